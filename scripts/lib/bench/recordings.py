"""The section about recordings of any kind: how much of each was located, how well, and at what cost."""

from dataclasses import dataclass

from trio.messages import Problem, say

from .accuracy import LOCATED, error, parts_of, trajectory_errors
from .tables import fixed, markdown, read_csv


@dataclass(frozen=True)
class Outcome:
    """What the mapper made of an input."""

    frames: int
    located: int
    parts: int  # of the map
    longest_loss_s: float
    errors: dict  # as trajectory_errors() gives them
    cpu_ms: float  # a frame
    memory_MB: float  # the most


def recordings(run):
    header = ["recording", "frames", "located", "%", "parts", "longest loss, s", "ATE rmse, mm",
              "RPE over 1 s rmse, mm", "RPE over 1 s rmse, deg", "points", "CPU a frame, ms", "memory, MB"]
    rows, failures = [], []
    for source in run.recordings:
        try:
            name = f"recording_{source.name}"
            cloud = run.folder / f"{name}.ply"
            found = outcome(run, name, source, "--cloud", cloud)
            rows.append([source.name, *cells(found, num_points(cloud))])
        except Problem as problem:  # the others still count
            rows.append([source.name, None, "failed", *[None] * (len(header) - 3)])
            failures.append(f"`{source.name}` failed: {str(problem).splitlines()[-1]}\n")
            say(f"recording '{source.name}' failed: {problem}")
    return "\n".join([markdown(header, rows), *failures])


def outcome(run, name, source, *flags):
    """Maps the input; the files in the folder of the measurement are called NAME."""
    mapped = run.map_alone(name, source, *flags)
    rows = read_csv(mapped.timings)
    return Outcome(frames=len(rows), located=sum(row["state"] in LOCATED for row in rows), parts=len(parts_of(rows)),
                   longest_loss_s=longest_loss_s(rows), errors=trajectory_errors(run, mapped, source),
                   cpu_ms=mapped.cpu_ms,
                   memory_MB=max((float(row["memory_mb"]) for row in rows), default=0.0))


def cells(found, points):
    return [found.frames, found.located, fixed(100 * found.located / max(found.frames, 1), 1), found.parts,
            fixed(found.longest_loss_s, 2), error(found.errors, "ate_m_rmse", 1e3),
            error(found.errors, "rpe_m_rmse", 1e3), error(found.errors, "rpe_deg_rmse"), fixed(points, 0),
            fixed(found.cpu_ms, 1), fixed(found.memory_MB, 0)]


def longest_loss_s(rows):
    """From the first frame of a loss to the next that is located, or to the last of all."""
    longest_us, lost_since_us = 0, None
    for row in rows:
        utime = int(row["utime_us"])
        if lost_since_us is not None:
            longest_us = max(longest_us, utime - lost_since_us)
        if row["state"] in LOCATED:
            lost_since_us = None
        elif lost_since_us is None:
            lost_since_us = utime
    return 1e-6 * longest_us


def num_points(cloud):
    """From the header of a PLY file."""
    with open(cloud, "rb") as lines:
        for line in lines:
            if line.startswith(b"element vertex "):
                return int(line.split()[2])
    raise Problem(f"{cloud} is no PLY file with points")
