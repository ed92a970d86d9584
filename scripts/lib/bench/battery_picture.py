"""The picture of the battery, a square for each case: its upper half is coloured by the share of frames located, its
lower half by the error of the path. A script for gnuplot; coordinates are pixels, from the upper left corner."""

import math

from .tables import fixed, percent_down

# From good to bad. Blue to red: colour-blind people can tell them apart.
COLORS = ("#2166ac", "#92c5de", "#fee8a0", "#f4a582", "#b2182b")
NOTHING = "#bdbdbd"
LOCATED_AT_LEAST = (0.99, 0.97, 0.90, 0.50, 0.0)
ATE_MM_AT_MOST = (5.0, 10.0, 25.0, 50.0, math.inf)  # half a voxel of 8.8 mm, one, about three, about six

SQUARE, GAP = 66, 4  # pixels
BETWEEN_ROOMS = 14
LEFT, TOP, BELOW, RIGHT = 150, 100, 110, 20
LEGEND_BOX = 92


def color_of_located(share):
    return NOTHING if share is None else COLORS[[share >= least for least in LOCATED_AT_LEAST].index(True)]


def color_of_ate(ate_mm):
    return NOTHING if ate_mm is None else COLORS[[ate_mm <= most for most in ATE_MM_AT_MOST].index(True)]


def script_of(rows, columns, results, picture):
    """@param rows: pairs of room and sensor; columns: texts; results: by (row, column), absent: not measured"""
    tops = tops_of(rows)
    height = tops[-1] + SQUARE + BELOW
    width = max(LEFT + SQUARE * len(columns) + RIGHT, LEFT + LEGEND_BOX * (len(COLORS) + 1) + RIGHT)
    lines = [f"set terminal pngcairo size {width},{height} font 'sans-serif,10' noenhanced",
             f"set output '{picture}'", "unset border; unset tics; unset key",
             "set lmargin 0; set rmargin 0; set tmargin 0; set bmargin 0",
             f"set xrange [0:{width}]; set yrange [{height}:0]",
             *text(LEFT, 20, "Above: frames located, %. Below: error of the path (ATE rmse), mm.", "left")]
    for x, column in enumerate(columns):
        words = column.replace("depth alone", "depth").split(", ")
        lines += text(LEFT + (SQUARE - GAP) / 2 + SQUARE * x, TOP - 16 * len(words), "\\n".join(words))
    for top, (room, sensor) in zip(tops, rows, strict=True):
        if (room, sensor) == next(row for row in rows if row[0] == room):
            lines += text(10, top + SQUARE / 2, room, "left", bold=True)
        lines += text(LEFT - 8, top + SQUARE / 2, sensor, "right")
        for x, column in enumerate(columns):
            if ((room, sensor), column) in results:
                lines += square(LEFT + SQUARE * x, top, results[(room, sensor), column])
    return "\n".join([*lines, *legend(height - BELOW + 30), "plot NaN", ""])


def tops_of(rows):
    """The upper edge of each row, with some room between the rooms."""
    tops = [TOP]
    for before, row in zip(rows, rows[1:]):
        tops.append(tops[-1] + SQUARE + BETWEEN_ROOMS * (row[0] != before[0]))
    return tops


def square(x, y, result):
    located = "failed" if result.located_share is None else percent_down(result.located_share)
    ate = "-" if result.ate_mm is None else fixed(result.ate_mm, 1)
    half = (SQUARE - GAP) / 2
    return (box(x, y, SQUARE - GAP, half, color_of_located(result.located_share), located) +
            box(x, y + half, SQUARE - GAP, half, color_of_ate(result.ate_mm), ate))


def legend(y):
    located = [f">= {100 * least:g} %" for least in LOCATED_AT_LEAST[:-1]] + [f"< {100 * LOCATED_AT_LEAST[-2]:g} %",
                                                                              "failed"]
    ates = [f"<= {most:g} mm" for most in ATE_MM_AT_MOST[:-1]] + [f"> {ATE_MM_AT_MOST[-2]:g} mm", "no path"]
    lines = []
    for title, names, top in (("located", located, y), ("ATE rmse", ates, y + 34)):
        lines += text(LEFT - 8, top + 14, title, "right")
        for place, (name, color) in enumerate(zip(names, (*COLORS, NOTHING), strict=True)):
            lines += box(LEFT + LEGEND_BOX * place, top, LEGEND_BOX - GAP, 28, color, name)
    return lines


def box(x, y, width, height, color, content):
    is_dark = color in (COLORS[0], COLORS[-1])
    return [f"set object rectangle from {x},{y} to {x + width},{y + height} fillcolor rgb '{color}' "
            "fillstyle solid noborder behind",
            *text(x + width / 2, y + height / 2, content, color="#ffffff" if is_dark else "#000000")]


def text(x, y, content, side="center", *, color="#000000", bold=False):
    font = " font 'sans-serif:Bold,11'" if bold else ""
    return [f'set label "{content}" at {x},{y} {side} textcolor rgb "{color}"{font}']
