"""Markdown tables, CSV files, and the output of Google Benchmark."""

import csv
import json
import math
import re

NOT_MEASURED = "not measured"


def markdown(header, rows):
    """A Markdown table; None is an empty cell."""
    def line(cells):
        return "".join(f"| {'' if cell is None else cell} " for cell in cells) + "|\n"

    return line(header) + "|---" * len(header) + "|\n" + "".join(map(line, rows))


def parse_tables(text):
    """The Markdown tables in a text, as lists of rows; a row is a dictionary from header to cell. Of two
    columns with one header the first counts."""
    tables, header = [], None
    for line in text.splitlines():
        if not line.startswith("|"):
            header = None
            continue
        cells = [cell.strip() for cell in line.strip().strip("|").split("|")]
        if header is None:
            header = cells
            tables.append([])
        elif not all(re.fullmatch(r":?-+:?", cell) for cell in cells):
            tables[-1].append({name: cells[header.index(name)] for name in header})
    return tables


def first_table(text):
    return (parse_tables(text) or [[]])[0]


def read_csv(file):
    """The rows of a CSV file, as dictionaries from header to text."""
    with open(file, newline="") as lines:
        return list(csv.DictReader(lines))


def fixed(value, decimals):
    """With so many decimals, and commas between thousands."""
    return f"{float(value):,.{decimals}f}"


def number(value):
    """With about three digits."""
    value = float(value)
    return fixed(value, 0 if value >= 99.5 else 1 if value >= 9.95 else 2 if value >= 0.995 else 3)


def percent_down(share):
    """To a tenth, rounded down: only all are 100."""
    return f"{math.floor(1000 * share + 1e-9) / 10:g}"


def quantile(values, share):
    """The smallest value that at least this share of the values does not exceed."""
    ordered = sorted(values)
    return ordered[max(math.ceil(share * len(ordered)), 1) - 1]


class Measurement:
    """The median of the repetitions of one benchmark: its name, the named arguments, wall and CPU time in ms,
    and its counters."""

    def __init__(self, entry):
        self.name, *arguments = self.parts(entry["run_name"])
        self.arguments = dict(argument.split(":", 1) for argument in arguments if ":" in argument)
        to_ms = {"ns": 1e-6, "us": 1e-3, "ms": 1.0, "s": 1e3}[entry.get("time_unit", "ns")]
        self.wall_ms = to_ms * entry["real_time"]
        self.cpu_ms = to_ms * entry["cpu_time"]
        self.label = entry.get("label", "")
        self.counters = entry

    @staticmethod
    def parts(run_name):
        """`raycast/guided/threads:2/real_time` is the benchmark `raycast/guided` with the argument threads:2."""
        parts = [part for part in run_name.split("/") if part not in ("real_time", "process_time")]
        plain = [part for part in parts if ":" not in part]
        return ["/".join(plain), *(part for part in parts if ":" in part)]

    def counter(self, name):
        return self.counters.get(name)


def parse_google_benchmark(text):
    """The medians in the JSON that a program prints with --benchmark_repetitions."""
    entries = json.loads(text)["benchmarks"]
    return [Measurement(entry) for entry in entries if entry.get("aggregate_name") == "median"]
