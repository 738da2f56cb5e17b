#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The viewgain authors
# SPDX-License-Identifier: Apache-2.0
"""Prints the table of perf/run.sh in Markdown, from the JSON that it saved.

    run_table.py FOLDER

FOLDER holds trace.json, trace_256.json, trace_512.json, integrate.json, decision.json and bars.json,
as `viewgain-bench` printed them. The exit code is 1 if an answer of viewgain is wrong.
"""
import json
import pathlib
import sys

CANDIDATES = 500  # of the decision
LARGE_MAPS = ("trace_256", "trace_512")
WALK = "rays go far through unknown space"
# Rivals in trace.json: key, name, what it does, viewgain's row, bar of the ratio, why the bar is missed.
RIVALS = [
    ("octomap_gain", "OctoMap, entropy gain", "gain `paper` of a view", "viewgain_gain", 1000,
     "summing hits takes a third of a view's time"),
    ("embree_quads", "Embree, a quad per voxel face, tracing alone", "gain `paper` of a view", "viewgain_gain", 3, ""),
    ("embree_quads", "Embree, a quad per voxel face, tracing alone", "gain `combined` of a view", "viewgain_combined", 1.45, WALK),
    ("embree_quads", "Embree, a quad per voxel face", "first voxel of each ray", "viewgain_trace", None, ""),
    ("dense_dda", "dense DDA, ours", "first voxel of each ray", "viewgain_trace", 1.8,
     "dense arrays of this size fit into the cache"),
    ("tree64", "sparse tree of 4³ children, ours", "first voxel of each ray", "viewgain_trace", None, ""),
    ("nanovdb_hdda", "NanoVDB HDDA", "first voxel of each ray", "viewgain_trace", None, ""),
    ("openvdb_hdda", "OpenVDB VolumeHDDA", "first voxel of each ray", "viewgain_trace", None, ""),
    ("openvdb_dda", "OpenVDB DDA", "first voxel of each ray", "viewgain_trace", None, ""),
    ("octomap_cast_ray", "OctoMap castRay", "first voxel of each ray", "viewgain_trace", None, ""),
]
# The same for larger maps, whose bars are those of 256³ and 512³.
LARGE = [
    ("embree_quads", "Embree, a quad per voxel face, tracing alone", "gain `combined` of a view", "viewgain_combined", (2, 1.3), WALK),
    ("embree_quads", "Embree, a quad per voxel face", "first voxel of each ray", "viewgain_trace", (None, None), ""),
    ("dense_dda", "dense DDA, ours", "first voxel of each ray", "viewgain_trace", (1.35, 1.2), "every hit is in another voxel"),
]
# Figures of bars.json: key, what it is, unit, why the bar is missed.
PACKETS = "obstacles are traced in packets as wide as the instruction set"
FIGURES = [
    ("race_over_exhaustive", "`race` of 2,000 by `paper` / scoring all by `paper`", "time", WALK),
    ("stages_over_paper", "`race` of 2,000 by `surface` / scoring all by `paper`", "time", WALK),
    ("stages_over_paper_combined", "`race` of 2,000 by `combined` / scoring all by `paper`", "time", WALK),
    ("classic_over_paper", "ten gains of the literature / `paper`", "time", "they also walk through free space"),
    ("thread_scaling", "2 threads / 1, 200 poses", "speed", "waiting for the slower thread; other work on the machine"),
    ("latency_scaling", "2 threads / 1, one pose by `paper`", "time", "a pose takes half a millisecond, and waking a thread takes a part of it"),
    ("cost_512_over_128", "a pose at 512³ / at 128³", "time", "every hit is in another voxel"),
    ("update_over_build", "scene update / build, 512³", "time", ""),
    ("wall_over_free", "with / without a wall of 100 boxes", "speed", PACKETS),
    ("mesh_over_free", "with / without a mesh around", "speed", "one obstacle test per packet"),
    ("table_over_free", "with / without a table", "speed", PACKETS),
    ("lens_over_pinhole", "with / without a lens", "speed", ""),
    ("hazard_ms_128", "chance of surface in unknown voxels, 128³", "ms", "distances to free space are found for all unknown voxels"),
    ("hazard_ms_512", "chance of surface in unknown voxels, 512³", "ms", "distances to free space are found for all unknown voxels"),
    ("memory_mb", "memory of map and scene, 512³ after 8 views", "MB", ""),
    ("turn_ms", "frame to best view by `combined`, with surface and candidates", "ms", "the surface is rebuilt whole"),
    ("decision_ms_100", "frame to best of 100 by `paper`", "ms", ""),
    ("decision_ms_500", "frame to best of 500 by `paper`", "ms", ""),
    ("decision_ms_2000", "frame to best of 2,000 by `paper`", "ms", ""),
]


