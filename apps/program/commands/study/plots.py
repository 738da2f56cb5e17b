#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The viewgain authors
# SPDX-License-Identifier: Apache-2.0
"""Draws the plots of a study: plots.py [DIR]

Reads results.json of the folder (its own unless given) and leaves there coverage.png, mean coverage by view. Needs
matplotlib.
"""

import collections
import json
import math
import os
import statistics
import sys

import matplotlib

matplotlib.use("agg")
import matplotlib.pyplot as plt


def name_of(run):
    return ":".join(part for part in (run["policy"], run["gain"]) if part)


def group_of(run):
    return run["sensor"], float(run["voxel"]), float(run["size"] or 0)


def mean_and_error(values):
    """Of pairs (object, value): the mean, and its standard error as in table.md, by object where there are several."""
    mean = statistics.fmean(value for _, value in values)
    one = len({of for of, _ in values}) == 1
    sums = collections.Counter()
    for i, (of, value) in enumerate(values):
        sums[i if one else of] += value - mean
    groups = len(sums)
    squares = math.fsum(s * s for s in sums.values())
    return mean, math.sqrt(groups / (groups - 1) * squares) / len(values) if groups > 1 else 0.0


def style(i):
    return {"color": plt.get_cmap("tab20")(i % 20), "linestyle": ("-", "--", ":")[i // 20 % 3]}


def coverage(runs, groups, names, path):
    figure, axes = plt.subplots(1, len(groups), figsize=(2.5 + 6 * len(groups), 4.2), dpi=110, squeeze=False,
                                sharey=True, layout="constrained")
    for one, group in zip(axes[0], groups):
        sensor, voxel, size = group
        one.set_title(f"{sensor}, voxels {1e3 * voxel:g} mm" + (f", {size:g} m" if size else ""), fontsize=9)
        for i, name in enumerate(names):
            curves = [[(run["object"], 100 * c) for c in run["coverage_by_view"]] for run in runs
                      if group_of(run) == group and name_of(run) == name]
            points = [mean_and_error(view) for view in zip(*curves)]
            views = range(1, len(points) + 1)
            one.plot(views, [m for m, _ in points], label=name, **style(i))
            one.fill_between(views, [m - e for m, e in points], [m + e for m, e in points], alpha=0.15, linewidth=0,
                             color=style(i)["color"])
        one.set_xlabel("views")
        one.xaxis.get_major_locator().set_params(integer=True)
        one.grid(alpha=0.3)
        one.spines[["top", "right"]].set_visible(False)
    axes[0][0].set_ylabel("visible surface covered [%], mean ± standard error")
    axes[0][-1].legend(frameon=False, fontsize=8, loc="center left", bbox_to_anchor=(1, 0.5))
    figure.savefig(path)


def main():
    if len(sys.argv) > 2 or sys.argv[1:] in (["-h"], ["--help"]):
        sys.exit(__doc__)
    folder = sys.argv[1] if len(sys.argv) == 2 else os.path.dirname(os.path.abspath(__file__))
    with open(os.path.join(folder, "results.json"), encoding="utf-8") as file:
        runs = json.load(file)
    groups = list(dict.fromkeys(map(group_of, runs)))
    names = list(dict.fromkeys(map(name_of, runs)))
    coverage(runs, groups, names, os.path.join(folder, "coverage.png"))


if __name__ == "__main__":
    main()
