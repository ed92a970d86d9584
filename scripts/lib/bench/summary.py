"""The main results, out of the tables of the sections."""

from .tables import markdown, parse_tables

# What, unit, section, which of its tables, the rows' own names, and the result of a row.
RESULTS = (
    ("Camera rate, 30 Hz: frames dropped", "", "live", 0, "{recording}", "{dropped} of {frames}"),
    ("Camera rate: CPU time of mapper, segmenter and viewer together, a frame", "ms", "live", 0, "{recording}",
     "{all three, CPU-ms a frame}"),
    ("Mapping a frame, median wall time (CPU time)", "ms", "paths", 0, "{input}",
     "{wall p50, ms} ({CPU a frame, ms})"),
    ("Error of the camera's path, ATE rmse", "mm", "paths", 0, "{input}", "{ATE rmse, mm}"),
    ("Error at the end of the path", "% of the path", "paths", 0, "{input}", "{drift, %}"),
    ("Distance of the map's points from the true surface, median", "mm", "surface", 0, "{room}", "{median, mm}"),
    ("Segmenting a slice, average", "ms", "maps", 0, "{map}, {mode}", "{average, ms}"),
    ("Segments that are the same as those of mode `batch`", "%", "maps", 1, "{map}, {mode}", "{v = 1, %}"),
    ("Segmenting a slice of a map of 4 million points, average (p99)", "ms", "exact", 0, "{preset}",
     "{average, ms} ({p99, ms})"),
    ("Objects of `office`, mean best IoU", "", "quality", 0, "{map}, {preset}", "{objects, mean best IoU}"),
)


def summary(texts):
    """From what the sections printed, by name; results whose section has no table are left out."""
    rows = []
    for what, unit, section, table, name, result in RESULTS:
        tables = parse_tables(texts.get(section, ""))
        if table >= len(tables):
            continue
        cells = ", ".join(f"{name.format_map(row)}: {result.format_map(row)}" for row in tables[table])
        rows.append([what, unit, cells, f"[{section}](#{section})"])
    return markdown(["what", "unit", "result", "section"], rows)
