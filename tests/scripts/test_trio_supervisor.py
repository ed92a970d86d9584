"""The rules of a run, with small processes in place of the real ones."""

import signal
import unittest
from unittest import mock

from trio_fakes import UNTIL_TERM, FolderTest, wait_until

from trio import status as status_module
from trio import supervisor as supervisor_module
from trio.status import Status
from trio.supervisor import IDLE_AFTER_ERROR_S, IDLE_S, Supervisor


class FakeStatus:
    """As though kintsugi-status heard a mapper that lingers; `results` are the ends of the display."""

    def __init__(self):
        self.results = []
        self.shown = []
        self.shows_progress = True
        self.lingers = True
        self.finished = []  # processes

    def show_progress(self, idle_s):
        self.shown.append(idle_s)

    def take_result(self):
        return self.results.pop(0) if self.results else None

    def has_finished(self, process):
        return process in self.finished

    def mapper_has_finished(self):
        return self.lingers

    def hears_lingering_mapper(self, timeout_s, give_up=lambda: False):
        return self.lingers

    def hears_end_of_detection(self, timeout_s, give_up=lambda: False):
        self.detector_awaited = wait_until(give_up)
        return self.detector_awaited

    def hears_end_of_map(self, timeout_s, give_up=lambda: False):
        return True

    def end(self):
        pass


