"""The command lines of scripts/fleet. One table each, as those of scripts/trio."""

import argparse
import shlex
import textwrap

from trio.messages import Problem
from trio.options import STORE, Parser
from trio.process_options import ProcessOptions

# The programs that work on inputs, by the word that names them on the command line and in the list.
PROGRAMS = {"cloud": "segment-cloud", "segmenter": "segmenter", "mapper": "mapper"}

# Flag, metavar (None: a switch), STORE, default, help.
RUN_OPTIONS = (
    ("--out", "DIR", STORE, "out/fleet",
     "folder of the fleet (default %(default)s). A second run in it does only what is missing or has failed"),
    ("--scheduler", "NAME", STORE, "auto",
     "slurm: job arrays; parallel: GNU parallel on this machine; auto (default): Slurm where its controller answers"),
    ("--jobs", "N", STORE, "0",
     "tasks at a time (default: as many as there is room for)"),
    ("--cpus", "N", STORE, "1", "processors for each task (default %(default)s)"),
    ("--timeout", "S", STORE, "0", "a program that takes longer is ended, and its input has failed (default: never)"),
    ("--preset", "NAME", STORE, "", "parameters of the segmentation: objects (default) or paper"),
    ("--cloud", "'ARGS'", STORE, "", "further options of kintsugi-segment-cloud, quoted as in a shell"),
    ("--segmenter", "'ARGS'", STORE, "", "further options of kintsugi-segmenter"),
    ("--mapper", "'ARGS'", STORE, "", "further options of kintsugi-mapper"),
    ("--no-maps", None, STORE, False,
     "keep of each input its row, its messages and the description of its segments, but no clouds and no logs"),
    ("--sbatch", "'ARGS'", STORE, "", "further options of sbatch, as --sbatch '--partition=long --mem=4G'"),
    ("--parallel", "'ARGS'", STORE, "", "further options of GNU parallel, as --parallel '--memfree 2G'"),
)
MAY_BE_EMPTY = {"--preset", "--cloud", "--segmenter", "--mapper", "--sbatch", "--parallel"}
SCHEDULERS = ("auto", "slurm", "parallel")

LIST_HELP = """\
LIST is a file with one input a line, or - for standard input:

    PATH [name=NAME] [truth=FILE] [path=FILE] [kind=KIND] [cloud='ARGS'] [segmenter='ARGS'] [mapper='ARGS']

PATH is a point cloud (PLY, PCD, LAS, NPY, text), an LCM log of a mapper, or a recording: what --device of
kintsugi-mapper takes, a folder or synthetic://NAME too. kind=cloud, log or recording says so where the name does not.
truth is a PLY file with the true instances, path the camera's true path (TUM format); both are known of synthetic
scenes, and the path of folders with groundtruth.txt. These paths are relative to the folder of LIST (of -: to the
current folder); files in ARGS need their whole paths, because the programs run in the folder of the result. Words with
blanks are quoted as in a shell; # begins a comment.
"""

USAGE = """\
usage: scripts/fleet run LIST --out DIR [options]     segments or maps every input of LIST (below)
       scripts/fleet report DIR                       writes results.csv and report.html of DIR again, also during a run

"""

# What a fleet sets itself, and why.
KEPT = {
    "segment-cloud": {"--json": "segments.json is in the folder of the result"},
    "segmenter": {"--out": "the files of the map are in the folder of the result",
                  "--log": "PATH in the list is the log",
                  "--save": "the files of the map are in the folder of the result", "--resume": "each input begins anew"},
    "mapper": {"--device": "PATH in the list is the device", "--store": "the log is in the folder of the result",
               "--resume": "each input begins anew", "--output-trajectory": "the path is in the folder of the result",
               "--timings": "they are in the folder of the result",
               "--lcm-url": "a fleet needs no bus", "--ground-truth": "it is in the folder of the result"},
}


class RunParser(Parser):
    """Raises Problem with exit code 2 for a wrong command line."""

    def __init__(self):
        super().__init__("scripts/fleet run", RUN_OPTIONS, usage="scripts/fleet run LIST [options]",
                         description=textwrap.fill(
                             "Segments the clouds and logs of a list, and maps and segments its recordings, one task "
                             "an input, with Slurm or on this machine. Writes results.csv and report.html into DIR.", 100))
        self.epilog = LIST_HELP
        self.formatter_class = argparse.RawDescriptionHelpFormatter  # the epilog has lines of its own
        self.may_be_empty = MAY_BE_EMPTY
        self.add_argument("list", metavar="LIST", nargs="?", help="the inputs, see below")

    def parse(self, arguments):
        choice, rest = self.parse_known_args(self.join_values(arguments))
        if rest:
            raise Problem(f"unknown option {rest[0]}; see {self.prog} --help", 2)
        if not choice.list:
            raise Problem(f"which list? see {self.prog} --help", 2)
        if choice.scheduler not in SCHEDULERS:
            raise Problem(f"--scheduler {choice.scheduler}: expected one of {', '.join(SCHEDULERS)}", 2)
        choice.jobs = whole_number("--jobs", choice.jobs, 0)
        choice.cpus = whole_number("--cpus", choice.cpus, 1)
        choice.timeout = whole_number("--timeout", choice.timeout, 0)
        for word in PROGRAMS:
            setattr(choice, word, words_for(word, getattr(choice, word), f"--{word}"))
        for word in ("sbatch", "parallel"):
            setattr(choice, word, split(getattr(choice, word), f"--{word}"))
        return choice


def whole_number(flag, text, least):
    if not text.isdecimal() or int(text) < least:
        raise Problem(f"{flag} {text}: expected a whole number, at least {least}", 2)
    return int(text)


def split(text, where):
    """The words of a text, as a shell has them."""
    try:
        return shlex.split(text)
    except ValueError as error:
        raise Problem(f"{where} {text}: {error}", 2) from error


def words_for(word, text, where):
    """Options for a program of an input, checked for those that the fleet sets itself."""
    words = split(text, where)
    options = ProcessOptions(PROGRAMS[word])
    options.add(words)
    options.check("scripts/fleet", KEPT[PROGRAMS[word]], where)
    return words


def settings_of(choice):
    """What decides the results, beside the list."""
    return {"preset": choice.preset, "maps": not choice.no_maps, **{word: getattr(choice, word) for word in PROGRAMS}}
