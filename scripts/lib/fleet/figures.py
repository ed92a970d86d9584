"""The plots of the report page: scripts for gnuplot, and what gnuplot draws from them."""

import math
import shutil
import subprocess
from dataclasses import dataclass

from .table import at_work, busy_periods, with_values

# Told apart by colour-blind people, too.
KINDS = (("cloud", "#0072b2", 7), ("log", "#d55e00", 5), ("recording", "#009e73", 9))
CURVES = ("#0072b2", "#d55e00")
INTERVALS = 100  # of the plot of progress
TERMINAL = ("set terminal svg name '{name}' size 900,420 dynamic background rgb 'white' font 'sans-serif,14' "
            "noenhanced\nset border 3 linecolor rgb '#555555'\nset tics nomirror\nset grid linecolor rgb '#e4e4e4'\n"
            "set key outside above center horizontal Left reverse samplen 2\n")


@dataclass(frozen=True)
class Figure:
    title: str
    caption: str
    script: str  # without its terminal


def figures_of(rows, since_s=0.0):
    """Those for which the rows have figures. The progress is that of tasks that began after `since_s` (Unix time)."""
    return [figure for figure in (
        over_points(rows, "segmented_s", "Time", "time, s",
                    "Wall time of the programs for each input, without the comparison with the truth."),
        over_points(rows, "segments", "Segments", "segments", "Number of segments of each input."),
        over_points(rows, "peak_memory_MB", "Memory", "peak memory, MB",
                    "The most memory that a program took for each input."),
        sorted_curves(rows, (("object_iou", "objects"), ("instance_iou", "all instances")), "Quality of the segments",
                      "mean best IoU", "Mean best intersection over union of the true instances with a segment; inputs "
                      "of known truth in ascending order, for each curve by itself.", top=1.0),
        sorted_curves(rows, (("ate_m", "ATE, root mean square"),), "Error of the camera's path", "error, m",
                      "Recordings of known path in ascending order.", is_log=True),
        progress([row for row in rows if row.get("started_s", 0.0) >= since_s])) if figure]


def over_points(rows, column, title, label, caption):
    """A point for each input."""
    found = [row for row in with_values(rows, "points", column) if row["points"] > 0 and row[column] > 0]
    series = [(kind, f"with points linecolor rgb '{color}' pointtype {shape} pointsize 0.6 title '{kind}'",
               [(row["points"], row[column]) for row in found if row["kind"] == kind]) for kind, color, shape in KINDS]
    series = [each for each in series if each[2]]
    if not series:
        return None
    return Figure(title, caption, f"set xlabel 'points'\nset ylabel '{label}'\nset grid\n"
                  + log_axis("x", [row["points"] for row in found])
                  + log_axis("y", [row[column] for row in found]) + plot(series))


def log_axis(axis, values):
    """A range with room at both ends, also where all values are one; and tics in it where it is less than some powers
    of ten, at which gnuplot has none."""
    least, most = min(values) / 1.3, max(values) * 1.3
    steps = (1, 2, 5) if most / least < 300 else (1,)
    powers = range(math.floor(math.log10(least)), math.ceil(math.log10(most)) + 1)
    tics = [step * 10.0**power for power in powers for step in steps if least <= step * 10.0**power <= most]
    return (f"set logscale {axis}\nset {axis}range [{least:.6g}:{most:.6g}]\n"
            f"set {axis}tics ({', '.join(f'{tic_label(tic)!r} {tic:.6g}' for tic in tics)})\n")


def tic_label(value):
    return f"{value:,.0f}" if value >= 1 else f"{value:g}"


def sorted_curves(rows, columns, title, label, caption, *, top=None, is_log=False):
    series, shown = [], []
    for (column, name), color in zip(columns, CURVES, strict=False):
        values = sorted(row[column] for row in with_values(rows, column))
        if values:
            shown += values
            size = 0.3 if len(values) > 30 else 0.6
            series.append((column, f"with linespoints linecolor rgb '{color}' linewidth 1.5 pointtype 7 "
                           f"pointsize {size} title '{name}'", list(enumerate(values, 1))))
    if not series:
        return None
    count = max(len(points) for _, _, points in series)
    scale = log_axis("y", shown) if is_log else f"set yrange [0:{top or ''}]\n"
    each = "set xtics 1\n" if count < 15 else ""  # not at halves
    return Figure(title, caption, f"set xlabel 'inputs'\nset ylabel '{label}'\nset grid\nset xrange [0:{count + 1}]\n"
                  f"{each}{scale}" + plot(series))


def progress(rows):
    """How many inputs had a result after so long, and how many tasks worked."""
    periods = busy_periods(rows)
    if not periods:
        return None
    ends = [(end, number) for number, end in enumerate(sorted(end for _, end in periods), 1)]
    busy = at_work(periods, INTERVALS)
    series = [("ended", f"with steps linecolor rgb '{CURVES[0]}' linewidth 1.5 title 'results'",
               [(0.0, 0), *ends]),
              ("working", f"axes x1y2 with histeps linecolor rgb '{CURVES[1]}' title 'tasks at work (right)'", busy)]
    most = max((number for _, number in busy), default=1.0)
    return Figure("Progress",
                  f"Results of the last run, and its tasks at work (mean of each {INTERVALS}th of its time).",
                  "set xlabel 'time, s'\nset ylabel 'results'\nset y2label 'tasks at work'\nset border 11\nset y2tics\n"
                  f"set xrange [0:*]\nset yrange [0:*]\nset y2range [0:{1.5 * most:.6g}]\n" + plot(series))


def plot(series):
    """`series`: (name, how it is drawn, points)."""
    data = "".join(f"${name} << EOD\n" + "".join(f"{x:.9g} {y:.9g}\n" for x, y in points) + "EOD\n"
                   for name, _, points in series)
    return data + "plot " + ", \\\n  ".join(f"${name} using 1:2 {style}" for name, style, _ in series) + "\n"


def drawn(figure, name):
    """The SVG element, or nothing: gnuplot is not there, or failed."""
    if not shutil.which("gnuplot"):
        return ""
    done = subprocess.run(["gnuplot"], input=TERMINAL.format(name=name) + figure.script, capture_output=True, text=True,
                          check=False)
    start = done.stdout.find("<svg")  # the header before is of a file
    return done.stdout[start:] if not done.returncode and start >= 0 else ""
