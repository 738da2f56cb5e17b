# SPDX-FileCopyrightText: 2026 The viewgain authors
# SPDX-License-Identifier: Apache-2.0
"""The results of a study as Markdown tables."""
from __future__ import annotations

import itertools
import math

import numpy as np

from . import rows as of_rows
from .rows import GOALS, counted_views, half_interval, mean_and_error, name_of, values_of


def _fixed(value, digits):
    return f"{value:.{digits}f}" if math.isfinite(value) else "-"


def _short(value):
    return f"{value:.12g}"


def _line(cells):
    return "|" + "".join(f" {cell} |" for cell in cells) + "\n"


def _head(cells):
    return _line(cells) + "|" + "---|" * len(cells) + "\n"


def _objects(rows):
    return [row["object"] for row in rows]


def _mean(values, digits):
    return _fixed(mean_and_error(values, range(len(values)))[0], digits)


def _with_interval(rows, values, digits):
    half = half_interval(values, _objects(rows))
    return _mean(values, digits) + ("" if math.isnan(half) else f" ± {_fixed(half, digits)}")


def _never(rows, goal):
    return sum(row[f"views_to_{100 * goal:.0f}"] is None for row in rows)


def _counts(rows, goal, max_views):
    """"mean / median / number of runs that never reached the goal; mean path". In the median, runs that never reached the goal rank above all
    others. They make the mean a lower bound, which has no interval."""
    never = _never(rows, goal)
    if never == len(rows):
        return "-"
    views = counted_views(rows, goal, max_views)
    mean = f"≥ {_mean(views, 2)}" if never else _with_interval(rows, views, 2)
    median = float(np.median([row[f"views_to_{100 * goal:.0f}"] or math.inf for row in rows]))
    return (f"{mean} / {'never' if math.isinf(median) else _fixed(median, 1)} / {never}; "
            f"{_mean(values_of(rows, f'metres_to_{100 * goal:.0f}'), 2)} m")


def _means(groups, max_views):
    text = _head(["policy", "to 80 % ↓", "to 90 % ↓", "to 95 % ↓", "AUC ↑", "final coverage ↑", "RMS [mm] ↓", "consistency →1", "path [m] ↓",
                  "decisions", "s per view", "time [s] ↓"])
    for name, rows in groups.items():
        cells = [name, *(_counts(rows, goal, max_views) for goal in GOALS)]
        cells.append(_with_interval(rows, values_of(rows, "auc"), 3))
        cells.append(_with_interval(rows, values_of(rows, "coverage_visible", 100), 1) + " %")
        cells.append(_with_interval(rows, values_of(rows, "rms_error", 1e3), 2))
        cells.append(_with_interval(rows, values_of(rows, "consistency"), 2))
        cells.append(_with_interval(rows, values_of(rows, "travelled"), 1))
        cells += [_mean(values_of(rows, key), digits) for key, digits in (("decisions", 1), ("deciding_seconds", 2), ("seconds", 1))]
        text += _line(cells)
    return text


def _probability(p):
    return "<0.001" if p < 0.001 else _fixed(p, 3)


def _difference(rows, a, b, digits, more_is_better):
    """Text "mean difference ± standard error (wins-ties-losses; p of both tests)". `a` and `b` have the same runs in the same order."""
    d = a - b
    mean, error, count = mean_and_error(d, _objects(rows))
    if count == 0:
        return "-"
    better = d if more_is_better else -d
    return (f"{_fixed(mean, digits)} ± {_fixed(error, digits)} ({(better > 0).sum()}-{(d == 0).sum()}-{(better < 0).sum()}; "
            f"{_probability(of_rows.sign_test(d))}, {_probability(of_rows.signed_rank_test(d))})")


