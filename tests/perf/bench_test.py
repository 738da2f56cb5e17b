#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The viewgain authors
# SPDX-License-Identifier: Apache-2.0
"""Each subcommand of viewgain-bench runs at a tiny size, prints JSON and says in its exit code what
its bars say; ways to do the same agree. bench_test.py VIEWGAIN_BENCH VIEWGAIN_MICRO PEERS_FOLDER"""
import json
import pathlib
import subprocess
import sys
import tempfile

BOX = "OFF\n8 12 0\n" + "".join(f"{x} {y} {z}\n" for z in (-10, 10) for y in (-12, 12) for x in (-15, 15)) + "".join(
    f"3 {a} {b} {c}\n3 {a} {c} {d}\n" for a, b, c, d in
    [(0, 2, 3, 1), (4, 5, 7, 6), (0, 1, 5, 4), (2, 6, 7, 3), (0, 4, 6, 2), (1, 3, 7, 5)])
CALLS = ["trace --json --voxels 37 --poses 2 --repetitions 1", "integrate --json --voxels 64 --repetitions 1",
         "decision --json --maps camel-48,hall --candidates 8 --repetitions 1",
         "scaling --json --voxels 16,24 --poses 4 --repetitions 1", "hall --json --voxel 0.2 --frames 12 --poses 4",
         "approximate --json --voxels 48 --poses 40 --repetitions 1", "choose --json --poses 60 --subsets 2 --seed 3",
         "bars --json --voxels 32 --large-voxels 48 --poses 8 --repetitions 1 --maps 2 --candidates 8", "environment",
         "memory --voxels 64 --views 2", "armadillo --json --views 5 --stride 16 --data data",
         "hemisphere --json --size 0.03 --first-views 2 --budget 5 --gain random --mesh box.off",
         "frames --json --seeds 1 --views 3 --candidates 12 --voxel 0.02 --degrees 0,40 --mesh box.off"]


def values_of(key, value):
    """All that stands under this key, at any depth."""
    if isinstance(value, list):
        return [found for entry in value for found in values_of(key, entry)]
    if not isinstance(value, dict):
        return []
    return [found for name, entry in value.items() for found in ([entry] if name == key else values_of(key, entry))]


def main():
    bench, micro, peers = sys.argv[1:]
    with tempfile.TemporaryDirectory() as folder:
        pathlib.Path(folder, "box.off").write_text(BOX, encoding="utf-8")
        stand_in = [sys.executable, f"{peers}/make_stand_in.py", "box.off", "data", "--points", "4000", "--views", "30"]
        subprocess.run(stand_in, cwd=folder, check=True)
        for call in CALLS:
            done = subprocess.run([bench, *call.split(), "--threads", "2"], cwd=folder, capture_output=True, text=True)
            said = json.loads(done.stdout)
            assert done.returncode == (1 if False in values_of("pass", said) else 0), f"{call}: {done.returncode} {done.stderr}"
            assert all(values_of("agree", said)), f"{call}: its ways do not agree: {done.stdout}"
            if call.startswith("trace"):  # a competitor's wrong ray is a figure, and no failure of ours
                ours = [wrong for name, wrong in said["wrong"].items() if name.startswith("viewgain_")]
                assert len(ours) > 3 and sum(ours) == 0
        for wrong in ("", "trace --poses 0", "bars --only nothing", "armadillo --data none", "trace --mesh none.off"):
            assert subprocess.run([bench, *wrong.split()], cwd=folder, capture_output=True).returncode == 2, wrong
    parts = subprocess.run([micro, "--benchmark_min_time=0.0001", "--benchmark_format=json"], capture_output=True, check=True).stdout
    wrong = [one["name"] for one in json.loads(parts)["benchmarks"] if "error_occurred" in one]
    assert not wrong, wrong


if __name__ == "__main__":
    main()
