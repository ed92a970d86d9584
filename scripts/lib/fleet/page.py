"""The report page: one file that needs no other."""

from html import escape

from .figures import drawn, figures_of
from .table import count, mean, total, with_values

# As of the pages of kintsugi-evaluate.
STYLE = """
body { font: 16px/1.5 sans-serif; color: #222; background: #fff; max-width: 60rem; margin: 2rem auto; padding: 0 1rem; }
h1 { font-size: 1.6rem; } h2 { font-size: 1.2rem; margin-top: 2.2rem; }
table { border-collapse: collapse; font-size: .92rem; }
th, td { padding: .25rem .8rem .25rem 0; border-bottom: 1px solid #e0e0e0; text-align: right; vertical-align: top; }
th:first-child, td:first-child, .text, .long { text-align: left; } .long { overflow-wrap: anywhere; }
dl { display: grid; grid-template-columns: max-content auto; gap: .1rem 1.2rem; }
dt { color: #666; } dd { margin: 0; overflow-wrap: anywhere; }
.note, figcaption { color: #555; font-size: .92rem; } .remark { color: #a04000; }
figure { margin: 1rem 0 2rem; } svg { width: 100%; height: auto; }
.wide { overflow-x: auto; }
"""
EXTREMES = 10  # rows in the tables of the slowest and the worst
MOST_ROWS = 2000  # in the table of all: a page of some 100 KB; results.csv has all
MOST_FAILED = 200
CLASSES = {"reason": "long", "input": "long",
           **dict.fromkeys(("kind", "state", "step", "begun", "scheduler"), "text")}


def page(title, rows, runs, settings):
    """`rows` of the table, `runs` of the folder, `settings`: the options of the fleet."""
    body = [definitions(facts(rows, runs, settings)), failures(rows)]
    for number, figure in enumerate(figures_of(rows, runs[-1]["begun_s"] if runs else 0.0)):
        picture = drawn(figure, f"figure{number}") or remark("Not drawn: gnuplot is missing or failed. It is in the "
                                                             "Debian package gnuplot-nox.")
        body.append(f"{section(figure.title)}<figure>\n{picture}\n<figcaption>{escape(figure.caption)}</figcaption>\n"
                    "</figure>\n")
    body += [lost_frames(rows), extremes(rows), all_runs(runs), all_rows(rows)]
    return (f'<!DOCTYPE html>\n<html lang="en">\n<head>\n<meta charset="utf-8">\n<title>{escape(title)}</title>\n'
            f"<style>{STYLE}</style>\n</head>\n<body>\n<h1>{escape(title)}</h1>\n{''.join(body)}</body>\n</html>\n")


def facts(rows, runs, settings):
    numbers = count(rows)
    states = ", ".join(f"{number:,} {state}" for state, number in numbers.items() if number)
    found = [("Inputs", f"{len(rows):,}: {states}")]
    if numbers["done"]:
        memory_MB = max(row["peak_memory_MB"] for row in with_values(rows, "peak_memory_MB"))
        found += [("Points", f"{total(rows, 'points'):,}"), ("Segments", f"{total(rows, 'segments'):,}"),
                  ("Time", f"{duration(total(rows, 'wall_s'))} of all tasks; {duration(total(rows, 'cpu_s'))} of CPU"),
                  ("Peak memory", f"{memory_MB:,.0f} MB")]
    for column, name in (("object_iou", "Mean best IoU, objects"), ("instance_iou", "Mean best IoU, all instances"),
                         ("achievable_accuracy", "Achievable accuracy"),
                         ("undersegmentation_error", "Under-segmentation error"), ("ate_m", "Error of the path (ATE), m")):
        if (value := mean(rows, column)) is not None:
            found.append((name, f"{value:.3f}, mean over {len(with_values(rows, column)):,} inputs"))
    if objects := total(rows, "objects"):
        found.append(("Objects found", f"{total(rows, 'objects_found'):,.0f} of {objects:,.0f}"))
    options = [f"preset {settings['preset']}"] if settings["preset"] else []
    options += [f"{word}: {' '.join(settings[word])}" for word in ("cloud", "segmenter", "mapper") if settings[word]]
    found.append(("Options", "; ".join(options) or "those of the programs"))
    for column, name in (("host", "Machines"), ("version", "Version")):
        found.append((name, ", ".join(sorted({str(row[column]) for row in rows if row.get(column)})) or "-"))
    if runs:
        found.append(("Last run", runs[-1]["begun"]))
    return found


