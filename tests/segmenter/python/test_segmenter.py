"""kintsugi.Segmenter, saved maps and queries, from Python."""

import os
import subprocess
import sys
import tempfile
import threading
import unittest

import kintsugi
import numpy as np


def square(x=0.0, z=1.0, dtype=np.float64):
    """20 x 20 points, 1 cm apart, with the corner at (x, 0, z)."""
    u, v = np.meshgrid(np.arange(20) * 0.01, np.arange(20) * 0.01)
    return np.stack([x + u.ravel(), v.ravel(), np.full(400, z)], axis=1).astype(dtype)


FACING = np.tile([0.0, 0.0, -1.0], (400, 1))


def shifted(x):
    pose = np.eye(4)
    pose[0, 3] = x
    return pose


class SegmenterTest(unittest.TestCase):
    def setUp(self):
        self.segmenter = kintsugi.Segmenter(resolution=0.01)

    def test_pieces_that_touch_are_one_segment(self):
        a = self.segmenter.add(square(), FACING)
        b = self.segmenter.add(square(0.2, dtype=np.float32), FACING)
        far = self.segmenter.add(square(2.0), FACING)
        self.assertEqual(self.segmenter.pieces, [a, b, far])
        self.assertEqual(self.segmenter.labels(a).dtype, np.uint32)
        np.testing.assert_array_equal(self.segmenter.labels(a), self.segmenter.labels(b))
        self.assertEqual(self.segmenter.labels().shape, (1200,))
        self.assertEqual(len(np.unique(self.segmenter.labels())), 2)
        segments = self.segmenter.segments()
        self.assertEqual(segments.dtype, kintsugi.SEGMENT)
        self.assertEqual(segments["points"].tolist(), [800, 400])
        np.testing.assert_allclose(segments["box_max"][0], [0.39, 0.19, 1.0], atol=1e-6)

    def test_equals_a_batch_run_over_the_points_where_they_are(self):
        random = np.random.default_rng(1)
        pieces = {}
        for _ in range(12):
            points = square(*random.uniform(-0.3, 0.3, 2).round(2))
            normals = FACING + random.normal(0.0, 0.03, points.shape)
            colors = random.choice(np.uint8([[250, 10, 10], [10, 250, 10]]), 1).repeat(400, axis=0)
            pieces[self.segmenter.add(points, normals, colors)] = points, normals, colors
        for piece in list(pieces)[::3]:
            x = random.uniform(-0.3, 0.3)
            self.segmenter.move(piece, shifted(x))
            pieces[piece] = pieces[piece][0] + [x, 0.0, 0.0], *pieces[piece][1:]
        self.segmenter.remove(list(pieces)[4])
        pieces.pop(list(pieces)[4])
        batch = kintsugi.Segmenter(mode="batch")
        given = np.concatenate([self.segmenter.points(piece) for piece in pieces])
        np.testing.assert_allclose(given["position"], np.concatenate([p[0] for p in pieces.values()]), atol=1e-6)
        ours, theirs = self.segmenter.labels(), batch.labels(batch.add(given))
        pairs = np.unique(np.stack([ours, theirs]), axis=1)  # a bijection of ids
        self.assertEqual(pairs.shape[1], len(np.unique(ours)))
        self.assertEqual(pairs.shape[1], len(np.unique(theirs)))
        self.assertGreater(pairs.shape[1], 2)

    def test_moves_replaces_and_removes(self):
        a = self.segmenter.add(square(), FACING)
        b = self.segmenter.add(square(2.0), FACING)
        self.segmenter.move(b, shifted(-1.8))
        self.assertEqual(self.segmenter.num_segments, 1)
        self.assertIn(kintsugi.MERGED, self.segmenter.events["type"])
        self.assertEqual(self.segmenter.relabelled_pieces, [b])
        np.testing.assert_allclose(self.segmenter.points(b)["position"][0], [0.2, 0.0, 1.0], atol=1e-6)
        self.segmenter.move({a: shifted(3.0), b: shifted(0.0)})
        self.assertEqual(self.segmenter.num_segments, 2)
        self.segmenter.replace(b, square(8.0), FACING)
        np.testing.assert_allclose(self.segmenter.points(b)["position"][0], [8.0, 0.0, 1.0])
        self.segmenter.remove(b)
        self.assertEqual(self.segmenter.pieces, [a])
        self.assertEqual(self.segmenter.num_points, 400)

    def test_estimates_normals_that_are_not_given(self):
        piece = self.segmenter.add(square(), viewpoint=(0.0, 0.0, 9.0))
        np.testing.assert_allclose(self.segmenter.points(piece)["normal"], -FACING, atol=1e-5)
        normals = kintsugi.estimate_normals(square(), 0.01)
        self.assertEqual(normals.shape, (400, 3))
        for resolution in (0.0, np.inf, np.nan, 1e30):
            with self.subTest(resolution), self.assertRaisesRegex(ValueError, "resolution_m is .*, must be > 0"):
                kintsugi.estimate_normals(square(), resolution)

    def test_takes_records_and_gives_views(self):
        points = np.zeros(400, kintsugi.POINT)
        points["position"] = square()
        points["normal"] = FACING
        points["color"] = [1, 2, 3]
        piece = self.segmenter.add(points)
        given = self.segmenter.points(piece)
        np.testing.assert_array_equal(given["color"], points["color"])
        self.assertIsNotNone(given["position"].base)  # a view, no copy
        self.assertEqual(kintsugi.POINT.itemsize, 32)

    def test_the_gap_of_a_record_is_zero_in_the_map(self):
        points = np.frombuffer(bytearray(b"\xab" * 32 * 400), kintsugi.POINT)
        for field, value in (("position", square()), ("normal", FACING), ("color", 1), ("weight", 1.0)):
            points[field] = value
        given = self.segmenter.points(self.segmenter.add(points))
        gap = given.view(np.uint8).reshape(400, 32)[:, 27]
        np.testing.assert_array_equal(gap, 0)

    def test_takes_strided_arrays(self):
        piece = self.segmenter.add(np.asfortranarray(square()), np.repeat(FACING, 2, axis=0)[::2])
        np.testing.assert_allclose(self.segmenter.points(piece)["position"], square(), atol=1e-6)

    def test_colors_separate_segments(self):
        colors = np.zeros((400, 3), np.uint8)
        colors[:200] = [255, 1, 1]
        colors[200:] = [1, 1, 255]
        self.segmenter.add(square(), FACING, colors)
        self.assertEqual(self.segmenter.num_segments, 2)

    def test_points_that_cannot_be_segmented_have_no_segment(self):
        points = square()
        points[3, 0] = np.nan
        labels = self.segmenter.labels(self.segmenter.add(points, FACING))
        self.assertEqual(labels[3], 0)
        self.assertTrue(np.all(np.delete(labels, 3) > 0))

    def test_refuses_wrong_arrays_with_a_sentence(self):
        cases = [
            (ValueError, r"points must have the shape \(N, 3\), not \(400, 2\)", (square()[:, :2],)),
            (TypeError, "points must be of floats .* not int64", (np.zeros((4, 3), np.int64),)),
            (TypeError, "points must", ("cloud.ply",)),
            (ValueError, r"normals must have the shape \(400, 3\), not \(399, 3\)", (square(), FACING[1:])),
            (TypeError, "colors must be of dtype uint8", (square(), FACING, FACING)),
            (ValueError, "colors must have the shape", (square(), FACING, np.zeros((400, 4), np.uint8))),
            (ValueError, "have normals and colours already", (np.zeros(4, kintsugi.POINT), FACING)),
        ]
        for error, text, arguments in cases:
            with self.subTest(text), self.assertRaisesRegex(error, text):
                self.segmenter.add(*arguments)
        self.assertEqual(self.segmenter.pieces, [])

    def test_refuses_records_whose_fields_are_of_other_dtypes(self):
        fields = {"position": "3f4", "normal": "3f4", "color": "3u1", "weight": "f4"}
        for field, dtype in (("color", "3f4"), ("color", "3i4"), ("position", "2f4"), ("position", "f4"),
                             ("position", "3i4"), ("weight", "c8")):
            points = np.zeros(400, list({**fields, field: dtype}.items()))
            with self.subTest(field, dtype=dtype), self.assertRaisesRegex(TypeError, "field '%s' of points" % field):
                self.segmenter.add(points)

    def test_takes_records_with_other_gaps_and_byte_orders(self):
        points = np.zeros(400, [("position", ">f4", 3), ("normal", ">f4", 3), ("color", "u1", 3), ("weight", ">f4")])
        points["position"] = square()
        points["normal"] = FACING
        piece = self.segmenter.add(points)
        np.testing.assert_allclose(self.segmenter.points(piece)["position"], square(), atol=1e-6)

    def test_errors_of_numpy_are_told_as_they_are(self):
        with self.assertRaises(MemoryError):
            self.segmenter.add(np.broadcast_to(np.zeros(3), (10**13, 3)))
        with np.errstate(over="raise"), self.assertRaises(FloatingPointError):
            self.segmenter.add(np.full((3, 3), 1e300))

        class Interrupted:
            def __array__(self, *_, **__):
                raise KeyboardInterrupt

        for arguments in ((Interrupted(),), (square(), Interrupted()), (square(), FACING, Interrupted())):
            with self.assertRaises(KeyboardInterrupt):
                self.segmenter.add(*arguments)
        with self.assertRaises(KeyboardInterrupt):
            self.segmenter.query(at=Interrupted())

    def test_colors_that_cannot_be_copied_are_an_error(self):
        script = """
import resource
import kintsugi, numpy as np
N = 5_000_000
points, normals = np.zeros((N, 3), np.float32), np.ones((N, 3), np.float32)
colors = np.zeros((N, 6), np.uint8)[:, ::2]
segmenter = kintsugi.Segmenter()
with open("/proc/self/statm") as file:
    used = int(file.read().split()[0]) * resource.getpagesize()
resource.setrlimit(resource.RLIMIT_AS, (used + 32 * N + (2 << 20),) * 2)
try:
    segmenter.add(points, normals, colors)
except MemoryError:
    print("MemoryError")
"""
        done = subprocess.run([sys.executable, "-c", script], capture_output=True, text=True)
        self.assertEqual(done.stdout, "MemoryError\n", done.stderr)

    def test_refuses_bad_poses_options_and_pieces(self):
        piece = self.segmenter.add(square(), FACING)
        with self.assertRaisesRegex(ValueError, r"X_WP must have the shape \(4, 4\)"):
            self.segmenter.move(piece, np.eye(3))
        with self.assertRaisesRegex(ValueError, "must be a rotation"):
            self.segmenter.move(piece, np.diag([2.0, 1.0, 1.0, 1.0]))
        with self.assertRaisesRegex(TypeError, "an int"):
            self.segmenter.move("box", np.eye(4))
        self.segmenter.move(piece, np.eye(4, dtype=int))
        with self.assertRaisesRegex(ValueError, "last row"):
            self.segmenter.move(piece, np.full((4, 4), 0.5))
        with self.assertRaisesRegex(ValueError, "there is no piece 99"):
            self.segmenter.labels(99)
        with self.assertRaisesRegex(ValueError, "resolution_m is -1"):
            kintsugi.Segmenter(resolution=-1.0)
        with self.assertRaisesRegex(ValueError, "no parameter 'colour'"):
            kintsugi.Segmenter(parameters={"colour": 1.0})

    def test_answers_queries(self):
        self.segmenter.add(square(), FACING)
        self.segmenter.add(square(2.0), FACING)
        answer = self.segmenter.query(at=(2.1, 0.1, 1.01))
        self.assertEqual(answer.segments["id"].tolist(), [2])
        self.assertEqual(answer.segments["planar"][0], 1)
        np.testing.assert_allclose(np.abs(answer.segments["plane_normal"][0]), [0, 0, 1], atol=1e-5)
        np.testing.assert_allclose(answer.hit, [2.1, 0.1, 1.0], atol=0.01)
        self.assertEqual(self.segmenter.query(ray=((0.1, 0.1, 0), (0, 0, 2))).segments["id"].tolist(), [1])
        self.assertEqual(self.segmenter.query(box=((1, -1, 0), (3, 1, 2))).num_matching, 1)
        self.assertEqual(len(self.segmenter.query(planar=True, largest=1).segments), 1)
        self.assertEqual(self.segmenter.query(ids=[2, 77]).segments["id"].tolist(), [2])
        for error, text, keywords in [
                (TypeError, "no keyword 'nearby'", {"nearby": 1}),
                (TypeError, "planar must be True or False", {"planar": "yes"}),
                (ValueError, "at must be three numbers", {"at": (1, 2)}),
                (ValueError, "at most one place", {"at": (1, 2, 3), "ids": [1]}),
                (ValueError, "radius_m", {"at": (1, 2, 3), "radius": -1}),
                (ValueError, "camera", {"pixel": (1, 2)})]:
            with self.subTest(text), self.assertRaisesRegex(error, text):
                self.segmenter.query(**keywords)

    def test_threads_share_a_segmenter(self):
        threads = [threading.Thread(target=lambda x=x: self.segmenter.add(square(float(x)), FACING))
                   for x in range(8)]
        for thread in threads:
            thread.start()
        for thread in threads:
            thread.join()
        self.assertEqual(self.segmenter.num_points, 3200)

    def test_an_array_outlives_its_segmenter(self):
        piece = self.segmenter.add(square(), FACING)
        points = self.segmenter.points(piece)
        self.segmenter = None
        self.assertEqual(len(points), 400)
        np.testing.assert_allclose(points["position"], square(), atol=1e-6)


