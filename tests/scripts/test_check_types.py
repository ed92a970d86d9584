"""scripts/check_types: which types it takes for one."""

import subprocess
import tempfile
import unittest
from pathlib import Path

PROGRAM = Path(__file__).resolve().parent.parent.parent / "scripts" / "check_types"


class CheckTypes(unittest.TestCase):
    def check(self, *codes):
        with tempfile.TemporaryDirectory() as root:
            for number, code in enumerate(codes):
                Path(root, f"{number}.hpp").write_text(code, encoding="utf-8")
            subprocess.run(["git", "init", "-q", root], check=True)
            subprocess.run(["git", "-C", root, "add", "."], check=True)
            return subprocess.run([PROGRAM, "--root", root], capture_output=True, text=True, check=False)

    def test_names_a_type_that_is_defined_twice(self):
        result = self.check("namespace a::b {\nstruct Cell {\n  int x = 0;\n};\n}", "namespace a {\nnamespace b {\nclass Cell final : X {};\n}\n}")
        self.assertEqual(result.returncode, 1)
        self.assertEqual(result.stdout, "a::b::Cell is defined in 0.hpp and in 1.hpp: give one of them another name\n")

    def test_takes_what_is_no_second_definition(self):
        defined = "namespace a {\nenum class Cell : int { kOne };\n}"
        for other in (
            "namespace a {\nclass Cell;\n}",
            "namespace b {\nstruct Cell {};\n}",
            "namespace a {\nnamespace {\nstruct Cell {};\n}\n}",
            "namespace a {\nstruct Map {\n  struct Cell {};\n};\n}",
            "namespace a {\nstruct Map::Cell {};\ntemplate <>\nstruct Cell<int> {};\n}",
            "namespace a {\nvoid f() {\n  struct Cell {};\n}\nCell g(struct Cell cell) { return cell; }\n}",
            "namespace a {\n// struct Cell {\nconst char* kText = \"struct Cell {\";\nint k = 1'000 + '{';\n}",
        ):
            with self.subTest(other=other):
                result = self.check(defined, other)
                self.assertEqual((result.returncode, result.stderr), (0, ""), result.stdout)


if __name__ == "__main__":
    unittest.main()
