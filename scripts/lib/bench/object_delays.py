"""How soon a live detector tells of objects, and what it costs: kintsugi-evaluate --detection-times on the logs of walks
through the kitchen."""

import json
import shutil
from dataclasses import dataclass
from statistics import mean, median

from .run import BENCH_PROGRAMS, SCRIPTS, room
from .tables import NOT_MEASURED, fixed

LIVE_RUNS = 3
# The detector asks the segmenter for views when the map has ended; nobody asks later.
PLAYED = """
"$0" "$1/mapper.lcm" "$1/run.lcm" --points="$2" &
"$3/trio" --only segmenter --objects "$4" --out "$5" --segmenter --linger=10 &
for each in 1 2; do
  wait -n || { kill $(jobs -p); exit 1; }
done
"""


@dataclass(frozen=True)
class Walk:
    delays_s: list  # of each detection
    cpu_share: float  # of a core, or None


def live_walks(run, library):
    """At the camera's rate, beside the mapper and the renderer of its images."""
    walks = []
    for number in range(1, LIVE_RUNS + 1):
        name = live_name(number)
        shutil.rmtree(run.folder / name, ignore_errors=True)
        run.trio(name, room("kitchen"), "--objects", str(library))
        walks.append(measured(run, name))
    return walks


def live_name(number):
    return f"live_objects_kitchen_{number}"


def walk_in_large_map(run, library, num_points):
    """The first of the live walks again, after floors far away."""
    name = "live_objects_large"
    shutil.rmtree(run.folder / name, ignore_errors=True)
    run.execute([f"{SCRIPTS}/private_bus", "bash", "-c", PLAYED, f"{BENCH_PROGRAMS}/bench_large_walk",
                 run.folder / live_name(1), num_points, SCRIPTS, library, name], name=f"{name}_messages")
    return measured(run, name)


def measured(run, name):
    """What the log of the bus tells. The exit code is 1 when the log lacks a chunk: then the last patch that it has may be an
    earlier one."""
    file = run.folder / f"{name}.json"
    file.unlink(missing_ok=True)
    run.kintsugi("evaluate", "--detection-times", run.folder / name / "run.lcm", "--json", file, may_fail=True)
    if not file.exists():
        return Walk([], None)
    told = json.loads(file.read_text())
    return Walk([each["delay_s"] for each in told["detections"]], told["cpu_share"])


def text(walks):
    """Median and 99th percentile over all."""
    delays_s = sorted(delay_s for walk in walks for delay_s in walk.delays_s)
    if not delays_s:
        return NOT_MEASURED
    nearly_all = delays_s[min(len(delays_s) - 1, int(0.99 * len(delays_s)))]
    return f"{fixed(median(delays_s), 2)} / {fixed(nearly_all, 2)}"


def percent(walks):
    shares = [walk.cpu_share for walk in walks if walk.cpu_share is not None]
    return fixed(100 * mean(shares), 1) if shares else NOT_MEASURED
