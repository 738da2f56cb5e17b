# SPDX-FileCopyrightText: 2026 The viewgain authors
# SPDX-License-Identifier: Apache-2.0
"""How much time does Python add to a batch?

    python_overhead.py PYTHON_GAINS [POSES [ROUNDS]]

PYTHON_GAINS is the test program python_gains. C++ and Python score the same poses on the same map,
alternately. Prints the medians over the rounds, and the time of the conversions alone.
"""
import pathlib
import statistics
import subprocess
import sys
import tempfile
import time

import numpy as np

import viewgain

program = sys.argv[1]
count = int(sys.argv[2]) if len(sys.argv) > 2 else 1000
rounds = int(sys.argv[3]) if len(sys.argv) > 3 else 9

i, j, k = np.mgrid[:64, :64, :64]
radius = np.sqrt((i - 32.0) ** 2 + (j - 32.0) ** 2 + (k - 32.0) ** 2)
labels = np.where(radius > 24, 1, np.where(radius > 22, 2, 0)).astype(np.uint8)
labels[(radius <= 24) & (j > 40)] = 0
sensor = viewgain.sensor_preset("sr4000")
grid = viewgain.BeliefGrid.from_labels(labels, voxel_size=0.005, origin=[-0.16] * 3, sensor=sensor)
poses = viewgain.sphere_poses(count, 0.6)
evaluator = viewgain.GainEvaluator(viewgain.VoxelScene(grid), sensor, gain="paper")
nowhere = viewgain.GainEvaluator(
    viewgain.VoxelScene(viewgain.BeliefGrid.from_labels(
        np.ones((1, 1, 1), np.uint8), voxel_size=0.005, sensor=sensor)),
    sensor, pixel_stride=100)

with tempfile.TemporaryDirectory() as name:
    folder = pathlib.Path(name)
    grid.save(folder / "map.vdb")
    np.ascontiguousarray(poses[:, :3]).tofile(folder / "poses")
    cpp, python, conversion = [], [], []
    for _ in range(rounds):
        run = subprocess.run([program, folder / "map.vdb", folder / "poses", folder / "gains", "5"],
                             check=True, capture_output=True, text=True)
        cpp.append(float(run.stdout))
        seconds = []
        for _ in range(5):
            begin = time.perf_counter()
            evaluator.evaluate(poses)
            seconds.append(time.perf_counter() - begin)
        python.append(statistics.median(seconds))
        begin = time.perf_counter()
        nowhere.evaluate(poses)
        conversion.append(time.perf_counter() - begin)

a, b = statistics.median(cpp), statistics.median(python)
print(f"{count} poses, {evaluator.rays_per_pose} rays each, {evaluator.num_threads} threads")
print(f"C++ {1e3 * a:.3f} ms, Python {1e3 * b:.3f} ms: {100 * (b / a - 1):+.2f} %")
print(f"the call around nothing to trace: {1e3 * statistics.median(conversion):.3f} ms, "
      f"{100 * statistics.median(conversion) / a:.2f} % of the batch")
