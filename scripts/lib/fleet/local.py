"""Tasks on this machine, through GNU parallel."""

import os
import shlex
import shutil
import signal
import subprocess
import sys

from trio.messages import Problem
from trio.process import spawn

from .folder import write_text

STOP_S = 10.0
TASK = "KINTSUGI_FLEET_TASK"  # in the environment of parallel: what the shell of a task does


class Local:
    name = "parallel"

    def __init__(self, folder, jobs, cpus, words):
        """`words`: further options of parallel."""
        if not shutil.which("parallel"):
            raise Problem("GNU parallel is not installed (apt-get install parallel), and Slurm does not answer or was "
                          "not chosen")
        self.workers = jobs or max(1, len(os.sched_getaffinity(0)) // cpus)
        self._folder = folder
        self._words = words
        self._parallel = None

    def start(self, task_command, count):
        """Starts tasks 1 to `count`: task_command with the number of the task and of its slot behind."""
        self._folder.remove_outputs()
        # exec: no shell between parallel and a task, which is killed when parallel dies.
        task = shlex.join(["exec", "setpriv", "--pdeathsig", "KILL", sys.executable, *task_command])
        output = shlex.quote(str(self._folder.job_file("parallel-")))
        environment = {key: value for key, value in os.environ.items() if key != "PARALLEL"}  # its default options
        # Not in the command of parallel, which would replace {} and the like in a path, too.
        environment[TASK] = f'{task} "$1" "$2" >{output}"$1".txt 2>&1'
        lock = self._folder.lock_descriptor
        numbers = self._folder.job_file("numbers.txt")
        write_text(numbers, "".join(f"{number}\n" for number in range(1, count + 1)))
        with open(self._folder.job_file("parallel.txt"), "wb") as log:
            # Without --ungroup the output of tasks would go through files; they have none.
            self._parallel = spawn(
                ["parallel", "--will-cite", "--ungroup", f"--jobs={self.workers}", *self._words,
                 f'exec /bin/sh -c "${TASK}" sh {{}} {{%}}', "::::", str(numbers)], "KILL", env=environment, stdout=log,
                stderr=subprocess.STDOUT, pass_fds=() if lock is None else (lock,))

    def is_at_work(self):
        return self._parallel is not None and self._parallel.poll() is None

    def stop(self):
        if not self.is_at_work():
            return
        os.killpg(self._parallel.pid, signal.SIGKILL)
        self._parallel.wait(STOP_S)

    def last_words(self, number):
        """What a task said that has ended without a result."""
        return self._folder.last_line(f"parallel-{number}.txt")

    def problem(self):
        """What parallel says when it could not start tasks."""
        if self._parallel is None or self._parallel.returncode != 255:  # others count failed tasks
            return ""
        return self._folder.job_file("parallel.txt").read_text(errors="replace").strip()
