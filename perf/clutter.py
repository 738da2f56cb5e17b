#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The viewgain authors
# SPDX-License-Identifier: Apache-2.0
"""How do policies compare in clutter and with limited reach? Prints the tables of results/clutter.md.

    clutter.py DIR [--jobs N] [--program PATH] [--tables] [--unseen]

Runs every policy on the scenes of scenes.toml with use = "report": with an SR4000 from three start
poses, which are the seeds, then with a D435 in two scenes from one. The default and the counts come
first. If it is stopped, the same call goes on with the runs that are in DIR. About an hour on two
idle cores. Needs the program viewgain, apps/install_dependencies.sh --perf, and
PYTHONPATH=build/release/python.

The visible surface, of which shares are stated, is what 2,562 poses see that look at the middle of the
scene. --unseen samples other poses in reach and prints what share of the surface none of them sees.
"""
import argparse
import itertools
import json
import pathlib
import sys

import numpy as np
import scipy.spatial
from scipy import stats
import viewgain.study as study
from viewgain.study import rows as of_rows
from viewgain.study.runs import version_of

import meshes
import scenes

GOALS = (.6, .7, .8, .9)
MAX_VIEWS = 10
OURS = "gain:combined"
COUNTS = ("gain:surface_frontier_count", "gain:unknown_count", "frontier")
RANDOM = {"name": "random", "command": "viewgain reconstruct --policy random --generator shell"}
POLICIES = [OURS, *COUNTS], ["oracle", RANDOM, "gain:surface", "gain:paper"]  # the first ones in all scenes and seeds, then the others
SEEDS = (1, 2, 3)
AROUND = .6                               # of the scene, where --unseen looks for poses [m]
CLEAR = .1                                # between such a pose and the surface [m]
LEAST_COSINE = np.cos(np.radians(80))     # that of the visible surface
D435_SCENES, D435_SEEDS = ("bin-31", "shelf-33"), (1,)


def toml(value):
    """A string, a number, a list or a table with string keys."""
    if isinstance(value, dict):
        return f"{{{', '.join(f'{key} = {toml(one)}' for key, one in value.items())}}}"
    return f"[{', '.join(map(toml, value))}]" if isinstance(value, (list, tuple)) else json.dumps(value)


def scene_object(folder, seed):
    """The scene as an object of a study, from its start pose number `seed`."""
    flags = scenes.tomllib.loads((folder / "flags.toml").read_text(encoding="utf-8"))
    start = np.loadtxt(folder / "starts.txt")[seed - 1, 1:]
    joined = lambda numbers: ",".join(f"{v:.6f}" for v in numbers)
    return {"mesh": str(folder / "scene.off"), "name": folder.name, "reach": str(folder / "reach.toml"),
            "flags": [f"--from={joined(start)}", f"--workspace={joined(flags['workspace'])}"]}


def is_made(folder):
    """Whether the scene's files are newer than what makes them."""
    sources = [pathlib.Path(scenes.__file__).with_name(name) for name in ("scenes.py", "scenes.toml", "meshes.py")]
    flags = folder / "flags.toml"  # the last one written
    return flags.exists() and flags.stat().st_mtime > max(source.stat().st_mtime for source in sources)


def specs(out, program):
    """The study's specs, one per sensor, seed and part of POLICIES, in the order of the runs. Writes the scenes and the specs to `out`."""
    reported = [name for name, scene in scenes.listed().items() if scene["use"] == "report"]
    for name in reported:
        if not is_made(out / "scenes" / name):
            scenes.write_listed([name], out / "scenes")
    sensors = ("sr4000", reported, SEEDS), ("d435", D435_SCENES, D435_SEEDS)
    for (sensor, names, seeds), (part, policies) in itertools.product(sensors, enumerate(POLICIES, 1)):
        for seed in seeds:
            keys = {"objects": [scene_object((out / "scenes" / name).resolve(), seed) for name in names], "policies": policies,
                    "seeds": [seed], "sensors": [sensor], "voxels": [.005], "max_views": MAX_VIEWS}
            path = out / f"{sensor}-{seed}-{part}.toml"
            path.write_text("".join(f"{key} = {toml(value)}\n" for key, value in keys.items()), encoding="utf-8")
            yield study.read_spec(path, version_of(program))


