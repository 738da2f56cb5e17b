#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The viewgain authors
# SPDX-License-Identifier: Apache-2.0
"""Prints N directions whose minimum angle is as large as possible (Tammes' problem), one per line.

    tammes.py N

Linear programs improve random starts. In each, the points move little enough that the angles
between neighbours change linearly, and the largest cosine falls. The best of all starts is
returned. The result is deterministic for a seed.
"""
import sys

import numpy as np
from scipy.optimize import linprog
from scipy.sparse import csr_matrix


def least_angle(points):
    """The minimum angle between any two unit vectors [deg]."""
    return float(np.degrees(2 * np.arcsin(min(1.0, _distances(points).min() / 2))))


def _distances(points):
    a, b = np.triu_indices(len(points), 1)
    return np.linalg.norm(points[a] - points[b], axis=1)


def _moved(points, reach):
    """The points after a linear program has moved each by at most `reach` along two tangents."""
    n = len(points)
    side = np.eye(3)[np.argmin(np.abs(points), axis=1)]
    first = np.cross(points, side)
    first /= np.linalg.norm(first, axis=1)[:, None]
    tangents = np.stack([first, np.cross(points, first)], axis=1)  # (n, 2, 3)
    a, b = np.triu_indices(n, 1)
    cosine = (points[a] * points[b]).sum(axis=1)
    angle = np.arccos(np.clip(cosine, -1, 1))
    near = angle <= angle.min() + 3 * reach
    a, b, cosine = a[near], b[near], cosine[near]
    row = np.arange(len(a))
    slope = lambda i, j: np.einsum("pkc,pc->pk", tangents[i], points[j])
    values = np.concatenate([slope(a, b).ravel(), slope(b, a).ravel(), -np.ones(len(a))])
    columns = np.concatenate([(2 * a[:, None] + [0, 1]).ravel(), (2 * b[:, None] + [0, 1]).ravel(), np.full(len(a), 2 * n)])
    rows = np.concatenate([np.repeat(row, 2), np.repeat(row, 2), row])
    found = linprog(np.r_[np.zeros(2 * n), 1], A_ub=csr_matrix((values, (rows, columns))), b_ub=-cosine,
                    bounds=[(-reach, reach)] * (2 * n) + [(-1, 1)], method="highs")
    if found.x is None:
        return points
    moved = points + np.einsum("nk,nkc->nc", found.x[:-1].reshape(n, 2), tangents)
    return moved / np.linalg.norm(moved, axis=1)[:, None]


def tammes(count, *, starts=None, seed=1):
    """Unit vectors, (count, 3). Takes seconds for 128 and half a minute for 360."""
    if count < 2:
        raise ValueError(f"{count} directions have no angle; at least 2")
    random = np.random.default_rng(seed)
    best = None
    for _ in range(starts or max(1, min(20, 200 // count))):
        points = random.normal(size=(count, 3))
        points /= np.linalg.norm(points, axis=1)[:, None]
        least, reach = _distances(points).min(), 1 / np.sqrt(count)
        while reach > 1e-6:
            moved = _moved(points, reach)
            new = _distances(moved).min()
            if new > least * (1 + 1e-7):
                points, least = moved, new
            else:
                reach /= 2
        if best is None or least > _distances(best).min():
            best = points
    return best


if __name__ == "__main__":
    if len(sys.argv) != 2 or not sys.argv[1].isdigit() or int(sys.argv[1]) < 2:
        sys.exit(__doc__)
    for direction in tammes(int(sys.argv[1])):
        print(*(f"{value:.15g}" for value in direction))
