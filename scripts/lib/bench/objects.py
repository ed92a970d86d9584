"""The section about objects: what has changed between two maps of a room, and taught objects found in other rooms.

Everything is made from the synthetic rooms. With --out DIR, maps and libraries of an earlier run there are used again
while they are newer than the programs that made them."""

import json
import re
import shutil
from dataclasses import dataclass
from pathlib import Path
from statistics import median

from trio.messages import Problem
from trio.programs import program

from . import large_maps, object_delays, object_libraries
from .run import Input, room
from .tables import NOT_MEASURED, fixed, markdown, number, read_csv

LARGE = "500 and more"  # points of an object, as kintsugi-evaluate calls the class
LARGE_MAP = 4_000_000  # points
# Rows of the first table that the summary has, too.
CHANGES = "changes between office and office-later, objects of 500 points and more: precision / recall"
DELAY = "from the last patch of an object to its detection"
FOUND = "taught in the office, found in kitchens, 500 points and more: precision / recall"
# Where taught objects are looked for: each room under its own noise, and walked through at another speed, because in one
# recording there are too few objects to tell a rule from luck.
PLACES = {
    "kitchen": ("kitchen", "kitchen?seed=2", "kitchen?seed=3&speed=1.3"),
    "office-later": ("office-later", "office-later?seed=2&speed=1.3", "office-later?seed=3"),
}


@dataclass(frozen=True)
class MappedRoom:
    """What there is of a room that was mapped with a tracked camera."""

    device: str
    folder: Path

    @property
    def map(self):
        return self.folder / "segmenter.map"

    @property
    def segments(self):
        return self.folder / "segments.ply"

    @property
    def truth(self):
        return self.folder / "truth.ply"


def objects(run):
    rooms = {name: mapped(run, room(name)) for name in ("office", "office-again", "office-later", "kitchen")}
    office, kitchen = rooms["office"], rooms["kitchen"]
    pairs = {name: truth_between(run, office, rooms[name]) for name in ("office-again", "office-later", "kitchen")}
    library, names = taught(run, office, [pairs["office-later"], pairs["kitchen"]])
    changed = {name: changes(run, office, rooms[name], pairs[name]) for name in ("office-later", "office-again")}
    found = {name: [found_in(run, office, scene, library, names) for scene in scenes] for name, scenes in PLACES.items()}
    costs = {count: cost_of(run, kitchen.map, grown(run, library, count)) for count in (40, 1000)}
    large = enlarged(run, kitchen)
    costs[LARGE_MAP] = cost_of(run, large, run.folder / "objects_library_40")
    walks = object_delays.live_walks(run, library)
    large_walk = object_delays.walk_in_large_map(run, run.folder / "objects_library_40", LARGE_MAP)
    return (markdown(["what", "measured", "target"], target_rows(changed, found, costs, walks, large_walk)) + "\n" +
            markdown(["objects taught in the office, found in", "points of the object", "there", "found", "told", "right",
                      "position, median, cm", "rotation, median, deg"], found_rows(found)) + "\n" +
            markdown(["objects in the library", "map", "prepared, CPU-s", "segments", "examined, CPU-s",
                      "a segment, CPU-ms"], cost_rows(costs)))


def is_newer(file, *programs):
    return file.exists() and all(file.stat().st_mtime > Path(program(name)).stat().st_mtime for name in programs)


def mapped(run, source):
    here = MappedRoom(source.device, run.folder / f"objects_{source.name}")
    if is_newer(here.truth, "mapper", "segmenter", "ground-truth"):
        return here
    shutil.rmtree(here.folder, ignore_errors=True)
    # On a bus: there the segmenter gets what the camera saw, of which free space is known.
    run.trio(here.folder.name, source, "--replay", "--only", "mapper,segmenter", "--mapper", "--session=1")
    run.kintsugi("ground-truth", source.device, here.folder / "mapper.lcm", here.truth, log=f"ground_truth_{source.name}")
    return here


def truth_between(run, before, after):
    """The JSON file of the changes and of the objects that are in both."""
    file = after.folder / "objects.json"
    flag = "--objects" if after.folder.name.startswith("objects_kitchen") else "--changes"
    run.kintsugi("ground-truth", flag, before.device, after.device, file)
    return file


def taught(run, office, pairs):
    """The library, and the names in it."""
    library = run.folder / "objects_library"
    if not is_newer(library / "done", "objects", "mapper", "segmenter"):
        shutil.rmtree(library, ignore_errors=True)
        known = [each for file in pairs for each in json.loads(file.read_text())["objects"]]
        object_libraries.teach(run, office, known, library / "objects")
        (library / "done").touch()
    return library / "objects", sorted(folder.name for folder in (library / "objects").iterdir() if folder.is_dir())


def found_in(run, office, scene, library, names):
    """As detections(), in a room that is mapped here where it is not mapped yet."""
    place = mapped(run, Input(re.sub(r"\W+", "-", scene), address=f"synthetic://{scene}"))
    return detections(run, place, truth_between(run, office, place), library, names)


def grown(run, library, count):
    folder = run.folder / f"objects_library_{count}"
    shutil.rmtree(folder, ignore_errors=True)
    object_libraries.grow(library, folder, count)
    return folder


