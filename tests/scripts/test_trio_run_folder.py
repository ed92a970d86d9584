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
        for name in ("mapper.lcm", "mapper.1.lcm", "segments.ply", "snapshot_0001.png", "trio.options", "notes.txt"):
            (self.folder.path / name).write_text(name)
        self.folder.keep_earlier_run()
        self.assertEqual([path.name for path in self.folder.path.iterdir() if path.is_file()], ["notes.txt"])
        kept = list((self.folder.path / "earlier").iterdir())
        self.assertEqual(len(kept), 1)
        self.assertEqual((kept[0] / "mapper.1.lcm").read_text(), "mapper.1.lcm")
        self.assertIn(f"{self.folder.path} held an earlier run; it is now in {kept[0]}", self.said)

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
        self.folder.remember_options(arguments)
        self.assertEqual(self.folder.recall_options(), (os.getcwd(), arguments))

    def test_without_a_run_there_is_nothing_to_recall(self):
        with self.assertRaisesRegex(Problem, "holds no run to go on with"):
            self.folder.recall_options()

    def test_a_full_disk_is_named_with_the_file(self):
        os.symlink("/dev/full", self.folder.file("trio.options.partial"))
        with self.assertRaisesRegex(Problem, "trio.options: No space left on device"):
            self.folder.remember_options([])
        self.assertFalse(os.path.lexists(self.folder.file("trio.options.partial")))


if __name__ == "__main__":
    unittest.main()
