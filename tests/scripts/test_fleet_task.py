"""One task: what it runs, what it measures, and what it says when something fails."""

import json
import resource
from unittest import mock

from fleet_fakes import FleetTest
from trio_fakes import write_program

from fleet import measures
from fleet.folder import FleetFolder
from fleet.inputs import Input
from fleet.task import do_task

SETTINGS = {"preset": "", "maps": True, "cloud": [], "segmenter": [], "mapper": []}


class TaskTest(FleetTest):
    def setUp(self):
        super().setUp()
        self.folder = FleetFolder(self.out)

    def do(self, given, timeout_s=0, **settings):
        self.folder.begin([given], {**SETTINGS, **settings})
        row = do_task(self.folder, [given], {**SETTINGS, **settings}, given.name, timeout_s)
        self.assertEqual(row, self.folder.row(given.name))
        return row

    def cloud(self, script, **given):
        return Input("a", str(self.write("a.ply", script)), **given)

    def expect_failed(self, row, reason, exit_code=None):
        self.assertEqual((row["state"], row["reason"], row.get("exit_code")), ("failed", reason, exit_code))

    def test_a_cloud_with_truth(self):
        row = self.do(self.cloud("", truth="/truth.ply"))
        self.assertEqual({key: row[key] for key in ("state", "points", "segments", "object_iou", "instance_iou",
                                                    "objects_found", "objects")},
                         {"state": "done", "points": 100, "segments": 4, "object_iou": 0.5, "instance_iou": 0.75,
                          "objects_found": 3, "objects": 6})
        self.assertNotIn("ate_m", row)

    def test_a_recording_of_a_scene_is_mapped_segmented_and_compared(self):
        row = self.do(Input("a", "synthetic://office"))
        self.assertEqual({key: row.get(key) for key in ("state", "kind", "points", "segments", "parts", "frames", "located",
                                                        "object_iou", "ate_m")},
                         {"state": "done", "kind": "recording", "points": 12, "segments": 3, "parts": 2, "frames": 2,
                          "located": 1, "object_iou": 0.5, "ate_m": 0.25})

    def test_the_path_of_a_folder_with_truth_in_numbers_of_frames(self):
        recording = self.here / "walk"
        recording.mkdir()
        (recording / "groundtruth.txt").write_text("".join(f"{number} 0 0 0 0 0 0 1\n" for number in range(4)))
        self.assertEqual(self.do(Input("a", str(recording)))["ate_m"], 0.25)
        self.assertIn("0.033333 0", (self.out / "results/a/truth_in_seconds.txt").read_text())

    def test_a_path_too_short_for_motions_is_compared_without(self):
        write_program(self.programs / "kintsugi-evaluate", "case \"$*\" in *--all-pairs*) "
                      "printf 'ate_m_pairs,ate_m_rmse\\n4,0.125\\n' > $6 ;; *--csv*) exit 1 ;; esac")
        self.assertEqual(self.do(Input("a", "synthetic://office"))["ate_m"], 0.125)

    def test_a_path_that_cannot_be_compared_fails_only_where_that_was_asked_for(self):
        write_program(self.programs / "kintsugi-evaluate", "echo no poses; exit 1")
        recording = self.here / "walk"
        recording.mkdir()
        (recording / "groundtruth.txt").write_text("0.5 0 0 0 0 0 0 1\n")
        row = self.do(Input("a", str(recording)))
        self.assertEqual((row["state"], row["reason"]), ("done", "the path was not compared: no poses"))
        row = self.do(Input("b", str(recording), path=str(recording / "groundtruth.txt")))
        self.expect_failed(row, "no poses", 1)

    def test_time_and_memory_are_those_of_the_programs(self):
        # 60 MB in a string of the shell, made by doubling.
        row = self.do(self.cloud("x=0123456789012345678901234567890123456789012345678901234567890; "
                                 "for i in 1 2 3 4 5 6 7 8 9 10 11 12 13 14 15 16 17 18 19 20; do x=$x$x; done; sleep 0.2"))
        self.assertEqual(row["state"], "done")
        self.assertGreater(row["peak_memory_MB"], 60)
        self.assertLess(row["peak_memory_MB"], 10 * 60)
        self.assertGreater(row["cpu_s"], 0)
        self.assertGreaterEqual(row["wall_s"], 0.2)

    def test_the_reason_is_the_error_that_a_program_told(self):
        self.expect_failed(self.do(self.cloud("echo 'kintsugi-segment-cloud: a.ply: line 3: no numbers'; echo bye; exit 1")),
                           "a.ply: line 3: no numbers", 1)
        self.expect_failed(self.do(self.cloud("echo only this; exit 5")), "only this", 5)
        self.expect_failed(self.do(self.cloud("exit 6")), "kintsugi-segment-cloud ended with exit code 6, without a word", 6)

    def test_what_earlier_programs_said_is_no_reason(self):
        write_program(self.programs / "kintsugi-evaluate", "exit 4")
        row = self.do(self.cloud("echo 'error: not so bad'", truth="/t.ply"))
        self.expect_failed(row, "kintsugi-evaluate ended with exit code 4, without a word", 4)
        self.assertEqual((row["step"], row["points"]), ("quality", 100))

    def test_a_program_that_was_killed(self):
        self.expect_failed(self.do(self.cloud("kill -KILL $$")),
                           "kintsugi-segment-cloud was killed by SIGKILL: perhaps there was too little memory", -9)
        self.expect_failed(self.do(self.cloud("kill -SEGV $$")), "kintsugi-segment-cloud was killed by SIGSEGV", -11)

    def test_a_program_that_takes_too_long_is_ended(self):
        with mock.patch.object(measures, "END_S", 0.2):
            row = self.do(self.cloud("trap '' TERM; while :; do sleep 0.05; done"), timeout_s=0.2)
        self.assertEqual((row["state"], row["reason"]), ("failed", "kintsugi-segment-cloud took longer than --timeout"))

    def test_an_input_that_is_not_there(self):
        self.expect_failed(self.do(Input("a", "/no/such.ply")), "/no/such.ply: No such file or directory")

    def test_a_file_of_a_program_that_is_not_as_expected(self):
        row = self.do(self.cloud("segments=half"))
        self.assertEqual(row["state"], "failed")
        self.assertIn("JSONDecodeError", row["reason"])

    def test_without_maps_the_description_and_the_messages_are_kept(self):
        self.do(self.cloud("echo said"), maps=False)
        names = sorted(path.name for path in (self.out / "results/a").iterdir())
        self.assertEqual(names, ["messages.txt", "row.json", "segments.json"])
        self.assertIn("said", (self.out / "results/a/messages.txt").read_text())

    def test_what_cannot_be_written_is_no_result(self):
        given = self.cloud("")
        self.folder.begin([given], SETTINGS)
        limits = resource.getrlimit(resource.RLIMIT_FSIZE)
        resource.setrlimit(resource.RLIMIT_FSIZE, (0, limits[1]))
        try:
            with self.assertRaises(OSError):
                do_task(self.folder, [given], SETTINGS, "a")
        finally:
            resource.setrlimit(resource.RLIMIT_FSIZE, limits)
        self.assertEqual(self.folder.rows([given])[0]["state"], "missing")
        self.assertEqual(json.loads((self.out / "fleet.json").read_text())["inputs"][0]["name"], "a")
