"""The section about fleets: many generated clouds, with one task at a time and with as many as there are processors."""

import json
import os

from .run import SCRIPTS, Input
from .tables import fixed, markdown, quantile, read_csv

# Rooms, and how many frames each has at 30 Hz.
ROOMS = (("office", 375), ("hall", 301), ("hallway", 301), ("kitchen", 421), ("loop", 3001), ("two-floors", 15241))
FRAMES = 24  # of each cloud: surface is in the map after 8
CLOUDS = 200


def fleets(run):
    clouds = [make_cloud(run, number) for number in range(CLOUDS)]
    (run.folder / "fleet.txt").write_text("".join(f"{cloud.name} truth={truth.name}\n" for cloud, truth in clouds))
    return markdown(["tasks at a time", "clouds", "failed", "elapsed, s", "tasks at work, mean", "time of a cloud p50 / p95, s",
                     "points", "segments", "objects, mean best IoU"],
                    [cells(run, workers) for workers in sorted({1, len(os.sched_getaffinity(0))})])


def make_cloud(run, number):
    """A map of some frames anywhere on the path through a room, and its true instances."""
    room, length = ROOMS[number % len(ROOMS)]
    passes = -(-CLOUDS // len(ROOMS))
    start = number // len(ROOMS) * (length - FRAMES) // passes
    source = Input(room, address=f"synthetic://{room}?seed={number}&start={start}&frames={FRAMES}")
    name = f"cloud_{number:03}_{room}"
    cloud, truth = run.folder / f"{name}.ply", run.folder / f"{name}_truth.ply"
    run.map_alone(name, source, "--cloud", cloud, "--linger", "0")
    run.kintsugi("ground-truth", source.device, cloud, truth)
    return cloud, truth


def cells(run, workers):
    out = run.folder / f"fleet_{workers}"
    run.execute([f"{SCRIPTS}/fleet", "run", "fleet.txt", "--out", out, "--no-maps", "--scheduler", "parallel",
                 "--jobs", workers], name=out.name, may_fail=True)  # failed clouds are in the table
    took = json.loads((out / "jobs" / "runs.json").read_text())[-1]
    done = [row for row in read_csv(out / "results.csv") if row["state"] == "done"]
    times = [float(row["segmented_s"]) for row in done]
    known = [float(row["object_iou"]) for row in done if row["object_iou"]]
    return [workers, took["tasks"], took["failed"], fixed(took["elapsed_s"], 1), fixed(took["at_work"], 2),
            f"{fixed(quantile(times, 0.5), 2)} / {fixed(quantile(times, 0.95), 2)}",
            fixed(sum(int(row["points"]) for row in done), 0), fixed(sum(int(row["segments"]) for row in done), 0),
            fixed(sum(known) / len(known), 3)]
