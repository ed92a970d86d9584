"""Shared by the tests of scripts/lib/trio: its import path, small processes, and fake programs in place of
the real ones."""

import os
import signal
import sys
import time
import unittest
from pathlib import Path
from tempfile import TemporaryDirectory
from unittest import mock

ROOT = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "scripts" / "lib"))

from trio import messages  # noqa: E402
from trio.process import Process, stop  # noqa: E402
from trio.run_folder import RunFolder  # noqa: E402

PATIENCE_S = 30  # for what has to happen sooner or later

UNTIL_TERM = "trap 'exit 0' TERM; while :; do sleep 0.02; done"


def wait_until(condition):
    """Whether it comes true."""
    deadline = time.monotonic() + PATIENCE_S
    while not condition():
        if time.monotonic() > deadline:
            return False
        time.sleep(0.02)
    return True


class FolderTest(unittest.TestCase):
    """Has a folder of a run, and what was said to the person."""

    def setUp(self):
        temporary = TemporaryDirectory()
        self.addCleanup(temporary.cleanup)
        self.temporary = Path(temporary.name)
        self.folder = RunFolder(self.temporary / "run")
        self.folder.create()
        self.said = ""
        patch = mock.patch.object(messages.os, "write", self._hear)
        patch.start()
        self.addCleanup(patch.stop)

    def _hear(self, descriptor, text):
        self.said += text.decode()
        return len(text)

    def shell(self, name, script, **arguments):
        """A process that runs a script of the shell; ended with the test."""
        process = Process(name, ["/bin/sh", "-c", script], self.folder, **arguments)
        self.addCleanup(stop, [process], signal.SIGKILL, PATIENCE_S)
        return process


def write_program(path, script):
    path.write_text("#!/bin/sh\n" + script + "\n", encoding="utf-8")
    path.chmod(0o755)


def process_is_gone(pid):
    """Ended, perhaps not yet waited for by its parent."""
    try:
        with open(f"/proc/{pid}/stat", encoding="utf-8") as file:
            return file.read().rpartition(") ")[2].startswith("Z")
    except OSError:
        return True


def environment(programs):
    """For a script of ours that shall run the programs in this folder, on a bus that nobody uses."""
    return {**os.environ, "KINTSUGI_BIN": str(programs), "PATH": f"{programs}:{os.environ['PATH']}",
            "LCM_DEFAULT_URL": "memq://"}
