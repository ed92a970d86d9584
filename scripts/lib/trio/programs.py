"""Where the programs are."""

import os
import shutil

from .messages import Problem

ROOT = os.path.realpath(os.path.join(os.path.dirname(__file__), "..", "..", ".."))
BIN = os.path.abspath(os.environ.get("KINTSUGI_BIN") or os.path.join(ROOT, "build", "release", "bin"))


def program(name):
    """The path of kintsugi-NAME; the environment variable KINTSUGI_BIN names the folder."""
    return os.path.join(BIN, "kintsugi-" + name)


def check_programs(names, commands):
    """Raises Problem unless all kintsugi-NAME and the commands of the system are there."""
    for name in names:
        if not os.access(program(name), os.X_OK):
            raise Problem(f"there is no kintsugi-{name} in {BIN}; run scripts/build first")
    for command in commands:
        if not shutil.which(command):
            raise Problem(f"the command {command} is not installed; scripts/build installs what is missing")
