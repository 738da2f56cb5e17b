#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The viewgain authors
# SPDX-License-Identifier: Apache-2.0
"""What do calls of ViewScorer cost? Prints a table.

    scorer_costs.py [REPETITIONS]

The maps have 1e4, 1e6 and 1e7 voxels of labels: a ball with unknown voxels inside and free space
around it; half of the workspace is unknown. Cameras have 25,344 and 307,200 rays. Figures are
medians [ms] on all threads. Needs PYTHONPATH=build/release/python.
"""
import statistics
import sys
import time

import numpy as np
import viewgain

EDGES = 22, 100, 216        # voxels along a side
SENSORS = "sr4000", "kinect_v1"
SIDE = 0.5                  # side of the workspace [m]
POSES = viewgain.sphere_poses(200, 1.0)


def labels_of(edge):
    """Labels of a ball of half the side. All voxels behind x = 0 are unknown."""
    axis = (np.arange(edge) + 0.5) / edge - 0.5
    x, y, z = np.meshgrid(axis, axis, axis, indexing="ij", sparse=True)
    radius = np.sqrt(x**2 + y**2 + z**2)
    shell = np.abs(radius - 0.25) < 1.0 / edge
    labels = np.where(shell, 2, np.where(radius < 0.25, 0, 1)).astype(np.uint8)
    labels[np.broadcast_to(x < 0, labels.shape)] = 0
    return labels


def median_ms(call, repetitions, prepare=lambda: None):
    """Median time of call(prepare()) [ms]. prepare() is not timed."""
    seconds = []
    for repetition in range(repetitions + 1):  # the first one warms up
        prepared = prepare()
        begin = time.perf_counter()
        call(prepared)
        if repetition:
            seconds.append(time.perf_counter() - begin)
    return 1e3 * statistics.median(seconds)


def rows(edge, repetitions):
    labels = labels_of(edge)
    lowest = (-(edge // 2),) * 3
    for name in SENSORS:
        sensor = viewgain.sensor_preset(name)
        settings = dict(voxel_size=SIDE / edge, workspace=[[-SIDE / 2] * 3, [SIDE / 2] * 3])
        scorer = viewgain.ViewScorer(sensor, **settings)
        whole = median_ms(lambda new: new.set(lowest, labels), repetitions, lambda: viewgain.ViewScorer(sensor, **settings))
        scorer.set(lowest, labels)
        small = min(16, edge)
        part = labels[:small, :small, :small]
        flip = iter(range(1 << 30))
        change = lambda _=None: scorer.set(lowest, np.full_like(part, 1 + next(flip) % 2))
        box = median_ms(change, repetitions)
        scene = median_ms(lambda _: scorer.scene, repetitions, change)
        evaluator = median_ms(lambda _: scorer.evaluator, repetitions, change)
        scorer.set(lowest, labels)
        depth = scorer.evaluator.depth(POSES[0])
        frame = median_ms(lambda _: scorer.add(np.where(np.isfinite(depth), depth, 0), POSES[0]), repetitions)
        one = median_ms(lambda _: scorer.evaluate(POSES[:20]), repetitions) / 20
        best = median_ms(lambda _: scorer.best(POSES), repetitions) / len(POSES)
        yield [f"{edge**3:.0e}".replace("e+0", "e"), f"{sensor.camera.width * sensor.camera.height:,}", whole, box, scene, evaluator, frame, one, best]


def main():
    repetitions = int(sys.argv[1]) if len(sys.argv) > 1 else 7
    print("| voxels | rays | `set` all | `set` 16³ | then `scene` | or `evaluator` | `add` | `evaluate`, per pose | `best` of 200, per pose |")
    print("|---|---|---|---|---|---|---|---|---|")
    for edge in EDGES:
        for row in rows(edge, repetitions):
            print("| " + " | ".join(value if isinstance(value, str) else f"{value:.3g}" for value in row) + " |", flush=True)


if __name__ == "__main__":
    main()
