"""The main results, out of the tables of the sections."""

from dataclasses import dataclass

from . import objects
from .tables import markdown, parse_tables


@dataclass(frozen=True)
class Result:
    what: str
    section: str
    table: int  # which of the section's tables
    row: str  # how a row is called
    value: str  # the result in a row
    only: tuple = ()  # the column and the values that a row must have there to be shown


RESULTS = (
    Result("Frames dropped at the camera's rate of 30 Hz", "live", 0, "{recording}", "{dropped} of {frames}"),
    Result("CPU time of mapper, segmenter and viewer together, a frame, ms", "live", 0, "{recording}",
           "{all three, CPU-ms a frame}"),
    Result("Centre pixel of the camera has its right segment, % of a live run", "live", 1, "{recording}",
           "{centre pixel has its right segment, %}"),
    Result("From surface that was seen long enough to its label, median (p99), s", "live", 1, "{recording}",
           "{from seen to labelled, median (p99), s}"),
    Result("Mapping a frame: median wall time (CPU time), ms", "paths", 0, "{input}",
           "{wall p50, ms} ({CPU a frame, ms})"),
    Result("Frames located of each recording", "recordings", 0, "{recording}", "{located} of {frames}"),
    Result("Error of the camera's path: ATE rmse, mm", "paths", 0, "{input}", "{ATE rmse, mm}"),
    Result("Drift at the end of the path, % of its length", "paths", 0, "{input}", "{drift, %}"),
    Result("Frames fused wrongly, and refused, under all disturbances", "recovery", 0, "{input}",
           "{wrong} and {refused} of {frames}"),
    Result("Distance of the map's points from the true surface: median, mm", "surface", 0, "{room}", "{median, mm}"),
    Result("Segmenting a slice, mode `exact`: average, ms", "maps", 0, "{map}", "{average, ms}",
           ("mode", "exact", "the paper's")),
    Result("Segments equal to those of mode `batch`, mode `exact`, %", "maps", 1, "{map}", "{v = 1, %}",
           ("mode", "exact")),
    Result("Segments equal to those of mode `batch`, mode `voting`, %", "maps", 1, "{map}", "{v = 1, %}",
           ("mode", "voting")),
    Result("Segmenting a slice of a map of 4 million points: average (p99), ms", "exact", 0, "{preset}",
           "{average, ms} ({p99, ms})"),
    Result("Objects of `office`: mean best IoU", "quality", 0, "{map}, {preset}", "{objects, mean best IoU}"),
    Result("Changes of a room: precision / recall", "objects", 0, "office", "{measured}", ("what", objects.CHANGES)),
    Result("Objects of one room found in another: precision / recall", "objects", 0, "kitchen", "{measured}",
           ("what", objects.FOUND)),
)


def summary(texts):
    """From what the sections printed, by name; results of sections without a table are left out."""
    rows = []
    for result in RESULTS:
        tables = parse_tables(texts.get(result.section, ""))
        if result.table >= len(tables):
            continue
        shown = [row for row in tables[result.table]
                 if not result.only or row[result.only[0]] in result.only[1:]]
        cells = ", ".join(f"{result.row.format_map(row)}: {result.value.format_map(row)}" for row in shown)
        rows.append([result.what, cells, f"[{result.section}](#{result.section})"])
    return markdown(["what", "result", "section"], rows) if rows else "(not measured yet)\n"
