#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The viewgain authors
# SPDX-License-Identifier: Apache-2.0
"""Draws the plots of a study: plots.py [DIR]

Reads results.json and predictions.csv of the folder (its own unless given) and leaves there coverage.png (mean coverage
by view), and, where the study asked for predictions, prediction.png (rank correlation of scores with what candidates
bring) and calibration.png (promised against truly new surface). Needs matplotlib.
"""

import collections
import csv
import json
import math
import os
import statistics
import sys

import matplotlib

matplotlib.use("agg")
import matplotlib.pyplot as plt

BINS = 8  # of a calibration curve, of equal counts


def name_of(run):
    return ":".join(part for part in (run["policy"], run["gain"], run["semantics"]) if part)


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


def finish(figure, axes, path):
    for one in axes:
        one.grid(alpha=0.3)
        one.spines[["top", "right"]].set_visible(False)
    axes[-1].legend(frameon=False, fontsize=8, loc="center left", bbox_to_anchor=(1, 0.5))
    figure.savefig(path)
    plt.close(figure)


def panels(groups):
    figure, axes = plt.subplots(1, len(groups), figsize=(2.5 + 6 * len(groups), 4.2), dpi=110, squeeze=False,
                                sharey=True, layout="constrained")
    for one, (sensor, voxel, size) in zip(axes[0], groups):
        one.set_title(f"{sensor}, voxels {1e3 * voxel:g} mm" + (f", {size:g} m" if size else ""), fontsize=9)
    return figure, list(axes[0])


def coverage(runs, groups, names, path):
    figure, axes = panels(groups)
    for one, group in zip(axes, groups):
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
    axes[0].set_ylabel("visible surface covered [%], mean ± standard error")
    finish(figure, axes, path)


def prediction(runs, groups, names, path):
    figure, axes = panels(groups)
    for one, group in zip(axes, groups):
        for i, name in enumerate(names):
            values = collections.defaultdict(list)
            for run in runs:
                if group_of(run) == group and name_of(run) == name:
                    for entry in run["prediction"]:
                        if entry["spearman_area"] is not None:
                            values[entry["view"]].append((run["object"], entry["spearman_area"]))
            if values:
                points = [(view, *mean_and_error(v)) for view, v in sorted(values.items())]
                one.errorbar(*zip(*points), label=name, marker="o", markersize=3, capsize=2, **style(i))
        one.set_xlabel("after so many views")
        one.xaxis.get_major_locator().set_params(integer=True)
    axes[0].set_ylabel("Spearman: score and truly new surface")
    finish(figure, axes, path)


def calibration(rows, groups, names, path):
    figure, axes = panels(groups)
    most = 0.0
    for one, group in zip(axes, groups):
        for i, name in enumerate(names):
            pairs = sorted((1e4 * float(row["predicted_area"]), row["object"], 1e4 * float(row["new_area"])) for row in rows
                           if group_of(row) == group and name_of(row) == name and row["predicted_area"] != "nan")
            if len(pairs) < 2 * BINS:
                continue
            edges = [len(pairs) * k // BINS for k in range(BINS + 1)]
            bins = [pairs[a:b] for a, b in zip(edges, edges[1:])]
            points = [(statistics.fmean([p for p, *_ in b]), *mean_and_error([pair[1:] for pair in b])) for b in bins]
            one.errorbar(*zip(*points), label=name, marker="o", markersize=3, capsize=2, **style(i))
            most = max([most] + [max(p, t) for p, t, _ in points])
        one.set_xlabel("expected new surface [cm²]")
    for one in axes:
        one.plot([0, most], [0, most], color="#888888", linewidth=1, label="as promised")
    axes[0].set_ylabel("truly new surface [cm²], by eighths")
    finish(figure, axes, path)


def main():
    if len(sys.argv) > 2 or sys.argv[1:] in (["-h"], ["--help"]):
        sys.exit(__doc__)
    folder = sys.argv[1] if len(sys.argv) == 2 else os.path.dirname(os.path.abspath(__file__))
    with open(os.path.join(folder, "results.json"), encoding="utf-8") as file:
        runs = json.load(file)
    groups = list(dict.fromkeys(map(group_of, runs)))
    names = list(dict.fromkeys(map(name_of, runs)))
    coverage(runs, groups, names, os.path.join(folder, "coverage.png"))
    if not any(run["prediction"] for run in runs):
        return
    prediction(runs, groups, names, os.path.join(folder, "prediction.png"))
    with open(os.path.join(folder, "predictions.csv"), encoding="utf-8", newline="") as file:
        rows = list(csv.DictReader(file))
    if any(row["predicted_area"] != "nan" for row in rows):
        calibration(rows, groups, names, os.path.join(folder, "calibration.png"))


if __name__ == "__main__":
    main()
