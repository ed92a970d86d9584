"""Sections about the segmenter."""

import re
import shlex
from pathlib import Path

from trio.messages import Problem
from trio.programs import ROOT, program

from .memory_limit import MemoryLimit
from .run import BENCH_PROGRAMS, PAPER_SLICES, SCRIPTS, room
from .tables import fixed, markdown, number, parse_tables, read_csv

PAPER_RESULTS = Path(ROOT, "segmenter", "evaluation", "paper", "paper_results.hpp")


def maps(run):
    lines, agreements = [], []
    for source in run.inputs("office", "loop"):
        add_map(run, source, [], [], lines, agreements)
    two_floors = room("two-floors")
    truth = shlex.quote(str(run.true_path(two_floors)))
    add_map(run, two_floors, ["--mapper", f"--trajectory {truth}"], ["--batch-budget", 30], lines, agreements)
    header = ["map", "vertices", "slices", "build, s", "length, m", "mode", "max, ms", "max before the final slice, ms",
              "min, ms", "average, ms", "p99, ms", "CPU average, ms", "total, s", "slices behind, max",
              "slices behind, average"]
    return markdown(header, lines + paper_rows()) + "\n" + markdown(
        ["map", "mode", "segments", "v = 1, %", "mean v", "points in segments with v = 1, %",
         "segments of 100 points and more", "of these v = 1, %", "of these mean v"], agreements)


def add_map(run, source, options_of_trio, options_of_evaluation, lines, agreements):
    """Appends a row for each mode to both tables."""
    name = f"map_{source.name}"
    out = run.folder / name / "evaluation"
    run.trio(name, source, "--replay", *PAPER_SLICES, *options_of_trio)
    run.kintsugi("evaluate", run.folder / name / "run.lcm", "--out", out, *options_of_evaluation)
    behind = {row["mode"]: row for row in read_csv(out / "table2.csv")}
    for row in read_csv(out / "table1.csv"):
        slices_ms = [float(each["engine_ms"]) for each in read_csv(out / f"slices_{row['mode']}.csv")]
        about = "" if int(row["runs"]) >= int(row["slices"]) else "~ "
        lag = behind.get(row["mode"])
        lines.append([source.name, fixed(row["vertices"], 0), row["slices"], fixed(row["build_time_s"], 1),
                      fixed(row["length_m"], 1), row["mode"], number(row["max_ms"]),
                      number(max(slices_ms[:-1], default=0)), number(row["min_ms"]),
                      about + number(row["average_ms"]), number(row["p99_ms"]), number(row["cpu_average_ms"]),
                      about + number(row["total_s"]), lag and lag["max_slices_behind"],
                      lag and fixed(lag["average_slices_behind"], 2)])
    results = read_csv(out / "agreement.csv")
    for mode in dict.fromkeys(row["mode"] for row in results if row["mode"] != "batch"):
        any_size, large = (row for row in results if row["mode"] == mode)
        agreements.append([source.name, mode, fixed(any_size["segments"], 0), percent(any_size["share_v1"]),
                           fixed(any_size["mean_v"], 3), percent(any_size["point_share_v1"]),
                           fixed(large["segments"], 0), percent(large["share_v1"]), fixed(large["mean_v"], 3)])


def percent(share):
    return fixed(100 * float(share), 1)


def paper_rows():
    """The paper's Tables I and II, which kintsugi-evaluate knows."""
    datasets = re.findall(r'\{"([^"]+)", ([^}]+)\}', PAPER_RESULTS.read_text())
    rows = []
    for name, values in datasets:
        vertices, slices, build_s, length_m, max_ms, min_ms, average_ms, total_s, behind, average_behind = (
            float(value.replace("'", "")) for value in values.split(","))
        rows.append([f"paper: {name}", fixed(vertices, 0), fixed(slices, 0), fixed(build_s, 1), fixed(length_m, 1),
                     "the paper's", number(max_ms), None, number(min_ms), number(average_ms), None, None,
                     number(total_s), fixed(behind, 0), fixed(average_behind, 1)])
    return rows


