# SPDX-FileCopyrightText: 2026 The viewgain authors
# SPDX-License-Identifier: Apache-2.0
"""The plots of a study. They need matplotlib."""
from __future__ import annotations

import io

import numpy as np

from .rows import mean_and_error, name_of, values_of


def _group(row):
    return row["sensor"], row["voxel"], row["size"]


def _title(group):
    sensor, voxel, size = group
    return f"{_label(sensor)}, voxels {1e3 * voxel:g} mm" + (f", {size:g} m" if size else "")


def _label(name):
    return ("\N{ZERO WIDTH SPACE}" if name.startswith("_") else "") + name.replace("$", r"\$")  # matplotlib parses $ and hides names with _


def _figure(groups, height):
    """One panel per group, four per row."""
    import matplotlib.figure  # not pyplot, which opens windows and keeps state

    columns = min(4, len(groups))
    lines = -(-len(groups) // columns)
    figure = matplotlib.figure.Figure(figsize=(2.5 + 6 * columns, height * lines), dpi=110 if lines < 10 else 50, layout="constrained")
    all_axes = figure.subplots(lines, columns, squeeze=False, sharey=True).ravel()
    for axes in all_axes[len(groups):]:
        axes.set_visible(False)
    for axes, group in zip(all_axes, groups):
        axes.set_title(_title(group), fontsize=9)
        axes.grid(alpha=0.3)
        axes.spines[["top", "right"]].set_visible(False)
    return figure, all_axes[:len(groups)]


def _png(figure):
    data = io.BytesIO()
    figure.savefig(data, format="png")
    return data.getvalue()


def coverage(rows: list[dict]) -> bytes:
    """A PNG of the mean coverage after each view, with standard errors as in the table. It has one line per policy, and one panel per sensor,
    voxel and size."""
    from matplotlib import colormaps

    groups, names = list(dict.fromkeys(map(_group, rows))), list(dict.fromkeys(map(name_of, rows)))
    figure, all_axes = _figure(groups, 4.2)
    for axes, group in zip(all_axes, groups):
        for i, name in enumerate(names):
            style = {"color": colormaps["tab20"](i % 20), "linestyle": ("-", "--", ":")[i // 20 % 3]}
            some = [row for row in rows if _group(row) == group and name_of(row) == name]
            objects = [row["object"] for row in some]
            points = np.array([mean_and_error(view, objects)[:2] for view in zip(*(row["coverage_by_view"] for row in some))]) * 100
            views, mean, error = range(1, len(points) + 1), points[:, 0], np.nan_to_num(points[:, 1])
            axes.plot(views, mean, label=_label(name), **style)
            axes.fill_between(views, mean - error, mean + error, alpha=0.15, linewidth=0, color=style["color"])
        axes.set_xlabel("views")
        axes.xaxis.get_major_locator().set_params(integer=True)
    all_axes[0].set_ylabel("visible surface covered [%], mean ± standard error")
    all_axes[min(3, len(groups) - 1)].legend(frameon=False, fontsize=8, loc="center left", bbox_to_anchor=(1, 0.5))
    return _png(figure)


def differences(rows: list[dict], against: str) -> bytes:
    """A PNG of the mean difference in AUC between each policy and the policy `against`, with standard errors as in the table."""
    groups = list(dict.fromkeys(map(_group, rows)))
    names = [name for name in dict.fromkeys(map(name_of, rows)) if name != against]
    figure, all_axes = _figure(groups, 1.2 + 0.28 * len(names))
    for axes, group in zip(all_axes, groups):
        some = [row for row in rows if _group(row) == group]
        other = values_of([row for row in some if name_of(row) == against], "auc")
        for i, name in enumerate(names):
            of = [row for row in some if name_of(row) == name]
            mean, error, _ = mean_and_error(values_of(of, "auc") - other, [row["object"] for row in of])
            axes.errorbar(mean, i, xerr=np.nan_to_num(error), fmt="o", color="tab:blue", capsize=3)
        axes.axvline(0, color="grey", linewidth=0.8)
        axes.set_xlabel(f"AUC minus that of {_label(against)}, mean ± standard error")
    all_axes[0].set_yticks(range(len(names)), map(_label, names))
    all_axes[0].set_ylim(len(names) - 0.5, -0.5)
    return _png(figure)
