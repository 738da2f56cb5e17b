# SPDX-FileCopyrightText: 2026 The viewgain authors
# SPDX-License-Identifier: Apache-2.0
"""What calls give back when it is more than one thing: named tuples."""
from typing import Annotated, Any, NamedTuple, Optional

import numpy as np
from numpy.typing import NDArray

_Floats = NDArray[np.float64]
_Image = NDArray[np.float32]


def named(module: str) -> Any:
    """Of a class of named tuples: it is the module's, its fields have their annotations' words, and ``result["field"]``
    gives a field as well, as numpy's structured arrays do."""

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
    """Standard deviations of a reading, from ``Sensor.sigmas``."""

    axial: Annotated[float, "Along the ray [m]."]
    lateral: Annotated[float, "Across the ray [m]."]


@named("viewgain")
class IntegrationReport(NamedTuple):
    """What ``integrate`` has put into a map, from ``FrameIntegrator`` and ``CloudIntegrator``."""

    readings: Annotated[int, "Pixels or points whose range is within the sensor's limits."]
    plane_readings: Annotated[int, "Pixels or points that see the support plane; not among readings."]
    out_of_range: Annotated[int, "Pixels or points that carve up to max_range."]
    invalid: Annotated[int, "Pixels or points that say nothing."]
    readings_inside: Annotated[int, "Readings that lie in the workspace."]
    voxels_hit: Annotated[int, "Voxels that readings lie in."]
    voxels_crossed: Annotated[int, "Voxels that rays pass and no reading lies in."]


@named("viewgain")
class Suspicion(NamedTuple):
    """What is probably wrong with frames, from ``suspect_frames`` and ``FrameConsistency``."""

    kind: Annotated[str, "The mistake, such as depth_scale, world_to_camera or quaternion_order."]
    what: Annotated[str, "A sentence with the figure that made it suspicious."]


@named("viewgain")
class FrameConsistency(NamedTuple):
    """Whether frames fit one another, from ``consistency`` of ``ViewScorer`` and ``ViewPlanner``."""

    share_in_free: Annotated[float, "Of all readings, those in space that other frames saw as free."]
    share_seen_past: Annotated[float, "Of readings of earlier frames, those that later frames see past."]
    contradicting: Annotated[tuple, "Indices of the frames that contradict the others; empty unless something is suspected."]
    suspicion: Annotated[Optional[Suspicion], "The likely cause; None: the frames agree."]
    in_free: Annotated[_Floats, "(N,), float64: share_in_free of each frame in the map."]
    seen_past: Annotated[_Floats, "(N,), float64: share_seen_past of each."]
    displacement: Annotated[float, "Median over the frames of their displacement against earlier frames [m]; NaN if none could be compared."]
    expected: Annotated[float, "The displacement that the declared errors explain [m]."]
    displacements: Annotated[_Floats, "(N,), float64: displacement of each frame; NaN where too little is seen twice."]


@named("viewgain")
class RayOutcomes(NamedTuple):
    """What becomes of a view's rays, from ``GainEvaluator.outcomes`` and ``ViewPlanner.outcomes``."""

    rays: Annotated[int, "Of the view."]
    unknown: Annotated[int, "Come to unknown space: what may be new."]
    known_surface: Annotated[int, "End in known surface, with free space before it."]
    obstacle: Annotated[int, "End at an obstacle or, but by gain \"paper\", on the support plane."]
    too_near: Annotated[int, "Meet known surface or an obstacle before min_range."]
    out_of_range: Annotated[int, "Are in known free space to max_range."]
    out_of_map: Annotated[int, "Leave the workspace, or never come into it."]


@named("viewgain")
class GridStatistics(NamedTuple):
    """Voxels and progress of a map, from ``BeliefGrid.statistics``."""

    unknown: Annotated[int, "Voxels never observed."]
    free: Annotated[int, "Voxels known to be free."]
    occupied: Annotated[int, "Voxels known to be occupied."]
    bytes: Annotated[int, "Memory of the map."]
    entropy_removed: Annotated[float, "Sum over the occupied voxels [nat, or m**2 for trace]."]