class Run:
    """The figures of one run."""

    def __init__(self, run, record, area):
        self.scene, self.policy, self.seed, self.sensor = run.object.name, run.policy.name, run.seed, run.sensor
        row = study.row_of(run, record, MAX_VIEWS)
        covered, views = row["coverage_by_view"], record["per_view"]
        self.views_to = [next((i + 1 for i, share in enumerate(covered) if share >= goal), None) for goal in GOALS]
        self.metres_to = [views[min(count or len(views), len(views)) - 1]["travelled"] for count in self.views_to]
        self.auc, self.end, self.rms = row["auc"], row["coverage_visible"], 1e3 * row["rms_error"]
        self.visible = sum(view["true_new_area"] for view in views) / row["coverage_visible"] / area


def finished(spec, out):
    """The runs of the spec that have been made."""
    areas = {}
    for run in spec.runs:
        path = out / "runs" / run.hash / "run.json"
        if not path.exists():
            continue
        if run.object.mesh not in areas:
            vertices, triangles = meshes.read_mesh(run.object.mesh)
            corners = vertices[triangles]
            areas[run.object.mesh] = np.linalg.norm(np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]), axis=1).sum() / 2
        yield Run(run, json.loads(path.read_text(encoding="utf-8")), areas[run.object.mesh])


def line(cells):
    return f"| {' | '.join(map(str, cells))} |\n"


def head(cells):
    return line(cells) + "|---" * len(cells) + "|\n"


def by_scene(runs, key):
    """Mean over the scenes of the mean of each."""
    return np.mean([np.mean([key(run) for run in runs if run.scene == scene]) for scene in dict.fromkeys(run.scene for run in runs)])


def comparable(runs):
    """The runs of those scenes and seeds that the first policies all have, so that means are of the same."""
    policies = {run.policy for run in runs} & {OURS, *COUNTS}
    shared = [{(run.scene, run.seed) for run in runs if run.policy == policy} for policy in policies]
    return [run for run in runs if all((run.scene, run.seed) in pairs for pairs in shared)]


def means(runs):
    """Views and metres to each goal; a run that never gets there counts as MAX_VIEWS + 1 views and with its whole path."""
    runs = comparable(runs)
    text = head(["policy", "runs", *(f"to {100 * goal:.0f} %: views; metres" for goal in GOALS), "AUC", "in the end", "RMS [mm]"])
    for policy in dict.fromkeys(run.policy for run in runs):
        own = [run for run in runs if run.policy == policy]
        cells = [policy, len(own)]
        for i in range(len(GOALS)):
            never = sum(run.views_to[i] is None for run in own)
            views, metres = by_scene(own, lambda run: run.views_to[i] or MAX_VIEWS + 1), by_scene(own, lambda run: run.metres_to[i])
            cells.append(f"{'≥ ' if never else ''}{views:.2f}; {metres:.1f}" + (f" ({never} never)" if never else ""))
        text += line([*cells, f"{by_scene(own, lambda run: run.auc):.3f}", f"{100 * by_scene(own, lambda run: run.end):.1f} %",
                      f"{by_scene(own, lambda run: run.rms):.2f}"])
    return text


def scores(runs):
    names = list(dict.fromkeys(run.scene for run in runs))
    text = head(["AUC", *names])
    for policy in dict.fromkeys(run.policy for run in runs):
        of = [[run.auc for run in runs if (run.policy, run.scene) == (policy, name)] for name in names]
        text += line([policy, *(f"{np.mean(values):.3f}" if values else "-" for values in of)])
    return text


def interval(values):
    """Mean ± half its 95 % interval (Student's t)."""
    half = stats.t.ppf(.975, len(values) - 1) * np.std(values, ddof=1) / np.sqrt(len(values)) if len(values) > 1 else np.nan
    return f"{np.mean(values):+.3f}" + (f" ± {half:.3f}" if np.isfinite(half) else "")


