/* SPDX-FileCopyrightText: 2026 The viewgain authors
   SPDX-License-Identifier: Apache-2.0 */
#ifndef VIEWGAIN_C_GAIN_H
#define VIEWGAIN_C_GAIN_H

/* Part of viewgain/viewgain.h: scenes, expected gain of poses, feasibility, poses. */

#include "viewgain/c/map.h"

#ifdef __cplusplus
extern "C" {
#endif

/* ---- Scenes ---- */

/* An immutable snapshot of a grid for ray tracing, with its surroundings. */
typedef struct vg_scene vg_scene;

/* Settings of a scene. */
typedef struct vg_scene_config {
  size_t struct_size;        /* set by _init() */
  int32_t num_threads;       /* threads that build the scene; 0: all */
  const double* boxes;       /* obstacles, world: 6 numbers each, min x y z, max x y z */
  size_t box_count;          /* number of boxes */
  const double* vertices;    /* an obstacle mesh, world: 3 numbers each */
  size_t vertex_count;       /* number of vertices */
  const uint32_t* triangles; /* 3 vertex indices each */
  size_t triangle_count;     /* number of triangles */
  /* Height z of an infinite table, world [m]; NaN (the default): none. Bodies stay above it; it
     ends rays of the surface and combined gains. */
  double support_plane;
  /* For the surface and combined gains: longest side of the object [m]; NaN (the default): that of
     the part seen so far. */
  double object_size;
  /* Constant rate at which a ray meets the surface in unknown voxels [1/m]; NaN (the default):
     depends on the distance to seen surface. */
  double hazard_rate;
  /* Two alternatives to hazard_rate, of which at most one may be set: hazard_rates, one rate per
     voxel [1/m] in the order of vg_grid_states(); hazard_file, a .vdb file whose float grid
     "hazard", or whose only float grid, contains rates. */
  const float* hazard_rates;
  size_t hazard_count;     /* dims[0] * dims[1] * dims[2] */
  const char* hazard_file; /* null: none */
} vg_scene_config;
/* Sets the defaults. */
VG_API void vg_scene_config_init(vg_scene_config* config, size_t struct_size);

/* Builds a scene. If config is null, it has no surroundings. */
VG_API vg_status vg_scene_build(const vg_grid* grid, const vg_scene_config* config,
                                vg_scene** scene);

/* The scene of the current `grid` with the surroundings of `before`. Faster than vg_scene_build(),
   because unchanged parts are copied. */
VG_API vg_status vg_scene_update(const vg_scene* before, const vg_grid* grid, int32_t num_threads,
                                 vg_scene** scene);
VG_API void vg_scene_release(vg_scene* scene); /* null: no effect */

/* Counts how often the rays of a frame meet the surface in unknown space; later scenes of the grid
   use the counts in the surface and combined gains. Call it before the frame is integrated, with
   the scene of the current grid; depth and pose as in vg_integrate(). No effect while no surface is
   known, or if the scene's config gives the hazard (a rate, an array, a file). */
VG_API vg_status vg_calibrate_hazard(const vg_integrator* integrator, vg_grid* grid,
                                     const vg_scene* scene, const float* depth,
                                     const double T_world_camera[16]);

/* ---- Expected gain ---- */

/* Scores poses against a scene. Calls that take it as const may run from many threads at once. */
typedef struct vg_evaluator vg_evaluator;

/* Measure of uncertainty of the paper's gain: 1/2 sum of ln over the covariance's diagonal, 1/2 ln
   of its determinant, or its trace [m^2]. */
enum { VG_LOG_DIAGONAL = 0, VG_LOG_DETERMINANT = 1, VG_TRACE = 2 };

/* What a view's gain measures: entropy removed [nat], expected new surface [m^2], or expected new
   surface and refinement of known surface [nat]. */
enum { VG_GAIN_PAPER = 0, VG_GAIN_SURFACE = 1, VG_GAIN_COMBINED = 2 };

/* A task weight for a part of the workspace. */
typedef struct vg_weight_region {
  double box_min[3], box_max[3]; /* grid frame [m]; the last region that contains a voxel counts */
  double weight;                 /* >= 0; 1 outside all regions */
} vg_weight_region;

/* How to find the voxels that rays hit; gains do not depend on it: automatic, Embree's BVH, or a
   sweep over cells from near to far. */
enum { VG_TRACER_AUTOMATIC = 0, VG_TRACER_EMBREE = 1, VG_TRACER_SWEEP = 2 };

/* Settings of an evaluator. All except num_threads and tracer affect the gain. */
typedef struct vg_evaluator_config {
  size_t struct_size;              /* set by _init() */
  int32_t criterion;               /* VG_LOG_DIAGONAL */
  int32_t pixel_stride;            /* 1: every pixel; s: every s-th of every s-th row */
  int32_t num_threads;             /* 0: all; 1: the calling thread; does not affect gains */
  double prior_sigma;              /* [m]; NaN (the default): the map's */
  double min_range, max_range;     /* along the ray [m]; NaN (the default): the sensor's */
  const vg_weight_region* weights; /* task weights of parts of the workspace; null: none */
  size_t weight_count;             /* number of weights */
  double refinement_weight;  /* with VG_GAIN_COMBINED: weight of refinement relative to new surface;
                                default 1 */
  int32_t gain;              /* VG_GAIN_COMBINED */
  int32_t posterior_entropy; /* 1: also compute vg_view_gain.posterior_entropy with VG_GAIN_PAPER; 0
                                is the default */
  int32_t tracer;            /* VG_TRACER_AUTOMATIC; does not affect gains */
} vg_evaluator_config;
/* Sets the defaults. */
VG_API void vg_evaluator_config_init(vg_evaluator_config* config, size_t struct_size);

/* Creates an evaluator. If config is null, the defaults apply. */
VG_API vg_status vg_evaluator_create(const vg_scene* scene, const vg_sensor* sensor,
                                     const vg_evaluator_config* config, vg_evaluator** evaluator);

/* An evaluator for another scene, such as from vg_scene_update, to follow a growing map. It has the
   sensor, settings and threads of `evaluator`, which does not change. Takes microseconds. Gains are
   the same as with a new evaluator. */
VG_API vg_status vg_evaluator_with_scene(const vg_evaluator* evaluator, const vg_scene* scene,
                                         vg_evaluator** following);
VG_API void vg_evaluator_release(vg_evaluator* evaluator); /* null: no effect */

/* Properties of an evaluator. */
typedef struct vg_evaluator_info {
  size_t struct_size;                /* set by _init() */
  int32_t image_width, image_height; /* of depth images [px] */
  uint64_t rays_per_pose;            /* one per pixel of the strided image */
  int32_t num_threads;               /* number of threads of the evaluator */
  double prior_sigma;                /* [m] */
} vg_evaluator_info;
/* Prepares `info` for the call below. */
VG_API void vg_evaluator_info_init(vg_evaluator_info* info, size_t struct_size);
/* Returns the properties of the evaluator. Constant time. */
VG_API vg_status vg_evaluator_get_info(const vg_evaluator* evaluator, vg_evaluator_info* info);

/* Status of vg_view_gain: scored; not a rigid transform, gain NaN; camera centre in an occupied
   voxel, gain 0. */
enum { VG_VIEW_OK = 0, VG_VIEW_BAD_POSE = 1, VG_VIEW_CAMERA_IN_OCCUPIED = 2 };

/* Expected gain of a view; in nats, or in m^2 for VG_TRACE and VG_GAIN_SURFACE. Some members exist
   only for the gains that their comments name; otherwise they are NaN, and counts are 0. */
typedef struct vg_view_gain {
  double gain; /* paper: exploration + refinement; surface: area; combined: from area and
                  refinement_saturated; NaN: invalid pose */
  double exploration, refinement;           /* paper: parts from unknown and from occupied voxels */
  double posterior_entropy;                 /* paper, if enabled: eq. (6) of the paper, lengths in
                                               metres */
  uint32_t rays, hits;                      /* rays of the view; rays that end in a voxel */
  uint32_t unknown_voxels, occupied_voxels; /* distinct voxels (paper); occupied_voxels also with
                                               combined */
  int32_t status;                           /* VG_VIEW_ */
  double area;                              /* surface, combined: expected new surface [m^2] */
  double refinement_saturated;              /* combined: refinement of known surface [nat] */
} vg_view_gain;

/* Expected gain of each of `count` poses (16 doubles each), on all threads of the evaluator. (For a
   single pose without a watch, only the paper's gain uses more than one thread.) An invalid pose
   has gain NaN and affects no other; a camera in an occupied voxel has gain 0. `watch` may be null.
   If the result is VG_STOPPED, the remaining gains are NaN. */
VG_API vg_status vg_evaluate(const vg_evaluator* evaluator, const double* poses, size_t count,
                             double* gains, const vg_watch* watch);

/* As above with all results of each view; view_size is sizeof(vg_view_gain). */
VG_API vg_status vg_evaluate_views(const vg_evaluator* evaluator, const double* poses, size_t count,
                                   vg_view_gain* views, size_t view_size, const vg_watch* watch);

/* ---- Choosing views ---- */

/* The k best poses, found by scoring all poses: best first, ties in the order of their indices.
   `indices` and `gains` have room for k; gains may be null. *found is the number of chosen poses,
   which is less than k if fewer poses are valid. If the result is VG_STOPPED, these are the best
   *found poses so far. */
VG_API vg_status vg_best(const vg_evaluator* evaluator, const double* poses, size_t count, size_t k,
                         size_t* indices, double* gains, size_t* found, const vg_watch* watch);

/* The k best poses with high probability, faster than vg_best(). Compares poses with about 400 of
   their rays, and scores the best in full. With VG_GAIN_PAPER, `seed` selects the rays; the other
   gains ignore it. `indices`, `gains` and *found are as in vg_best(). Deterministic for a seed and
   any number of threads. deadline: time limit of the call [s], >= 0, or INFINITY. At most half of
   it goes to comparing poses. After the deadline the result is the best of the poses scored in
   full, with VG_OK. */
VG_API vg_status vg_race(const vg_evaluator* evaluator, const double* poses, size_t count, size_t k,
                         double deadline, uint64_t seed, size_t* indices, double* gains,
                         size_t* found, const vg_watch* watch);

/* Up to k poses whose joint gain is large, in the order chosen. `gains` are marginal gains: the
   increase over the earlier poses. VG_STOPPED: these are the poses chosen so far. */
VG_API vg_status vg_best_set(const vg_evaluator* evaluator, const double* poses, size_t count,
                             size_t k, size_t* indices, double* gains, size_t* found,
                             const vg_watch* watch);

/* ---- Looking at a view ---- */

/* What a ray ends in; VG_HIT_NONE: nothing. */
enum { VG_HIT_NONE = 0, VG_HIT_UNKNOWN = 1, VG_HIT_OCCUPIED = 2, VG_HIT_OBSTACLE = 3 };

/* Where the rays of a pose end: depth along the optical axis [m], +infinity where a ray hits
   nothing, and what it hits (VG_HIT_; labels may be null). count must be image_width *
   image_height. Returns VG_INVALID_ARGUMENT for an invalid pose. */
VG_API vg_status vg_depth_image(const vg_evaluator* evaluator, const double T_world_camera[16],
                                float* depth, uint8_t* labels, size_t count);

/* Contribution of one voxel to the gain of a view. */
typedef struct vg_contribution {
  int32_t voxel[3];     /* lattice of the grid */
  int32_t state;        /* 0 unknown, 2 occupied */
  uint32_t rays;        /* rays that end in the voxel; surface, combined: rays that reach it */
  double gain;          /* [nat, or m^2] */
  double expected_rays; /* expected number of rays that end in the voxel; less than `rays` if rays
                           can continue */
} vg_contribution;

/* Explains a gain: one entry per voxel in which rays end or can end, largest gain first; the gains
   add up to the view's. Writes at most `capacity` entries; *found is their total number, which is
   at most rays_per_pose with VG_GAIN_PAPER. contribution_size is sizeof(vg_contribution). A camera
   in an occupied voxel has no entries. Returns VG_INVALID_ARGUMENT for an invalid pose. */
VG_API vg_status vg_contributions(const vg_evaluator* evaluator, const double T_world_camera[16],
                                  vg_contribution* contributions, size_t contribution_size,
                                  size_t capacity, size_t* found);

/* Where a view's rays end, to explain its gain. The counts after `rays` add up to `rays`. */
typedef struct vg_ray_outcomes {
  size_t struct_size;     /* set by _init() */
  uint32_t rays;          /* rays of the view */
  uint32_t too_near;      /* hit known surface or an obstacle nearer than min_range */
  uint32_t unknown;       /* reach unknown space: possible new surface */
  uint32_t known_surface; /* end on known surface after free space */
  uint32_t obstacle; /* end on an obstacle or, except with VG_GAIN_PAPER, on the support plane */
  uint32_t out_of_range; /* stay in known free space up to max_range */
  uint32_t out_of_map;   /* leave the workspace, or never enter it */
} vg_ray_outcomes;
/* Prepares `outcomes` for a call. */
VG_API void vg_ray_outcomes_init(vg_ray_outcomes* outcomes, size_t struct_size);
/* Outcomes of one pose. Returns VG_INVALID_ARGUMENT for an invalid pose. Costs two traces of the
   pose. */
VG_API vg_status vg_outcomes(const vg_evaluator* evaluator, const double T_world_camera[16],
                             vg_ray_outcomes* outcomes);

/* ---- Which poses are possible ---- */

/* Checks which poses are feasible in a scene. Calls that take it as const may run from many threads
   at once. */
typedef struct vg_feasibility vg_feasibility;

/* Why a pose is infeasible. If several reasons hold, the first in this order counts. */
enum {
  VG_FEASIBLE = 0,
  VG_INFEASIBLE_BAD_POSE = 1,
  VG_INFEASIBLE_UNREACHABLE = 2, /* `reachable` returned 0 */
  VG_INFEASIBLE_TAKEN = 3,       /* a view was already taken there */
  VG_INFEASIBLE_PLANE = 4,       /* the body would touch the support plane or be below it */
  VG_INFEASIBLE_OBSTACLE = 5,  /* the body would overlap an obstacle, or the camera be inside one */
  VG_INFEASIBLE_COLLISION = 6, /* the body would overlap voxels that are not free */
  VG_INFEASIBLE_TOO_NEAR = 7   /* much of the image would be nearer than min_range */
};

/* Settings of the feasibility check: body, reach and sight. */
typedef struct vg_feasibility_config {
  size_t struct_size;         /* set by _init() */
  double body_size[3];        /* width, height, depth of the housing, in this order [m]; default
                                 0.065, 0.065, 0.076 */
  int32_t has_flange;         /* nonzero: uses T_flange_camera; 0: the camera is in the middle of
                                 the body's front face */
  double T_flange_camera[16]; /* from the camera's frame to the flange's; default identity */
  double clearance;           /* margin around the body on each side [m]; default 0 */
  double taken_distance;      /* two views are the same if their distance is less than this [m];
                                 default 0.010 */
  double taken_angle;         /* and their rotations differ by less than this [rad]; default 2
                                 degrees */
  const vg_sensor* sensor;    /* null (the default): no view is too near; read during create */
  double max_near_share;      /* a view is too near if more than this share of the rays that end in
                                 the map end within min_range; default 0.2 */
  /* Whether the robot can reach the camera pose: nonzero if so. Null (the default): all poses are
     reachable. Must be thread safe, and must not throw or jump out. */
  int32_t (*reachable)(const double T_world_camera[16], void* user);
  void* user;          /* may be null */
  int32_t num_threads; /* 0: all; 1: the calling thread; does not affect results */
} vg_feasibility_config;
/* Sets the defaults. */
VG_API void vg_feasibility_config_init(vg_feasibility_config* config, size_t struct_size);

/* Creates a checker. If config is null, the defaults apply. */
VG_API vg_status vg_feasibility_create(const vg_scene* scene, const vg_feasibility_config* config,
                                       vg_feasibility** feasibility);

/* Why each pose is infeasible, or VG_FEASIBLE; the first reason in the order above. `taken`: poses
   of the views so far, 16 doubles each. Runs on all threads, which call `reachable` concurrently.
   */
VG_API vg_status vg_feasibility_check(const vg_feasibility* feasibility, const double* poses,
                                      size_t count, const double* taken, size_t taken_count,
                                      int32_t* reasons);

/* As above for another scene, such as from vg_scene_update, to follow a growing map; `feasibility`
   does not change. Takes microseconds. */
VG_API vg_status vg_feasibility_with_scene(const vg_feasibility* feasibility, const vg_scene* scene,
                                           vg_feasibility** following);
VG_API void vg_feasibility_release(vg_feasibility* feasibility); /* null: no effect */

/* ---- Poses ---- */

/* count poses evenly spread on a sphere around `center`, looking at it, image up along world up
   (+z). */
VG_API vg_status vg_sphere_poses(size_t count, double radius, const double center[3],
                                 double* poses);
/* As above on its upper half. */
VG_API vg_status vg_dome_poses(size_t count, double radius, const double center[3], double* poses);

/* A camera at `eye` that looks at `target`, with image up as close to `up` as possible (null: +z).
 */
VG_API vg_status vg_look_at(const double eye[3], const double target[3], const double up[3],
                            double T_world_camera[16]);

/* Orders `count` stops so that the path through all of them is the cheapest; exact up to 12 stops.
   costs, in any unit, has count + 1 rows of `count` numbers. Row i, column j is the cost from stop
   i to stop j; the last row is from the current pose. Costs are at least 0; infinity means no path.
   `stops` has room for count. `cost` may be null. If no order is found, *cost is infinity and
   `stops` is unchanged. */
VG_API vg_status vg_order_stops(const double* costs, size_t count, size_t* stops, double* cost);

#ifdef __cplusplus
}
#endif
#endif
