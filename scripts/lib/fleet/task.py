"""One task: an input becomes a result, good or failed."""

import json
import os
import socket
import subprocess
import time
from pathlib import Path

from trio.messages import Problem
from trio.programs import program
from true_path import in_seconds

from . import measures, work
from .folder import DONE, ROW

MESSAGES = "messages.txt"


class StepFailed(Exception):
    def __init__(self, step, exit_code, reason):
        super().__init__(reason)
        self.step = step
        self.exit_code = exit_code


def do_task(folder, inputs, settings, name, timeout_s=0):
    """Works on the input of this name; the result is in the folder (a FleetFolder) then. That an input has failed is
    a result, too. A program may take `timeout_s` (0: as long as it takes)."""
    given = {each.name: each for each in inputs}[name]
    with folder.work_on(name) as here:
        task = Task(given, settings, here, timeout_s)
        row = task.run()
        if not settings["maps"]:
            remove_maps(here)
        (here / ROW).write_text(json.dumps(row, indent=1) + "\n", encoding="utf-8")
    return row


def remove_maps(here):
    for pattern in work.MAPS:
        for file in here.glob(pattern):
            file.unlink()


class Task:
    """`here` is the folder in which the programs run and write."""

    def __init__(self, given, settings, here, timeout_s=0):
        self.timeout_s = timeout_s
        self.given = given
        self.settings = settings
        self.here = here
        self.log = here / MESSAGES
        self.row = {"name": given.name, "input": given.device, "host": socket.gethostname(),
                    "started": time.strftime("%Y-%m-%dT%H:%M:%SZ", time.gmtime()), "started_s": round(time.time(), 3),
                    "wall_s": 0.0, "cpu_s": 0.0, "peak_memory_MB": 0.0}

    def run(self):
        """The row of the table."""
        start_s = time.monotonic()
        try:
            kind = work.kind_of(self.given)
            self.row["kind"] = kind
            for step in work.steps_of(self.given, kind, self.settings):
                self._do(step)
            if kind == "recording":
                self.row.update(self._path_quality())
            self._measure()
            self.row.update(state=DONE, exit_code=0)
        except StepFailed as failed:
            self._fail(str(failed), failed.step, failed.exit_code)
        except Problem as problem:
            self._fail(str(problem))
        except (OSError, ValueError, KeyError, IndexError) as error:  # a file that a program wrote is not as expected
            self._fail(f"{type(error).__name__}: {error}")
        self.row["wall_s"] = round(time.monotonic() - start_s, 3)
        self.row["version"] = version()
        return self.row

    def _do(self, step):
        """Runs it, and adds what it takes."""
        with open(self.log, "a", encoding="utf-8", errors="surrogateescape") as log:
            log.write(f"$ {' '.join(map(str, step.command))}\n")
            begin = log.tell()
        usage = measures.run_program(step.command, self.here, self.log, self.timeout_s)
        self.row["cpu_s"] = round(self.row["cpu_s"] + usage.cpu_s, 3)
        self.row["peak_memory_MB"] = max(self.row["peak_memory_MB"], round(usage.peak_memory_MB, 1))
        if step.what != "quality":  # so that it does not matter whether the truth is known
            self.row["segmented_s"] = round(self.row.get("segmented_s", 0.0) + usage.wall_s, 3)
        if usage.exit_code or usage.timed_out:
            raise StepFailed(step.what, usage.exit_code,
                             measures.reason_of(usage, step.command, self.log, begin))

    def _measure(self):
        self.row.update(measures.segment_counts(self.here))
        self.row.update(measures.frame_counts(self.here / work.TIMINGS))
        self.row.update(measures.instance_quality(self.here / work.QUALITY))

    def _fail(self, reason, step=None, exit_code=None):
        self.row.update(state="failed", reason=reason)
        if step:
            self.row.update(step=step, exit_code=exit_code)
        try:
            self._measure()
        except (OSError, ValueError, KeyError, IndexError):
            pass  # what is there is not complete

    def _path_quality(self):
        """Of the camera's path, part by part of the map. Parts too short to be compared are left out."""
        truth = work.true_path_of(self.given)
        if not truth:
            return {}
        truth = in_seconds(Path(self.here, truth), self.here / "truth_in_seconds.txt")
        tables, failed = [], None
        for estimate in sorted(self.here.glob("trajectory*.txt")):
            table = self.here / f"errors_{estimate.stem}.csv"
            for with_motions in (True, False):
                try:
                    self._do(work.path_step(estimate.name, truth, table.name, with_motions))
                    tables.append(table)
                    break
                except StepFailed as error:
                    failed = error
        if failed and not tables:
            if self.given.path:
                raise failed
            self.row["reason"] = f"the path was not compared: {failed}"  # its truth was only found beside it
        return measures.path_quality(tables)


def version():
    """Of the programs."""
    done = subprocess.run([program("segmenter"), "--version"], stdin=subprocess.DEVNULL, capture_output=True, text=True,
                          check=False)
    return done.stdout.strip().rpartition(" ")[2]


def lost(folder, given, reason):
    """The result of an input whose tasks ended without one."""
    messages = folder.path / "work" / given.name / MESSAGES
    kept = messages.read_bytes() if messages.exists() else b""
    with folder.work_on(given.name) as here:
        (here / MESSAGES).write_bytes(kept)
        row = {"name": given.name, "input": given.device, "state": "failed", "reason": reason}
        (here / ROW).write_text(json.dumps(row, indent=1) + "\n", encoding="utf-8")


def use_processors(slot, cpus):
    """Keeps this task and its programs on processors of its own, on a machine where tasks have the slots 1, 2, ..."""
    allowed = sorted(os.sched_getaffinity(0))
    own = allowed[(slot - 1) * cpus:slot * cpus]
    if len(own) == cpus:  # with more tasks than processors the system shares them
        os.sched_setaffinity(0, own)


