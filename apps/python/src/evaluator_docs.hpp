// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace viewgain::python {

// Docstrings of the class GainEvaluator.

inline constexpr const char* kEvaluatorDoc =
    R"(Scores camera poses against a scene by expected information gain.

Results are bit-identical to those of C++, for any number of threads. Poses are ``T_world_camera``
arrays (..., 4, 4) that map the optical frame (x right, y down, z forward) to the world [m].
C-contiguous float64 is read in place; other real dtypes are converted once.

Parameters
----------
scene : VoxelScene
sensor : Sensor
gain : {"combined", "surface", "paper"}
    What a view's gain measures: expected new surface and refinement of known surface [nat],
    expected new surface [m**2], or entropy removed [nat].
criterion : {"log_diagonal", "log_determinant", "trace"}
    Measure of uncertainty of the paper's gain; gains are in nats, with trace in m**2. The combined
    gain always uses log_diagonal; trace raises ValueError with it.
pixel_stride : int
    Traces every s-th pixel of every s-th row.
prior_sigma : float, optional
    Standard deviation of an unknown voxel [m]; default: the map's.
min_range, max_range : float, optional
    Along the ray [m]; default: the sensor's. Voxels nearer than min_range have no gain, but known
    surface there blocks rays.
weights : iterable of (box, weight), optional
    Task weights >= 0 of parts of the workspace: boxes (2, 3) in the grid frame [m]. The last box
    that contains a voxel's centre counts; outside all boxes the weight is 1.
refinement_weight : float, optional
    Weight of refinement relative to new surface; only with "combined". Default: 1.
posterior_entropy : bool
    Also compute the field posterior_entropy in ``evaluate_detailed``; only with "paper"; about 4 %
    slower.
tracer : {"automatic", "embree", "sweep"}
    How to find the voxels that rays hit. "sweep" visits cells from near to far. "embree" uses a
    BVH, which must be built first. "automatic" builds it for scenes that get many views of under
    100 rays. Does not affect results.
num_threads : int
    0: all hardware threads.

Notes
-----
Methods may run in many threads at once and release the GIL; Ctrl-C ends a batch.

Cost: linear in poses and rays per pose. With the paper's gain, two threads score about 4,800 poses
of 176x144 pixels per second in a map of 128**3 voxels; with the surface gain a quarter of that,
with the combined gain a fifth. The constructor removes the lens distortion once: 1 ms for 176x144
pixels. Properties take constant time.)";

inline constexpr const char* kWithSceneDoc =
    R"(An evaluator for another scene, to follow a growing map.

The new evaluator has the sensor, settings and threads of this one, which does not change. Results
are those of a new evaluator for that scene, with the new map's ``prior_sigma`` unless it was given.
Cost: some microseconds; some milliseconds with the surface or combined gain if the scene is new.

Parameters
----------
scene : VoxelScene
    For example from ``VoxelScene.update``.

Returns
-------
GainEvaluator)";

inline constexpr const char* kEvaluateDoc =
    R"(The expected gains of poses.

Warns (UserWarning) if most poses do not see the map, with the likely mistake.

Parameters
----------
T_world_camera : array_like, (..., 4, 4)
strict : bool
    Raise ValueError for an invalid pose (not finite, or not rigid within 1e-3) instead of returning
    the gain NaN.
control : BatchControl, optional

Returns
-------
ndarray, (...), float64
    [nat]; with trace or the surface gain [m**2]. NaN for invalid poses, and for poses that a stop
    left out. A single pose gives a scalar.)";

inline constexpr const char* kEvaluateDetailedDoc =
    R"(The expected gains of poses in detail.

Parameters
----------
T_world_camera, strict, control
    As ``evaluate``.

Returns
-------
ndarray, (...), structured
    Fields with all gains: gain, rays, hits, status (index into ``VIEW_STATUS_NAMES``). Paper:
    exploration and refinement (the parts of the gain from unknown and from occupied voxels),
    posterior_entropy if enabled, unknown_voxels and occupied_voxels (numbers of distinct voxels;
    the latter also with combined). Surface and combined: area (expected new surface [m**2]).
    Combined: refinement_saturated (refinement of known surface [nat]). Fields of other gains are
    NaN, or 0 for counts. A single pose gives a scalar.)";

