# SPDX-FileCopyrightText: 2026 The viewgain authors
# SPDX-License-Identifier: Apache-2.0
"""Named tuples that calls return."""
from typing import Annotated, Any, NamedTuple, Optional

import numpy as np
from numpy.typing import NDArray

_Floats = NDArray[np.float64]
_Image = NDArray[np.float32]


def named(module: str) -> Any:
    """Class decorator for named tuples. Sets the module, takes the fields' docstrings from their annotations, and makes ``result["field"]``
    return a field, as with numpy's structured arrays."""

    def finish(result: Any) -> Any:
        result.__module__ = module
        annotations = dict(result.__annotations__)
        for name, annotation in annotations.items():
            getattr(result, name).__doc__ = annotation.__metadata__[0]
            annotations[name] = annotation.__origin__  # signatures are of the types alone
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


@named("viewgain")
class IntegrationReport(NamedTuple):
    """Counts of ``integrate``, from ``FrameIntegrator`` and ``CloudIntegrator``."""

    readings: Annotated[int, "Pixels or points whose range is within the sensor's limits."]
    plane_readings: Annotated[int, "Pixels or points that show the support plane or a known object; not counted as readings."]
    out_of_range: Annotated[int, "Pixels or points that are free up to max_range."]
    invalid: Annotated[int, "Pixels or points without information."]
    readings_inside: Annotated[int, "Readings that lie in the workspace."]
    voxels_hit: Annotated[int, "Voxels that contain readings."]
    voxels_crossed: Annotated[int, "Voxels that rays cross and that contain no readings."]


@named("viewgain")
class Suspicion(NamedTuple):
    """A probable fault of frames, from ``suspect_frames`` and ``FrameConsistency``."""

    kind: Annotated[str, "The mistake, such as depth_scale, world_to_camera or quaternion_order."]
    what: Annotated[str, "A sentence with the number that raised the suspicion."]


@named("viewgain")
class FrameConsistency(NamedTuple):
    """How well frames agree, from ``consistency`` of ``ViewScorer`` and ``ViewPlanner``."""

    share_in_free: Annotated[float, "Fraction of all readings (measured depths) in space that other frames saw as free."]
    share_seen_past: Annotated[float, "Fraction of readings of earlier frames that later frames see past."]
    contradicting: Annotated[tuple, "Indices of the frames that contradict the others; empty unless something is suspected."]
    suspicion: Annotated[Optional[Suspicion], "Likely cause; None: the frames agree."]
    in_free: Annotated[_Floats, "(N,), float64: share_in_free of each frame in the map."]
    seen_past: Annotated[_Floats, "(N,), float64: share_seen_past of each frame."]
    displacement: Annotated[float, "Median displacement of the frames relative to earlier ones [m]; NaN if none could be compared."]
    expected: Annotated[float, "Displacement that the declared errors explain [m]."]
    displacements: Annotated[_Floats, "(N,), float64: displacement of each frame; NaN if it shares too little surface with others."]


@named("viewgain")
class RayOutcomes(NamedTuple):
    """Where a view's rays end, from ``GainEvaluator.outcomes`` and ``ViewPlanner.outcomes``."""

    rays: Annotated[int, "Number of rays of the view."]
    unknown: Annotated[int, "Reach unknown space: possible new surface."]
    known_surface: Annotated[int, "End on known surface after free space."]
    obstacle: Annotated[int, "End on an obstacle or, except with gain \"paper\", on the support plane."]
    too_near: Annotated[int, "Hit known surface or an obstacle nearer than min_range."]
    out_of_range: Annotated[int, "Stay in known free space up to max_range."]
    out_of_map: Annotated[int, "Leave the workspace, or never enter it."]


@named("viewgain")
class GridStatistics(NamedTuple):
    """Voxels and progress of a map, from ``BeliefGrid.statistics``."""

    unknown: Annotated[int, "Voxels never observed."]
    free: Annotated[int, "Voxels known to be free."]
    occupied: Annotated[int, "Voxels known to be occupied."]
    bytes: Annotated[int, "Memory of the map."]
    entropy_removed: Annotated[float, "Entropy removed, summed over the occupied voxels [nat, or m**2 for trace]."]


