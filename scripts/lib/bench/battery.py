"""The section about the battery: synthetic rooms under several sensors, speeds and rates, with and without colour."""

import csv
from dataclasses import dataclass

from trio.messages import Problem, say

from .battery_cases import chosen_cases, rows_and_columns
from .battery_picture import script_of
from .recordings import outcome
from .tables import fixed, markdown, percent_down

GOOD_SHARE = 0.99


@dataclass(frozen=True)
class Result:
    """Of one case. No located_share: the mapper failed; no ate_mm: too few poses."""

    located_share: float | None = None
    ate_mm: float | None = None


def battery(run):
    """Also writes battery.csv, line by line, and battery.png into the folder of the measurement."""
    cases = chosen_cases(run.cases)
    results = {}
    with open(run.folder / "battery.csv", "w", newline="") as file:
        writer = csv.DictWriter(file, CSV_HEADER)
        writer.writeheader()
        for number, case in enumerate(cases, 1):
            line = measured(run, case)
            writer.writerow(line)
            file.flush()
            results[case] = Result(line.get("located_share"), line.get("ate_mm"))
            say(f"case {number} of {len(cases)}, {case.source.name}: {cell(results[case])}")
    draw(run, results)
    return battery_table(results)


CSV_HEADER = ("room", "sensor", "has_color", "speed", "rate_hz", "frames", "located", "located_share", "parts",
              "longest_loss_s", "ate_mm", "rpe_mm", "rpe_deg", "cpu_ms", "memory_MB")


def measured(run, case):
    """A line of battery.csv. A case in which the mapper fails has the case only, and does not end the battery."""
    line = vars(case).copy()
    source = case.source
    try:
        found = outcome(run, source.name, source, "--linger", 0, "--ground-truth", run.truth_folder(source))
    except Problem as problem:
        say(f"case '{source.name}' failed: {problem}")
        return line
    line.update(frames=found.frames, located=found.located, located_share=found.located / max(found.frames, 1),
                parts=found.parts, longest_loss_s=round(found.longest_loss_s, 6), cpu_ms=found.cpu_ms,
                memory_MB=found.memory_MB)
    for name, error, scale in (("ate_mm", "ate_m_rmse", 1e3), ("rpe_mm", "rpe_m_rmse", 1e3),
                               ("rpe_deg", "rpe_deg_rmse", 1.0)):
        if error in found.errors:
            line[name] = scale * found.errors[error]
    return line


def cell(result):
    if result is None:
        return None
    if result.located_share is None:
        return "failed"
    located = f"{percent_down(result.located_share)} %"
    return located if result.ate_mm is None else f"{located}, {fixed(result.ate_mm, 1)} mm"


def battery_table(results):
    rows, columns = rows_and_columns(results)
    by_place = {(case.row, case.column): result for case, result in results.items()}
    table = markdown(["room", "sensor", *columns],
                     [[*row, *(cell(by_place.get((row, column))) for column in columns)] for row in rows])
    good = sum((result.located_share or 0.0) >= GOOD_SHARE for result in results.values())
    return f"{table}\nAt least {100 * GOOD_SHARE:.0f} % of the frames are located in {good} of {len(results)} cases.\n"


def draw(run, results):
    by_place = {(case.row, case.column): result for case, result in results.items()}
    script, picture = run.folder / "battery.gp", run.folder / "battery.png"
    script.write_text(script_of(*rows_and_columns(results), by_place, picture))
    run.execute(["gnuplot", script])
    say(f"picture of the battery: {picture}")
