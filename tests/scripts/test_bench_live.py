"""The section of scripts/bench about live runs, out of what the programs print."""

import json
import sys
import tempfile
import unittest
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "scripts" / "lib"))

from bench import live, summary, tables  # noqa: E402
from bench.run import Input  # noqa: E402

TOLD = {"centre_right": 0.957, "covered_mean": 0.912, "delay_median_s": 0.3, "delay_p99_s": 1.0, "unchanged": 0.999,
        "times_sent": 3.2, "pixel": {"asked": 200, "answered": 190, "wrong": 0, "behind_10cm": 0},
        "ray": {"asked": 200, "answered": 100, "wrong": 41, "behind_10cm": 30}}


class FakeRun:
    """A trio of 500 frames in the folder of the measurement."""

    def __init__(self, folder, told):
        self.folder = Path(folder)
        self._told = told

    def inputs(self, *rooms):
        return [Input("kitchen", "/somewhere"), *map(Input, rooms)]

    def rendered(self, source):
        return Input(source.name, f"/rendered/{source.name}")

    def trio(self, name, source, *options):
        (self.folder / name).mkdir()
        loops = "4 loops closed, 0 contradicted; the map was corrected 3 times\n" if source.name == "loop" else ""
        (self.folder / name / "mapper.log").write_text(
            "500 frames in 16.7 s (1 ms each): 500 located (7 not fused for lack of time), 2 dropped\n" + loops)
        return "  CPU: mapper 10.00 s, segmenter 2.00 s, viewer 1.00 s\n"

    def kintsugi(self, name, *arguments, may_fail):
        assert (name, arguments[0], may_fail) == ("evaluate", "--live", True), (name, arguments)
        Path(arguments[3]).write_text(json.dumps(self._told))


class Live(unittest.TestCase):
    def section(self, told):
        with tempfile.TemporaryDirectory() as folder:
            return live.live(FakeRun(folder, told))

    def test_a_line_for_each_input_in_both_tables(self):
        costs, measures = tables.parse_tables(self.section(TOLD))
        self.assertEqual([row["recording"] for row in costs], ["kitchen", "office", "loop"])
        self.assertEqual([row["corrections of the map"] for row in costs], ["0", "0", "3"])
        self.assertEqual(costs[0]["dropped"], "2")
        self.assertEqual(costs[0]["not fused"], "7")
        self.assertEqual(costs[0]["mapper, CPU-ms a frame"], "20.0")
        self.assertEqual(costs[0]["all three, CPU-ms a frame"], "26.0")
        self.assertEqual(list(measures[1].values()),
                         ["office", "95.7", "91.2", "0.30 (1.00)", "95.0 (0.0)", "50.0 (41.0)", "99.9", "3.2"])

    def test_what_could_not_be_measured_is_an_empty_cell(self):
        told = {**TOLD, "delay_median_s": None, "delay_p99_s": None, "centre_right": None,
                "pixel": {"asked": 0, "answered": 0, "wrong": 0, "behind_10cm": 0}}
        _, measures = tables.parse_tables(self.section(told))
        self.assertEqual(list(measures[0].values())[1:5], ["", "91.2", "", "0.0 (0.0)"])

    def test_the_summary_has_its_results(self):
        text = summary.summary({"live": self.section(TOLD)})
        self.assertIn("kitchen: 95.7, office: 95.7", text)
        self.assertIn("kitchen: 0.30 (1.00), office: 0.30 (1.00)", text)
        self.assertIn("kitchen: 2 of 500", text)


if __name__ == "__main__":
    unittest.main()
