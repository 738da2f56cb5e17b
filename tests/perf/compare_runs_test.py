# SPDX-FileCopyrightText: 2026 The viewgain authors
# SPDX-License-Identifier: Apache-2.0
"""perf/compare_runs.py, given as the one argument, on results made by hand."""
import json
import pathlib
import subprocess
import sys
import tempfile
import unittest

PROGRAM = sys.argv.pop()


def compared(base, head):
    """Prints of the program for the runs of both sides: {first word of a line: its other words}."""
    with tempfile.TemporaryDirectory() as folder:
        for side, runs in (("base", base), ("head", head)):
            for i, run in enumerate(runs):
                (pathlib.Path(folder) / f"{side}.{i}.json").write_text(json.dumps(run))
        done = subprocess.run([sys.executable, PROGRAM, folder], capture_output=True, text=True, check=True)
    lines = [line.split() for line in done.stdout.splitlines()]
    return {words[0]: words[1:] for words in lines}


def bars(**values):
    return [{"name": n, "value": v, "better": "lower" if n.endswith("_ms") else "higher"} for n, v in values.items()]


class CompareRuns(unittest.TestCase):
    def test_direction_medians_and_spread(self):
        # Eleven runs: run 10 sorts behind run 9 only if its number is read as a number.
        base = [bars(speed=2.0, build_ms=4.0) for _ in range(11)]
        head = [bars(speed=3.0, build_ms=2.0) for _ in range(10)] + [bars(speed=1.0, build_ms=8.0)]
        rows = compared(base, head)
        self.assertEqual(rows["medians"][1], "11")
        self.assertEqual(rows["speed"], ["higher", "2", "3", "1.500", "1.000", "1.500"])
        self.assertEqual(rows["build_ms"], ["lower", "4", "2", "2.000", "1.250", "2.000"])

    def test_each_run_is_compared_with_its_neighbour_in_time(self):
        rows = compared([bars(speed=v) for v in (1.0, 2.0, 4.0)], [bars(speed=v) for v in (2.0, 4.0, 8.0)])
        self.assertEqual(rows["speed"][3:], ["2.000", "2.000", "2.000"])

    def test_what_is_worse_is_marked(self):
        rows = compared([bars(speed=1.0, build_ms=1.0, other=1.0)], [bars(speed=0.94, build_ms=1.06, other=0.96)])
        self.assertEqual(rows["speed"][-2:], ["under", "0.95"])
        self.assertEqual(rows["build_ms"][-2:], ["under", "0.95"])
        self.assertEqual(rows["other"][-1], "0.960")

    def test_figures_of_one_side_are_listed(self):
        rows = compared([bars(speed=1.0, gone=1.0)], [bars(speed=1.0, new=1.0)])
        self.assertEqual(rows["gone"], ["only", "in", "base"])
        self.assertEqual(rows["new"], ["only", "in", "head"])
        self.assertEqual(len(rows), 5)

    def test_rates_of_trace(self):
        def trace(rate):
            return {"methods": [{"name": "viewgain_gain", "rays_per_second": rate}]}

        rows = compared([trace(1e8)], [trace(1.5e8)])
        self.assertEqual(rows["viewgain_gain"], ["higher", "100", "150", "1.500", "1.500", "1.500"])


if __name__ == "__main__":
    unittest.main()
