// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace viewgain::python {

// What the class GainEvaluator and its methods say of themselves.

inline constexpr const char* kEvaluatorDoc =
    R"(Scores camera poses against a scene by expected information gain.

Results are the same bits for any number of threads, and the same as from C++. Poses are
``T_world_camera`` arrays (..., 4, 4) that map the optical frame (x right, y down, z forward) to the
world [m]: C-contiguous float64 is read in place, other real dtypes are converted once.

Parameters
----------
scene : VoxelScene
sensor : Sensor
gain : {"combined", "surface", "paper"}
    What a view's gain counts: the new surface that it is expected to show and refining known surface
    [nat], new surface alone [m**2], or the entropy that it removes [nat].
criterion : {"log_diagonal", "log_determinant", "trace"}
    How the paper's gain measures uncertainty; gains are in nats, for trace in m**2. The combined gain
    always goes by log_diagonal and refuses trace.
pixel_stride : int
    Every s-th pixel of every s-th row.
prior_sigma : float, optional
    Standard deviation of an unknown voxel [m]; the map's unless given.
min_range, max_range : float, optional
    Along the ray [m]; the sensor's unless given. Nothing nearer than min_range gains, but known
    surface there blocks rays.
weights : iterable of (box, weight), optional
    Task weights >= 0 of parts of the workspace: boxes (2, 3) in the grid's frame [m]. The last that
    holds a voxel's centre counts, 1 outside all.
refinement_weight : float, optional
    Weight of refining against finding new surface, with "combined" alone. Default: 1.
posterior_entropy : bool
    Let ``evaluate_detailed`` have it, too: with "paper" alone, some 4 % slower.
tracer : {"automatic", "embree", "sweep"}
    How rays meet voxels: by Embree's BVH, faster for images of under 100 rays in a map that stays, or by
    sweeping cells from near to far, as unless told otherwise. Never changes a result.
num_threads : int
    0: all hardware threads.

Notes
-----
Methods may run in many threads at once and leave the GIL while they work; Ctrl-C ends a batch.

Cost: linear in poses and rays per pose; some 120 million rays a second on two threads for a map of 128**3
voxels by the paper's gain, which is 4,800 images of 176x144 pixels; a quarter of that by the surface gain,
a fifth by the combined one. Making an evaluator undoes the lens distortion once: 1 ms for 176x144
pixels. Properties take constant time.)";

inline constexpr const char* kWithSceneDoc =
    R"(The evaluator of another scene, for following a map as it grows.

It has the sensor, the settings and the threads of this one, which stays as it is; nothing is computed
anew. Cost: some microseconds; by the surface and the combined gain the hazard and the known surface of a
scene that has neither yet, some milliseconds. Its results are those of an evaluator made for that scene, whose
map's ``prior_sigma`` counts unless one was given.

Parameters
----------
scene : VoxelScene
    Such as ``VoxelScene.update`` returns.

Returns
-------
GainEvaluator)";

inline constexpr const char* kEvaluateDoc =
    R"(The expected gains of poses.

Warns (UserWarning) if most poses do not see the map, and of the likely mistake.

Parameters
----------
T_world_camera : array_like, (..., 4, 4)
strict : bool
    Raise ValueError for a bad pose (not finite, rotation or last row off by more than 1e-3) instead
    of giving it the gain NaN.
control : BatchControl, optional

Returns
-------
ndarray, (...), float64
    [nat], for trace and the surface gain [m**2]; NaN for bad poses and for those not reached before a stop. A single
    pose gives a scalar.)";

inline constexpr const char* kEvaluateDetailedDoc =
    R"(The expected gains of poses and what they are made of.

Parameters
----------
T_world_camera, strict, control
    As ``evaluate``.

Returns
-------
ndarray, (...), structured
    By the paper's gain: gain = exploration (unknown voxels) + refinement (occupied ones),
    posterior_entropy if asked for, unknown_voxels and occupied_voxels (distinct; occupied_voxels by the combined gain, too). By the others: area (new surface
    to be expected [m**2]; gain, by the surface gain), refinement_saturated (combined [nat]). By all:
    rays, hits, status (index into ``VIEW_STATUS_NAMES``). Of the others a part is NaN, a count 0. A
    single pose gives a scalar.)";