def changes(run, before, after, truth):
    name = f"changes_{after.folder.name}"
    told, out = run.folder / name, run.folder / f"{name}_scores"
    shutil.rmtree(told, ignore_errors=True)
    run.kintsugi("diff", before.map, after.map, "--out", told, log=name)
    run.kintsugi("evaluate", "--changes", told, "--truth-objects", truth, "--before-truth", before.truth,
                 "--after-truth", after.truth, "--out", out, log=out.name)
    return json.loads((out / "scores.json").read_text())


def detections(run, place, truth, library, names):
    name = f"found_{place.folder.name}"
    told, out = run.folder / f"{name}.json", run.folder / f"{name}_scores"
    run.kintsugi("objects", "detect", place.map, "--library", library, "--json", told, log=name)
    run.kintsugi("evaluate", "--objects", told, "--truth-objects", truth, "--after-truth", place.truth, "--taught",
                 ",".join(names), "--library", library, "--detected-in", place.segments, "--out", out, log=out.name)
    return json.loads((out / "scores.json").read_text()), read_csv(out / "objects.csv")


def enlarged(run, place):
    """The room in a map of 4 million points, the others of which are floors far away."""
    file = run.folder / "objects_large.ply"
    if not file.exists() or file.stat().st_mtime < place.segments.stat().st_mtime:
        large_maps.add_floors(place.segments, file, LARGE_MAP)
    return file


def cost_of(run, map_file, library):
    """Prepared in s, segments, examined in s; s of processor time."""
    name = f"cost_{map_file.stem}_{library.name}"
    run.kintsugi("objects", "detect", map_file, "--library", library, log=name)
    words = re.search(r"prepared in ([0-9.]+) s, (\d+) segments examined in ([0-9.]+) s",
                      (run.folder / f"{name}.log").read_text())
    if words is None:
        raise Problem(f"kintsugi-objects detect tells no cost, see {name}.log")
    return float(words[1]), int(words[2]), float(words[3])


def share(value):
    return NOT_MEASURED if value is None else fixed(value, 2)


def of_large(scores, kind="all"):
    return next(row for row in scores["summary"] if row["points"] == LARGE and row["kind"] == kind)


def precision_recall(scores):
    row = of_large(scores)
    return f"{share(row['precision'])} / {share(row['recall'])}"


def pooled(found, points):
    """Sums over the rooms of what was there, found, told and right in a class of sizes."""
    rows = [row for scores, _ in found for row in scores["summary"] if row["kind"] == "all" and row["points"] == points]
    return {key: sum(row[key] for row in rows) for key in ("true", "found", "told", "right")}


def pooled_precision_recall(found):
    sums = pooled(found, LARGE)
    ratio = lambda part, whole: share(sums[part] / sums[whole] if sums[whole] else None)  # noqa: E731
    return f"{ratio('right', 'told')} / {ratio('found', 'true')}"


def target_rows(changed, found, costs, walks, large_walk):
    moved = changed["office-later"]["moved_within_2cm_5deg"]
    moved_share = moved["right"] / moved["true"] if moved["true"] else None
    growth = costs[1000][2] / costs[40][2] if costs[40][2] else None
    return [
        [CHANGES, precision_recall(changed["office-later"]), "0.95 / 0.90"],
        ["of these moved, told as moved within 2 cm and 5 degrees: share",
         f"{share(moved_share)} ({moved['right']} of {moved['true']})", "0.80"],
        ["the same room again, from another path: false changes of 200 points and more",
         changed["office-again"]["false_of_200_points"], "0"],
        [FOUND, pooled_precision_recall(found["kitchen"]), "0.95 / 0.80"],
        ["taught in the office, found in office-later: precision / recall",
         pooled_precision_recall(found["office-later"]), None],
        [f"{DELAY}, live: median / p99, s", object_delays.text(walks), "0.5 / 2"],
        [f"{DELAY}, in a map of 4 million points: median / p99, s", object_delays.text([large_walk]), "0.5 / 2"],
        ["processor of the detector while the camera walks, % of a core", object_delays.percent(walks), "10"],
        ["time to examine a map with 1,000 objects in the library, over that with 40",
         NOT_MEASURED if growth is None else f"{fixed(growth, 2)} times", "2 times"],
    ]


def found_rows(found):
    rows = []
    for place, of_rooms in found.items():
        outcomes = [row for _, of_room in of_rooms for row in of_room]
        for points in ("50 to 199", "200 to 499", LARGE):
            sums = pooled(of_rooms, points)
            here = [row for row in outcomes if class_of(int(row["points"])) == points]
            rows.append([f"{place}, {len(of_rooms)} walks", points, *sums.values(), middle(here, "translation_cm"),
                         middle(here, "rotation_deg")])
    return rows


def class_of(points):
    """As kintsugi-evaluate calls the sizes of objects."""
    return LARGE if points >= 500 else "200 to 499" if points >= 200 else "50 to 199"


def middle(rows, column):
    values = [float(row[column]) for row in rows if row[column]]
    return fixed(median(values), 1) if values else None


def cost_rows(costs):
    def row(count, place, prepare_s, segments, examine_s):
        return [f"{count:,}", place, number(prepare_s), segments, number(examine_s),
                number(1e3 * examine_s / max(segments, 1))]

    return [row(*((40, "kitchen, 4 million points") if key == LARGE_MAP else (key, "kitchen")), *cost)
            for key, cost in costs.items()]
