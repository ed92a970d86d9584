"""What a run took and wrote, as shown at its end."""

import re
import unittest

from trio_fakes import FolderTest

from trio.summary import show_summary


class Summary(FolderTest):
    def process(self, name, cpu_s, peak_memory_MB):
        process = self.shell(name, "")
        process.cpu_s, process.peak_memory_MB = cpu_s, peak_memory_MB
        return process

    def test_names_processor_time_and_memory_as_other_scripts_read_them(self):
        show_summary(self.folder, [self.process("mapper", 17.128, 101), self.process("viewer", 1.2, 126)])
        self.assertIn("  CPU: mapper 17.13 s, viewer 1.20 s\n", self.said)
        self.assertIn("  memory at most: mapper 101 MB, viewer 126 MB\n", self.said)
        # scripts/lib/faults.sh and scripts/lib/bench/mapping.py
        self.assertEqual(re.findall(r"(?m)^ *memory at most:.* viewer ([0-9]+) MB.*", self.said), ["126"])
        self.assertEqual(re.findall(r"(?m)^ *CPU:.* mapper ([0-9.]+) s.*", self.said), ["17.13"])

    def test_leaves_out_what_never_ran(self):
        show_summary(self.folder, [self.process("mapper", None, None), self.process("viewer", 1.0, 2)])
        self.assertIn("  CPU: viewer 1.00 s\n", self.said)

    def test_names_the_files_that_are_there(self):
        for name in ("segments.ply", "run.lcm", "snapshot_0001.png", "snapshot_0002.png"):
            (self.folder.path / name).touch()
        show_summary(self.folder, [])
        self.assertIn(self.folder.file("segments.ply") + " ", self.said)
        self.assertIn(self.folder.file("run.lcm") + " ", self.said)
        self.assertIn("2 pictures of the run", self.said)
        self.assertNotIn("trajectory.txt", self.said)

    def test_tells_the_parts_of_the_map_and_their_files(self):
        for name in ("segments.ply", "segments.part1.ply", "segments.part2.ply", "segments.part10.ply",
                     "trajectory.part1.txt", "run.lcm.partial"):
            (self.folder.path / name).touch()
        show_summary(self.folder, [])
        self.assertIn("the map has 4 parts", self.said)
        self.assertRegex(self.said, r"(?s)segments\.ply .*part1\.ply +the same of part 1.*part2\.ply .*part10\.ply ")
        self.assertIn(self.folder.file("trajectory.part1.txt") + " ", self.said)

    def test_counts_part_0_once_when_its_pictures_have_its_number(self):
        for name in ("segments.ply", "segments.part1.ply", "final.png", "final.part0.png"):
            (self.folder.path / name).touch()
        show_summary(self.folder, [])
        self.assertIn("the map has 2 parts", self.said)
        self.assertRegex(self.said, r"final\.part0\.png +the same of part 0")

    def test_says_nothing_of_parts_when_there_is_one(self):
        (self.folder.path / "segments.ply").touch()
        show_summary(self.folder, [])
        self.assertNotIn("part", self.said)


if __name__ == "__main__":
    unittest.main()
