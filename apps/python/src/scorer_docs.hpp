// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace viewgain::python {

// Docstrings of the class ViewScorer.

inline constexpr const char* kScorerDoc =
    R"(Takes depth frames or labelled voxels and returns gains of camera poses.

Contains a map, and keeps its scene and evaluator up to date. ``add`` frames, or ``set`` labels.
Then ``evaluate`` poses, or ask for the ``best``.

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
    Standard deviation of the surface position in an unknown voxel [m]; default:
    ``default_prior_sigma``.
support_plane : float, optional
    Height z of the table, world frame [m]. Measured depths of the table mark free space, but make
    no voxel occupied.
boxes : array_like, (n, 2, 3), optional
    Known obstacles: lowest and highest corners, world frame [m]. They block rays and the camera's
    body. Measured depths of obstacles mark free space, but make no voxel occupied.
meshes : iterable of (vertices, triangles), optional
    Known obstacles as triangle meshes: vertices (n, 3) in the world frame [m], and triangles (m, 3)
    of vertex indices.
gain : {"combined", "surface", "paper"}
    "combined": expected new surface, and refinement of known surface [nat]. "surface": expected new
    surface [m**2]. "paper": entropy removed [nat].
criterion : {"log_diagonal", "log_determinant", "trace"}
    Measure of entropy for gain "paper". "trace" cannot be used with gain "combined".
pixel_stride : int
    s: traces every s-th pixel of every s-th row.
weights : iterable of (box, weight)
    Task weights, as in ``GainEvaluator``.
refinement_weight : float, optional
    As in ``GainEvaluator``.
object_size : float, optional
    Longest side of the object [m]; default: that of the part seen so far.
body_size : array_like, (3,), optional
    Width, height and depth of the camera's housing (its body), flange frame [m]; default: the
    sensor's. If the size is known, ``best`` omits poses at which the body has no room.
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
    A map to start from. A BeliefGrid is copied. A file is a .vdb map, for example from ``save``, or
    an OctoMap .ot or .bt. Cannot be used with voxel_size, workspace and T_world_grid.
tracer : {"automatic", "embree", "sweep"}
    Tracer, as in ``GainEvaluator``. Does not affect results.
num_threads : int
    0: all hardware threads. Does not affect results.

Notes
-----
``evaluate``, ``best``, ``scene`` and ``evaluator`` may run in any thread at any time. While the map
changes, they use the map before or after the change. ``save``, ``consistency`` and ``grid`` wait
for the end of the change. The GIL is released. Pickles contain settings and map, but not the frames
that ``consistency`` compares. Cost of a change: that of changing the map, and some milliseconds for
the scene.)";

inline constexpr const char* kScorerAddDoc = R"(Adds a depth frame to the map.

Also removes flying pixels, marks known obstacles and updates the hazard, which is the rate at which
rays meet the surface in unknown space.

Parameters
----------
depth : array_like, (height, width), floating point
    As in ``FrameIntegrator.integrate``.
T_world_camera : array_like, (4, 4)
pose_sigma : array_like, (2,), optional
    Uncertainty of this pose in addition to the sensor's pose_sigma: standard deviations of
    translation [m] and rotation [rad].
amplitude : array_like, (height, width), floating point, optional
    As in ``FrameIntegrator.integrate``.

Returns
-------
MapUpdate
    Its verdict states whether the frame could be used.)";

inline constexpr const char* kScorerSetDoc = R"(Sets the states of the voxels in a box.

Labelled voxels add no refinement to the gain. Cost: one pass over the labels, and an update of the
scene.

Parameters
----------
first : array_like, (3,), whole numbers
    Index of the lowest voxel of the box, on the grid's lattice; ``BeliefGrid.min_index`` for the
    corner of the workspace.
labels : array_like, (nx, ny, nz), whole numbers
    0 unknown, 1 free, 2 occupied.

Returns
-------
int
    Number of changed voxels.)";

inline constexpr const char* kScorerForgetDoc =
    R"(Makes the voxels of a region unknown again, for example when objects have moved.

Parameters
----------
region : array_like, (2, 3)
    Lowest and highest corner, grid frame [m]. Bounds may be infinite.

Returns
-------
int
    Number of voxels that were known.)";

inline constexpr const char* kScorerEvaluateDoc = R"(The gain of each pose on the current map.

Ctrl-C ends the call. Cost: that of ``GainEvaluator.evaluate``.

Parameters
----------
T_world_camera : array_like, (..., 4, 4)
measure : callable, optional
    Custom gain, as in ``GainEvaluator.evaluate_own``.
strict : bool
    If true, an invalid pose raises ValueError.
control : BatchControl, optional

Returns
-------
ndarray, (...), float64
    NaN for an invalid pose.)";

inline constexpr const char* kScorerBestDoc =
    R"(The k best poses with high probability; see ``GainEvaluator.race``.

If body_size is known, omits poses at which the body has no room or over 20 % of the view is nearer
than the sensor's min_range.

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

Cost: 50 ms; 0.5 s if they disagree.

Returns
-------
FrameConsistency)";

inline constexpr const char* kScorerLoadDoc =
    R"(A scorer that starts from a map file; the same as the argument ``map``.

Parameters
----------
path : path-like
    A .vdb map, for example from ``save``, or an OctoMap .ot or .bt.
*args, **settings
    Arguments of the class: the sensor, and settings other than the map's layout.

Returns
-------
ViewScorer)";

inline constexpr const char* kScorerSaveDoc =
    R"(Writes the map as a .vdb file, atomically. ``load`` starts a scorer from it.

Parameters
----------
path : path-like)";

}  // namespace viewgain::python
