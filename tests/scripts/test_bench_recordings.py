"""scripts/bench --only recordings: which recordings are measured, and what a row says of them."""

import math
import sys
import unittest
from pathlib import Path
from tempfile import TemporaryDirectory
from unittest import mock

ROOT = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "scripts" / "lib"))

from bench import accuracy, recordings, tables  # noqa: E402
from bench.run import Input, MapperRun, recordings_under  # noqa: E402
from trio.messages import Problem  # noqa: E402


def frame(utime, state="tracking", part=None, memory_mb="100.0"):
    row = {"utime_us": str(utime), "state": state, "memory_mb": memory_mb}
    return row if part is None else {**row, "part": str(part)}


def write_csv(file, rows):
    lines = [",".join(rows[0]), *(",".join(row.values()) for row in rows)]
    file.write_text("\n".join(lines) + "\n")


def poses(*times):
    return "# timestamp tx ty tz qx qy qz qw\n" + "".join(f"{time} 0 0 0 0 0 0 1\n" for time in times)


class FakeRun:
    """A mapper that leaves given frames, and an evaluation with given errors by the name of the path's file."""

    def __init__(self, folder, frames, path, errors, truth="truth.txt"):
        self.folder = folder
        self.frames = frames
        self.path = path
        self.errors = errors
        self.truth = truth and folder / truth
        if self.truth:
            self.truth.write_text(poses("0.01", "0.04"))
        self.recordings = []
        self.evaluated = []

    def map_alone(self, name, source, *flags):
        if source.name == "damaged":
            raise Problem("exit code 1 of kintsugi-mapper\nkintsugi-mapper: no image can be read")
        write_csv(self.folder / f"{name}.csv", self.frames)
        (self.folder / f"{name}.txt").write_text(self.path)
        Path(flags[flags.index("--cloud") + 1]).write_bytes(
            b"ply\nformat binary_little_endian 1.0\nelement vertex 1234567\nproperty float x\nend_header\n\xff\x00")
        located = sum(row["state"] != "lost" for row in self.frames)
        log = f"{len(self.frames)} frames in 1.0 s (1.0 ms each, 17.25 ms of CPU): {located} located, 0 lost\n"
        return MapperRun(log, self.folder / f"{name}.txt", self.folder / f"{name}.csv")

    def true_path(self, source):
        return self.truth

    def kintsugi(self, name, *arguments):
        path, file = (Path(arguments[arguments.index(flag) + 1]) for flag in ("--trajectory", "--csv"))
        self.evaluated.append((path.name, path.read_text(), "--all-pairs" in arguments))
        found = self.errors[path.name]
        if isinstance(found, str) and not ("--all-pairs" in arguments and found == "short"):
            raise Problem(f"exit code 1\n{found}")
        if found == "short":
            found = {"ate_m_rmse": "0.002", "ate_m_pairs": "9", "ate_m_max": "0.003", "rpe_m_rmse": "5"}
        write_csv(file, [{"estimate": str(path), **found}])


def errors(ate_m, ate_pairs, rpe_m, rpe_deg, rpe_pairs):
    """Two pairs or motions with the same errors have this root mean square."""
    return {"ate_m_rmse": str(ate_m), "ate_m_pairs": str(ate_pairs), "ate_m_max": str(2 * ate_m),
            "rpe_m_rmse": str(rpe_m), "rpe_m_pairs": str(rpe_pairs), "rpe_m_max": str(rpe_m),
            "rpe_deg_rmse": str(rpe_deg), "rpe_deg_pairs": str(rpe_pairs), "rpe_deg_max": str(rpe_deg)}


class Folders(unittest.TestCase):
    def setUp(self):
        temporary = TemporaryDirectory()
        self.addCleanup(temporary.cleanup)
        self.folder = Path(temporary.name).resolve()

    def write(self, *files):
        for file in files:
            (self.folder / file).parent.mkdir(parents=True, exist_ok=True)
            (self.folder / file).touch()

    def test_every_recording_at_any_depth_is_found_once(self):
        self.write("b/camera.txt", "b/depth.txt", "a/deep/camera.txt", "a/deep/associations.txt", "no_images/camera.txt",
                   "no_camera/depth.txt")
        found = recordings_under([self.folder, self.folder / "b"])
        self.assertEqual([(each.name, each.folder) for each in found],
                         [("deep", str(self.folder / "a/deep")), ("b", str(self.folder / "b"))])

    def test_a_recording_itself_may_be_given(self):
        self.write("r/camera.txt", "r/depth.txt")
        self.assertEqual([each.name for each in recordings_under([self.folder / "r"])], ["r"])

    def test_equal_names_are_told_apart(self):
        self.write(*(f"{parent}/r/{file}" for parent in "ab" for file in ("camera.txt", "depth.txt")))
        self.assertEqual([each.name for each in recordings_under([self.folder])], ["r-1", "r-2"])

    def test_a_folder_without_recordings_is_a_wrong_option(self):
        with self.assertRaisesRegex(Problem, "no recording in .*camera.txt") as raised:
            recordings_under([self.folder])
        self.assertEqual(raised.exception.exit_code, 2)


class Losses(unittest.TestCase):
    def test_the_longest_lasts_until_a_frame_is_located_again(self):
        rows = [frame(0), frame(100_000, "lost"), frame(200_000), frame(300_000, "lost"), frame(400_000, "lost"),
                frame(650_000), frame(700_000)]
        self.assertAlmostEqual(recordings.longest_loss_s(rows), 0.35)

    def test_or_until_the_end(self):
        rows = [frame(0), frame(100_000, "lost"), frame(200_000, "lost"), frame(900_000, "lost")]
        self.assertAlmostEqual(recordings.longest_loss_s(rows), 0.8)

    def test_a_run_without_loss_has_none(self):
        self.assertEqual(recordings.longest_loss_s([frame(0), frame(1), frame(2, "given")]), 0)
        self.assertEqual(recordings.longest_loss_s([]), 0)