class SupervisorTest(FolderTest):
    def setUp(self):
        super().setUp()
        self.status = FakeStatus()
        patch = mock.patch.object(supervisor_module, "PERIOD_S", 0.02)
        patch.start()
        self.addCleanup(patch.stop)

    def supervisor(self, *processes, logger=None, completion=None):
        supervisor = Supervisor(self.folder, self.status, list(processes), logger, completion)
        for process in [*processes[1:], processes[0]]:
            process.start()
        return supervisor

    def until_term(self, name):
        """Notes when it was told to end, and the order of ends."""
        note = f"echo {name} >>{self.folder.file('ends')}"
        return self.shell(name, f"trap '{note}; exit 0' TERM; echo up; while :; do sleep 0.02; done")

    def up(self, *processes):
        for process in processes:
            self.assertTrue(wait_until(lambda p=process: self.folder.has(p.name + ".log")))

    def once(self, name, first, then):
        """What it does at its first start, and at later ones."""
        mark = self.folder.file(name + ".was_there")
        return self.shell(name, f"if [ -e {mark} ]; then {then}; else touch {mark}; {first}; fi")

    def test_the_detector_finishes_before_the_segmenter_ends(self):
        mapper, segmenter = self.until_term("mapper"), self.until_term("segmenter")
        detector = self.shell("detector", f"sleep 0.3; echo detector >>{self.folder.file('ends')}")
        supervisor = self.supervisor(mapper, segmenter, detector, self.shell("viewer", "exit 0"))
        self.up(mapper, segmenter)
        self.assertTrue(supervisor.watch())
        self.assertEqual((self.folder.path / "ends").read_text().split(), ["detector", "segmenter", "mapper"])

    def test_the_run_ends_with_its_last_process_and_the_leader_ends_last(self):
        mapper, segmenter = self.until_term("mapper"), self.until_term("segmenter")
        done = self.folder.file("done")
        viewer = self.shell("viewer", f"until [ -e {done} ]; do sleep 0.02; done")
        supervisor = self.supervisor(mapper, segmenter, viewer)
        self.up(mapper, segmenter)
        (self.folder.path / "done").touch()
        self.assertTrue(supervisor.watch())
        self.assertEqual((self.folder.path / "ends").read_text().split(), ["segmenter", "mapper"])

    def test_what_a_signal_killed_is_started_again(self):
        viewer = self.once("viewer", "kill -KILL $$", "exit 0")
        self.assertTrue(self.supervisor(self.shell("mapper", UNTIL_TERM), viewer).watch())
        self.assertIn("viewer was killed (signal 9); starting it again", self.said)

    def test_a_restart_may_need_another_command(self):
        mapper = self.shell("mapper", "kill -KILL $$", restart_command=lambda: ["/bin/sh", "-c", "echo resumed"])
        done = self.folder.file("mapper.log")
        viewer = self.shell("viewer", f"until grep -q resumed {done}; do sleep 0.02; done")
        self.assertTrue(self.supervisor(mapper, viewer).watch())

    def test_what_dies_at_once_five_times_running_ends_the_run(self):
        viewer = self.shell("viewer", "echo start; kill -SEGV $$")
        self.assertFalse(self.supervisor(self.shell("mapper", UNTIL_TERM), viewer).watch())
        self.assertEqual((self.folder.path / "viewer.log").read_text().split().count("start"), 5)
        self.assertIn("viewer was ended by signal 11", self.said)

    def test_an_error_ends_the_run_with_its_last_words(self):
        mapper = self.shell("mapper", "echo no such device; exit 1")
        viewer = self.until_term("viewer")
        supervisor = self.supervisor(mapper, viewer)
        self.up(viewer)
        self.status.results = [None] * 20 + [False]  # the others do not get on without it
        self.assertFalse(supervisor.watch())
        self.assertIn("mapper ended with an error (exit code 1):", self.said)
        self.assertIn("  mapper: no such device\n", self.said)
        self.assertIn(IDLE_AFTER_ERROR_S, self.status.shown)
        self.assertEqual((self.folder.path / "ends").read_text().split(), ["viewer"])

    def test_nothing_is_started_again_after_a_request_to_stop(self):
        viewer = self.shell("viewer", "kill -KILL $$")
        supervisor = self.supervisor(self.shell("mapper", UNTIL_TERM), viewer)
        supervisor.request_stop()
        self.assertFalse(supervisor.watch())
        self.assertNotIn("starting it again", self.said)

    def test_one_request_stops_the_mapper_and_waits_for_the_viewer(self):
        self.status.lingers = False
        mapper = self.until_term("mapper")
        ends = self.folder.file("ends")
        viewer = self.shell("viewer", f"until grep -q mapper {ends}; do sleep 0.02; done")
        supervisor = self.supervisor(mapper, viewer)
        self.up(mapper)
        supervisor.request_stop()
        self.assertTrue(supervisor.watch())
        self.assertIn("Ctrl-C again: stop at once", self.said)

    def test_one_request_leaves_a_mapper_alone_that_only_lingers(self):
        mapper = self.until_term("mapper")
        viewer = self.shell("viewer", "sleep 0.2")
        supervisor = self.supervisor(mapper, viewer)
        self.up(mapper)
        supervisor.request_stop()
        mapper.tell_to_stop = mock.Mock()
        self.assertTrue(supervisor.watch())
        mapper.tell_to_stop.assert_not_called()

    def test_the_second_request_stops_the_viewer_too(self):
        mapper, viewer = self.until_term("mapper"), self.until_term("viewer")
        supervisor = self.supervisor(mapper, viewer)
        self.up(mapper, viewer)
        supervisor.request_stop()
        supervisor.request_stop()
        self.assertTrue(supervisor.watch())
        self.assertEqual((self.folder.path / "ends").read_text().split(), ["viewer", "mapper"])

    def test_where_nothing_leads_one_request_is_enough(self):
        segmenter, viewer = self.until_term("segmenter"), self.until_term("viewer")
        supervisor = self.supervisor(segmenter, viewer)
        self.up(segmenter, viewer)
        supervisor.request_stop()
        self.assertTrue(supervisor.watch())
        self.assertEqual((self.folder.path / "ends").read_text().split(), ["viewer", "segmenter"])

    def test_a_player_that_is_stopped_leaves_the_others_little_time(self):
        player, viewer = self.until_term("player"), self.until_term("viewer")
        supervisor = self.supervisor(player, viewer)
        self.up(player, viewer)
        self.status.results = [None, None, False]
        supervisor.request_stop()
        self.assertTrue(supervisor.watch())
        self.assertIn(IDLE_AFTER_ERROR_S, self.status.shown)
        self.assertEqual(supervisor.failures, [])

    def test_a_viewer_that_does_not_get_on_after_the_map_is_stopped_and_the_run_has_failed(self):
        for leader, requests in (("mapper", 0), ("mapper", 1), ("player", 0)):
            first, viewer = self.until_term(leader), self.until_term("viewer")
            supervisor = self.supervisor(first, viewer)
            self.up(first, viewer)
            self.status.results = [False]
            for _ in range(requests):
                supervisor.request_stop()
            self.assertFalse(supervisor.watch())
            self.said = ""
            supervisor.tell_failures()
            self.assertIn(f"the run is not complete: there was no progress for {IDLE_S} s", self.said)

    def test_who_has_finished_and_lingers_does_not_stand_still(self):
        mapper, segmenter = self.until_term("mapper"), self.until_term("segmenter")
        for processes, finished in (([mapper], []), ([mapper, segmenter], ["segmenter"])):
            supervisor = self.supervisor(*processes)
            self.up(*processes)
            self.status.results, self.status.finished = [False], finished
            self.assertTrue(supervisor.watch())
            self.assertEqual(supervisor.failures, [])

    def test_an_error_is_the_reason_why_the_others_stand_still(self):
        viewer = self.until_term("viewer")
        supervisor = self.supervisor(self.shell("mapper", "exit 1"), viewer)
        self.up(viewer)
        self.status.results = [None] * 20 + [False]
        self.assertFalse(supervisor.watch())
        self.assertEqual(len(supervisor.failures), 1)

    def test_a_silent_camera_may_come_back(self):
        self.status.lingers = False
        mapper = self.until_term("mapper")
        came = self.folder.path / "came"
        viewer = self.shell("viewer", f"until [ -e {came} ]; do sleep 0.02; done")
        supervisor = self.supervisor(mapper, viewer)
        self.up(mapper)
        self.status.results = [False]
        show = self.status.show_progress = mock.Mock(side_effect=lambda _: show.call_count == 2 and came.touch())
        self.assertTrue(supervisor.watch())
        self.assertEqual(show.call_count, 2)

    def test_one_that_is_killed_while_it_is_closed_finishes_first(self):
        segmenter = self.once("segmenter", "kill -KILL $$", "echo finished; " + UNTIL_TERM)
        supervisor = self.supervisor(self.shell("mapper", UNTIL_TERM), segmenter)
        self.assertTrue(wait_until(lambda: not segmenter.running))
        self.status.hears_end_of_map = mock.Mock(side_effect=lambda *_, **__: self.up(segmenter))
        supervisor.close(segmenter)
        self.status.hears_end_of_map.assert_called_once()
        self.assertFalse(supervisor.failed)

    def test_a_run_whose_logger_ended_goes_on_but_is_no_success(self):
        logger = self.shell("logger", "echo no space; exit 1")
        viewer = self.shell("viewer", "sleep 0.3")
        supervisor = self.supervisor(self.shell("mapper", UNTIL_TERM), viewer, logger=logger)
        logger.start()
        self.assertTrue(wait_until(lambda: not logger.running))
        self.assertFalse(supervisor.watch())
        self.assertIn("lcm-logger ended early (exit code 1)", self.said)
        self.assertIn("  logger: no space", self.said)

    def test_nothing_is_requested_for_a_log_that_nobody_writes(self):
        logger, completion = self.shell("logger", "exit 1"), self.until_term("completion")
        viewer = self.shell("viewer", "sleep 0.5")
        supervisor = self.supervisor(self.shell("mapper", UNTIL_TERM), viewer, logger=logger, completion=completion)
        completion.start()
        self.up(completion)
        logger.start()
        self.assertFalse(supervisor.watch())
        self.assertFalse(completion.running)
        self.assertFalse(self.folder.has("ends"))  # it was killed at once
        self.assertNotIn("kintsugi-complete-log", self.said)

    def test_the_log_is_completed_before_those_end_that_send_again(self):
        mapper, segmenter, completion = (self.until_term(name) for name in ("mapper", "segmenter", "completion"))
        supervisor = self.supervisor(mapper, segmenter, self.shell("viewer", "sleep 0.2"), completion=completion)
        completion.start()
        self.up(mapper, segmenter, completion)
        self.assertTrue(supervisor.watch())
        with open(self.folder.file("ends"), encoding="utf-8") as ends:
            self.assertEqual(ends.read().split(), ["completion", "segmenter", "mapper"])

    def test_a_log_that_is_not_whole_is_told_and_no_failure(self):
        completion = self.shell("completion", "trap 'echo kintsugi-complete-log: lacks 3; exit 2' TERM; echo up; "
                                "while :; do sleep 0.02; done")
        supervisor = self.supervisor(self.shell("mapper", UNTIL_TERM), self.shell("viewer", "sleep 0.2"),
                                     completion=completion)
        completion.start()
        self.up(completion)
        self.assertTrue(supervisor.watch())
        supervisor.tell_failures()
        self.assertIn("run.lcm is not whole: kintsugi-complete-log: lacks 3", self.said)

    def test_a_run_goes_on_without_who_completes_its_log(self):
        completion = self.shell("completion", "echo no bus; exit 1")
        viewer = self.shell("viewer", "sleep 0.3")
        supervisor = self.supervisor(self.shell("mapper", UNTIL_TERM), viewer, completion=completion)
        completion.start()
        self.assertTrue(wait_until(lambda: not completion.running))
        self.assertTrue(supervisor.watch())
        self.assertIn("kintsugi-complete-log ended early (exit code 1)", self.said)
        self.assertIn("  completion: no bus", self.said)

    def test_who_completes_the_log_does_not_delay_a_stop_at_once(self):
        completion = self.shell("completion", "trap '' TERM; echo up; while :; do sleep 0.02; done")
        mapper, viewer = self.until_term("mapper"), self.until_term("viewer")
        supervisor = self.supervisor(mapper, viewer, completion=completion)
        completion.start()
        self.up(mapper, viewer, completion)
        supervisor.request_stop()
        supervisor.request_stop()
        self.assertTrue(supervisor.watch())
        self.assertFalse(completion.running)

    def test_failures_and_what_to_do_are_told_again(self):
        viewer = self.shell("viewer", "echo kintsugi-viewer: no space; echo bye; exit 1")
        supervisor = self.supervisor(self.shell("mapper", UNTIL_TERM), viewer)
        self.folder.is_disk_full = lambda: True
        self.assertFalse(supervisor.watch())
        self.said = ""
        supervisor.tell_failures()
        first, second = self.said.splitlines()
        self.assertIn("viewer ended with an error (exit code 1): kintsugi-viewer: no space", first)
        self.assertIn("scripts/trio --resume --out", second)

    def test_a_replay_on_a_full_disk_is_not_to_be_resumed(self):
        self.folder.is_disk_full = lambda: True
        supervisor = self.supervisor(self.shell("player", UNTIL_TERM), self.shell("viewer", "exit 1"))
        self.assertFalse(supervisor.watch())
        self.assertIn("when there is space, play the log again", self.said)
        self.assertNotIn("--resume", self.said)

    def test_a_full_disk_is_told_once(self):
        viewer = self.shell("viewer", "sleep 0.3")
        supervisor = self.supervisor(self.shell("mapper", UNTIL_TERM), viewer)
        self.folder.is_disk_full = lambda: True
        self.assertTrue(supervisor.watch())
        self.assertEqual(self.said.count(f"{self.folder.path}: no space left on device"), 1)

    def test_end_stops_all_and_removes_the_pid_files(self):
        processes = [self.until_term(name) for name in ("mapper", "viewer")]
        supervisor = self.supervisor(*processes)
        self.up(*processes)
        supervisor.end()
        self.assertFalse(any(process.running for process in processes))
        self.assertIsNone(self.folder.read_pid("mapper"))