inline constexpr const char* kBestDoc =
    R"(The k best poses, exact: scores all poses.

Parameters
----------
T_world_camera : array_like, (..., 4, 4)
k : int
costs : array_like, (n,), optional
    Costs to subtract from the gains, in their unit.
measure : callable, optional
    Custom gain that replaces the evaluator's, as in ``evaluate_own``; called for one view at a
    time.
control : BatchControl, optional
    A stop returns the best so far.

Returns
-------
BestViews
    Best first, ties to the lower index. Fewer than k if fewer poses are valid.)";

inline constexpr const char* kRaceDoc =
    R"(The k best poses with high probability; see ``best``.

Scores all poses with about 400 of their rays, and then the best of them in full: max(24, 4 k, 5 %),
or 1.6 % with the surface and combined gains. Cost: about a sixth of ``best`` for 500 poses or more,
less for larger images.

Parameters
----------
T_world_camera, k, costs, measure, control
    As ``best``; the measure is first called with few rays.
deadline : float, optional
    Time limit of the call [s], at least 0. At most half of it goes to the first stage. Threads
    finish their current views.
seed : int
    Selects the rays of the first stage with the paper's gain; ignored with the other gains.

Returns
-------
BestViews)";

inline constexpr const char* kBestSetDoc =
    R"(Up to k poses with a large gain together, chosen greedily.

With the gains "surface" and "combined", surface that several poses are expected to show counts
once.

Cost: up to k times some calls of ``evaluate``, and memory for the voxels that rays hit.

Parameters
----------
T_world_camera, k
    As ``best``.
control : BatchControl, optional
    A stop returns the poses chosen so far.

Returns
-------
ViewSet)";

inline constexpr const char* kPlanTourDoc =
    R"(Poses with a large gain together, as in ``best_set``, and a short path through them.

Chooses each view by its marginal gain minus its costs: its own cost, and that of the detour to it.
Views that cost more than they gain are left out, except the first. Cost: ``best_set``, and two
calls of way per pose and stop.

Parameters
----------
T_world_camera : array_like, (..., 4, 4)
way : callable or array_like, (n + 1, n), optional
    ``way(i, j)`` returns the cost of the path from pose i to pose j, in a unit of your choice such
    as seconds. i = -1 is the current pose; inf means that there is no path. Or a table of these
    costs, with the row of the current pose last. Default: paths cost nothing.
max_stops : int, optional
    Default: no limit.
first : int, optional
    This pose is chosen first, whatever its gain and cost.
cost_per_way : float
    Cost per unit of way, in the gain's unit.
budget : float, optional
    Limit of the total path cost, in the unit of way.
per_way : bool
    Choose by gain per path cost instead of gain minus cost. Use it with a budget.
costs : array_like, (n,), optional
    Cost of each pose itself, subtracted from its gain.
least_area : float
    Minimum new surface [m**2] of each stop after the first; ignored with gain "paper".
control : BatchControl, optional
    A stop returns a tour of the poses chosen so far.

Returns
-------
ViewTour
    Views in the order of the path.)";

inline constexpr const char* kApproximateDoc =
    R"(Estimates of the gains from some of each view's rays.

Cost: a third of ``evaluate`` at the default share, less for smaller shares.

Parameters
----------
T_world_camera : array_like, (..., 4, 4)
share : float
    Largest fraction of a view's rays to trace, in (0, 1]; 1 gives the exact gain with standard
    error 0.
seed : int
    Selects the rays.
control : BatchControl, optional
    Poses after a stop have NaN.

Returns
-------
ndarray, (...), structured
    Fields: gain and standard_error in the unit of ``evaluate``, rays (number of traced rays). A
    single pose gives a scalar.)";

}  // namespace viewgain::python
