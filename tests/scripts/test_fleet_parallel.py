"""Whole runs of scripts/fleet through GNU parallel, with fake programs."""

import os
import shutil
import signal
import unittest

from fleet_fakes import PATIENCE_S, FleetTest, WholeRuns
from trio_fakes import process_is_gone


@unittest.skipUnless(shutil.which("parallel"), "there is no parallel; scripts/packages-fleet.txt has what this test needs")
class ParallelTest(WholeRuns, FleetTest):
    scheduler = ("--scheduler", "parallel")

    def test_tasks_end_with_a_run_that_is_killed_and_the_next_run_does_them(self):
        self.write_list(slow="echo $$ $PPID > $1.pids; [ -e $1.cure ] || sleep 60")
        run = self.begin("run", "list.txt", "--out", self.out, *self.scheduler)
        file = self.here / "slow.ply.pids"
        self.wait_for(lambda: file.exists() and len(file.read_text().split()) == 2)
        pids = [int(pid) for pid in file.read_text().split()]
        run.send_signal(signal.SIGKILL)
        run.wait(PATIENCE_S)
        self.wait_for(lambda: all(process_is_gone(pid) for pid in pids))
        self.write("slow.ply.cure", "")
        self.run_fleet()
        self.assertEqual(self.table()["slow"]["state"], "done")

    def test_a_second_run_at_once_is_refused(self):
        self.write_list(slow="touch $1.begun; while [ ! -e $1.cure ]; do sleep 0.05; done")
        run = self.begin("run", "list.txt", "--out", self.out, *self.scheduler)
        self.wait_for((self.here / "slow.ply.begun").exists)
        self.assertIn(f"is at work in {self.out} (pid {run.pid})", self.run_fleet(expect=1))
        self.write("slow.ply.cure", "")
        self.assertEqual(run.wait(PATIENCE_S), 0, (self.here / "messages.txt").read_text())

    def test_so_many_tasks_at_a_time_as_jobs_says_each_with_processors_of_its_own(self):
        # Each waits for the other.
        script = ("touch {here}/{name}.here; until [ -e {here}/a.here ] && [ -e {here}/b.here ]; do sleep 0.01; done; "
                  "grep Cpus_allowed_list /proc/self/status > {here}/{name}.cpus")
        self.write_list(**{name: script.format(here=self.here, name=name) for name in "ab"})
        self.run_fleet("--jobs", "2", "--timeout", str(PATIENCE_S // 2))
        lists = [(self.here / f"{name}.cpus").read_text() for name in "ab"]
        if len(os.sched_getaffinity(0)) > 1:
            self.assertNotEqual(*lists)
        self.assertEqual(self.runs()[0]["workers"], 2)

    def test_an_input_whose_file_has_the_name_of_another_may_be_added(self):
        for folder in "ab":
            (self.here / folder).mkdir()
            self.write(f"{folder}/scan.ply", "")
        self.write("list.txt", "a/scan.ply\n")
        self.run_fleet()
        self.write("list.txt", "b/scan.ply\na/scan.ply\n")
        self.assertIn("1 of 2 inputs have been done before", self.run_fleet())
        self.assertEqual(list(self.table()), ["b_scan", "scan"])

    def test_options_of_parallel_that_it_does_not_know_are_told(self):
        self.write_list(a="")
        self.assertIn("Unknown option: nonsense", self.run_fleet("--parallel=--nonsense", expect=1))
