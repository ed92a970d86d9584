"""Sections about the mapper."""

import re
from collections import Counter

from .accuracy import error, trajectory_errors
from .run import Input, room
from .tables import first_table, fixed, markdown, number, quantile, read_csv

VOXEL_M = 4.5 / 512  # the mapper's default


def stages(run):
    text = ""
    for source in run.inputs("office"):
        output = run.bench("bench_frame", "--device", source.device, "--threads", "1,2", "--resolution", VOXEL_M,
                           *run.limited("--frames"))
        text += f"`{source.name}`, ms:\n\n{stage_table(first_table(output))}\n"
    return text


# Of a recording, reading and converting count as part of the frame; a synthetic room is rendered before.
OMITTED_STAGES = ("read, decode (wait)", "convert, undistort", "frames / lost / slices")


def stage_table(rows):
    """Single values instead of `wall median / wall p99 / CPU mean`."""
    name, *runs = rows[0]
    header = ["stage"] + [f"{re.sub('.* mm, ', '', each)}: {value}" for each in runs
                          for value in ("wall median", "wall p99", "CPU mean")]
    kept = [row for row in rows if row[name] not in OMITTED_STAGES and "threads" not in row[name]
            and "worker" not in row[name]]
    return markdown(header, [[row[name], *(value for each in runs for value in row[each].split(" / "))]
                             for row in kept])


def volume(run):
    measured = run.google_benchmark("bench_volume")
    titles = {"raycast/guided": "raycast, started at the measured depth", "raycast/unguided": "raycast, without it",
              "integrate": "allocate and fuse, with colour"}
    kernels = [m for m in measured if m.name in titles]
    sets = list(dict.fromkeys(m.label for m in kernels))
    wall_ms = {(m.name, m.arguments["threads"], m.label): number(m.wall_ms) for m in kernels}
    rows = [[titles[name], threads, *(wall_ms[name, threads, each] for each in sets)]
            for name, threads in dict.fromkeys((m.name, m.arguments["threads"]) for m in kernels)]
    others = [[{"extract": "extract the surface", "snapshot": "copy the volume"}.get(m.name, m.name),
               number(m.wall_ms), number(m.cpu_ms)] for m in measured if m.name not in titles]
    return (markdown(["stage", "threads", *(f"{each}, ms" for each in sets)], rows) + "\n" +
            markdown(["stage, all threads", "wall, ms", "CPU, ms"], others))


def paths(run):
    header = ["input", "frames", "located", "wall p50, ms", "wall p99, ms", "CPU a frame, ms", "ATE rmse, mm",
              "ATE median, mm", "ATE max, mm", "RPE over 1 s rmse, mm", "RPE over 1 s rmse, deg", "path, m", "drift, %",
              "RPE over 1 m rmse, mm"]
    rows = []
    for source in run.inputs("office", "loop", "two-floors"):
        mapped = run.map_tracked(source)
        frame_ms = [float(row["frame_ms"]) for row in read_csv(mapped.timings)]
        errors = trajectory_errors(run, mapped, source)
        rows.append([source.name, mapped.count("frames in"), mapped.count("located"), fixed(quantile(frame_ms, 0.5), 1),
                     fixed(quantile(frame_ms, 0.99), 1), fixed(mapped.cpu_ms, 1),
                     *(error(errors, f"ate_m_{each}", 1e3) for each in ("rmse", "median", "max")),
                     error(errors, "rpe_m_rmse", 1e3), error(errors, "rpe_deg_rmse"), error(errors, "path_length_m"),
                     error(errors, "drift_percent"), error(errors, "rpe_per_metre_m_rmse", 1e3)])
    return markdown(header, rows)


