# SPDX-FileCopyrightText: 2026 The viewgain authors
# SPDX-License-Identifier: Apache-2.0
"""Named tuples that calls return."""
from typing import Annotated, Any, NamedTuple, Optional

import numpy as np
from numpy.typing import NDArray

_Floats = NDArray[np.float64]
_Image = NDArray[np.float32]


def named(module: str) -> Any:
    """Class decorator for named tuples. Sets the module, and takes the docstrings of fields from their annotations. Makes
    ``result["field"]`` return a field, as for numpy's structured arrays."""

    def finish(result: Any) -> Any:
        result.__module__ = module
        annotations = dict(result.__annotations__)
        for name, annotation in annotations.items():
            getattr(result, name).__doc__ = annotation.__metadata__[0]
            annotations[name] = annotation.__origin__  # signatures show only the types
        result.__annotations__ = result.__new__.__annotations__ = annotations

        def item(self: Any, key: Any) -> Any:
            if not isinstance(key, str):
                return tuple.__getitem__(self, key)
            if key not in self._fields:
                raise KeyError(key)
            return getattr(self, key)

        result.__getitem__ = item
        return result

    return finish


@named("viewgain")
class Sigmas(NamedTuple):
    """Standard deviations of a reading (one measured depth), from ``Sensor.sigmas``."""

    axial: Annotated[float, "Along the ray [m]."]
    lateral: Annotated[float, "Across the ray [m]."]


# Counts that several results have.
_Readings = Annotated[int, "Number of pixels or points whose range is within the sensor's limits."]
_PlaneReadings = Annotated[int, "Number of pixels or points that show the support plane or a known object; not counted as readings."]
_OutOfRange = Annotated[int, "Number of pixels or points that are free up to max_range."]
_Invalid = Annotated[int, "Number of pixels or points that measured nothing."]
_ReadingsInside = Annotated[int, "Number of readings that lie in the workspace."]
_VoxelsHit = Annotated[int, "Number of voxels that readings hit."]
_VoxelsCrossed = Annotated[int, "Number of voxels that were crossed, but not hit."]


@named("viewgain")
class IntegrationReport(NamedTuple):
    """Counts of ``integrate``, from ``FrameIntegrator`` and ``CloudIntegrator``."""

    readings: _Readings
    plane_readings: _PlaneReadings
    out_of_range: _OutOfRange
    invalid: _Invalid
    readings_inside: _ReadingsInside
    voxels_hit: _VoxelsHit
    voxels_crossed: _VoxelsCrossed


@named("viewgain")
class Suspicion(NamedTuple):
    """A probable fault of frames, from ``suspect_frames`` and ``FrameConsistency``."""

    kind: Annotated[str, "The mistake, such as depth_scale, world_to_camera or quaternion_order."]
    what: Annotated[str, "A sentence with the number that raised the suspicion."]


@named("viewgain")
class FrameConsistency(NamedTuple):
    """How well frames agree, from ``consistency`` of ``ViewScorer`` and ``ViewPlanner``."""

    share_in_free: Annotated[float, "Fraction of readings (measured depths) that lie in space that other frames saw as free."]
    share_seen_past: Annotated[float, "Fraction of readings of earlier frames that lie in space that later frames saw as free."]
    contradicting: Annotated[tuple, "Indices of the frames that contradict the others; empty unless something is suspected."]
    suspicion: Annotated[Optional[Suspicion], "Likely cause; None: the frames agree."]
    in_free: Annotated[_Floats, "(N,), float64: share_in_free of each frame in the map."]
    seen_past: Annotated[_Floats, "(N,), float64: share_seen_past of each frame."]
    displacement: Annotated[float, "Median displacement of the frames relative to earlier ones [m]; NaN if none could be compared."]
    expected: Annotated[float, "Displacement that the stated uncertainties explain [m]."]
    displacements: Annotated[_Floats, "(N,), float64: displacement of each frame; NaN if it shares too little surface with others."]


@named("viewgain")
class RayOutcomes(NamedTuple):
    """Where a view's rays end, from ``GainEvaluator.outcomes`` and ``ViewPlanner.outcomes``."""

    rays: Annotated[int, "Number of rays of the view."]
    unknown: Annotated[int, "Number of rays that reach unknown space, where they may show new surface."]
    known_surface: Annotated[int, "Number of rays that end on known surface after free space."]
    obstacle: Annotated[int, "Number of rays that end on an obstacle or, except with gain \"paper\", on the support plane."]
    too_near: Annotated[int, "Number of rays that end on known surface or an obstacle nearer than min_range."]
    out_of_range: Annotated[int, "Number of rays that stay in known free space up to max_range."]
    out_of_map: Annotated[int, "Number of rays that leave the workspace, or never enter it."]


