# SPDX-FileCopyrightText: 2026 The viewgain authors
# SPDX-License-Identifier: Apache-2.0
"""Rows of poses and gains, for viewgain.distributed; files of them are read and written in C++."""
from __future__ import annotations

import os
from typing import TYPE_CHECKING, Any

import numpy as np

from ._viewgain import Error, _part_columns, _POSE_COLUMNS, _read_part

if TYPE_CHECKING:
    from numpy.typing import NDArray

SETTINGS = ("gain", "criterion", "pixel_stride", "refinement_weight", "support_plane", "prior_sigma", "min_range", "max_range",
            "weights", "posterior_entropy")  # of GainEvaluator and VoxelScene


def dtype_of(gain: str) -> np.dtype:
    return np.dtype(_part_columns(gain))


def rows_of(path: Any, head: str, gain: str) -> NDArray:
    """Of a part. Raises ValueError if it is not one of the job with this head, or not whole."""
    try:
        return np.frombuffer(_read_part(path, head, gain), dtype_of(gain))
    except Error as error:
        raise ValueError(f"{error}; delete it, and its rows are scored again") from error


def best_of(rows: NDArray, top: int) -> NDArray:
    """By gain, ties to the lower row, NaN last."""
    gains = np.where(np.isnan(rows["gain"]), np.inf, -rows["gain"])
    return rows[np.lexsort((rows["index"], gains, np.isnan(rows["gain"])))[:top]]


def poses_of(poses: Any) -> NDArray:
    if isinstance(poses, (str, os.PathLike)):
        poses = np.load(poses, mmap_mode="r")
    if getattr(poses, "dtype", None) is not None and poses.dtype.names:
        missing = [name for name in _POSE_COLUMNS if name not in poses.dtype.names]
        if missing or poses.ndim != 1:
            raise ValueError(f"rows of poses of the shape {poses.shape} without {', '.join(missing) or 'one dimension'}")
    else:
        poses = np.asanyarray(poses, float)
        if poses.ndim != 3 or poses.shape[1:] != (4, 4):
            raise ValueError(f"poses of the shape {poses.shape}: not (n, 4, 4)")
    if len(poses) == 0:
        raise ValueError("there is no pose")
    return poses


def gaps(done: list[tuple[int, int]], total: int) -> list[tuple[int, int]]:
    """Rows that are not there, as (begin, end)."""
    gaps, last = [], 0
    for begin, end in sorted(done) + [(total, total)]:
        if begin > last:
            gaps.append((last, begin))
        last = max(last, end)
    return gaps