@named("viewgain")
class ViewSet(NamedTuple):
    """Poses with a large gain together, from ``GainEvaluator.best_set``."""

    indices: Annotated[NDArray[np.int64], "(<= k,), int64: indices into the poses with their leading axes flattened, in the order chosen."]
    gains: Annotated[NDArray[np.void], "(<= k,), structured: marginal gains (the increase over the earlier views), with the fields of ``evaluate_detailed``."]
    gain: Annotated[float, "Gain of the set, in the gain's unit."]
    complete: Annotated[bool, "False: a stop ended the call before the last choice."]


@named("viewgain")
class BestViews(NamedTuple):
    """The best of many poses, from ``best`` of ``ViewScorer`` and ``GainEvaluator``, and ``GainEvaluator.race``."""

    indices: Annotated[NDArray[np.int64], "(k,), int64: indices into the poses with their leading axes flattened, best first."]
    gains: Annotated[NDArray[np.void], "(k,), structured: results of ``evaluate_detailed``, without costs; empty with a measure."]
    worth: Annotated[_Floats, "(k,), float64: gain, or measure, minus cost."]
    complete: Annotated[bool, "False: the time limit or a stop ended the call early."]
    estimated: Annotated[int, "Number of poses scored with only some of their rays; 0 if all are scored in full."]
    scored: Annotated[NDArray[np.int64], "(n,), int64: indices of the poses that were scored in full, ascending."]
    scored_gains: Annotated[NDArray[np.void], "(n,), structured: their gains; empty with a measure."]


@named("viewgain")
class Frame(NamedTuple):
    """A recorded frame, from ``read_frames``."""

    depth: Annotated[_Image, "(height, width), float32: along the optical axis [m]; 0: no reading, inf: free up to max_range."]
    T_world_camera: Annotated[_Floats, "(4, 4), float64."]
    amplitude: Annotated[Optional[_Image], "(height, width), float32 [1/m**2], or None."]


@named("viewgain")
class SimulatedFrame(NamedTuple):
    """A simulated frame, from ``SimulatedSensor.acquire``."""

    depth: Annotated[_Image, "(height, width), float32: along the optical axis [m]; 0: invalid, inf: free up to max_range."]
    amplitude: Annotated[_Image, "(height, width), float32: cos / range**2 [1/m**2]; 0 without a reading."]


@named("viewgain")
class Cloud(NamedTuple):
    """A point cloud, from ``load_cloud``."""

    points: Annotated[_Floats, "(n, 3), float64: as in the file, in its frame [m]; NaN for missing points of an organised cloud."]
    viewpoint: Annotated[Optional[_Floats], "(4, 4), float64: the sensor's pose in the points' frame, or None."]


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
    T_world_camera: Annotated[_Floats, "(4, 4), float64, corrected pose; if the frame is not registered, the reported pose."]
    covariance: Annotated[_Floats, "(6, 6), float64: covariance of the translation [m], then the rotation [rad], world axes."]
    translation: Annotated[float, "Displacement of the camera centre by the correction [m]."]
    rotation: Annotated[float, "Angle of the correction [rad]; the program's JSON has rotation_deg."]
    residual_before: Annotated[float, "RMS distance of readings from the map's surface at the reported pose [m]."]
    residual_after: Annotated[float, "RMS distance of readings from the map's surface at the estimated pose [m]."]
    readings: Annotated[int, "Number of readings (measured depths) used."]
    pairs: Annotated[int, "Number of readings that correspond to a point of the map."]
    overlap: Annotated[float, "pairs / readings."]
    contradiction: Annotated[float, "The larger of two fractions: of readings that lie in known free space, and of the map's surface that the frame sees past."]
    smallest_information: Annotated[float, "How well the frame determines the pose: smallest information over all motions, relative to that of the reported pose."]
    free_directions: Annotated[int, "Number of motions that the frame does not determine, which stay as reported."]
    pose_sigma: Annotated[tuple, "(2,): standard deviations per axis from the covariance [m], [rad], for ``ViewPlanner.add``."]


