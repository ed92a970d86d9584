"""One process of a run."""

import os
import re
import signal
import subprocess
import time

from .messages import STDERR, os_error_text, say, write

LAST_LINES = 5
ERROR_LEVEL = re.compile(r"\[(error|critical)\]|\b([Ee]rror|critical): ")  # as in the logs of the processes
QUICK_DEATH_S = 2.0  # a process that a signal killed within this time of its start ...
MAX_QUICK_DEATHS = 5  # ... so many times running is not started again
CLOCK_TICKS_PER_S = os.sysconf("SC_CLK_TCK")


def spawn(command, death_signal="TERM", **arguments):
    """Starts a command that gets `death_signal` when this process dies, and is in a session of its own,
    so that Ctrl-C in the terminal reaches only this process."""
    return subprocess.Popen(["setpriv", "--pdeathsig", death_signal, *command], stdin=subprocess.DEVNULL,
                            start_new_session=True, **arguments)


class Process:
    """A process of the run in `folder` (a RunFolder): its log is NAME.log there, its number NAME.pid.

    `restart_command` returns the command for the next start after the first; None: the same again.
    """

    def __init__(self, name, command, folder, restart_command=None, death_signal="TERM"):
        self.name = name
        self.command = command
        self.cpu_s = None  # None: it never ran
        self.peak_memory_MB = None
        self.killed = False  # by stop(), because it did not end in time
        self.told_to_stop = False
        self._folder = folder
        self._restart_command = restart_command or (lambda: command)
        self._death_signal = death_signal
        self._popen = None
        self._start_s = 0.0
        self._log_start = None  # where in its log this run begins
        self._quick_deaths = 0
        self._earlier_cpu_s = 0.0  # of those that this one replaced

    @property
    def log_file(self):
        return self._folder.file(self.name + ".log")

    @property
    def pid(self):
        return self._popen.pid if self._popen else None

    @property
    def started(self):
        """From start() until take_exit_code() has returned its exit code."""
        return self._popen is not None

    @property
    def running(self):
        return self._popen is not None and self._popen.poll() is None

    def start(self):
        self.killed = self.told_to_stop = False
        self._start_s = time.monotonic()
        log = self._open_log()
        lock = self._folder.lock_descriptor
        try:
            self._popen = spawn(self.command, self._death_signal, stdout=log, stderr=subprocess.STDOUT,
                                pass_fds=() if lock is None else (lock,))
        finally:
            if log != subprocess.DEVNULL:
                log.close()
        self._folder.write_pid(self.name, self.pid)

    def restart(self):
        self._earlier_cpu_s = self.cpu_s or 0.0
        self.command = self._restart_command()
        self.start()

    def send(self, signal_number):
        if self.running:
            self._popen.send_signal(signal_number)

    def tell_to_stop(self):
        """Sends SIGTERM once: a mapper that is told twice leaves out what it has not published yet."""
        if not self.told_to_stop:
            self.told_to_stop = True
            self.send(signal.SIGTERM)

    def take_exit_code(self):
        """None while it runs. Once it has ended: its exit code, or the negative number of the signal that killed
        it; from then on the process counts as not started."""
        if not self.started or self.running:
            return None
        code = self._popen.returncode
        self._popen = None
        return code

    def may_restart(self):
        """Whether it has not died too often soon after its start. To be asked once after each death."""
        quick = time.monotonic() - self._start_s < QUICK_DEATH_S
        self._quick_deaths = self._quick_deaths + 1 if quick else 0
        return self._quick_deaths < MAX_QUICK_DEATHS

    def measure(self):
        """Notes CPU time and memory from /proc while it runs."""
        if not self.started:
            return
        try:
            with open(f"/proc/{self.pid}/stat", encoding="utf-8", errors="replace") as file:
                fields = file.read().rpartition(") ")[2].split()  # the name before may hold blanks
            with open(f"/proc/{self.pid}/status", encoding="utf-8", errors="replace") as file:
                peaks_kB = [int(line.split()[1]) for line in file if line.startswith("VmHWM:")]
        except OSError:
            return
        self.cpu_s = self._earlier_cpu_s + (int(fields[11]) + int(fields[12])) / CLOCK_TICKS_PER_S
        for peak_kB in peaks_kB:
            self.peak_memory_MB = max(self.peak_memory_MB or 0, peak_kB // 1000)

    def show_last_words(self):
        """The end of its log, on standard error."""
        words = self._words()
        for line in words[-LAST_LINES:]:
            write(STDERR, f"  {self.name}: {line}\n")
        if not words:
            write(STDERR, f"  nothing is in its log, {self.log_file}\n")
        if self._folder.is_disk_full():
            write(STDERR, f"  {self.name}: its log may lack what it said: no space left on device\n")

    def reason(self):
        """[the last line of its log that tells an error], or [the last one]; [] if nothing is in it."""
        words = self._words()
        errors = [line for line in words if line.startswith("kintsugi-") or ERROR_LEVEL.search(line)]
        if not errors and self._folder.is_disk_full():
            return ["no space left on device, not even for the reason in its log"]
        return (errors or words)[-1:]

    def _words(self):
        """The last lines of its log, of this run only: one that is resumed goes on in the same log."""
        return [] if self._log_start is None else last_lines(self.log_file, self._log_start)

    def has_said(self, text):
        """Whether the text is in its log, since its first start here."""
        try:
            with open(self.log_file, "rb") as file:
                file.seek(self._log_start or 0)
                return text.encode() in file.read()
        except OSError:
            return False

    def _open_log(self):
        try:
            log = open(self.log_file, "ab")
            self._log_start = log.tell() if self._log_start is None else self._log_start
            return log
        except OSError as error:
            say(f"{os_error_text(error)}; what the {self.name} says is lost")
            return subprocess.DEVNULL


def last_lines(path, start=0):
    """Of the last 10 kB of a file, after its first `start` bytes."""
    try:
        with open(path, "rb") as file:
            size = file.seek(0, os.SEEK_END)
            file.seek(max(start, size - 10_000))
            return file.read().decode(errors="replace").splitlines()
    except OSError:
        return []


def stop(processes, signal_number, timeout_s):
    """Sends a signal to those that run and waits for their end. Kills those that do not end in time; returns
    whether all ended by themselves."""
    for process in processes:
        process.send(signal_number)
    deadline = time.monotonic() + timeout_s
    for process in processes:
        while process.running and time.monotonic() < deadline:
            process.measure()
            time.sleep(0.05)
        if process.running:
            say(f"{process.name} did not stop within {timeout_s:g} s; killing it")
            process.killed = True
            process.send(signal.SIGKILL)
    return not any(process.killed for process in processes)
