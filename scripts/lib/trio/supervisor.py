"""The rules of a run: what is started again, what ends it, and in which order the processes end."""

import signal
import time

from .messages import say
from .process import stop

PERIOD_S = 0.2
IDLE_S = 60  # no progress for so long: the rest of the map will not come
IDLE_AFTER_ERROR_S = 5  # the same after an error, when the others may be unable to finish
DETECTOR_IDLE_S = 10  # no progress for so long: it does not get the rest of the map
STOP_TIMEOUT_S = 60
LEADING_PROCESSES = ("mapper", "player")


class Supervisor:
    """Watches the processes of a run. The first of `processes` is the leader, the mapper or the player of a
    log: it is stopped last, because the others ask it for what they miss. The last one, the viewer if there
    is one, knows when the run is complete: it exits by itself. `logger` records the bus, and `completion` requests
    what its log lacks; both may be None."""

    def __init__(self, folder, status, processes, logger=None, completion=None):
        self.folder = folder
        self.status = status
        self.processes = processes
        self.logger = logger
        self.completion = completion
        self.failed = False
        self.failures = []  # what has failed, and why
        self.advice = []  # what to do about them
        self.num_stop_requests = 0
        self._disk_was_full = False

    @property
    def leader(self):
        return self.processes[0]

    @property
    def last(self):
        return self.processes[-1]

    def install_signal_handlers(self):
        """For Ctrl-C, SIGTERM, and SIGHUP (the terminal was closed). A signal that was ignored from the start, as
        with nohup, remains ignored."""
        for number in (signal.SIGINT, signal.SIGTERM, signal.SIGHUP):
            if signal.getsignal(number) != signal.SIG_IGN:
                signal.signal(number, lambda *_: self.request_stop())

    def request_stop(self):
        """The first request finishes the map so far; the second stops at once, and so does the first if neither a
        mapper nor a player runs here."""
        self.num_stop_requests += 1 if self.leader.name in LEADING_PROCESSES else 2

    def watch(self):
        """Until the run is complete and all its processes have ended. Returns whether all went well."""
        self.status.show_progress(IDLE_S)
        stop_announced = False
        while self.last.started:
            time.sleep(PERIOD_S)
            self._note_disk()
            self._check_logger()
            for process in self.processes:
                process.measure()
                self._check(process)
            if not self.last.started:
                break
            if self.num_stop_requests and not stop_announced:
                stop_announced = True
                self._begin_to_stop()
            if self.num_stop_requests > 1:
                self._stop(self.last)
            elif self._stands_still():
                self._note_standstill()
                self._stop(self.last)
        self._complete_log()
        for process in reversed(self.processes):  # each asks those before it for what it misses
            self.close(process)
        self.status.end()
        return not self.failed

    def end(self):
        """Ends what still runs, for example after an exception, within 10 s."""
        self.status.end()
        processes = [process for process in (*self.processes, self.logger, self.completion) if process]
        stop(processes, signal.SIGTERM, 10)
        self.folder.remove_pid_files()

    def tell_failures(self):
        """Again, and last, where it is seen."""
        for text in self.failures + self.advice:
            say(text)

    def _check(self, process):
        """If the process has ended: starts it again if it was killed by a signal, unless it dies soon after each
        start; ends the run if there was an error."""
        killed_here = process.killed
        code = process.take_exit_code()
        if code in (None, 0, -signal.SIGTERM) or killed_here:
            return
        if code < 0 and not self.num_stop_requests and process.may_restart():
            say(f"{process.name} was killed (signal {-code}); starting it again")
            process.restart()
            return
        self.failed = True
        self.num_stop_requests = max(1, self.num_stop_requests)
        how = f"was ended by signal {-code}" if code < 0 else f"ended with an error (exit code {code})"
        say(f"{process.name} {how}:")
        process.show_last_words()
        self.failures.append(": ".join([f"{process.name} {how}", *process.reason()]))
        if self.folder.is_disk_full():
            self.advice = [f"{self.folder.path}: no space left on device; when there is space, {self._how_to_go_on()}"]
            say(*self.advice)
        self.status.show_progress(IDLE_AFTER_ERROR_S)

    def _how_to_go_on(self):
        if self.leader.name == "player":
            return "play the log again"
        return f"scripts/trio --resume --out {self.folder.path} goes on with the run"

    def _check_logger(self):
        """Without the logger the run goes on, but it has failed. Without who completes its log, it only goes on."""
        code = self.logger.take_exit_code() if self.logger else None
        if code is not None:
            self.failed = True
            say(f"lcm-logger ended early (exit code {code}); run.lcm lacks what is on the bus from now on:")
            self.logger.show_last_words()
            self._end_completion(signal.SIGKILL)  # nobody would record what it requests
        code = self.completion.take_exit_code() if self.completion else None
        if code is not None:
            say(f"kintsugi-complete-log ended early (exit code {code}); run.lcm lacks what lcm-logger misses from now on:")
            self.completion.show_last_words()

    def _complete_log(self):
        """While those still run that send again what the log lacks. A log that lacks something, since who has sent it
        has ended, is no failure of the run, but told."""
        if self.num_stop_requests > 1:
            self._end_completion(signal.SIGKILL)
        elif self._end_completion(signal.SIGTERM) not in (None, 0):
            self.advice += [f"run.lcm is not whole: {reason}" for reason in self.completion.reason()]

    def _end_completion(self, signal_number):
        """It writes nothing, so that it can be killed. Returns its exit code; None: it does not run."""
        if not self.completion:
            return None
        stop([self.completion], signal_number, STOP_TIMEOUT_S)
        return self.completion.take_exit_code()

    def _note_disk(self):
        is_full = self.folder.is_disk_full()
        if is_full and not self._disk_was_full:
            say(f"{self.folder.path}: no space left on device; status.csv and the logs may be incomplete, the map and "
                "the pictures are written when there is space")
        self._disk_was_full = is_full

    def _begin_to_stop(self):
        say("stopping; the map so far is published, segmented, drawn and written (Ctrl-C again: stop at once)")
        if self.leader.name == "player":  # nobody completes the map of a log that was not played to its end
            self.leader.tell_to_stop()
            self.status.show_progress(IDLE_AFTER_ERROR_S)
        elif self.leader.name == "mapper" and self.status.shows_progress and not self._mapper_lingers():
            self.leader.tell_to_stop()

    def _mapper_lingers(self):
        """Asked on the bus: what is recorded may be old, and a mapper that lingers would end when it is told to stop."""
        return self.status.hears_lingering_mapper(2, give_up=lambda: self.num_stop_requests > 1)

    def _stands_still(self):
        """Whether the last process makes no progress any more although no more of the map will come. While the
        mapper waits for a silent camera, more may come."""
        result = self.status.take_result()
        if result is None or result:
            return False
        if not self.leader.running or self.status.mapper_has_finished():
            return True
        self.status.show_progress(IDLE_S)
        return False

    def _note_standstill(self):
        """The run has failed, unless its last process has finished and only lingers, or why it stands still is known:
        something ended with an error, or the log was not played to its end."""
        has_finished = self.last.name == "mapper" or self.status.has_finished(self.last.name)
        is_cut_short = self.num_stop_requests and self.leader.name == "player"
        if has_finished or is_cut_short or self.failures:
            return
        self.failed = True
        self.failures.append(f"the run is not complete: there was no progress for {IDLE_S} s; the map and its pictures may "
                             "lack something")
        say(self.failures[-1])

    def _stop(self, process):
        if not stop([process], signal.SIGTERM, STOP_TIMEOUT_S):
            self.failed = True

    def close(self, process):
        """Stops a process that has nothing left to do. If somebody kills it at this moment, it is started again
        and finishes first."""
        while process.started:
            if process.name == "mapper":
                self._let_mapper_finish(process)
            if process.name == "detector":
                self._let_detector_finish(process)
            self._stop(process)
            self._check(process)
            if process.running:
                self.status.hears_end_of_map(IDLE_S, give_up=lambda: not process.running)

    def _let_detector_finish(self, detector):
        """Waits until the detector has examined the whole map, unless all shall stop at once."""

        def give_up():
            return not detector.running or self.num_stop_requests > 1

        if not give_up():
            self.status.hears_end_of_detection(DETECTOR_IDLE_S, give_up=give_up)

    def _let_mapper_finish(self, mapper):
        """Waits until the mapper has published everything and only answers requests; one that still maps is
        stopped first."""
        if not mapper.running or self.status.hears_lingering_mapper(2):
            return
        mapper.tell_to_stop()
        self.status.hears_lingering_mapper(STOP_TIMEOUT_S, give_up=lambda: not mapper.running)
