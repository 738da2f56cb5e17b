#!/usr/bin/python3
# SPDX-FileCopyrightText: 2026 The viewgain authors
# SPDX-License-Identifier: Apache-2.0
"""Puts many frames of an object into one map, from the same 100 poses again and again, brings scene and evaluator up
to date after each and scores four views, and looks for what grows when there is nothing left to see.

    PYTHONPATH=build/release/python tests/long_run.py [--views 2000] [--voxels 512] [--csv FILE] [--plot FILE.png]

Writes the memory [MB] and CPU time [s] of every view into FILE, and draws them. Ends with 1 where,
from the second quarter to the last, memory grows by more than 4 kB a view, or a view takes half as much CPU time again.
"""
import argparse
import csv
import sys
import time

import numpy as np
import viewgain

SIZE = 0.35  # of the workspace [m]
POSES = 100
MOST_GROWTH = 4096  # a view [bytes]


def rays_of(camera):
    u, v = np.meshgrid(np.arange(camera.width), np.arange(camera.height))
    return np.stack([(u - camera.cx) / camera.fx, (v - camera.cy) / camera.fy, np.ones(u.shape)], axis=-1)


def depth_of(rays, T_world_camera):
    """Three spheres in a room that is a sphere, too."""
    directions = rays @ T_world_camera[:3, :3].T
    nearest = np.full(rays.shape[:2], np.inf)
    for center, radius in (((0, 0, 0), 0.12), ((0.1, 0.05, 0), 0.06), ((-0.08, 0, 0.1), 0.05), ((0, 0, 0), 1.5)):
        away = T_world_camera[:3, 3] - np.asarray(center)
        a, b = (directions**2).sum(-1), directions @ away
        root = np.sqrt(np.maximum(b**2 - a * (away @ away - radius**2), 0))
        met = b**2 > a * (away @ away - radius**2)
        t = np.where(radius < 1, (-b - root) / a, (-b + root) / a)
        nearest = np.where(met & (t > 0), np.minimum(nearest, t), nearest)
    return nearest.astype(np.float32)


def resident():
    with open("/proc/self/statm", encoding="ascii") as file:
        return int(file.read().split()[1]) * 4096


def draw(file, rows, voxels):
    import matplotlib

    matplotlib.use("Agg")
    from matplotlib import pyplot

    table = np.array(rows)
    figure, (memory, seconds) = pyplot.subplots(2, sharex=True, figsize=(7, 4), layout="constrained")
    memory.plot(table[:, 0], table[:, 1] / 1e6, linewidth=0.8)
    memory.set(ylabel="resident [MB]", ylim=(0, None), title=f"{voxels}³ voxels, the same {POSES} poses again and again")
    seconds.plot(table[:, 0], table[:, 2], ".", markersize=1)
    seconds.set(ylabel="CPU time a view [s]", ylim=(0, None), xlabel="view")
    figure.savefig(file, dpi=110)


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--views", type=int, default=2000)
    parser.add_argument("--voxels", type=int, default=512)
    parser.add_argument("--csv", default="")
    parser.add_argument("--plot", default="")
    options = parser.parse_args()
    sensor = viewgain.sensor_preset("sr4000")
    half = SIZE / 2
    grid = viewgain.BeliefGrid(voxel_size=SIZE / options.voxels, workspace=[[-half] * 3, [half] * 3], sensor=sensor)
    integrator = viewgain.FrameIntegrator(sensor)
    scene = viewgain.VoxelScene(grid)
    evaluator = viewgain.GainEvaluator(scene, sensor)
    rays = rays_of(sensor.camera)
    poses = viewgain.sphere_poses(POSES, 0.6)
    frames = [depth_of(rays, pose) for pose in poses]
    rows = []
    for i in range(options.views):
        begin = time.process_time()
        integrator.integrate(grid, frames[i % POSES], poses[i % POSES])
        scene = scene.update(grid)
        evaluator = evaluator.with_scene(scene)
        evaluator.evaluate(poses[:4])
        rows.append((i, resident(), time.process_time() - begin))
    if options.csv:
        with open(options.csv, "w", newline="", encoding="utf-8") as file:
            writer = csv.writer(file)
            writer.writerow(("view", "resident_mb", "seconds"))
            writer.writerows((i, f"{memory / 1e6:.3f}", f"{seconds:.4f}") for i, memory, seconds in rows)
    if options.plot:
        draw(options.plot, rows, options.voxels)
    table = np.array(rows)
    second, last = (table[options.views * k // 4:options.views * (k + 1) // 4] for k in (1, 3))
    # Scenes come and go, by 10 MB either way.
    growth = (last[:, 1].mean() - second[:, 1].mean()) / (options.views / 2)
    seconds, before = np.median(last[:, 2]), np.median(second[:, 2])
    print(f"long: {options.views} views of {options.voxels}^3 voxels, {last[:, 1].max() / 1e6:.0f} MB, {growth:+.0f} bytes "
          f"and {seconds:.3f} s of CPU time a view, {seconds / before:.2f} of the second quarter's")
    return 1 if growth > MOST_GROWTH or seconds > 1.5 * before else 0


if __name__ == "__main__":
    sys.exit(main())
