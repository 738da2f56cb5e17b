#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The viewgain authors
# SPDX-License-Identifier: Apache-2.0
"""Draws the READMEs' pictures from what the programs left: draw.py WHAT INPUT PICTURE.png

    step, idea   a picture of the program and a legend beside it
    speed        the JSON of `viewgain-bench trace`
    coverage     the results.json of a study

make_pictures.sh calls it. Needs matplotlib.
"""

import collections
import json
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
POLICIES = [("gain:combined", "gain: combined (default)", "#0b7a3b"), ("gain:paper", "gain: the paper's", "#e08000"),
            ("gain:surface_frontier_count", "surface_frontier_count (MCMF, GMC)", "#7a3fb5"),
            ("frontier", "most unknown voxels", "#1f4fe0"), ("random", "random", "#d81b8a"),
            ("oracle", "knows the object", "#111111")]


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


def coverage(results_file, out):
    """Mean coverage by view of a study: some policies by name, the others in grey."""
    with open(results_file, encoding="utf-8") as file:
        results = json.load(file)
    curves = collections.defaultdict(list)
    for run in results:
        name = ":".join(part for part in (run["policy"], run["gain"]) if part)
        curves[name].append([100 * share for share in run["coverage_by_view"]])
    means = {name: [statistics.fmean(view) for view in zip(*runs)] for name, runs in curves.items()}
    views = range(1, len(next(iter(means.values()))) + 1)
    named = {name: (label, color) for name, label, color in POLICIES if name in means}
    figure, axes = plt.subplots(figsize=(8, 3.8), dpi=100, layout="constrained")
    others = [mean for name, mean in means.items() if name not in named]
    for i, mean in enumerate(others):
        axes.plot(views, mean, color="#b8bec5", linewidth=1, label=f"{len(others)} others" if i == 0 else None)
    for name, (label, color) in named.items():
        axes.plot(views, means[name], color=color, linewidth=2, label=label)
    axes.set_xlabel(f"views (means of {min(map(len, curves.values()))} runs each)")
    axes.set_ylabel("visible surface covered [%]")
    axes.set_xlim(1, views[-1])
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
