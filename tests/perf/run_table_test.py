# SPDX-FileCopyrightText: 2026 The viewgain authors
# SPDX-License-Identifier: Apache-2.0
"""perf/run_table.py, given as the one argument, on figures made by hand."""
import json
import pathlib
import subprocess
import sys
import tempfile
import unittest

PROGRAM = sys.argv.pop()
HEAD = {"cpu": "a CPU", "threads": 2, "isa": "avx2", "compiler": "GNU 12", "versions": {"embree": "3.13", "cgal": ""},
        "commit": "abc", "agree": True}
RATES = {"viewgain_gain": 60e6, "viewgain_combined": 24e6, "viewgain_trace": 120e6, "embree_quads": 15e6, "dense_dda": 40e6, "octomap_gain": 2e5}


def trace(size, **changes):
    methods = [{"name": name, "rays_per_second": rate} for name, rate in RATES.items()]
    return {**HEAD, "scene": f"camel-{size}", "methods": methods, **changes}


def files(**changes):
    stages = {"integrate": 1, "scene": 1, "paper 500": 48, "octomap_integrate": 500, "octomap_gain_of_a_view": 99,
              "surface_frontier_count 500": 90, "combined 500 two stages": 30}
    bars = [{"name": "update_over_build", "value": 0.2, "bar": 0.35, "better": "lower", "pass": True},
            {"name": "wall_over_free", "value": 0.7, "bar": 0.8, "better": "higher", "pass": False},
            {"name": "thread_scaling", "value": 1.95, "bar": 1.9, "better": "higher", "pass": False, "note": "answers differ"},
            {"name": "decision_ms_500", "value": 50, "bar": None, "better": "lower", "pass": None}]
    made = {"trace": trace(128), "trace_256": trace(256), "trace_512": trace(512),
            "integrate": {"agree": True, "milliseconds": {"octomap": {"median": 300}, "viewgain_cones": {"median": 1.5}}},
            "decision": [{"milliseconds": {name: {"median": ms} for name, ms in stages.items()}}], "bars": bars}
    return {**made, **changes}


def printed(made):
    """The exit code, the first line, and the rows by their first two cells."""
    with tempfile.TemporaryDirectory() as folder:
        for name, value in made.items():
            (pathlib.Path(folder) / f"{name}.json").write_text(json.dumps(value))
        done = subprocess.run([sys.executable, PROGRAM, folder], capture_output=True, text=True, check=False)
    lines = done.stdout.splitlines()
    rows = [[cell.strip() for cell in line.split("|")[1:-1]] for line in lines if line.startswith("| ")]
    assert all(len(row) == 7 for row in rows), rows
    return done.returncode, lines, {tuple(row[:2]): row[2:] for row in rows[1:]}


class RunTable(unittest.TestCase):
    def test_rivals_of_this_machine(self):
        code, lines, rows = printed(files())
        self.assertEqual(code, 0)
        self.assertEqual(lines[0], "a CPU, 2 threads, avx2; GNU 12; embree 3.13; viewgain abc")
        gain = "gain `paper` of a view, 128³ [million rays/s]"
        self.assertEqual(rows[gain, "Embree, a quad per voxel face, tracing alone"], ["15.0", "60.0", "4.00 ×", "≥ 3", "met"])
        octomap = rows[gain, "OctoMap, entropy gain"]
        self.assertEqual(octomap[2:4], ["300 ×", "≥ 1,000"])
        self.assertTrue(octomap[4].startswith("**missed**: "))
        self.assertEqual(rows["a frame into the map [ms]", "OctoMap, one thread"], ["300", "1.50", "200 ×", "≥ 100", "met"])
        self.assertEqual(rows["a frame to the best of 500 views by `paper` [ms]", "OctoMap, entropy gain, one thread"],
                         ["50,000", "50.0", "1,000 ×", "", ""])
        self.assertEqual(rows["the best of 500 views by `race` with `combined` [ms]", "`surface_frontier_count`, ours"][:3],
                         ["90.0", "30.0", "3.00 ×"])
        self.assertEqual(rows["first voxel of each ray, 256³ [million rays/s]", "dense DDA, ours"][2:], ["3.00 ×", "≥ 1.35", "met"])
        self.assertEqual(rows["first voxel of each ray, 512³ [million rays/s]", "dense DDA, ours"][3:], ["≥ 1.2", "met"])

    def test_the_default_gain_by_size(self):
        _, _, rows = printed(files())
        bars = {size: rows[f"gain `combined` of a view, {size}³ [million rays/s]", "Embree, a quad per voxel face, tracing alone"][2:]
                for size in (128, 256, 512)}
        missed = "**missed**: rays go far through unknown space"
        self.assertEqual(bars, {128: ["1.60 ×", "≥ 1.45", "met"], 256: ["1.60 ×", "≥ 2", missed], 512: ["1.60 ×", "≥ 1.3", "met"]})

    def test_misses_are_rows_with_a_reason(self):
        _, _, rows = printed(files())
        self.assertEqual(rows["scene update / build, 512³ [time]", ""][1:], ["0.20", "", "≤ 0.35", "met"])
        wall = rows["with / without a wall of 100 boxes [speed]", ""]
        self.assertEqual(wall[4], "**missed**: obstacles are traced in packets as wide as the instruction set")
        self.assertEqual(rows["2 threads / 1, 200 poses [speed]", ""][4], "**missed**: answers differ")
        self.assertEqual(rows["frame to best of 500 by `paper` [ms]", ""][1:], ["50.0", "", "", ""])

    def test_wrong_answers_fail(self):
        code, lines, _ = printed(files(trace_256=trace(256, agree=False)))
        self.assertEqual(code, 1)
        self.assertIn("trace_256", lines[-1])


if __name__ == "__main__":
    unittest.main()
