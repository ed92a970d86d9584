"""scripts/bench --write: what is between the markers of a section is replaced."""

import contextlib
import io
import os
import sys
import unittest
from pathlib import Path
from tempfile import TemporaryDirectory
from unittest import mock

ROOT = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "scripts" / "lib"))

from bench import commands  # noqa: E402
from bench.document import Document  # noqa: E402
from trio.messages import Problem  # noqa: E402

TEXT = """# Measurements

<!-- bench:summary -->
<!-- /bench:summary -->

## One
Above one.
<!-- bench:one -->
old one
<!-- /bench:one -->
Below one.
<!-- bench:two -->
old two
<!-- /bench:two -->
"""


def failing(run):
    raise Problem("no luck")


class BenchDocument(unittest.TestCase):
    def setUp(self):
        temporary = TemporaryDirectory()
        self.addCleanup(temporary.cleanup)
        self.folder = Path(temporary.name)
        self.file = self.folder / "BENCHMARK.md"
        self.file.write_text(TEXT)
        sections = (commands.Section("one", "", lambda run: "| a |\n|---|\n| \\1 |\n"),
                    commands.Section("two", "", failing),
                    commands.Section("three", "", lambda run: "new three"))
        self.addCleanup(mock.patch.stopall)
        mock.patch.object(commands, "machine", lambda: "2 cores").start()
        mock.patch.object(commands, "SECTIONS", sections).start()
        self.said = mock.patch.object(commands, "say").start()

    def bench(self, *arguments):
        """Exit code and output."""
        with contextlib.redirect_stdout(io.StringIO()) as printed:
            code = commands.main([*arguments, "--write", str(self.file)])
        return code, printed.getvalue()

    def messages(self):
        return " ".join(str(call.args[0]) for call in self.said.call_args_list)

    def test_replaces_only_what_is_between_the_markers(self):
        code, printed = self.bench("--only", "one")
        self.assertEqual(code, 0)
        self.assertIn("## one\n\n| a |", printed)
        text = self.file.read_text()
        self.assertIn("Above one.\n<!-- bench:one -->\n\n| a |\n|---|\n| \\1 |\n\nMeasured on 2 cores.\n\n<!-- /bench:one -->\n"
                      "Below one.\n", text)
        self.assertNotIn("old one", text)
        self.assertIn("<!-- bench:two -->\nold two\n<!-- /bench:two -->\n", text)

    def test_a_whole_run_says_once_on_which_machine(self):
        mock.patch.object(commands, "SECTIONS", commands.SECTIONS[:1]).start()
        self.file.write_text(TEXT + "<!-- bench:machine -->\n<!-- /bench:machine -->\n")
        self.assertEqual(self.bench()[0], 0)
        text = self.file.read_text()
        self.assertIn("| \\1 |\n\n<!-- /bench:one -->", text)
        self.assertIn("<!-- bench:machine -->\n\n2 cores; load before the run", text)

    def test_writing_again_changes_nothing(self):
        self.bench("--only", "one")
        text = self.file.read_text()
        self.bench("--only", "one")
        self.assertEqual(self.file.read_text(), text)

    def test_a_section_without_markers_is_an_error_before_anything_is_measured(self):
        code, printed = self.bench("--only", "one,three")
        self.assertEqual(code, 1)
        self.assertIn("no places for section 'three'", self.messages())
        self.assertEqual(printed, "")
        self.assertEqual(self.file.read_text(), TEXT)

    def test_a_section_that_fails_keeps_what_was_there(self):
        code, _ = self.bench("--only", "two,one")
        self.assertEqual(code, 1)
        self.assertIn("section 'two' failed: no luck", self.messages())
        self.assertIn("old two", self.file.read_text())
        self.assertNotIn("old one", self.file.read_text())

    def test_a_section_that_is_skipped_keeps_what_was_there(self):
        sections = (commands.Section("one", "", lambda run: "new one", needs_recording=True),)
        mock.patch.object(commands, "SECTIONS", sections).start()
        code, printed = self.bench("--only", "one")
        self.assertEqual(code, 0)
        self.assertIn("section 'one' is skipped: no recording was given", self.messages())
        self.assertNotIn("## one", printed)
        self.assertIn("<!-- bench:one -->\nold one\n<!-- /bench:one -->", self.file.read_text())

    def test_an_unknown_section_is_a_wrong_option(self):
        self.assertEqual(self.bench("--only", "four")[0], 2)
        self.assertIn("no section 'four'", self.messages())

    def test_a_file_that_is_not_there_is_an_error(self):
        self.file.unlink()
        self.assertEqual(self.bench("--only", "one")[0], 1)
        self.assertIn("there is no file", self.messages())

    def test_a_write_that_fails_leaves_the_document_as_it_was(self):
        for function in ("os.replace", "pathlib.Path.write_text"):
            with mock.patch(function, side_effect=OSError(28, "No space left on device")):
                with self.assertRaises(OSError):
                    Document(self.file).replace("one", "new")
            self.assertEqual(self.file.read_text(), TEXT)
            self.assertEqual(os.listdir(self.folder), ["BENCHMARK.md"])

    def test_two_places_for_one_section_are_an_error(self):
        self.file.write_text(TEXT + TEXT)
        with self.assertRaisesRegex(Problem, "2 places for section 'one'"):
            Document(self.file).check(["one"])


class BenchmarkDocument(unittest.TestCase):
    def test_has_a_place_for_every_section(self):
        Document(ROOT / "BENCHMARK.md").check(["machine", "summary", *(each.name for each in commands.SECTIONS
                                                                       if each.name != "pictures")])


if __name__ == "__main__":
    unittest.main()
