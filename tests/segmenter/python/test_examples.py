"""The examples that need no bus. trio.test_python runs the others."""

import os
import subprocess
import sys
import tempfile
import unittest

import kintsugi
import numpy as np

ROOT = os.path.dirname(os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__)))))
EXAMPLES = os.path.join(ROOT, "segmenter", "python", "examples")
sys.path.insert(0, EXAMPLES)

import room  # noqa: E402


def has_module(name):
    return subprocess.run([sys.executable, "-c", "import " + name], capture_output=True).returncode == 0


class ExamplesTest(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = folder.name

    def path(self, name):
        return os.path.join(self.folder, name)

    def run_example(self, name, *arguments):
        done = subprocess.run([sys.executable, os.path.join(EXAMPLES, name), *arguments],
                              capture_output=True, text=True)
        self.assertEqual(done.returncode, 0, done.stdout + done.stderr)
        return done.stdout

    def save_room(self):
        segmenter = kintsugi.Segmenter(room.SPACING)
        segmenter.add(*room.joined(room.walls(), room.box(-0.2, 1.8)))
        segmenter.save(self.path("room.map"))
        return self.path("room.map")

    def test_segment_cloud(self):
        self.assertIn("5 segments", self.run_example("segment_cloud.py"))
        np.save(self.path("cloud.npy"), room.joined(room.walls(), room.box(-0.2, 1.8))[0])
        self.assertIn("31485 points", self.run_example("segment_cloud.py", self.path("cloud.npy"), "0.02"))
        for arguments in ([self.path("cloud.npy")], ["--help"]):
            done = subprocess.run([sys.executable, os.path.join(EXAMPLES, "segment_cloud.py"), *arguments],
                                  capture_output=True, text=True)
            self.assertEqual(done.returncode, 1)
            self.assertIn("segment_cloud.py CLOUD.npy 0.01", done.stderr)

    def test_incremental(self):
        text = self.run_example("incremental.py")
        self.assertIn("the top of the box is segment 4, and was 4", text)
        self.assertIn("without the box: 3 segments", text)

    def test_saved_map(self):
        text = self.run_example("saved_map.py", self.save_room())
        self.assertEqual(text.count("m^2"), 5)
        self.assertIn("colour [150 120  90]", text)

    def test_plot_segments(self):
        if not has_module("matplotlib"):
            self.skipTest("python3-matplotlib is not installed")
        self.run_example("plot_segments.py", self.save_room(), self.path("plan.png"))
        self.assertGreater(os.path.getsize(self.path("plan.png")), 1000)

    def test_open3d_segments(self):
        if not has_module("open3d"):
            self.skipTest("python3-open3d is not installed")
        self.assertIn("5 segments", self.run_example("open3d_segments.py", self.path("room.ply")))
        text = self.run_example("open3d_segments.py", self.path("room.ply"), self.path("segments.ply"), "0.02")
        self.assertIn("31485 points", text)


if __name__ == "__main__":
    unittest.main()
