#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The viewgain authors
# SPDX-License-Identifier: Apache-2.0
"""How close do a study's policies come to the minimum number of views? Prints Markdown.

    limits.py SPEC.toml DIR [--samples 1000] [--seconds 20] [--dense 162] [--own 160]

DIR is the output of `python3 -m viewgain.study SPEC.toml --out DIR`. The spec must set
kept_candidates. Visible parts of the true surface (visibility.py) are kept in DIR/visibility.

Shares refer to the samples on the surface that at least one view sees. The views are those of a
dense set, and the candidates and views of all runs. The dense set has --dense poses on each of
three spheres, at 0.8, 1 and 1.25 times the start's distance. The first view is given and counts.

The minimum number of views and the best k views are integer programs. If one runs out of time, the
table shows the bounds that are proven. Needs PYTHONPATH=build/release/python and scipy.
"""
import argparse
import collections
import json
import pathlib
import sys
import tomllib

import numpy as np
import viewgain.mesh
from scipy.spatial import cKDTree

import covers
import meshes
import visibility

GOALS = (0.80, 0.90, 0.95)
RADII = (0.8, 1, 1.25)  # radii of the dense set [start's distance]
MOST = 12  # number of views in the curve


class Run:
    """A run of the study, and what its views and candidates see."""

    def __init__(self, row, folder, most):
        self.row = row
        self.policy = f"gain:{row['gain']}" if row["gain"] else row["policy"]
        record = json.loads((folder / "runs" / row["hash"] / "run.json").read_text(encoding="utf-8"))
        self.taken = np.array([view["pose"] for view in record["per_view"]])
        candidates = folder / "runs" / row["hash"] / "candidates.txt"
        if not candidates.exists():
            sys.exit(f"{candidates} is missing: set kept_candidates in the study's spec and run it again")
        own = viewgain.read_poses(candidates)
        own = own[np.unique(np.linspace(0, len(own) - 1, most).astype(int))]
        self.poses = np.concatenate([self.taken, own])


def kept_matrix(path, known, poses):
    """known.matrix(poses), read from the file if it has the same poses and samples."""
    if path.exists():
        kept = np.load(path)
        if kept["poses"].shape == poses.shape and np.array_equal(kept["poses"], poses) and np.array_equal(kept["samples"], known.points):
            return np.unpackbits(kept["seen"], axis=1, count=len(known.points)).astype(bool)
    seen = known.matrix(poses)
    path.parent.mkdir(exist_ok=True)
    np.savez(path, poses=poses, samples=known.points, seen=np.packbits(seen, axis=1), area=known.area / len(known.points))
    return seen


