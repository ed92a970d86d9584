"""scripts/bench --only battery: the cases, their table and their picture."""

import re
import shutil
import subprocess
import sys
import unittest
from pathlib import Path
from tempfile import TemporaryDirectory
from unittest import mock

ROOT = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "scripts" / "lib"))

from bench import battery, battery_picture, commands, tables  # noqa: E402
from bench.battery import Result  # noqa: E402
from bench.battery_cases import Case, all_cases, chosen_cases, rows_and_columns  # noqa: E402
from bench.recordings import Outcome  # noqa: E402
from trio.messages import Problem  # noqa: E402


class FakeRun:
    def __init__(self, folder, cases):
        self.folder = folder
        self.cases = cases
        self.commands = []

    def truth_folder(self, source):
        return self.folder / f"truth_{source.name}"

    def execute(self, command):
        self.commands.append(command)


def outcome(located, **errors):
    return Outcome(frames=200, located=located, parts=1, longest_loss_s=0.1, errors=errors, cpu_ms=15.0, memory_MB=200)


class Cases(unittest.TestCase):
    def test_all_are_the_product(self):
        self.assertEqual(len(all_cases()), 4 * 5 * 2 * 3 * 2)
        self.assertEqual(len(set(all_cases())), len(all_cases()))
        self.assertEqual(len({case.source.name for case in all_cases()}), len(all_cases()))
        self.assertEqual(len({(case.row, case.column) for case in all_cases()}), len(all_cases()))

    def test_the_default_ones_have_every_sensor_in_every_room_and_harder_ones_for_two(self):
        cases = chosen_cases(None)
        usual = [case for case in cases if case.speed == "1" and case.rate_hz == 30]
        self.assertEqual(len(usual), 4 * 5 * 2)
        harder = [case for case in cases if case not in usual]
        self.assertEqual(len(harder), 4 * 2 * 2 * 2)
        self.assertEqual({case.sensor for case in harder}, {"kinect1", "d435"})
        self.assertEqual({(case.speed, case.rate_hz) for case in harder}, {("2", 30), ("1", 15)})

    def test_the_address_says_all_of_a_case(self):
        self.assertEqual(Case("hall", "d435", False, "0.5", 15).source.device,
                         "synthetic://hall?sensor=d435&speed=0.5&rate=15&color=off")
        self.assertEqual(Case("hall", "clean").source.device, "synthetic://hall?sensor=clean&speed=1&rate=30")

    def test_words_choose_the_cases_that_have_all_of_them(self):
        self.assertEqual(chosen_cases("hall,d435,depth,speed2"),
                         [Case("hall", "d435", False, "2", 30), Case("hall", "d435", False, "2", 15)])
        self.assertEqual(chosen_cases("all"), all_cases())

    def test_words_that_no_case_has_are_a_wrong_option(self):
        for words, message in (("hall,kinect9", "'kinect9'; there are: office hall"), ("hall,office", "all of these")):
            with self.assertRaisesRegex(Problem, message) as raised:
                chosen_cases(words)
            self.assertEqual(raised.exception.exit_code, 2)

    def test_words_are_checked_before_anything_is_measured(self):
        with self.assertRaisesRegex(Problem, "'nothing'"):
            commands.parse(["--only", "battery", "--cases", "nothing"])


class Table(unittest.TestCase):
    def test_has_a_row_for_each_room_and_sensor_and_a_column_for_each_condition(self):
        results = {Case("office", "kinect1"): Result(1.0, 3.14), Case("office", "kinect1", False, "2"): Result(0.9996, 7),
                   Case("hall", "lidar"): Result(0.005), Case("hall", "lidar", False, "2"): Result()}
        text = battery.battery_table(results)
        self.assertEqual(tables.first_table(text), [
            {"room": "office", "sensor": "kinect1", "colour": "100 %, 3.1 mm", "depth alone, speed 2": "99.9 %, 7.0 mm"},
            {"room": "hall", "sensor": "lidar", "colour": "0.5 %", "depth alone, speed 2": "failed"}])
        self.assertIn("At least 99 % of the frames are located in 2 of 4 cases.", text)

    def test_columns_have_the_order_of_the_cases_whatever_came_first(self):
        _, columns = rows_and_columns([Case("hall", "d435", True, "2"), Case("hall", "d435"), Case("hall", "d435", False)])
        self.assertEqual(columns, ["colour", "colour, speed 2", "depth alone"])


