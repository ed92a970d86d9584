"""The log of the bus: what a logger has left half written, and what is synced when."""

import os
import unittest
from unittest import mock

from trio_fakes import FolderTest

from trio import recording
from trio.recording import HEADER, SYNC_WORD, Recording, cut_after_last_event


def event(number, data=b"data"):
    return HEADER.pack(SYNC_WORD, number, 1_000, 4, len(data)) + b"CHAN" + data


class RecordingTest(FolderTest):
    def setUp(self):
        super().setUp()
        self.log = self.folder.path / "run.lcm.partial"

    def test_what_is_left_half_written_is_cut_off(self):
        whole = event(0) + event(1, b"")
        for rest in (b"", event(2)[:5], event(2)[:-1], bytes(5_000), HEADER.pack(SYNC_WORD, 2, 1_000, 0, 4) + b"data",
                     HEADER.pack(SYNC_WORD, 2, 1_000, 4, 2**31) + event(2)):
            self.log.write_bytes(whole + rest)
            cut_after_last_event(self.log)
            self.assertEqual(self.log.read_bytes(), whole)
        self.log.write_bytes(b"")
        cut_after_last_event(self.log)
        self.assertEqual(self.log.read_bytes(), b"")

    def test_the_logger_goes_on_behind_the_last_whole_event(self):
        self.log.write_bytes(event(0) + b"half")
        Recording(self.folder.path).begin()
        self.assertEqual(self.log.read_bytes(), event(0))

    def test_a_run_that_is_resumed_goes_on_with_its_recording(self):
        for number in range(2):
            recording = Recording(self.folder.path)
            recording.begin()
            with self.log.open("ab") as logger:
                logger.write(event(number))
            recording.end()
        self.assertEqual((self.folder.path / "run.lcm").read_bytes(), event(0) + event(1))

    def test_a_durable_one_has_its_names_and_contents_on_the_disk(self):
        done = []

        def note(what):
            return lambda path: done.append((what, os.path.basename(path), sorted(os.listdir(self.folder.path))))

        with (mock.patch.object(recording, "sync_file", note("file")),
              mock.patch.object(recording, "sync_folder", note("folder"))):
            log = Recording(self.folder.path, durable=True)
            log.begin()
            log.end()
        self.assertEqual(done, [("folder", "run", ["run.lcm.partial"]), ("file", "run.lcm.partial", ["run.lcm.partial"]),
                                ("folder", "run", ["run.lcm"])])


if __name__ == "__main__":
    unittest.main()