@named("viewgain")
class AddedView(NamedTuple):
    """Effect of a frame, from ``ViewPlanner.add``."""

    readings: Annotated[int, "Pixels or points whose range is within the sensor's limits."]
    plane_readings: Annotated[int, "Pixels or points that show the support plane or a known object; not counted as readings."]
    out_of_range: Annotated[int, "Pixels or points that are free up to max_range."]
    invalid: Annotated[int, "Pixels or points without information."]
    readings_inside: Annotated[int, "Readings that lie in the workspace."]
    voxels_hit: Annotated[int, "Voxels that contain readings."]
    voxels_crossed: Annotated[int, "Voxels that rays cross and that contain no readings."]
    view: Annotated[int, "Number of the view, from 0."]
    entropy_removed: Annotated[float, "Entropy removed by this view [nat, or m**2 for trace]."]
    new_area: Annotated[float, "New surface shown by this view, perpendicular to the rays [m**2]; NaN with gain \"paper\"."]
    total_entropy_removed: Annotated[float, "Entropy removed so far [nat, or m**2 for trace]."]
    total_area: Annotated[float, "Sum of the new areas so far [m**2]."]
    unknown_voxels: Annotated[int, "Number of voxels that are still unknown."]
    verdict: Annotated[str, "How the frame was used: used, carved (only free space), or why it was not: lost_pose, no_pose, unreadable, wrong_size, nothing_in_range, outside, contradicts."]


@named("viewgain")
class MapUpdate(NamedTuple):
    """Effect of a frame, from ``ViewScorer.add``."""

    readings: Annotated[int, "Pixels or points whose range is within the sensor's limits."]
    plane_readings: Annotated[int, "Pixels or points that show the support plane or a known object; not counted as readings."]
    out_of_range: Annotated[int, "Pixels or points that are free up to max_range."]
    invalid: Annotated[int, "Pixels or points without information."]
    readings_inside: Annotated[int, "Readings that lie in the workspace."]
    voxels_hit: Annotated[int, "Voxels that contain readings."]
    voxels_crossed: Annotated[int, "Voxels that rays cross and that contain no readings."]
    flying_pixels: Annotated[int, "Pixels removed by the jump-edge filter."]
    new_area: Annotated[float, "New surface shown by the frame, perpendicular to the rays [m**2]; NaN with gain \"paper\"."]
    verdict: Annotated[str, "How the frame was used: used, carved (only free space), or why it was not: nothing_in_range, outside."]


@named("viewgain")
class Proposal(NamedTuple):
    """Candidates that are currently possible, from ``ViewPlanner.propose``.

    A tuple of three fields: ``len(proposal)`` is 3, and ``len(proposal.T_world_camera)`` is the number of candidates.
    """

    T_world_camera: Annotated[_Floats, "(n, 4, 4), float64."]
    generator: Annotated[list[str], "Name of the set or generator of each candidate."]
    dropped: Annotated[dict[str, int], "Number of dropped candidates by reason: ``INFEASIBILITY_NAMES``, and \"missed\" (commanded and not reached)."]


@named("viewgain")
class ViewTour(NamedTuple):
    """Views in the order of a short path, from ``GainEvaluator.plan_tour``."""

    indices: Annotated[NDArray[np.int64], "(k,), int64: indices of the poses."]
    gains: Annotated[NDArray[np.void], "(k,), structured: marginal gains, the increase over the views chosen earlier."]
    worth: Annotated[_Floats, "(k,), float64: gain minus costs of view and path when the view was chosen."]
    way: Annotated[float, "Total path cost, in the unit of way."]


@named("viewgain")
class Ranking(NamedTuple):
    """The best candidates, best first, from ``ViewPlanner.rank``.

    A tuple of six fields: ``len(ranking)`` is 6, and ``len(ranking.indices)`` is the number of views.
    """

    indices: Annotated[NDArray[np.int64], "(k,), int64: indices into ``poses`` if given, otherwise into the candidates of the proposal (not of ``add_poses``)."]
    gain: Annotated[_Floats, "(k,), float64 [nat; with gain \"surface\" m**2]; marginal with together or in a new plan; NaN with ``measure``, whose value is in ``worth``."]
    worth: Annotated[_Floats, "(k,), float64: gain minus cost, in the gain's unit; 0 or less if the view costs more than it gains."]
    complete: Annotated[bool, "False: stopped early."]
    area: Annotated[_Floats, "(k,), float64: expected new surface [m**2]; NaN with gain \"paper\"."]
    T_world_camera: Annotated[_Floats, "(k, 4, 4), float64."]
