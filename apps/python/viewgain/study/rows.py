# SPDX-FileCopyrightText: 2026 The viewgain authors
# SPDX-License-Identifier: Apache-2.0
"""The numbers of a run that a study compares, and the statistics in its tables."""
from __future__ import annotations

import collections
import math

import numpy as np

try:
    from scipy import stats
except ImportError as error:
    raise ImportError(f"viewgain.study needs scipy (Debian: python3-scipy), which cannot be imported: {error}") from error

GOALS = (0.80, 0.90, 0.95)  # coverages of the visible surface; the table has the number of views to reach each


class SpecError(ValueError):
    """A spec, or a file of a study, is invalid. The text names the file and what to do."""


def _number(value):
    return math.nan if value is None else float(value)


def _figure(value):
    """A finite number or null from run.json. Raises ValueError for any other value."""
    if value is None or (isinstance(value, (int, float)) and not isinstance(value, bool) and math.isfinite(value)):
        return value
    raise ValueError(f"{value!r} is not a finite number")


def row_of(run, record, max_views):
    """The row of ``results.json`` for a `Run`. `record` is the run's run.json as a dict. Raises LookupError, TypeError, ValueError or
    AttributeError if a value in it is missing or is not a number."""
    views = record["per_view"]
    covered = [float(_figure(view["coverage_visible"]) or 0.0) for view in views][:max_views]
    covered += [covered[-1]] * (max_views - len(covered))  # if the run ended early, the last coverage counts for the remaining views
    row = {"object": run.object.name, "policy": run.policy.policy, "gain": run.policy.gain, "seed": run.seed, "sensor": run.sensor,
           "voxel": run.voxel, "size": run.size, "views": int(record["views"]),
           "decisions": sum(view["generator"] not in ("start", "plan") for view in views), "stop_reason": str(record["stop_reason"])}
    to = [next((i + 1 for i, share in enumerate(covered) if share >= goal), None) for goal in GOALS]
    for goal, count in zip(GOALS, to):
        row[f"views_to_{100 * goal:.0f}"] = count
    for goal, count in zip(GOALS, to):  # if the goal was never reached, the whole path
        row[f"metres_to_{100 * goal:.0f}"] = _figure(views[min(count or len(views), len(views)) - 1]["travelled"])
    row["auc"], row["coverage_visible"] = float(np.mean(covered)), covered[-1]
    for key in ("coverage", "rms_error", "consistency", "outliers", "travelled"):
        row[key] = _figure(record[key])
    # A run with one view made no decision, and a custom program does not report durations of stages.
    stages = [_figure(record["seconds"].get(stage)) for stage in ("candidates", "score")]
    deciding = sum(stage or 0 for stage in stages) / (row["views"] - 1) if row["views"] > 1 and stages != [None, None] else None
    return {**row, "coverage_by_view": covered, "hash": run.hash, "deciding_seconds": deciding, "seconds": _figure(record["seconds"]["total"])}


def name_of(row):
    """The name of a row's policy, as in a spec."""
    return f"{row['policy']}:{row['gain']}" if row["gain"] else row["policy"]


def early_ends(rows, max_views) -> list[str]:
    """One line for each policy with runs that ended before max_views."""
    lines = []
    for name in dict.fromkeys(map(name_of, rows)):
        of = [row for row in rows if name_of(row) == name]
        reasons = collections.Counter(row["stop_reason"] for row in of if row["views"] < max_views)
        if reasons:
            lines.append(f"{sum(reasons.values())} of {len(of)} runs of {name} ended before {max_views} views "
                         f"({', '.join(f'{reason} {count}' for reason, count in reasons.items())}); for the remaining views, their last coverage counts")
    return lines


def values_of(rows, key, factor=1.0):
    """A column of the rows as floats, times `factor`. null becomes NaN."""
    return np.array([factor * _number(row[key]) for row in rows])


def counted_views(rows, goal, max_views):
    """The number of views that each run needed to reach a goal; max_views + 1 if it never did."""
    return np.array([row[f"views_to_{100 * goal:.0f}"] or max_views + 1 for row in rows], float)


def mean_and_error(values, clusters):
    """Mean, standard error and number of the values that are not NaN. `clusters` has the object of each value. If there are several, the error
    is clustered (CR1 of Cameron and Miller, J. Human Resources 50, 2015), because runs on one object are not independent."""
    values = np.asarray(values, float)
    kept = np.isfinite(values)
    n = int(kept.sum())
    if n == 0:
        return math.nan, math.nan, 0
    mean = math.fsum(values[kept]) / n
    several = len(set(clusters)) > 1
    sums = collections.defaultdict(float)
    for i in np.flatnonzero(kept):
        sums[clusters[i] if several else i] += values[i] - mean
    groups = len(sums)
    error = math.sqrt(groups / (groups - 1) * math.fsum(s * s for s in sums.values())) / n if groups > 1 else math.nan
    return mean, error, n


def half_interval(values, clusters):
    """Half the 95 % interval of the mean, for other seeds on the same objects. Uses Student's t with n - G degrees of freedom for n values and G
    clusters. NaN if n = G."""
    groups = collections.defaultdict(list)
    for value, cluster in zip(values, clusters):
        if math.isfinite(value):
            groups[cluster].append(value)
    n = sum(map(len, groups.values()))
    freedom = n - len(groups)
    if freedom == 0:
        return math.nan
    squares = math.fsum(float(np.sum((np.array(group) - np.mean(group)) ** 2)) for group in groups.values())
    return float(stats.t.ppf(0.975, freedom)) * math.sqrt(squares / (freedom * n))


def sign_test(differences):
    """Two-sided p of the exact sign test. Ignores differences that are 0 or NaN. 1 if none is left."""
    d = np.asarray(differences, float)
    d = d[np.isfinite(d) & (d != 0)]
    return stats.binomtest(int((d > 0).sum()), len(d)).pvalue if len(d) else 1.0


def signed_rank_test(differences):
    """Two-sided p of Wilcoxon's signed-rank test. Ignores differences that are 0 or NaN. Ties get their mean rank. Exact for up to 50
    differences without ties, and up to 13 with ties. Otherwise uses the normal distribution, with the variance for ties and without continuity
    correction."""
    d = np.asarray(differences, float)
    d = d[np.isfinite(d) & (d != 0)]
    if len(d) == 0:
        return 1.0
    has_ties = len(np.unique(np.abs(d))) < len(d)
    if has_ties and len(d) <= 13:
        ranks = stats.rankdata(np.abs(d))
        return float(stats.permutation_test((np.sign(d) * ranks,), lambda x, axis: np.sum(x, axis=axis), permutation_type="samples",
                                            vectorized=True, n_resamples=np.inf).pvalue)
    return float(stats.wilcoxon(d, method="exact" if len(d) <= 50 and not has_ties else "approx", correction=False).pvalue)