class StatusTest(FolderTest):
    def status_of(self, script):
        """A Status whose kintsugi-status is a script of the shell."""
        patch = mock.patch.object(status_module, "spawn", lambda command, **arguments: spawn_shell(script, command))
        patch.start()
        self.addCleanup(patch.stop)
        status = Status(self.folder.file("status.csv"))
        self.addCleanup(status.end)
        return status

    def result(self, status):
        status.show_progress(7)
        self.assertTrue(wait_until(lambda: not status.shows_progress))
        return status.take_result()

    def test_the_display_tells_whether_all_have_finished(self):
        self.assertIs(self.result(self.status_of("exit 0")), True)
        self.assertIs(self.result(self.status_of("exit 2")), False)

    def test_a_result_is_told_once(self):
        status = self.status_of("exit 0")
        self.result(status)
        self.assertIsNone(status.take_result())

    def test_statuses_that_cannot_be_recorded_are_shown_all_the_same(self):
        calls = self.folder.path / "calls"
        status = self.status_of(f'echo "$*" >>{calls}; case "$*" in *--log*) exit 1 ;; *) exit 0 ;; esac')
        self.assertIsNone(self.result(status))
        self.assertIn("status.csv: the statuses are no longer recorded", self.said)
        self.assertTrue(wait_until(lambda: not status.shows_progress))
        self.assertIs(status.take_result(), True)
        for call in calls.read_text().splitlines():
            self.assertIn("--timeout 7", call)

    def test_a_display_that_was_killed_begins_again_and_tells_nothing(self):
        mark = self.folder.path / "was_here"
        status = self.status_of(f"[ -e {mark} ] && exit 0; touch {mark}; kill -KILL $$")
        self.assertIsNone(self.result(status))
        self.assertTrue(wait_until(lambda: not status.shows_progress))
        self.assertIs(status.take_result(), True)

    def test_the_newest_value_of_this_run_counts(self):
        file = self.folder.path / "status.csv"
        file.write_text("utime_us,process,field,value\n1,mapper,finished,1\n")
        status = Status(str(file))
        self.assertIsNone(status.last("mapper", "finished"))
        with file.open("a") as more:
            more.write('2,mapper,finished,1\n3,mapper,finished,0\n4,segmenter,finished,1\n5,mapper,device,"a ""b"""\n')
        self.assertEqual(status.last("mapper", "finished"), "0")
        self.assertEqual(status.last("mapper", "device"), 'a "b"')

    def test_a_question_may_be_given_up(self):
        status = self.status_of("exec sleep 1000")
        self.assertFalse(status.hears(["viewer"], 1000, give_up=lambda: True))


def spawn_shell(script, command):
    return status_module.subprocess.Popen(["/bin/sh", "-c", script, *command])


if __name__ == "__main__":
    unittest.main()