class Section(unittest.TestCase):
    def setUp(self):
        temporary = TemporaryDirectory()
        self.addCleanup(temporary.cleanup)
        self.folder = Path(temporary.name)
        self.addCleanup(mock.patch.stopall)
        self.said = mock.patch.object(battery, "say").start()

    def test_every_case_has_a_line_and_one_that_fails_does_not_end_it(self):
        run = FakeRun(self.folder, "hall,lidar,speed1,color")
        found = [Problem("no such room"), outcome(198, ate_m_rmse=0.0125, rpe_m_rmse=0.01)]
        with mock.patch.object(battery, "outcome", side_effect=found) as mapped:
            table, = tables.parse_tables(battery.battery(run))
        self.assertEqual(table, [{"room": "hall", "sensor": "lidar", "colour": "failed", "colour, 15 Hz": "99 %, 12.5 mm"}])
        self.assertIn(run.folder / "truth_hall_lidar_color_speed1_15hz", mapped.call_args.args)
        failed, good = tables.read_csv(self.folder / "battery.csv")
        self.assertEqual((failed["sensor"], failed["rate_hz"], failed["located"]), ("lidar", "30", ""))
        self.assertEqual((good["located_share"], good["ate_mm"], good["rpe_mm"], good["rpe_deg"]),
                         ("0.99", "12.5", "10.0", ""))
        self.assertEqual(run.commands, [["gnuplot", self.folder / "battery.gp"]])


class Picture(unittest.TestCase):
    def colors(self, script):
        """Of the rectangles, by the text in them."""
        lines = script.splitlines()
        return {re.search('"(.*?)"', lines[i + 1])[1]: re.search("rgb '(.*?)'", line)[1]
                for i, line in enumerate(lines) if line.startswith("set object rectangle")}

    def script(self, results, picture="picture.png"):
        return battery_picture.script_of(*rows_and_columns(results),
                                         {(case.row, case.column): result for case, result in results.items()}, picture)

    def test_colours_tell_located_share_and_error_from_good_to_bad(self):
        good, fair, middle, poor, bad = battery_picture.COLORS
        self.assertEqual([battery_picture.color_of_located(share) for share in (1, 0.99, 0.98, 0.9, 0.5, 0.49, 0, None)],
                         [good, good, fair, middle, poor, bad, bad, battery_picture.NOTHING])
        self.assertEqual([battery_picture.color_of_ate(mm) for mm in (0, 5, 5.1, 25, 50, 51, None)],
                         [good, good, fair, middle, poor, bad, battery_picture.NOTHING])

    def test_every_case_has_two_halves_with_its_values(self):
        good, fair, _, _, bad = battery_picture.COLORS
        script = self.script({Case("office", "kinect1"): Result(0.981, 3.14), Case("hall", "lidar", False): Result(0.2)})
        colors = self.colors(script)
        self.assertEqual((colors["98.1"], colors["3.1"], colors["20"], colors["-"]),
                         (fair, good, bad, battery_picture.NOTHING))
        self.assertEqual(script.count("set object rectangle"), 2 * 2 + 12, "halves, and the legend")

    @unittest.skipUnless(shutil.which("gnuplot"), "gnuplot is not installed")
    def test_gnuplot_draws_it(self):
        with TemporaryDirectory() as folder:
            script = self.script({case: Result(1.0, 2.0) for case in all_cases()}, f"{folder}/picture.png")
            drawn = subprocess.run(["gnuplot"], input=script, text=True, capture_output=True, check=False)
            self.assertEqual((drawn.returncode, drawn.stderr.count("error")), (0, 0), drawn.stderr)
            self.assertTrue(Path(folder, "picture.png").read_bytes().startswith(b"\x89PNG"))


if __name__ == "__main__":
    unittest.main()
