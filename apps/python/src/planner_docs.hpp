// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace viewgain::python {

// Docstrings of the class ViewPlanner.

inline constexpr const char* kPlannerDoc =
    R"(Plans next-best views step by step, for the program of a robot.

``add`` a frame, ``propose`` candidates, ``rank`` them and ask ``should_stop``. Then move the
camera, report the result with ``tried``, and ``add`` the next frame.

Parameters
----------
sensor : Sensor
voxel_size : float
    [m]
workspace : array_like, (2, 3)
    Lowest and highest corner of the mapped space, grid frame [m]. Let it begin at the table,
    because the space below the table stays unknown.
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
    Gain that ranks views. "combined": expected new surface, and refinement of known surface [nat].
    "surface": expected new surface [m**2]. "paper": entropy removed [nat].
criterion : {"log_diagonal", "log_determinant", "trace"}
    Measure of entropy, also in gain "paper". "trace" cannot be used with gain "combined".
object_size : float, optional
    Longest side of the object [m]; default: that of the part seen so far.
reach : ReachRegion, optional
    Reachable camera poses. If the region has a list of poses, they also become candidates.
body_size : array_like, (3,), optional
    Width, height and depth of the camera's housing, flange frame [m]; default: the sensor's, or if
    it has none, the SR4000's.
clearance : float
    Margin around the camera's body [m].
jump_edges : bool
    Remove flying pixels.
check_feasibility : bool
    If false, accepts all candidates except those at which a view was taken or tried.
max_views, idle_views : int
    Stop after max_views views, or after idle_views consecutive views that changed the entropy
    removed and the number of unknown voxels by less than 0.1 %. idle_views 0: never.
broken_promises : int
    Stop after this many consecutive views that showed less than a fifth of the predicted new
    surface, or with gain "paper", removed less than a fifth of the predicted entropy; 0: never.
    Only views at the best pose of the last ranking count.
plan, take : int
    plan is the number of views to plan together, with a short path through them; 1: no planning.
    take is the number of planned views to take before replanning, at most plan. ``rank`` returns
    the plan. Until replanning, ``propose`` returns the remaining views that are still good, with
    the generator "plan".
stop_gain : float, optional
    With gain "paper": stop when the best candidate's gain, divided by the number of voxels in which
    its rays end, is below this [nat; m**2 with "trace"]. Default: 1.2; with "trace", 0.01 of the
    value in the first ranking.
stop_area : float, optional
    With gain "surface" and "combined": stop when the largest expected new surface of a candidate,
    divided by the surface area so far and averaged over three rankings, is below this; 0: never.
    Default: 0.004.
coarsest : int
    As in ``FrameIntegrator``.
fine : array_like, (n, 2, 3), optional
    As in ``FrameIntegrator``.
finest : int
    As in ``FrameIntegrator``.
state : path-like, optional
    A file of ``save`` to continue. Its map must have the layout given here; see ``load``.
tracer : {"automatic", "embree", "sweep"}
    Tracer, as in ``GainEvaluator``. Does not affect results.
num_threads : int
    0: all hardware threads. Does not affect results.

Notes
-----
One call at a time: a concurrent call raises RuntimeError. Calls release the GIL, except while your
generators and the predicate of ``reach`` run. Cost: some ms for the constructor, and with a state,
that of ``BeliefGrid.load``. Methods take some microseconds unless they state otherwise. ``grid``
copies the map, in 0.3 ms for 128**3 voxels.)";

inline constexpr const char* kLoadDoc =
    R"(A planner that continues from a file of ``save``, with bit-identical results.

Parameters
----------
path : path-like
sensor, **settings
    As for the saved planner; only the map's layout is checked. Then add the candidates again, and
    call ``propose``. A planner that had stopped can continue with larger values of ``max_views``,
    ``idle_views`` or ``broken_promises``.

Returns
-------
ViewPlanner)";

inline constexpr const char* kSaveDoc =
    R"(Writes the state atomically, as a map with additional notes.

Does not write the settings, the candidates and the last proposal. ``BeliefGrid.load`` and the
program can read the map. Cost: that of ``BeliefGrid.save``, and linear in the tried poses.

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
    R"(Adds a function that computes candidates for each proposal.

Parameters
----------
generator : callable
    Takes a copy of the map, a BeliefGrid with the views so far, and returns poses (n, 4, 4). Its
    exceptions pass through. It must not call the planner. It must not refer to the planner either,
    because then both would never be released.
name : str
    Name of the generator in ``propose``.)";

inline constexpr const char* kAddDoc =
    R"(Integrates a frame into the map. The last proposal becomes invalid.

Warns (UserWarning) if almost no measured depth lies in the workspace, but most would do so with
another convention for poses or depths.