class SavedMapTest(unittest.TestCase):
    def test_is_what_was_saved(self):
        segmenter = kintsugi.Segmenter()
        piece = segmenter.add(square(), FACING)
        with tempfile.TemporaryDirectory() as folder:
            file = os.path.join(folder, "segmenter.map")
            segmenter.save(file)
            saved = kintsugi.load_map(file)
        np.testing.assert_array_equal(saved.labels, segmenter.labels(piece))
        np.testing.assert_array_equal(saved.segments(), segmenter.segments())
        self.assertAlmostEqual(saved.resolution, 0.01, places=6)
        self.assertEqual(saved.query(planar=True).num_matching, 1)
        self.assertIn("1 segments", repr(saved))
        with self.assertRaises(ValueError):
            saved.points["weight"][0] = 1.0  # read-only
        points = saved.points
        del saved
        np.testing.assert_allclose(points["position"], square(), atol=1e-6)

    def test_errors_tell_names_that_are_no_utf_8(self):
        for call in (kintsugi.load_map, kintsugi.read_log, kintsugi.Segmenter().save,
                     lambda name: kintsugi.connect(bus_key=name)):
            with self.assertRaisesRegex(RuntimeError, "none\ufffd"):
                call("/none\udcff/file")

    def test_refuses_another_file(self):
        with self.assertRaisesRegex(RuntimeError, "none.map"):
            kintsugi.load_map("none.map")


if __name__ == "__main__":
    unittest.main()
