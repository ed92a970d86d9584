"""The folder of a fleet. It belongs to one list with one set of options; one run at a time works in it.

    fleet.json            the inputs and the options that it is of
    results/NAME/         of each input: row.json, messages.txt and what the programs wrote; appears as a whole
    work/NAME/            of a task that is at work, or was killed
    jobs/                 tasks that a run has to do, what they printed, earlier runs
    results.csv, report.html
"""

import contextlib
import json
import os
import shutil
from pathlib import Path

from trio.messages import Problem, os_error_text
from trio.run_folder import RunFolder, try_lock

from .inputs import Input

FLEET, ROW = "fleet.json", "row.json"
DONE = "done"
OUTPUTS = ("slurm-*.txt", "parallel-*.txt")


class FleetFolder:
    def __init__(self, path):
        self.path = Path(path).absolute()
        self._lock = RunFolder(path)

    @property
    def lock_descriptor(self):
        return self._lock.lock_descriptor

    def lock_if_used(self):
        """Raises Problem if another run is at work in it. Nothing is written into a new one."""
        self._lock.lock_if_used()

    def check_is_of(self, inputs, settings):
        """Raises Problem unless the folder is empty, or of these options and of this list or the beginning of it."""
        if not (self.path / FLEET).exists():
            others = sorted(set(os.listdir(self.path)) - {".lock"}) if self.path.is_dir() else []
            if others:
                raise Problem(f"{self.path} holds other files ({others[0]}, ...) and no fleet; choose a new folder "
                              "with --out", 2)
            return
        of_inputs, of_settings = self.recall()
        now = {given.name: given for given in inputs}
        for given in of_inputs:
            if now.get(given.name) != given:
                raise Problem(f"{self.path} is the folder of another list: {difference(given, now.get(given.name))}. "
                              "Go on with that list (inputs may be added to it), or choose another folder with --out",
                              2)
        changed = [key for key in settings if settings[key] != of_settings.get(key)]
        if changed:
            was, wanted = (shown(of[changed[0]]) for of in (of_settings, settings))
            raise Problem(f"{self.path} was begun with other options: {changed[0]} was {was}, and is {wanted} now. "
                          "Go on with the options that it has, or choose another folder with --out", 2)

    def begin(self, inputs, settings):
        """Creates and locks the folder, and remembers what it is of."""
        self.path.mkdir(parents=True, exist_ok=True)
        self._lock.lock()
        for name in ("results", "work", "jobs"):
            (self.path / name).mkdir(exist_ok=True)
        write_json(self.path / FLEET, {"settings": settings, "inputs": [given.as_json() for given in inputs]})

    def recall(self):
        """The inputs and the options that the folder is of."""
        file = self.path / FLEET
        try:
            text = json.loads(file.read_text(encoding="utf-8", errors="surrogateescape"))
            return [Input(**given) for given in text["inputs"]], text["settings"]
        except OSError as error:
            raise Problem(f"{self.path} is no folder of a fleet: {os_error_text(error)}", 2) from error
        except (ValueError, KeyError, TypeError) as error:
            raise Problem(f"{file} is damaged ({error}); choose another folder with --out") from error

    def recorded(self):
        """The inputs that it is of; none of a new one."""
        return self.recall()[0] if (self.path / FLEET).exists() else []

    def row(self, name):
        """The row of an input in the table, or None if there is no result."""
        try:
            return json.loads((self.path / "results" / name / ROW).read_text(encoding="utf-8"))
        except (OSError, ValueError):  # without its row a result is none
            return None

    def rows(self, inputs):
        """A row for each input: its result, or that it has none."""
        return [self.row(given.name) or {"name": given.name, "input": given.device, "state": "missing"}
                for given in inputs]

    def is_done(self, name):
        row = self.row(name)
        return row is not None and row["state"] == DONE

    def results(self):
        """A number for each result, another one when it is replaced."""
        with os.scandir(self.path / "results") as entries:
            return {entry.name: entry.inode() for entry in entries}

    @contextlib.contextmanager
    def work_on(self, name):
        """Yields a new folder for a task. When the block ends without an error it is the result of the input: all of
        it, in place of an earlier one. Raises Problem if another task is at work on the same input."""
        # Names do not begin with a dot.
        lock = os.open(self.path / "work" / f".{name}.lock", os.O_RDWR | os.O_CREAT, 0o666)
        try:
            if not try_lock(lock):
                raise Problem(f"{name}: another task is at work on it")
            work = self.path / "work" / name
            shutil.rmtree(work, ignore_errors=True)
            work.mkdir()
            yield work
            self._replace(name, work)
        finally:
            os.close(lock)

    def _replace(self, name, work):
        result, earlier = self.path / "results" / name, self.path / "work" / f".{name}.earlier"
        shutil.rmtree(earlier, ignore_errors=True)
        with contextlib.suppress(FileNotFoundError):
            result.rename(earlier)
        work.rename(result)
        shutil.rmtree(earlier, ignore_errors=True)

    def tidy(self):
        """Removes what tasks that have ended needed. Not while one is at work."""
        for file in (self.path / "work").glob(".*.lock"):
            file.unlink(missing_ok=True)
        self.remove_outputs(lambda file: not file.stat().st_size)

    def remove_outputs(self, which=lambda _: True):
        """Removes what tasks have printed, each into a file."""
        for pattern in OUTPUTS:
            for file in (self.path / "jobs").glob(pattern):
                if which(file):
                    file.unlink(missing_ok=True)

    def job_file(self, name):
        return self.path / "jobs" / name

    def last_line(self, name):
        """Of a file of the folder jobs; nothing if there is none."""
        file = self.job_file(name)
        lines = file.read_text(errors="replace").strip().splitlines() if file.exists() else []
        return lines[-1] if lines else ""

    def runs(self):
        """What earlier runs took, the newest last."""
        try:
            return json.loads(self.job_file("runs.json").read_text(encoding="utf-8"))
        except (OSError, ValueError):
            return []

    def add_run(self, run):
        write_json(self.job_file("runs.json"), [*self.runs(), run])


def difference(was, now):
    if now is None:
        return f"it has no input {was.name} ({was.device})"
    key = next(key for key, value in was.as_json().items() if value != now.as_json()[key])
    return f"{key} of {was.name} was {shown(was.as_json()[key])}, and is {shown(now.as_json()[key])} now"


def shown(value):
    text = " ".join(value) if isinstance(value, list) else str(value)
    return f"'{text}'" if text else "not given"


def write_text(file, text):
    """Beside, and renamed: a reader finds all of it or nothing."""
    partial = file.with_name(f"{file.name}.{os.getpid()}.partial")
    try:
        partial.write_text(text, encoding="utf-8", errors="surrogateescape")
        partial.replace(file)
    except OSError as error:  # write() does not name the file
        partial.unlink(missing_ok=True)
        raise Problem(f"{file}: {error.strerror}") from error


def write_json(file, value):
    write_text(file, json.dumps(value, indent=1) + "\n")
