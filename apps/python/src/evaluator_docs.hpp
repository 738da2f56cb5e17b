// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace viewgain::python {

// Docstrings of the class GainEvaluator.

inline constexpr const char* kEvaluatorDoc =
    R"(Scores camera poses in a scene by expected information gain.

Poses are ``T_world_camera``, arrays (..., 4, 4) that map the camera frame (x right, y down, z
forward) to the world [m]. C-contiguous float64 arrays are used without a copy; other real dtypes
are converted once. Results are bit-identical to those of C++, for any number of threads.

Parameters
----------
scene : VoxelScene
sensor : Sensor
gain : {"combined", "surface", "paper"}
    What the gain of a view measures. "combined": expected new surface, and refinement of known
    surface [nat]. "surface": expected new surface [m**2]. "paper": entropy removed [nat].
criterion : {"log_diagonal", "log_determinant", "trace"}
    Measure of entropy for gain "paper", whose unit is m**2 with "trace". Gain "combined" always
    uses "log_diagonal", and raises ValueError with "trace".
pixel_stride : int
    s: traces every s-th pixel of every s-th row.
prior_sigma : float, optional
    Standard deviation of the surface position in an unknown voxel [m]; default: the map's.
min_range, max_range : float, optional
    Limits of the range along the ray [m]; default: the sensor's. Voxels nearer than min_range have
    no gain, but known surface there blocks rays.
weights : iterable of (box, weight), optional
    Task weights of parts of the workspace. A box is (2, 3) in the grid frame [m], and a weight is
    at least 0. For each voxel, the last box that contains its centre counts. Outside all boxes the
    weight is 1.
refinement_weight : float, optional
    Weight of refinement relative to new surface, only for gain "combined"; default: 1.
posterior_entropy : bool
    Whether ``evaluate_detailed`` computes its field posterior_entropy, only for gain "paper". Takes
    about 4 % longer.
tracer : {"automatic", "embree", "sweep"}
    How to find the voxels in which rays end. "sweep" visits cells of the map from near to far.
    "embree" builds a bounding volume hierarchy and uses it. "automatic" uses "embree" for scenes
    that get many views of under 100 rays, otherwise "sweep". Does not affect results.
num_threads : int
    0: all hardware threads.

Notes
-----
Methods may run in many threads at once and release the GIL; Ctrl-C ends a batch.

Cost: linear in poses and rays per pose. With gain "paper", two threads score about 4,800 poses of
176x144 pixels per second in a map of 128**3 voxels. With gain "surface" they score a quarter of
that, and with "combined" a fifth. The constructor computes the rays of all pixels, in 1 ms for
176x144 pixels. Properties take constant time.)";

inline constexpr const char* kWithSceneDoc =
    R"(An evaluator for another scene, for example of a growing map.

It has the sensor, settings and threads of this evaluator, which does not change. ``prior_sigma`` is
that of the new map, unless it was set. Cost: some microseconds. With gain "surface" or "combined",
it is some milliseconds if the scene was not used before.

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
    If true, an invalid pose raises ValueError. Otherwise its gain is NaN. A pose is invalid if it
    is not finite, or not rigid within 1e-3.
control : BatchControl, optional

Returns
-------
ndarray, (...), float64
    [nat]; with gain "surface" or criterion "trace" [m**2]. NaN for invalid poses, and for poses
    that were not scored because of a stop. A single pose gives a scalar.)";

inline constexpr const char* kEvaluateDetailedDoc =
    R"(The expected gains of poses with all their parts.

Parameters
----------
T_world_camera, strict, control
    As ``evaluate``.

Returns
-------
ndarray, (...), structured
    Fields for all gains: gain, rays (number of rays), hits (number of rays that end in a voxel),
    status (index into ``VIEW_STATUS_NAMES``). Fields for "paper": exploration (gain from unknown
    voxels), refinement (gain from occupied voxels), posterior_entropy (if enabled), unknown_voxels
    (number of unknown voxels in which rays end). Field for "paper" and "combined": occupied_voxels
    (the same for occupied voxels). Field for "surface" and "combined": area (expected new surface
    [m**2]). Field for "combined": refinement_saturated (refinement of known surface [nat]). Fields
    for other gains are NaN, or 0 for numbers. A single pose gives a scalar.)";

