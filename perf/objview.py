#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The viewgain authors
# SPDX-License-Identifier: Apache-2.0
"""ObjView-Bench's protocol (arXiv 2605.10707) on your meshes. Prints Markdown.

    objview.py MESH... [--views FILE] [--observable FILE] [--starts FILE] [--as-is] [--budget 20]
               [--sectors whole,hemi,...]

The protocol:

- The object is in the unit sphere. Views are at distance 3.0 and look at its centre, with 512x512
  pixels, 45 deg and no noise.
- The next view is one of 128 Tammes directions, in the whole sphere, a half (z >= 0), a quarter
  (y >= 0, too) or an eighth (x >= 0, too).
- The observable points are those seen from 360 Tammes directions, as far as the task allows these,
  thinned to one point per 0.005. NSC is the share of observable points that have a measured point
  within 0.01, 0.02 or 0.03.
- The map is stable if three views in a row each add less than 1 % to the number of measured voxels
  of size 0.01.
- The path goes around the unit sphere.

Our choices: Tammes directions from tammes.py, 3,000 of the points, three starts (the directions
nearest to x, y and z), voxels of 1/32 as in their planner, gains on every 8th pixel and row.

The authors' files can be used instead: directions as three numbers per line, meshes as OFF or OBJ.
Use --as-is if the meshes are in the unit sphere. Needs PYTHONPATH=build/release/python and scipy.
"""
import argparse
import collections
import pathlib
import sys
import time

import numpy as np
import viewgain
from scipy.spatial import cKDTree

import covers
import meshes
import tammes

SECTORS = {"whole": [], "hemi": [2], "quarter": [2, 1], "eighth": [2, 1, 0]}  # axes that must not be negative
RADIUS, PIXELS, FUSED = 3.0, 512, 0.005
NEAR = (0.01, 0.02, 0.03)
TAU, PATIENCE = 0.01, 3
POINTS = 3000
VOXEL, STRIDE = 1 / 32, 8
POLICIES = ("combined", "paper", "count", "oracle", "random")


def sensor_of():
    focal = PIXELS / 2 / np.tan(np.radians(45 / 2))
    centre = (PIXELS - 1) / 2
    camera = viewgain.PinholeCamera(PIXELS, PIXELS, fx=focal, fy=focal, cx=centre, cy=centre)
    return viewgain.Sensor(camera, min_range=0.1, max_range=6.0, working_distance=RADIUS, noise=viewgain.ConstantNoise())


def allowed(directions, sector):
    return np.flatnonzero((directions[:, SECTORS[sector]] >= -1e-4).all(axis=1))


def way_round(a, b, radius=1.0):
    """Path length from a to b. If the sphere around the origin is in between, the path follows it."""
    line = b - a
    length = np.linalg.norm(line)
    if length == 0:
        return 0.0
    nearest = a + np.clip(-(a @ line) / length**2, 0, 1) * line
    if np.linalg.norm(nearest) >= radius:
        return float(length)
    ra, rb = np.linalg.norm(a), np.linalg.norm(b)
    arc = np.arccos(np.clip(a @ b / (ra * rb), -1, 1)) - np.arccos(radius / ra) - np.arccos(radius / rb)
    return float(np.sqrt(ra**2 - radius**2) + np.sqrt(rb**2 - radius**2) + radius * arc)


def stable_at(voxels):
    """Number of views until the map is stable, or None. `voxels`: voxels with a reading after each view."""
    calm = 0
    for k, (before, after) in enumerate(zip(voxels, voxels[1:]), 2):
        calm = calm + 1 if (after - before) / max(before, 1) < TAU else 0
        if calm == PATIENCE:
            return k
    return None


def cells_of(points, size):
    """One point per cell of a lattice, and the keys of the cells."""
    index = np.floor(points / size).astype(np.int64) + 2**20
    keys, first = np.unique(index[:, 0] << 42 | index[:, 1] << 21 | index[:, 2], return_index=True)
    return points[first], keys


