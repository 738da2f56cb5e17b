# SPDX-FileCopyrightText: 2026 The viewgain authors
# SPDX-License-Identifier: Apache-2.0
"""Minimum sets of views and best sets of k views, if it is known what each view sees.

`seen` is a boolean matrix with a row per view and a column per cell of the surface. `area` has the
weight of each cell, a positive number. Shares are shares of the total area. Integer programs are
solved by HiGHS (scipy.optimize.milp). If one runs out of time, the result has the best known set
and the bound that was proven.
"""
from typing import NamedTuple

import numpy as np
from scipy.optimize import Bounds, LinearConstraint, milp
from scipy.sparse import csr_matrix, hstack, identity

SLACK = 1e-9  # tolerance of shares, for sums in floating point


class Least(NamedTuple):
    """The minimum number of views that reach a share."""

    views: list  # indices of the smallest known set; None if all views together do not reach the share
    lp_bound: int  # lower bound on the size, from the linear program; 0 if all views together do not reach the share
    bound: int  # best lower bound; the set is optimal if this is its size


class Best(NamedTuple):
    """The best set of k views."""

    views: list
    share: float  # covered share
    bound: float  # upper bound on the share of any k views


def share_of(seen, area, views):
    """The share that these views cover together."""
    return float(area[seen[list(views)].any(axis=0)].sum() / area.sum()) if len(views) else 0.0


def greedy(seen, area, most=None):
    """Views in the order of their marginal gains, until none adds anything; ties go to the lower index."""
    left, views = area.astype(float).copy(), []
    while most is None or len(views) < most:
        added = seen @ left
        best = int(np.argmax(added))
        if added[best] <= SLACK * area.sum():
            break
        views.append(best)
        left[seen[best]] = 0
    return views


def _swapped(seen, area, views):
    """The set after swapping single views for as long as that covers more."""
    views = list(views)
    for _ in range(10):
        before = list(views)
        for at in range(len(views)):
            others = seen[views[:at] + views[at + 1:]].any(axis=0)
            added = seen @ np.where(others, 0, area)
            if added.max() > added[views[at]] + SLACK * area.sum():
                views[at] = int(np.argmax(added))
        if views == before:
            break
    return views


def _best_few(seen, area, k):
    """The best set of one view, or of at most two by trying all pairs."""
    alone = seen @ area
    if k == 1:
        return [int(np.argmax(alone))]
    together = alone[:, None] + alone - (seen * area) @ seen.T.astype(float)
    return sorted({int(i) for i in np.unravel_index(np.argmax(together), together.shape)})


def _solve(seen, area, cost, least, most, whole, seconds):
    """Minimises `cost` over x (views) and y (cells): a share of at least `least`, at most `most` views."""
    n, cells = seen.shape
    covers = hstack([csr_matrix(seen.T.astype(float)), -identity(cells)])
    sums = csr_matrix(np.stack([np.r_[np.zeros(n), area / area.sum()], np.r_[np.ones(n), np.zeros(cells)]]))
    limits = [LinearConstraint(covers, 0, np.inf), LinearConstraint(sums, [least - SLACK, 0], [np.inf, most])]
    integrality = np.r_[np.full(n, int(whole)), np.zeros(cells)]
    return milp(cost, constraints=limits, integrality=integrality, bounds=Bounds(0, 1), options={"time_limit": seconds})


def _chosen(seen, result):
    return [int(i) for i in np.flatnonzero(result.x[:len(seen)] > 0.5)]


def _with_first(seen, area, first):
    """The problem without a view: the cells that the view does not see, and the share that it covers."""
    rest = ~seen[first] if first is not None else np.ones(seen.shape[1], bool)
    return seen[:, rest], area[rest], 1 - float(area[rest].sum() / area.sum())


def least_views(seen, area, share, *, first=None, seconds=60.0):
    """The minimum set of views that covers a share. It contains `first`, if given."""
    if share_of(seen, area, range(len(seen))) < share - SLACK:
        return Least(None, 0, 0)
    start = [] if first is None else [first]
    rest, rest_area, has = _with_first(seen, area, first)
    if has >= share - SLACK:
        return Least(start, len(start), len(start))
    wanted = (share - has) / (1 - has)
    order = greedy(rest, rest_area)
    known = next(order[:k] for k in range(1, len(order) + 1) if share_of(rest, rest_area, order[:k]) >= wanted - SLACK)
    while len(known) > 1:
        fewer = _swapped(rest, rest_area, order[:len(known) - 1])
        if share_of(rest, rest_area, fewer) < wanted - SLACK:
            break
        known = fewer
    cost = np.r_[np.ones(len(rest)), np.zeros(len(rest_area))]
    relaxed = _solve(rest, rest_area, cost, wanted, len(rest), False, seconds)
    lp_bound = bound = max(1, int(np.ceil(relaxed.fun - 1e-6))) if relaxed.status == 0 else 1
    while 1 < len(known) <= 3 and bound < len(known):
        fewer = _best_few(rest, rest_area, len(known) - 1)
        if share_of(rest, rest_area, fewer) < wanted - SLACK:
            bound = len(known)
        else:
            known = fewer
    if bound < len(known):  # is there a smaller one?
        result = _solve(rest, rest_area, cost, wanted, len(known) - 1, True, seconds)
        if result.status == 2:
            bound = len(known)
        elif result.x is not None:
            known = _chosen(rest, result)
        if result.status in (0, 1) and result.mip_dual_bound is not None:
            bound = max(bound, int(np.ceil(min(result.mip_dual_bound, len(known)) - 1e-6)))
    return Least(start + known, len(start) + lp_bound, len(start) + bound)


def best_of(seen, area, k, *, first=None, seconds=60.0):
    """The set of at most k views that covers most. It contains `first`, if given."""
    start = [] if first is None else [first]
    rest, rest_area, has = _with_first(seen, area, first)
    k -= len(start)
    if k < 1 or not rest.any():
        return Best(start, share_of(seen, area, start), share_of(seen, area, start))
    if k <= 2:
        known = _best_few(rest, rest_area, k)
        share = share_of(seen, area, start + known)
        return Best(start + known, share, share)
    known = _swapped(rest, rest_area, greedy(rest, rest_area, k))
    cost = np.r_[np.zeros(len(rest)), -rest_area / rest_area.sum()]
    result = _solve(rest, rest_area, cost, 0, k, True, seconds)
    if result.x is not None:
        known = max(known, _chosen(rest, result), key=lambda views: share_of(rest, rest_area, views))
    bound = -result.mip_dual_bound if result.mip_dual_bound is not None else 1.0
    share = share_of(seen, area, start + known)
    return Best(start + known, share, max(share, min(1.0, has + (1 - has) * bound)))