def pairs(runs):
    """AUC of OURS minus that of each policy, same scene and seed."""
    names = list(dict.fromkeys(run.scene for run in runs))
    auc = {(run.policy, run.scene, run.seed): run.auc for run in runs}
    text = head(["policy", *names, "all, other scenes", "all, other seeds", "ahead"])
    for policy in dict.fromkeys(run.policy for run in runs if run.policy != OURS):
        d = {name: [auc[OURS, name, seed] - value for (one, scene, seed), value in auc.items()
                    if (one, scene) == (policy, name) and (OURS, name, seed) in auc] for name in names}
        d = {name: values for name, values in d.items() if values}
        if not d:
            continue
        every, clusters = sum(d.values(), []), [name for name, values in d.items() for _ in values]
        half = of_rows.half_interval(every, clusters)
        text += line([policy, *(interval(d[name]) if name in d else "-" for name in names), interval([np.mean(v) for v in d.values()]),
                      f"± {half:.3f}" if np.isfinite(half) else "-", f"{sum(v > 0 for v in every)} of {len(every)}"])
    return text


def not_visible(runs):
    text = head(["scene", "not in the visible surface"])
    for name in dict.fromkeys(run.scene for run in runs):
        text += line([name, f"{100 * (1 - np.mean([run.visible for run in runs if run.scene == name])):.0f} %"])
    return text


def poses_in_reach(known, reach, count):
    """Poses at random places in reach, around the scene, that look at random places of the surface."""
    rng, poses = np.random.default_rng(1), []
    low, high = known.points.min(axis=0) - AROUND, known.points.max(axis=0) + AROUND
    surface = scipy.spatial.cKDTree(known.points)
    while len(poses) < count:
        eye, at = rng.uniform(low, high), known.points[rng.integers(len(known.points))]
        pose = np.eye(4)
        pose[:3, :3] = scipy.spatial.transform.Rotation.from_quat(scenes.quaternion(eye, at)).as_matrix()
        pose[:3, 3] = eye
        if surface.query(eye)[0] > CLEAR and reach.contains(pose[None])[0]:
            poses.append(pose)
    return poses


def unseen(folders, count=1000):
    """Share of the surface that none of `count` poses in reach sees with an SR4000 at under 80 deg."""
    import viewgain  # the extension module, which only this needs
    import visibility

    text = head(["scene", f"seen by none of {count:,} poses in reach"])
    for folder in folders:
        known = visibility.KnownObject(*meshes.read_mesh(folder / "scene.off"), viewgain.sensor_preset("sr4000"), 5000)
        seen = np.zeros(len(known.points), bool)
        for pose in poses_in_reach(known, viewgain.ReachRegion.load(str(folder / "reach.toml")), count):
            seen |= known.sees(pose, LEAST_COSINE)
        text += line([folder.name, f"{100 * (1 - seen.mean()):.0f} %"])
    return text


def tables(runs):
    text = ""
    for sensor in dict.fromkeys(run.sensor for run in runs):
        own = [run for run in runs if run.sensor == sensor]
        text += f"## {sensor}: {len(own)} runs, seeds {', '.join(map(str, sorted({run.seed for run in own})))}\n\n"
        text += "\n".join(table(own) for table in (means, scores, pairs, not_visible)) + "\n"
    return text


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("out", type=pathlib.Path, metavar="DIR", help="folder of the runs")
    parser.add_argument("--jobs", type=int, default=2, metavar="N", help="number of runs at once (default: 2)")
    parser.add_argument("--program", metavar="PATH", help="the program viewgain (default: on PATH)")
    parser.add_argument("--tables", action="store_true", help="make no runs; print the tables of those in DIR")
    parser.add_argument("--unseen", action="store_true", help="make no runs; print what share of each scene cannot be seen")
    args = parser.parse_args()
    runs = []
    try:
        program = study.find_program(args.program)
        args.out.mkdir(parents=True, exist_ok=True)
        for spec in specs(args.out, program):
            if args.unseen:
                print(unseen([one.mesh.parent for one in spec.objects]), end="")
                return
            if not args.tables:
                study.make_runs(spec, args.out, args.jobs, None, program, lambda said: print(said, file=sys.stderr, flush=True))
            runs += finished(spec, args.out)
    except (study.SpecError, study.RunError) as error:
        sys.exit(f"clutter.py: {error}")
    print(tables(runs), end="")


if __name__ == "__main__":
    main()
