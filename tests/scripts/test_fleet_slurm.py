"""Whole runs of scripts/fleet through Slurm, with fake programs."""

import signal
import subprocess
import unittest

from fleet_fakes import PATIENCE_S, FleetTest, WholeRuns
from one_machine_slurm import NoSlurm, OneMachineSlurm

LONGEST_ARRAY = 4  # Slurm counts from 0: arrays of 3 tasks


class SlurmTest(WholeRuns, FleetTest):
    scheduler = ("--scheduler", "slurm")

    @classmethod
    def setUpClass(cls):
        try:
            cls.slurm = OneMachineSlurm(LONGEST_ARRAY)
        except NoSlurm as reason:
            raise unittest.SkipTest(f"there is no Slurm here: {reason}") from reason
        cls.addClassCleanup(cls.slurm.close)

    def environment(self):
        return {**super().environment(), "SLURM_CONF": self.slurm.environment["SLURM_CONF"]}

    def test_a_list_longer_than_an_array_may_be(self):
        self.write_list(**{f"cloud{number}": f"points={number + 1}" for number in range(7)})
        self.run_fleet("--jobs", "2")
        self.assertEqual([row["points"] for row in self.table().values()], [str(number + 1) for number in range(7)])

    def test_auto_takes_slurm_where_it_answers(self):
        self.write_list(a="")
        self.assertIn("tasks: 1, with Slurm", self.fleet("run", "list.txt", "--out", self.out))

    def test_tasks_go_on_without_the_run_and_the_next_run_waits_for_them(self):
        self.write_list(slow="touch $1.begun; while [ ! -e $1.cure ]; do sleep 0.05; done; echo x >> $1.times")
        run = self.begin("run", "list.txt", "--out", self.out, *self.scheduler)
        self.wait_for((self.here / "slow.ply.begun").exists)
        run.send_signal(signal.SIGKILL)
        run.wait(PATIENCE_S)
        second = self.begin("run", "list.txt", "--out", self.out, *self.scheduler)
        self.wait_for(lambda: "are still at work in Slurm" in (self.here / "messages.txt").read_text())
        self.write("slow.ply.cure", "")
        self.assertEqual(second.wait(PATIENCE_S), 0, (self.here / "messages.txt").read_text())
        self.assertEqual((self.here / "slow.ply.times").read_text(), "x\n")
        self.assertEqual(self.table()["slow"]["state"], "done")

    def test_tasks_that_are_cancelled_outside_are_done_again(self):
        self.write_list(slow="[ -e $1.begun ] || { touch $1.begun; sleep 60; }")
        run = self.begin("run", "list.txt", "--out", self.out, *self.scheduler)
        self.wait_for((self.here / "slow.ply.begun").exists)
        subprocess.run(["scancel", "--name=kintsugi-fleet"], env=self.environment(), check=True)
        self.assertEqual(run.wait(PATIENCE_S), 0, (self.here / "messages.txt").read_text())
        self.assertEqual(self.table()["slow"]["state"], "done")

    def test_what_slurm_refuses_is_told(self):
        self.write_list(a="")
        self.assertIn("sbatch: ", self.run_fleet("--sbatch=--partition=nonsense", expect=1))
