# SPDX-FileCopyrightText: 2026 The viewgain authors
# SPDX-License-Identifier: Apache-2.0
import os
from collections.abc import Callable, Iterable, Iterator, Sequence
from typing import Any, Literal, Union, overload

import numpy as np
from numpy.typing import ArrayLike, NDArray

from .results import (
    AddedView,
    ChosenViews,
    Cloud,
    Frame,
    FrameRegistration,
    GridStatistics,
    IntegrationReport,
    Proposal,
    Ranking,
    Sigmas,
    SimulatedFrame,
    TimedPoses,
)

__version__: str

_Path = Union[str, bytes, "os.PathLike[str]"]
_Criterion = Literal["log_diagonal", "log_determinant", "trace"]
_Floats = NDArray[np.float64]
_Indices = NDArray[np.int64]
_Rows = NDArray[np.void]
# A single pose gives a scalar, more of them an array.
_FloatOrFloats = Union[np.float64, NDArray[np.float64]]
_RowOrRows = Union[np.void, NDArray[np.void]]
_BoolOrBools = Union[np.bool_, NDArray[np.bool_]]
_CodeOrCodes = Union[np.uint8, NDArray[np.uint8]]

VIEW_STATUS_NAMES: tuple[str, ...]
HIT_KIND_NAMES: tuple[str, ...]
INFEASIBILITY_NAMES: tuple[str, ...]

class Error(RuntimeError): ...

class BatchControl:
    def __init__(self, progress: Callable[[int, int], object] | None = None) -> None: ...
    def stop(self) -> None: ...
    @property
    def stopped(self) -> bool: ...

class PinholeCamera:
    def __init__(
        self,
        width: int,
        height: int,
        *,
        fx: float,
        fy: float,
        cx: float,
        cy: float,
        distortion: Sequence[float] = ...,
    ) -> None: ...
    @staticmethod
    def from_matrix(
        K: ArrayLike, width: int, height: int, *, distortion: Sequence[float] = ...
    ) -> PinholeCamera: ...
    @property
    def matrix(self) -> _Floats: ...
    @property
    def width(self) -> int: ...
    @property
    def height(self) -> int: ...
    @property
    def fx(self) -> float: ...
    @property
    def fy(self) -> float: ...
    @property
    def cx(self) -> float: ...
    @property
    def cy(self) -> float: ...
    @property
    def distortion(self) -> list[float]: ...
    def rays(self) -> _Floats: ...
    def project(self, points: ArrayLike) -> _Floats: ...

class ShotNoise:
    def __init__(
        self,
        *,
        reference_sigma: float = ...,
        reference_range: float = ...,
        reference_integration_time: float = ...,
        integration_time: float = ...,
        modulation_frequency: float = ...,
        min_amplitude: float = ...,
    ) -> None: ...
    @property
    def reference_sigma(self) -> float: ...
    @property
    def reference_range(self) -> float: ...
    @property
    def reference_integration_time(self) -> float: ...
    @property
    def integration_time(self) -> float: ...
    @property
    def modulation_frequency(self) -> float: ...
    @property
    def min_amplitude(self) -> float: ...

class StructuredLightNoise:
    def __init__(
        self,
        *,
        offset: float = ...,
        quadratic: float = ...,
        vertex: float = ...,
        grazing: float = ...,
        lateral_px: float = ...,
        lateral_grazing_px: float = ...,
    ) -> None: ...
    @property
    def offset(self) -> float: ...
    @property
    def quadratic(self) -> float: ...
    @property
    def vertex(self) -> float: ...
    @property
    def grazing(self) -> float: ...
    @property
    def lateral_px(self) -> float: ...
    @property
    def lateral_grazing_px(self) -> float: ...

class StereoNoise:
    def __init__(self, *, subpixel: float = ..., focal: float = ..., baseline: float = ...) -> None: ...
    @property
    def subpixel(self) -> float: ...
    @property
    def focal(self) -> float: ...
    @property
    def baseline(self) -> float: ...

