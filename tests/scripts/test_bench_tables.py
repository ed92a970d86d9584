"""The tables of scripts/bench, out of what the programs print."""

import json
import sys
import unittest
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "scripts" / "lib"))

from bench import mapping, others, segmenting, summary, tables  # noqa: E402

STAGES = """# folder:///somewhere, 300 frames

| ms: wall median / wall p99 / CPU mean | 8.8 mm, 1 thread | 8.8 mm, 2 threads |
|---|---|---|
| read, decode (wait) | 9.00 / 9.00 / - | 9.00 / 9.00 / - |
| track | 2.00 / 6.00 / 6.50 | 1.00 / 3.00 / 7.00 |
| of these, slice worker | - / - / 0.25 | - / - / 0.25 |
"""

RECOVERY = """| disturbance | frames | located | parts | fused wrongly | worst, mm | off reference | worst, mm | good | refused |
|---|---|---|---|---|---|---|---|---|---|
| none | 200 | 200 | 1 | 0 | 0.5 | 0 | 0.5 | 200 | 0 (0.0 %) |
| jump | 100 | 97 | 2 | 1 | 31.0 | 2 | 99.0 | 90 | 3 (3.3 %) |
| covered | 200 | 90 | 1 | 0 | 11.0 | 0 | 11.0 | 90 | 2 (2.2 %) |
"""

EXACT = """
| exact, ms a slice | average | median | p99 | max |
|---|---|---|---|---|
| all | 7.10 | 6.60 | 23.0 | 57.0 |
| CPU | 7.00 | 6.50 | 22.0 | 56.0 |
| - fragments | 1.60 | 1.50 | 4.80 | 9.00 |

| exact |  |
|---|---|
| first million, ms a slice | 6.40 |
| last million, ms a slice | 7.80 |
| engine, bytes a point | 122 |

| batch, all at once |  |
|---|---|
| wall, ms (median of 3) | 1,750 |

| exact, all at once |  |
|---|---|
| wall, ms (median of 3) | 2,500 |

| exact, correction | updates | points each | p50, ms | p90, ms | p99, ms | max, ms | us a point | built anew |
|---|---|---|---|---|---|---|---|---|
| one point is removed | 30 | 1 | 0.020 | 0.1 | 0.200 | 0.496 | 20 | 0 |
"""


def google_benchmark(name, **values):
    return {"run_name": name, "aggregate_name": "median", "time_unit": "us", "real_time": 2000.0, "cpu_time": 4000.0,
            **values}


class FakeRun:
    """Has the medians of one Google Benchmark program."""

    def __init__(self, *entries):
        self.measured = tables.parse_google_benchmark(json.dumps({"benchmarks": entries}))

    def google_benchmark(self, *arguments, **others):
        return self.measured


class Tables(unittest.TestCase):
    def test_a_table_is_read_as_it_was_written(self):
        text = tables.markdown(["a", "b, ms"], [["x", 1], ["y", None]])
        self.assertEqual(text, "| a | b, ms |\n|---|---|\n| x | 1 |\n| y |  |\n")
        self.assertEqual(tables.parse_tables("before\n" + text + "between\n" + text),
                         [[{"a": "x", "b, ms": "1"}, {"a": "y", "b, ms": ""}]] * 2)

    def test_numbers_have_about_three_digits(self):
        self.assertEqual([tables.number(value) for value in (0.0216, 1.2345, 12.345, 99.4, 1234.5)],
                         ["0.022", "1.23", "12.3", "99.4", "1,234"])

    def test_quantiles_are_values_of_the_sample(self):
        self.assertEqual([tables.quantile([4, 1, 3, 2], share) for share in (0.0, 0.5, 0.51, 1.0)], [1, 2, 3, 4])

    def test_google_benchmark_gives_medians_with_their_arguments(self):
        median, = FakeRun(google_benchmark("raycast/guided/threads:2/process_time/real_time", label="AVX2"),
                          google_benchmark("raycast", aggregate_name="mean")).measured
        self.assertEqual((median.name, median.arguments, median.label), ("raycast/guided", {"threads": "2"}, "AVX2"))
        self.assertEqual((median.wall_ms, median.cpu_ms), (2.0, 4.0))


