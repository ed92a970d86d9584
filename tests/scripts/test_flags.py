"""scripts/flags: the tables of flags in README.md files, from what a program prints with --help."""

import subprocess
import tempfile
import unittest
from pathlib import Path

FLAGS = Path(__file__).resolve().parents[2] / "scripts/flags"

# As CLI11 prints it.
HELP = """\
Does nothing.
Usage: fake [OPTIONS] FILE

Positionals:
  FILE TEXT REQUIRED          what to read

Options:
  -h,--help                   Print this help message and exit
  --version                   Print the version and exit
  -n,--steps INT:NONNEGATIVE=10
                              how many steps | 0: all
  --voxel FLOAT:FLOAT in [0.1 - 1e+06]=0.5
                              edge, m
  --size FLOAT:POSITIVE       fills the column, > 0
  --mode TEXT:{fast,exact}=exact
                              fast or exact, < slow
  --ids UINT ... Needs: --mode
                              only these
  --map TEXT Excludes: --mode a file
[Option Group: The bus]
  at most one of these
  Options:
    --pixel FLOAT x 2           U V
"""

TABLES = """\
Positionals:

| flag | value | default | meaning |
|---|---|---|---|
| `FILE` | `TEXT` | `required` | what to read |

Options:

| flag | value | default | meaning |
|---|---|---|---|
| `-n, --steps` | `INT >= 0` | `10` | how many steps \\| 0: all |
| `--voxel` | `FLOAT in [0.1 - 1e+06]` | `0.5` | edge, m |
| `--size` | `FLOAT > 0` |  | fills the column, > 0 |
| `--mode` | `{fast,exact}` | `exact` | fast or exact, &lt; slow |
| `--ids` | `UINT ...` |  | only these (needs --mode) |
| `--map` | `TEXT` |  | a file (not with --mode) |

The bus:

| flag | value | default | meaning |
|---|---|---|---|
| `--pixel` | `FLOAT x 2` |  | U V |
"""


class Flags(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = Path(folder.name)
        (self.folder / "help.txt").write_text(HELP)
        self.program = self.folder / "fake"
        self.program.write_text('#!/bin/sh\n[ "$1" = --help ] && cat "$(dirname "$0")/help.txt"\n')
        self.program.chmod(0o755)
        self.readme = self.folder / "README.md"
        self.readme.write_text("before\n<!-- flags:fake -->\nold\n<!-- /flags -->\nafter\n")

    def flags(self, *options):
        return subprocess.run([FLAGS, "--bin", self.folder, *options, self.readme],
                              capture_output=True, text=True)

    def test_writes_the_table_between_the_marks_and_nothing_else(self):
        done = self.flags()
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertEqual(self.readme.read_text(),
                         f"before\n<!-- flags:fake -->\n\n{TABLES}\n<!-- /flags -->\nafter\n")

    def test_the_check_holds_for_what_was_written(self):
        self.flags()
        self.assertEqual(self.flags("--check").returncode, 0)

    def test_the_check_names_the_file_that_differs_and_leaves_it(self):
        self.flags()
        text = self.readme.read_text()
        (self.folder / "help.txt").write_text(HELP.replace("=10", "=11"))
        done = self.flags("--check")
        self.assertEqual(done.returncode, 1)
        self.assertIn(str(self.readme), done.stderr)
        self.assertEqual(self.readme.read_text(), text)

    def test_a_subcommand_has_a_table_of_its_own(self):
        self.program.write_text('#!/bin/sh\n[ "$*" = "teach --help" ] && cat "$(dirname "$0")/help.txt"\n')
        self.readme.write_text("<!-- flags:fake teach -->\nold\n<!-- /flags -->\n")
        done = self.flags()
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertEqual(self.readme.read_text(),
                         f"<!-- flags:fake teach -->\n\n{TABLES}\n<!-- /flags -->\n")

    def test_a_program_that_is_not_there_is_an_error(self):
        self.program.unlink()
        done = self.flags("--check")
        self.assertEqual(done.returncode, 1)
        self.assertIn("fake is not built", done.stderr)


if __name__ == "__main__":
    unittest.main()
