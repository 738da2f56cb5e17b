# SPDX-FileCopyrightText: 2026 The viewgain authors
# SPDX-License-Identifier: Apache-2.0
"""Files of poses and gains in columns, as viewgain/support/columns/part_head.hpp and apps/program/commands/score/score_part.cpp have them, so that
`viewgain merge` takes parts of both. For viewgain.distributed."""
from __future__ import annotations

import json
import os
import pathlib
import tempfile
from typing import TYPE_CHECKING, Any

import numpy as np

import viewgain

if TYPE_CHECKING:
    from numpy.typing import NDArray

_COLUMNS = [("index", "<i8"), ("gain", "<f8"), ("exploration", "<f8"), ("refinement", "<f8"), ("posterior_entropy", "<f8"),
            ("rays", "<u4"), ("hits", "<u4"), ("unknown_voxels", "<u4"), ("occupied_voxels", "<u4"), ("status", "u1")]
_AREA_COLUMNS = [("area", "<f8"), ("refinement_saturated", "<f8")]
_POSE_COLUMNS = ("tx", "ty", "tz", "qx", "qy", "qz", "qw")
_NUMBERS = ("refinement_weight", "support_plane", "prior_sigma", "min_range", "max_range")
SETTINGS = ("gain", "criterion", "pixel_stride", *_NUMBERS, "weights", "posterior_entropy")  # of GainEvaluator


def _mix64(x: NDArray[np.uint64]) -> NDArray[np.uint64]:
    with np.errstate(over="ignore"):
        x = x + np.uint64(0x9E3779B97F4A7C15)
        x = (x ^ (x >> np.uint64(30))) * np.uint64(0xBF58476D1CE4E5B9)
        x = (x ^ (x >> np.uint64(27))) * np.uint64(0x94D049BB133111EB)
    return x ^ (x >> np.uint64(31))


def hash_of_text(text: str) -> str:
    data = text.encode()
    state = _mix64(np.array([0x76696577, 0x6761696E], np.uint64) ^ np.uint64(len(data)))
    for byte in data:
        state = _mix64(state ^ np.uint64(byte))
    return "".join(f"{int(half):016x}" for half in state)


