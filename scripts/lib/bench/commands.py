"""The command line of scripts/bench, and the order of the sections."""

import argparse
import contextlib
import os
import subprocess
import sys
import tempfile
import time
from dataclasses import dataclass
from typing import Callable

from trio.messages import Problem, os_error_text, say
from trio.programs import ROOT

from . import battery, fleets, live, mapping, object_times, objects, others, recordings, segmenting
from .battery_cases import chosen_cases
from .document import Document
from .run import Run, recordings_under
from .summary import summary


@dataclass(frozen=True)
class Section:
    name: str
    what: str
    measure: Callable[[Run], str]
    programs: tuple = ()  # that it needs
    needs_recording: bool = False
    in_default_run: bool = True


TRIO = ("kintsugi-mapper", "kintsugi-segmenter", "kintsugi-viewer", "kintsugi-status")
MAPPER = ("kintsugi-mapper", "kintsugi-evaluate")
OBJECTS = (*TRIO, "kintsugi-diff", "kintsugi-evaluate", "kintsugi-ground-truth", "kintsugi-objects")

SECTIONS = (
    Section("live", "mapper, segmenter and viewer at the camera's rate: CPU, frames dropped, what of the view is segmented",
            live.live, (*TRIO, "kintsugi-evaluate", "kintsugi-render-scene")),
    Section("paths", "the mapper alone: time of a frame, error of the camera's path", mapping.paths, MAPPER),
    Section("recordings", "every recording: frames located, parts of the map, error of the path, cost",
            recordings.recordings, MAPPER, needs_recording=True),
    Section("battery", "synthetic rooms x sensors x speeds x rates x colour (not in the default run: 25 minutes)",
            battery.battery, MAPPER, in_default_run=False),
    Section("stages", "the stages of a frame: wall and CPU time, by threads", mapping.stages, ("bench_frame",)),
    Section("volume", "fusion, raycast and extraction by themselves, by instruction set", mapping.volume,
            ("bench_volume",)),
    Section("bare", "walls, floors and corridors, with texture and without", mapping.bare, MAPPER),
    Section("recovery", "losses and recoveries of the camera under disturbances", mapping.recovery,
            ("bench_recovery",)),
    Section("surface", "the points of the map against the true surface", mapping.surface,
            ("kintsugi-mapper", "kintsugi-evaluate-surface")),
    Section("memory", "memory of the mapper over two floors", mapping.memory, ("kintsugi-mapper",)),
    Section("loops", "a round that is walked once, twice and ten times: the map, its error and the mapper's memory",
            mapping.loops, MAPPER),
    Section("maps", "time of segmenting each slice and agreement with batch, beside the paper's tables",
            segmenting.maps, (*TRIO, "kintsugi-evaluate")),
    Section("quality", "segments against the true objects of the synthetic office, and a sweep of each parameter",
            segmenting.quality, (*MAPPER, "kintsugi-ground-truth")),
    Section("objects", "changes between two maps of a room, and objects taught in one room and found in others",
            objects.objects, OBJECTS),
    Section("object-times", "how soon taught objects are found live and in a large map, and what it costs",
            object_times.object_times, (*OBJECTS, "bench_large_walk")),
    Section("segmenter", "batch, voting and neighbour search on generated maps", segmenting.segmenter,
            ("bench_segmenter",)),
    Section("exact", "mode exact slice by slice and under corrections, on a generated map of 4 million points",
            segmenting.exact, ("bench_exact",)),
    Section("beyond-memory", "mode exact on a generated map of 50 million points, with a limit on memory and without",
            segmenting.beyond_memory, ("bench_memory",)),
    Section("corrections", "corrections that move all patches, or few, of a generated map of 4 million points",
            segmenting.corrections, ("bench_closing", "bench_motions")),
    Section("whole-map", "saving, describing, querying and resuming a whole map", segmenting.whole_map,
            ("bench_whole_map",)),
    Section("renderer", "drawing a picture", others.renderer, ("bench_renderer",)),
    Section("late-viewer", "a viewer that is started late", others.late_viewer, ("bench_late_viewer",)),
    Section("streams", "a reliable stream on a bus that loses chunks", others.streams, ("bench_stream",)),
    Section("limits", "what one and two threads of this machine can do at most", others.limits, ("bench_machine",)),
    Section("structure", "files, folders and includes of the source code", others.structure),
    Section("pictures", "paths of pictures of each map, from two sides (not in the default run)", mapping.pictures,
            TRIO, in_default_run=False),
    Section("fleets", "200 generated clouds through scripts/fleet, with one task at a time and with more (not in the default "
            "run: 15 minutes)", fleets.fleets, (*MAPPER, "kintsugi-ground-truth", "kintsugi-segment-cloud",
                                                "kintsugi-segmenter"), in_default_run=False),
    Section("faults", "scripts/faults --all (not in the default run: takes hours)", others.faults, TRIO,
            in_default_run=False),
)


