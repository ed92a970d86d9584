"""Whether two labelled clouds have the same points in the same segments."""

import os
import struct
import sys
import tempfile
import unittest

sys.path.insert(0, os.path.join(os.path.dirname(__file__), "..", "..", "scripts", "lib"))

from same_partition import difference

HEADER = ("ply\nformat binary_little_endian 1.0\nelement vertex {}\nproperty float x\nproperty uint segment_id\n"
          "property int slice_id\nend_header\n")


class SamePartition(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = folder.name

    def file(self, name, points):
        path = os.path.join(self.folder, name)
        with open(path, "wb") as file:
            file.write(HEADER.format(len(points)).encode("ascii"))
            for point in points:
                file.write(struct.pack("<fIi", *point))
        return path

    def difference(self, a, b):
        return difference(self.file("a.ply", a), self.file("b.ply", b))

    def test_order_and_ids_do_not_matter(self):
        self.assertEqual(self.difference([(1, 7, 0), (2, 7, 0), (3, 8, 1)], [(3, 2, 1), (2, 9, 0), (1, 9, 0)]), "")

    def test_a_segment_that_is_split_or_joined_differs(self):
        whole, split = [(1, 7, 0), (2, 7, 0)], [(1, 1, 0), (2, 2, 0)]
        self.assertIn("segment 7", self.difference(whole, split))
        self.assertIn("segment 7", self.difference(split, whole))

    def test_other_points_differ(self):
        self.assertIn("is not in", self.difference([(1, 7, 0)], [(2, 7, 0)]))
        self.assertIn("is not in", self.difference([(1, 7, 0)], [(1, 7, 3)]))
        self.assertIn("has 1 points", self.difference([(1, 7, 0)], [(1, 7, 0), (1, 7, 0)]))

    def test_a_file_that_is_cut_off_is_refused(self):
        path = self.file("a.ply", [(1, 7, 0)])
        os.truncate(path, os.path.getsize(path) - 1)
        with self.assertRaisesRegex(ValueError, "11 bytes of points, expected 12"):
            difference(path, path)


if __name__ == "__main__":
    unittest.main()