class Stage:
    """An object, and what the views read of it."""

    def __init__(self, mesh, directions, observable, as_is):
        vertices, triangles = meshes.read_mesh(mesh)
        if not as_is:
            vertices = meshes.scaled(vertices, None)
            vertices = vertices / np.linalg.norm(vertices, axis=1).max()
        self.sensor = sensor_of()
        camera = self.sensor.camera
        self.rays = np.stack(np.meshgrid((np.arange(PIXELS) - camera.cx) / camera.fx, (np.arange(PIXELS) - camera.cy) / camera.fy), -1)
        self.simulated = viewgain.SimulatedSensor(vertices, triangles, self.sensor)
        self.poses = np.asarray(viewgain.look_at(RADIUS * directions, [0, 0, 0]))
        self.depths = [self.simulated.acquire(pose).depth for pose in self.poses]
        self.read = [cells_of(self.points_of(depth, pose), FUSED / 2)[0] for depth, pose in zip(self.depths, self.poses)]
        self.voxels = [cells_of(points, NEAR[0])[1] for points in self.read]
        self.observed = [cells_of(self.points_of(self.simulated.acquire(pose).depth, pose), FUSED)[0]
                         for pose in np.asarray(viewgain.look_at(RADIUS * observable, [0, 0, 0]))]

    def points_of(self, depth, T_world_camera):
        is_reading = (depth > 0) & np.isfinite(depth)
        z = depth[is_reading][:, None].astype(float)
        return np.hstack([self.rays[is_reading] * z, z]) @ T_world_camera[:3, :3].T + T_world_camera[:3, 3]

    def covered(self, views, observable):
        """By [threshold, view, observable point]: does the view have a reading within the threshold?"""
        points = cells_of(np.concatenate([self.observed[i] for i in observable]), FUSED)[0]
        points = points[np.random.default_rng(1).permutation(len(points))[:POINTS]]
        distance = np.array([cKDTree(self.read[i]).query(points, distance_upper_bound=NEAR[-1])[0] for i in views])
        return np.array([distance < near for near in NEAR])


class MapChoice:
    """The view with the largest gain in a map of the frames so far."""

    def __init__(self, stage, policy):
        self.stage, self.policy = stage, policy
        self.grid = viewgain.BeliefGrid(voxel_size=VOXEL, workspace=[[-1] * 3, [1] * 3], sensor=stage.sensor)
        self.integrator = viewgain.FrameIntegrator(stage.sensor)
        self.scene = None

    def next(self, taken, candidates):
        frame, pose = self.stage.depths[taken[-1]], self.stage.poses[taken[-1]]
        if self.scene is not None:
            self.integrator.calibrate_hazard(self.grid, self.scene, frame, pose)
        self.integrator.integrate(self.grid, frame, pose)
        self.scene = viewgain.VoxelScene(self.grid)
        gain = "paper" if self.policy == "count" else self.policy
        evaluator = viewgain.GainEvaluator(self.scene, self.stage.sensor, gain=gain, pixel_stride=STRIDE)
        values = evaluator.evaluate_detailed(self.stage.poses[candidates])
        return candidates[int(np.argmax(values["unknown_voxels" if self.policy == "count" else "gain"]))]


class OracleChoice:
    """The view that adds most to NSC at 0.01."""

    def __init__(self, views, covered):
        self.at, self.covered = {view: i for i, view in enumerate(views)}, covered

    def next(self, taken, candidates):
        left = ~self.covered[[self.at[view] for view in taken]].any(axis=0)
        return candidates[int(np.argmax([self.covered[self.at[view]][left].sum() for view in candidates]))]


class RandomChoice:
    def __init__(self, seed):
        self.random = np.random.default_rng(seed)

    def next(self, taken, candidates):
        return int(self.random.choice(candidates))


def episode(choice, views, start, budget):
    """The views in their order, and the mean time per choice [s]."""
    taken, seconds = [int(start)], []
    while len(taken) < min(budget, len(views)):
        begin = time.perf_counter()
        taken.append(int(choice.next(taken, [int(view) for view in views if view not in taken])))
        seconds.append(time.perf_counter() - begin)
    return taken, float(np.mean(seconds)) if seconds else 0.0


def figures_of(stage, views, covered, taken, seconds, checkpoints):
    """NSC at checkpoints [%], views until the stop, NSC there [%], path length, time per choice [s].

    Without a stop, the budget counts.
    """
    rows = [int(np.flatnonzero(views == view)[0]) for view in taken]
    nsc = lambda k, near=0: 100 * covered[near][rows[:k]].any(axis=0).mean()
    keys, counts = np.empty(0, np.int64), []
    for view in taken:
        keys = np.union1d(keys, stage.voxels[view])
        counts.append(len(keys))
    stop = stable_at(counts) or len(taken)
    eyes = stage.poses[taken, :3, 3]
    way = sum(way_round(a, b) for a, b in zip(eyes[:stop], eyes[1:stop]))
    return [*(nsc(k) for k in checkpoints), stop, *(nsc(stop, near) for near in range(len(NEAR))), way, seconds]


