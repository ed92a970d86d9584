"""The list of a fleet: its lines, and the names of its inputs."""

import io
import os
import unittest
from unittest import mock

from fleet_fakes import FleetTest

from fleet import inputs, work
from fleet.inputs import Input, read_list
from trio.messages import Problem


class ListTest(FleetTest):
    def read(self, text):
        return read_list(str(self.write("list.txt", text)))

    def problem(self, text):
        with self.assertRaises(Problem) as caught:
            self.read(text)
        self.assertEqual(caught.exception.exit_code, 2)
        return str(caught.exception)

    def test_a_line_has_a_path_and_what_belongs_to_it(self):
        given = self.read("# John's clouds\n\n"
                          "rooms/hall.ply truth=hall_truth.ply   # from the\tsecond floor\n"
                          "'/data/my walk' name=walk path=walk.txt kind=recording mapper='--resolution 0.02' "
                          "segmenter=--preset=paper\r\n"
                          "synthetic://office?frames=60\n")
        self.assertEqual(given, [
            Input("hall", f"{self.here}/rooms/hall.ply", truth=f"{self.here}/hall_truth.ply"),
            Input("walk", "/data/my walk", "recording", path=f"{self.here}/walk.txt",
                  words={"mapper": ["--resolution", "0.02"], "segmenter": ["--preset=paper"]}),
            Input("office_frames=60", "synthetic://office?frames=60")])

    def test_paths_are_relative_to_the_list_and_on_standard_input_to_the_current_folder(self):
        (self.here / "lists").mkdir()
        self.write("lists/list.txt", "a.ply\n")
        self.assertEqual(read_list(str(self.here / "lists/list.txt"))[0].device, f"{self.here}/lists/a.ply")
        with mock.patch("sys.stdin", io.StringIO("a.ply\n")):
            self.assertEqual(read_list("-")[0].device, os.path.join(os.getcwd(), "a.ply"))

    def test_equal_names_are_told_apart_by_the_folders_above(self):
        names = [given.name for given in self.read("s1/scan.ply\ns2/scan.ply\nother.ply\nx/scan.las name=scan\n")]
        self.assertEqual(names, ["s1_scan", "s2_scan", "other", "scan"])
        names = [given.name for given in self.read("same.ply\nsame.ply\n")]
        self.assertEqual(len(set(names)), 2)

    def test_an_input_keeps_its_name_when_others_are_added(self):
        before = self.read("s1/scan.ply\nsame.ply\nsame.ply cloud='--unit cm'\n")
        self.assertEqual(before[0].name, "scan")
        text = "s2/scan.ply\nsame.ply cloud='--unit cm'\ns1/scan.ply\nsame.ply\nsame.ply\ns2/scan.ply name=mine\n"
        now = read_list(str(self.write("list.txt", text)), before)
        self.assertEqual(now[1:4], [before[2], before[0], before[1]])
        self.assertEqual([now[0].name, now[5].name], ["s2_scan", "mine"])
        self.assertEqual(len({given.name for given in now}), 6)
        self.assertEqual(read_list(str(self.here / "list.txt"), now), now)

    def test_a_name_that_a_line_gives_is_taken_from_the_input_that_had_it(self):
        before = self.read("s1/scan.ply\n")
        now = read_list(str(self.write("list.txt", "s1/scan.ply\ns2/scan.ply name=scan\n")), before)
        self.assertEqual([given.name for given in now], ["s1_scan", "scan"])

    def test_a_name_can_be_a_folder_whatever_the_path_is(self):
        for path in ("'/a/.hidden'", "/a/b/", "'/a/weird *name;.ply'", "synthetic://office?frames=9&speed=2", "/",
                     "/a/" + "x" * 300 + ".ply"):
            with self.subTest(path=path):
                self.assertRegex(self.read(path)[0].name, inputs.NAME.pattern + "$")

    def test_each_wrong_line_is_told_with_its_number_and_what_was_expected(self):
        text = self.problem("a.ply\nmy cloud.ply\nb.ply truth=\nc.ply name=a/b\nd.ply kind=mesh\ne.ply name=x\n"
                            "f.ply name=x\ng.ply name=y name=z\nh.ply 'open\ni.ply mapper='--store x'\n"
                            "j.ply segmenter='--help'\n")
        file = f"{self.here}/list.txt"
        self.assertEqual([line.strip().partition(": ")[0] for line in text.splitlines()],
                         [f"{file}:{number}" for number in (2, 3, 4, 5, 7, 8, 9, 10, 11)])
        for told in ("'cloud.ply': expected name=, truth=, path=, kind=", "a path with blanks needs quotes",
                     "truth= needs a value", "kind=mesh: expected one of cloud, log, recording",
                     "name=x in line 6 already", "name= is given twice", "No closing quotation",
                     "scripts/fleet sets --store itself", "only prints and ends with --help"):
            self.assertIn(told, text)

    def test_of_many_wrong_lines_the_first_are_told(self):
        text = self.problem("a b\n" * 50)
        self.assertEqual(len(text.splitlines()), inputs.SHOWN_ERRORS + 1)
        self.assertIn("and 40 more", text)

    def test_an_empty_list_and_one_that_is_not_there(self):
        self.assertIn("there is no input in it", self.problem("# nothing\n\n"))
        with self.assertRaises(Problem) as caught:
            read_list(str(self.here / "none.txt"))
        self.assertIn("none.txt: No such file", str(caught.exception))

    def test_names_that_are_not_utf8_are_kept(self):
        (self.here / "list.txt").write_bytes(b"\xff.ply name=odd\n")
        self.assertEqual(os.fsencode(read_list(str(self.here / "list.txt"))[0].device), os.fsencode(self.here) + b"/\xff.ply")


