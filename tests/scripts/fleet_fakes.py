"""Shared by the tests of scripts/lib/fleet: a folder with fake programs, and inputs that tell these what to do."""

import csv
import json
import os
import signal
import subprocess
import sys
import time
import unittest
from pathlib import Path
from tempfile import TemporaryDirectory
from unittest import mock

from trio_fakes import ROOT, write_program

FLEET = ROOT / "scripts" / "fleet"
PATIENCE_S = 60  # for what has to happen sooner or later

# An input is a script of the shell, in which these programs do what it says.
PROGRAMS = {
    "kintsugi-segment-cloud": """
case "$*" in *--wrong*) echo '--wrong: not known' >&2; exit 109 ;; esac
[ -e "$1" ] || { echo "kintsugi-segment-cloud: $1: no such file" >&2; exit 1; }
points=100 segments=4
. "$1"
echo "ply $*" > "$2"
echo "{\\"num_points\\": $points, \\"num_segments\\": $segments}" > segments.json
""",
    "kintsugi-segmenter": """
case "$1" in --version) echo kintsugi-segmenter 1.2.3; exit ;; --check) exit ;; esac
echo '{"num_points": 7, "num_segments": 2}' > segments.json
echo '{"num_points": 5, "num_segments": 1}' > segments.part1.json
echo ply > segments.ply
""",
    "kintsugi-mapper": """
echo log > mapper.lcm
printf 'frame_index,state\\n1,tracking\\n2,lost\\n' > timings.csv
printf '0.0 0 0 0 0 0 0 1\\n' > trajectory.txt
[ ! -d scene ] && mkdir scene && printf '0.0 0 0 0 0 0 0 1\\n' > scene/groundtruth.txt
""",
    "kintsugi-ground-truth": "echo truth > $3",
    "kintsugi-evaluate": """
while [ $# -gt 0 ]; do
  case "$1" in
    --csv) printf 'ate_m_pairs,ate_m_rmse\\n4,0.25\\n' > "$2" ;;
    --out) mkdir -p "$2"
      printf 'object_iou,instance_iou,objects_found,objects,achievable_accuracy,undersegmentation_error\\n' > "$2/quality.csv"
      printf '0.5,0.75,3,6,0.9,0.2\\n' >> "$2/quality.csv" ;;
  esac
  shift
done
""",
}


class FleetTest(unittest.TestCase):
    """Has `here`, an empty folder, and fake programs."""

    def setUp(self):
        temporary = TemporaryDirectory()
        self.addCleanup(temporary.cleanup)
        self.here = Path(temporary.name).resolve()
        self.programs = self.here / "programs"
        self.programs.mkdir()
        for name, script in PROGRAMS.items():
            write_program(self.programs / name, script)
        self.out = self.here / "out"
        patch = mock.patch("trio.programs.BIN", str(self.programs))
        patch.start()
        self.addCleanup(patch.stop)

    def write(self, name, text):
        (self.here / name).write_text(text)
        return self.here / name

    def write_list(self, **inputs):
        """A list with a cloud for each, whose content is the value."""
        for name, script in inputs.items():
            self.write(f"{name}.ply", script)
        return self.write("list.txt", "".join(f"{name}.ply\n" for name in inputs))

    def environment(self):
        return {**os.environ, "KINTSUGI_BIN": str(self.programs)}

    def command(self, *arguments):
        return [sys.executable, str(FLEET), *map(str, arguments)]

    def fleet(self, *arguments, expect=0):
        """Runs scripts/fleet as a person does; returns what it prints."""
        done = subprocess.run(self.command(*arguments), env=self.environment(), cwd=self.here, stdin=subprocess.DEVNULL,
                              stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, check=False,
                              timeout=PATIENCE_S)
        self.assertEqual(done.returncode, expect, done.stdout)
        return done.stdout

    def begin(self, *arguments):
        """Starts scripts/fleet, and ends it with the test."""
        with open(self.here / "messages.txt", "wb") as output:
            process = subprocess.Popen(self.command(*arguments), env=self.environment(), cwd=self.here,
                                       stdin=subprocess.DEVNULL, stdout=output, stderr=subprocess.STDOUT)
        self.addCleanup(process.wait)
        self.addCleanup(process.kill)
        return process

    def wait_for(self, condition):
        deadline = time.monotonic() + PATIENCE_S
        while not condition():
            if time.monotonic() > deadline:
                messages_file = self.here / "messages.txt"
                self.fail(f"it did not happen: {messages_file.read_text() if messages_file.exists() else ''}")
            time.sleep(0.02)

    def table(self):
        with open(self.out / "results.csv", newline="") as lines:
            return {row["name"]: row for row in csv.DictReader(lines)}

    def runs(self):
        return json.loads((self.out / "jobs" / "runs.json").read_text())


