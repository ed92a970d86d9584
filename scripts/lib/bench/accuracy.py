"""How far the camera's path of a mapper run is from the truth, as kintsugi-evaluate finds it.

Each part of a map has a frame W of its own, so that positions of different parts cannot be compared. The errors are
those within the parts, put together."""

import math
import re

from trio.messages import Problem, say
from true_path import in_seconds, microseconds

from .tables import fixed, read_csv

LOCATED = ("tracking", "given")  # the states in which a frame has a pose


def trajectory_errors(run, mapped, source):
    """The columns of kintsugi-evaluate --trajectory, as numbers; {} without a true path, or if too few poses have a
    true one. Of a map of several parts only the columns that can be put together."""
    truth = run.true_path(source)
    if truth is None or not mapped.count("located"):
        return {}
    truth = in_seconds(truth, run.folder / f"truth_in_seconds_{mapped.path.stem}.txt")
    errors = [path_errors(run, path, truth) for path in paths_of_parts(mapped)]
    errors = [each for each in errors if each]
    return errors[0] if len(errors) == 1 else pooled(errors)


def path_errors(run, path, truth):
    """Of one part. A part too short for motions of one second has errors of its positions only."""
    for flags, wanted in ((["--delta", 1, "--delta-unit", "s"], ""), (["--all-pairs"], "ate_")):
        file = run.folder / f"errors_{path.stem}.csv"
        try:
            run.kintsugi("evaluate", "--trajectory", path, "--truth", truth, "--csv", file, *flags)
        except Problem as problem:
            reason = str(problem).splitlines()[-1]
            continue
        return {name: float(text) for name, text in read_csv(file)[0].items()
                if name.startswith(wanted) and re.fullmatch(r"-?[0-9.]+(e-?\d+)?", text)}
    say(f"{path.stem} was not compared with the truth: {reason}")
    return {}


def pooled(errors):
    """Root mean squares and greatest values over several parts, each with the weight of its poses or motions."""
    result = {}
    for quantity in ("ate_m", "rpe_m", "rpe_deg"):
        known = [each for each in errors if f"{quantity}_rmse" in each]
        weights = [each[f"{quantity}_pairs"] for each in known]
        if known:
            squares = sum(weight * each[f"{quantity}_rmse"]**2 for weight, each in zip(weights, known, strict=True))
            result[f"{quantity}_pairs"] = sum(weights)
            result[f"{quantity}_rmse"] = math.sqrt(squares / sum(weights))
            result[f"{quantity}_max"] = max(each[f"{quantity}_max"] for each in known)
    return result


def part_of_row(row):
    """Of a row of --timings; a mapper that does not know parts makes one."""
    return row.get("part", "1")


def parts_of(rows):
    """The parts of the map, in the order in which they were begun."""
    return list(dict.fromkeys(part_of_row(row) for row in rows if row["state"] in LOCATED))


def paths_of_parts(mapped):
    """A file in TUM format for each part of the map."""
    rows = read_csv(mapped.timings)
    parts = parts_of(rows)
    if len(parts) <= 1:
        return [mapped.path]
    part_at_us = {int(row["utime_us"]): part_of_row(row) for row in rows}
    lines = {part: [] for part in parts}
    for line in mapped.path.read_text().splitlines(keepends=True):
        if not line.startswith("#"):
            lines[part_at_us[microseconds(line.split()[0])]].append(line)
    files = []
    for part, poses in lines.items():
        files.append(mapped.path.with_name(f"{mapped.path.stem}_part_{part}.txt"))
        files[-1].write_text("".join(poses))
    return files


def error(errors, name, scale=1.0):
    return fixed(scale * errors[name], 2) if name in errors else "-"
