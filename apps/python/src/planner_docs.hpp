// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace viewgain::python {

// What the class ViewPlanner and its methods say of themselves.

inline constexpr const char* kPlannerDoc =
    R"(Next best views step by step, for a robot's program: frames in, views out.

``add`` a frame; ``propose`` candidates; ``rank`` them; ask ``should_stop``, which counts what they
promise; move, and say how that went with ``tried``; ``add`` the next frame.

Parameters
----------
sensor : Sensor
voxel_size : float
    [m]
workspace : array_like, (2, 3)
    Lowest and highest corner of what is mapped, the grid's frame [m]. Begin it at the table: what is
    under it stays unknown.
T_world_grid : array_like, (4, 4), optional
    Places the grid's frame in the world; identity unless given.
prior_sigma : float, optional
    Of an unknown voxel [m]; ``default_prior_sigma`` unless given.
support_plane : float, optional
    Height z of the table [m]. Its readings carve but do not hit.
boxes : array_like, (n, 2, 3), optional
    Known obstacles: lowest and highest corners, world frame [m]. They block rays and the body, and
    their readings carve but do not hit.
meshes : iterable of (vertices, triangles), optional
    The same as triangles: (n, 3), world frame [m], and (m, 3) indices.
gain : {"combined", "surface", "paper"}
    What ranks views: expected new surface and refinement, new surface alone, entropy removed.
criterion : {"log_diagonal", "log_determinant", "trace"}
    Of gain "paper" and of entropies; "trace" does not go with gain "combined".
object_size : float, optional
    Longest side of the object [m]; that of what is seen unless given.
reach : ReachRegion, optional
    Where the camera can be put. Its list of poses, if it has one, is among the candidates.
body_size : array_like, (3,), optional
    Width, height, depth of the housing, flange frame [m]; the sensor's unless given, the SR4000's where it has none.
clearance : float
    Round the body [m].
jump_edges : bool
    Remove flying pixels.
check_feasibility : bool
    False: every candidate is possible but those that were taken or tried.
max_views, idle_views : int
    End after so many views; after so many in a row that changed entropy and unknown voxels by less
    than 0.1 % (0: never).
broken_promises : int
    End after so many views in a row, taken where the best of the last ranking was, that brought
    less than a fifth of the new surface (by gain "paper" the entropy) that was promised; 0: never.
plan, take : int
    So many views are planned together, in a short order, and so many of them taken before it is planned
    anew, at most ``plan``; 1, 1: one at a time. ``rank`` says the plan; ``propose`` what is left of it, less what
    has become impossible or promises too little, by the generator "plan".
stop_gain : float, optional
    By gain "paper": end when the best candidate promises less than this per touched voxel [nat, m**2 for
    trace]. Default: 1.2; for trace 0.01 of the first ranking's.
stop_area : float, optional
    By gain "surface" and "combined": end when no candidate promises this share of the surface so
    far as new surface, on the mean of three rankings; 0: never. Default: 0.004.
coarsest : int
    As in ``FrameIntegrator``.
fine : array_like, (n, 2, 3), optional
    As in ``FrameIntegrator``.
finest : int
    As in ``FrameIntegrator``.
state : path-like, optional
    A file of ``save`` to go on from, its map laid out as here; what ``load`` gives.
tracer : {"automatic", "embree", "sweep"}
    How rays meet voxels, as in ``GainEvaluator``. Never changes a result.
num_threads : int
    0: all hardware threads. Never changes a result.

Notes
-----
One call at a time: while one is at work another raises RuntimeError. Calls leave the GIL while they
work, but while your generators and the predicate of ``reach`` are asked. Cost: a new planner takes
some ms, one with a state that of ``BeliefGrid.load``; the methods that take long say so, others
some microseconds; ``grid`` is a copy, 0.3 ms for 128**3 voxels.)";

inline constexpr const char* kLoadDoc =
    R"(A planner that goes on where ``save`` was called, bit for bit.

Parameters
----------
path : path-like
sensor, **settings
    Those of the constructor, as before, which is not looked at but for the map's layout; candidates
    are added and proposed anew, too. ``max_views``, ``idle_views`` and ``broken_promises`` count at once: a planner that
    had ended may go on with more.

Returns
-------
ViewPlanner)";

inline constexpr const char* kSaveDoc =
    R"(Writes the whole state, a map with notes, whole or not at all. Cost: that of ``BeliefGrid.save``, and linear
in the poses that were tried.

Left out are the settings, poses, generators and the last proposal. ``BeliefGrid.load`` and the program read the map.

Parameters
----------
path : path-like)";

inline constexpr const char* kAddPosesDoc =
    R"(Candidates that are proposed from now on.

Warns (UserWarning) if most poses do not see the map, and of the likely mistake.

Parameters
----------
T_world_camera : array_like, (n, 4, 4)
name : str
    The generator that ``propose`` names.)";

inline constexpr const char* kAddGeneratorDoc =
    R"(Candidates that are made anew for each proposal.

Parameters
----------
generator : callable
    Given the map, a BeliefGrid of its own with the views so far, returns poses (n, 4, 4). What it
    raises passes through. It must not call the planner, nor refer to it: the two would never be
    released.
name : str
    What ``propose`` names.)";

inline constexpr const char* kAddDoc =
    R"(Puts a frame into the map; the last proposal is void.

