# SPDX-FileCopyrightText: 2026 The viewgain authors
# SPDX-License-Identifier: Apache-2.0
"""Plots of poses, gains and maps with matplotlib, which is imported by the first call.

Each function draws into the matplotlib axes ``axes``, or by default into a new figure, and returns the axes. Call them from one
thread, because matplotlib's pyplot requires it.
"""
from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

if TYPE_CHECKING:
    from numpy.typing import ArrayLike

    from . import GainEvaluator


def _axes_of(axes: Any) -> Any:
    if axes is not None:
        return axes
    import matplotlib.pyplot as plt

    return plt.figure(layout="constrained").add_subplot()


def _image(axes: Any, image: np.ma.MaskedArray, label: str) -> Any:
    axes = _axes_of(axes)
    axes.figure.colorbar(axes.imshow(image, cmap="viridis"), ax=axes, label=label)
    axes.set_xlabel("u [px]")
    axes.set_ylabel("v [px]")
    return axes


def gains(T_world_camera: ArrayLike, values: ArrayLike, *, center: ArrayLike = (0.0, 0.0, 0.0),
          label: str = "expected gain [nat]", axes: Any = None) -> Any:
    """Plots the values of poses around a centre over azimuth and elevation. Marks the largest value. Omits poses with NaN.

    Parameters
    ----------
    T_world_camera : array_like, (n, 4, 4)
    values : array_like, (n,)
        For example the gains of the poses; NaN is allowed.
    center : array_like, (3,)
        Point from which azimuth and elevation are measured, world frame [m].
    label : str
        What the values are, with their unit.
    """
    poses, numbers = np.asarray(T_world_camera, float), np.asarray(values, float)
    if poses.ndim != 3 or poses.shape[1:] != (4, 4) or numbers.shape != poses.shape[:1]:
        raise ValueError(f"values has the shape {numbers.shape} and poses the shape {poses.shape}; expected one value per pose")
    known = np.isfinite(numbers)
    if not known.any():
        raise ValueError("none of the values is finite")
    x, y, z = (poses[known, :3, 3] - np.asarray(center, float)).T
    azimuth, elevation = np.degrees(np.arctan2(y, x)), np.degrees(np.arctan2(z, np.hypot(x, y)))
    axes = _axes_of(axes)
    drawn = axes.scatter(azimuth, elevation, c=numbers[known], s=12)
    best = int(np.argmax(numbers[known]))
    axes.plot(azimuth[best], elevation[best], "o", markersize=12, markerfacecolor="none", markeredgecolor="red", label="best")
    axes.figure.colorbar(drawn, ax=axes, label=label)
    axes.set_xlabel("azimuth [deg]")
    axes.set_ylabel("elevation [deg]")
    axes.legend(loc="upper right")
    return axes


def depth(image: ArrayLike, *, axes: Any = None) -> Any:
    """Plots a depth image. Pixels that are 0, infinite or NaN are white.

    Parameters
    ----------
    image : array_like, (height, width)
        Along the optical axis [m].
    """
    pixels = np.asarray(image, float)
    if pixels.ndim != 2:
        raise ValueError(f"a depth image must have two dimensions, not the shape {pixels.shape}")
    return _image(axes, np.ma.masked_where(~np.isfinite(pixels) | (pixels <= 0), pixels), "depth [m]")


def contributions(evaluator: GainEvaluator, T_world_camera: ArrayLike, *, axes: Any = None) -> Any:
    """Plots the contribution of each ray of a view to the gain. The gain of a voxel is divided equally among the rays that end in
    it.

    Cost: 4 times that of ``GainEvaluator.evaluate`` for the pose, and a Python step per ray.

    Parameters
    ----------
    evaluator : GainEvaluator
        Must have gain "paper", because with other gains a ray does not end in one voxel.
    T_world_camera : array_like, (4, 4)
    """
    if evaluator.gain != "paper":
        raise ValueError(f"contributions require the gain 'paper', not {evaluator.gain!r}, because only its rays each end in one voxel")
    hits = evaluator.trace(T_world_camera)
    shares = {tuple(row["voxel"]): row["gain"] / row["rays"] for row in evaluator.contributions(T_world_camera)}
    kinds, voxels = hits["kind"].ravel(), hits["voxel"].reshape(-1, 3)
    image = np.array([shares.get(tuple(voxel), 0.0) if kind in (1, 2) else np.nan for kind, voxel in zip(kinds, voxels)])
    image = image.reshape(hits.shape)
    return _image(axes, np.ma.masked_invalid(image), "gain of the ray [nat]")
