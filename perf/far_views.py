#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The viewgain authors
# SPDX-License-Identifier: Apache-2.0
"""Compares expected with measured new surface, per range.

    far_views.py SENSOR SCENE RUN

Results are in perf/results/prediction.md, "Far views".

SCENE is a folder from scenes.py. RUN is a folder from `viewgain reconstruct --save-maps on` of that
scene. After each of the first views, the candidates from boundaries and shells within reach are
sorted by the mean range of the surface that they are expected to show. They are split into thirds.
In each third, some candidates of the better half are simulated. Columns:

- mean range
- expected new surface
- measured surface in formerly unknown voxels, divided by the expected new surface
- area of the mesh that points newly cover, divided by the expected new surface
- share of the uncovered mesh in view that is covered afterwards
"""
import argparse
import json
import pathlib
import subprocess

import numpy as np
import scipy.spatial

import meshes
import viewgain

SAMPLES = 30_000
TOLERANCE = 0.005  # [m]


def samples_of(vertices, triangles, rng):
    """Uniform points on the triangles, and the total area [m^2]."""
    a, b, c = (vertices[triangles[:, k]] for k in range(3))
    areas = .5 * np.linalg.norm(np.cross(b - a, c - a), axis=1)
    i = rng.choice(len(triangles), SAMPLES, p=areas / areas.sum())
    u, v = np.sqrt(rng.random((1, SAMPLES, 1))), rng.random((1, SAMPLES, 1))
    return ((1 - u) * a[i] + u * (1 - v) * b[i] + u * v * c[i])[0], areas.sum()


def covered(grid, samples):
    points = grid.points()["position"]
    return scipy.spatial.cKDTree(points).query(samples, distance_upper_bound=TOLERANCE)[0] <= TOLERANCE


def seen(depth, sensor, pose, samples):
    """Which samples a frame without noise shows: within 4 mm + 1 % of its depth."""
    camera, p = sensor.camera, (samples - pose[:3, 3]) @ pose[:3, :3]
    before = p[:, 2] > .05
    z = np.where(before, p[:, 2], 1)
    u = np.rint(camera.fx * p[:, 0] / z + camera.cx).astype(int)
    v = np.rint(camera.fy * p[:, 1] / z + camera.cy).astype(int)
    ranges = np.linalg.norm(p, axis=1)
    inside = before & (u >= 0) & (u < camera.width) & (v >= 0) & (v < camera.height)
    inside &= (ranges >= sensor.min_range) & (ranges <= sensor.max_range)
    read = np.zeros(len(samples))
    read[inside] = depth[v[inside], u[inside]]
    return inside & (np.abs(read - z) < .004 + .01 * z)


def candidates_after(map_file, scene, sensor, count, rng):
    """Mean range [m] and area [m^2] of promised surface, and pose, of some candidates, nearest first."""
    call = ["viewgain", "next", map_file, "--generator", "boundary,shell", "--count", "150", "--gain", "paper", "--top", "all",
            "--reach", scene / "reach.toml", "--json"]
    views = json.loads(subprocess.run(call, check=True, capture_output=True, text=True).stdout)["next"]
    grid = viewgain.BeliefGrid.load(map_file)
    evaluator = viewgain.GainEvaluator(viewgain.VoxelScene(grid), sensor, gain="surface")
    found = []
    for generator in "boundary", "shell":
        poses = np.array([view["T_world_camera"] for view in views if view["generator"] == generator])
        for pose in rng.permutation(poses)[:count]:
            parts = evaluator.contributions(pose)
            if parts["gain"].sum() > 0:
                ranges = np.linalg.norm(grid.center(parts["voxel"]) - pose[:3, 3], axis=1)
                found.append((np.average(ranges, weights=parts["gain"]), evaluator.evaluate(pose), pose))
    return sorted(found, key=lambda view: view[0])


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("sensor", help="sensor preset: " + ", ".join(viewgain.sensor_preset_names()))
    parser.add_argument("scene", type=pathlib.Path, help="folder from scenes.py")
    parser.add_argument("run", type=pathlib.Path, help="folder from reconstruct")
    parser.add_argument("--views", type=int, default=5, help="number of first views (default: 5)")
    parser.add_argument("--each", type=int, default=6, help="candidates to simulate per third (default: 6)")
    options = parser.parse_args()
    sensor, rng = viewgain.sensor_preset(options.sensor), np.random.default_rng(1)
    vertices, triangles = (np.asarray(part) for part in meshes.read_mesh(options.scene / "scene.off"))
    vertices = vertices.astype(float)
    vertices -= (vertices.min(axis=0) + vertices.max(axis=0)) / 2  # reconstruct puts the origin here
    samples, area = samples_of(vertices, triangles, rng)
    camera = viewgain.SimulatedSensor(vertices, triangles, sensor, seed=99)
    clean = viewgain.SimulatedSensor(vertices, triangles, sensor, noise=False, lateral_noise=False, sub_rays=1)
    print("| after | range [m] | promised [cm2] | readings | covered | of what is seen |\n|---|---|---|---|---|---|")
    for number in range(options.views):
        map_file = options.run / "maps" / f"{number:02d}.vdb"
        grid = viewgain.BeliefGrid.load(map_file)
        before = covered(grid, samples)
        found = candidates_after(map_file, options.scene, sensor, 36, rng)
        for third in np.array_split(np.arange(len(found)), 3):
            better = sorted(third, key=lambda i: -found[i][1])[:max(options.each, len(third) // 2)]
            rows = []
            for i in rng.permutation(better)[:options.each]:
                distance, promised, pose = found[i]
                scorer = viewgain.ViewScorer(sensor, map=grid, gain="surface")
                update = scorer.add(camera.acquire(pose, 1000 + number).depth, pose)
                after = covered(scorer.grid, samples) & ~before
                shown = seen(clean.acquire(pose, 0).depth, sensor, pose, samples) & ~before
                rows.append((distance, promised, update.new_area, area * after.mean(), area * shown.mean(), area * (shown & after).mean()))
            distance, promised, readings, fresh, shown, both = np.sum(rows, axis=0)
            print(f"| {number + 1} | {distance / len(rows):.2f} | {1e4 * promised / len(rows):.0f} | {readings / promised:.2f} "
                  f"| {fresh / promised:.2f} | {both / shown:.2f} |", flush=True)


if __name__ == "__main__":
    main()
