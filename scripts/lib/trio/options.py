"""The command lines of scripts/trio and scripts/replay. One table each: parser and --help are made
from it."""

import argparse
import shlex

from .messages import Problem
from .process_options import ProcessOptions, value_of

PROCESSES = ("mapper", "segmenter", "viewer")
STORE_LIMIT = "--store-limit"
DETECTOR = "detector"  # runs with --objects only

PASS_ON = "pass on"  # FLAG or FLAG=VALUE is passed to one process
SPLIT = "split"  # the value is split into further options for one process
STORE = "store"  # for the command itself

BUS_KEY_HELP = ("sign every message with the key in this file (kintsugi-keygen), and take only what is signed with it "
                "(default: KINTSUGI_BUS_KEY, or unsigned)")

# Flag, metavar (None: a switch), what is done with it, for which process or with which default, help.
TRIO_OPTIONS = (
    ("--device", "URI", PASS_ON, "mapper",
     "where frames come from: a recording's path (its formats are in mapper/README.md), synthetic://NAME (a scene "
     "there), or a camera's URI; empty or not given: the first camera"),
    ("--out", "DIR", STORE, "out/trio",
     "folder of the run (default %(default)s); files of an earlier run in it are moved to DIR/earlier"),
    ("--resume", None, STORE, False,
     "continue the interrupted run in DIR (after a reboot, say) with the options that it was started with"),
    ("--mode", "MODE", PASS_ON, "segmenter", "segmentation mode (default: the segmenter's own)"),
    ("--preset", "NAME", PASS_ON, "segmenter", "parameters of the segmenter: objects (default) or paper"),
    ("--resolution", "M", PASS_ON, "mapper", "side of a voxel in metres"),
    ("--volume", "NAME", PASS_ON, "mapper",
     "what the mapper keeps around the camera. range (default): all that the camera sees; cube: 4.5 m"),
    ("--volume-size", "M", PASS_ON, "mapper", "side of the cube in metres"),
    ("--slices", "KIND", PASS_ON, "mapper",
     "patch (default): surface is sent as soon as it is seen, and again when it has changed; shift: once, when it "
     "leaves the volume"),
    ("--calibration", "FILE", PASS_ON, "mapper", "camera.txt of the camera"),
    ("--replay", None, PASS_ON, "mapper",
     "map every frame, as fast as processing allows (recordings and synthetic rooms)"),
    ("--max-frames", "N", PASS_ON, "mapper", "stop after N frames"),
    ("--every", "S", PASS_ON, "viewer", "write a snapshot every S seconds of the recording (default 10)"),
    ("--video", None, STORE, False, "write a video of the run too"),
    ("--publish-frames", None, PASS_ON, "mapper",
     "publish the raw frames too, so that the log can be replayed into a mapper"),
    ("--no-log", None, STORE, False, "do not record the bus"),
    ("--durable", None, STORE, False,
     "a power cut takes at most the last second of the run: go on with --resume (kintsugi-mapper --durable, and the "
     "files of the run are synced)"),
    (STORE_LIMIT, "MB", PASS_ON, "mapper",
     "for runs of days: what the map needs no more is removed from mapper.lcm, so that it stays below this; and the bus "
     "is not recorded, of the statuses only some (0: no limit)"),
    ("--map-name", "NAME", STORE, None,
     "name of the map (default: map). Several runs on one bus need a name each; segmenter and viewer then use only "
     "this map"),
    ("--objects", "DIR", STORE, None,
     "find the objects of this library (kintsugi-objects teach) in the map: a fourth process, kintsugi-objects detect"),
    ("--bus-key", "FILE", STORE, None, BUS_KEY_HELP),
    ("--only", "NAMES", STORE, ",".join(PROCESSES),
     "run only these of %(default)s; the others run on other hosts"),
    ("--private", None, STORE, False, "run in a private network that no other program hears"),
    ("--mapper", "'ARGS'", SPLIT, "mapper", "further options of kintsugi-mapper, quoted as in a shell"),
    ("--segmenter", "'ARGS'", SPLIT, "segmenter", "further options of kintsugi-segmenter"),
    ("--viewer", "'ARGS'", SPLIT, "viewer", "further options of kintsugi-viewer"),
    ("--detector", "'ARGS'", SPLIT, DETECTOR, "further options of kintsugi-objects detect"),
)

REPLAY_OPTIONS = (
    ("--out", "DIR", STORE, "out/replay", "folder of the run (default %(default)s)"),
    ("--speed", "X", STORE, "1", "times real time (default %(default)s)"),
    ("--mode", "MODE", PASS_ON, "segmenter", "segmentation mode (default: the segmenter's own)"),
    ("--preset", "NAME", PASS_ON, "segmenter", "parameters of the segmenter: objects (default) or paper"),
    ("--every", "S", PASS_ON, "viewer", "write a snapshot every S seconds of the recording (default 10)"),
    ("--bus-key", "FILE", STORE, None, BUS_KEY_HELP),
    ("--private", None, STORE, False, "run in a private network that no other program hears"),
    ("--segmenter", "'ARGS'", SPLIT, "segmenter", "further options of kintsugi-segmenter, quoted as in a shell"),
    ("--viewer", "'ARGS'", SPLIT, "viewer", "further options of kintsugi-viewer"),
    ("--objects", "DIR", STORE, None, "find the objects of this library in the map, with kintsugi-objects detect"),
    ("--detector", "'ARGS'", SPLIT, DETECTOR, "further options of kintsugi-objects detect"),
)