class KindTest(FleetTest):
    def kind(self, name, content=b"", **given):
        (self.here / name).write_bytes(content)
        return work.kind_of(Input("x", str(self.here / name), **given))

    def test_endings_contents_folders_and_addresses(self):
        self.assertEqual(self.kind("a.PLY"), "cloud")
        self.assertEqual(self.kind("a.las"), "cloud")
        self.assertEqual(self.kind("a.klg"), "recording")
        self.assertEqual(self.kind("lcmlog-2026-01-01.00", b"\xed\xa1\xda\x01...."), "log")
        self.assertEqual(self.kind("a.xyz", kind="recording"), "recording")
        self.assertEqual(work.kind_of(Input("x", str(self.here))), "recording")
        self.assertEqual(work.kind_of(Input("x", "synthetic://office")), "recording")

    def test_what_is_not_there_or_unknown_is_told(self):
        with self.assertRaisesRegex(Problem, "none.ply: No such file"):
            work.kind_of(Input("x", str(self.here / "none.ply")))
        with self.assertRaisesRegex(Problem, "expected a cloud .*, a log of LCM, a recording .*kind="):
            self.kind("notes.md")


class StepsTest(unittest.TestCase):
    SETTINGS = {"preset": "paper", "maps": True, "cloud": ["--unit", "cm"], "segmenter": [], "mapper": ["--resolution=0.01"]}

    def commands(self, kind, **given):
        steps = work.steps_of(Input("x", **given), kind, self.SETTINGS)
        return [(step.what, [os.path.basename(step.command[0]), *step.command[1:]]) for step in steps]

    def test_options_of_a_line_count_more_than_those_of_the_fleet(self):
        self.assertEqual(self.commands("cloud", device="/a.ply", words={"cloud": ["--unit", "mm"]}), [
            ("segment", ["kintsugi-segment-cloud", "/a.ply", "labelled.ply", "--json=segments.json", "--preset=paper",
                         "--unit", "mm"])])

    def test_a_scene_is_compared_with_its_truth(self):
        steps = self.commands("recording", device="synthetic://office", words={"mapper": ["--linger=1"]})
        self.assertEqual([what for what, _ in steps], ["map", "segment", "truth", "quality"])
        mapper = steps[0][1]
        self.assertIn("--lcm-url=memq://", mapper)
        self.assertIn("--resolution=0.01", mapper)
        self.assertEqual([word for word in mapper if word.startswith("--linger")], ["--linger=1"])

    def test_a_log_with_truth(self):
        self.assertEqual([what for what, _ in self.commands("log", device="/a.lcm", truth="/t.ply")], ["segment", "quality"])
        self.assertEqual([what for what, _ in self.commands("log", device="/a.lcm")], ["segment"])