@named("viewgain")
class ViewSet(NamedTuple):
    """Poses that are good together, from ``GainEvaluator.best_set``."""

    indices: Annotated[NDArray[np.int64], "(<= k,), int64: indices into the poses with their leading axes flattened, in the order of their choice."]
    gains: Annotated[NDArray[np.void], "(<= k,), structured: what each adds to those before it, as from ``evaluate_detailed``."]
    gain: Annotated[float, "Of all together, in the gain's unit."]
    complete: Annotated[bool, "False: a stop ended the call before the last choice."]


@named("viewgain")
class BestViews(NamedTuple):
    """The best of many poses, from ``best`` of ``ViewScorer`` and ``GainEvaluator``, and ``GainEvaluator.race``."""

    indices: Annotated[NDArray[np.int64], "(k,), int64: indices into the poses with their leading axes flattened, best first."]
    gains: Annotated[NDArray[np.void], "(k,), structured: as from ``evaluate_detailed``, in its unit, without costs; empty with a measure."]
    worth: Annotated[_Floats, "(k,), float64: the gain, or the measure, less the cost."]
    complete: Annotated[bool, "False: the time limit, or a stop, ended the call before all was done."]
    estimated: Annotated[int, "Poses that were scored by some of their rays; 0 where all are scored in full."]
    scored: Annotated[NDArray[np.int64], "(n,), int64: indices of the poses that were scored in full, rising."]
    scored_gains: Annotated[NDArray[np.void], "(n,), structured: of these; empty with a measure."]


@named("viewgain")
class Frame(NamedTuple):
    """A recorded frame, from ``read_frames``."""

    depth: Annotated[_Image, "(height, width), float32: along the optical axis [m]; 0: nothing known, inf: nothing up to max_range."]
    T_world_camera: Annotated[_Floats, "(4, 4), float64."]
    amplitude: Annotated[Optional[_Image], "(height, width), float32 [1/m**2], or None."]


@named("viewgain")
class SimulatedFrame(NamedTuple):
    """A simulated frame, from ``SimulatedSensor.acquire``."""

    depth: Annotated[_Image, "(height, width), float32: along the optical axis [m]; 0: invalid, inf: nothing up to max_range."]
    amplitude: Annotated[_Image, "(height, width), float32: cos / range**2 [1/m**2]; 0 where there is no reading."]


@named("viewgain")
class Cloud(NamedTuple):
    """A point cloud, from ``load_cloud``."""

    points: Annotated[_Floats, "(n, 3), float64: as they stand in the file, in the file's frame [m]; NaN where an organised cloud has none."]
    viewpoint: Annotated[Optional[_Floats], "(4, 4), float64: the sensor's pose in the points' frame, or None."]


@named("viewgain")
class TimedPoses(NamedTuple):
    """Poses with their times, from ``read_timed_poses``."""

    T_world_camera: Annotated[_Floats, "(n, 4, 4), float64."]
    timestamps: Annotated[_Floats, "(n,), float64 [s]."]


@named("viewgain")
class FrameRegistration(NamedTuple):
    """Where a frame's camera was, from ``ViewPlanner.register_frame``."""

    status: Annotated[str, "\"registered\", \"too_little_overlap\" or \"refused\"."]
    reason: Annotated[str, "Why it has this status, for people; empty if registered."]
    T_world_camera: Annotated[_Floats, "(4, 4), float64, corrected if registered, else as reported."]
    covariance: Annotated[_Floats, "(6, 6), float64, of its translation [m], then its rotation [rad], world axes."]
    translation: Annotated[float, "Way of the camera's centre by the correction that was found [m]."]
    rotation: Annotated[float, "Its angle [rad]; the program's JSON has rotation_deg."]
    residual_before: Annotated[float, "RMS distance of the pairs at the reported pose [m]."]
    residual_after: Annotated[float, "The same at the pose that was found [m]."]
    readings: Annotated[int, "Readings that were looked at."]
    pairs: Annotated[int, "Readings that belong to a point of the map."]
    overlap: Annotated[float, "Share: pairs / readings."]
    contradiction: Annotated[float, "The larger share: of readings in space known to be free, of the map's surface that the frame looks past."]
    smallest_information: Annotated[float, "Of the frame along any motion, as a factor of the prior's."]
    free_directions: Annotated[int, "Motions that the frame does not hold, which stay as reported."]
    pose_sigma: Annotated[tuple, "(2,): what the covariance leaves in each axis [m], [rad], for ``ViewPlanner.add``."]