def parse(arguments):
    lines = "\n".join(f"  {section.name:<12} {section.what}" for section in SECTIONS)
    parser = argparse.ArgumentParser(
        prog="scripts/bench", formatter_class=argparse.RawDescriptionHelpFormatter,
        description="Builds the programs, measures, and prints every table of BENCHMARK.md. Run it on a machine that "
                    "does nothing else.", epilog=f"sections:\n{lines}")
    parser.add_argument("folders", metavar="DIR", nargs="*",
                        help="a recording in TUM layout, if possible with groundtruth.txt, or a folder with such "
                             "recordings; without one, what needs it is skipped")
    parser.add_argument("--only", metavar="NAME,...", help="only these sections")
    parser.add_argument("--frames", metavar="N", type=int,
                        help="only the first N frames of each input: quick, but not the figures of BENCHMARK.md")
    parser.add_argument("--cases", metavar="WORD,...",
                        help="of the battery: all, or those cases that have all of these words, as hall,d435,depth "
                             "(default: about a third of all)")
    parser.add_argument("--out", metavar="DIR",
                        help="keep logs, tables and pictures in DIR (default: a temporary folder, which is removed)")
    parser.add_argument("--write", metavar="FILE",
                        help="also replace what is between the markers of each section in FILE")
    options = parser.parse_args(arguments)
    options.sections = chosen_sections(options.only)
    chosen_cases(options.cases)  # wrong words are to be told before anything is measured
    return options


def chosen_sections(names):
    if names is None:
        return [section for section in SECTIONS if section.in_default_run]
    known = {section.name: section for section in SECTIONS}
    for name in names.split(","):
        if name not in known:
            raise Problem(f"there is no section '{name}'; see scripts/bench --help", exit_code=2)
    return [known[name] for name in names.split(",")]


def build(sections):
    """The programs of these sections; not those that are in the folder KINTSUGI_BIN."""
    programs = dict.fromkeys(program for section in sections for program in section.programs)
    if os.environ.get("KINTSUGI_BIN"):
        programs = [program for program in programs if program.startswith("bench_")]
    if programs:
        subprocess.run([os.path.join(ROOT, "scripts", "build"), "release", *programs], stdout=sys.stderr, check=True)


def machine():
    """Cores, processor, memory, system."""
    def field(file, key, separator):
        with open(file) as lines:
            return next((line.split(separator, 1)[1].strip().strip('"') for line in lines if line.startswith(key)), "?")

    memory_GB = int(field("/proc/meminfo", "MemTotal", ":").split()[0]) / 1024**2
    return (f"{os.cpu_count()} cores of {field('/proc/cpuinfo', 'model name', ':')}, {memory_GB:.0f} GiB, "
            f"{field('/etc/os-release', 'PRETTY_NAME', '=')}")


def load():
    return ", ".join(f"{value:.1f}" for value in os.getloadavg())


def measure(section, run):
    """What the section prints, or None if it failed."""
    start = time.monotonic()
    try:
        return section.measure(run)
    except Problem as problem:
        say(f"section '{section.name}' failed: {problem}")
        return None
    finally:
        say(f"section '{section.name}' took {time.monotonic() - start:.0f} s")


def run_sections(options, run):
    """The exit code: 1 if a section failed. In FILE, what stands there of such a section, and of one that is skipped, is
    kept. What is measured by itself says on which machine: that may be another one than the rest is from."""
    document = Document(options.write) if options.write else None
    is_whole = options.only is None
    if document:
        document.check([section.name for section in options.sections] + ["summary"] + ["machine"] * is_whole)
    build(options.sections)
    texts = {"machine": f"{machine()}; load before the run (1, 5, 15 minutes): {load()}.\n"}
    print(texts["machine"], flush=True)
    if document and is_whole:
        document.replace("machine", texts["machine"])
    failed = 0
    for section in options.sections:
        if section.needs_recording and not run.recordings:
            say(f"section '{section.name}' is skipped: no recording was given")
            continue
        text = measure(section, run)
        failed += text is None
        if text is None:
            continue
        texts[section.name] = text
        print(f"## {section.name}\n\n{text}", flush=True)
        if document:
            document.replace(section.name, text if is_whole else f"{text.strip()}\n\nMeasured on {machine()}.")
    if document:
        texts = document.sections()
        document.replace("summary", summary(texts))
    print(f"## summary\n\n{summary(texts)}", flush=True)
    return 1 if failed else 0


def main(arguments):
    try:
        options = parse(arguments)
        found = recordings_under(options.folders)
        with contextlib.ExitStack() as stack:
            folder = os.path.realpath(options.out or stack.enter_context(tempfile.TemporaryDirectory()))
            os.makedirs(folder, exist_ok=True)
            return run_sections(options, Run(folder, found, options.frames, options.cases))
    except Problem as problem:
        say(str(problem))
        return problem.exit_code
    except subprocess.CalledProcessError as error:
        return error.returncode
    except OSError as error:
        say(os_error_text(error))
        return 1
