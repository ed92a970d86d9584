"""Tasks as job arrays of Slurm."""

import json
import re
import shlex
import shutil
import subprocess
import time

from trio.messages import Problem, say

from .folder import write_json

STOP_S = 60.0
JOBS = "slurm.json"  # ids of the arrays of the run, for a run that comes after this one was killed
ANSWER_S = 60.0


def answers():
    """Whether there is a controller that takes jobs."""
    return bool(shutil.which("sbatch")) and call("scontrol", "ping").returncode == 0


def call(*command):
    try:
        return subprocess.run(command, stdin=subprocess.DEVNULL, capture_output=True, text=True, check=False,
                              timeout=ANSWER_S)
    except subprocess.TimeoutExpired:
        return subprocess.CompletedProcess(command, 1, "", f"{command[0]} did not answer within {ANSWER_S:g} s")


class Slurm:
    name = "Slurm"

    def __init__(self, folder, jobs, cpus, words):
        """jobs 0: as many as Slurm starts; `words`: further options of sbatch."""
        if not answers():
            raise Problem("no controller of Slurm answers (scontrol ping); --scheduler parallel works without")
        self.workers = jobs
        self._folder = folder
        self._options = [f"--cpus-per-task={cpus}", "--job-name=kintsugi-fleet", *words]
        self._arrays = []  # (id, number before the first task)

    def start(self, task_command, count):
        """As of Local, without a slot. Arrays are as long as Slurm permits; with a limit of tasks at a time the next
        one begins when one has ended."""
        longest = longest_array()
        self._arrays = []
        for before in range(0, count, longest):
            limit = [f"%{self.workers}"] if self.workers else []
            after = [f"--dependency=afterany:{self._arrays[-1][0]}"] if self.workers and self._arrays else []
            number = f'"$(({before} + SLURM_ARRAY_TASK_ID))"'
            self._submit(f"--array={''.join(['1-', str(min(longest, count - before)), *limit])}", *after,
                         f"--wrap=exec {shlex.join(task_command)} {number}", before=before)

    def _submit(self, *words, before):
        folder = str(self._folder.path).replace("%", "%%")
        done = call("sbatch", "--parsable", f"--output={folder}/jobs/slurm-%A_%a.txt", *self._options, *words)
        if done.returncode:
            self.stop()
            raise Problem(f"sbatch: {done.stderr.strip().removeprefix('sbatch: ')}")
        self._arrays.append((done.stdout.strip().partition(";")[0], before))
        write_json(self._folder.job_file(JOBS), [array for array, _ in self._arrays])

    def is_at_work(self):
        return are_at_work([array for array, _ in self._arrays])

    def stop(self):
        """Ends the tasks, and waits until they have ended."""
        if not self._arrays:
            return
        call("scancel", *[array for array, _ in self._arrays])
        deadline = time.monotonic() + STOP_S
        while self.is_at_work():
            if time.monotonic() > deadline:
                say(f"the jobs {', '.join(array for array, _ in self._arrays)} of Slurm have not ended yet")
                return
            time.sleep(0.2)

    def last_words(self, number):
        """What a task said that has ended without a result, or Slurm of it."""
        for array, before in reversed(self._arrays):
            if number > before:
                return self._folder.last_line(f"slurm-{array}_{number - before}.txt")
        return ""

    def problem(self):
        return ""


def wait_for_earlier(folder, tell):
    """Waits for arrays of a run that was killed: they go on without it. Calls `tell` while it waits."""
    try:
        arrays = json.loads(folder.job_file(JOBS).read_text(encoding="utf-8"))
    except (OSError, ValueError):
        return
    if not shutil.which("squeue") or not are_at_work(arrays):
        return
    say(f"the tasks of an earlier run are still at work in Slurm ({', '.join(arrays)}): waiting for them; scancel ends "
        "them")
    while are_at_work(arrays):
        tell()
        time.sleep(1.0)


def are_at_work(arrays):
    """Whether tasks of these arrays wait or run. A controller that does not answer may be back soon: they do then."""
    if not arrays:
        return False
    done = call("squeue", "--noheader", "--format=%i", f"--jobs={','.join(arrays)}")
    if done.returncode:
        return "Invalid job id" not in done.stderr
    return bool(done.stdout.strip())


def longest_array():
    found = re.search(r"^MaxArraySize\s*=\s*(\d+)", call("scontrol", "show", "config").stdout, re.M)
    return max(1, int(found[1]) - 1) if found else 1000  # indices are smaller than it