def short(value):
    """Three figures."""
    if value >= 1000:
        return f"{value:,.0f}"
    return f"{value:.3g}" if value >= 100 or value < .01 else f"{value:.{2 if value < 10 else 1}f}"


def verdict(is_met, reason):
    return "met" if is_met else f"**missed**: {reason}" if reason else "**missed**"


def rival_row(what, rival, theirs, ours, ratio, bar=None, reason=""):
    limit = "" if bar is None else f"≥ {bar:,}"
    said = "" if bar is None else verdict(ratio >= bar, reason)
    return [what, rival, theirs, ours, f"{short(ratio)} ×", limit, said]


def trace_rows(trace, rivals):
    rates = {method["name"]: method["rays_per_second"] / 1e6 for method in trace["methods"]}
    size = trace["scene"].split("-")[-1]
    return [rival_row(f"{what}, {size}³ [million rays/s]", name, short(rates[key]), short(rates[ours]),
                      rates[ours] / rates[key], bar, reason)
            for key, name, what, ours, bar, reason in rivals if key in rates]


def frame_row(integrate):
    ms = {name: entry["median"] for name, entry in integrate["milliseconds"].items()}
    theirs, ours = ms["octomap"], ms["viewgain_cones"]
    return rival_row("a frame into the map [ms]", "OctoMap, one thread", short(theirs), short(ours), theirs / ours, 100)


def decision_rows(decision):
    ms = {name: entry["median"] for name, entry in decision[0]["milliseconds"].items()}
    theirs = ms["octomap_integrate"] + CANDIDATES * ms["octomap_gain_of_a_view"]
    ours = ms["integrate"] + ms["scene"] + ms[f"paper {CANDIDATES}"]
    count, race = ms[f"surface_frontier_count {CANDIDATES}"], ms[f"combined {CANDIDATES} two stages"]
    return [rival_row(f"a frame to the best of {CANDIDATES} views by `paper` [ms]", "OctoMap, entropy gain, one thread",
                      short(theirs), short(ours), theirs / ours),
            rival_row(f"the best of {CANDIDATES} views by `race` with `combined` [ms]", "`surface_frontier_count`, ours", short(count),
                      short(race), count / race)]


def figure_rows(bars):
    by_name = {bar["name"]: bar for bar in bars}
    for key, what, unit, reason in FIGURES:
        if key not in by_name:
            continue
        bar = by_name[key]
        sign = "≥" if bar["better"] == "higher" else "≤"
        limit = "" if bar["bar"] is None else f"{sign} {bar['bar']:g}"
        wrong = "answers differ" if bar.get("note") in ("gains differ", "answers differ", "maps differ") else reason
        said = "" if bar["pass"] is None else verdict(bar["pass"], wrong)
        yield [f"{what} [{unit}]", "", "", short(bar["value"]), "", limit, said]


def main(folder):
    read = {path.stem: json.loads(path.read_text(encoding="utf-8")) for path in folder.glob("*.json")}
    trace, integrate = read["trace"], read["integrate"]
    versions = ", ".join(f"{name} {version}" for name, version in trace["versions"].items() if version)
    load = folder / "load.txt"
    before = f"; load before it {load.read_text(encoding='utf-8').strip()}" if load.exists() else ""
    print(f"{trace['cpu']}, {trace['threads']} threads, {trace['isa']}; {trace['compiler']}; {versions}; "
          f"viewgain {trace['commit']}{before}\n")
    print("| what | rival | its figure | viewgain | viewgain is faster by | bar | met, or why not |")
    print("|---|---|---|---|---|---|---|")
    rows = trace_rows(trace, RIVALS)
    for i, name in enumerate(LARGE_MAPS):
        rows += trace_rows(read[name], [(*rival, bars[i], reason) for *rival, bars, reason in LARGE])
    rows += [frame_row(integrate), *decision_rows(read["decision"]), *figure_rows(read["bars"])]
    for row in rows:
        print(f"| {' | '.join(row)} |")
    wrong = [name for name in ("trace", *LARGE_MAPS, "integrate") if not read[name]["agree"]]
    if wrong:
        print(f"\n**Wrong answers** of viewgain in {', '.join(wrong)}.")
    return 1 if wrong else 0


if __name__ == "__main__":
    if len(sys.argv) != 2:
        sys.exit(__doc__)
    sys.exit(main(pathlib.Path(sys.argv[1])))
