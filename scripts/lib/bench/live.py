"""The section about a live run: cost, and how much of what the camera sees is in the segment map."""

import json
import re

from trio.messages import Problem

from .run import Input
from .tables import fixed, markdown

PROCESSES = ("mapper", "segmenter", "viewer")


def live(run):
    costs, measures = [], []
    # Its loops correct the whole map in the middle. Rendering it live would take the time of both cores.
    two_rounds = run.rendered(Input("loop", address="synthetic://loop?speed=2&laps=2"))
    for source in [*run.inputs("office"), two_rounds]:
        name = f"live_{source.name}"
        printed = run.trio(name, source)
        log = (run.folder / name / "mapper.log").read_text()
        costs.append([source.name, *cost(printed, log), corrections(log)])
        measures.append([source.name, *in_view(measured(run, name))])
    return (markdown(["recording", "frames", "dropped", "not fused", *(f"{process}, CPU-ms a frame" for process in PROCESSES),
                      "all three, CPU-ms a frame", "corrections of the map"], costs) + "\n" +
            markdown(["recording", "centre pixel has its right segment, %", "visible surface in a segment, mean, %",
                      "from seen to labelled, median (p99), s", "`--pixel` answered (wrong), %",
                      "`--ray` answered (wrong), %", "label never changed, %", "times that a point is sent"], measures))


def cost(printed, log):
    """Frames, those of them that were dropped or not fused, and CPU-ms a frame of each process and of all."""
    frames, dropped, not_fused = (int(re.findall(rf"(\d+) {what}", log)[-1])
                                  for what in ("frames in", "dropped", "not fused"))
    cpu = re.findall(r"(?m)^ *CPU: .*", printed)[-1]
    cpu_ms = [1e3 * float(re.search(rf"{process} ([0-9.]+) s", cpu)[1]) / frames for process in PROCESSES]
    return [frames, dropped, not_fused, *(fixed(each, 1) for each in [*cpu_ms, sum(cpu_ms)])]


def corrections(log):
    """How often the map was corrected meanwhile; without loops the log tells nothing."""
    told = re.search(r"the map was corrected (\d+) times", log)
    return int(told[1]) if told else 0


def measured(run, name):
    """What kintsugi-evaluate measures of the log of the bus. Its exit code is 1 when the log lacks a chunk, for instance of
    what the camera saw, which is not sent again: what that carried counts as not seen."""
    file = run.folder / name / "live.json"
    run.kintsugi("evaluate", "--live", run.folder / name / "run.lcm", "--json", file, may_fail=True)
    if not file.exists():
        raise Problem(f"kintsugi-evaluate has measured nothing of {name}, see kintsugi-evaluate.log")
    return json.loads(file.read_text())


def percent(share):
    return None if share is None else fixed(100 * share, 1)


def answers(counts):
    """Shares of the pixels that were asked, and of the answers; both in percent."""
    answered = counts["answered"] / max(counts["asked"], 1)
    return f"{percent(answered)} ({percent(counts['wrong'] / max(counts['answered'], 1))})"


def in_view(told):
    """The cells of one run."""
    delays = [told["delay_median_s"], told["delay_p99_s"]]
    delay = None if None in delays else "{:.2f} ({:.2f})".format(*delays)
    return [percent(told["centre_right"]), percent(told["covered_mean"]), delay, answers(told["pixel"]),
            answers(told["ray"]), percent(told["unchanged"]),
            None if told["times_sent"] is None else fixed(told["times_sent"], 1)]
