"""What the processes say about themselves on the bus, through kintsugi-status."""

import csv
import os
import signal
import subprocess
import time

from .messages import Problem, say
from .process import spawn
from .programs import program

NO_PROGRESS = 2  # exit code of kintsugi-status
FAILED = 1


class Status:
    """Shows the progress of a run to the person and records each status in `csv_file`; answers questions
    about the processes."""

    def __init__(self, csv_file, map_name=None, csv_period_s=0):
        """`map_name`: of the map of the run; None: the one that is heard first. `csv_period_s`: between the recorded
        statuses of a process; 0: all are recorded."""
        self._csv_file = csv_file
        self._csv_period_s = csv_period_s
        self._of_map = [f"--map-name={map_name}"] if map_name else []
        self._csv_start = os.path.getsize(csv_file) if csv_file and os.path.exists(csv_file) else 0
        self._records = True
        self._display = None
        self._idle_s = 0  # of the display

    def show_progress(self, idle_s):
        """Until mapper, segmenter and viewer have finished, or there has been no progress for `idle_s` seconds."""
        self.end()
        self._idle_s = idle_s
        log = ["--log", self._csv_file, f"--log-every={self._csv_period_s}"] if self._records else []
        self._display = spawn([program("status"), "--until-finished", "--viewer", "--timeout", str(idle_s), *self._of_map,
                               *log])

    @property
    def shows_progress(self):
        return self._display is not None and self._display.poll() is None

    def take_result(self):
        """When the display has ended: True if all have finished, False if there was no progress for too long. None
        at other times. If the statuses cannot be recorded the display goes on without recording, and if it was killed it
        begins again."""
        if self._display is None or self.shows_progress:
            return None
        code = self._display.returncode
        self._display = None
        if code == FAILED and not self._records:
            raise Problem("kintsugi-status cannot watch the run, see the message above")
        if code == FAILED:
            say(f"{self._csv_file}: the statuses are no longer recorded, see the message above")
            self._records = False
        if code not in (0, NO_PROGRESS):
            self.show_progress(self._idle_s)
            return None
        return code == 0

    def end(self):
        if self.shows_progress:
            self._display.terminate()
            try:
                self._display.wait(2)
            except subprocess.TimeoutExpired:
                self._display.kill()
        self._display = None

    def last(self, process, field):
        """The newest value that was recorded in this run, as text; None without."""
        value = None
        try:
            with open(self._csv_file, encoding="utf-8", errors="replace", newline="") as file:
                file.seek(self._csv_start)
                for row in csv.reader(file):
                    if row[1:3] == [process, field] and len(row) > 3:
                        value = row[3]
        except (OSError, csv.Error):
            pass
        return value

    def has_finished(self, process):
        """Whether its newest status that was recorded in this run says so."""
        return self.last(process, "finished") == "1"

    def mapper_has_finished(self):
        return self.has_finished("mapper") or self.hears_lingering_mapper(2)

    def hears_lingering_mapper(self, timeout_s, give_up=lambda: False):
        """Waits until the mapper has published everything and only answers requests."""
        return self._ask("--until-ready", "mapper", "--lingering", timeout_s=timeout_s, give_up=give_up)

    def hears(self, names, timeout_s, give_up=lambda: False):
        """Waits until each of the processes has been heard on the bus."""
        return self._ask("--until-ready", ",".join(names), timeout_s=timeout_s, give_up=give_up)

    def hears_end_of_map(self, timeout_s, give_up=lambda: False):
        """Waits until mapper and segmenter have finished."""
        return self._ask("--until-finished", timeout_s=timeout_s, give_up=give_up)

    def hears_end_of_detection(self, timeout_s, give_up=lambda: False):
        """Waits until the detector has examined the whole map."""
        return self._ask("--until-finished", "--detector", timeout_s=timeout_s, give_up=give_up)

    @classmethod
    def hears_mapper_of(cls, map_name, timeout_s):
        """Whether a mapper with this map name is heard on the bus."""
        return cls(None, map_name)._ask("--until-ready", "mapper", timeout_s=timeout_s)

    def _ask(self, *question, timeout_s, give_up=lambda: False):
        query = spawn([program("status"), *question, *self._of_map, "--timeout", str(timeout_s)],
                      stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        while query.poll() is None:
            if give_up():
                query.send_signal(signal.SIGTERM)
                query.wait()
                return False
            time.sleep(0.05)
        return query.returncode == 0