Warns (UserWarning) if hardly any reading lies in the workspace and most would by another convention
of poses or depths.

Cost: linear in the pixels and grows with the voxels that they carve: 12 ms for 176x144 pixels and voxels of
5 mm on two threads.

Parameters
----------
depth : array_like, (height, width), floating point
    Along the optical axis [m]; 0, NaN or masked: nothing known, inf: nothing up to max_range.
T_world_camera : array_like, (4, 4)
pose_sigma : array_like, (2,), optional
    What this pose may be off beside the sensor's own pose_sigma [m], [rad]: after
    ``register_frame`` its pose_sigma.
amplitude : array_like, (height, width), optional
    [1/m**2]

Returns
-------
AddedView
    new_area is area across the rays, as the expected area is: surface that is seen obliquely is
    larger. verdict says what became of the frame: one that cannot be used, as its pose is not rigid, changes no map and counts as a view that brought nothing. After Error,
    where the scene cannot be made, the frame is in the map.)";

inline constexpr const char* kAddFrameDoc =
    R"(Reads a frame of a folder and puts it into the map, or counts why it cannot be used. Cost: that of reading, and ``add``.

Parameters
----------
frames : FrameSequence
    Of ``read_frames``.
index : int
    From the end if negative.

Returns
-------
AddedView)";

inline constexpr const char* kConsistencyDoc =
    R"(Whether the frames in the map fit one another.

Cost: 20 ms for a dozen frames, 0.5 s where they do not fit.

Returns
-------
FrameConsistency)";

inline constexpr const char* kDropDoc =
    R"(A view that came to nothing before there was a frame to add, or whose frame is left out. Cost: a pass over the map.

It counts as a frame that cannot be used: a view that brought nothing; its pose is not proposed again.

Parameters
----------
verdict : str
    One of those of AddedView.verdict but "used" and "carved".
T_world_camera : array_like, (4, 4), optional
    Where it was taken, if that is known.

Returns
-------
AddedView)";

inline constexpr const char* kRegisterFrameDoc =
    R"(Where the camera was, by what the frame shows of the map so far. Changes nothing.

Minimises the distances of the frame's readings from the map's points along the surface's normals,
by Gauss and Newton, with the reported pose as prior. Put a frame that is "registered" in at the pose
that was found, one with "too_little_overlap" as reported, and leave out one that is "refused": it
contradicts the map, or would move by more than five sigmas. Cost: some 100 to 300 ms a frame.

Parameters
----------
depth : array_like, (height, width), floating point
    As for ``add``.
T_world_camera : array_like, (4, 4)
    As it is reported.
sigma_translation : float
    How far each coordinate of the camera's centre may be off, 1 sigma [m].
sigma_rotation : float
    The same of each component of its rotation [rad].
amplitude : array_like, (height, width), optional
    [1/m**2]

Returns
-------
FrameRegistration)";

inline constexpr const char* kProposeDoc =
    R"(The candidates that are possible now.

What a generator or the predicate of ``reach`` raises passes through. Cost: linear in the candidates, 4 µs
each, and what generators take.

Returns
-------
Proposal)";

inline constexpr const char* kRankDoc =
    R"(The k best candidates of the proposal since the last view, or of any poses.

Cost: linear in the candidates: 2 ms each in two stages, 20 ms with exact, by gain "combined", for 176x144
pixels and a map of 128**3 voxels that is mostly unknown. Warns (UserWarning) if most of the given
poses do not see the map.

Parameters
----------
k : int
poses : array_like, (n, 4, 4), optional
    T_world_camera, instead of the proposal; nobody looks whether they are possible. Bad ones are left out.
    Says nothing to ``should_stop``.
costs : array_like, (n,), optional
    Subtracted from the gains, in their unit.
cost_per_metre : float
    Of the straight way from ``current_pose``, in the gain's unit per metre. The combined gain of new surface goes with
    1 / voxel**2, and so should this.
current_pose : array_like, (4, 4), optional
    Where the camera is, T_world_camera; only its centre counts. By default the pose of the last frame, whether it could
    be used or not, or of a later ``tried`` that was reached. A plan begins there, too.
together : bool
    Each view by what it adds to those before it, so that no two show the same; not with measure.
exact : bool
    Score all in full. Else, but by gain "paper", in two stages: see ``GainEvaluator.race``. Of views that go together
    the first is found so, the others are chosen of few poses, at least 32, by a quarter of their rays.
measure : callable, optional
    A gain of your own in the planner's place, as of ``GainEvaluator.evaluate_own``; gain and area are NaN then.
control : BatchControl, optional

Returns
-------
Ranking
    Its arrays are best first.)";

inline constexpr const char* kTriedDoc =
    R"(A pose was commanded: it is not proposed again, and goes out of the proposal as it stands.

Call it for each pose that the robot was sent to, and for no other.

Parameters
----------
T_world_camera : array_like, (4, 4)
reached : bool
    True if the camera got there: the pose counts as taken; False if it did not: as missed.)";

inline constexpr const char* kShouldStopDoc =
    R"(Why to end, if there is a reason.

Returns
-------
str or None
    After ``add`` max_views, idle or promises; after ``propose`` no_candidates or unreachable; after ``rank`` of
    the proposal gain, area or, with costs, cost: no view is worth its way.)";

}  // namespace viewgain::python