class WholeRuns:
    """What holds with every scheduler. `scheduler`: options of scripts/fleet run."""

    scheduler = ()

    def run_fleet(self, *arguments, expect=0):
        return self.fleet("run", "list.txt", "--out", self.out, *self.scheduler, *arguments, expect=expect)

    def test_what_failed_is_named_and_only_that_is_done_again(self):
        self.write_list(good="points=30 segments=3; echo x >> $1.times",
                        bad="echo x >> $1.times; echo 'kintsugi-segment-cloud: a spoilt cloud' >&2; exit 1",
                        late="echo x >> $1.times; [ -e $1.cure ] || exit 3")
        text = self.run_fleet(expect=1)
        self.assertIn("fleet: bad failed: a spoilt cloud\n", text)
        self.assertIn("1 done, 2 failed of 3 inputs", text)
        rows = self.table()
        self.assertEqual([rows["good"][key] for key in ("state", "exit_code", "points", "segments", "kind", "version")],
                         ["done", "0", "30", "3", "cloud", "1.2.3"])
        self.assertEqual([rows["bad"][key] for key in ("state", "step", "exit_code", "reason")],
                         ["failed", "segment", "1", "a spoilt cloud"])
        self.assertEqual(rows["late"]["exit_code"], "3")
        self.assertIn("a spoilt cloud", (self.out / "report.html").read_text())
        self.assertTrue((self.out / "results" / "good" / "labelled.ply").read_text().startswith("ply"))

        self.write("late.ply.cure", "")
        text = self.run_fleet(expect=1)
        self.assertIn("1 of 3 inputs have been done before", text)
        self.assertEqual([self.table()[name]["state"] for name in ("good", "bad", "late")], ["done", "failed", "done"])
        times = [len((self.here / f"{name}.ply.times").read_text().split()) for name in ("good", "bad", "late")]
        self.assertEqual(times, [1, 2, 2])
        self.assertEqual([run["tasks"] for run in self.runs()], [3, 2])

    def test_a_key_of_the_bus_is_found_from_the_folders_of_the_tasks(self):
        self.write_list(log='echo "$KINTSUGI_BUS_KEY" >$1.key')
        with mock.patch.dict(os.environ, {"KINTSUGI_BUS_KEY": "my.key"}):
            self.run_fleet()
        self.assertEqual((self.here / "log.ply.key").read_text().strip(), str(self.here / "my.key"))

    def test_a_task_whose_worker_is_killed_is_done_again(self):
        self.write_list(**{f"cloud{number}": "" for number in range(4)},
                        victim="[ -e $1.killed ] || { touch $1.killed; echo half > labelled.ply; kill -KILL $PPID; sleep 60; }")
        text = self.run_fleet()
        self.assertTrue((self.here / "victim.ply.killed").exists())
        self.assertIn("tasks without a result, because their workers were killed: 1; once more", text)
        self.assertEqual({row["state"] for row in self.table().values()}, {"done"})
        self.assertTrue((self.out / "results" / "victim" / "labelled.ply").read_text().startswith("ply"))
        self.assertEqual([each.name for each in (self.out / "work").iterdir()], [])

    def test_a_task_whose_worker_is_always_killed_has_failed(self):
        self.write_list(good="", victim="echo x >> $1.times; echo its last words; kill -KILL $PPID; sleep 60")
        text = self.run_fleet(expect=1)
        self.assertIn("victim failed: its worker ended 3 times without a result", text)
        self.assertEqual(len((self.here / "victim.ply.times").read_text().split()), 3)
        self.assertEqual([row["state"] for row in self.table().values()], ["done", "failed"])
        self.assertIn("its last words", (self.out / "results" / "victim" / "messages.txt").read_text())

    def test_what_a_lost_worker_said_is_told_of_its_own_input(self):
        dies = "echo x >> $1.times; echo no room for {} >> /proc/$PPID/fd/2; kill -KILL $PPID; sleep 60"
        self.write_list(late="echo x >> $1.times; [ $(wc -l < $1.times) = 3 ] || { kill -KILL $PPID; sleep 60; }",
                        first=dies.format("first"), second=dies.format("second"))
        text = self.run_fleet(expect=1)
        for name in ("first", "second"):
            self.assertRegex(text, f"{name} failed: its worker ended 3 times without a result: .*no room for {name}")
        self.assertEqual(self.table()["late"]["state"], "done")

    def test_the_folder_may_have_any_name(self):
        self.out = self.here / "it's 5 {} {.} {%} {1} {= $_ =} %a%j"
        self.write_list(a="")
        self.run_fleet()
        self.assertEqual(self.table()["a"]["state"], "done")

    def test_a_run_that_is_stopped_is_gone_on_with(self):
        self.write_list(first="", slow="touch $1.begun; [ -e $1.cure ] || sleep 60", last="")
        run = self.begin("run", "list.txt", "--out", self.out, *self.scheduler, "--jobs", "1")
        self.wait_for((self.here / "slow.ply.begun").exists)
        run.send_signal(signal.SIGTERM)
        self.assertEqual(run.wait(PATIENCE_S), 130, (self.here / "messages.txt").read_text())
        self.assertEqual([row["state"] for row in self.table().values()], ["done", "missing", "missing"])
        self.write("slow.ply.cure", "")
        self.assertIn("1 of 3 inputs have been done before", self.run_fleet())
        self.assertEqual({row["state"] for row in self.table().values()}, {"done"})
