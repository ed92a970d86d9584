"""Sections about the viewer, the bus, the machine and the source code."""

import re

from .run import SCRIPTS
from .tables import first_table, fixed, markdown, number


def renderer(run):
    titles = {"draw_figure/follow": "following the camera", "draw_figure/overview": "whole map"}
    rows = [[titles.get(m.name.rsplit("/", 1)[0], m.name), fixed(m.counter("points"), 0), number(m.wall_ms),
             number(m.cpu_ms)] for m in run.google_benchmark("bench_renderer")]
    return markdown(["view", "points", "wall, ms", "CPU of the drawing thread, ms"], rows)


def late_viewer(run):
    rows = [[fixed(m.counter("points"), 0), "yes" if m.arguments["pictures"] == "1" else "no",
             fixed(m.counter("sent_MB"), 0), number(m.wall_ms), fixed(m.counter("peak_MB"), 0)]
            for m in run.google_benchmark("bench_late_viewer")]
    return markdown(["points", "final pictures drawn too", "chunks, MB", "wall, ms", "peak memory, MB"], rows)


def streams(run):
    return run.bench("bench_stream")


def limits(run):
    """Only of the best instruction set, which is the last one measured."""
    measured = run.google_benchmark("bench_machine", "--benchmark_min_time=0.1")
    best = measured[-1].label
    rates = {"calculate": ("single-precision operations, 10^9/s", "operations", 1e-9),
             "read": ("sequential reads, GB/s", "bytes_per_second", 1e-9),
             "read_scattered": ("gathers of one vector, 10^6/s", "items_per_second", 1e-6)}
    rows = {}
    for m in measured:
        if m.label != best:
            continue
        title, counter, scale = rates[m.name]
        size_kB = int(m.arguments["kB"])
        rows.setdefault((title, f"{size_kB:,}" if size_kB else None), []).append(number(scale * m.counter(counter)))
    return f"Instruction set: {best}.\n\n" + markdown(
        ["what", "data, kB", "1 thread", "2 threads"], [[*key, *rates_found] for key, rates_found in rows.items()])


def structure(run):
    return structure_table(run.execute([f"{SCRIPTS}/check_layers", "--report"], may_fail=True))


def structure_table(report):
    """Sums the folders of each process up; below, the last line of the report, which is about all of them."""
    parts = {}
    for row in first_table(report):
        parts.setdefault(row["folder"].split("/")[0], []).append(row)

    def column(rows, name):
        return [int(row[name]) for row in rows]

    table = markdown(
        ["part", "folders", "files", "files in the largest folder", "most layers in a folder",
         "pairs of folders, one including the other"],
        [[part, len(rows), sum(column(rows, "files")), max(column(rows, "files")), max(column(rows, "layers")),
          sum(column(rows, "to other folders"))] for part, rows in parts.items()])
    total = re.search(r"(?m)^\d+ files, .*$", report)
    return f"{table}\nAll together: {total[0]}.\n" if total else table


def faults(run):
    # Of a folder that is kept, rows that hold are not run again: all of them take longer than a machine is free.
    return run.execute([f"{SCRIPTS}/faults", "--all", "--missing", "--out", run.folder / "faults"], may_fail=True)
