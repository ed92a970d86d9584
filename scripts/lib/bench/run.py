"""Runs the programs over an input, in the folder of the measurement."""

import os
import re
import shlex
import subprocess
from dataclasses import dataclass
from pathlib import Path

from trio.messages import Problem
from trio.programs import ROOT, program

from .tables import parse_google_benchmark

SCRIPTS = os.path.join(ROOT, "scripts")
BENCH_PROGRAMS = os.path.join(ROOT, "build", "release", "bench")
# The paper's: slices of what leaves a cube.
PAPER_SLICES = ("--slices", "shift", "--volume", "cube")


@dataclass(frozen=True)
class Input:
    """A recording (a folder in TUM layout, or a file) or a synthetic room."""

    name: str
    folder: str = ""
    address: str = ""  # of a synthetic room; empty: the room called NAME

    @property
    def device(self):
        return f"folder://{self.folder}" if self.folder else self.address or f"synthetic://{self.name}"


def room(name):
    return Input(name)


def is_recording(folder):
    return (os.path.isfile(os.path.join(folder, "camera.txt")) and
            any(os.path.isfile(os.path.join(folder, images)) for images in ("depth.txt", "associations.txt")))


def recordings_under(folders):
    """These folders, or the recordings in them at any depth, in order of their paths; none twice. Two with one name
    are told apart by a number."""
    found = {}
    for folder in folders:
        folder = os.path.realpath(folder)
        here = [path for path in [folder, *sub_folders(folder)] if is_recording(path)]
        if not here:
            raise Problem(f"there is no recording in {folder}: a folder with camera.txt, and depth.txt or "
                          "associations.txt", exit_code=2)
        found.update(dict.fromkeys(here))
    names = unique_names([os.path.basename(path) for path in found])
    return [Input(name, path) for name, path in zip(names, found, strict=True)]


def sub_folders(folder):
    return sorted(os.path.join(parent, name) for parent, names, _ in os.walk(folder) for name in names)


def unique_names(names):
    return [name if names.count(name) == 1 else f"{name}-{names[:place].count(name) + 1}"
            for place, name in enumerate(names)]


@dataclass(frozen=True)
class MapperRun:
    """What the mapper left: its log, the camera's path (TUM format), and a CSV line for each frame."""

    log: str
    path: Path
    timings: Path

    def count(self, what):
        """The number before `what` in the last line that counts frames: frames, located, dropped."""
        line = re.findall(r"\d+ frames in .*", self.log)[-1]
        return int(re.search(rf"(\d+) {what}", line)[1])

    @property
    def cpu_ms(self):
        return float(re.findall(r"([0-9.]+) ms of CPU", self.log)[-1])


class Run:
    def __init__(self, folder, recordings=(), frames=None, cases=None):
        self.folder = Path(folder)
        self.recordings = list(recordings)
        self.frames = frames  # only the first so many of each input; None: all
        self.cases = cases  # of the battery: `all`, or words that they must have; None: the default ones
        self.tracked = {}

    def inputs(self, *rooms):
        return [*self.recordings, *map(room, rooms)]

    def execute(self, command, *, name=None, environment=None, may_fail=False):
        """What the command prints on standard output; that and its messages are kept in NAME.log. A command that
        fails is a Problem, which shows the end of them."""
        command = [str(word) for word in command]
        log = self.folder / f"{name or os.path.basename(command[0])}.log"
        result = subprocess.run(command, cwd=self.folder, capture_output=True, text=True, stdin=subprocess.DEVNULL,
                                env={**os.environ, **(environment or {})}, check=False)
        log.write_text(result.stdout + result.stderr)
        if result.returncode and not may_fail:
            end = "\n".join((result.stdout + result.stderr).splitlines()[-5:])
            raise Problem(f"exit code {result.returncode} of {shlex.join(command)}\n{end}")
        return result.stdout

    def kintsugi(self, name, *arguments, log=None, may_fail=False):
        return self.execute([program(name), *arguments], name=log, may_fail=may_fail)

    def bench(self, name, *arguments, environment=None):
        return self.execute([os.path.join(BENCH_PROGRAMS, name), *arguments], environment=environment)

    def google_benchmark(self, name, *arguments, environment=None):
        return parse_google_benchmark(
            self.bench(name, "--benchmark_repetitions=3", "--benchmark_report_aggregates_only",
                       "--benchmark_format=json", *arguments, environment=environment))

    def limited(self, flag):
        return [flag, str(self.frames)] if self.frames else []

    def map_alone(self, name, source, *flags):
        """Only the mapper, over every frame."""
        path, timings = self.folder / f"{name}.txt", self.folder / f"{name}.csv"
        self.execute([f"{SCRIPTS}/private_bus", program("mapper"), "--device", source.device, "--replay",
                      "--output-trajectory", path, "--timings", timings, *self.limited("--max-frames"), *flags],
                     name=name)
        return MapperRun((self.folder / f"{name}.log").read_text(), path, timings)

    def map_tracked(self, source):
        """As map_alone(), without flags; only once for each input."""
        if source not in self.tracked:
            self.tracked[source] = self.map_alone(f"tracked_{source.name}", source)
        return self.tracked[source]

    def truth_folder(self, source):
        """Where the mapper writes the truth of a synthetic room."""
        return self.folder / f"truth_{source.name}"

    def true_path(self, source):
        """The file with the camera's true path, or None; that of a synthetic room is written first."""
        if source.folder:
            truth = Path(source.folder, "groundtruth.txt")
            return truth if truth.exists() else None
        truth = self.truth_folder(source)
        if not (truth / "groundtruth.txt").exists():
            self.execute([f"{SCRIPTS}/private_bus", program("mapper"), "--device", source.device, "--replay",
                          "--max-frames", "1", "--ground-truth", truth])
        return truth / "groundtruth.txt"

    def rendered(self, source):
        """A synthetic room as a recording that costs hardly more to read than a camera: unpacking PNG takes a fifth
        of a mapper's time."""
        name = f"rendered_{source.name}"
        file = self.folder / f"{name}.klg"
        self.kintsugi("convert", source.device, file, "--jpeg-quality", "0", *self.limited("--max-frames"),
                      log=f"{name}_messages")
        return Input(source.name, str(file))

    def trio(self, name, source, *options):
        """scripts/trio in the folder NAME; returns what it prints."""
        return self.execute([f"{SCRIPTS}/trio", "--private", "--device", source.device, "--out", name,
                             *self.limited("--max-frames"), *options], name=f"{name}_messages")
