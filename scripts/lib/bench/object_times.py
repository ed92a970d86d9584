"""The section about the time that finding objects takes: live, in a map of 4 million points, and with a large library."""

import re
import shutil

from trio.messages import Problem

from . import large_maps, object_delays, object_libraries
from .objects import taught_rooms
from .tables import NOT_MEASURED, fixed, markdown, number

LARGE_MAP = 4_000_000  # points
COST_RUNS = 5  # odd: with many objects one run differs from the next by a quarter
DELAY = "from the last patch of an object to its detection"


def object_times(run):
    rooms, _, library, _ = taught_rooms(run)
    kitchen = rooms["kitchen"]
    costs = {count: cost_of(run, kitchen.map, grown(run, library, count)) for count in (40, 1000)}
    costs[LARGE_MAP] = cost_of(run, enlarged(run, kitchen), run.folder / "objects_library_40")
    walks = object_delays.live_walks(run, library)
    large_walk = object_delays.walk_in_large_map(run, run.folder / "objects_library_40", LARGE_MAP)
    return (markdown(["what", "measured", "target"], target_rows(costs, walks, large_walk)) + "\n" +
            markdown(["objects in the library", "map", "prepared, CPU-s", "segments", "examined, CPU-s",
                      "a segment, CPU-ms"], cost_rows(costs)))


def grown(run, library, count):
    folder = run.folder / f"objects_library_{count}"
    shutil.rmtree(folder, ignore_errors=True)
    object_libraries.grow(library, folder, count)
    return folder


def enlarged(run, place):
    """The room in a map of 4 million points, the others of which are floors far away."""
    file = run.folder / "objects_large.ply"
    if not file.exists() or file.stat().st_mtime < place.segments.stat().st_mtime:
        large_maps.add_floors(place.segments, file, LARGE_MAP)
    return file


def cost_of(run, map_file, library):
    """Prepared in s, segments, examined in s; s of processor time: the middle one of some runs."""
    return sorted((cost_of_run(run, map_file, library) for _ in range(COST_RUNS)), key=lambda cost: cost[2])[COST_RUNS // 2]


def cost_of_run(run, map_file, library):
    name = f"cost_{map_file.stem}_{library.name}"
    run.kintsugi("objects", "detect", map_file, "--library", library, log=name)
    words = re.search(r"prepared in ([0-9.]+) s, (\d+) segments examined in ([0-9.]+) s",
                      (run.folder / f"{name}.log").read_text())
    if words is None:
        raise Problem(f"kintsugi-objects detect tells no cost, see {name}.log")
    return float(words[1]), int(words[2]), float(words[3])


def target_rows(costs, walks, large_walk):
    growth = costs[1000][2] / costs[40][2] if costs[40][2] else None
    return [
        [f"{DELAY}, live: median / p99, s", object_delays.text(walks), "0.5 / 2"],
        [f"{DELAY}, in a map of 4 million points: median / p99, s", object_delays.text([large_walk]), "0.5 / 2"],
        ["processor of the detector while the camera walks, % of a core", object_delays.percent(walks), "10"],
        ["time to examine a map with 1,000 objects in the library, over that with 40",
         NOT_MEASURED if growth is None else f"{fixed(growth, 2)} times", "2 times"],
    ]


def cost_rows(costs):
    def row(count, place, prepare_s, segments, examine_s):
        return [f"{count:,}", place, number(prepare_s), segments, number(examine_s),
                number(1e3 * examine_s / max(segments, 1))]

    return [row(*((40, "kitchen, 4 million points") if key == LARGE_MAP else (key, "kitchen")), *cost)
            for key, cost in costs.items()]
