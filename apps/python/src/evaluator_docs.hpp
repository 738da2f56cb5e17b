// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace viewgain::python {

// What the class GainEvaluator and its methods say of themselves.

inline constexpr const char* kEvaluatorDoc =
    R"(Scores camera poses against a scene by expected information gain.

Results are bit-identical for any number of threads, and to C++. Poses are ``T_world_camera`` arrays
(..., 4, 4) that map the optical frame (x right, y down, z forward) to the world [m]; C-contiguous
float64 is read in place, other real dtypes are converted once.

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
    Along the ray [m]; default: the sensor's. Nothing nearer than min_range gains, but known surface
    there blocks rays.
weights : iterable of (box, weight), optional
    Task weights >= 0 of parts of the workspace: boxes (2, 3) in the grid frame [m]. The last box
    that contains a voxel's centre counts; 1 outside all.
refinement_weight : float, optional
    Weight of refinement relative to new surface; only with "combined". Default: 1.
posterior_entropy : bool
    Also compute it in ``evaluate_detailed``; only with "paper"; about 4 % slower.
tracer : {"automatic", "embree", "sweep"}
    How to find the voxels that rays hit: Embree's BVH, which is faster for images of under 100 rays
    in a constant map, or a sweep over cells from near to far, the default. Does not affect results.
num_threads : int
    0: all hardware threads.

Notes
-----
Methods may run in many threads at once and release the GIL; Ctrl-C ends a batch.

Cost: linear in poses and rays per pose; about 120 million rays per second on two threads for a map
of 128**3 voxels with the paper's gain, or 4,800 images of 176x144 pixels; a quarter of that with
the surface gain, a fifth with the combined one. The constructor removes the lens distortion once:
1 ms for 176x144 pixels. Properties take constant time.)";

inline constexpr const char* kWithSceneDoc =
    R"(An evaluator for another scene, to follow a growing map.

It shares the sensor, settings and threads of this one, which does not change. Results are those of
a new evaluator for that scene, with the map's ``prior_sigma`` unless one was given. Cost: some
microseconds; for surface and combined gains also the hazard and the known surface of a new scene,
some milliseconds.

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
    [nat], for trace and the surface gain [m**2]; NaN for invalid poses and for those after a stop.
    A single pose gives a scalar.)";

inline constexpr const char* kEvaluateDetailedDoc =
    R"(The expected gains of poses in detail.

Parameters
----------
T_world_camera, strict, control
    As ``evaluate``.

Returns
-------
ndarray, (...), structured
    All gains: gain, rays, hits, status (index into ``VIEW_STATUS_NAMES``). Paper: exploration
    (unknown voxels) + refinement (occupied ones) = gain, posterior_entropy if enabled,
    unknown_voxels and occupied_voxels (distinct; the latter also for combined). Surface, combined:
    area (expected new surface [m**2]; surface: = gain). Combined: refinement_saturated [nat]. Other
    fields are NaN, counts 0. A single pose gives a scalar.)";

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
    Best first, ties to the lower index. Fewer than k if fewer poses have a gain; invalid poses are
    never chosen.)";

inline constexpr const char* kRaceDoc =
    R"(The k best poses with high probability; see ``best``.

Scores all poses with about 400 of their rays, and the best max(24, 4 k, 5 %) of them in full (1.6 %
with surface and combined gains). Cost: about a sixth of ``best`` for 500 poses or more, less for
larger images.

Parameters
----------
T_world_camera, k, costs, measure, control
    As ``best``; the measure is first called with few rays.
deadline : float, optional
    Time limit of the call [s], at least 0: at most half of it for estimates of poses from all over
    the list, the rest for full scores of the best ones. Threads finish their current views.
seed : int
    Selects the rays with the paper's gain; with the others they lie in the middle.

Returns
-------
BestViews)";

inline constexpr const char* kBestSetDoc =
    R"(Up to k poses that are good together, chosen greedily.

With gains "surface" and "combined", the gain of a set counts the expected surface of each place
once.

Cost: up to k times some calls of ``evaluate``, and memory for the touched voxels.

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
    R"(Poses that are good together, as ``best_set``, and a short path through them.

Chooses each view by its marginal gain minus its costs: its own cost, and the increase of the path
through the others. The first view is chosen even if it is not worth its cost, others only if they
are. Cost: ``best_set``, and two calls of way per pose and stop.

Parameters
----------
T_world_camera : array_like, (..., 4, 4)
way : callable or array_like, (n + 1, n), optional
    ``way(i, j)`` is the cost of the path from pose i to pose j, in a unit of your choice such as
    seconds; i = -1 is the current pose; inf: no path, or vetoed. Or a table of these, with the row
    of the current pose last. Default: paths are free.
max_stops : int, optional
    Default: no limit.
first : int, optional
    This pose is chosen first, regardless of its gain and cost.
cost_per_way : float
    Cost per unit of way, in the gain's unit.
budget : float, optional
    Limit of the total path cost, in the unit of way.
per_way : bool
    Choose by gain per path cost instead of gain minus cost, for a budget.
costs : array_like, (n,), optional
    Cost of each pose itself, subtracted from its gain.
least_area : float
    Minimum new surface [m**2] of each stop after the first; ignored with gain "paper".
control : BatchControl, optional
    A stop returns a tour of the poses chosen so far.

Returns
-------
ViewTour
    In driving order.)";

inline constexpr const char* kApproximateDoc =
    R"(Estimates of the gains from a share of each view's rays.

Cost: decreases with the share; a third of ``evaluate`` at the default.

Parameters
----------
T_world_camera : array_like, (..., 4, 4)
share : float
    Largest share of a view's rays to trace, in (0, 1]; 1 gives the exact gain with standard error
    0.
seed : int
    Selects the rays.
control : BatchControl, optional
    Poses after a stop have NaN.

Returns
-------
ndarray, (...), structured
    gain and standard_error in the unit of ``evaluate``, and number of traced rays. A single pose
    gives a scalar.)";

}  // namespace viewgain::python
