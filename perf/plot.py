#!/usr/bin/env python3
"""Plots the output of `viewgain-bench scaling --json`, `bars --json` or `approximate --json`.

    viewgain-bench scaling --json > scaling.json
    perf/plot.py scaling.json scaling.png

    scaling        rays per second by map size, for each number of rays and threads; bars: 5 to 95 %
    bars           each figure divided by its bar; 1 or better passes
    approximate    rank correlation with the full gains, by speed

Needs matplotlib (Debian: python3-matplotlib).
"""
import argparse
import json
import sys


def plot_scaling(axes, result):
    groups = {}
    for case in result["cases"]:
        groups.setdefault((case["rays_per_pose"], case["threads"]), []).append(case)
    for (rays, threads), cases in sorted(groups.items()):
        sides = [int(case["scene"].split("-")[1]) for case in cases]
        rate = {k: [case["rays_per_second"][k] / 1e6 for case in cases]
                for k in ("median", "p05", "p95")}
        below = [m - low for m, low in zip(rate["median"], rate["p05"])]
        above = [high - m for m, high in zip(rate["median"], rate["p95"])]
        label = f"{rays:,} rays per pose, {threads} thread{'s' if threads > 1 else ''}"
        axes.errorbar(sides, rate["median"], yerr=[below, above], marker="o", capsize=3,
                      label=label)
    sides = sorted({int(case["scene"].split("-")[1]) for case in result["cases"]})
    axes.set_xscale("log", base=2)
    axes.set_xticks(sides, [f"{n}³" for n in sides])
    axes.set_ylim(bottom=0)
    axes.set_xlabel("voxels of the camel's map")
    axes.set_ylabel("full gain, million rays per second")
    axes.set_title(f"{result['cpu']}, {result['isa']}, {result['commit']}", fontsize="small")
    axes.legend(fontsize="small")


def plot_bars(axes, result):
    rows = [row for row in result if row["bar"] is not None][::-1]
    shares = [row["value"] / row["bar"] if row["better"] == "higher" else row["bar"] / row["value"]
              for row in rows]
    colors = ["tab:green" if row["pass"] else "tab:red" for row in rows]
    axes.barh([row["name"] for row in rows], shares, color=colors)
    for i, (row, share) in enumerate(zip(rows, shares)):
        sign = "≥" if row["better"] == "higher" else "≤"
        axes.annotate(f" {row['value']:.3g} ({sign} {row['bar']:g})", (share, i), va="center",
                      fontsize="small")
    axes.axvline(1, color="black", linewidth=1)
    axes.set_xscale("log")
    axes.set_xlim(0.5 * min(shares + [1]), 4 * max(shares + [1]))
    axes.set_xlabel("share of the bar; from 1 on it is met")
    if rows:
        axes.set_title(f"{rows[0]['isa']}, {rows[0]['threads']} threads", fontsize="small")


def plot_approximate(axes, result):
    for kind, label in (("stride", "pixel stride"), ("share", "approximate: a lattice of rays")):
        ways = [way for way in result["ways"] if way["kind"] == kind]
        axes.plot([way["speed_over_full"] for way in ways],
                  [1 - way["rank_correlation"] for way in ways], marker="o", label=label)
        for way in ways:
            text = (f"{way['parameter']:g}" if kind == "stride"
                    else f"{100 * way['parameter']:g} %")
            axes.annotate(text, (way["speed_over_full"], 1 - way["rank_correlation"]),
                          textcoords="offset points", xytext=(5, 5), fontsize="small")
    axes.set_xscale("log")
    axes.set_yscale("log")
    axes.invert_yaxis()
    axes.set_xlabel("speed, times that of scoring in full")
    axes.set_ylabel("1 − rank correlation with the full gains (up is better)")
    axes.set_title(f"{result['scene']}, {result['poses']:,} views, {result['cpu']}, "
                   f"{result['isa']}", fontsize="small")
    axes.legend(fontsize="small")


def main():
    parser = argparse.ArgumentParser(description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("json", help="output of scaling, bars or approximate")
    parser.add_argument("png", help="picture to write")
    arguments = parser.parse_args()
    try:
        with open(arguments.json, encoding="utf-8") as file:
            result = json.load(file)
    except (OSError, ValueError) as error:
        sys.exit(f"plot.py: {arguments.json}: {error}")
    if isinstance(result, list):
        plot = plot_bars
    elif "cases" in result:
        plot = plot_scaling
    elif "ways" in result:
        plot = plot_approximate
    else:
        sys.exit(f"plot.py: {arguments.json}: expected the JSON of `scaling`, `bars` or `approximate`")
    try:
        import matplotlib
    except ImportError:
        sys.exit("plot.py: matplotlib is missing: install python3-matplotlib")
    matplotlib.use("Agg")
    import matplotlib.pyplot

    figure, axes = matplotlib.pyplot.subplots(figsize=(8, 5))
    plot(axes, result)
    figure.tight_layout()
    figure.savefig(arguments.png, dpi=150)


if __name__ == "__main__":
    main()
