"""The sections of scripts/bench about objects: what is taught, how a library is grown, and its tables."""

import json
import shutil
import struct
import sys
import tempfile
import unittest
import zlib
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "scripts" / "lib"))

from bench import large_maps, object_delays, object_libraries, object_times, objects, summary, tables  # noqa: E402

PLY = ("ply\nformat binary_little_endian 1.0\nelement vertex 2\nproperty float x\nproperty uint segment_id\n"
       "property uchar red\nend_header\n").encode()


class Taught(unittest.TestCase):
    def test_columns_of_a_ply_file(self):
        with tempfile.NamedTemporaryFile() as file:
            file.write(PLY + struct.pack("<fIBfIB", 1.5, 7, 200, -2.0, 9, 100))
            file.flush()
            self.assertEqual(object_libraries.columns(file.name, "segment_id", "x"), [(7, 1.5), (9, -2.0)])

    def test_a_segment_belongs_to_what_has_most_of_its_points(self):
        truth = [(x, 0, 0, instance) for x, instance in enumerate([5, 5, 5, 6, 6, 0])]
        segments = [(x, 0, 0, segment) for x, segment in enumerate([1, 1, 2, 2, 3, 4])]
        owned = object_libraries.owners(segments, truth)
        self.assertEqual({instance: tuple(each) for instance, each in owned.items()},
                         {5: ([1], 2), 6: ([3], 1)})  # half of 2 is not most, nobody has 4

    def test_what_is_large_or_hardly_seen_is_not_taught(self):
        keys = {1: "mug red 134x90x105", 2: "desk tan 1800x780x740", 3: "bowl white 254x254x74", 4: "floor"}
        known = [{"id_before": number, "key_before": key} for number, key in keys.items()]
        owned = {1: [[10, 11], 400], 2: [[12], 9000], 3: [[13], 299], 4: [[14], 9000], 5: [[15], 900]}
        self.assertEqual(object_libraries.lessons(owned, known), {"mug_red_134x90x105": [10, 11]})


class LargeMaps(unittest.TestCase):
    def test_floors_are_added_as_further_segments(self):
        with tempfile.TemporaryDirectory() as folder:
            small, large = Path(folder, "small.ply"), Path(folder, "large.ply")
            small.write_bytes(PLY.replace(b"property float x", b"property float x\nproperty float z") +
                              struct.pack("<ffIBffIB", 1.5, 0, 7, 200, -2.0, 0, 9, 100))
            large_maps.add_floors(small, large, 260_000)
            points = object_libraries.columns(large, "x", "segment_id")
            self.assertEqual(len(points), 260_000)
            self.assertEqual(points[:2], [(1.5, 7), (-2.0, 9)])
            self.assertEqual({segment for _, segment in points[2:]}, {10, 11})
            large_maps.add_floors(small, large, 1)
            self.assertEqual(large.read_bytes(), small.read_bytes())