Cost: grows with the number of pixels and of voxels along their rays. It is 12 ms for 176x144 pixels
and voxels of 5 mm on two threads.

Parameters
----------
depth : array_like, (height, width), floating point
    Along the optical axis [m]. 0, NaN or masked: no measured depth. inf: free up to max_range.
T_world_camera : array_like, (4, 4)
pose_sigma : array_like, (2,), optional
    Uncertainty of this pose in addition to the sensor's pose_sigma: standard deviations of
    translation [m] and rotation [rad]. After ``register_frame``, use its pose_sigma.
amplitude : array_like, (height, width), optional
    [1/m**2]

Returns
-------
AddedView
    verdict states whether the frame could be used. A frame that cannot be used, for example because
    its pose is not rigid, leaves the map unchanged and counts as a failed view. new_area is
    measured perpendicular to the rays, like the expected area; the actual area of oblique surface
    is larger. If building the scene raises Error, the frame is already in the map.)";

inline constexpr const char* kAddFrameDoc =
    R"(Reads a frame from a folder and adds it. If it cannot be used, records why.

Cost: reading the frame, and that of ``add``.

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

It counts as a failed view, and its pose is not proposed again.

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

Minimises the distances between the frame's depths and the map's points along the surface normals
(Gauss-Newton), with the reported pose as prior. Afterwards, ``add`` the frame at the estimated pose
if the status is "registered", or at the reported pose if it is "too_little_overlap". ``drop`` the
frame if it is "refused", because it contradicts the map or would move by more than five sigmas.
Cost: about 100 to 300 ms per frame.

Parameters
----------
depth : array_like, (height, width), floating point
    As for ``add``.
T_world_camera : array_like, (4, 4)
    The reported pose.
sigma_translation : float
    Uncertainty of the reported pose: standard deviation of each coordinate of the camera centre
    [m].
sigma_rotation : float
    Standard deviation of each component of its rotation [rad].
amplitude : array_like, (height, width), optional
    [1/m**2]

Returns
-------
FrameRegistration)";

inline constexpr const char* kProposeDoc =
    R"(The candidates that are currently feasible.

Exceptions of generators and of the predicate of ``reach`` pass through. Cost: 4 µs per candidate,
and that of the generators.

Returns
-------
Proposal)";

inline constexpr const char* kRankDoc =
    R"(The k best candidates of the last proposal, or the k best of other poses.

Warns (UserWarning) if most of the given poses do not see the map. Cost with gain "combined",
176x144 pixels and a map of 128**3 voxels that is mostly unknown: 2 ms per candidate, or 20 ms with
exact.

Parameters
----------
k : int
poses : array_like, (n, 4, 4), optional
    T_world_camera to rank instead of the proposal. Their feasibility is not checked. Invalid poses
    are omitted. Such a ranking does not affect ``should_stop``.
costs : array_like, (n,), optional
    Costs to subtract from the gains, in their unit.
cost_per_metre : float
    Cost of the straight path from ``current_pose``, in the gain's unit per metre. With gain
    "combined", new surface counts in proportion to 1 / voxel_size**2, so this cost should do so
    too.
current_pose : array_like, (4, 4), optional
    T_world_camera of the camera, of which only the centre is used. Path costs and plans start
    there. Default: the pose that was last reached, by a frame or by ``tried``.
together : bool
    If true, each view is ranked by its marginal gain, which is the increase over the views ranked
    before it, so that views do not show the same surface twice. Cannot be used with measure.
exact : bool
    If true, scores all poses with all their rays. If false, does so only with gain "paper", and
    otherwise works in two stages as ``GainEvaluator.race``. With together, views after the first
    are then chosen among at least 32 poses, with a quarter of their rays.
measure : callable, optional
    Custom gain that replaces the planner's, as in ``GainEvaluator.evaluate_own``. The gain and area
    of the result are then NaN.
control : BatchControl, optional

Returns
-------
Ranking
    Its arrays are best first.)";

inline constexpr const char* kTriedDoc =
    R"(Reports that the robot was sent to a pose.

The pose is removed from the current proposal and not proposed again. Call this method for each pose
that the robot was sent to, and for no other.

Parameters
----------
T_world_camera : array_like, (4, 4)
reached : bool
    Whether the camera reached the pose. The pose then counts as taken, otherwise as missed.)";

inline constexpr const char* kShouldStopDoc =
    R"(The reason to stop, if there is one.

Returns
-------
str or None
    After ``add``: max_views, idle or promises. After ``propose``: no_candidates or unreachable.
    After ``rank`` of the proposal: gain, area or cost. "cost" means that every view costs more than
    it gains.)";

}  // namespace viewgain::python