def directions_of(path, count):
    if path is None:
        return tammes.tammes(count)
    try:
        directions = np.loadtxt(path, ndmin=2).reshape(-1, 3)
    except (OSError, ValueError) as error:
        sys.exit(f"{path}: expected three numbers per line: {error}")
    return directions / np.linalg.norm(directions, axis=1)[:, None]


def parse_arguments():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("meshes", nargs="+", type=pathlib.Path, metavar="MESH", help="mesh files")
    for name, what in (("views", "file of candidate directions (default: 128 Tammes directions)"),
                       ("observable", "file of directions that define the observable points (default: 360 Tammes directions)"),
                       ("starts", "file of directions; runs start at the nearest candidates (default: x, y and z)")):
        parser.add_argument(f"--{name}", help=what)
    parser.add_argument("--as-is", action="store_true", help="do not scale the meshes; they are in the unit sphere")
    parser.add_argument("--budget", type=int, default=20, help="number of views, with the start (default: 20)")
    parser.add_argument("--sectors", default=",".join(SECTORS),
                        help="sectors to run (default: all)")
    options = parser.parse_args()
    options.sectors = options.sectors.split(",")
    if not set(options.sectors) <= set(SECTORS):
        parser.error(f"--sectors: choose from {', '.join(SECTORS)}")
    if options.budget < 1:
        parser.error("--budget must be positive")
    return options


def main():
    options = parse_arguments()
    views, observable = directions_of(options.views, 128), directions_of(options.observable, 360)
    starts = np.eye(3) if options.starts is None else directions_of(options.starts, 0)
    checkpoints = [k for k in (3, 5, 10) if k < options.budget] + [options.budget]
    figures, limits = collections.defaultdict(list), collections.defaultdict(list)
    for mesh in options.meshes:
        stage = Stage(mesh, views, observable, options.as_is)
        for sector in options.sectors:
            may = allowed(views, sector)
            covered = stage.covered(may, allowed(observable, sector))
            reached = covered[0].any(axis=0).mean()
            limits[sector].append([100 * reached, *(covers.least_views(covered[0], np.ones(POINTS), part * reached, seconds=30)
                                                    for part in (0.9, 0.95, 0.99, 1))])
            for at, direction in enumerate(starts):
                start = may[np.argmax(views[may] @ direction)]
                for policy in POLICIES:
                    choice = (OracleChoice(may, covered[0]) if policy == "oracle" else RandomChoice(at + 1) if policy == "random"
                              else MapChoice(stage, policy))
                    taken, seconds = episode(choice, may, start, options.budget)
                    figures[sector, policy].append(figures_of(stage, may, covered, taken, seconds, checkpoints))
            print(f"{mesh.stem}, {sector}", file=sys.stderr)
    print(f"{', '.join(mesh.stem for mesh in options.meshes)}; {len(starts)} starts; means of {len(options.meshes) * len(starts)} runs. "
          f"NSC at 0.01 after k views, then at the stop at {', '.join(map(str, NEAR))} [%].\n")
    head = ["sector", "policy", *(f"k = {k}" for k in checkpoints), "views until the stop", *(f"NSC {near}" for near in NEAR), "path length",
            "s per choice"]
    print("| " + " | ".join(head) + " |\n|" + "---|" * len(head))
    for (sector, policy), rows in figures.items():
        mean = np.mean(rows, axis=0)
        print("| " + " | ".join([sector, policy, *(f"{v:.1f}" for v in mean[:-1]), f"{mean[-1]:.3f}"]) + " |")
    print("\nMinimum number of views to a share of what all candidates together cover, with any start. Objects are in their order. `3-4` means "
          "that fewer than 3 are ruled out\n\n| sector | all candidates' NSC [%] | 90 % | 95 % | 99 % | all |\n|---|---|---|---|---|---|")
    for sector, rows in limits.items():
        span = lambda one: str(len(one.views)) if one.bound == len(one.views) else f"{one.bound}-{len(one.views)}"
        columns = zip(*rows)
        cells = [", ".join(f"{share:.1f}" for share in next(columns)), *(", ".join(map(span, column)) for column in columns)]
        print(f"| {sector} | " + " | ".join(cells) + " |")


if __name__ == "__main__":
    main()