inline constexpr const char* kBestDoc =
    R"(The k best poses, exactly: all are scored.

Parameters
----------
T_world_camera : array_like, (..., 4, 4)
k : int
costs : array_like, (n,), optional
    Subtracted from the gains, in their unit.
measure : callable, optional
    A gain of your own in the evaluator's place, as of ``evaluate_own``; asked for one view after the other.
control : BatchControl, optional
    After a stop the result is what is best of those scored so far.

Returns
-------
BestViews
    Best first, ties to the lower index. Fewer than k where fewer poses have a gain: bad poses are never
    chosen.)";

inline constexpr const char* kRaceDoc =
    R"(The k best poses, very probably; see ``best``.

All poses are scored by about 400 of their rays, and the best max(24, 4 k, 5 %) of them in
full (1.6 % by the surface and the combined gain). Cost: some 6 times less than ``best`` for 500 poses
and more, the less the larger the images.

Parameters
----------
T_world_camera, k, costs, measure, control
    As ``best``; the measure is asked about few rays first.
deadline : float, optional
    Time limit of the call [s], at least 0: half of it for estimates of poses from all over the list, the
    rest for scoring the most promising in full. Views that threads are at are finished.
seed : int
    Which rays, by the paper's gain; by the others they are in the middle.

Returns
-------
BestViews)";

inline constexpr const char* kBestSetDoc =
    R"(Up to k poses that are good together, chosen one after the other.

By gains "surface" and "combined" two looks at one place are not two chances: a set is worth what
the views show of each place together, at most what is to be expected there.

Cost: up to k times that of some calls of ``evaluate``, and memory for the voxels that are touched.

Parameters
----------
T_world_camera, k
    As ``best``.
control : BatchControl, optional
    After a stop the result is what was chosen so far.

Returns
-------
ViewSet)";

inline constexpr const char* kPlanTourDoc =
    R"(Poses that are good together, as ``best_set``, and a short way through them.

Each choice is by what a view adds to those chosen before it less what it costs: its own cost, and
what it adds to the way through the others. The first is chosen even if it is not worth its cost, others
only if they are. Cost: that of ``best_set``, and two calls of way for every pose and stop.

Parameters
----------
T_world_camera : array_like, (..., 4, 4)
way : callable or array_like, (n + 1, n), optional
    ``way(i, j)`` is what the way from pose i to pose j costs, i being -1 where the camera is, in a unit of
    your own, say seconds of an arm; inf: there is none, or it is vetoed. Or a table of these, last the row
    from where the camera is. Without it ways cost nothing.
max_stops : int, optional
    All unless given.
first : int, optional
    This pose is chosen first, whatever it gains and costs.
cost_per_way : float
    Of a unit of way, in the gain's unit.
budget : float, optional
    Of all ways together, in the unit of way: no stop is chosen beyond it.
per_way : bool
    Choose what adds most per way, instead of what adds most less its cost: for a budget.
costs : array_like, (n,), optional
    Of each pose by itself, subtracted from its gain.
least_area : float
    Stops beyond the first that add less new surface are not chosen [m**2]; not by gain "paper".
control : BatchControl, optional
    After a stop the result is of what was chosen so far.

Returns
-------
ViewTour
    In the order in which they are driven to.)";

inline constexpr const char* kApproximateDoc =
    R"(Estimates of the gains from a part of each view's rays.

Cost: goes down with the share, 3 times faster than ``evaluate`` at the default's.

Parameters
----------
T_world_camera : array_like, (..., 4, 4)
share : float
    Of a view's rays that are traced at most, in (0, 1]; at 1 the gain itself, standard error 0.
seed : int
    Which rays.
control : BatchControl, optional
    What was not reached before a stop is NaN.

Returns
-------
ndarray, (...), structured
    gain, standard_error, in the unit of ``evaluate``, rays that were traced. A single pose gives a scalar.)";

}  // namespace viewgain::python
