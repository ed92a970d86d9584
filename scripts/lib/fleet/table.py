"""The results as one table, and what they come to."""

import csv
import io

COLUMNS = ("name", "kind", "state", "step", "exit_code", "reason", "input", "points", "segments", "parts", "frames",
           "located", "segmented_s", "wall_s", "cpu_s", "peak_memory_MB", "object_iou", "instance_iou", "objects_found",
           "objects", "achievable_accuracy", "undersegmentation_error", "ate_m", "started", "host", "version")
STATES = ("done", "failed", "missing")


def as_csv(rows):
    """A line for each input; what is not known is empty. An input that is done may have a reason, too: why a quality is
    not known."""
    text = io.StringIO()
    writer = csv.writer(text, lineterminator="\n")
    writer.writerow(COLUMNS)
    for row in rows:
        writer.writerow([row.get(column, "") for column in COLUMNS])
    return text.getvalue()


def count(rows):
    """How many inputs are in each of STATES."""
    return {state: sum(row["state"] == state for row in rows) for state in STATES}


def with_values(rows, *columns):
    """The rows that are done and have numbers in these columns."""
    return [row for row in rows if row["state"] == "done"
            and all(isinstance(row.get(column), (int, float)) for column in columns)]


def total(rows, column):
    return sum(row[column] for row in with_values(rows, column))


def mean(rows, column):
    """None without a value."""
    found = with_values(rows, column)
    return total(rows, column) / len(found) if found else None


def busy_periods(rows):
    """(beginning, end) of each task, seconds since the first one began."""
    found = [(row["started_s"], row["started_s"] + row["wall_s"]) for row in rows if "started_s" in row]
    first = min((begin for begin, _ in found), default=0.0)
    return [(begin - first, end - first) for begin, end in found]


def at_work(periods, num_intervals):
    """(middle, mean number of tasks at work) of intervals of one length, up to the end of the last task."""
    length = max(end for _, end in periods) / num_intervals
    if not length:
        return []
    sums = [0.0] * num_intervals
    for begin, end in periods:
        for place in range(int(begin / length), min(int(end / length) + 1, num_intervals)):
            sums[place] += max(0.0, min(end, (place + 1) * length) - max(begin, place * length))
    return [((place + 0.5) * length, busy_s / length) for place, busy_s in enumerate(sums)]
