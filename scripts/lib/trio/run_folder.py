"""The folder of a run. One run at a time writes into it, an earlier run in it is kept, and it
remembers the options of its run for --resume."""

import contextlib
import fcntl
import os
import time
from pathlib import Path

from .durable import sync_file, sync_folder
from .messages import Problem, command_name, say

LOCK_TIMEOUT_S = 3.0  # the processes of a supervisor that was killed end soon

# What segmenter, viewer and detector make of a map, and what the processes of a replay say.
REPLAY_FILES = (
    "segments*.ply", "segments*.json", "segments*.csv", "final.png", "final.part*.png", "final_*.png", "map_final*.png",
    "segments_final*.png", "objects_final*.png", "snapshot_*.png", "highlight.png", "plots*.png", "timeline_*.png",
    "objects.json", "status.csv", "segmenter.log", "viewer.log", "detector.log", "player.log")
# All that a run writes, a replay too. Other files in the folder belong to the user.
RUN_FILES = (
    "mapper.lcm", "mapper.*.lcm", ".mapper.base.lcm", "segmenter.map", "segmenter.map.views", "run.lcm", "run.lcm.partial", "run.mp4",
    "trajectory.txt", "trajectory.part*.txt", "*.partial.*", "mapper.log", "logger.log", "completion.log", "trio.options",
    *REPLAY_FILES)
PROCESSES_WITH_PID_FILE = ("mapper", "segmenter", "viewer", "detector", "logger", "completion", "player")


class RunFolder:
    """`path` as the user gave it; the files in it are what RUN_FILES names."""

    def __init__(self, path):
        self.path = Path(path)
        self.lock_descriptor = None

    def file(self, name):
        return str(self.path / name)

    def has(self, name):
        """Whether the file exists and is not empty."""
        file = self.path / name
        return file.is_file() and file.stat().st_size > 0

    def create(self):
        self.path.mkdir(parents=True, exist_ok=True)

    def lock(self):
        """Locks the folder until this process and its children, which inherit `lock_descriptor`, have ended.
        Raises Problem if another run holds the lock. Again: does nothing."""
        if self.lock_descriptor is not None:
            return
        descriptor = os.open(self.file(".lock"), os.O_RDWR | os.O_CREAT, 0o666)
        deadline = time.monotonic() + LOCK_TIMEOUT_S
        while not try_lock(descriptor):
            if time.monotonic() > deadline:
                raise Problem(self._held_by(os.pread(descriptor, 32, 0)))
            time.sleep(0.1)
        self.lock_descriptor = descriptor
        with contextlib.suppress(OSError):  # on a full disk the message of _held_by lacks the number
            os.ftruncate(descriptor, 0)
            os.pwrite(descriptor, str(os.getpid()).encode(), 0)

    def lock_if_used(self):
        """lock(), if an earlier run has used the folder. Nothing is written in a new one."""
        if (self.path / ".lock").exists():
            self.lock()

    def _held_by(self, recorded):
        pid = int(recorded) if recorded.isdigit() else None
        left = {name: its_pid for name in PROCESSES_WITH_PID_FILE if is_alive(its_pid := self.read_pid(name))}
        if left and not is_alive(pid):
            names = ", ".join(f"{name} (pid {its_pid})" for name, its_pid in left.items())
            return f"processes of an earlier run still work in {self.path}: {names}; wait until they have ended"
        holder = f" (pid {pid})" if is_alive(pid) else ""
        return (f"another scripts/{command_name()} is at work in {self.path}{holder}; "
                "choose another folder with --out")

    def keep_earlier_run(self, durable=False):
        """Moves the files of a run that is there into earlier/DATE. `durable`: after a power cut, too, they are either
        here or there."""
        found = self._find(RUN_FILES)
        if not found:
            return
        date = time.strftime("%Y%m%d-%H%M%S", time.localtime(found[0].stat().st_mtime))
        kept = self.path / "earlier" / date
        while kept.exists():
            kept = kept.with_name(kept.name + "x")
        kept.mkdir(parents=True)
        for file in found:
            file.rename(kept / file.name)
        if durable:
            for folder in (kept, kept.parent, self.path):
                sync_folder(folder)
        say(f"{self.path} held an earlier run; it is now in {kept}")

    def remove_earlier_replay(self):
        """Removes what a replay writes. No log of messages is among it: the one that is to be played may lie here."""
        for file in self._find(REPLAY_FILES):
            file.unlink()

    def _find(self, patterns):
        """The files that match, each once."""
        return list(dict.fromkeys(file for pattern in patterns for file in sorted(self.path.glob(pattern))))

    def begin_run(self, arguments, durable=False):
        """Makes the folder that of a new run with these arguments. On a full disk the earlier run stays where it is.
        `durable`: a power cut finds the folder of the earlier run or of the new one, and not a new one with old files."""
        partial = self.path / "trio.options.partial"
        try:
            write_words(partial, [os.getcwd(), *arguments])
            if durable:
                sync_file(partial)
            self.keep_earlier_run(durable)
            partial.rename(self.path / "trio.options")
            if durable:
                for folder in (self.path, self.path.absolute().parent):  # it may be a new one
                    sync_folder(folder)
        except BaseException:
            partial.unlink(missing_ok=True)
            raise

    def recall_options(self):
        """What begin_run wrote: the folder in which the run was started, and its arguments."""
        if not self.has("trio.options"):
            raise Problem(f"{self.path} holds no run to go on with")
        started_in, *arguments = read_words(self.path / "trio.options")
        return started_in, arguments

    def write_pid(self, name, pid):
        """For people and tests; the run does not depend on it, so a full disk is no error."""
        with contextlib.suppress(OSError):
            (self.path / f"{name}.pid").write_text(f"{pid}\n", encoding="ascii")

    def read_pid(self, name):
        try:
            return int((self.path / f"{name}.pid").read_text(encoding="ascii"))
        except (OSError, ValueError):
            return None

    def remove_pid_files(self):
        for name in PROCESSES_WITH_PID_FILE:
            with contextlib.suppress(OSError):
                (self.path / f"{name}.pid").unlink()

    def is_disk_full(self):
        """Whether less than 1 MB is free, which is too little for most files of a run."""
        try:
            disk = os.statvfs(self.path)
        except OSError:
            return False
        return disk.f_bavail * disk.f_frsize < 1_000_000


def write_words(file, words):
    """Each with a zero byte at its end, because a word may hold any other one."""
    try:
        file.write_bytes(os.fsencode("".join(word + "\0" for word in words)))
    except OSError as error:  # write() does not name the file
        raise Problem(f"{file}: {error.strerror}") from error


def read_words(file):
    return os.fsdecode(file.read_bytes()).split("\0")[:-1]


def try_lock(descriptor):
    try:
        fcntl.flock(descriptor, fcntl.LOCK_EX | fcntl.LOCK_NB)
    except BlockingIOError:
        return False
    return True


def is_alive(pid):
    """Whether there is a process with this number; None: no."""
    if pid is None:
        return False
    try:
        os.kill(pid, 0)
    except ProcessLookupError:
        return False
    except PermissionError:
        pass
    return True
