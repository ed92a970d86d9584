"""What a program took, and what is in the files that it wrote."""

import csv
import json
import os
import re
import select
import signal
import subprocess
import time
from dataclasses import dataclass
from pathlib import Path

from trio.check import HINT
from trio.process import ERROR_LEVEL, last_lines, spawn

END_S = 10.0  # from SIGTERM to SIGKILL
LOCATED = ("tracking", "given")  # states of a frame that has a pose
CUT = 500  # characters of a reason


@dataclass(frozen=True)
class Usage:
    """exit_code is the negative number of the signal that killed the program."""

    exit_code: int
    wall_s: float
    cpu_s: float
    peak_memory_MB: float
    timed_out: bool = False


def run_program(command, folder, log, timeout_s):
    """Runs a command in `folder`, with its output behind that in `log` (a path). It is killed when this process
    dies. timeout_s 0: none."""
    start_s = time.monotonic()
    with open(log, "ab") as output:
        program = spawn([str(word) for word in command], "KILL", cwd=folder, stdout=output, stderr=subprocess.STDOUT)
    timed_out = bool(timeout_s) and not has_ended(program.pid, timeout_s)
    if timed_out:
        os.killpg(program.pid, signal.SIGTERM)
        if not has_ended(program.pid, END_S):
            os.killpg(program.pid, signal.SIGKILL)
    _, status, usage = os.wait4(program.pid, 0)
    program.returncode = os.waitstatus_to_exitcode(status)  # or it would be waited for again
    return Usage(program.returncode, time.monotonic() - start_s, usage.ru_utime + usage.ru_stime,
                 usage.ru_maxrss * 1024 / 1e6, timed_out)


def has_ended(pid, within_s):
    descriptor = os.pidfd_open(pid)
    try:
        poll = select.poll()
        poll.register(descriptor, select.POLLIN)
        return bool(poll.poll(1000 * within_s))
    finally:
        os.close(descriptor)


def reason_of(usage, command, log, start):
    """Why a program failed, in one line: what it said last, behind the first `start` bytes of the log."""
    name = os.path.basename(str(command[0]))
    if usage.timed_out:
        return f"{name} took longer than --timeout"
    if usage.exit_code < 0:
        number = -usage.exit_code
        names = {each.value: each.name for each in signal.Signals}
        hint = ": perhaps there was too little memory" if number == signal.SIGKILL else ""
        return f"{name} was killed by {names.get(number, f'signal {number}')}{hint}"
    lines = [line for line in last_lines(log, start) if line.strip() and HINT not in line]
    told = [line for line in lines if line.startswith("kintsugi-") or ERROR_LEVEL.search(line)] or lines
    if not told:
        return f"{name} ended with exit code {usage.exit_code}, without a word"
    return told[-1].strip().removeprefix(f"{name}: ")[:CUT]


def segment_counts(folder):
    """points, segments: of all parts of the map."""
    maps = [json.loads(file.read_text(encoding="utf-8")) for file in [*Path(folder).glob("segments.json"),
                                                                      *Path(folder).glob("segments.part*.json")]]
    if not maps:
        return {}
    return {"points": sum(each["num_points"] for each in maps),
            "segments": sum(each["num_segments"] for each in maps), "parts": len(maps)}


def frame_counts(timings):
    """frames, located: from what the mapper wrote about each frame."""
    if not os.path.exists(timings):
        return {}
    rows = read_csv(timings)
    return {"frames": len(rows), "located": sum(row["state"] in LOCATED for row in rows)}


def instance_quality(folder):
    """From quality.csv of kintsugi-evaluate."""
    file = Path(folder, "quality.csv")
    if not file.exists():
        return {}
    row = {name: float(text) for name, text in read_csv(file)[0].items() if is_number(text)}
    of_objects = ("object_iou", "objects_found", "objects") if row.get("objects") else ()  # there may be none
    return {name: row[name] for name in (*of_objects, "instance_iou", "achievable_accuracy", "undersegmentation_error")
            if name in row}


def path_quality(tables):
    """ate_m: root mean square over the parts of the map, each with the weight of its poses."""
    rows = [read_csv(table)[0] for table in tables]
    poses = sum(float(row["ate_m_pairs"]) for row in rows)
    if not poses:
        return {}
    return {"ate_m": (sum(float(row["ate_m_pairs"]) * float(row["ate_m_rmse"])**2 for row in rows) / poses)**0.5}


def is_number(text):
    return re.fullmatch(r"-?[0-9.]+(e[-+]?\d+)?", text) is not None


def read_csv(file):
    with open(file, newline="", encoding="utf-8") as lines:
        return list(csv.DictReader(lines))
