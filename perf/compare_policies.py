#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The viewgain authors
# SPDX-License-Identifier: Apache-2.0
"""Compares the policies of `viewgain reconstruct` on several objects and seeds.

Runs every policy with the same start poses, noise seeds, feasibility and budget, and prints, as
Markdown, how many views each needs to 80, 90 and 95 % of the visible surface, the mean coverage over
the views of the budget (AUC), what it has in the end, and the differences of paired runs to one of
them. A run that never gets there counts as budget + 1 views.

    perf/compare_policies.py [--viewgain build/release/bin/viewgain] [--meshes build/meshes]
                             [--out build/policies] [--jobs 2] [--seeds 5] [--views 12] [--keep] [--sensor sr4000]
                             [--policies combined,frontier] [--objects camel] [--against frontier]
                             [-- arguments of reconstruct]
"""

import argparse
import concurrent.futures
import json
import os
import statistics
import subprocess

OBJECTS = ["camel", "lion-head", "mannequin-devil"]
POLICIES = {
    "combined": ["--policy", "gain", "--gain", "combined"],
    "surface": ["--policy", "gain", "--gain", "surface"],
    "paper": ["--policy", "gain", "--gain", "paper"],
    "frontier": ["--policy", "frontier"],
    "kriegel": ["--policy", "kriegel"],
    "sequence": ["--policy", "sequence", "--refine", "off"],
    "random": ["--policy", "random"],
    "oracle": ["--policy", "oracle"],
    "fibonacci": ["--policy", "fibonacci"],
    "proximity": ["--policy", "proximity"],
}
GOALS = (0.80, 0.90, 0.95)