class Sections(unittest.TestCase):
    def test_stages_have_a_column_for_each_value(self):
        table, = tables.parse_tables(mapping.stage_table(tables.first_table(STAGES)))
        self.assertEqual(table, [{"stage": "track", "1 thread: wall median": "2.00", "1 thread: wall p99": "6.00",
                                  "1 thread: CPU mean": "6.50", "2 threads: wall median": "1.00",
                                  "2 threads: wall p99": "3.00", "2 threads: CPU mean": "7.00"}])

    def test_recovery_has_sums_and_three_columns_for_each_input(self):
        sums, table = tables.parse_tables(mapping.recovery_table({"a": tables.first_table(RECOVERY)}))
        self.assertEqual(sums, [{"input": "a", "frames": "300", "located": "187", "wrong": "1", "worst, mm": "31.0",
                                 "refused": "5"}])
        self.assertEqual(table[1], {"disturbance": "jump", "a: located": "97 of 100 in 2 parts", "a: wrong (worst, mm)": "1 (31.0)",
                                    "a: refused": "3"})

    def test_exact_has_a_row_for_each_preset(self):
        found = tables.parse_tables(EXACT)
        times, corrections = tables.parse_tables(segmenting.exact_tables({"paper": found, "objects": found}))
        self.assertEqual([row["preset"] for row in times], ["paper", "objects"])
        self.assertEqual(times[0]["p99, ms"], "23.0")
        self.assertEqual(times[0]["fragments, average, ms"], "1.60")
        self.assertEqual(times[0]["batch over all points, ms"], "1,750")
        self.assertEqual(corrections, [{"correction of the finished map": "one point is removed", "points each": "1",
                                        "`paper`: p50, ms": "0.020", "`paper`: max, ms": "0.496",
                                        "`objects`: p50, ms": "0.020", "`objects`: max, ms": "0.496"}])

    def test_volume_has_a_column_for_each_instruction_set(self):
        run = FakeRun(*(google_benchmark(f"integrate/instruction_set:{i}/threads:1/real_time", label=label)
                        for i, label in enumerate(("portable", "AVX2"))), google_benchmark("extract/real_time"))
        kernels, others_found = tables.parse_tables(mapping.volume(run))
        self.assertEqual(kernels, [{"stage": "allocate and fuse, with colour", "threads": "1", "portable, ms": "2.00",
                                    "AVX2, ms": "2.00"}])
        self.assertEqual(others_found[0]["stage, all threads"], "extract the surface")

    def test_limits_are_those_of_the_best_instruction_set(self):
        names = [(f"read/instruction_set:{i}/kB:16/threads:{threads}", label) for i, label in ((0, "portable"), (1, "AVX2"))
                 for threads in (1, 2)]
        run = FakeRun(*(google_benchmark(name, label=label, bytes_per_second=(2 + i) * 1e9)
                        for i, (name, label) in enumerate(names)))
        table, = tables.parse_tables(others.limits(run))
        self.assertEqual(table, [{"what": "sequential reads, GB/s", "data, kB": "16", "1 thread": "4.00",
                                  "2 threads": "5.00"}])

    def test_structure_sums_up_each_process(self):
        report = tables.markdown(["folder", "files", "layers", "to other folders"],
                                 [["mapper", 2, 1, 3], ["mapper/core", 5, 4, 1]]) + "\n7 files, running back: 0\n"
        text = others.structure_table(report)
        self.assertIn("| mapper | 2 | 7 | 5 | 4 | 4 |", text)
        self.assertTrue(text.endswith("All together: 7 files, running back: 0.\n"))

    def test_the_paper_is_read_from_the_source_code(self):
        self.assertIn(["paper: Loop", "1,163,049", "164", "100.2", "14.7", "the paper's", "793", None, "4.80", "303", None,
                       None, "51.1", "2", "0.9"], segmenting.paper_rows())

    def test_of_a_sweep_worst_and_best_of_each_parameter_are_shown(self):
        results = [{"parameter": "", "object_iou": "0.9", "factor": "1"}] + [
            {"parameter": "scale", "object_iou": iou, "factor": factor}
            for iou, factor in (("0.5", "0.5"), ("0.6", "2"), ("0.4", "4"))]
        self.assertEqual(segmenting.sweep_cells(results), [["`scale`", "0.400 (4)", "0.600 (2)"]])


class Summary(unittest.TestCase):
    def test_takes_main_results_out_of_the_sections(self):
        text = summary.summary({"surface": "| room | median, mm |\n|---|---|\n| office | 0.79 |\n| loop | 4.2 |\n"})
        row, = tables.first_table(text)
        self.assertEqual(row["result"], "office: 0.79, loop: 4.2")

    def test_of_the_maps_shows_mode_exact_beside_the_paper(self):
        text = summary.summary({"maps": tables.markdown(
            ["map", "mode", "average, ms"],
            [["loop", "exact", 10], ["loop", "batch", 80], ["paper: Loop", "the paper's", 303]])})
        row, = tables.first_table(text)
        self.assertEqual(row["result"], "loop: 10, paper: Loop: 303")

    def test_leaves_out_what_was_not_measured(self):
        self.assertEqual(summary.summary({"surface": "(not measured yet)\n"}), "(not measured yet)\n")


if __name__ == "__main__":
    unittest.main()
