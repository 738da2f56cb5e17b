#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The viewgain authors
# SPDX-License-Identifier: Apache-2.0
"""Compares the runs that compare.sh has collected.

    compare_runs.py FOLDER

FOLDER has base.0.json, head.0.json, base.1.json and so on. Each file is the JSON of
`viewgain-bench trace` or `bars`. A ratio above 1 means that head is better: it is head / base if
larger is better, base / head if smaller is better.
"""
import json
import pathlib
import statistics
import sys

BAR = 0.95  # ratios of medians below this are marked


def figures(text):
    """{name: (value, is larger better)}; rates in Mrays/s."""
    data = json.loads(text)
    if isinstance(data, dict):
        return {m["name"]: (m["rays_per_second"] / 1e6, True) for m in data["methods"]}
    return {bar["name"]: (bar["value"], bar["better"] == "higher") for bar in data}


def quantile(values, share):
    ordered = sorted(values)
    place = share * (len(ordered) - 1)
    low = int(place)
    high = min(low + 1, len(ordered) - 1)
    return ordered[low] + (place - low) * (ordered[high] - ordered[low])


def main(folder):
    runs = sorted(int(path.name.split(".")[1]) for path in folder.glob("base.*.json"))
    base, head = ([figures((folder / f"{side}.{run}.json").read_text()) for run in runs] for side in ("base", "head"))
    print(f"medians of {len(runs)} alternating runs of each; ratio of the medians, 5 and 95 % quantiles of the runs' ratios; above 1, head is better")
    print(f"{'figure':<24} {'better':>7} {'base':>12} {'head':>12} {'ratio':>7} {'p05':>7} {'p95':>7}")
    for name in (name for name in base[0] if name in head[0]):
        is_higher_better = base[0][name][1]
        before, after = ([run[name][0] for run in side] for side in (base, head))

        def ratio(old, new):
            return new / old if is_higher_better else old / new

        each = [ratio(*pair) for pair in zip(before, after)]
        of_medians = ratio(statistics.median(before), statistics.median(after))
        print(f"{name:<24} {'higher' if is_higher_better else 'lower':>7} {statistics.median(before):>12.4g} "
              f"{statistics.median(after):>12.4g} {of_medians:>7.3f} {quantile(each, 0.05):>7.3f} {quantile(each, 0.95):>7.3f}"
              + (f"  under {BAR}" if of_medians < BAR else ""))
    for name in sorted(base[0].keys() ^ head[0].keys()):
        print(f"{name:<24} only in {'base' if name in base[0] else 'head'}")


if __name__ == "__main__":
    if len(sys.argv) != 2:
        sys.exit(__doc__)
    main(pathlib.Path(sys.argv[1]))
