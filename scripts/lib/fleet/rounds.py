"""Gives the tasks of a run to a scheduler until each has a result."""

import json
import signal
import time

from trio.messages import STDOUT, Problem, command_name, say, write
from trio.programs import ROOT

from .folder import write_json
from .task import lost

MAX_ROUNDS = 3  # a task whose worker was killed is done again
POLL_S = 1.0
TELL_S = 10.0  # between two lines about progress
TODO = "todo.json"
SIGNALS = (signal.SIGINT, signal.SIGTERM, signal.SIGHUP)


class Stopped(Exception):
    """By a signal."""


class Rounds:
    """`inputs` are those that this run has to do, of `folder`."""

    def __init__(self, folder, inputs, scheduler, timeout_s, cpus):
        self._folder = folder
        self._inputs = inputs
        self._scheduler = scheduler
        self._timeout_s = timeout_s
        self._cpus = cpus
        self._before = folder.results()
        self._told_s = 0.0
        self._told = None

    def run(self):
        """Returns whether all ended, and not by a signal. Afterwards each input has a result, unless stopped."""
        handlers = {number: signal.signal(number, stop_by_signal) for number in SIGNALS}
        left = self._inputs
        try:
            for number in range(MAX_ROUNDS):
                self._round(left)
                numbers = {given.name: place for place, given in enumerate(left, 1)}
                left = self._without_result()
                if not left:
                    return True
                if number + 1 < MAX_ROUNDS:
                    say(f"tasks without a result, because their workers were killed: {len(left)}; once more")
        except Stopped:
            ignore_signals()
            say("stopping; a second run goes on with what is missing")
            return False
        finally:
            ignore_signals()  # until the tasks have ended
            self._scheduler.stop()
            for number, handler in handlers.items():
                signal.signal(number, handler)
        for given in left:
            said = self._scheduler.last_words(numbers[given.name])
            reason = f"its worker ended {MAX_ROUNDS} times without a result"
            lost(self._folder, given, f"{reason}: {said}" if said else reason)
        return True

    def _round(self, inputs):
        write_json(self._folder.job_file(TODO), {"names": [given.name for given in inputs],
                                                 "timeout_s": self._timeout_s, "cpus": self._cpus})
        self._scheduler.start([f"{ROOT}/scripts/fleet", "task", str(self._folder.path)], len(inputs))
        start_s = time.monotonic()
        while self._scheduler.is_at_work():
            self.tell()
            time.sleep(min(POLL_S, 0.05 + 0.1 * (time.monotonic() - start_s)))  # a short round is not made longer
        self.tell(at_once=True)
        if problem := self._scheduler.problem():
            raise Problem(f"{self._scheduler.name}: {problem}")

    def with_result(self):
        """The inputs that have got a result in this run."""
        left = {given.name for given in self._without_result()}
        return [given for given in self._inputs if given.name not in left]

    def _without_result(self):
        now = self._folder.results()
        return [given for given in self._inputs
                if now.get(given.name, self._before.get(given.name)) == self._before.get(given.name)]

    def tell(self, at_once=False):
        """A line on standard output, when something has changed."""
        now_s = time.monotonic()
        if not at_once and now_s - self._told_s < TELL_S:
            return
        self._told_s = now_s
        done = len(self._inputs) - len(self._without_result())
        if done != self._told:
            self._told = done
            write(STDOUT, f"{command_name()}: {done} of {len(self._inputs)}\n")


def stop_by_signal(*_):
    raise Stopped


def ignore_signals():
    for number in SIGNALS:
        signal.signal(number, signal.SIG_IGN)


def todo(folder):
    """What the tasks of this round are: names, timeout_s, cpus."""
    return json.loads(folder.job_file(TODO).read_text(encoding="utf-8"))
