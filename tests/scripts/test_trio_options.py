"""The command lines of scripts/trio and scripts/replay."""

import unittest

from trio_fakes import ROOT  # noqa: F401  (sets the import path)

from trio.messages import Problem
from trio.options import REPLAY_OPTIONS, TRIO_OPTIONS, Parser, parse_replay, parse_trio


class TrioOptions(unittest.TestCase):
    def expect_problem(self, arguments, text, parse=parse_trio):
        with self.assertRaises(Problem) as caught:
            parse(arguments)
        self.assertIn(text, str(caught.exception))
        self.assertEqual(caught.exception.exit_code, 2)

    def test_help_shows_every_option(self):
        for table in (TRIO_OPTIONS, REPLAY_OPTIONS):
            shown = Parser("command", table).format_help()
            for flag, metavar, *_ in table:
                self.assertIn(f"{flag} {metavar}" if metavar else flag, shown)

    def test_options_reach_their_processes(self):
        options = parse_trio(["--device", "synthetic://office", "--resolution=0.02", "--replay", "--preset", "paper",
                              "--every", "2"])
        self.assertEqual(options.mapper, ["--device=synthetic://office", "--resolution=0.02", "--replay"])
        self.assertEqual(options.segmenter, ["--preset=paper"])
        self.assertEqual(options.viewer, ["--every=2"])

    def test_the_last_of_two_equal_options_counts(self):
        options = parse_trio(["--device", "a.oni", "--replay", "--out", "one", "--device", "b.oni", "--replay",
                              "--out", "two"])
        self.assertCountEqual(options.mapper, ["--device=b.oni", "--replay"])
        self.assertEqual(options.out, "two")

    def test_an_empty_device_is_the_first_camera(self):
        self.assertEqual(parse_trio(["--device", ""]).mapper, [])
        self.assertEqual(parse_trio(["--device="]).mapper, [])
        self.assertEqual(parse_trio(["--device", "synthetic://office", "--device", ""]).mapper, [])

    def test_further_options_are_split_as_in_a_shell(self):
        options = parse_trio(["--mapper", "--session=7 --cloud '/a b/c.ply'", "--viewer", "--view \"1,2, 3\"",
                              "--mapper", r"--mesh d\ e.ply", "--segmenter", ""])
        self.assertEqual(options.mapper, ["--session=7", "--cloud", "/a b/c.ply", "--mesh", "d e.ply"])
        self.assertEqual(options.viewer, ["--view", "1,2, 3"])
        self.assertEqual(options.segmenter, [])

    def test_a_limited_log_is_passed_on_and_nothing_is_recorded_without_limit(self):
        for arguments in (["--store-limit", "500"], ["--mapper", "--store-limit=500"], ["--mapper", "--store-limit 500"]):
            options = parse_trio(arguments)
            self.assertEqual("=".join(options.mapper), "--store-limit=500")
            self.assertTrue(options.is_long and options.no_log)
        for arguments in ([], ["--store-limit", "0"], ["--mapper", "--store-limit 0.0"],
                          ["--store-limit", "500", "--store-limit", "0"]):
            options = parse_trio(arguments)
            self.assertFalse(options.is_long or options.no_log, arguments)

    def test_objects_add_the_detector_before_the_last_process(self):
        self.assertEqual(parse_trio([]).only, ["mapper", "segmenter", "viewer"])
        options = parse_trio(["--objects", "my objects", "--detector", "--map-name attic"])
        self.assertEqual(options.only, ["mapper", "segmenter", "detector", "viewer"])
        self.assertEqual(options.objects, "my objects")
        self.assertEqual(options.detector, ["--map-name", "attic"])
        for only, processes in (("segmenter", ["detector", "segmenter"]),
                                ("mapper,segmenter", ["mapper", "detector", "segmenter"])):
            self.assertEqual(parse_trio(["--objects=a", "--only", only]).only, processes)
        self.assertEqual(parse_replay(["run.lcm", "--objects=a"]).only, ["segmenter", "detector", "viewer"])

    def test_a_detector_needs_objects_and_the_segmenter(self):
        self.expect_problem(["--detector", "--map-name attic"], "--detector needs --objects DIR")
        self.expect_problem(["--objects=a", "--only", "viewer"], "--objects needs the segmenter")
        self.expect_problem(["--objects"], "--objects needs a value")
        self.expect_problem(["--objects=a", "--detector", "--library b"], "--objects of scripts/trio chooses the library")
        self.expect_problem(["--objects=a", "--detector", "--help"], "kintsugi-objects detect only prints")

    def test_a_value_may_begin_with_a_dash(self):
        self.assertEqual(parse_trio(["--mapper", "--session=7", "--no-log"]).mapper, ["--session=7"])

    def test_the_last_of_two_equal_options_counts_for_further_options_too(self):
        self.assertEqual(parse_trio(["--mapper", "--device x", "--device", "y"]).mapper, ["--device=y"])
        self.assertEqual(parse_trio(["--device", "y", "--mapper", "--device x"]).mapper, ["--device", "x"])
        options = parse_trio(["--mapper", "--rate 3 --session=7", "--mapper", "--rate=5"])
        self.assertEqual(options.mapper, ["--session=7", "--rate=5"])
        self.assertEqual(parse_trio(["--viewer", "--highlight 1 --highlight 2"]).viewer,
                         ["--highlight", "1", "--highlight", "2"])

    def test_options_that_belong_to_the_run_are_refused_with_the_reason(self):
        self.expect_problem(["--mapper", "--store my.lcm"], "--mapper '--store my.lcm': scripts/trio sets --store itself: "
                            "the log is mapper.lcm in the folder of the run; --out chooses the folder")
        self.expect_problem(["--mapper", "--resume=my.lcm"], "scripts/trio --resume continues the run")
        self.expect_problem(["--segmenter", "--out x"], "--out of scripts/trio chooses the folder")
        self.expect_problem(["--segmenter", "--save x"], "--save itself")
        self.expect_problem(["--viewer", "--out=x"], "--viewer '--out=x': scripts/trio sets --out itself")
        self.expect_problem(["run.lcm", "--viewer", "--out=x"], "--out of scripts/replay chooses", parse_replay)

    def test_options_with_which_a_process_only_prints_are_refused(self):
        self.expect_problem(["--mapper", "--rate 3 --help"], "--mapper '--help': kintsugi-mapper only prints and ends")
        self.expect_problem(["--viewer", "--print-config"], "run it by itself")

    def test_a_quote_that_is_not_closed_is_an_error(self):
        self.expect_problem(["--mapper", "--cloud 'a b"], "--mapper --cloud 'a b: No closing quotation")

    def test_wrong_options_are_named(self):
        self.expect_problem(["--nonsense"], "unknown option --nonsense")
        self.expect_problem(["--res", "1"], "unknown option --res")
        self.expect_problem(["stray"], "unknown option stray")
        self.expect_problem(["--out"], "--out needs a value")
        self.expect_problem(["--resolution", ""], "--resolution needs a value")
        self.expect_problem(["--private=yes"], "--private")

    def test_only_names_processes_in_any_order(self):
        self.assertEqual(parse_trio([]).only, ["mapper", "segmenter", "viewer"])
        self.assertEqual(parse_trio(["--only", "viewer,segmenter"]).only, ["segmenter", "viewer"])
        self.expect_problem(["--only", "painter"], "--only painter")
        self.expect_problem(["--only", "mapper,"], "--only mapper,")

    def test_two_command_lines_share_nothing(self):
        parse_trio(["--mapper", "--session=7", "--device", "a.oni"])
        self.assertEqual(parse_trio([]).mapper, [])


class ReplayOptions(unittest.TestCase):
    def test_the_log_may_stand_anywhere(self):
        for arguments in (["run.lcm", "--speed", "4"], ["--speed", "4", "run.lcm"]):
            options = parse_replay(arguments)
            self.assertEqual((options.log, options.speed, options.out), ("run.lcm", "4", "out/replay"))

    def test_a_log_is_needed(self):
        with self.assertRaisesRegex(Problem, "which log"):
            parse_replay([])

    def test_the_map_may_be_saved(self):
        options = parse_replay(["run.lcm", "--segmenter", "--save x.map"])
        self.assertEqual(options.segmenter, ["--save", "x.map"])

    def test_there_is_no_mapper(self):
        with self.assertRaisesRegex(Problem, "unknown option --mapper"):
            parse_replay(["run.lcm", "--mapper", "x"])


if __name__ == "__main__":
    unittest.main()
