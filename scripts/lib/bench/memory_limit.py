"""A hard limit on the memory of a command, with the pages of files that the system keeps for it: a control group of Linux,
which takes root."""

import os
from pathlib import Path

from trio.messages import Problem

GROUPS = Path("/sys/fs/cgroup")
ENTER = 'echo $$ > "$0/cgroup.procs" && exec "$@"'


class MemoryLimit:
    """As long as the `with` lasts. A Problem if there is no such group to be had."""

    def __init__(self, num_bytes):
        self.num_bytes = num_bytes
        is_unified = (GROUPS / "cgroup.controllers").exists()
        self.group = (GROUPS if is_unified else GROUPS / "memory") / f"kintsugi-bench-{os.getpid()}"
        self.file = self.group / ("memory.max" if is_unified else "memory.limit_in_bytes")

    def __enter__(self):
        try:
            self.group.mkdir()
            self.file.write_text(str(self.num_bytes))
        except OSError as error:
            self.__exit__()
            raise Problem(f"no control group with a limit on memory, which takes root: {error}") from error
        return self

    def __exit__(self, *_):
        if self.group.is_dir():
            self.group.rmdir()

    def command(self, *words):
        return ["bash", "-c", ENTER, self.group, *words]
