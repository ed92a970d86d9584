"""The folder of a run: lock, earlier runs, remembered options."""

import os
import unittest
from unittest import mock

from trio_fakes import UNTIL_TERM, FolderTest

from trio import run_folder
from trio.messages import Problem
from trio.run_folder import RunFolder


class RunFolderTest(FolderTest):
    def test_the_second_run_is_told_who_holds_the_folder(self):
        self.folder.lock()
        with mock.patch.object(run_folder, "LOCK_TIMEOUT_S", 0), self.assertRaises(Problem) as caught:
            RunFolder(self.folder.path).lock()
        self.assertIn(f"is at work in {self.folder.path} (pid {os.getpid()})", str(caught.exception))

    def test_a_process_that_was_left_behind_is_named(self):
        self.folder.lock()
        os.pwrite(self.folder.lock_descriptor, b"999999999", 0)  # of a supervisor that was killed
        process = self.shell("segmenter", UNTIL_TERM)
        process.start()
        with mock.patch.object(run_folder, "LOCK_TIMEOUT_S", 0), self.assertRaises(Problem) as caught:
            RunFolder(self.folder.path).lock()
        self.assertIn(f"segmenter (pid {process.pid})", str(caught.exception))

    def test_a_child_holds_the_lock_too(self):
        self.folder.lock()
        process = self.shell("one", UNTIL_TERM)
        process.start()
        os.close(self.folder.lock_descriptor)
        descriptor = os.open(self.folder.file(".lock"), os.O_RDWR)
        self.addCleanup(os.close, descriptor)
        self.assertFalse(run_folder.try_lock(descriptor))

    def test_the_lock_is_free_when_its_holder_has_ended(self):
        self.folder.lock()
        os.close(self.folder.lock_descriptor)
        other = RunFolder(self.folder.path)
        other.lock()
        os.close(other.lock_descriptor)

    def test_an_earlier_run_is_kept_and_foreign_files_stay(self):
        for name in ("mapper.lcm", "mapper.1.lcm", "segments.ply", "segments.partial.ply", "snapshot_0001.png",
                     "highlight.png", "plots.png", "timeline_12.png", "run.partial.mp4", "trio.options", "notes.txt"):
            (self.folder.path / name).write_text(name)
        self.folder.keep_earlier_run()
        self.assertEqual([path.name for path in self.folder.path.iterdir() if path.is_file()], ["notes.txt"])
        kept = list((self.folder.path / "earlier").iterdir())
        self.assertEqual(len(kept), 1)
        self.assertEqual((kept[0] / "mapper.1.lcm").read_text(), "mapper.1.lcm")
        self.assertIn(f"{self.folder.path} held an earlier run; it is now in {kept[0]}", self.said)

    def test_of_an_earlier_replay_nothing_stays_and_of_a_run_what_a_replay_reads(self):
        kept = ["run.lcm", "run.lcm.partial", "mapper.lcm", "mapper.1.lcm", "segmenter.map", "segmenter.map.views",
                "run.mp4", "trajectory.txt", "trio.options", "mapper.log", "notes.txt"]
        for name in (*kept, "segments.ply", "segments.part1.json", "segments.csv", "final.png", "map_final.part1.png",
                     "snapshot_0001.png", "plots.png", "highlight.png", "timeline_12.png", "objects.json", "status.csv",
                     "player.log", "viewer.log"):
            (self.folder.path / name).write_text(name)
        self.folder.remove_earlier_replay()
        self.assertEqual(sorted(path.name for path in self.folder.path.iterdir()), sorted(kept))

    def test_no_earlier_run_replaces_another(self):
        for content in ("first", "second"):
            file = self.folder.path / "mapper.lcm"
            file.write_text(content)
            os.utime(file, (1e9, 1e9))  # the date names the folder of an earlier run
            self.folder.keep_earlier_run()
        kept = sorted((self.folder.path / "earlier").iterdir())
        self.assertEqual([(path / "mapper.lcm").read_text() for path in kept], ["first", "second"])

    def test_a_new_folder_holds_no_earlier_run(self):
        self.folder.keep_earlier_run()
        self.assertEqual(self.said, "")

    def test_options_are_remembered_word_for_word(self):
        arguments = ["--device", "folder:///a b/c", "--mapper", "", "--viewer", "--view 'x\ny'", "\udcff"]
        self.folder.begin_run(arguments)
        self.assertEqual(self.folder.recall_options(), (os.getcwd(), arguments))

    def test_a_power_cut_finds_no_new_options_beside_files_of_an_earlier_run(self):
        self.folder.begin_run(["--device", "first"])
        (self.folder.path / "mapper.lcm").write_text("slices")
        found = []

        def note(path):
            found.append((os.path.basename(path), sorted(file.name for file in self.folder.path.iterdir())))

        with mock.patch.object(run_folder, "sync_file", note), mock.patch.object(run_folder, "sync_folder", note):
            self.folder.begin_run(["--device", "second"], durable=True)
        names = [name for name, _ in found]
        moved = names.index("run")
        self.assertEqual(names[0], "trio.options.partial")
        self.assertEqual(found[0][1], ["mapper.lcm", "trio.options", "trio.options.partial"])
        self.assertEqual(found[moved][1], ["earlier", "trio.options.partial"])
        self.assertIn("earlier", names[:moved])
        self.assertEqual(found[moved + 1][1], ["earlier", "trio.options"])

    def test_without_a_run_there_is_nothing_to_recall(self):
        with self.assertRaisesRegex(Problem, "holds no run to go on with"):
            self.folder.recall_options()

    def test_on_a_full_disk_the_file_is_named_and_the_earlier_run_stays_as_it_is(self):
        self.folder.begin_run(["--device", "first"])
        (self.folder.path / "mapper.lcm").write_text("slices")
        partial = self.folder.path / "trio.options.partial"
        partial.symlink_to("/dev/full")
        with self.assertRaisesRegex(Problem, "trio.options.partial: No space left on device"):
            self.folder.begin_run(["--device", "second"])
        self.assertEqual(sorted(path.name for path in self.folder.path.iterdir()), ["mapper.lcm", "trio.options"])
        self.assertEqual(self.folder.recall_options()[1], ["--device", "first"])

    def test_an_earlier_run_that_cannot_be_moved_leaves_no_half_written_options(self):
        self.folder.begin_run(["--device", "first"])
        (self.folder.path / "earlier").touch()  # where a folder should be
        with self.assertRaises(OSError):
            self.folder.begin_run(["--device", "second"])
        self.assertEqual(sorted(path.name for path in self.folder.path.iterdir()), ["earlier", "trio.options"])
        self.assertEqual(self.folder.recall_options()[1], ["--device", "first"])


if __name__ == "__main__":
    unittest.main()