def memory(run):
    rows = read_csv(run.map_tracked(room("two-floors")).timings)
    step = max(len(rows) // 6, 1)
    shown = [i for i in range(len(rows)) if i % step == step - 1 or i == 0]
    return markdown(["frames mapped", "memory of the mapper, MB"],
                    [[f"{i + 1:,}", fixed(rows[i]["memory_mb"], 0)] for i in shown])


def loops(run):
    """The same round again and again: nothing may grow."""
    rows = []
    for laps in (1, 2, 10):
        source = Input(f"loop-{laps}", address=f"synthetic://loop?speed=3&laps={laps}")
        cloud = run.folder / f"{source.name}.ply"
        mapped = run.map_alone(source.name, source, "--cloud", cloud)
        points = int(re.search(r"cloud of (\d+) points", mapped.log)[1])
        closed = re.search(r"(\d+) loops closed, (\d+) contradicted", mapped.log)
        peak_MB, kept_MB = re.search(r"(\d+) MB of memory at most; (\d+) MB kept", mapped.log).groups()
        frames = read_csv(mapped.timings)
        rows.append([laps, f"{points:,}", closed[1] if closed else 0, closed[2] if closed else 0,
                     error(trajectory_errors(run, mapped, source), "ate_m_rmse", 1e3), kept_MB,
                     fixed(frames[-1]["memory_mb"], 0), peak_MB, fixed(mapped.cpu_ms, 1)])
    return markdown(["rounds", "points", "loops", "contradicted", "ATE rmse, mm", "kept, MB",
                     "memory in the last frame, MB", "at most, MB", "CPU a frame, ms"], rows)


def bare(run):
    rows = []
    for name in ("wall", "floor", "corridor", "wall-visit"):
        for source in (room(name), room(f"{name}-plain")):
            mapped = run.map_alone(f"bare_{source.name}", source)
            reasons = Counter(row["reason"] for row in read_csv(mapped.timings) if row["reason"])
            rows.append([source.name, mapped.count("frames in"), mapped.count("located"),
                         error(trajectory_errors(run, mapped, source), "ate_m_rmse", 1e3),
                         reasons.most_common(1)[0][0] if reasons else ""])
    return markdown(["scene", "frames", "located", "ATE rmse, mm", "most frequent reason of a loss"], rows)


def recovery(run):
    columns = {}
    for source in run.inputs("office"):
        columns[source.name] = run.bench("bench_recovery", "--device", source.device, *run.limited("--frames"))
    for source in run.recordings[:1]:
        columns[f"{source.name}, 300 frames, depth alone"] = run.bench(
            "bench_recovery", "--device", source.device, "--frames", run.frames or 300, "--depth-only")
    return recovery_table({name: first_table(output) for name, output in columns.items()})


def recovery_table(tables):
    """From the tables that bench_recovery printed for each input: the sums over all disturbances, and below, the
    disturbances as rows with three columns for each input."""
    sums = markdown(["input", "frames", "located", "wrong", "worst, mm", "refused"],
                    [[name, *disturbed_sums(table)] for name, table in tables.items()])
    header = ["disturbance"] + [f"{name}: {value}" for name in tables
                                for value in ("located", "wrong (worst, mm)", "refused")]
    rows = [[name] for name in (row["disturbance"] for row in next(iter(tables.values())))]
    for table in tables.values():
        for row, cells in zip(rows, table, strict=True):
            row += [located(cells), f"{cells['fused wrongly']} ({cells['worst, mm']})",
                    cells["refused"].split(" ")[0]]
    return sums + "\n" + markdown(header, rows)


def located(cells):
    parts = "" if cells["parts"] == "1" else f" in {cells['parts']} parts"
    return f"{cells['located']} of {cells['frames']}{parts}"


def disturbed_sums(table):
    disturbed = [row for row in table if row["disturbance"] != "none"]

    def total(name):
        return fixed(sum(int(row[name].split(" ")[0]) for row in disturbed), 0)

    worst_mm = max(float(row["worst, mm"]) for row in disturbed)
    return [total("frames"), total("located"), total("fused wrongly"), fixed(worst_mm, 1), total("refused")]


def surface(run):
    rows = []
    for source in (room("office"), room("loop")):
        cloud = run.folder / f"{source.name}.ply"
        run.map_alone(f"surface_{source.name}", source, "--cloud", cloud)
        words = run.kintsugi("evaluate-surface", cloud, source.device).split()
        value = dict(zip(words[::2], words[1::2], strict=True))
        rows.append([source.name, fixed(value["points"], 0), fixed(value["per_m2"], 0),
                     *(fixed(1e3 * float(value[f"{each}_m"]), 2) for each in ("median", "p95", "p99", "max")),
                     *(fixed(value[f"normal_{each}_deg"], 1) for each in ("median", "p95"))])
    return markdown(["room", "points", "points a m2", "median, mm", "p95, mm", "p99, mm", "max, mm",
                     "normal, median, deg", "normal, p95, deg"], rows)


def pictures(run):
    """The paths of pictures of each fused map from two sides."""
    lines = []
    for source in run.inputs("office"):
        name = f"picture_{source.name}"
        run.trio(name, source, "--replay", "--volume", "range")
        for yaw, pitch in ((30, 40), (-30, 65)):
            out = run.folder / name / f"from_{yaw}"
            run.kintsugi("viewer", "--log", run.folder / name / "run.lcm", "--out", out, "--size", "1600x1200",
                         "--every", 1000000, f"--overview-yaw={yaw}", f"--overview-pitch={pitch}")
            lines.append(f"{out / 'map_final.png'}\n")
    return "".join(lines)
