// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace viewgain::python {

// Docstrings of the class ViewPlanner.

inline constexpr const char* kPlannerDoc =
    R"(Next-best views step by step: takes frames and proposes views, for a robot's program.

``add`` a frame, ``propose`` candidates, ``rank`` them and ask ``should_stop``. Then move the
camera, report the result with ``tried``, and ``add`` the next frame.

Parameters
----------
sensor : Sensor
voxel_size : float
    [m]
workspace : array_like, (2, 3)
    Lowest and highest corner of the mapped space, grid frame [m]. Let it start at the table,
    because the space below the table stays unknown.
T_world_grid : array_like, (4, 4), optional
    Pose of the grid frame in the world; default: identity.
prior_sigma : float, optional
    Standard deviation of an unknown voxel [m]; default: ``default_prior_sigma``.
support_plane : float, optional
    Height z of the table [m]. Measured depths of the table mark free space, but hit no voxel.
boxes : array_like, (n, 2, 3), optional
    Known obstacles: lowest and highest corners, world frame [m]. They block rays and the body.
    Measured depths of obstacles mark free space, but hit no voxel.
meshes : iterable of (vertices, triangles), optional
    Obstacles as triangles: (n, 3), world frame [m], and (m, 3) indices.
gain : {"combined", "surface", "paper"}
    Gain that ranks views: expected new surface and refinement, expected new surface, or entropy
    removed.
criterion : {"log_diagonal", "log_determinant", "trace"}
    Criterion of gain "paper" and of entropies; "trace" cannot be used with gain "combined".
object_size : float, optional
    Longest side of the object [m]; default: that of its seen part.
reach : ReachRegion, optional
    Reachable camera poses. Its list of poses, if any, adds candidates.
body_size : array_like, (3,), optional
    Width, height, depth of the housing, flange frame [m]; default: the sensor's, else the SR4000's.
clearance : float
    Margin around the body [m].
jump_edges : bool
    Remove flying pixels.
check_feasibility : bool
    False: accepts all candidates except those taken or tried.
max_views, idle_views : int
    Stop after max_views views, or after idle_views views in a row that changed entropy and unknown
    voxels by less than 0.1 % (0: never).
broken_promises : int
    Stop after this many views in a row that showed less than a fifth of the predicted new surface
    (with gain "paper": entropy); 0: never. Only views at the best pose of the last ranking count.
plan, take : int
    Number of views to plan together, with a short path through them, and number of views to take
    before replanning, at most ``plan``; 1, 1: one at a time. ``rank`` returns the plan. ``propose``
    then returns those remaining views that are still good, with the generator "plan".
stop_gain : float, optional
    With gain "paper": stop when the best candidate's gain per touched voxel is below this [nat,
    m**2 for trace]. Default: 1.2; for trace 0.01 of the gain in the first ranking.
stop_area : float, optional
    With gain "surface" and "combined": stop when the largest expected new surface of a candidate,
    divided by the surface so far, is below this on average over three rankings; 0: never. Default:
    0.004.
coarsest : int
    As in ``FrameIntegrator``.
fine : array_like, (n, 2, 3), optional
    As in ``FrameIntegrator``.
finest : int
    As in ``FrameIntegrator``.
state : path-like, optional
    A file of ``save`` to continue, with the map layout given here; see ``load``.
tracer : {"automatic", "embree", "sweep"}
    Tracer, as in ``GainEvaluator``. Does not affect results.
num_threads : int
    0: all hardware threads. Does not affect results.

Notes
-----
One call at a time: a concurrent call raises RuntimeError. Calls release the GIL, except while your
generators and the predicate of ``reach`` run. Cost: some ms to make a planner, with a state also
``BeliefGrid.load``. Methods take some microseconds unless they state otherwise; ``grid`` is a copy,
0.3 ms for 128**3 voxels.)";

inline constexpr const char* kLoadDoc =
    R"(A planner that continues after ``save``, with bit-identical results.

Parameters
----------
path : path-like
sensor, **settings
    As for the saved planner; only the map's layout is checked. Add the candidates again, and call
    ``propose``. A planner that had stopped can continue with larger values of ``max_views``,
    ``idle_views`` or ``broken_promises``.

Returns
-------
ViewPlanner)";

inline constexpr const char* kSaveDoc =
    R"(Writes the state atomically, as a map with additional notes.

Omits the settings, poses, generators and the last proposal. ``BeliefGrid.load`` and the program
read the map. Cost: ``BeliefGrid.save``, and linear in the tried poses.

Parameters
----------
path : path-like)";

inline constexpr const char* kAddPosesDoc =
    R"(Adds candidates to all later proposals.

Warns (UserWarning) if most poses do not see the map, with the likely mistake.

Parameters
----------
T_world_camera : array_like, (n, 4, 4)
name : str
    Name of the generator in ``propose``.)";

inline constexpr const char* kAddGeneratorDoc =
    R"(Adds candidates that are recomputed for each proposal.

Parameters
----------
generator : callable
    Takes a copy of the map, a BeliefGrid with the views so far, and returns poses (n, 4, 4).
    Exceptions pass through. The function must not call or reference the planner, because both would
    then never be released.
name : str
    Name of the generator in ``propose``.)";

inline constexpr const char* kAddDoc =
    R"(Integrates a frame; invalidates the last proposal.

