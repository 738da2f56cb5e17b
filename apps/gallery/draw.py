#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The viewgain authors
# SPDX-License-Identifier: Apache-2.0
"""Draws the READMEs' pictures from what the programs left: draw.py WHAT INPUT PICTURE.png

    step, idea   a picture of the program and a legend beside it
    speed        the JSON of `viewgain-bench trace`
    coverage     the folder of runs that perf/compare_policies.py keeps

make_pictures.sh calls it. Needs matplotlib.
"""

import collections
import glob
import json
import os
import statistics
import sys

import matplotlib

matplotlib.use("agg")
import matplotlib.pyplot as plt
from matplotlib.lines import Line2D

# The colours of the program's pictures.
STEP = [("surface modelled so far", "#a0a09c", "s"), ("where new surface is expected", "#f9922d", "s"),
        ("open boundary: left", "#e01b24", "s"), ("right", "#33a02c", "s"), ("top", "#1f4fe0", "s"),
        ("bottom", "#f2c200", "s"), ("candidate view, by its boundary", "#7a7a7a", "^"),
        ("view just taken", "#111111", "^"), ("next view and its rays", "#0b7a3b", "^")]
IDEA = [("seen so far", "#a0a09c", "s"), ("rays end in unknown voxels: exploration", "#f9922d", "s"),
        ("rays end in occupied voxels: refinement", "#2f6fe0", "s"), ("best of 2,000 views", "#111111", "^")]
METHODS = [("viewgain_gain", "viewgain, with its gain"), ("viewgain_trace", "viewgain, tracing alone"),
           ("dense_dda", "dense arrays, hierarchical DDA"), ("embree_quads", "Embree, a mesh of the voxels"),
           ("openvdb_hdda", "OpenVDB VolumeHDDA"), ("openvdb_dda", "OpenVDB DDA"),
           ("octomap_cast_ray", "OctoMap castRay"), ("octomap_gain", "OctoMap, with a gain")]
POLICIES = [("combined", "gain: combined (default)", "#0b7a3b"), ("frontier", "most unknown voxels", "#1f4fe0"),
            ("random", "random", "#888888"), ("kriegel", "boundaries in order", "#e08000")]


def with_legend(picture, out, entries, columns):
    image = plt.imread(picture)
    image = image[int(0.06 * len(image)):int(0.94 * len(image))]  # the margins
    width, legend = 7.7, 0.85  # [inch]
    height = width * image.shape[0] / image.shape[1]
    figure, axes = plt.subplots(figsize=(width, height + legend), dpi=100)
    figure.subplots_adjust(0, legend / (height + legend), 1, 1)
    axes.imshow(image)
    axes.axis("off")
    marks = [Line2D([], [], linestyle="", marker=mark, color=color, markersize=8, label=label)
             for label, color, mark in entries]
    figure.legend(handles=marks, loc="lower center", ncol=columns, frameon=False, fontsize=9)
    figure.savefig(out)


def speed(result_file, out):
    with open(result_file, encoding="utf-8") as file:
        result = json.load(file)
    rates = {m["name"]: m["rays_per_second"] / 1e6 for m in result["methods"]}
    rows = [(label, rates[name], name) for name, label in METHODS if name in rates][::-1]
    figure, axes = plt.subplots(figsize=(8, 3.2), dpi=100, layout="constrained")
    colors = ["#0b7a3b" if name.startswith("viewgain") else "#9aa3ad" for _, _, name in rows]
    axes.barh([row[0] for row in rows], [row[1] for row in rows], color=colors)
    for i, (_, rate, _) in enumerate(rows):
        axes.annotate(f" {rate:.3g}", (rate, i), va="center", fontsize=9)
    axes.set_xscale("log")
    axes.set_xlim(0.1, 1000)
    axes.set_xlabel(f"million rays per second, {result['threads']} threads, {result['isa']}, {result['scene']['name']}"
                    if isinstance(result["scene"], dict) else
                    f"million rays per second, {result['threads']} threads, {result['isa']}, {result['scene']}")
    axes.spines[["top", "right"]].set_visible(False)
    figure.savefig(out)


def coverage(folder, out):
    shares = collections.defaultdict(lambda: collections.defaultdict(list))
    for name in sorted(glob.glob(os.path.join(folder, "*", "run.json"))):
        policy = os.path.basename(os.path.dirname(name)).split("-")[-2]
        with open(name, encoding="utf-8") as file:
            run = json.load(file)
        for view in run["per_view"]:
            shares[policy][view["index"] + 1].append(100 * view["coverage_visible"])
    figure, axes = plt.subplots(figsize=(8, 3.4), dpi=100, layout="constrained")
    for policy, label, color in POLICIES:
        views = sorted(shares[policy])
        axes.plot(views, [statistics.mean(shares[policy][v]) for v in views], color=color, label=label,
                  linewidth=2.2 if policy == "combined" else 1.4)
    runs = len(shares["combined"][1])
    axes.set_xlabel(f"views (means of {runs} runs each)")
    axes.set_ylabel("visible surface covered [%]")
    axes.set_xlim(1, 12)
    axes.set_ylim(20, 100)
    axes.grid(alpha=0.3)
    axes.legend(frameon=False)
    axes.spines[["top", "right"]].set_visible(False)
    figure.savefig(out)


def main():
    if len(sys.argv) != 4 or sys.argv[1] not in ("step", "idea", "speed", "coverage"):
        sys.exit(__doc__)
    what, source, out = sys.argv[1:]
    if what == "speed":
        speed(source, out)
    elif what == "coverage":
        coverage(source, out)
    else:
        with_legend(source, out, *((STEP, 3) if what == "step" else (IDEA, 2)))


if __name__ == "__main__":
    main()