class QuadraticNoise:
    def __init__(self, *, offset: float = ..., quadratic: float = ...) -> None: ...
    @property
    def offset(self) -> float: ...
    @property
    def quadratic(self) -> float: ...

class ConstantNoise:
    def __init__(self, *, sigma_axial: float = ..., sigma_lateral: float = ...) -> None: ...
    @property
    def sigma_axial(self) -> float: ...
    @property
    def sigma_lateral(self) -> float: ...

_Noise = Union[ShotNoise, StructuredLightNoise, StereoNoise, QuadraticNoise, ConstantNoise]

class Sensor:
    def __init__(
        self,
        camera: PinholeCamera,
        *,
        min_range: float,
        max_range: float,
        working_distance: float,
        noise: _Noise,
        name: str = "custom",
        T_flange_camera: ArrayLike | None = None,
        body_size: Sequence[float] | None = None,
        range_calibration: ArrayLike | None = None,
        pose_sigma: Sequence[float] = ...,
    ) -> None: ...
    @staticmethod
    def load(preset_or_file: _Path) -> Sensor: ...
    def save(self, path: _Path) -> None: ...
    @property
    def name(self) -> str: ...
    @property
    def camera(self) -> PinholeCamera: ...
    @property
    def min_range(self) -> float: ...
    @property
    def max_range(self) -> float: ...
    @property
    def working_distance(self) -> float: ...
    @property
    def noise(self) -> _Noise: ...
    @property
    def T_flange_camera(self) -> _Floats | None: ...
    @property
    def body_size(self) -> list[float] | None: ...
    @property
    def range_calibration(self) -> _Floats | None: ...
    @property
    def pose_sigma(self) -> tuple[float, float]: ...
    def corrected(self, depth: ArrayLike) -> NDArray[np.float32]: ...
    def sigmas(self, t: float, cos_incidence: float = 1.0) -> Sigmas: ...

def sensor_preset(name: str) -> Sensor: ...
def sensor_preset_names() -> list[str]: ...
def default_prior_sigma(voxel_size: float, sensor: Sensor) -> float: ...
def criterion_names() -> list[str]: ...
def gain_model_names() -> list[str]: ...
def look_at(eyes: ArrayLike, target: ArrayLike, up: ArrayLike = ...) -> _Floats: ...
def sphere_poses(count: int, radius: float, *, center: ArrayLike = ...) -> _Floats: ...
def dome_poses(count: int, radius: float, *, center: ArrayLike = ...) -> _Floats: ...
def orbit_poses(
    count: int,
    radius: float,
    elevation: float,
    *,
    start: float = 0.0,
    step: float | None = None,
    center: ArrayLike = ...,
) -> _Floats: ...
def ring_poses(
    count: int, radius: float, height: float, tilt: float, *, start: float = 0.0, center: ArrayLike = ...
) -> _Floats: ...
def literature_ring_poses(total: int, radius: float, *, center: ArrayLike = ...) -> _Floats: ...
def shell_poses(
    count: int, min_radius: float, max_radius: float, *, seed: int = 1, center: ArrayLike = ...
) -> _Floats: ...

