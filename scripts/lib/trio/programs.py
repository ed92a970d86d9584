"""Where the programs are."""

import os
import shutil

from .messages import Problem

ROOT = os.path.realpath(os.path.join(os.path.dirname(__file__), "..", "..", ".."))
BIN = os.path.abspath(os.environ.get("KINTSUGI_BIN") or os.path.join(ROOT, "build", "release", "bin"))


# Processes whose program has another name: the words behind "kintsugi-".
WORDS = {"detector": ("objects", "detect")}


def program(name):
    """The path of kintsugi-NAME; the environment variable KINTSUGI_BIN names the folder."""
    return os.path.join(BIN, "kintsugi-" + name)


def command_of(name):
    """The words with which a command line of a process of the run begins."""
    first, *rest = WORDS.get(name, (name,))
    return [program(first), *rest]


def called(name):
    """What a person calls to run a process of the run."""
    return " ".join(("kintsugi-" + WORDS.get(name, (name,))[0], *WORDS.get(name, (name,))[1:]))


def check_programs(names, commands):
    """Raises Problem unless the programs of all processes and the commands of the system are there."""
    for name in names:
        path = command_of(name)[0]
        if not os.access(path, os.X_OK):
            raise Problem(f"there is no {os.path.basename(path)} in {BIN}; run scripts/build first")
    for command in commands:
        if not shutil.which(command):
            raise Problem(f"the command {command} is not installed; scripts/build installs what is missing")