class Grown(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = Path(folder.name)
        self.vertex = (0.1, 0.2, 0.3, 0.6, 0.0, 0.8, 200, 40, 40, 2.5)
        for name in ("cup", "mug"):
            object_libraries.write_object(self.folder / "known", {"name": name, "views_O": []}, [self.vertex] * 3)

    def grow(self, count):
        object_libraries.grow(self.folder / "known", self.folder / "grown", count)
        return {path.name: object_libraries.known_object(path) for path in (self.folder / "grown").iterdir()}

    def test_the_first_are_those_that_were_taught(self):
        grown = self.grow(5)
        self.assertEqual(sorted(grown), ["cup", "cup_v1", "cup_v2", "mug", "mug_v1"])
        self.assertEqual(grown["mug"], object_libraries.known_object(self.folder / "known" / "mug"))

    def test_the_others_are_stretched_and_have_unit_normals(self):
        grown = self.grow(5)
        shapes = set()
        for name in ("cup_v1", "cup_v2", "mug_v1"):
            description, vertices = grown[name]
            self.assertEqual(description["name"], name)
            self.assertEqual(len(vertices), 3)
            factors = [vertices[0][axis] / self.vertex[axis] for axis in range(3)]
            self.assertTrue(all(0.75 <= each <= 1.35 for each in factors), factors)
            self.assertAlmostEqual(sum(each ** 2 for each in vertices[0][3:6]), 1.0, places=5)
            self.assertNotEqual(vertices[0][6:9], self.vertex[6:9])
            shapes.add(tuple(round(each, 3) for each in factors))
        self.assertEqual(len(shapes), 3)

    def test_files_have_the_checksum_of_the_model(self):
        self.grow(3)
        folder = self.folder / "grown" / "cup_v1"
        description = json.loads((folder / "object.json").read_text())
        self.assertEqual(description["model_crc32"], f"{zlib.crc32((folder / 'model.ply').read_bytes()):08x}")
        self.assertEqual(description["points"], 3)


def scores(precision=0.9, recall=None):
    sizes = [{"points": name, "kind": "all", "true": 4, "found": 3, "told": 5, "right": 3, "precision": precision,
              "recall": recall} for name in ("50 to 199", "200 to 499", "500 and more")]
    return {"summary": sizes, "moved_within_2cm_5deg": {"right": 1, "true": 6}, "false_of_200_points": 2}


class Tables(unittest.TestCase):
    def test_targets_stand_beside_what_was_measured(self):
        changed = {name: scores() for name in ("office-later", "office-again")}
        found = {"kitchen": [(scores(), [])] * 2, "office-later": [(scores(), [])]}
        targets = objects.target_rows(changed, found)
        rows = [row[1] for row in targets]
        self.assertEqual(rows, ["0.90 / not measured", "0.17 (1 of 6)", 2, "0.60 / 0.75", "0.60 / 0.75"])
        text = tables.markdown(["what", "measured", "target"], targets)
        self.assertIn("| office: 0.90 / not measured |", summary.summary({"objects": text}))
        self.assertIn("| kitchen: 0.60 / 0.75 |", summary.summary({"objects": text}))

    def test_times_stand_beside_their_targets(self):
        costs = {40: (0.3, 954, 10.0), 1000: (7.0, 954, 25.0)}
        walks = [object_delays.Walk([3.0, 0.0], 0.08), object_delays.Walk([1.25], 0.05), object_delays.Walk([], None)]
        targets = object_times.target_rows(costs, walks, object_delays.Walk([0.5], 0.01))
        self.assertEqual([row[1] for row in targets], ["1.25 / 3.00", "0.50 / 0.50", "6.5", "2.50 times"])
        self.assertEqual(object_delays.text([]), "not measured")
        self.assertEqual(object_delays.percent([object_delays.Walk([], None)]), "not measured")
        self.assertEqual(object_times.cost_rows(costs)[1], ["1,000", "kitchen", "7.00", 954, "25.0", "26.2"])
        large = {object_times.LARGE_MAP: (0.3, 970, 10.0)}
        self.assertEqual(object_times.cost_rows(large)[0][:2], ["40", "kitchen, 4 million points"])

    def test_the_cost_is_that_of_the_middle_run(self):
        times_s = iter([9.5, 7.5, 8.0, 7.9, 9.0])

        class Run:
            folder = Path(tempfile.mkdtemp())

            def kintsugi(self, *_, log):
                text = f"info: 40 objects prepared in 0.3 s, 946 segments examined in {next(times_s)} s of processor time"
                (self.folder / f"{log}.log").write_text(text)

        self.addCleanup(shutil.rmtree, Run.folder)
        self.assertEqual(object_times.cost_of(Run(), Path("kitchen.map"), Path("library")), (0.3, 946, 8.0))

    def test_errors_are_of_the_objects_of_the_size(self):
        outcomes = [{"points": "900", "translation_cm": "1.00", "rotation_deg": "4.00"},
                    {"points": "700", "translation_cm": "3.00", "rotation_deg": ""},
                    {"points": "600", "translation_cm": "", "rotation_deg": ""},
                    {"points": "250", "translation_cm": "9.00", "rotation_deg": "9.00"}]
        rows = objects.found_rows({"kitchen": [(scores(), outcomes[:2]), (scores(), outcomes[2:])]})
        self.assertEqual([row[:6] for row in rows],
                         [["kitchen, 2 walks", size, 8, 6, 10, 6] for size in ("50 to 199", "200 to 499", "500 and more")])
        self.assertEqual([row[-2:] for row in rows], [[None, None], ["9.0", "9.0"], ["2.0", "4.0"]])
        tables.markdown(["a"] * len(rows[0]), rows)

    def test_libraries_of_one_object_are_counted_together(self):
        rows = objects.alone_rows({"kitchen": [(scores(), [])] * 3})
        self.assertEqual(rows[0], ["kitchen, 5 walks", "50 to 199", 12, 9, 15, 9])
        tables.markdown(objects.COUNTS, [row[1:] for row in rows])


if __name__ == "__main__":
    unittest.main()