class Truth(unittest.TestCase):
    def setUp(self):
        temporary = TemporaryDirectory()
        self.addCleanup(temporary.cleanup)
        self.file = Path(temporary.name, "groundtruth.txt")
        self.converted = Path(temporary.name, "converted.txt")

    def test_numbers_of_frames_become_times_at_30_hz(self):
        self.file.write_text("# comment\n1 1.5 0 0 0 0 0 1\n2 2.5 0 0 0 0 0 1\n5.000 3.5 0 0 0 0 0 1\n")
        self.assertEqual(accuracy.in_seconds(self.file, self.converted), self.converted)
        self.assertEqual(self.converted.read_text(), "0.033333 1.5 0 0 0 0 0 1\n0.066667 2.5 0 0 0 0 0 1\n"
                                                     "0.166667 3.5 0 0 0 0 0 1\n")

    def test_seconds_stay(self):
        for text in (poses("1.0", "2.0", "2.5"), poses("1341836537.8070", "1341836537.8183"), poses("1"),
                     poses("0", "33", "67", "100")):
            self.file.write_text(text)
            self.assertEqual(accuracy.in_seconds(self.file, self.converted), self.file)
        self.assertFalse(self.converted.exists())


class Sections(unittest.TestCase):
    def setUp(self):
        temporary = TemporaryDirectory()
        self.addCleanup(temporary.cleanup)
        self.folder = Path(temporary.name)
        self.said = mock.patch.object(recordings, "say").start()
        mock.patch.object(accuracy, "say").start()
        self.addCleanup(mock.patch.stopall)

    def rows(self, run, *names):
        run.recordings = [Input(name, f"/somewhere/{name}") for name in names]
        text = recordings.recordings(run)
        return tables.first_table(text), text

    def test_a_row_has_all_values(self):
        run = FakeRun(self.folder, [frame(0), frame(33_333, "lost", memory_mb="250.4"), frame(66_667)],
                      poses("0.000000", "0.066667"), {"recording_r.txt": errors(0.0123, 2, 0.02, 0.5, 2)})
        (row,), _ = self.rows(run, "r")
        self.assertEqual(row, {"recording": "r", "frames": "3", "located": "2", "%": "66.7", "parts": "1",
                               "longest loss, s": "0.03", "ATE rmse, mm": "12.30", "RPE over 1 s rmse, mm": "20.00",
                               "RPE over 1 s rmse, deg": "0.50", "points": "1,234,567", "CPU a frame, ms": "17.2",
                               "memory, MB": "250"})

    def test_parts_are_compared_with_the_truth_one_by_one(self):
        run = FakeRun(self.folder, [frame(0, part=1), frame(100_000, part=1), frame(200_000, "lost", part=1),
                                    frame(5_000_001, part=2)],
                      poses("0.000000", "0.100000", "5.000001"),
                      {"recording_r_part_1.txt": errors(0.003, 3, 0.01, 1.0, 1),
                       "recording_r_part_2.txt": errors(0.007, 1, 0.02, 2.0, 3)})
        (row,), _ = self.rows(run, "r")
        self.assertEqual(row["parts"], "2")
        self.assertEqual([(name, text.count("\n")) for name, text, _ in run.evaluated],
                         [("recording_r_part_1.txt", 2), ("recording_r_part_2.txt", 1)])
        self.assertEqual(row["ATE rmse, mm"], f"{math.sqrt((3 * 3**2 + 1 * 7**2) / 4):.2f}")
        self.assertEqual(row["RPE over 1 s rmse, mm"], f"{math.sqrt((10**2 + 3 * 20**2) / 4):.2f}")
        self.assertEqual(row["RPE over 1 s rmse, deg"], f"{math.sqrt((1 + 3 * 4) / 4):.2f}")

    def test_a_part_in_which_nothing_was_located_does_not_count(self):
        self.assertEqual(accuracy.parts_of([frame(0, part=1), frame(1, "lost", part=2), frame(2, part=3)]), ["1", "3"])

    def test_a_path_too_short_for_motions_of_a_second_still_has_an_ate(self):
        run = FakeRun(self.folder, [frame(0), frame(33_333)], poses("0.0", "0.033333"), {"recording_r.txt": "short"})
        (row,), _ = self.rows(run, "r")
        self.assertEqual((row["ATE rmse, mm"], row["RPE over 1 s rmse, mm"]), ("2.00", "-"))

    def test_without_truth_or_without_poses_there_are_no_errors(self):
        for run in (FakeRun(self.folder, [frame(0)], poses("0.0"), {}, truth=None),
                    FakeRun(self.folder, [frame(0, "lost")], "", {}),
                    FakeRun(self.folder, [frame(0)], poses("0.0"), {"recording_r.txt": "too few poses"})):
            (row,), _ = self.rows(run, "r")
            self.assertEqual((row["ATE rmse, mm"], row["RPE over 1 s rmse, deg"]), ("-", "-"))

    def test_a_recording_that_fails_does_not_hide_the_others(self):
        run = FakeRun(self.folder, [frame(0), frame(33_333)], poses("0.0"), {"recording_r.txt": "short"})
        (damaged, row), text = self.rows(run, "damaged", "r")
        self.assertEqual((damaged["located"], damaged["points"]), ("failed", ""))
        self.assertEqual(row["located"], "2")
        self.assertIn("`damaged` failed: kintsugi-mapper: no image can be read", text)
        self.said.assert_called_once()


if __name__ == "__main__":
    unittest.main()
