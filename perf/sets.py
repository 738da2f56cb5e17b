#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The viewgain authors
# SPDX-License-Identifier: Apache-2.0
"""How good are sets of views? Prints Markdown.

    sets.py MESH... [--maps 200]

Each object of 0.35 m is modelled with a simulated SR4000 with all noise and voxels of 5 mm. Views
are chosen by the gain "combined" among 200 poses on a sphere of 0.6 m. After 1, 2, 4 and 8 views,
sets of these poses are chosen on the map.

First table: `best_set` of 2, 3 and 4 of 14 random poses, compared with the best of all their
subsets, on every eighth pixel and row.

Second table: `best_set` of 3 of the 200 poses, compared with the three best single views.

- Seen: surface that the views truly see and that no earlier view has seen (visibility.py).
- Modelled: surface within 5 mm of a point of the map after the frames of these views were added.
- Realised / promised: newly seen surface divided by the set's gain "surface".

Needs PYTHONPATH=build/release/python.
"""
import argparse
import itertools
import pathlib

import numpy as np
import viewgain
from scipy.spatial import cKDTree

import meshes
import visibility

SIZE, DISTANCE, VOXEL, POSES = 0.35, 0.6, 0.005, 200
VIEWS, FEW, SAMPLES, NEAR = (1, 2, 4, 8), 14, 4000, 0.005


def value(evaluator, poses):
    """The set gain of these views."""
    chosen = evaluator.best_set(poses, len(poses))
    return float(chosen.gains["gain"].sum())


def share_of_best(evaluator, poses, k):
    """Gain of the greedy set over that of the best subset of k views; nan if no subset has a gain."""
    best = max(value(evaluator, poses[list(subset)]) for subset in itertools.combinations(range(len(poses)), k))
    greedy = evaluator.best_set(poses, k).gains["gain"].sum()
    return float(greedy) / best if best > 0 else np.nan


class Model:
    """A map that grows view by view, and what of the object is seen and modelled."""

    def __init__(self, mesh, sensor, seed):
        self.truth = visibility.KnownObject(*mesh, sensor, SAMPLES)
        self.sensor = sensor
        self.camera = viewgain.SimulatedSensor(*mesh, sensor, noise=True, lateral_noise=True, sub_rays=3, background_radius=1.5, seed=seed)
        half = SIZE / 2 + 0.03
        self.workspace = [[-half] * 3, [half] * 3]
        self.frames = []
        self.seen = np.zeros(SAMPLES, bool)
        self.planner = self.empty()

    def empty(self):
        return viewgain.ViewPlanner(self.sensor, voxel_size=VOXEL, workspace=self.workspace)

    def frame(self, pose, number):
        taken = self.camera.acquire(pose, number)
        return taken.depth, pose, taken.amplitude

    def add(self, pose):
        self.frames.append(self.frame(pose, len(self.frames)))
        depth, pose, amplitude = self.frames[-1]
        self.planner.add(depth, pose, amplitude=amplitude)
        self.seen |= self.truth.sees(pose)

    def covered_after(self, poses):
        """Share of the samples with a point near by, if these views were added."""
        planner = self.empty()
        for depth, pose, amplitude in self.frames + [self.frame(pose, 100 + k) for k, pose in enumerate(poses)]:
            planner.add(depth, pose, amplitude=amplitude)
        near = cKDTree(planner.grid.points()["position"]).query(self.truth.points, distance_upper_bound=NEAR)[0]
        return float((near < NEAR).mean())

    def newly_seen(self, poses):
        """Surface that these views see and no view before [m²]."""
        together = np.any([self.truth.sees(pose) for pose in poses], axis=0)
        return float((together & ~self.seen).mean()) * self.truth.area


def print_tables(choice, rows):
    print("\n| k of 14 | maps | minimum share of the best subset's gain | mean | exactly the best |", "|---|---|---|---|---|", sep="\n")
    for k, shares in choice.items():
        known = np.array(shares)[~np.isnan(shares)]
        print(f"| {k} | {len(known)} | {100 * known.min():.2f} % | {100 * known.mean():.2f} % | {100 * (known > 1 - 1e-6).mean():.0f} % |")
    print("\n| views | maps | realised / promised, mean | median | not worse than three singles, seen | better, seen | seen, set / singles"
          " | not worse, modelled | better, modelled |", "|---|---|---|---|---|---|---|---|---|", sep="\n")
    for name, part in [(str(v), rows[rows[:, 0] == v]) for v in VIEWS] + [("all", rows)]:
        if len(part) == 0:
            continue
        _, seen, of_singles, promised, covered, covered_by_singles = part.T
        ratio = seen / promised
        print(f"| {name} | {len(part)} | {ratio.mean():.2f} | {np.median(ratio):.2f} | {100 * (seen >= of_singles).mean():.0f} % |"
              f" {100 * (seen > of_singles).mean():.0f} % | {seen.sum() / of_singles.sum():.2f} |"
              f" {100 * (covered >= covered_by_singles).mean():.0f} % | {100 * (covered > covered_by_singles).mean():.0f} % |")


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("meshes", nargs="+", type=pathlib.Path, metavar="MESH", help="mesh files")
    parser.add_argument("--maps", type=int, default=200, help="number of maps (default: 200)")
    arguments = parser.parse_args()
    sensor = viewgain.sensor_preset("sr4000")
    around = viewgain.sphere_poses(POSES, DISTANCE)
    choice = {k: [] for k in (2, 3, 4)}
    rows = []
    jobs = ((seed, path) for seed in itertools.count(1) for path in arguments.meshes)
    while len(rows) < arguments.maps:
        seed, path = next(jobs)
        vertices, triangles = meshes.read_mesh(path)
        model = Model((meshes.scaled(vertices, SIZE), triangles), sensor, seed)
        random = np.random.default_rng(seed)
        left = list(range(POSES))
        first = left.pop(random.integers(len(left)))
        model.add(around[first])
        for views in range(1, max(VIEWS) + 1):
            scene = viewgain.VoxelScene(model.planner.grid)
            coarse = viewgain.GainEvaluator(scene, sensor, pixel_stride=8)
            if views in VIEWS and len(rows) < arguments.maps:
                few = around[random.choice(left, FEW, replace=False)]
                for k, shares in choice.items():
                    shares.append(share_of_best(coarse, few, k))
                poses = around[left]
                evaluator = viewgain.GainEvaluator(scene, sensor)
                by_surface = viewgain.GainEvaluator(scene, sensor, gain="surface")
                together = poses[evaluator.best_set(poses, 3).indices]
                singles = poses[evaluator.best(poses, 3).indices]
                rows.append((views, model.newly_seen(together), model.newly_seen(singles), value(by_surface, together),
                             model.covered_after(together), model.covered_after(singles)))
                print(f"map {len(rows)}: {path.stem}, seed {seed}, {views} views", flush=True)
            model.add(around[left.pop(int(coarse.best(around[left], 1).indices[0]))])
    print_tables(choice, np.array(rows))


if __name__ == "__main__":
    main()