@named("viewgain")
class GridStatistics(NamedTuple):
    """Numbers of voxels and removed entropy of a map, from ``BeliefGrid.statistics``."""

    unknown: Annotated[int, "Number of voxels never observed."]
    free: Annotated[int, "Number of voxels known to be free."]
    occupied: Annotated[int, "Number of voxels known to be occupied."]
    bytes: Annotated[int, "Memory of the map [bytes]."]
    entropy_removed: Annotated[float, "Entropy removed, summed over the occupied voxels [nat; m**2 with criterion \"trace\"]."]


@named("viewgain")
class ViewSet(NamedTuple):
    """A set of poses with a large gain together, from ``GainEvaluator.best_set``."""

    indices: Annotated[NDArray[np.int64], "(<= k,), int64: indices into the poses with their leading axes flattened, in the order chosen."]
    gains: Annotated[NDArray[np.void], "(<= k,), structured: marginal gains (increase of the set's gain), with the fields of ``evaluate_detailed``."]
    gain: Annotated[float, "Gain of the set, in the gain's unit."]
    complete: Annotated[bool, "False: a stop ended the call before the last choice."]


@named("viewgain")
class BestViews(NamedTuple):
    """The best of many poses, from ``ViewScorer.best``, ``GainEvaluator.best`` and ``GainEvaluator.race``."""

    indices: Annotated[NDArray[np.int64], "(k,), int64: indices into the poses with their leading axes flattened, best first."]
    gains: Annotated[NDArray[np.void], "(k,), structured: results of ``evaluate_detailed``, without costs; empty with a custom gain."]
    worth: Annotated[_Floats, "(k,), float64: gain, or custom gain, minus cost."]
    complete: Annotated[bool, "False: the time limit or a stop ended the call early."]
    estimated: Annotated[int, "Number of poses whose gain was estimated from some of their rays."]
    scored: Annotated[NDArray[np.int64], "(n,), int64: indices of the poses that were scored with all their rays, ascending."]
    scored_gains: Annotated[NDArray[np.void], "(n,), structured: gains of these poses; empty with a custom gain."]


@named("viewgain")
class Frame(NamedTuple):
    """A recorded frame, from ``read_frames``."""

    depth: Annotated[_Image, "(height, width), float32: along the optical axis [m]; 0: nothing measured, inf: free up to max_range."]
    T_world_camera: Annotated[_Floats, "(4, 4), float64."]
    amplitude: Annotated[Optional[_Image], "(height, width), float32 [1/m**2], or None."]


@named("viewgain")
class SimulatedFrame(NamedTuple):
    """A simulated frame, from ``SimulatedSensor.acquire``."""

    depth: Annotated[_Image, "(height, width), float32: along the optical axis [m]; 0: invalid, inf: free up to max_range."]
    amplitude: Annotated[_Image, "(height, width), float32: cos / range**2 [1/m**2], where cos is the cosine of the angle of incidence; 0 if nothing was measured."]


@named("viewgain")
class Cloud(NamedTuple):
    """A point cloud, from ``load_cloud``."""

    points: Annotated[_Floats, "(n, 3), float64: points in the frame of the file [m]; NaN for missing points of an organised cloud."]
    viewpoint: Annotated[Optional[_Floats], "(4, 4), float64: pose of the sensor in the frame of the points, or None."]


@named("viewgain")
class TimedPoses(NamedTuple):
    """Poses with their times, from ``read_timed_poses``."""

    T_world_camera: Annotated[_Floats, "(n, 4, 4), float64."]
    timestamps: Annotated[_Floats, "(n,), float64 [s]."]


@named("viewgain")
class FrameRegistration(NamedTuple):
    """Estimated camera pose of a frame, from ``ViewPlanner.register_frame``."""

    status: Annotated[str, "\"registered\", \"too_little_overlap\" or \"refused\"."]
    reason: Annotated[str, "Reason of the status, in words; empty if registered."]
    T_world_camera: Annotated[_Floats, "(4, 4), float64: estimated pose; if the frame is not registered, the reported pose."]
    covariance: Annotated[_Floats, "(6, 6), float64: covariance of translation [m] and rotation [rad], in this order, world axes."]
    translation: Annotated[float, "Distance between the reported and the estimated camera centre [m]."]
    rotation: Annotated[float, "Angle between the reported and the estimated rotation [rad]; the program's JSON has rotation_deg."]
    residual_before: Annotated[float, "RMS distance between readings and the map's surface at the reported pose [m]."]
    residual_after: Annotated[float, "RMS distance between readings and the map's surface at the estimated pose [m]."]
    readings: Annotated[int, "Number of readings (measured depths) used."]
    pairs: Annotated[int, "Number of readings that correspond to a point of the map."]
    overlap: Annotated[float, "pairs / readings."]
    contradiction: Annotated[float, "The larger of two fractions: that of readings that lie in known free space, and that of the map's surface in space that the frame shows as free."]
    smallest_information: Annotated[float, "How well the frame determines the pose: smallest information about any motion of the camera, relative to that of the reported pose."]
    free_directions: Annotated[int, "Number of independent motions of the camera that the frame does not determine. In these, the pose stays as reported."]
    pose_sigma: Annotated[tuple, "(2,): standard deviations per axis of translation [m] and rotation [rad], for ``ViewPlanner.add``."]