class Problem:
    """Runs on one object. The rows of `seen` are the start of each seed, then the dense set."""

    def __init__(self, runs, mesh, folder, options):
        row = runs[0].row
        vertices, triangles = meshes.read_mesh(mesh)
        self.mesh = meshes.scaled(vertices, row["size"]), triangles
        self.sensor, self.voxel = viewgain.Sensor.load(row["sensor"]), row["voxel"]
        known = visibility.KnownObject(*self.mesh, self.sensor, options.samples)
        starts = {run.row["seed"]: run.taken[0] for run in runs}
        for run in runs:
            if not np.array_equal(run.taken[0], starts[run.row["seed"]]):
                sys.exit(f"runs of seed {run.row['seed']} on {row['object']} start at different places")
        distance = np.mean([np.linalg.norm(pose[:3, 3]) for pose in starts.values()])
        spheres = [viewgain.sphere_poses(options.dense, factor * distance) for factor in RADII]
        self.name, self.runs, self.seeds, self.tolerance = row["object"], runs, list(starts), options.tolerance
        self.poses = np.concatenate([np.array(list(starts.values())), *spheres])
        self.seen = kept_matrix(folder / f"{self.name}.npz", known, self.poses)
        for run in runs:
            run.seen = kept_matrix(folder / f"{run.row['hash']}.npz", known, run.poses)
        counted = self.seen.any(axis=0) | np.any([run.seen.any(axis=0) for run in runs], axis=0)
        self.visible = counted.mean()
        self.seen = self.seen[:, counted]
        for run in runs:
            run.seen = run.seen[:, counted]
        self.area = np.ones(int(counted.sum()))
        self.points = known.points[counted]

    def rows_of(self, seed):
        """Rows of the dense set, with this seed's start first."""
        return [self.seeds.index(seed), *range(len(self.seeds), len(self.poses))]


    def modelled(self, poses, seed):
        """The covered share of the surface after a frame from each pose.

        Frames are simulated as in `reconstruct`. The share is within one percent of its count.
        """
        half = 0.5 * 0.4 / 0.35 * np.ptp(self.mesh[0], axis=0).max()
        camera = viewgain.SimulatedSensor(*self.mesh, self.sensor, background_radius=1.5, noise=True, lateral_noise=True, sub_rays=3,
                                          seed=seed)
        planner = viewgain.ViewPlanner(self.sensor, voxel_size=self.voxel, workspace=[[-half] * 3, [half] * 3])
        for i, pose in enumerate(poses):
            frame = camera.acquire(pose, i)
            planner.add(frame.depth, pose, amplitude=frame.amplitude)
        surface = viewgain.mesh.surface_of_grid(planner.grid)
        return np.mean(cKDTree(surface.vertices).query(self.points)[0] <= self.tolerance)


def way_of(poses):
    return float(np.linalg.norm(np.diff(poses[:, :3, 3], axis=0), axis=1).sum())


def table(head, rows):
    print("| " + " | ".join(head) + " |\n|" + "---|" * len(head))
    for row in rows:
        print("| " + " | ".join(str(cell) for cell in row) + " |")
    print()


def shown(least):
    """"4", or "3-4" if 3 is not ruled out; in brackets the linear program's bound, if it is lower."""
    if least.views is None:
        return "never"
    size = len(least.views)
    text = str(size) if least.bound == size else f"{least.bound}-{size}"
    return text if least.lp_bound == least.bound else f"{text} ({least.lp_bound})"


def limits_of(problem, seconds):
    """Limits of the dense set by seed and goal, and of the own candidates by run and goal.

    A limit of the dense set is the minimum set, the size of the greedy set and the length of the
    shortest path. One of the own candidates is the minimum set.
    """
    dense, own = {}, {}
    for seed in problem.seeds:
        rows = problem.rows_of(seed)
        seen, poses = problem.seen[rows], problem.poses[rows]
        order = [0, *with_first(seen, problem.area)]
        for goal in GOALS:
            least = covers.least_views(seen, problem.area, goal, first=0, seconds=seconds)
            simple = next((k for k in range(1, len(order) + 1) if covers.share_of(seen, problem.area, order[:k]) >= goal - covers.SLACK),
                          None)
            way = None
            if least.views is not None:
                start, *stops = poses[least.views, :3, 3]
                costs = np.linalg.norm(np.array([*stops, start])[:, None] - np.array(stops).reshape(1, -1, 3), axis=2)
                way = viewgain.order_stops(costs)[1]
            dense[seed, goal] = (least, simple, way)
            print(f"{problem.name}, seed {seed}, {goal}: {shown(least)}", file=sys.stderr)
    for run in problem.runs:
        for goal in GOALS:
            own[run, goal] = covers.least_views(run.seen, problem.area, goal, first=0, seconds=seconds)
        print(f"{problem.name}, {run.policy}: {[shown(own[run, goal]) for goal in GOALS]}", file=sys.stderr)
    return dense, own


def with_first(seen, area):
    """The greedy order after view 0."""
    return covers.greedy(seen, np.where(seen[0], 0, area))


