/* SPDX-FileCopyrightText: 2026 The viewgain authors
   SPDX-License-Identifier: Apache-2.0 */
#ifndef VIEWGAIN_C_GAIN_H
#define VIEWGAIN_C_GAIN_H

/* Part of viewgain/viewgain.h: scenes, the expected gain of poses, which are possible, poses. */

#include "viewgain/c/map.h"

#ifdef __cplusplus
extern "C" {
#endif

/* ---- Scenes ---- */

/* An immutable snapshot of a grid, made for tracing, and what stands there beside. */
typedef struct vg_scene vg_scene;

/* What a scene is built with. */
typedef struct vg_scene_config {
  size_t struct_size;        /* as _init() sets it */
  int32_t num_threads;       /* of the build; 0: all */
  const double* boxes;       /* obstacles, world: 6 numbers each, min x y z, max x y z */
  size_t box_count;          /* how many boxes */
  const double* vertices;    /* an obstacle mesh, world: 3 numbers each */
  size_t vertex_count;       /* how many vertices */
  const uint32_t* triangles; /* 3 vertex indices each */
  size_t triangle_count;     /* how many triangles */
  /* Height z of a table without end, world [m]; NaN (the default): none. Bodies stay above it; rays
     of the surface and the combined gain end there. */
  double support_plane;
  /* For the surface and the combined gain: longest side of the object [m], NaN (the default): that
     of what is seen of it. */
  double object_size;
  /* Rate at which a ray in unknown voxels meets the surface [1/m], the same everywhere, NaN (the
     default): by the distance from what is seen. */
  double hazard_rate;
  /* Instead of hazard_rate, one of the two: a rate for each voxel [1/m], in the order of
     vg_grid_states(); a .vdb file of rates, its grid of floats "hazard" or the only one. */
  const float* hazard_rates;
  size_t hazard_count;     /* of hazard_rates: dims[0] * dims[1] * dims[2] */
  const char* hazard_file; /* null: none */
} vg_scene_config;
VG_API void vg_scene_config_init(vg_scene_config* config, size_t struct_size); /* the defaults */

/* config null: nothing stands there. */
VG_API vg_status vg_scene_build(const vg_grid* grid, const vg_scene_config* config,
                                vg_scene** scene);

/* The scene of what `grid` is now, in the surroundings of `before`; copies what has not changed. */
VG_API vg_status vg_scene_update(const vg_scene* before, const vg_grid* grid, int32_t num_threads,
                                 vg_scene** scene);
VG_API void vg_scene_release(vg_scene* scene); /* null: nothing */

/* Counts how often a frame meets the surface in unknown space, before it is integrated; the surface
   and the combined gain of the grid's later scenes go by it. `scene` is that of the grid as it
   stands, depth and pose are as for vg_integrate(). Nothing happens while no surface is known, and
   where the scene's hazard was given (a rate, an array, a file). */
VG_API vg_status vg_calibrate_hazard(const vg_integrator* integrator, vg_grid* grid,
                                     const vg_scene* scene, const float* depth,
                                     const double T_world_camera[16]);

/* ---- Expected gain ---- */

/* Scores poses against a scene. Calls that take it as const may run from many threads at once. */
typedef struct vg_evaluator vg_evaluator;

/* By what the paper's gain measures uncertainty: 1/2 sum ln of the covariance's diagonal, 1/2 ln of
   its determinant, its trace [m^2]. */
enum { VG_LOG_DIAGONAL = 0, VG_LOG_DETERMINANT = 1, VG_TRACE = 2 };

/* What a view's gain counts: entropy removed [nat], new surface to be expected [m^2], or that and
   refining known surface [nat]. */
enum { VG_GAIN_PAPER = 0, VG_GAIN_SURFACE = 1, VG_GAIN_COMBINED = 2 };

/* A task weight for a part of the workspace. */
typedef struct vg_weight_region {
  double box_min[3], box_max[3]; /* grid frame [m]; the last region that holds a voxel counts */
  double weight;                 /* >= 0; 1 outside all regions */
} vg_weight_region;

/* How rays meet voxels; the same gains: as is mostly faster, by Embree's BVH, by sweeping cells
   from near to far. */
enum { VG_TRACER_AUTOMATIC = 0, VG_TRACER_EMBREE = 1, VG_TRACER_SWEEP = 2 };

/* What changes the answer, num_threads and tracer. */
typedef struct vg_evaluator_config {
  size_t struct_size;              /* as _init() sets it */
  int32_t criterion;               /* VG_LOG_DIAGONAL */
  int32_t pixel_stride;            /* 1: every pixel; s: every s-th of every s-th row */
  int32_t num_threads;             /* 0: all; 1: the caller alone; never changes a gain */
  double prior_sigma;              /* [m]; NaN (the default): the map's */
  double min_range, max_range;     /* along the ray [m]; NaN (the default): the sensor's */
  const vg_weight_region* weights; /* task weights of parts of the workspace; null: none */
  size_t weight_count;             /* how many weights */
  double refinement_weight;  /* VG_GAIN_COMBINED: of refining against finding new surface (1) */
  int32_t gain;              /* VG_GAIN_COMBINED */
  int32_t posterior_entropy; /* 1: vg_view_gain.posterior_entropy too, by VG_GAIN_PAPER; 0 (the
                                default) */
  int32_t tracer;            /* VG_TRACER_AUTOMATIC; never changes a gain */
} vg_evaluator_config;
/* The defaults. */
VG_API void vg_evaluator_config_init(vg_evaluator_config* config, size_t struct_size);

/* config null: the defaults. */
VG_API vg_status vg_evaluator_create(const vg_scene* scene, const vg_sensor* sensor,
                                     const vg_evaluator_config* config, vg_evaluator** evaluator);

/* The evaluator of another scene, such as vg_scene_update makes, for following a map as it grows:
   the sensor, settings and threads of `evaluator`, which stays as it is. Nothing is computed anew,
   so that it takes microseconds; gains are those of an evaluator made for that scene. */
VG_API vg_status vg_evaluator_with_scene(const vg_evaluator* evaluator, const vg_scene* scene,
                                         vg_evaluator** following);
VG_API void vg_evaluator_release(vg_evaluator* evaluator); /* null: nothing */

/* What an evaluator is. */
typedef struct vg_evaluator_info {
  size_t struct_size;                /* as _init() sets it */
  int32_t image_width, image_height; /* of depth images: the sensor's by the stride [px] */
  uint64_t rays_per_pose;            /* one for each pixel of the strided image */
  int32_t num_threads;               /* that the evaluator works with */
  double prior_sigma;                /* [m] */
} vg_evaluator_info;
/* Makes `info` ready for the call below. */
VG_API void vg_evaluator_info_init(vg_evaluator_info* info, size_t struct_size);
/* Tells what the evaluator is. Takes constant time. */
VG_API vg_status vg_evaluator_get_info(const vg_evaluator* evaluator, vg_evaluator_info* info);

/* Of vg_view_gain: scored; no rigid transform, gain NaN; the camera's centre is in an occupied
   voxel, gain 0. */
enum { VG_VIEW_OK = 0, VG_VIEW_BAD_POSE = 1, VG_VIEW_CAMERA_IN_OCCUPIED = 2 };

/* What a view is expected to bring; gains in nats, in m^2 for VG_TRACE and VG_GAIN_SURFACE. Each
   part says which gains have it; of the others it is NaN, a count 0. */
typedef struct vg_view_gain {
  double gain;                    /* paper: exploration + refinement; surface: area; combined: both,
                                     area and refinement_saturated; NaN: a bad pose */
  double exploration, refinement; /* paper: share of unknown and of occupied voxels */
  double posterior_entropy;       /* paper, if asked for: its eq. (6), lengths in metres */
  uint32_t rays, hits;            /* of the view; that end in a voxel */
  uint32_t unknown_voxels, occupied_voxels; /* distinct; paper, occupied_voxels combined too */
  int32_t status;                           /* VG_VIEW_ */
  double area;                 /* surface, combined: new surface to be expected [m^2] */
  double refinement_saturated; /* combined: of known surface [nat] */
} vg_view_gain;

/* The expected gain of every pose, on all threads of the evaluator: poses are count times 16
   doubles; a single one without a watch is traced on all threads together by the paper's
   gain, on one by the others. A bad pose has gain NaN
   and spoils no other; a camera in an occupied voxel has 0. watch or null. VG_STOPPED: the gains
   not reached are NaN. */
VG_API vg_status vg_evaluate(const vg_evaluator* evaluator, const double* poses, size_t count,
                             double* gains, const vg_watch* watch);

/* The same with all that is known of each view; view_size is sizeof(vg_view_gain). */
VG_API vg_status vg_evaluate_views(const vg_evaluator* evaluator, const double* poses, size_t count,
                                   vg_view_gain* views, size_t view_size, const vg_watch* watch);

/* ---- Choosing views ---- */

/* The k best poses, exactly those of the largest gains, best first, ties to the lower index; all
   poses are scored. `indices` and `gains` (null: not wanted) have room for k, *found says how many
   there are: fewer than k where fewer poses have a gain, as bad ones are never chosen. VG_STOPPED:
   the best of those scored so far, which *found counts. */
VG_API vg_status vg_best(const vg_evaluator* evaluator, const double* poses, size_t count, size_t k,
                         size_t* indices, double* gains, size_t* found, const vg_watch* watch);

/* The k best poses, very probably, faster: poses are compared by about 400 of their rays, and the
   best of these scored in full. `seed` says which rays, for VG_GAIN_PAPER; for the others they are
   in the middle of the image's cells. `indices`, `gains` and *found as for vg_best(). The same for
   a seed and any number of threads.
   deadline: time limit of the call [s], >= 0, or INFINITY. Half of it at most goes to comparing
   poses from all over the list; then those that were scored in full count, VG_OK. */
VG_API vg_status vg_race(const vg_evaluator* evaluator, const double* poses, size_t count, size_t k,
                         double deadline, uint64_t seed, size_t* indices, double* gains,
                         size_t* found, const vg_watch* watch);

/* Up to k poses that are good together, in the order of their choice; gains: what each adds to
   those before it. VG_STOPPED: those chosen so far. */
VG_API vg_status vg_best_set(const vg_evaluator* evaluator, const double* poses, size_t count,
                             size_t k, size_t* indices, double* gains, size_t* found,
                             const vg_watch* watch);

/* ---- Looking at a view ---- */

/* What a ray ends in; VG_HIT_NONE: nothing. */
enum { VG_HIT_NONE = 0, VG_HIT_UNKNOWN = 1, VG_HIT_OCCUPIED = 2, VG_HIT_OBSTACLE = 3 };

/* Where the rays of a pose end: depth along the optical axis [m], +infinity where a ray meets
   nothing, and what it meets (VG_HIT_; null: not wanted). count must be image_width *
   image_height. A bad pose is VG_INVALID_ARGUMENT. */
VG_API vg_status vg_depth_image(const vg_evaluator* evaluator, const double T_world_camera[16],
                                float* depth, uint8_t* labels, size_t count);

/* What one voxel adds to the gain of a view. */
typedef struct vg_contribution {
  int32_t voxel[3];     /* on the grid's lattice */
  int32_t state;        /* 0 unknown, 2 occupied */
  uint32_t rays;        /* that end in it; surface, combined: that reach it */
  double gain;          /* [nat, or m^2] */
  double expected_rays; /* that are expected to end in it; not all, where they may go on */
} vg_contribution;

/* Why a view is good: one entry per voxel in which rays end or may end, the largest gain first; the
   gains add up to the view's. Fills at most `capacity` of them and says in *found how many there
   are; never more than rays_per_pose with VG_GAIN_PAPER. contribution_size is
   sizeof(vg_contribution). None for a camera in an occupied voxel; a bad pose is
   VG_INVALID_ARGUMENT. */
VG_API vg_status vg_contributions(const vg_evaluator* evaluator, const double T_world_camera[16],
                                  vg_contribution* contributions, size_t contribution_size,
                                  size_t capacity, size_t* found);

/* What becomes of a view's rays, for asking why its gain is what it is; the counts below `rays` add
   up to it. */
typedef struct vg_ray_outcomes {
  size_t struct_size;     /* as _init() sets it */
  uint32_t rays;          /* of the view */
  uint32_t too_near;      /* meet known surface or an obstacle before min_range */
  uint32_t unknown;       /* come to unknown space: what may be new */
  uint32_t known_surface; /* end in known surface, with free space before it */
  uint32_t obstacle;      /* end at an obstacle or, but by VG_GAIN_PAPER, on the support plane */
  uint32_t out_of_range;  /* are in known free space to max_range */
  uint32_t out_of_map;    /* leave the workspace, or never come into it */
} vg_ray_outcomes;
/* Makes `outcomes` ready for a call. */
VG_API void vg_ray_outcomes_init(vg_ray_outcomes* outcomes, size_t struct_size);
/* Of one pose. A bad pose is VG_INVALID_ARGUMENT. Costs two traces of the pose. */
VG_API vg_status vg_outcomes(const vg_evaluator* evaluator, const double T_world_camera[16],
                             vg_ray_outcomes* outcomes);

/* ---- Which poses are possible ---- */

/* Says which poses are possible in a scene. Calls that take it as const may run from many threads
   at once. */
typedef struct vg_feasibility vg_feasibility;

/* Why a pose is impossible; checked in this order, the first one counts. */
enum {
  VG_FEASIBLE = 0,
  VG_INFEASIBLE_BAD_POSE = 1,
  VG_INFEASIBLE_UNREACHABLE = 2, /* `reachable` says no */
  VG_INFEASIBLE_TAKEN = 3,       /* a view was taken there already */
  VG_INFEASIBLE_PLANE = 4,       /* the body would touch the support plane or be under it */
  VG_INFEASIBLE_OBSTACLE = 5,    /* the body would overlap an obstacle, or the camera be in one */
  VG_INFEASIBLE_COLLISION = 6,   /* the body would overlap voxels that are not free */
  VG_INFEASIBLE_TOO_NEAR = 7     /* much of the image would be nearer than the sensor can measure */
};

/* What must have room, and where the robot gets. */
typedef struct vg_feasibility_config {
  size_t struct_size;         /* as _init() sets it */
  double body_size[3];        /* width, height, depth of the housing, in this order [m]; 0.065
                                 0.065 0.076 */
  int32_t has_flange;         /* nonzero: T_flange_camera counts; else the camera is in the */
  double T_flange_camera[16]; /* middle of the body's front face */
  double clearance;           /* the body is grown by this on each side [m]; 0 */
  double taken_distance;      /* views this near ... [m]; 0.010 */
  double taken_angle;         /* ... and this much alike are the same [rad]; 2 degrees */
  const vg_sensor* sensor;    /* null (the default): nothing is too near; read during create */
  double max_near_share;      /* of the rays; 0.2 */
  /* Whether the robot can put the camera there: nonzero, yes. Null (the default): everywhere. Must
     be thread safe, and must not throw or jump out. */
  int32_t (*reachable)(const double T_world_camera[16], void* user);
  void* user;          /* may be null */
  int32_t num_threads; /* 0: all; 1: the caller alone; never changes a reason */
} vg_feasibility_config;
/* The defaults. */
VG_API void vg_feasibility_config_init(vg_feasibility_config* config, size_t struct_size);

/* config null: the defaults. */
VG_API vg_status vg_feasibility_create(const vg_scene* scene, const vg_feasibility_config* config,
                                       vg_feasibility** feasibility);

/* Why each pose is not possible (VG_FEASIBLE: it is); the first reason in the order above counts.
   `taken`: the poses of the views so far, 16 doubles each. On all threads, which call
   `reachable` at once. */
VG_API vg_status vg_feasibility_check(const vg_feasibility* feasibility, const double* poses,
                                      size_t count, const double* taken, size_t taken_count,
                                      int32_t* reasons);

/* The same of another scene, such as vg_scene_update makes, for following a map as it grows;
   `feasibility` stays as it is. Takes microseconds. */
VG_API vg_status vg_feasibility_with_scene(const vg_feasibility* feasibility, const vg_scene* scene,
                                           vg_feasibility** following);
VG_API void vg_feasibility_release(vg_feasibility* feasibility); /* null: nothing */

/* ---- Poses ---- */

/* count poses evenly on a sphere round `center`, looking at it, image up = world up (+z). */
VG_API vg_status vg_sphere_poses(size_t count, double radius, const double center[3],
                                 double* poses);
/* The same on its upper half. */
VG_API vg_status vg_dome_poses(size_t count, double radius, const double center[3], double* poses);

/* A camera at `eye` that looks at `target`, image up as near to `up` as can be (null: +z). */
VG_API vg_status vg_look_at(const double eye[3], const double target[3], const double up[3],
                            double T_world_camera[16]);

/* The order of `count` stops in which the way through all of them costs least, in a unit of your
   own: exact to 12 stops. costs, count + 1 rows of `count`: row i, column j from stop i to stop j;
   the last row from where the camera is. At least 0; infinity: no way. `stops` has room for count.
   *cost (null: not wanted) is infinity, and stops stay as they were, where no order was found. */
VG_API vg_status vg_order_stops(const double* costs, size_t count, size_t* stops, double* cost);

#ifdef __cplusplus
}
#endif
#endif
