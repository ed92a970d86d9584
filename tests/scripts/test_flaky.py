"""scripts/flaky: which tests of a suite sometimes fail, on a suite of ctest that is written here."""

import os
import signal
import subprocess
import tempfile
import unittest
from pathlib import Path

from trio_fakes import wait_until

FLAKY = Path(__file__).resolve().parents[2] / "scripts/flaky"


class Flaky(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = Path(folder.name)
        self.out = self.folder / "out"

    def suite(self, properties="", **scripts):
        """A build folder with a test for each script of the shell, which finds its name in $1 and a folder in $2."""
        lines = [f'add_test({name} "/bin/sh" "-c" [==[{script}]==] sh "{name}" "{self.folder}")\n'
                 for name, script in scripts.items()]
        (self.folder / "CTestTestfile.cmake").write_text("".join(lines) + properties)

    def command(self, *options):
        return [FLAKY, "--test-dir", self.folder, "--out", self.out, *options]

    def flaky(self, *options, exit_code=0):
        done = subprocess.run(self.command(*options), capture_output=True, text=True, check=False)
        self.assertEqual(done.returncode, exit_code, done.stdout + done.stderr)
        self.assertNotIn("Traceback", done.stderr)
        return done.stdout + done.stderr

    def test_one_that_fails_every_other_time_is_told_with_its_rounds_and_its_output(self):
        self.suite(good="true", every_other='if [ -e $2/mark ]; then rm $2/mark; echo "no mark"; exit 1; fi; touch $2/mark')
        said = self.flaky("--quiet", "2", "--loaded", "2", exit_code=1)
        self.assertIn("every_other: failed in 2 of 4 rounds", said)
        for number in (1, 2):  # a quiet round and a loaded one are run in turn
            output = self.out / f"loaded-0{number}" / "every_other.txt"
            self.assertIn(f"  loaded {number}: {output}\n", said)
            self.assertIn("no mark", output.read_text())
        self.assertNotIn("good", said)
        self.assertIn("4 rounds in 0 min; tests that failed: 1", said)

    def test_no_failure_ends_with_0(self):
        self.suite(good="true", other="true")
        said = self.flaky("--quiet", "2", "--loaded", "1", "--load", "1")
        self.assertIn("loaded 1 of 1: 0 of 2 tests failed", said)
        self.assertIn("3 rounds in 0 min; tests that failed: 0", said)

    def test_the_load_is_there_in_loaded_rounds_only_and_gone_afterwards(self):
        # The processes of the load are children of scripts/flaky, which is the parent of ctest.
        count = ("flaky=$(ps -o ppid= -p $PPID); "
                 "ps -o args= --ppid $flaky | grep -c 'while True' >>$2/busy; ps -o pid=,args= --ppid $flaky >>$2/pids")
        self.suite(counts=count)
        self.flaky("--quiet", "1", "--loaded", "1", "--load", "3")
        self.assertEqual((self.folder / "busy").read_text().split(), ["0", "3"])
        pids = [line.split()[0] for line in (self.folder / "pids").read_text().splitlines() if "while True" in line]
        self.assertFalse([pid for pid in pids if Path("/proc", pid).exists()])

    def test_a_test_that_cannot_be_started_or_takes_too_long_has_failed_and_a_skipped_one_has_not(self):
        self.suite(slow="exec sleep 1000", skipped="exit 77",
                   properties='add_test(missing "/no/such/program")\n'
                              "set_tests_properties(slow PROPERTIES TIMEOUT 1)\n"
                              "set_tests_properties(skipped PROPERTIES SKIP_RETURN_CODE 77)\n")
        said = self.flaky("--quiet", "1", "--loaded", "0", exit_code=1)
        self.assertIn("slow: failed in 1 of 1 rounds", said)
        self.assertIn("missing: failed in 1 of 1 rounds", said)
        self.assertIn("skipped: skipped\n", said)

    def test_the_folder_for_the_output_may_be_relative(self):
        self.suite(bad="exit 1")
        here = self.folder / "elsewhere"
        here.mkdir()
        done = subprocess.run([FLAKY, "--test-dir", "..", "--out", "out", "--quiet", "1", "--loaded", "0"], cwd=here,
                              capture_output=True, text=True, check=False)
        self.assertEqual(done.returncode, 1, done.stderr)
        self.assertIn("  quiet 1: out/quiet-01/bad.txt\n", done.stdout)
        self.assertTrue((here / "out/quiet-01/bad.txt").exists())

    def test_options_of_ctest_choose_the_tests(self):
        self.suite(good="true", bad="exit 1")
        self.assertIn("0 of 1 tests failed", self.flaky("--quiet", "1", "--loaded", "0", "-R", "good"))

    def test_without_a_test_or_a_round_and_into_an_old_folder_nothing_is_run(self):
        self.suite(good="true")
        self.assertIn("no test was run", self.flaky("-R", "nothing", exit_code=2))
        self.assertIn("exists", self.flaky(exit_code=2))
        self.assertIn("has to be a round", self.flaky("--quiet", "0", "--loaded", "0", exit_code=2))

    def test_ctrl_c_tells_what_is_known_and_ends_the_load(self):
        self.suite(waits="[ -e $2/mark ] || { touch $2/mark; exit 1; }; echo >$2/waits; exec sleep 1000")
        flaky = subprocess.Popen(self.command("--load", "1"), stdout=subprocess.PIPE, text=True, start_new_session=True)
        self.assertTrue(wait_until((self.folder / "waits").exists))
        os.killpg(flaky.pid, signal.SIGINT)
        said = flaky.communicate()[0]
        self.assertEqual(flaky.returncode, 130, said)
        self.assertIn("waits: failed in 1 of 1 rounds\n  quiet 1: ", said)


if __name__ == "__main__":
    unittest.main()
