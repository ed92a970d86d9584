"""The section about objects: what has changed between two maps of a room, and taught objects found in other rooms. Its
figures do not depend on how fast the machine is.

Everything is made from the synthetic rooms. With --out DIR, maps and libraries of an earlier run there are used again
while they are newer than the programs that made them."""

import json
import re
import shutil
from dataclasses import dataclass
from pathlib import Path
from statistics import median

from trio.programs import program

from . import object_libraries
from .run import Input, room
from .tables import NOT_MEASURED, fixed, markdown, read_csv

LARGE = "500 and more"  # points of an object, as kintsugi-evaluate calls the class
# Rows of the first table that the summary has, too.
CHANGES = "changes between office and office-later, objects of 500 points and more: precision / recall"
FOUND = "taught in the office, found in kitchens, 500 points and more: precision / recall"
COUNTS = ("points of the object", "there", "found", "told", "right")
CLASSES = ("50 to 199", "200 to 499", LARGE)
# Where taught objects are looked for: each room under its own noise, and walked through at another speed, because in one
# recording there are too few objects to tell a rule from luck.
PLACES = {
    "kitchen": ("kitchen", "kitchen?seed=2", "kitchen?seed=3&speed=1.3", "kitchen?seed=4", "kitchen?seed=5&speed=1.15"),
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
    rooms, pairs, library, names = taught_rooms(run)
    office = rooms["office"]
    changed = {name: changes(run, office, rooms[name], pairs[name]) for name in ("office-later", "office-again")}
    places = {name: [place_and_truth(run, office, scene) for scene in scenes] for name, scenes in PLACES.items()}
    found = {name: [detections(run, *each, library, names) for each in of_name] for name, of_name in places.items()}
    alone = {name: found_alone(run, of_name, library, names) for name, of_name in places.items()}
    return (markdown(["what", "measured", "target"], target_rows(changed, found)) + "\n" +
            markdown(["objects taught in the office, found in", *COUNTS, "position, median, cm", "rotation, median, deg"],
                     found_rows(found)) + "\n" +
            markdown(["each by itself, in a library of one, found in", *COUNTS], alone_rows(alone)))


def taught_rooms(run):
    """The rooms that are mapped, by name; what is in both the office and another; the library and the names in it."""
    rooms = {name: mapped(run, room(name)) for name in ("office", "office-again", "office-later", "kitchen")}
    office = rooms["office"]
    pairs = {name: truth_between(run, office, rooms[name]) for name in ("office-again", "office-later", "kitchen")}
    return rooms, pairs, *taught(run, office, [pairs["office-later"], pairs["kitchen"]])


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


def place_and_truth(run, office, scene):
    """The scene's room, which is mapped here where it is not mapped yet, and the file of its truth."""
    here = mapped(run, Input(re.sub(r"\W+", "-", scene), address=f"synthetic://{scene}"))
    return here, truth_between(run, office, here)


def found_alone(run, places, library, names):
    """As detections(), for each object in a library of its own and each place."""
    found = []
    for name in names:
        only = run.folder / "objects_alone" / name
        shutil.rmtree(only, ignore_errors=True)
        shutil.copytree(library / name, only / name)
        found += [detections(run, *each, only, [name], name=f"alone_{name}_in") for each in places]
    return found


def changes(run, before, after, truth):
    name = f"changes_{after.folder.name}"
    told, out = run.folder / name, run.folder / f"{name}_scores"
    shutil.rmtree(told, ignore_errors=True)
    run.kintsugi("diff", before.map, after.map, "--out", told, log=name)
    run.kintsugi("evaluate", "--changes", told, "--truth-objects", truth, "--before-truth", before.truth,
                 "--after-truth", after.truth, "--out", out, log=out.name)
    return json.loads((out / "scores.json").read_text())


def detections(run, place, truth, library, names, *, name="found"):
    """The scores of what is told in a place, and the lines of the objects that are there.
    name: with which the names of the files begin."""
    name = f"{name}_{place.folder.name}"
    told, out = run.folder / f"{name}.json", run.folder / f"{name}_scores"
    run.kintsugi("objects", "detect", place.map, "--library", library, "--json", told, log=name)
    run.kintsugi("evaluate", "--objects", told, "--truth-objects", truth, "--after-truth", place.truth, "--taught",
                 ",".join(names), "--library", library, "--detected-in", place.segments, "--out", out, log=out.name)
    return json.loads((out / "scores.json").read_text()), read_csv(out / "objects.csv")


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


def target_rows(changed, found):
    moved = changed["office-later"]["moved_within_2cm_5deg"]
    moved_share = moved["right"] / moved["true"] if moved["true"] else None
    return [
        [CHANGES, precision_recall(changed["office-later"]), "0.95 / 0.90"],
        ["of these moved, told as moved within 2 cm and 5 degrees: share",
         f"{share(moved_share)} ({moved['right']} of {moved['true']})", "0.80"],
        ["the same room again, from another path: false changes of 200 points and more",
         changed["office-again"]["false_of_200_points"], "0"],
        [FOUND, pooled_precision_recall(found["kitchen"]), "0.95 / 0.80"],
        ["taught in the office, found in office-later: precision / recall",
         pooled_precision_recall(found["office-later"]), None],
    ]


def found_rows(found):
    rows = []
    for place, of_rooms in found.items():
        outcomes = [row for _, of_room in of_rooms for row in of_room]
        for points in CLASSES:
            sums = pooled(of_rooms, points)
            here = [row for row in outcomes if class_of(int(row["points"])) == points]
            rows.append([f"{place}, {len(of_rooms)} walks", points, *sums.values(), middle(here, "translation_cm"),
                         middle(here, "rotation_deg")])
    return rows


def alone_rows(alone):
    return [[f"{place}, {len(PLACES[place])} walks", points, *pooled(found, points).values()]
            for place, found in alone.items() for points in CLASSES]


def class_of(points):
    """As kintsugi-evaluate calls the sizes of objects."""
    return LARGE if points >= 500 else "200 to 499" if points >= 200 else "50 to 199"


def middle(rows, column):
    values = [float(row[column]) for row in rows if row[column]]
    return fixed(median(values), 1) if values else None