class BeliefGrid:
    def __init__(
        self,
        *,
        voxel_size: float,
        workspace: ArrayLike,
        prior_sigma: float | None = None,
        sensor: Sensor | None = None,
        T_world_grid: ArrayLike | None = None,
    ) -> None: ...
    @staticmethod
    def from_labels(
        labels: ArrayLike,
        *,
        voxel_size: float,
        origin: ArrayLike = ...,
        T_world_grid: ArrayLike | None = None,
        prior_sigma: float | None = None,
        sensor: Sensor | None = None,
    ) -> BeliefGrid: ...
    @staticmethod
    def load(path: _Path) -> BeliefGrid: ...
    @staticmethod
    def load_octomap(
        path: _Path,
        *,
        workspace: ArrayLike | None = None,
        prior_sigma: float | None = None,
        sensor: Sensor | None = None,
        occupied_from: float = 0.0,
    ) -> BeliefGrid: ...
    def save_octomap(self, path: _Path) -> None: ...
    def save(self, path: _Path, *, with_covariance: bool = False) -> None: ...
    def to_bytes(self) -> bytes: ...
    @staticmethod
    def from_bytes(data: bytes) -> BeliefGrid: ...
    def clone(self) -> BeliefGrid: ...
    @property
    def voxel_size(self) -> float: ...
    @property
    def prior_sigma(self) -> float: ...
    @property
    def shape(self) -> tuple[int, int, int]: ...
    @property
    def min_index(self) -> tuple[int, int, int]: ...
    @property
    def workspace(self) -> _Floats: ...
    @property
    def T_world_grid(self) -> _Floats: ...
    def index_of(self, points: ArrayLike) -> NDArray[np.int32]: ...
    def center(self, voxels: ArrayLike) -> _Floats: ...
    def set(self, voxels: ArrayLike, log_odds: ArrayLike) -> None: ...
    def forget(self, region: ArrayLike) -> int: ...
    def occupied(self) -> _Rows: ...
    def states(self) -> NDArray[np.uint8]: ...
    def views(self) -> _Floats: ...
    @property
    def hazard_factors(self) -> _Floats: ...
    def beliefs(self) -> _Rows: ...
    def points(self, *, min_hits: int = 2, num_threads: int = 0) -> _Rows: ...
    def statistics(self, criterion: _Criterion = "log_diagonal") -> GridStatistics: ...
    def content_hash(self) -> str: ...

class FrameIntegrator:
    def __init__(
        self,
        sensor: Sensor,
        *,
        carve: Literal["cones", "lines"] = "cones",
        occupancy: Literal["probabilistic", "literal"] = "probabilistic",
        support_plane: float | None = None,
        num_threads: int = 0,
    ) -> None: ...
    def integrate(
        self,
        grid: BeliefGrid,
        depth: ArrayLike,
        T_world_camera: ArrayLike,
        *,
        amplitude: ArrayLike | None = None,
    ) -> IntegrationReport: ...
    def calibrate_hazard(
        self, grid: BeliefGrid, scene: VoxelScene, depth: ArrayLike, T_world_camera: ArrayLike
    ) -> None: ...

class CloudIntegrator:
    def __init__(
        self,
        sensor: Sensor,
        *,
        occupancy: Literal["probabilistic", "literal"] = "probabilistic",
        support_plane: float | None = None,
        num_threads: int = 0,
    ) -> None: ...
    def integrate(
        self, grid: BeliefGrid, points: ArrayLike, T_world_sensor: ArrayLike
    ) -> IntegrationReport: ...

def load_cloud(path: _Path) -> Cloud: ...
def cloud_bounds(
    sensor: Sensor, points: ArrayLike, T_world_sensor: ArrayLike, *, support_plane: float | None = None
) -> _Floats | None: ...
def reading_bounds(
    sensor: Sensor, depth: ArrayLike, T_world_camera: ArrayLike, *, support_plane: float | None = None
) -> _Floats | None: ...

class VoxelScene:
    def __init__(
        self,
        grid: BeliefGrid,
        *,
        boxes: ArrayLike | None = None,
        meshes: Iterable[tuple[ArrayLike, ArrayLike]] = (),
        object_size: float | None = None,
        hazard: float | _Path | ArrayLike | None = None,
        num_threads: int = 0,
    ) -> None: ...
    def update(self, grid: BeliefGrid, *, num_threads: int = 0) -> VoxelScene: ...
    @property
    def isa(self) -> str: ...
    @property
    def primitive_count(self) -> int: ...
    @property
    def bytes(self) -> int: ...

class ReachRegion:
    def __init__(
        self,
        *,
        boxes: ArrayLike | None = None,
        shells: ArrayLike | None = None,
        half_spaces: ArrayLike | None = None,
        poses: ArrayLike | None = None,
        distance: float = ...,
        angle: float = ...,
        predicate: Callable[[_Floats], object] | None = None,
    ) -> None: ...
    @staticmethod
    def load(path: _Path) -> ReachRegion: ...
    def save(self, path: _Path) -> None: ...
    def to_bytes(self) -> bytes: ...
    @staticmethod
    def from_bytes(data: bytes) -> ReachRegion: ...
    def contains(self, T_world_camera: ArrayLike) -> _BoolOrBools: ...

