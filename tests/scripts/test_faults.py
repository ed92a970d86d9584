"""scripts/faults: the seed fixes the moments of kills and power cuts; lines of rows that hold are kept."""

import contextlib
import os
import pathlib
import signal
import subprocess
import tempfile
import unittest

from trio_fakes import ROOT, environment, wait_until, write_program

DRAWS = """
set -euo pipefail
source "$1/scripts/lib/faults.sh"
RANDOM="$2" figure[reference_s]=100
for run in 1 2; do plan_kills segmenter viewer mapper; echo "$planned"; done
draw_share; echo "$share $RANDOM"
"""


# run_row QUICK NAME: a row that holds if it is called `fine`. Then what is kept of it, for runs that are quick and not.
KEPT = """
set -uo pipefail
source "$1/scripts/lib/faults.sh"
quick="$3" seed=1
fault_row fine "nothing" true
fault_row wrong "nothing" must "one is two" false
(run_row "$2" "$4")
for quick in 0 1; do print_held "$2" "$4" || echo "none"; done
"""


def bash(script, *arguments):
    return subprocess.run(["bash", "-c", script, "faults", ROOT, *map(str, arguments)], check=True, capture_output=True,
                          text=True).stdout


class SeedTest(unittest.TestCase):
    def draws(self, seed):
        return bash(DRAWS, seed)

    def test_the_same_seed_gives_the_same_moments(self):
        draws = self.draws(3)
        self.assertEqual(draws, self.draws(3))
        self.assertNotEqual(draws, self.draws(4))
        moments = [float(line.split()[0]) for line in draws.splitlines()[:-1]]
        self.assertEqual(len(set(moments)), 6)
        for run in (moments[:3], moments[3:]):
            self.assertEqual(run, sorted(run))


class KeptLinesTest(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = folder.name

    def kept(self, *, row, quick=0):
        """The line that the row printed, and what is kept: of the full run, of the quick one."""
        return bash(KEPT, self.folder, quick, row).splitlines()

    def test_a_row_that_holds_is_kept(self):
        line, full, quick = self.kept(row="fine")
        self.assertIn("| fine | nothing | yes |", line)
        self.assertEqual((full, quick), (line, "none"))

    def test_a_quick_run_does_not_stand_for_a_full_one(self):
        line, full, quick = self.kept(row="fine", quick=1)
        self.assertEqual((full, quick), ("none", line))

    def test_a_row_that_does_not_hold_is_not_kept(self):
        line, full, quick = self.kept(row="wrong")
        self.assertIn("**no**: one is two", line)
        self.assertEqual((full, quick), ("none", "none"))

    def test_missing_prints_what_is_kept_and_runs_nothing(self):
        pathlib.Path(self.folder, "loss-5").mkdir()
        pathlib.Path(self.folder, "loss-5", "line.quick.md").write_text("| loss-5 | as it was |\n")
        write_program(pathlib.Path(self.folder, "kintsugi-mapper"), "exit 1")
        shown = subprocess.run([f"{ROOT}/scripts/faults", "--quick", "--missing", "--out", self.folder, "loss-5"], check=True,
                               capture_output=True, text=True, env=environment(self.folder)).stdout
        self.assertEqual(shown.splitlines()[2:], ["| loss-5 | as it was |"])


# Ends with 0 after Ctrl-C, as a trio does whose map is shortened.
INTERRUPTED_TRIO = 'trap "exit 0" INT; mkdir -p "$2"; touch "$2/begun"; while :; do sleep 0.02; done'


def end_group(pid):
    with contextlib.suppress(ProcessLookupError):
        os.killpg(pid, signal.SIGKILL)


class InterruptTest(unittest.TestCase):
    def test_ctrl_c_in_a_reference_ends_all_and_leaves_none(self):
        temporary = tempfile.TemporaryDirectory()
        self.addCleanup(temporary.cleanup)
        folder = pathlib.Path(temporary.name).resolve()
        scripts, runs = folder / "scripts", folder / "runs"
        (scripts / "faults.d").mkdir(parents=True)
        for name in ("faults", "lib"):
            (scripts / name).symlink_to(ROOT / "scripts" / name)
        (scripts / "faults.d/rows.sh").write_text("LCM_DEFAULT_URL=memq://\nfault_row one nothing reference\n"
                                                  "fault_row two nothing reference --further\n")
        for name, script in (("scripts/private_bus", 'exec "$@"'), ("scripts/trio", INTERRUPTED_TRIO),
                             ("kintsugi-mapper", "exit 1")):
            write_program(folder / name, script)
        faults = subprocess.Popen([scripts / "faults", "--out", runs, "one", "two"], env=environment(folder),
                                  stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, start_new_session=True)
        self.addCleanup(faults.communicate)
        self.addCleanup(end_group, faults.pid)
        self.assertTrue(wait_until(lambda: list(runs.glob("reference-*/begun"))))
        os.killpg(faults.pid, signal.SIGINT)
        self.assertTrue(wait_until(lambda: faults.poll() is not None or len(list(runs.glob("reference-*/begun"))) > 1))
        self.assertEqual(faults.poll(), 130)
        self.assertEqual(list(runs.glob("*/seconds")), [])
        self.assertEqual(len(list(runs.glob("reference-*/begun"))), 1)


if __name__ == "__main__":
    unittest.main()