@named("viewgain")
class AddedView(NamedTuple):
    """What a frame has changed, from ``ViewPlanner.add``."""

    readings: Annotated[int, "Pixels or points whose range is within the sensor's limits."]
    plane_readings: Annotated[int, "Pixels or points that see the support plane; not among readings."]
    out_of_range: Annotated[int, "Pixels or points that carve up to max_range."]
    invalid: Annotated[int, "Pixels or points that say nothing."]
    readings_inside: Annotated[int, "Readings that lie in the workspace."]
    voxels_hit: Annotated[int, "Voxels that readings lie in."]
    voxels_crossed: Annotated[int, "Voxels that rays pass and no reading lies in."]
    view: Annotated[int, "Number of the view, from 0."]
    entropy_removed: Annotated[float, "Entropy that this view has removed [nat, or m**2 for trace]."]
    new_area: Annotated[float, "New surface that this view has shown, its area across the rays [m**2]; NaN by gain \"paper\"."]
    total_entropy_removed: Annotated[float, "Entropy removed so far [nat, or m**2 for trace]."]
    total_area: Annotated[float, "Sum of the new areas so far [m**2]."]
    unknown_voxels: Annotated[int, "Unknown voxels that are left."]
    verdict: Annotated[str, "What became of the frame: used, carved (free space alone), lost_pose, no_pose, unreadable, wrong_size, nothing_in_range, outside, contradicts."]


@named("viewgain")
class MapUpdate(NamedTuple):
    """What a frame has changed, from ``ViewScorer.add``."""

    readings: Annotated[int, "Pixels or points whose range is within the sensor's limits."]
    plane_readings: Annotated[int, "Pixels or points that see the support plane; not among readings."]
    out_of_range: Annotated[int, "Pixels or points that carve up to max_range."]
    invalid: Annotated[int, "Pixels or points that say nothing."]
    readings_inside: Annotated[int, "Readings that lie in the workspace."]
    voxels_hit: Annotated[int, "Voxels that readings lie in."]
    voxels_crossed: Annotated[int, "Voxels that rays pass and no reading lies in."]
    flying_pixels: Annotated[int, "Pixels that the jump-edge filter removed."]
    new_area: Annotated[float, "New surface that the frame has shown, its area across the rays [m**2]; NaN by gain \"paper\"."]
    verdict: Annotated[str, "What became of the frame: used, carved (free space alone), nothing_in_range or outside."]


@named("viewgain")
class Proposal(NamedTuple):
    """Candidates that are possible now, from ``ViewPlanner.propose``.

    A tuple of these three: ``len(proposal)`` is 3, and ``len(proposal.T_world_camera)`` says how many candidates there are.
    """

    T_world_camera: Annotated[_Floats, "(n, 4, 4), float64."]
    generator: Annotated[list[str], "Which set or generator each is of."]
    dropped: Annotated[dict[str, int], "Reason -> how many: ``INFEASIBILITY_NAMES``, and \"missed\": commanded and not reached."]


@named("viewgain")
class ViewTour(NamedTuple):
    """Views in the order in which they are driven to, from ``GainEvaluator.plan_tour``."""

    indices: Annotated[NDArray[np.int64], "(k,), int64: of the poses."]
    gains: Annotated[NDArray[np.void], "(k,), structured: what each added to those that were chosen before it."]
    worth: Annotated[_Floats, "(k,), float64: its gain less what it and its way cost when it was chosen."]
    way: Annotated[float, "Of all ways together, in the unit of way."]


@named("viewgain")
class Ranking(NamedTuple):
    """The best candidates in their order, from ``ViewPlanner.rank``.

    A tuple of these six: ``len(ranking)`` is 6, and ``len(ranking.indices)`` says how many views there are.
    """

    indices: Annotated[NDArray[np.int64], "(k,), int64: indices into ``poses`` where they are given, else into the proposal's candidates, in which poses of ``add_poses`` have other places."]
    gain: Annotated[_Floats, "(k,), float64 [nat; by gain \"surface\" m**2]; together or in a new plan what each view adds; NaN with ``measure``, whose value is in ``worth``."]
    worth: Annotated[_Floats, "(k,), float64: the gain less the cost, in its unit; 0 or less: the way costs more than the view brings."]
    complete: Annotated[bool, "False if a stop was requested."]
    area: Annotated[_Floats, "(k,), float64: new surface to be expected [m**2]; NaN by gain \"paper\"."]
    T_world_camera: Annotated[_Floats, "(k, 4, 4), float64."]
