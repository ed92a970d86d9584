"""One process of a run: start, end, log, restarts."""

import os
import signal
import subprocess
import sys
import unittest
from unittest import mock

from trio_fakes import ROOT, UNTIL_TERM, FolderTest, process_is_gone, wait_until

from trio import process as process_module
from trio.process import MAX_QUICK_DEATHS, stop


class ProcessTest(FolderTest):
    def run_to_end(self, process):
        process.start()
        self.assertTrue(wait_until(lambda: not process.running))
        return process.take_exit_code()

    def test_tells_how_it_ended(self):
        self.assertEqual(self.run_to_end(self.shell("one", "exit 3")), 3)
        self.assertEqual(self.run_to_end(self.shell("two", "kill -KILL $$")), -signal.SIGKILL)

    def test_the_exit_code_is_told_once(self):
        process = self.shell("one", "exit 3")
        self.run_to_end(process)
        self.assertIsNone(process.take_exit_code())
        self.assertFalse(process.started)

    def test_logs_of_restarts_follow_each_other(self):
        process = self.shell("one", "echo first", restart_command=lambda: ["echo", "second"])
        self.run_to_end(process)
        process.restart()
        self.assertTrue(wait_until(lambda: not process.running))
        self.assertEqual((self.folder.path / "one.log").read_text(), "first\nsecond\n")

    def test_has_a_session_of_its_own_and_a_pid_file(self):
        process = self.shell("one", UNTIL_TERM)
        process.start()
        self.assertEqual(os.getsid(process.pid), process.pid)
        self.assertEqual(self.folder.read_pid("one"), process.pid)

    def test_measures_processor_time_and_memory(self):
        process = self.shell("one", "i=0; while [ $i -lt 300000 ]; do i=$((i + 1)); done;" + UNTIL_TERM)
        process.start()
        self.assertTrue(wait_until(lambda: process.measure() or (process.cpu_s or 0) > 0))
        self.assertGreaterEqual(process.peak_memory_MB, 0)

    def test_five_quick_deaths_running_are_too_many(self):
        process = self.shell("one", "exit 0")
        with mock.patch.object(process_module.time, "monotonic", return_value=100.0):
            process.start()
            self.assertEqual([process.may_restart() for _ in range(MAX_QUICK_DEATHS)], [True] * 4 + [False])

    def test_a_long_life_makes_up_for_quick_deaths(self):
        process = self.shell("one", "exit 0")
        with mock.patch.object(process_module.time, "monotonic") as now:
            now.return_value = 100.0
            process.start()
            for _ in range(MAX_QUICK_DEATHS - 1):
                self.assertTrue(process.may_restart())
            now.return_value = 103.0
            self.assertTrue(process.may_restart())
            now.return_value = 100.0
            self.assertTrue(process.may_restart())

    def test_last_words_are_the_end_of_the_log(self):
        process = self.shell("one", "for i in 1 2 3 4 5 6 7; do echo line $i; done")
        self.run_to_end(process)
        process.show_last_words()
        self.assertEqual(self.said, "".join(f"  one: line {i}\n" for i in range(3, 8)))

    def test_the_reason_is_the_last_error_of_this_run(self):
        for words, reason in (("[12:00] [error] disk; [12:01] [info] done", ["[12:00] [error] disk"]),
                              ("12:02 segmenter error: disk; 12:03 segmenter info: bye", ["12:02 segmenter error: disk"]),
                              ("kintsugi-mapper: no file; bye", ["kintsugi-mapper: no file"]),
                              ("Error: Failed to open run.lcm; bye", ["Error: Failed to open run.lcm"]),  # lcm-logplayer
                              ("one; two", ["two"])):
            process = self.shell("one", f"echo '{words}' | tr ';' '\n' | sed 's/^ *//'")
            self.run_to_end(process)
            self.assertEqual(process.reason(), reason)
        process = self.shell("one", "exit 1")
        self.run_to_end(process)
        self.assertEqual(process.reason(), [])

    def test_an_empty_log_is_told(self):
        process = self.shell("one", "exit 1")
        self.run_to_end(process)
        process.show_last_words()
        self.assertIn("nothing is in its log", self.said)

    def test_what_a_full_disk_has_swallowed_is_told(self):
        (self.folder.path / "one.log").write_text("kintsugi-one: an error of an earlier run\n")
        process = self.shell("one", "echo up; exit 1")
        self.run_to_end(process)
        self.assertEqual(process.reason(), ["up"])
        self.folder.is_disk_full = lambda: True
        process.show_last_words()
        self.assertEqual(self.said, "  one: up\n  one: its log may lack what it said: no space left on device\n")
        self.assertIn("no space left on device", process.reason()[0])

    def test_runs_without_a_log_that_cannot_be_written(self):
        os.mkdir(self.folder.file("one.log"))
        self.assertEqual(self.run_to_end(self.shell("one", "echo lost; exit 4")), 4)
        self.assertIn("one.log: Is a directory", self.said)

    def test_stop_waits_for_all(self):
        processes = [self.shell(name, UNTIL_TERM) for name in ("one", "two")]
        for process in processes:
            process.start()
        self.assertTrue(stop(processes, signal.SIGTERM, 30))
        self.assertFalse(any(process.running for process in processes))

    def test_stop_kills_what_does_not_end(self):
        process = self.shell("one", "trap '' TERM; echo ready; while :; do sleep 0.02; done")
        process.start()
        self.assertTrue(wait_until(lambda: self.folder.has("one.log")))
        self.assertFalse(stop([process], signal.SIGTERM, 0.2))
        self.assertTrue(wait_until(lambda: not process.running))
        self.assertIn("one did not stop within 0.2 s", self.said)

    def test_is_told_to_stop_only_once(self):
        process = self.shell("one", UNTIL_TERM)
        process.start()
        with mock.patch.object(process, "send") as send:
            process.tell_to_stop()
            process.tell_to_stop()
        send.assert_called_once_with(signal.SIGTERM)

    def test_ends_when_the_supervisor_is_killed(self):
        program = f"""
import sys, time
sys.path.insert(0, {str(ROOT / "scripts" / "lib")!r})
from trio.process import Process
from trio.run_folder import RunFolder
process = Process("one", ["sleep", "1000"], RunFolder({str(self.folder.path)!r}))
process.start()
time.sleep(1000)
"""
        supervisor = subprocess.Popen([sys.executable, "-c", program])
        self.addCleanup(supervisor.wait)
        self.addCleanup(supervisor.kill)
        self.assertTrue(wait_until(lambda: self.folder.read_pid("one")))
        pid = self.folder.read_pid("one")
        # setpriv has asked for the signal when sleep runs.
        self.assertTrue(wait_until(lambda: os.readlink(f"/proc/{pid}/exe").endswith(("sleep", "coreutils"))))
        supervisor.kill()
        self.assertTrue(wait_until(lambda: process_is_gone(pid)))


if __name__ == "__main__":
    unittest.main()