class FeasibilityChecker:
    def __init__(
        self,
        scene: VoxelScene,
        *,
        body_size: ArrayLike = ...,
        T_flange_camera: ArrayLike | None = None,
        clearance: float = 0.0,
        reach: ReachRegion | None = None,
        support_plane: float | None = None,
        sensor: Sensor | None = None,
        max_near_share: float = ...,
        num_threads: int = 0,
    ) -> None: ...
    def with_scene(self, scene: VoxelScene) -> FeasibilityChecker: ...
    def feasible(self, T_world_camera: ArrayLike, taken: ArrayLike | None = None) -> _BoolOrBools: ...
    def reasons(self, T_world_camera: ArrayLike, taken: ArrayLike | None = None) -> _CodeOrCodes: ...

class SimulatedSensor:
    def __init__(
        self,
        vertices: ArrayLike,
        triangles: ArrayLike,
        sensor: Sensor,
        *,
        background_radius: float = 0.0,
        noise: bool = False,
        lateral_noise: bool = False,
        sub_rays: int = 1,
        seed: int = 1,
        support_plane: float | None = None,
        num_threads: int = 0,
    ) -> None: ...
    def acquire(
        self, T_world_camera: ArrayLike, frame_index: int = 0
    ) -> SimulatedFrame: ...

class GainEvaluator:
    def __init__(
        self,
        scene: VoxelScene,
        sensor: Sensor,
        *,
        gain: Literal["paper", "surface", "combined"] = "paper",
        criterion: _Criterion = "log_diagonal",
        pixel_stride: int = 1,
        prior_sigma: float | None = None,
        min_range: float | None = None,
        max_range: float | None = None,
        weights: Iterable[tuple[ArrayLike, float]] = (),
        refinement_weight: float | None = None,
        support_plane: float | None = None,
        posterior_entropy: bool = False,
        num_threads: int = 0,
    ) -> None: ...
    def with_scene(self, scene: VoxelScene) -> GainEvaluator: ...
    def evaluate(
        self, T_world_camera: ArrayLike, *, strict: bool = False, control: BatchControl | None = None
    ) -> _FloatOrFloats: ...
    def evaluate_detailed(
        self, T_world_camera: ArrayLike, *, strict: bool = False, control: BatchControl | None = None
    ) -> _RowOrRows: ...
    @overload
    def best(
        self,
        T_world_camera: ArrayLike,
        k: int = 1,
        *,
        return_gains: Literal[False] = False,
        control: BatchControl | None = None,
    ) -> _Indices: ...
    @overload
    def best(
        self,
        T_world_camera: ArrayLike,
        k: int = 1,
        *,
        return_gains: Literal[True],
        control: BatchControl | None = None,
    ) -> ChosenViews: ...
    @overload
    def race(
        self,
        T_world_camera: ArrayLike,
        k: int = 1,
        *,
        seed: int = ...,
        return_gains: Literal[False] = False,
        control: BatchControl | None = None,
    ) -> _Indices: ...
    @overload
    def race(
        self,
        T_world_camera: ArrayLike,
        k: int = 1,
        *,
        seed: int = ...,
        return_gains: Literal[True],
        control: BatchControl | None = None,
    ) -> ChosenViews: ...
    @overload
    def best_set(
        self,
        T_world_camera: ArrayLike,
        k: int,
        *,
        return_gains: Literal[False] = False,
        control: BatchControl | None = None,
    ) -> _Indices: ...
    @overload
    def best_set(
        self,
        T_world_camera: ArrayLike,
        k: int,
        *,
        return_gains: Literal[True],
        control: BatchControl | None = None,
    ) -> ChosenViews: ...
    def approximate(
        self,
        T_world_camera: ArrayLike,
        *,
        share: float = ...,
        seed: int = ...,
        control: BatchControl | None = None,
    ) -> _RowOrRows: ...
    def evaluate_own(
        self,
        T_world_camera: ArrayLike,
        measure: Callable[[_Floats, Any], float],
        *,
        control: BatchControl | None = None,
    ) -> _FloatOrFloats: ...
    def trace(self, T_world_camera: ArrayLike) -> _Rows: ...
    def depth(self, T_world_camera: ArrayLike) -> NDArray[np.float32]: ...
    def contributions(self, T_world_camera: ArrayLike) -> _Rows: ...
    @property
    def rays_per_pose(self) -> int: ...
    @property
    def num_threads(self) -> int: ...
    @property
    def prior_sigma(self) -> float: ...
    @property
    def gain(self) -> str: ...
    @property
    def criterion(self) -> str: ...
    @property
    def pixel_stride(self) -> int: ...
    @property
    def scene(self) -> VoxelScene: ...
    @property
    def sensor(self) -> Sensor: ...