Warns (UserWarning) if almost no measured depth lies in the workspace, but most would under another
convention for poses or depths.

Cost: grows with the pixels and the crossed voxels: 12 ms for 176x144 pixels and voxels of 5 mm on
two threads.

Parameters
----------
depth : array_like, (height, width), floating point
    Along the optical axis [m]; 0, NaN or masked: no reading, inf: free up to max_range.
T_world_camera : array_like, (4, 4)
pose_sigma : array_like, (2,), optional
    Uncertainty of this pose in addition to the sensor's pose_sigma [m], [rad]; after
    ``register_frame`` use its pose_sigma.
amplitude : array_like, (height, width), optional
    [1/m**2]

Returns
-------
AddedView
    new_area is measured perpendicular to the rays, like the expected area, so oblique surface is
    larger. verdict states whether the frame could be used. A frame that cannot be used, for example
    because its pose is not rigid, leaves the map unchanged and counts as a failed view. If building
    the scene raises Error, the frame is already in the map.)";

inline constexpr const char* kAddFrameDoc =
    R"(Reads a frame of a folder and adds it, or records why it cannot be used.

Cost: reading the frame, and ``add``.

Parameters
----------
frames : FrameSequence
    From ``read_frames``.
index : int
    Negative indices count from the end.

Returns
-------
AddedView)";

inline constexpr const char* kConsistencyDoc =
    R"(How well the frames in the map agree.

Cost: 20 ms for a dozen frames, 0.5 s if they disagree.

Returns
-------
FrameConsistency)";

inline constexpr const char* kDropDoc =
    R"(Records a view without a usable frame. Cost: one pass over the map.

The view counts as a failed view; its pose is not proposed again.

Parameters
----------
verdict : str
    A value of AddedView.verdict except "used" and "carved".
T_world_camera : array_like, (4, 4), optional
    Pose of the view, if known.

Returns
-------
AddedView)";

inline constexpr const char* kRegisterFrameDoc =
    R"(Estimates the camera pose from the frame and the map. Changes nothing.

Minimises the distances of the frame's depths from the map's points along the surface normals
(Gauss-Newton), with the reported pose as prior. Then ``add`` the frame: at the estimated pose if
its status is "registered", at the reported pose for "too_little_overlap". ``drop`` a frame that is
"refused", because it contradicts the map or would move by more than five sigmas. Cost: about 100 to
300 ms per frame.

Parameters
----------
depth : array_like, (height, width), floating point
    As for ``add``.
T_world_camera : array_like, (4, 4)
    The reported pose.
sigma_translation : float
    Standard deviation of each coordinate of the camera centre [m].
sigma_rotation : float
    Standard deviation of each component of the rotation [rad].
amplitude : array_like, (height, width), optional
    [1/m**2]

Returns
-------
FrameRegistration)";

inline constexpr const char* kProposeDoc =
    R"(The candidates that are currently possible.

Exceptions of generators and of the predicate of ``reach`` pass through. Cost: 4 µs per candidate,
and the generators.

Returns
-------
Proposal)";

inline constexpr const char* kRankDoc =
    R"(The k best candidates of the proposal since the last view, or of any poses.

Cost per candidate: 2 ms in two stages, 20 ms with exact, with gain "combined" for 176x144 pixels
and a map of 128**3 voxels that is mostly unknown. Warns (UserWarning) if most of the given poses do
not see the map.

Parameters
----------
k : int
poses : array_like, (n, 4, 4), optional
    T_world_camera to rank instead of the proposal, without a check of feasibility. Invalid poses
    are omitted. Does not affect ``should_stop``.
costs : array_like, (n,), optional
    Costs to subtract from the gains, in their unit.
cost_per_metre : float
    Cost of the straight path from ``current_pose``, in the gain's unit per metre. The combined gain
    of new surface is proportional to 1 / voxel**2, so this cost should be as well.
current_pose : array_like, (4, 4), optional
    Current camera pose, T_world_camera; only its centre is used. Default: the pose of the last
    frame, or of a later ``tried`` that was reached. Plans start there too.
together : bool
    Ranks views by their marginal gain, so that they do not show the same surface twice; cannot be
    used with measure.
exact : bool
    Scores all poses in full. Default: in two stages (``GainEvaluator.race``), except with gain
    "paper". With together, views after the first are then chosen among at least 32 poses with a
    quarter of their rays.
measure : callable, optional
    Custom gain that replaces the planner's, as in ``GainEvaluator.evaluate_own``; gain and area are
    then NaN.
control : BatchControl, optional

Returns
-------
Ranking
    Its arrays are best first.)";

inline constexpr const char* kTriedDoc =
    R"(Reports a commanded pose. It is not proposed again, and is removed from the current proposal.

Call it for each pose that the robot was sent to, and for no other.

Parameters
----------
T_world_camera : array_like, (4, 4)
reached : bool
    Whether the camera reached the pose. If so, the pose counts as taken, otherwise as missed.)";

inline constexpr const char* kShouldStopDoc =
    R"(Reason to stop, if any.

Returns
-------
str or None
    After ``add``: max_views, idle or promises. After ``propose``: no_candidates or unreachable.
    After ``rank`` of the proposal: gain, area or, with costs, cost (every view costs more than it
    gains).)";

}  // namespace viewgain::python