def print_curve(problems, seconds):
    """Prints the coverage of the best k views of the dense set and of the policies: means, first seeds."""
    rows, proven = [], 0
    policies = list(dict.fromkeys(run.policy for problem in problems for run in problem.runs))
    for k in range(1, MOST + 1):
        best, simple, modelled, others = [], [], [], collections.defaultdict(list)
        for problem in problems:
            of_seed = problem.rows_of(problem.seeds[0])
            seen = problem.seen[of_seed]
            found = covers.best_of(seen, problem.area, k, first=0, seconds=seconds)
            best.append(found)
            simple.append(covers.share_of(seen, problem.area, [0, *with_first(seen, problem.area)][:k]))
            modelled.append(problem.modelled(problem.poses[of_seed][found.views], problem.seeds[0]))
            proven += found.bound - found.share < 1e-4
            for run in problem.runs:
                if run.row["seed"] == problem.seeds[0]:
                    others[run.policy].append(run.row["coverage_by_view"][min(k, len(run.row["coverage_by_view"])) - 1])
        mean = lambda values: f"{100 * np.mean(values):.1f}"
        rows.append([k, mean(simple), mean([b.share for b in best]), mean([b.bound for b in best]), mean(modelled),
                     *(mean(others[policy]) for policy in policies)])
        print(f"best {k}: {rows[-1]}", file=sys.stderr)
    print(f"Best k views of the dense set [%], means of {len(problems)} objects at their first seed; {proven} of {MOST * len(problems)} "
          "proven to 0.01. Seen: by the greedy set, by the best known set, and the bound. Modelled: the surface after a frame from each of the "
          "best views, with all noise, as the study counts it. The other columns are the policies' runs after k views\n")
    table(["k", "greedy, seen", "best, seen", "bound", "best, modelled", *policies], rows)


def part_of_way(random, value, limit):
    return f"{100 * (random - value) / (random - limit):.0f} %" if random > limit else "-"


def print_policies(problems, dense, own):
    """Prints the number of views by policy, and its place between random and the limit."""
    runs = [(problem, run) for problem in problems for run in problem.runs]
    policies = list(dict.fromkeys(run.policy for _, run in runs))
    reached = {run: [covers.share_of(run.seen, problem.area, range(k + 1)) for k in range(len(run.taken))] for problem, run in runs}
    views, counted, ways, least, own_least = (collections.defaultdict(list) for _ in range(5))
    for problem, run in runs:
        for i, goal in enumerate(GOALS):
            key, never = (run.policy, goal), len(run.row["coverage_by_view"]) + 1
            count = next((k for k, share in enumerate(reached[run], 1) if share >= goal - covers.SLACK), never)
            views[key].append(count)
            ways[key].append(way_of(run.taken[:count]))
            counted[key].append(run.row[("views_to_80", "views_to_90", "views_to_95")[i]] or never)
            best = dense[problem.name, run.row["seed"], goal][0]
            least[key].append(len(best.views) if best.views is not None else never)
            one = own[run, goal]
            if one.views is not None:
                own_least[key].append(len(one.views))
    print("Number of views of each policy to a share of the visible surface, by what its views see. The limits are the minimum of the dense "
          "set and of the run's own candidates, from the same starts. In brackets is the number of runs whose candidates reach the share. "
          "0 % is `random`, 100 % the limit of the dense set\n")
    mean = {name: {key: np.mean(values) for key, values in store.items()}
            for name, store in (("views", views), ("ways", ways), ("counted", counted), ("least", least))}
    rows = []
    for policy in policies:
        for goal in GOALS:
            key, random = (policy, goal), mean["views"].get(("random", goal), np.nan)
            reach = own_least[key]
            rows.append([policy, f"{100 * goal:.0f} %", f"{mean['views'][key]:.2f}", f"{mean['least'][key]:.2f}",
                         f"{np.mean(reach):.2f} ({len(reach)})" if reach else "never",
                         part_of_way(random, mean["views"][key], mean["least"][key]), f"{mean['ways'][key]:.2f}",
                         f"{mean['counted'][key]:.2f}"])
    table(["policy", "share", "views", "limit, dense", "limit, own (runs)", "from random to limit", "path length [m]",
           "views by the study's count"], rows)