def quality(run):
    scores, sweeps = [], []
    office = room("office")
    runs = (("true poses", "true", ["--trajectory", run.true_path(office)], ["--scene-frame"]),
            ("tracked", "tracked", [], []))
    for title, name, options_of_mapper, options_of_truth in runs:
        out = run.folder / f"quality_{name}"
        log, truth = out.with_suffix(".lcm"), out.with_suffix(".ply")
        run.map_alone(out.name, office, "--store", log, *PAPER_SLICES, *options_of_mapper)
        run.kintsugi("ground-truth", office.device, log, truth, *options_of_truth)
        run.kintsugi("evaluate", log, "--ground-truth", truth, "--sweep", "--out", out)
        for figure in out.glob("*.gp"):
            draw_figure(run, figure)
        results = read_csv(out / "quality.csv")
        scores += [[title, *score_cells(row)] for row in results if not row["parameter"]]
        sweeps += [[title, *cells] for cells in sweep_cells(results)]
    return markdown(["map", "preset", "objects, mean best IoU", "all instances, mean best IoU", "objects found", "ASA",
                     "UE", "boundary recall", "boundary precision", "points in large segments, %", "segments"],
                    scores) + "\n" + markdown(
        ["map", "parameter", "lowest mean best IoU (factor)", "highest mean best IoU (factor)"], sweeps)


def score_cells(row):
    return [row["name"], fixed(row["object_iou"], 3), fixed(row["instance_iou"], 3),
            f"{row['objects_found']} of {row['objects']}", fixed(row["achievable_accuracy"], 3),
            fixed(row["undersegmentation_error"], 3), fixed(row["boundary_recall"], 3),
            fixed(row["boundary_precision"], 3), percent(row["large_segment_share"]), fixed(row["segments"], 0)]


def sweep_cells(results):
    """For each parameter, the worst and the best of the values that were tried."""
    rows = []
    for parameter in dict.fromkeys(row["parameter"] for row in results if row["parameter"]):
        tried = sorted((row for row in results if row["parameter"] == parameter),
                       key=lambda row: float(row["object_iou"]))
        rows.append([f"`{parameter}`", *(f"{fixed(row['object_iou'], 3)} ({row['factor']})"
                                         for row in (tried[0], tried[-1]))])
    return rows


def draw_figure(run, script):
    """Draws a figure of kintsugi-evaluate as PNG, beside its gnuplot script."""
    terminal = "set terminal pngcairo size 800,340 font 'sans-serif,10' noenhanced\n"
    picture = script.with_suffix(".png")
    beside = script.with_suffix(".png.gp")
    beside.write_text(f"{terminal}set output '{picture}'\n" + script.read_text().split("\n", 1)[1])
    run.execute(["gnuplot", beside])


TITLES = {
    "neighbours_of_all/grid": "neighbours of all points, grid",
    "neighbours_of_all/flann": "neighbours of all points, FLANN",
    "batch/grid": "batch, grid",
    "batch/flann": "batch, FLANN",
    "rows": "sort the points into rows",
    "pairs_of_rows": "find all pairs of neighbours, one thread",
    "grid_slice_by_slice": "grid, one thread: insert a slice and find its neighbours",
    "slice_by_slice/voting": "voting with segment ids",
}


def segmenter(run):
    whole, slices = [], []
    for millions, environment, options in ((1, {}, []), (4, {"KINTSUGI_BENCH_POINTS": "4000000"}, [
            "--benchmark_filter=batch/grid|grid_slice|rows"])):
        for m in run.google_benchmark("bench_segmenter", *options, environment=environment):
            if "p99_ms" in m.counters:
                slices.append([f"{millions} M", TITLES[m.name], fixed(m.counter("slices"), 0),
                               *(number(m.counter(f"{each}_ms")) for each in ("mean", "median", "p99", "max"))])
            else:
                threads = m.arguments.get("threads")
                memory = m.counter("peak_bytes_per_point")
                whole.append([f"{millions} M", TITLES[m.name] + (f", threads: {threads}" if threads else ""),
                              number(m.wall_ms), number(m.cpu_ms), memory and fixed(memory, 0)])
    return markdown(["points", "what", "wall, ms", "CPU, ms", "peak memory, bytes a point"], whole) + "\n" + markdown(
        ["points", "what", "slices", "mean, ms", "median, ms", "p99, ms", "max, ms"], slices)