def failures(rows):
    failed = [row for row in rows if row["state"] == "failed"]
    if not failed:
        return ""
    more = remark(f"{len(failed) - MOST_FAILED} more are in results.csv.") if len(failed) > MOST_FAILED else ""
    return section("Failed") + table(("name", "step", "exit_code", "reason", "input"), failed[:MOST_FAILED]) + more


def extremes(rows):
    parts = []
    for title, column, worst_first in (("The slowest", "segmented_s", True), ("The lowest quality", "object_iou", False),
                                       ("The largest errors of the path", "ate_m", True)):
        found = sorted(with_values(rows, column), key=lambda row: row[column], reverse=worst_first)
        if len(found) > 1:
            columns = ("name", "points", "segments", column)
            parts.append(section(title) + table(columns, found[:EXTREMES]))
    return "".join(parts)


def lost_frames(rows):
    """Recordings of which the camera was lost, those most of all first: they are done, and their maps have gaps."""
    found = [row for row in with_values(rows, "frames", "located") if row["located"] < row["frames"]]
    if not found:
        return ""
    found.sort(key=lambda row: row["located"] / row["frames"])
    return section("Frames that were not located") + table(("name", "frames", "located", "parts", "points"),
                                                           found[:EXTREMES])


def all_runs(runs):
    if not runs:
        return ""
    columns = ("begun", "elapsed_s", "scheduler", "workers", "tasks", "failed", "task_s", "at_work")
    return section("Runs") + table(columns, runs) + note(
        "workers: tasks at a time, where that was limited; task s: time of all tasks; at work: tasks at a time, mean.")


def all_rows(rows):
    columns = ("name", "kind", "state", "points", "segments", "segmented_s", "cpu_s", "peak_memory_MB", "object_iou",
               "ate_m")
    more = remark(f"The first {MOST_ROWS}; results.csv has all {len(rows)}.") if len(rows) > MOST_ROWS else ""
    return (f"{section('All inputs')}<details>\n<summary>{len(rows):,} rows</summary>\n"
            f"{table(columns, rows[:MOST_ROWS])}</details>\n{more}")


def table(columns, rows):
    def cells(tag, values):
        return "".join(f'<{tag} class="{CLASSES.get(column, "number")}">{escape(value)}</{tag}>'
                       for column, value in zip(columns, values, strict=True))

    lines = "".join(f"<tr>{cells('td', [shown(row.get(column)) for column in columns])}</tr>\n" for row in rows)
    header = cells("th", [column.replace("_", " ") for column in columns])
    return f'<div class="wide">\n<table>\n<tr>{header}</tr>\n{lines}</table>\n</div>\n'


def shown(value):
    if value is None:
        return ""
    if isinstance(value, float):
        return f"{value:,.3f}" if abs(value) < 100 else f"{value:,.0f}"
    return f"{value:,}" if isinstance(value, int) else str(value)


def duration(seconds):
    if seconds < 120:
        return f"{seconds:.1f} s"
    return f"{seconds / 60:.1f} min" if seconds < 7200 else f"{seconds / 3600:.1f} h"


def section(title):
    return f"<h2>{escape(title)}</h2>\n"


def definitions(pairs):
    return "<dl>\n" + "".join(f"<dt>{escape(name)}</dt><dd>{escape(value)}</dd>\n" for name, value in pairs) + "</dl>\n"


def note(text):
    return f'<p class="note">{escape(text)}</p>\n'


def remark(text):
    return f'<p class="remark">{escape(text)}</p>\n'
