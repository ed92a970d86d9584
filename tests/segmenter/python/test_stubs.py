"""The type stubs and the docstrings of the package are complete."""

import ast
import os
import unittest

import kintsugi

STUBS = os.path.join(os.path.dirname(kintsugi.__file__), "__init__.pyi")


def declared(nodes):
    """{name: {name of a member}} of what a stub file declares."""
    names = {}
    for node in nodes:
        if isinstance(node, (ast.ClassDef, ast.FunctionDef)):
            names[node.name] = {member.name for member in getattr(node, "body", [])
                                if isinstance(member, ast.FunctionDef)}
        elif isinstance(node, ast.AnnAssign):
            names[node.target.id] = set()
    return names


class StubsTest(unittest.TestCase):
    def setUp(self):
        with open(STUBS, encoding="utf-8") as file:
            self.declared = declared(ast.parse(file.read()).body)

    def test_declare_every_name_and_no_other(self):
        self.assertEqual(set(self.declared), set(kintsugi.__all__))

    def test_declare_every_member_and_no_other(self):
        for name in kintsugi.__all__:
            thing = getattr(kintsugi, name)
            if not isinstance(thing, type):
                continue
            members = {member for member in vars(thing) if not member.startswith("_")}
            self.assertEqual({member for member in self.declared[name] if not member.startswith("_")}, members, name)

    def test_every_function_has_a_docstring(self):
        for name in kintsugi.__all__:
            thing = getattr(kintsugi, name)
            members = [thing] if callable(thing) else []
            if isinstance(thing, type):
                members += [member for key, member in vars(thing).items() if callable(member) and key[0] != "_"]
            for member in members:
                text = (member.__doc__ or "").strip().splitlines()
                self.assertGreaterEqual(len(text), 1, name)

    def test_there_is_a_marker_for_type_checkers(self):
        self.assertTrue(os.path.exists(os.path.join(os.path.dirname(STUBS), "py.typed")))


if __name__ == "__main__":
    unittest.main()