def hash_of_poses(poses: NDArray) -> str:
    count = min(len(poses), 4096)
    rows = [0] if count == 1 else [i * (len(poses) - 1) // (count - 1) for i in range(count)]
    picked = poses[rows]
    if picked.dtype.names:
        numbers = np.stack([picked[name] for name in _POSE_COLUMNS], axis=1)
    else:
        numbers = picked.reshape(count, 16)
    bits = np.ascontiguousarray(numbers, "<f8").view(np.uint64)
    hashes = np.zeros(count, np.uint64)
    for column in bits.T:
        hashes = _mix64(hashes ^ column)
    all_of_them = _mix64(np.array([len(poses)], np.uint64))
    for value in hashes:
        all_of_them = _mix64(all_of_them ^ value)
    return f"{int(all_of_them[0]):016x}"


def sensor_text(sensor: viewgain.Sensor) -> str:
    with tempfile.TemporaryDirectory() as folder:
        path = pathlib.Path(folder, "sensor.toml")
        sensor.save(path)
        return path.read_text(encoding="utf-8")


def settings_text(settings: dict[str, Any]) -> str:
    known = {"gain": settings.get("gain", "paper"), "semantics": "paper", "criterion": settings.get("criterion", "log_diagonal"),
             "stride": settings.get("pixel_stride", 1), "feasible": "off"}
    for name in _NUMBERS:
        if settings.get(name) is not None:
            known[name] = float(settings[name])
    if settings.get("weights"):
        # As --weight's words, which the program leaves as they were typed: each number as short as it can be.
        known["weight"] = [",".join(np.format_float_positional(number, trim="-") for number in (*np.ravel(box), weight))
                           for box, weight in settings["weights"]]
    return json.dumps(known, separators=(",", ":"))


def head_of(job: Any, poses: NDArray) -> str:
    return (f"# viewgain {viewgain.__version__}\n# map {job.map_hash}\n# sensor {job.sensor.name} {job.sensor_hash}\n"
            f"# settings {settings_text(job.settings)}\n# isa {job.isa}\n"
            f"# poses {len(poses)} {hash_of_poses(poses)}\n")


def write_part(path: pathlib.Path, rows: NDArray, head: str, begin: int) -> None:
    temporary = path.with_name(f".{path.stem}.tmp-{os.getpid()}-1.npy")
    try:
        with open(temporary, "wb") as file:
            np.save(file, rows)
            file.write(f"{head}# rows {begin}:{begin + len(rows)}\n# scored {len(rows)}\n".encode())
            file.flush()
            os.fsync(file.fileno())
        os.replace(temporary, path)
    finally:
        temporary.unlink(missing_ok=True)


def read_part(path: pathlib.Path, head: str, dtype: np.dtype) -> tuple[int, NDArray]:
    """First row and rows of a part that is there. Raises ValueError if it is not one of this job, or not whole."""
    def damaged(what: str) -> ValueError:
        return ValueError(f"{path}: {what}; delete it, and its rows are scored again")

    try:
        rows = np.lib.format.open_memmap(path, mode="r")
    except ValueError as error:
        raise damaged(f"is cut short or no part ({error})") from error
    with open(path, "rb") as file:
        file.seek(rows.offset + rows.nbytes)
        tail = file.read().decode(errors="replace")
    if len(tail) < len(head) and head.startswith(tail):
        raise damaged("is cut short or no part")
    if not tail.startswith(head) or rows.dtype != dtype:
        raise ValueError(f"{path}: is of another job (map, sensor, settings, version, ISA or poses); name a new folder")
    if rows.ndim != 1 or len(rows) == 0:
        raise damaged("holds no rows")
    begin = int(rows["index"][0])
    end = begin + len(rows)
    if tail[len(head):] != f"# rows {begin}:{end}\n# scored {len(rows)}\n" or \
            not np.array_equal(rows["index"], np.arange(begin, end)):
        raise damaged("its rows are not those that it says")
    if rows["status"].max() >= len(viewgain.VIEW_STATUS_NAMES):
        raise damaged(f"there is no status {rows['status'].max()}")
    return begin, rows


def matrices(poses: NDArray) -> NDArray[np.float64]:
    """(n, 4, 4) from rows with translation and quaternion, which are normalised, or as it is."""
    if not poses.dtype.names:
        return poses
    t, q = (np.stack([poses[name] for name in names], axis=1) for names in (_POSE_COLUMNS[:3], _POSE_COLUMNS[3:]))
    norms = np.linalg.norm(q, axis=1, keepdims=True)
    q = np.where(np.abs(norms - 1) <= 1e-2, q / norms, np.nan)  # a bad pose: its gain is NaN
    x, y, z, w = q.T
    matrices = np.zeros((len(q), 4, 4))
    matrices[:, 0, :3] = np.stack([1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)], axis=1)
    matrices[:, 1, :3] = np.stack([2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)], axis=1)
    matrices[:, 2, :3] = np.stack([2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)], axis=1)
    matrices[:, :3, 3], matrices[:, 3, 3] = t, 1
    return matrices


def dtype_of(settings: dict[str, Any]) -> np.dtype:
    return np.dtype(_COLUMNS if settings.get("gain", "paper") == "paper" else _COLUMNS + _AREA_COLUMNS)


class Best:
    """The best rows so far: by gain, ties to the lower row, NaN last."""

    def __init__(self, top: int, dtype: np.dtype) -> None:
        self._top, self.rows = top, np.empty(0, dtype)

    def add(self, rows: NDArray) -> None:
        all_rows = np.concatenate([self.rows, rows])
        gains = np.where(np.isnan(all_rows["gain"]), np.inf, -all_rows["gain"])
        order = np.lexsort((all_rows["index"], gains, np.isnan(all_rows["gain"])))
        self.rows = all_rows[order[:self._top]]


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