def exact(run):
    tables = {preset: parse_tables(run.bench("bench_exact", "--threads", 1, "--corrections", 300, "--preset", preset))
              for preset in ("paper", "objects")}
    return exact_tables(tables)


def beyond_memory(run):
    """Each run of bench_memory is a column."""
    large = ("--points", 50_000_000)
    printed = {"5 million": run.bench("bench_memory", "--points", 5_000_000),
               "50 million": run.bench("bench_memory", *large)}
    with MemoryLimit(4 << 30) as limit:
        command = [f"{BENCH_PROGRAMS}/bench_memory", *large, "--max-memory", 3000, "--swap-folder", run.folder]
        printed["50 million, in 4 GiB"] = run.execute(limit.command(*command), name="bench_memory_in_4_gib")
    printed["50 million, batch"] = run.bench("bench_memory", *large, "--batch")
    columns = {name: by_first_column(parse_tables(text)[0]) for name, text in printed.items()}
    if len({column["digest of the partition"][0] for name, column in columns.items() if name != "5 million"}) != 1:
        raise Problem("the partitions of 50 million points differ")
    rows = dict.fromkeys(row for column in columns.values() for row in column)
    return markdown(["", *columns], [[row, *(column.get(row, [None])[0] for column in columns.values())]
                                     for row in rows])


def exact_tables(tables):
    """From the tables that bench_exact printed for each preset: a row of each preset, and the corrections."""
    header = ["preset", "average, ms", "median, ms", "p99, ms", "max, ms", "CPU average, ms",
              "fragments, average, ms", "first million, ms", "last million, ms", "engine, bytes a point",
              "batch over all points, ms"]
    rows, corrections = [], {}
    for preset, found in tables.items():
        times, values, batch, *_ = (by_first_column(table) for table in found)
        fixes = found[-1]
        rows.append([preset, *times["all"], times["CPU"][0], times["- fragments"][0],
                     *(values[name][0] for name in ("first million, ms a slice", "last million, ms a slice",
                                                    "engine, bytes a point")), batch["wall, ms (median of 3)"][0]])
        for row in fixes:
            cells = corrections.setdefault(next(iter(row.values())), [row["points each"]])
            cells += [row["p50, ms"], row["max, ms"]]
    return markdown(header, rows) + "\n" + markdown(
        ["correction of the finished map", "points each",
         *(f"`{preset}`: {value}, ms" for preset in tables for value in ("p50", "max"))],
        [[name, *cells] for name, cells in corrections.items()])


def by_first_column(table):
    return {cells[0]: cells[1:] for cells in (list(row.values()) for row in table)}


def corrections(run):
    """In memory; and on a bus, with a segmenter that runs beside it."""
    segmenter = shlex.join([program("segmenter"), "--out", str(run.folder), "--linger", "-1"])
    client = f"{BENCH_PROGRAMS}/bench_closing --runs 7"
    on_bus = run.execute([f"{SCRIPTS}/private_bus", "bash", "-c",
                          f"{segmenter} >segmenter.txt 2>&1 & {client}; code=$?; kill $!; wait; exit $code"],
                         name="bench_closing")
    return run.bench("bench_motions", "--runs", 7) + "\nThe same map on the bus:\n\n" + on_bus


def whole_map(run):
    printed = run.bench("bench_whole_map", "--points", 4000000)
    rows = [[row["what"], row["ms"], row["MB"] if float(row["MB"]) else None] for row in parse_tables(printed)[0]]
    return printed.splitlines()[0] + ".\n\n" + markdown(["what", "ms", "MB"], rows)