class FrameSequence:
    def __len__(self) -> int: ...
    def __iter__(self) -> Iterator[Frame]: ...
    def __getitem__(self, index: int) -> Frame: ...
    @property
    def sensor(self) -> Sensor: ...
    @property
    def depth_scale(self) -> float: ...
    @property
    def poses(self) -> _Floats: ...

def read_frames(
    folder: _Path,
    *,
    sensor: _Path | None = None,
    depth_scale: float | None = None,
    out_of_range: Literal["carve", "invalid"] = "carve",
) -> FrameSequence: ...
@overload
def read_poses(path: _Path, *, return_timestamps: Literal[False] = False) -> _Floats: ...
@overload
def read_poses(path: _Path, *, return_timestamps: Literal[True]) -> TimedPoses: ...
def write_poses(path: _Path, T_world_camera: ArrayLike, timestamps: ArrayLike | None = None) -> None: ...

class ViewPlanner:
    def __init__(
        self,
        sensor: Sensor,
        *,
        voxel_size: float,
        workspace: ArrayLike,
        T_world_grid: ArrayLike | None = None,
        prior_sigma: float | None = None,
        support_plane: float | None = None,
        boxes: ArrayLike | None = None,
        meshes: Iterable[tuple[ArrayLike, ArrayLike]] = (),
        gain: Literal["combined", "surface", "paper"] = "combined",
        criterion: _Criterion = "log_diagonal",
        object_size: float | None = None,
        reach: ReachRegion | None = None,
        body_size: ArrayLike | None = None,
        clearance: float = 0.0,
        jump_edges: bool = True,
        check_feasibility: bool = True,
        max_views: int = 20,
        idle_views: int = 3,
        stop_gain: float | None = None,
        stop_area: float | None = None,
        state: _Path | None = None,
        num_threads: int = 0,
    ) -> None: ...
    @staticmethod
    def load(path: _Path, *args: Any, **settings: Any) -> ViewPlanner: ...
    def save(self, path: _Path) -> None: ...
    def add_poses(self, T_world_camera: ArrayLike, name: str = "poses") -> None: ...
    def add_generator(
        self, generator: Callable[[BeliefGrid], ArrayLike], name: str = "generator"
    ) -> None: ...
    def add(
        self,
        depth: ArrayLike,
        T_world_camera: ArrayLike,
        *,
        pose_sigma: ArrayLike = ...,
        amplitude: ArrayLike | None = None,
    ) -> AddedView: ...
    def register_frame(
        self,
        depth: ArrayLike,
        T_world_camera: ArrayLike,
        *,
        sigma_translation: float = 0.005,
        sigma_rotation: float = 0.0087,
        amplitude: ArrayLike | None = None,
    ) -> FrameRegistration: ...
    def propose(self) -> Proposal: ...
    def rank(
        self,
        k: int = 1,
        *,
        poses: ArrayLike | None = None,
        costs: ArrayLike | None = None,
        cost_per_metre: float = 0.0,
        exact: bool = False,
        control: BatchControl | None = None,
    ) -> Ranking: ...
    def tried(self, T_world_camera: ArrayLike, reached: bool) -> None: ...
    def should_stop(self) -> str | None: ...
    @property
    def grid(self) -> BeliefGrid: ...
    @property
    def seconds(self) -> dict[str, float]: ...