def parse_arguments():
    parser = argparse.ArgumentParser(description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--viewgain", default="build/release/bin/viewgain")
    parser.add_argument("--meshes", default="build/meshes")
    parser.add_argument("--out", default="build/policies")
    parser.add_argument("--jobs", type=int, default=os.cpu_count())
    parser.add_argument("--seeds", type=int, default=5)
    parser.add_argument("--views", type=int, default=12, help="budget of each run")
    parser.add_argument("--sensor", default="sr4000")
    parser.add_argument("--policies", default="combined,surface,paper,frontier,kriegel,sequence,random")
    parser.add_argument("--objects", default=",".join(OBJECTS))
    parser.add_argument("--against", default="frontier", help="policy that the others are paired with")
    parser.add_argument("--keep", action="store_true", help="use the runs that are in --out already")
    parser.add_argument("extra", nargs="*", help="further arguments of reconstruct, after --")
    return parser.parse_args()


def run(arguments, mesh, policy, seed):
    path = os.path.join(arguments.meshes, mesh + ".off")
    if not os.path.exists(path):
        raise SystemExit(f"{path}: no such file; apps/extract_mesh.sh {mesh}.off {arguments.meshes}")
    out = os.path.join(arguments.out, f"{mesh}-{policy}-{seed}")
    if arguments.keep and os.path.exists(os.path.join(out, "run.json")):
        with open(os.path.join(out, "run.json"), encoding="utf-8") as file:
            return json.load(file)
    command = [arguments.viewgain, "reconstruct", path, "--sensor", arguments.sensor, "--voxel", "0.003125",
               "--max-views", str(arguments.views), "--seed", str(seed), "--threads", "1",
               "--pictures", "off", "--json", "--out", out]
    if "--size" not in arguments.extra:
        command += ["--size", "0.35"]
    # Each policy gets the whole budget: what stops a run early is not what is compared.
    command += ["--stop-gain", "0", "--stop-area", "0", "--stop-idle", "0"]
    command += POLICIES[policy] + arguments.extra
    done = subprocess.run(command, capture_output=True, text=True, check=False)
    if done.returncode != 0:
        raise SystemExit(f"{' '.join(command)}: {done.stderr.strip().splitlines()[-1:]}")
    return json.loads(done.stdout)


def figures(result, budget):
    """What is compared of a run. A run that ended early keeps what it had."""
    coverage = [view["coverage_visible"] or 0 for view in result["per_view"]]
    coverage += [coverage[-1]] * (budget - len(coverage))
    views = {goal: next((i + 1 for i, c in enumerate(coverage) if c >= goal), budget + 1)
             for goal in GOALS}
    return {"views": views, "auc": mean(coverage), "final": coverage[-1],
            "rms": 1e3 * result["rms_error"], "consistency": result["consistency"],
            "travelled": result["travelled"]}


def mean(values):
    return statistics.fmean(values)


def spread(values):
    return statistics.stdev(values) if len(values) > 1 else 0.0


def with_error(values, digits):
    """Mean ± standard error."""
    return f"{mean(values):.{digits}f} ± {spread(values) / len(values) ** 0.5:.{digits}f}"


def print_by_object(rows, objects, policies, seeds):
    print("Views to 90 % of the visible surface (5 mm), mean ± standard deviation over seeds; in the "
          "end: coverage, RMS of the surface, consistency of the points, travelled\n")
    print("| policy | " + " | ".join(objects) + " |")
    print("|---|" + "---|" * len(objects))
    for policy in policies:
        cells = []
        for mesh in objects:
            runs = [rows[mesh, policy, seed] for seed in seeds]
            views = [r["views"][0.90] for r in runs]
            cells.append(f"{mean(views):.1f} ± {spread(views):.1f}; "
                         f"{100 * mean([r['final'] for r in runs]):.1f} %, "
                         f"{mean([r['rms'] for r in runs]):.2f} mm, "
                         f"{mean([r['consistency'] for r in runs]):.2f}, "
                         f"{mean([r['travelled'] for r in runs]):.1f} m")
        print(f"| {policy} | " + " | ".join(cells) + " |")


def print_means(rows, policies, runs):
    print("\n| policy | to 80 % | to 90 % | to 95 % | not to 90 % | AUC | in the end | RMS [mm] |")
    print("|---|---|---|---|---|---|---|---|")
    for policy in policies:
        of = [rows[mesh, policy, seed] for mesh, seed in runs]
        views = " | ".join(f"{mean([r['views'][goal] for r in of]):.2f}" for goal in GOALS)
        missed = sum(r["final"] < 0.90 for r in of)
        print(f"| {policy} | {views} | {missed} of {len(of)} | {mean([r['auc'] for r in of]):.3f} | "
              f"{100 * mean([r['final'] for r in of]):.1f} % | {mean([r['rms'] for r in of]):.2f} |")


def print_pairs(rows, policies, runs, against):
    print(f"\nPaired with {against}, mean ± standard error; wins-ties-losses\n")
    print("| policy | to 80 % | to 90 % | to 95 % | AUC | RMS [mm] |")
    print("|---|---|---|---|---|---|")
    for policy in policies:
        if policy == against:
            continue
        pairs = [(rows[mesh, policy, seed], rows[mesh, against, seed]) for mesh, seed in runs]
        cells = []
        for goal in GOALS:
            d = [a["views"][goal] - b["views"][goal] for a, b in pairs]
            cells.append(f"{with_error(d, 2)} ({sum(v < 0 for v in d)}-{sum(v == 0 for v in d)}-"
                         f"{sum(v > 0 for v in d)})")
        auc = [a["auc"] - b["auc"] for a, b in pairs]
        cells.append(f"{with_error(auc, 3)} ({sum(v > 0 for v in auc)} of {len(auc)})")
        cells.append(with_error([a["rms"] - b["rms"] for a, b in pairs], 2))
        print(f"| {policy} | " + " | ".join(cells) + " |")


def main():
    arguments = parse_arguments()
    os.makedirs(arguments.out, exist_ok=True)
    objects, policies = arguments.objects.split(","), arguments.policies.split(",")
    seeds = range(1, arguments.seeds + 1)
    jobs = [(mesh, policy, seed) for seed in seeds for mesh in objects for policy in policies]
    with concurrent.futures.ThreadPoolExecutor(arguments.jobs) as executor:
        results = executor.map(lambda job: figures(run(arguments, *job), arguments.views), jobs)
        rows = dict(zip(jobs, results))
    runs = [(mesh, seed) for mesh in objects for seed in seeds]
    print_by_object(rows, objects, policies, seeds)
    print_means(rows, policies, runs)
    if arguments.against in policies:
        print_pairs(rows, policies, runs, arguments.against)


if __name__ == "__main__":
    main()
