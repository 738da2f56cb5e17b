#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The viewgain authors
# SPDX-License-Identifier: Apache-2.0
"""Compares the policies of `viewgain reconstruct` on three objects and several seeds.

Runs every policy with the same start poses, noise seeds, feasibility and budget, and prints, as
Markdown, how many views each needs to 90 % of the visible surface and what it has in the end. A run
that never gets there counts as budget + 1 views, and the table says how many did not.

    perf/compare_policies.py [--viewgain build/release/bin/viewgain] [--meshes build/meshes]
                             [--out build/policies] [--jobs 2] [--seeds 5] [--views 12]
"""

import argparse
import concurrent.futures
import json
import os
import statistics
import subprocess

OBJECTS = ["camel", "lion-head", "mannequin-devil"]
POLICIES = {
    "gain": [],
    "kriegel": [],
    "sequence": ["--no-refine"],
    "random": [],
    "frontier": [],
}
GOAL = 0.90


def parse_arguments():
    parser = argparse.ArgumentParser(description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--viewgain", default="build/release/bin/viewgain")
    parser.add_argument("--meshes", default="build/meshes")
    parser.add_argument("--out", default="build/policies")
    parser.add_argument("--jobs", type=int, default=os.cpu_count())
    parser.add_argument("--seeds", type=int, default=5)
    parser.add_argument("--views", type=int, default=12, help="budget of each run")
    parser.add_argument("--policies", default=",".join(POLICIES))
    parser.add_argument("--objects", default=",".join(OBJECTS))
    parser.add_argument("extra", nargs="*", help="further arguments of reconstruct, after --")
    return parser.parse_args()


def run(arguments, mesh, policy, seed):
    path = os.path.join(arguments.meshes, mesh + ".off")
    if not os.path.exists(path):
        raise SystemExit(f"{path}: no such file; apps/extract_mesh.sh {mesh}.off {arguments.meshes}")
    out = os.path.join(arguments.out, f"{mesh}-{policy}-{seed}")
    command = [arguments.viewgain, "reconstruct", path, "--sensor", "sr4000", "--voxel", "0.003125",
               "--policy", policy, "--max-views", str(arguments.views), "--seed", str(seed),
               "--threads", "1", "--no-pictures", "--json", "--out", out]
    # Each policy gets the whole budget: what stops a run early is not what is compared.
    command += ["--stop-gain", "0", "--stop-idle", "0"] + POLICIES[policy] + arguments.extra
    done = subprocess.run(command, capture_output=True, text=True, check=False)
    if done.returncode != 0:
        raise SystemExit(f"{' '.join(command)}: {done.stderr.strip().splitlines()[-1:]}")
    return json.loads(done.stdout)


def views_to_goal(result, budget):
    for view in result["per_view"]:
        if (view["coverage_visible"] or 0) >= GOAL:
            return view["index"] + 1
    return budget + 1


def mean(values):
    return statistics.fmean(values)


def spread(values):
    return statistics.stdev(values) if len(values) > 1 else 0.0


def main():
    arguments = parse_arguments()
    os.makedirs(arguments.out, exist_ok=True)
    objects, policies = arguments.objects.split(","), arguments.policies.split(",")
    seeds = range(1, arguments.seeds + 1)
    jobs = [(mesh, policy, seed) for mesh in objects for policy in policies for seed in seeds]
    with concurrent.futures.ThreadPoolExecutor(arguments.jobs) as executor:
        results = dict(zip(jobs, executor.map(lambda job: run(arguments, *job), jobs)))

    print(f"Views to {GOAL:.0%} of the visible surface (5 mm), mean ± standard deviation over seeds "
          f"1-{arguments.seeds}, budget {arguments.views}\n")
    print("| policy | " + " | ".join(objects) + " | mean | not reached |")
    print("|---|" + "---|" * (len(objects) + 2))
    for policy in policies:
        cells, everything, missed = [], [], 0
        for mesh in objects:
            views = [views_to_goal(results[mesh, policy, seed], arguments.views) for seed in seeds]
            missed += sum(v > arguments.views for v in views)
            everything += views
            cells.append(f"{mean(views):.1f} ± {spread(views):.1f}")
        print(f"| {policy} | " + " | ".join(cells) + f" | {mean(everything):.2f} | {missed} |")

    print("\nAt the end of the budget, means over seeds: visible coverage, RMS of the surface, "
          "consistency of the points, travelled\n")
    print("| policy | " + " | ".join(objects) + " |")
    print("|---|" + "---|" * len(objects))
    for policy in policies:
        cells = []
        for mesh in objects:
            runs = [results[mesh, policy, seed] for seed in seeds]
            cells.append(f"{100 * mean([r['coverage_visible'] for r in runs]):.1f} %, "
                         f"{1e3 * mean([r['rms_error'] for r in runs]):.2f} mm, "
                         f"{mean([r['consistency'] for r in runs]):.2f}, "
                         f"{mean([r['travelled'] for r in runs]):.1f} m")
        print(f"| {policy} | " + " | ".join(cells) + " |")


if __name__ == "__main__":
    main()