MAY_BE_EMPTY = {"--device", "--mapper", "--segmenter", "--viewer", "--detector"}


def parse_trio(arguments):
    """Namespace with out, resume, video, no_log, is_long (its files shall not grow without limit), private, objects;
    only (list of names, with objects also that of the detector); and the options of each process as lists: mapper,
    segmenter, viewer, detector. Of an option given twice the last one counts."""
    parser = Parser("scripts/trio", TRIO_OPTIONS, description=(
        "Runs mapper, segmenter and viewer over LCM with one set of options, restarts what is killed, and stops at "
        "the end of the device or at Ctrl-C with everything written (Ctrl-C twice: without waiting for the rest of "
        "the map to be drawn)."))
    options = parser.parse(arguments)
    options.only = with_detector(chosen_processes(options.only), options)
    options.is_long = is_limit(value_of(STORE_LIMIT, options.mapper))
    options.no_log |= options.is_long  # run.lcm has no limit
    return options


def is_limit(text):
    """Of a value of --store-limit; None: there is none. What is no number the mapper refuses."""
    try:
        return text is not None and float(text) != 0
    except ValueError:
        return True


def parse_replay(arguments):
    """Namespace with log, out, speed, private, objects, only (as of parse_trio), and the lists segmenter, viewer and
    detector."""
    parser = Parser("scripts/replay", REPLAY_OPTIONS, usage="scripts/replay LOG [options]",
                    description="Plays a recorded log through lcm-logplayer into a segmenter and a viewer.")
    parser.add_argument("log", metavar="LOG", nargs="?", help="run.lcm or mapper.lcm of a run, or another LCM log")
    options = parser.parse(arguments)
    if not options.log:
        raise Problem("which log? see scripts/replay --help", 2)
    options.only = with_detector(["segmenter", "viewer"], options)
    return options


def chosen_processes(names):
    given = names.split(",")
    if not set(given) <= set(PROCESSES):
        raise Problem(f"--only {names}: expected one or more of {','.join(PROCESSES)}", 2)
    return [name for name in PROCESSES if name in given]


def with_detector(names, options):
    """The names, with that of the detector if there are objects to find: not as the last one, which ends the run
    when it has nothing left to do."""
    if options.objects is None:
        if options.detector:
            raise Problem("--detector needs --objects DIR", 2)
        return names
    if "segmenter" not in names:
        raise Problem("--objects needs the segmenter in --only", 2)
    return [*names[:-1], DETECTOR, names[-1]]


class Parser(argparse.ArgumentParser):
    """Made from a table as above. A wrong command line raises Problem with exit code 2."""

    def __init__(self, command, table, usage=None, description=None):
        super().__init__(prog=command, usage=usage or f"{command} [options]", description=description,
                         allow_abbrev=False)
        self.may_be_empty = MAY_BE_EMPTY
        self._with_value = {flag for flag, metavar, *_ in table if metavar}
        for flag, metavar, kind, target, text in table:
            self._add(flag, metavar, kind, target, text)

    def parse(self, arguments):
        options, rest = self.parse_known_args(self.join_values(arguments))
        if rest:
            raise Problem(f"unknown option {rest[0]}; see {self.prog} --help", 2)
        for name in (*PROCESSES, DETECTOR):
            if of_process := getattr(options, name, None):
                of_process.check(self.prog)
            setattr(options, name, of_process.words() if of_process else [])
        return options

    def error(self, message):
        raise Problem(f"{message}; see {self.prog} --help", 2)

    def _add(self, flag, metavar, kind, target, text):
        if kind == STORE:
            action = {"action": "store", "metavar": metavar} if metavar else {"action": "store_true"}
            self.add_argument(flag, default=target, help=text, **action)
            return
        value = {"metavar": metavar} if metavar else {"nargs": 0}
        self.add_argument(flag, action=PassOn if kind == PASS_ON else Split, dest=target, default=None, help=text,
                          **value)

    def join_values(self, arguments):
        """FLAG VALUE as FLAG=VALUE: argparse takes a separate value that begins with a dash, as in
        `--mapper --session=7`, for another option."""
        joined = []
        rest = iter(arguments)
        for argument in rest:
            flag, is_joined, value = argument.partition("=")
            if flag not in self._with_value:
                joined.append(argument)
                continue
            if not is_joined:
                value = next(rest, None)
            if value is None or (not value and flag not in self.may_be_empty):
                raise Problem(f"{flag} needs a value", 2)
            joined.append(f"{flag}={value}")
        return joined


def options_of(namespace, name):
    """What the namespace has for a process; made with the first option."""
    if getattr(namespace, name) is None:
        setattr(namespace, name, ProcessOptions(name))
    return getattr(namespace, name)


class PassOn(argparse.Action):
    """FLAG or FLAG=VALUE for a process; an empty value stands for the process's own default."""

    def __call__(self, parser, namespace, values, option_string=None):
        if self.nargs == 0:
            words = [option_string]
        else:
            words = [f"{option_string}={values}"] if values else []
        options_of(namespace, self.dest).replace(option_string, words)


class Split(argparse.Action):
    """Splits further options for a process into words, as a shell does."""

    def __call__(self, parser, namespace, values, option_string=None):
        try:
            words = shlex.split(values)
        except ValueError as error:
            raise Problem(f"{option_string} {values}: {error}", 2) from error
        options_of(namespace, self.dest).add(words)