@named("viewgain")
class AddedView(NamedTuple):
    """Effect of a frame, from ``ViewPlanner.add``."""

    readings: _Readings
    plane_readings: _PlaneReadings
    out_of_range: _OutOfRange
    invalid: _Invalid
    readings_inside: _ReadingsInside
    voxels_hit: _VoxelsHit
    voxels_crossed: _VoxelsCrossed
    view: Annotated[int, "Number of the view, from 0."]
    entropy_removed: Annotated[float, "Entropy removed by this view [nat; m**2 with criterion \"trace\"]."]
    new_area: Annotated[float, "New surface that this view showed, measured perpendicular to the rays [m**2]; NaN with gain \"paper\"."]
    total_entropy_removed: Annotated[float, "Entropy removed so far [nat; m**2 with criterion \"trace\"]."]
    total_area: Annotated[float, "Sum of the new areas so far [m**2]."]
    unknown_voxels: Annotated[int, "Number of voxels that are still unknown."]
    verdict: Annotated[str, "used, or carved if it showed only free space. Otherwise the reason why the frame was not used: lost_pose, no_pose, unreadable, wrong_size, nothing_in_range, outside or contradicts."]


@named("viewgain")
class MapUpdate(NamedTuple):
    """Effect of a frame, from ``ViewScorer.add``."""

    readings: _Readings
    plane_readings: _PlaneReadings
    out_of_range: _OutOfRange
    invalid: _Invalid
    readings_inside: _ReadingsInside
    voxels_hit: _VoxelsHit
    voxels_crossed: _VoxelsCrossed
    flying_pixels: Annotated[int, "Number of pixels that the jump-edge filter removed."]
    new_area: Annotated[float, "New surface that the frame showed, measured perpendicular to the rays [m**2]; NaN with gain \"paper\"."]
    verdict: Annotated[str, "used, or carved if it showed only free space. Otherwise the reason why the frame was not used: nothing_in_range or outside."]


@named("viewgain")
class Proposal(NamedTuple):
    """Candidates that are currently feasible, from ``ViewPlanner.propose``.

    The number of candidates is ``len(proposal.T_world_camera)``. ``len(proposal)`` is 3, the number of fields.
    """

    T_world_camera: Annotated[_Floats, "(n, 4, 4), float64."]
    generator: Annotated[list[str], "Name of the set or generator of each candidate."]
    dropped: Annotated[dict[str, int], "Number of dropped candidates per reason: one of ``INFEASIBILITY_NAMES``, or \"missed\" for poses that the robot did not reach."]


@named("viewgain")
class ViewTour(NamedTuple):
    """Views in the order of a short path, from ``GainEvaluator.plan_tour``."""

    indices: Annotated[NDArray[np.int64], "(k,), int64: indices of the poses."]
    gains: Annotated[NDArray[np.void], "(k,), structured: marginal gains (increase of the set's gain), with the fields of ``evaluate_detailed``."]
    worth: Annotated[_Floats, "(k,), float64: marginal gain minus the costs of the view and of its path, when it was chosen."]
    way: Annotated[float, "Total path cost, in the unit of way."]


@named("viewgain")
class Ranking(NamedTuple):
    """The best candidates, best first, from ``ViewPlanner.rank``.

    The number of views is ``len(ranking.indices)``. ``len(ranking)`` is 6, the number of fields.
    """

    indices: Annotated[NDArray[np.int64], "(k,), int64: indices into the argument ``poses``; without it, indices into the candidates of the last ``Proposal``."]
    gain: Annotated[_Floats, "(k,), float64: gains [nat; with gain \"surface\" m**2]; with ``together`` and in a new plan, marginal gains; with ``measure``, NaN, and the custom gain is in ``worth``."]
    worth: Annotated[_Floats, "(k,), float64: gain minus cost, in the gain's unit; negative if the view costs more than it gains."]
    complete: Annotated[bool, "False: stopped early."]
    area: Annotated[_Floats, "(k,), float64: expected new surface [m**2]; NaN with gain \"paper\"."]
    T_world_camera: Annotated[_Floats, "(k, 4, 4), float64."]