inline constexpr const char* kBestDoc =
    R"(The k best poses. Scores all poses.

Parameters
----------
T_world_camera : array_like, (..., 4, 4)
k : int
costs : array_like, (n,), optional
    Costs to subtract from the gains, in their unit.
measure : callable, optional
    Custom gain that replaces the evaluator's, as in ``evaluate_own``. It is called for one view at
    a time.
control : BatchControl, optional
    A stop returns the best so far.

Returns
-------
BestViews
    Best first; if gains are equal, the lower index comes first. Fewer than k if fewer poses are
    valid.)";

inline constexpr const char* kRaceDoc =
    R"(The k best poses with high probability. Faster than ``best``.

The first stage estimates the gains of all poses from about 400 of their rays. The second stage
scores the best of them with all rays: at least 24 poses, at least 4 k, and at least 1.6 % of all
poses (5 % with gain "paper"). Cost: about a sixth of ``best`` for 500 poses or more; less for
larger images.

Parameters
----------
T_world_camera, k, costs, measure, control
    As ``best``. In the first stage, measure is called with the hits of few rays.
deadline : float, optional
    Time limit of the call [s], at least 0. The first stage gets at most half of it. After the
    limit, threads finish their current views.
seed : int
    Selects the rays of the first stage with gain "paper"; other gains ignore it.

Returns
-------
BestViews)";

inline constexpr const char* kBestSetDoc =
    R"(A set of up to k poses with a large gain together, chosen greedily.

With gain "surface" and "combined", surface that several poses are expected to show counts once.

Cost: up to k times that of some calls of ``evaluate``, and memory for the voxels in which rays end.

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
    R"(A set of poses with a large gain together, and a short path through them.

Chooses the poses one after the other, as ``best_set`` does, by their marginal gain minus costs. The
marginal gain is the increase of the set's gain. The costs are that of the pose itself and that of
the detour to it. Except for the first, poses that cost more than they gain are omitted. Cost:
``best_set``, and two calls of way per pose and chosen pose.

Parameters
----------
T_world_camera : array_like, (..., 4, 4)
way : callable or array_like, (n + 1, n), optional
    Costs of paths, in a unit of your choice such as seconds. As a callable, ``way(i, j)`` returns
    the cost of the path from pose i to pose j, where i = -1 is the current pose. As a table, row i
    and column j have this cost, and the last row is that of the current pose. inf means that there
    is no path. Default: paths cost nothing.
max_stops : int, optional
    Largest number of poses; default: no limit.
first : int, optional
    Index of a pose that is chosen first, whatever its gain and cost.
cost_per_way : float
    Cost per unit of way, in the gain's unit.
budget : float, optional
    Limit of the total path cost, in the unit of way.
per_way : bool
    If true, chooses by marginal gain divided by path cost instead. Use it with a budget.
costs : array_like, (n,), optional
    Cost of each pose itself, subtracted from its gain.
least_area : float
    Minimum expected new surface [m**2] of each pose after the first; gain "paper" ignores it.
control : BatchControl, optional
    A stop returns a tour of the poses chosen so far.

Returns
-------
ViewTour
    The poses in the order of the path.)";

inline constexpr const char* kApproximateDoc =
    R"(Estimates of gains from some of each view's rays.

Cost: a third of ``evaluate`` at the default share, less for smaller shares.

Parameters
----------
T_world_camera : array_like, (..., 4, 4)
share : float
    Largest fraction of a view's rays to trace, in (0, 1]. With 1, gains are exact and standard
    errors 0.
seed : int
    Selects the rays.
control : BatchControl, optional
    After a stop, the remaining poses have NaN.

Returns
-------
ndarray, (...), structured
    Fields: gain and standard_error in the unit of ``evaluate``, rays (number of traced rays). A
    single pose gives a scalar.)";

}  // namespace viewgain::python
