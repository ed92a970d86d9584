"""What an input is, and the programs that are run on it, each in the folder of the result."""

import os
from dataclasses import dataclass

from trio.messages import Problem
from trio.process_options import ProcessOptions, with_given
from trio.programs import program
from trio.recording import begins_as_log

from .inputs import ADDRESS
from .options import PROGRAMS

CLOUDS = (".ply", ".pcd", ".las", ".npy", ".xyz", ".pts", ".txt", ".asc", ".csv")
RECORDINGS = (".oni", ".klg", ".sens", ".bag")
GIVEN_PATH = "groundtruth.txt"  # in folders of recordings

# Where the programs write.
LABELLED, SEGMENTS, LOG, TRAJECTORY, TIMINGS = ("labelled.ply", "segments.json", "mapper.lcm", "trajectory.txt",
                                                "timings.csv")
QUALITY = "quality"
# Every frame, and nobody to wait for: 1 GB/s is more than the log takes. The session is part of the map.
MAPPER_DEFAULTS = ("--replay", "--linger=0", "--rate=1000", "--session=1")
OWN_LOG = ("--trust-log",)  # what the mapper stores is not signed, whatever KINTSUGI_BUS_KEY says
TRUE_INSTANCES, SCENE = "truth.ply", "scene"
MAPS = ("*.ply", "*.lcm")  # the large files


@dataclass(frozen=True)
class Step:
    """A command, and what it is for: map, segment, truth, quality."""

    what: str
    command: tuple


def kind_of(given):
    """cloud, log or recording. Raises Problem if it is not there, or nobody knows."""
    if ADDRESS.match(given.device):
        return given.kind or "recording"
    try:
        if os.path.isdir(given.device):
            return given.kind or "recording"
        is_log = begins_as_log(given.device)
    except OSError as error:
        raise Problem(f"{given.device}: {error.strerror}") from error
    ending = os.path.splitext(given.device)[1].lower()
    for kind, is_it in (("log", is_log or ending == ".lcm"), ("cloud", ending in CLOUDS),
                        ("recording", ending in RECORDINGS)):
        if given.kind == kind or (is_it and not given.kind):
            return kind
    raise Problem(f"{given.device}: its name does not tell what it is; expected a cloud ({', '.join(CLOUDS)}), a log "
                  f"of LCM, a recording ({', '.join(RECORDINGS)}, a folder), or kind= in the list")


def steps_of(given, kind, settings):
    """The programs for an input, in order."""
    if kind == "cloud":
        return [Step("segment", (program("segment-cloud"), given.device, LABELLED, f"--json={SEGMENTS}",
                                 *words_of("cloud", given, settings))),
                *quality_steps(LABELLED, given.truth)]
    if kind == "log":
        return [segment_log(given.device, given, settings), *quality_steps("segments.ply", given.truth)]
    return [Step("map", (program("mapper"), *own_mapper(given),
                         *with_given(MAPPER_DEFAULTS, words_of("mapper", given, settings)))),
            segment_log(LOG, given, settings, *OWN_LOG), *true_instances(given),
            *quality_steps("segments.ply", given.truth or (TRUE_INSTANCES if is_scene(given) else ""))]


def segment_log(log, given, settings, *options):
    return Step("segment", (program("segmenter"), f"--log={log}", "--out=.", *options,
                            *words_of("segmenter", given, settings)))


def own_mapper(given):
    """Options of the mapper; without a bus, because nobody listens."""
    return [f"--device={given.device}", "--lcm-url=memq://", f"--store={LOG}", f"--output-trajectory={TRAJECTORY}",
            f"--timings={TIMINGS}", *([f"--ground-truth={SCENE}"] if is_scene(given) else [])]


def words_of(word, given, settings):
    """Options of a program: of the fleet and, counting more, of the line in the list."""
    options = ProcessOptions(PROGRAMS[word])
    if word != "mapper" and settings["preset"]:
        options.add([f"--preset={settings['preset']}"])
    options.add(settings[word])
    options.add(given.words.get(word, []))
    return options.words()


def is_scene(given):
    return given.device.startswith("synthetic://")


def true_instances(given):
    if not is_scene(given) or given.truth:
        return []
    return [Step("truth", (program("ground-truth"), given.device, LOG, TRUE_INSTANCES, *OWN_LOG))]


def quality_steps(cloud, truth):
    if not truth:
        return []
    return [Step("quality", (program("evaluate"), cloud, "--ground-truth", truth, "--presets", "labels",
                             "--out", QUALITY))]


def true_path_of(given):
    """The file with the camera's true path, or nothing."""
    if given.path:
        return given.path
    if is_scene(given):
        return os.path.join(SCENE, "groundtruth.txt")
    beside = os.path.join(given.device, GIVEN_PATH)
    return beside if os.path.isfile(beside) else ""


def path_step(estimate, truth, result, with_motions):
    """Compares two camera paths. Paths too short for motions of a second are compared without."""
    return Step("quality", (program("evaluate"), "--trajectory", estimate, "--truth", truth, "--csv", result,
                            *([] if with_motions else ["--all-pairs"])))
