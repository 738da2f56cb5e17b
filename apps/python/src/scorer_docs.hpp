// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace viewgain::python {

// Docstrings of the class ViewScorer.

inline constexpr const char* kScorerDoc =
    R"(Takes depth frames or labelled voxels and returns gains of camera poses.

Keeps a map, its scene and its evaluator up to date. ``add`` frames, or ``set`` labels; then
``evaluate`` poses, or ask for the ``best``.

Parameters
----------
sensor : Sensor
voxel_size : float, optional
    [m]; default: 0.005.
workspace : array_like, (2, 3), optional
    Lowest and highest corner of the mapped space, grid frame [m]; default: -0.25 to 0.25 around the
    origin.
T_world_grid : array_like, (4, 4), optional
    Pose of the grid frame in the world; default: identity.
prior_sigma : float, optional
    Standard deviation of the surface in an unknown voxel [m]; default: ``default_prior_sigma``.
support_plane : float, optional
    Height z of the table [m]. Measured depths of the table mark free space, but never make a voxel
    occupied.
boxes : array_like, (n, 2, 3), optional
    Known obstacles: lowest and highest corners, world frame [m]. They block rays and bodies.
    Measured depths of obstacles only mark free space.
meshes : iterable of (vertices, triangles), optional
    Obstacles as triangles: (n, 3), world frame [m], and (m, 3) indices.
gain : {"combined", "surface", "paper"}
    "combined": expected new surface, and refinement of known surface [nat]. "surface": expected new
    surface [m**2]. "paper": entropy removed [nat].
criterion : {"log_diagonal", "log_determinant", "trace"}
    Used by gain "paper". "trace" cannot be used with gain "combined".
pixel_stride : int
    Every s-th pixel of every s-th row is a ray.
weights : iterable of (box, weight)
    Task weights, as in ``GainEvaluator``.
refinement_weight : float, optional
    As in ``GainEvaluator``.
object_size : float, optional
    Longest side of the object [m]; default: that of its seen part.
body_size : array_like, (3,), optional
    Width, height, depth of the camera's housing, flange frame [m]; default: the sensor's. With a
    body, ``best`` omits poses where it has no room.
clearance : float
    Margin around the body [m].
jump_edges : bool
    Remove flying pixels.
coarsest : int
    As in ``FrameIntegrator``.
fine : array_like, (n, 2, 3), optional
    As in ``FrameIntegrator``.
finest : int
    As in ``FrameIntegrator``.
map : BeliefGrid or path-like, optional
    A map to continue, which is copied, or its file: a .vdb of ``save`` or another map, or an
    OctoMap .ot or .bt. Cannot be combined with voxel_size, workspace and T_world_grid.
tracer : {"automatic", "embree", "sweep"}
    Tracer, as in ``GainEvaluator``. Does not affect results.
num_threads : int
    0: all hardware threads. Does not affect results.

Notes
-----
``evaluate``, ``best``, ``scene`` and ``evaluator`` may run in any thread at any time. During a
change of the map they use the map before or after that change. ``save``, ``consistency`` and
``grid`` wait until a running change ends. The GIL is released. Pickles hold settings and map, but
not the frames that ``consistency`` compares. Cost of a change: that of changing the map, and some
milliseconds for the scene.)";

inline constexpr const char* kScorerAddDoc = R"(Adds a depth frame to the map.

Removes flying pixels, marks known obstacles and updates the hazard of unknown space.

Parameters
----------
depth : array_like, (height, width), floating point
    As in ``FrameIntegrator.integrate``.
T_world_camera : array_like, (4, 4)
pose_sigma : array_like, (2,), optional
    Uncertainty of this pose in addition to the sensor's pose_sigma [m], [rad].
amplitude : array_like, (height, width), floating point, optional
    As in ``FrameIntegrator.integrate``.

Returns
-------
MapUpdate
    Its verdict states whether the frame could be used.)";

inline constexpr const char* kScorerSetDoc = R"(Labels a box of voxels.

Labelled voxels add no refinement to the gain. Cost: one pass over the labels, and the scene's
update.

Parameters
----------
first : array_like, (3,), whole numbers
    Lowest voxel of the box, on the grid's lattice.
labels : array_like, (nx, ny, nz), whole numbers
    0 unknown, 1 free, 2 occupied.

Returns
-------
int
    Number of changed voxels.)";

inline constexpr const char* kScorerForgetDoc =
    R"(Resets the voxels of a region to unknown, for example after objects have moved.

Parameters
----------
region : array_like, (2, 3)
    Lowest and highest corner, grid frame [m]; may be infinite.

Returns
-------
int
    Number of voxels that were known.)";

inline constexpr const char* kScorerEvaluateDoc = R"(The gain of each pose on the current map.

Cost and Ctrl-C: as ``GainEvaluator.evaluate``.

Parameters
----------
T_world_camera : array_like, (..., 4, 4)
measure : callable, optional
    Custom gain, as in ``GainEvaluator.evaluate_own``.
strict : bool
    Raise ValueError for an invalid pose.
control : BatchControl, optional

Returns
-------
ndarray, (...), float64
    NaN for an invalid pose.)";

inline constexpr const char* kScorerBestDoc =
    R"(The k best poses with high probability, in two stages: as ``GainEvaluator.race``.

With a body, omits poses where the body has no room, or where over 20 % of the view is too near.

Parameters
----------
T_world_camera : array_like, (..., 4, 4)
k : int
costs : array_like, (n,), optional
    Costs to subtract from the gains, in their unit.
deadline : float, optional
    Time limit of the call [s]; default: none.
control : BatchControl, optional

Returns
-------
BestViews
    Best first; fewer than k if fewer poses are valid and feasible. A gain of 0 means that the view
    would show nothing new.)";

inline constexpr const char* kScorerConsistencyDoc =
    R"(How well the frames added so far agree.

Cost: 50 ms; 0.5 s if frames disagree.

Returns
-------
FrameConsistency)";

inline constexpr const char* kScorerLoadDoc =
    R"(A scorer that continues a file, as with ``map``.

Parameters
----------
path : path-like
    A .vdb of ``save`` or another map, or an OctoMap .ot or .bt.
*args, **settings
    As for the class: the sensor, and settings other than the map's layout.

Returns
-------
ViewScorer)";

inline constexpr const char* kScorerSaveDoc =
    R"(Writes the map as a .vdb file, atomically; ``load`` continues it.

Parameters
----------
path : path-like)";

}  // namespace viewgain::python
