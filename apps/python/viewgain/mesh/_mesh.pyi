# SPDX-FileCopyrightText: 2026 The viewgain authors
# SPDX-License-Identifier: GPL-3.0-or-later
import os
from collections.abc import Callable, Sequence
from typing import Any, Literal, Union

import numpy as np
from numpy.typing import ArrayLike, NDArray

from .. import BatchControl, BeliefGrid, ReachRegion, Sensor
from .results import BoundaryCandidates, ViewRecord

_Path = Union[str, bytes, "os.PathLike[str]"]

BOUNDARY_CLASS_NAMES: tuple[str, ...]

class Surface:
    @property
    def vertices(self) -> NDArray[np.float64]: ...
    @property
    def normals(self) -> NDArray[np.float64]: ...
    @property
    def triangles(self) -> NDArray[np.uint32]: ...
    @property
    def source(self) -> NDArray[np.uint32]: ...
    def save(self, path: _Path) -> None: ...
    def to_bytes(self) -> bytes: ...
    @staticmethod
    def from_bytes(data: bytes) -> Surface: ...
    def to_trimesh(self) -> Any: ...
    def to_open3d(self) -> Any: ...

def reconstruct_surface(
    points: ArrayLike,
    toward_free: ArrayLike | None = None,
    *,
    spacing: float,
    smoothing_neighbors: int = ...,
    max_edge: float = ...,
    join_distance: float = ...,
    min_component: int = ...,
    num_threads: int = 0,
) -> Surface: ...
def surface_of_grid(grid: BeliefGrid, *, min_hits: int = 2, num_threads: int = 0) -> Surface: ...
def boundary_candidates(
    surface: Surface,
    views: ArrayLike,
    sensor: Sensor,
    *,
    spacing: float,
    working_distance: float | None = None,
    overlap: float | None = None,
    distances: Sequence[float] | None = None,
    tilts: Sequence[float] | None = None,
    rolls: Sequence[float] | None = None,
) -> BoundaryCandidates: ...

class Reconstruction:
    @property
    def reason(self) -> str: ...
    @property
    def views(self) -> list[ViewRecord]: ...
    @property
    def grid(self) -> BeliefGrid: ...
    @property
    def surface(self) -> Surface: ...

def reconstruct(
    acquire: Callable[[NDArray[np.float64]], Any],
    sensor: Sensor,
    start: ArrayLike,
    *,
    voxel_size: float,
    workspace: ArrayLike,
    criterion: Literal["log_diagonal", "log_determinant", "trace"] = "log_diagonal",
    policy: Literal["gain", "kriegel", "random", "frontier", "proximity", "sequence"] = "gain",
    gain: Literal["combined", "surface", "paper"] = "combined",
    boundary: bool | None = None,
    candidates: ArrayLike | None = None,
    reach: ReachRegion | None = None,
    support_plane: float | None = None,
    jump_edges: bool = True,
    max_views: int = 20,
    stop_gain: float | None = None,
    stop_area: float | None = None,
    idle_views: int = 3,
    observer: Callable[[ViewRecord], object] | None = None,
    control: BatchControl | None = None,
    num_threads: int = 0,
) -> Reconstruction: ...
