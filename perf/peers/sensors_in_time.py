#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The viewgain authors
# SPDX-License-Identifier: Apache-2.0
"""Compares a laser line scanner with the SR4000 on one object in equal time, after the paper's Fig. 6.

    sensors_in_time.py [--viewgain build/release/bin/viewgain] [--mesh build/release/meshes/camel.off]
                       [--out build/sensors_in_time] [--seconds 10,20,30,60] [--speed 0.25]
                       [--settle 0.5] [--line-rate 50] [--seeds 3] [-- arguments of reconstruct]

Runs `viewgain reconstruct` with the sensor sr4000 and with a laser line scanner, whose frame is a
sweep of 480 lines.
Prints a Markdown table of coverage of the visible surface (5 mm), coverage of all surface (2.5 mm),
RMS and removed entropy, after given times. Entropy starts from each sensor's own prior. The time is
that of a robot, not of this program:

    path length / speed + views * (settle + frame)

A frame takes 1 / 20 s with the SR4000. A sweep takes 480 lines / line rate.
"""

import argparse
import json
import math
import os
import statistics
import subprocess

LINES = 480  # per sweep
LEAST_WAY = {"SR4000": 0.5, "sweeps": 0.5}  # mean distance between views, at least [m]
SWEEP = f"""name = "sweep of {LINES} lines"
min_range = 0.1
max_range = 1.0
working_distance = 0.4

[camera]
width = 640
height = {LINES}
fx = 800.0
fy = 800.0
cx = 319.5
cy = {(LINES - 1) / 2}

[noise]
model = "constant"
sigma_axial = 0.0002
sigma_lateral = 0.0002
"""


def parse_arguments():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--viewgain", default="build/release/bin/viewgain", help="the program viewgain")
    parser.add_argument("--mesh", default="build/release/meshes/camel.off", help="mesh file of the object")
    parser.add_argument("--out", default="build/sensors_in_time", help="folder for the runs")
    parser.add_argument("--seconds", default="10,20,30,60", help="times of the rows [s]; the last one is the budget")
    parser.add_argument("--speed", type=float, default=0.25, help="speed of the camera [m/s] (default: 0.25)")
    parser.add_argument("--settle", type=float, default=0.5, help="time to settle before a view [s] (default: 0.5)")
    parser.add_argument("--line-rate", type=float, default=50, help="line rate of the scanner [1/s] (default: 50)")
    parser.add_argument("--seeds", type=int, default=3, help="number of seeds (default: 3)")
    parser.add_argument("extra", nargs="*", help="more arguments for reconstruct, after --")
    arguments = parser.parse_args()
    arguments.seconds = [float(s) for s in arguments.seconds.split(",")]
    return arguments


def ways(arguments, budget):
    """{name: (arguments of reconstruct, seconds per view)}."""
    sweep = os.path.join(arguments.out, "sweep.toml")
    with open(sweep, "w", encoding="utf-8") as file:
        file.write(SWEEP)
    each = {"SR4000": arguments.settle + 1 / 20, "sweeps": arguments.settle + LINES / arguments.line_rate}
    flags = {"SR4000": ["--sensor", "sr4000"], "sweeps": ["--sensor", sweep]}

    def most(name):
        return str(math.ceil(budget / (each[name] + LEAST_WAY[name] / arguments.speed)))

    return {name: (flags[name] + ["--max-views", most(name)], each[name]) for name in each}


def run(arguments, name, flags, seed):
    command = [arguments.viewgain, "reconstruct", arguments.mesh, "--size", "0.35", "--voxel", "0.003125",
               "--seed", str(seed), "--threads", "1", "--stop", "area=0", "--stop", "idle=0", "--stop", "promises=0", "--pictures", "off",
               "--report", "off", "--quiet", "--json", "--out", os.path.join(arguments.out, f"{name}-{seed}")]
    command += flags + arguments.extra
    done = subprocess.run(command, capture_output=True, text=True, check=False)
    if done.returncode != 0:
        raise SystemExit(f"{' '.join(command)}: {done.stderr.strip().splitlines()[-1:]}")
    views = json.loads(done.stdout)["per_view"]
    if views[-1]["travelled"] < LEAST_WAY[name] * (len(views) - 1):
        raise SystemExit(f"{name}, seed {seed}: path shorter than LEAST_WAY per view, so the time was not used up")
    return views


def at(views, seconds, per_view, speed):
    """The state after this time [s]; None before the first view."""
    done = [v for i, v in enumerate(views) if v["travelled"] / speed + (i + 1) * per_view <= seconds]
    return {"views": len(done), **done[-1]} if done else None


def mean(states, key):
    values = [s[key] for s in states if s[key] is not None]
    return statistics.fmean(values) if values else float("nan")


def cell(states):
    if any(s is None for s in states):
        return "-"
    rms = 1e3 * mean(states, "rms_error")
    return (f"{mean(states, 'views'):.0f} views: {100 * mean(states, 'coverage_visible'):.1f} %, "
            f"{100 * mean(states, 'coverage_2_5mm'):.1f} %, {rms:.2f} mm, "
            f"{mean(states, 'entropy_removed') / 1e3:.0f} knat")


def main():
    arguments = parse_arguments()
    os.makedirs(arguments.out, exist_ok=True)
    of = {}
    for name, (flags, per_view) in ways(arguments, arguments.seconds[-1]).items():
        of[name] = per_view, [run(arguments, name, flags, seed) for seed in range(1, arguments.seeds + 1)]
    print("coverage of the visible surface at 5 mm, of all surface at 2.5 mm, RMS of the surface, entropy removed\n")
    print("| after | " + " | ".join(of) + " |\n|---|" + "---|" * len(of))
    for seconds in arguments.seconds:
        cells = [cell([at(views, seconds, per_view, arguments.speed) for views in runs])
                 for per_view, runs in of.values()]
        print(f"| {seconds:.0f} s | " + " | ".join(cells) + " |")


if __name__ == "__main__":
    main()
