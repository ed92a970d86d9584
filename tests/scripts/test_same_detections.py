"""scripts/lib/same_detections.py: which differences between two runs of a detector count."""

import json
import subprocess
import tempfile
import unittest
from pathlib import Path

SCRIPT = Path(__file__).resolve().parents[2] / "scripts" / "lib" / "same_detections.py"


def detection(name, x, number=1, **changes):
    return {"detection": number, "name": name, "X_WO": [1, 0, 0, x, 0, 1, 0, 0, 0, 0, 1, 0], "points": 90, "score": 0.8,
            "segments": [number], "utime": number, **changes}


class SameDetections(unittest.TestCase):
    def compare(self, first, other):
        with tempfile.TemporaryDirectory() as folder:
            paths = []
            for name, detections in (("a.json", first), ("b.json", other)):
                paths.append(Path(folder, name))
                paths[-1].write_text(json.dumps({"map": name, "detections": detections}))
            return subprocess.run([SCRIPT, *paths], capture_output=True, text=True, check=False)

    def test_numbers_segments_and_order_may_differ(self):
        first = [detection("mug", 1.0, 1), detection("mug", 2.0, 2), detection("globe", 3.0, 3)]
        other = [detection("globe", 3.0, 7), detection("mug", 2.00001, 8), detection("mug", 1.0, 9)]
        self.assertEqual(self.compare(first, other).returncode, 0)
        self.assertEqual(self.compare([], []).returncode, 0)

    def test_name_pose_points_and_score_may_not(self):
        first = [detection("mug", 1.0)]
        for other in ([], [detection("cup", 1.0)], [detection("mug", 1.01)], [detection("mug", 1.0, points=91)],
                      [detection("mug", 1.0, score=0.81)], [detection("mug", 1.0), detection("mug", 1.0, 2)]):
            result = self.compare(first, other)
            self.assertEqual(result.returncode, 1, other)
            self.assertIn("b.json has other detections than ", result.stderr)
        self.assertEqual(subprocess.run([SCRIPT], capture_output=True, check=False).returncode, 2)


if __name__ == "__main__":
    unittest.main()