def parse_arguments():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("spec", type=pathlib.Path, metavar="SPEC.toml", help="the study's spec")
    parser.add_argument("dir", type=pathlib.Path, metavar="DIR", help="the study's output")
    parser.add_argument("--samples", type=int, default=1000, help="number of samples on the surface (default: 1000)")
    parser.add_argument("--seconds", type=float, default=20, help="time limit per integer program [s] (default: 20)")
    parser.add_argument("--dense", type=int, default=162, help="poses on each of three spheres (default: 162)")
    parser.add_argument("--own", type=int, default=160, help="most candidates per run, taken evenly (default: 160)")
    options = parser.parse_args()
    if min(options.samples, options.seconds, options.dense, options.own) <= 0:
        parser.error("--samples, --seconds, --dense and --own must be positive")
    return options


def main():
    options = parse_arguments()
    for path in (options.spec, options.dir / "results.json"):
        if not path.exists():
            sys.exit(f"{path} is missing")
    spec = tomllib.loads(options.spec.read_text(encoding="utf-8"))
    if spec.get("flags"):
        sys.exit(f"{options.spec}: limits.py does not support `flags`, because they may change what can be seen")
    files = {pathlib.Path(name).stem: options.spec.parent / name for name in spec["objects"]}
    rows = json.loads((options.dir / "results.json").read_text(encoding="utf-8"))
    if len({(row["sensor"], row["voxel"], row["size"]) for row in rows}) != 1:
        sys.exit(f"{options.spec}: limits.py supports studies of one sensor, voxel size and object size")
    groups = collections.defaultdict(list)
    for row in rows:
        groups[row["object"]].append(Run(row, options.dir, options.own))
    options.tolerance = spec.get("tolerance", 5e-3)
    problems, dense, own = [], {}, {}
    for name, runs in groups.items():
        problem = Problem(runs, files[name], options.dir / "visibility", options)
        problems.append(problem)
        by_seed, by_run = limits_of(problem, options.seconds)
        dense.update({(name, *key): value for key, value in by_seed.items()})
        own.update(by_run)
    print(f"{sum(len(problem.runs) for problem in problems)} runs; {options.samples} samples per object. Views see "
          f"{', '.join(f'{problem.name} {100 * problem.visible:.1f} %' for problem in problems)}; the dense set has "
          f"{len(RADII) * options.dense} views.\n")
    for goal in GOALS:
        all_dense = [value[0] for key, value in dense.items() if key[-1] == goal]
        all_own = [value for key, value in own.items() if key[-1] == goal]
        closed = lambda found: sum(one.views is not None and one.bound == len(one.views) for one in found)
        by_lp = lambda found: sum(one.views is not None and one.lp_bound == len(one.views) for one in found)
        never = sum(one.views is None for one in all_own)
        print(f"- {100 * goal:.0f} %: proven for {closed(all_dense)} of {len(all_dense)} starts in the dense set ({by_lp(all_dense)} by "
              f"the linear program alone), for {closed(all_own)} of {len(all_own)} runs' own candidates ({by_lp(all_own)}); {never} of "
              "these cannot reach it.")
    print("\nMinimum number of views in the dense set. `3-4` means that fewer than 3 are ruled out. In brackets is the linear program's bound, "
          "if it is lower. Then come the number of views of the greedy set and the shortest path through the minimum set [m]\n")
    table(["object", "seed", *(f"{100 * goal:.0f} %, greedy, path" for goal in GOALS)],
          [[problem.name, seed, *(f"{shown(least)}, {simple}, {way:.2f}" if way is not None else "never"
                                  for least, simple, way in (dense[problem.name, seed, goal] for goal in GOALS))]
           for problem in problems for seed in problem.seeds])
    print_curve(problems, options.seconds)
    print_policies(problems, dense, own)


if __name__ == "__main__":
    main()
