"""The table and the report page of a fleet."""

import csv
import io
import re
import shutil
import unittest
from html.parser import HTMLParser

from fleet_fakes import FleetTest

from fleet import figures, page, table

SETTINGS = {"preset": "paper", "maps": True, "cloud": [], "segmenter": [], "mapper": ["--resolution", "0.01"]}


def row(name, state="done", **values):
    return {"name": name, "input": f"/{name}.ply", "state": state, "kind": "cloud", "points": 1000, "segments": 10,
            "wall_s": 2.0, "segmented_s": 1.5, "cpu_s": 1.0, "peak_memory_MB": 50.0, "started_s": 100.0, "host": "node1",
            "version": "1.0", **values}


class WellFormed(HTMLParser):
    """Raises AssertionError for a tag that is not closed."""

    VOID = ("meta", "br", "img")

    def __init__(self):
        super().__init__()
        self.open = []

    def handle_starttag(self, tag, attrs):
        if tag not in self.VOID:
            self.open.append(tag)

    def handle_endtag(self, tag):
        assert self.open and self.open.pop() == tag, f"</{tag}>"


class TableTest(FleetTest):
    def test_a_line_for_each_input_whatever_is_in_it(self):
        rows = [row("a"), row("b", "failed", reason='said "no", twice\nand again'), {"name": "c", "input": "/c", "state": "missing"}]
        read = list(csv.DictReader(io.StringIO(table.as_csv(rows))))
        self.assertEqual([each["state"] for each in read], ["done", "failed", "missing"])
        self.assertEqual(read[1]["reason"], rows[1]["reason"])
        self.assertEqual(read[0]["points"], "1000")
        self.assertEqual(read[2]["points"], "")

    def test_sums_are_those_of_what_is_done(self):
        rows = [row("a", object_iou=0.5), row("b", object_iou=1.0), row("c", "failed", object_iou=0.0), row("d")]
        self.assertEqual(table.total(rows, "points"), 3000)
        self.assertEqual(table.mean(rows, "object_iou"), 0.75)
        self.assertIsNone(table.mean(rows, "ate_m"))


class PageTest(FleetTest):
    def page(self, rows, runs=()):
        text = page.page("Fleet <1>", rows, list(runs), SETTINGS)
        parser = WellFormed()
        parser.feed(text)
        self.assertEqual(parser.open, [])
        return text

    def test_it_needs_no_other_file(self):
        text = self.page([row(f"input{number}", points=number * 1000, object_iou=number / 10, instance_iou=0.5, ate_m=0.1)
                          for number in range(1, 10)])
        self.assertNotRegex(re.sub(r'xmlns(:\w+)?="[^"]*"', "", text), r"https?://|<script src|<link|<img")

    @unittest.skipUnless(shutil.which("gnuplot"), "there is no gnuplot")
    def test_a_figure_for_each_quantity_that_is_known(self):
        rows = [row(f"input{number}", points=number * 1000, object_iou=number / 10, instance_iou=0.5, ate_m=0.1)
                for number in range(1, 10)]
        self.assertEqual(self.page(rows).count("<svg"), 6)
        self.assertEqual(self.page([row("only")]).count("<svg"), 4)
        self.assertNotIn("Not drawn", self.page(rows))

    def test_a_fleet_of_which_nothing_is_done(self):
        text = self.page([row("b", "failed", reason="<b>no</b>", step="map", exit_code=1, points=None),
                          {"name": "c", "input": "/c", "state": "missing"}])
        self.assertIn("1 failed, 1 missing", text)
        self.assertIn("&lt;b&gt;no&lt;/b&gt;", text)

    def test_facts_and_runs(self):
        text = self.page([row("a"), row("b", host="node2")], [
            {"begun": "2026-01-01 00:00:00", "begun_s": 0.0, "elapsed_s": 2.0, "scheduler": "Slurm", "workers": 2,
             "tasks": 2, "failed": 0, "task_s": 4.0, "at_work": 2.0}])
        for told in ("node1, node2", "preset paper; mapper: --resolution 0.01", "2,000", "4.0 s of all tasks", "Fleet &lt;1&gt;"):
            self.assertIn(told, text)

    def test_recordings_with_frames_that_were_not_located_are_named_the_worst_first(self):
        text = self.page([row("half", frames=100, located=50), row("all", frames=100, located=100),
                          row("none", frames=100, located=1)])
        lost = text[text.index("Frames that were not located"):text.index("The slowest")]
        self.assertLess(lost.index("none"), lost.index("half"))
        self.assertNotIn(">all<", lost)

    def test_of_very_many_rows_the_first_are_on_the_page(self):
        text = self.page([row(f"input{number}") for number in range(page.MOST_ROWS + 1)])
        self.assertNotIn(f"input{page.MOST_ROWS}<", text)
        self.assertIn("results.csv has all", text)

    def test_tasks_at_work_are_counted_over_time(self):
        self.assertEqual(table.at_work([(0.0, 5.0), (2.0, 3.0)], 5), [(0.5, 1.0), (1.5, 1.0), (2.5, 2.0), (3.5, 1.0), (4.5, 1.0)])
        self.assertEqual(table.at_work([(0.5, 1.0), (1.25, 2.0)], 2), [(0.5, 0.5), (1.5, 0.75)])
        figure = figures.progress([row("a", started_s=10.0, wall_s=5.0), row("b", started_s=12.0, wall_s=1.0)])
        self.assertIn("$ended << EOD\n0 0\n3 1\n5 2\nEOD\n", figure.script)

    def test_logarithmic_axes_have_tics_in_narrow_ranges(self):
        self.assertIn("('2,000' 2000, '5,000' 5000)", figures.log_axis("x", [1500, 5000]))
        self.assertIn("('10' 10, '100' 100,", figures.log_axis("x", [5, 500000]))
        self.assertIn("'0.2' 0.2", figures.log_axis("y", [0.19, 0.21]))