def _pairs(groups, against, max_views):
    if len(groups) < 2:
        return ""
    other = groups[against]
    text = (f"\nDifferences to {against}, paired by object and seed: mean ± standard error (wins-ties-losses; p of the sign test, p of "
            f"Wilcoxon's signed-rank test). The smallest possible p with {len(other)} pairs is {_probability(min(1.0, 2.0 ** (1 - len(other))))}. "
            "The path to 95 % is compared for pairs in which both runs got there.\n\n" +
            _head(["policy", "to 80 % ↓", "to 90 % ↓", "to 95 % ↓", "path to 95 % [m] ↓", "AUC ↑", "RMS [mm] ↓"]))
    last = f"{100 * GOALS[-1]:.0f}"
    for name, rows in groups.items():
        if name == against:
            continue
        cells = [name]
        for goal in GOALS:
            is_reached = _never(rows, goal) + _never(other, goal) < len(rows) + len(other)
            cells.append(_difference(rows, counted_views(rows, goal, max_views), counted_views(other, goal, max_views), 2, False)
                         if is_reached else "-")
        ways = [np.where([row[f"views_to_{last}"] is None for row in some], np.nan, values_of(some, f"metres_to_{last}"))
                for some in (rows, other)]
        cells.append(_difference(rows, *ways, 2, False))
        cells.append(_difference(rows, values_of(rows, "auc"), values_of(other, "auc"), 3, True))
        cells.append(_difference(rows, values_of(rows, "rms_error", 1e3), values_of(other, "rms_error", 1e3), 2, False))
        text += _line(cells)
    return text


def _by_object(groups, objects):
    if len(objects) < 2:
        return ""
    text = "\nAUC and path length [m] per object\n\n" + _head(["policy", *objects])
    for name, rows in groups.items():
        of = [[row for row in rows if row["object"] == one] for one in objects]
        text += _line([name, *(f"{_mean(values_of(some, 'auc'), 3)}; {_mean(values_of(some, 'travelled'), 1)}" for some in of)])
    return text


def _introduction(rows, objects, max_views, tolerance):
    if len(objects) > 1:
        of_two = " With two objects, it only shows how alike these two are." if len(objects) == 2 else ""
        errors = ("standard error, computed per object because runs on one object are not independent." + of_two +
                  " p treats runs as independent; it holds for these objects only.\n")
    else:
        errors = "standard error over the runs on this object. It does not hold for other objects.\n"
    return (
        f"{len(rows)} runs: {', '.join(objects)}; {len({row['seed'] for row in rows})} seeds; {max_views} views.\n\n"
        "- ↓: less is better. ↑: more is better.\n"
        f"- to 80, 90, 95 %: number of views until this share of the visible surface is covered within {_short(1e3 * tolerance)} mm. "
        "A cell has the mean, the median, the number of runs that never got there, and the mean path length until then.\n"
        f"- A run that never got there counts as {max_views + 1} views in means and differences, and with its whole path. "
        "≥ marks means with such runs, which are lower bounds.\n"
        "- AUC: mean coverage over the views. final coverage: coverage after the last view.\n"
        "- RMS: error of the reconstructed surface. It may be low because difficult places are missing.\n"
        "- consistency: mean squared error of the points divided by their variances. 1 is ideal; above 1, the variances are too small.\n"
        "- decisions: number of times that views were ranked; a plan counts once. s per view: time to generate candidates and choose one.\n"
        "- A cell is - if no run got there, or if there is nothing to compute.\n"
        "- ± of a policy's mean: half of a 95 % interval (Student's t) for other seeds on the same objects. It is wide with fewer than "
        "about 5 seeds.\n"
        f"- ± of a difference: {errors}")


def table(rows: list[dict], against: str, max_views: int, tolerance: float) -> str:
    """The tables for the rows from `make_runs`. For each sensor, voxel and size there are means of the policies, paired differences to the
    policy `against`, and results per object. `tolerance` [m] is that of coverage."""
    objects, policies = list(dict.fromkeys(_objects(rows))), list(dict.fromkeys(map(name_of, rows)))
    text = _introduction(rows, objects, max_views, tolerance)
    for (sensor, voxel, size), some in itertools.groupby(rows, lambda row: (row["sensor"], row["voxel"], row["size"])):
        some = list(some)
        groups = {name: [row for row in some if name_of(row) == name] for name in policies}
        text += f"\n## {sensor}, voxels of {_short(1e3 * voxel)} mm" + (f", objects of {_short(size)} m" if size is not None else "")
        text += "\n\n" + _means(groups, max_views) + _pairs(groups, against, max_views) + _by_object(groups, objects)
    return text
