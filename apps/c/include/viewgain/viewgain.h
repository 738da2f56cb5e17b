/* SPDX-FileCopyrightText: 2026 The viewgain authors
   SPDX-License-Identifier: Apache-2.0 */
#ifndef VIEWGAIN_VIEWGAIN_H
#define VIEWGAIN_VIEWGAIN_H

/* viewgain for C99 and for whatever calls C. Linked from the same library as the C++ interface,
   whose gains are the same to the last bit.

   Units are metres, radians and nats. A pose is 16 doubles, a 4x4 matrix row by row, T_world_camera
   (camera to world); the camera's axes are x right, y down, z forward. Its lowest row must be
   0 0 0 1 and its rotation orthonormal, both to 1e-3; else, and if a number is not finite, it is a
   bad pose. Dense arrays of voxels are [x][y][z] with z fastest; states are 0 unknown, 1 free,
   2 occupied.

   Every function that can fail returns a status. Where it is not VG_OK, vg_last_error() says why
   and names the value; what the function would have filled is then unspecified, but for handles,
   which are null, and where a function says otherwise. No null pointers, except where "null" is
   said; an array of length 0 may be null.

   Structs that a function takes begin with struct_size; call the struct's _init function first,
   with its sizeof, which sets it and the defaults, then change what you like. Structs grow at their
   end, so a library takes every size that a struct has had in headers of its VG_ABI_VERSION: what a
   smaller struct lacks has its default, or is not filled. It refuses any other size by
   VG_INVALID_ARGUMENT and a message with both, a larger one too, so that a program never runs with
   a library older than its header. The size given with an array of vg_view_gain or vg_contribution
   counts in the same way; vg_weight_region never grows.

   Handles are released by the function that bears their name, in any order: what is made from a
   handle keeps what it needs of it. Releasing null does nothing. A handle must not be used, or
   released again, after its release.

   Thread safety: scenes, evaluators and checkers may be used from many threads at once. Nothing may
   run beside a function that changes a grid, on that grid. One call at a time on an integrator.

   Fork: evaluators work in the child, which makes threads of its own. A child that does not exec
   must end by _exit(), after fflush(NULL) if it wrote anything: exit(), and so a return from main,
   may wait for ever. Debian's OpenVDB loads log4cplus, whose exit handler waits for threads that a
   child does not have. The same holds for C++. */

#include <stddef.h>
#include <stdint.h>

#if defined(__GNUC__)
#define VG_API __attribute__((visibility("default")))
#else
#define VG_API
#endif

#ifdef __cplusplus
extern "C" {
#endif

/* Grows when something is removed or changes its meaning; additions leave it as it is. */
#define VG_ABI_VERSION 1
VG_API int32_t vg_abi_version(void); /* of the library */
VG_API const char* vg_version(void); /* "major.minor.patch" of the library */

typedef int32_t vg_status;
enum {
  VG_OK = 0,
  VG_INVALID_ARGUMENT = 1, /* a value outside its documented range, or a null pointer */
  VG_IO = 2,               /* a file cannot be opened, read or written */
  VG_FORMAT = 3,           /* a file's contents are not what they should be */
  VG_CAPACITY = 4,         /* more voxels or primitives than the data structures can hold */
  VG_BACKEND = 5,          /* Embree or OpenVDB reported a failure */
  VG_OUT_OF_MEMORY = 6,
  VG_STOPPED = 7, /* the caller's vg_watch asked to stop */
  VG_INTERNAL = 8 /* anything else: a defect of the library */
};

/* Why the last call of this thread that did not return VG_OK did not; "" if there was none. Valid
   until the thread's next such call; cut off after 1,023 bytes. */
VG_API const char* vg_last_error(void);

/* Follows and ends a long call. The function is called before each pose and once all are done, from
   whichever thread, never two at once. If it returns nonzero while there is work left the call ends
   soon, with VG_STOPPED. It must not throw or jump out. */
typedef struct vg_watch {
  size_t struct_size;
  /* done of total poses: scored (vg_evaluate and its like), in need of no more work (vg_best),
     chosen (vg_best_set); 0 until the end for vg_race. */
  int32_t (*poll)(size_t done, size_t total, void* user);
  void* user; /* may be null */
} vg_watch;
VG_API void vg_watch_init(vg_watch* watch, size_t struct_size);

/* ---- Sensors ---- */

/* Standard deviations of a reading at range t, along the ray and across it; see core's noise.hpp.
   The parameters are those of vg_sensor.noise, in this order. */
enum {
  VG_NOISE_SHOT = 0,             /* time of flight: reference_sigma, reference_range,
                                    reference_integration_time, integration_time,
                                    modulation_frequency, min_amplitude */
  VG_NOISE_STRUCTURED_LIGHT = 1, /* offset, quadratic, vertex, grazing, lateral_px,
                                    lateral_grazing_px */
  VG_NOISE_STEREO = 2,           /* subpixel, focal, baseline */
  VG_NOISE_QUADRATIC = 3,        /* offset, quadratic */
  VG_NOISE_CONSTANT = 4          /* sigma_axial, sigma_lateral */
};

/* A depth camera. Pixel (0,0) has its centre at (0,0), as in OpenCV. */
typedef struct vg_sensor {
  size_t struct_size;
  int32_t width, height;       /* [px] */
  double fx, fy, cx, cy;       /* [px] */
  double distortion[5];        /* k1 k2 p1 p2 k3 */
  double min_range, max_range; /* along the ray [m] */
  double working_distance;     /* where it is meant to be used [m] */
  int32_t noise_model;         /* VG_NOISE_ */
  double noise[6];             /* the model's parameters; those beyond must be 0 */
} vg_sensor;
VG_API void vg_sensor_init(vg_sensor* sensor, size_t struct_size); /* all 0: nothing is valid yet */

/* Fills a sensor that vg_sensor_init has seen: "sr4000", "azure_kinect_nfov", "kinect_v1", "d435"
   or "laser_line". */
VG_API vg_status vg_sensor_preset(const char* name, vg_sensor* sensor);

/* The prior sigma [m] that suits a voxel size and a sensor: max(voxel / 2, 2 sigma_ax at the
   working distance). */
VG_API vg_status vg_default_prior_sigma(double voxel_size, const vg_sensor* sensor, double* sigma);

/* ---- Belief grids ---- */

typedef struct vg_grid vg_grid;

typedef struct vg_grid_config {
  size_t struct_size;
  double voxel_size;             /* [m] */
  double box_min[3], box_max[3]; /* the workspace, in the grid's frame; grown to whole voxels */
  double T_world_grid[16];       /* identity */
  double prior_sigma;            /* of an unknown voxel [m] */
} vg_grid_config;
VG_API void vg_grid_config_init(vg_grid_config* config, size_t struct_size);

/* An empty map: every voxel of the workspace is unknown. */
VG_API vg_status vg_grid_create(const vg_grid_config* config, vg_grid** grid);

/* A map from a dense array of states. The corner of voxel (0,0,0) is at `origin`, world: the grid's
   frame is moved there, its axes are the world's. */
VG_API vg_status vg_grid_from_labels(const uint8_t* labels, const int32_t dims[3],
                                     const double origin[3], double voxel_size, double prior_sigma,
                                     vg_grid** grid);

VG_API vg_status vg_grid_load(const char* path, vg_grid** grid); /* a .vdb file of viewgain */
VG_API vg_status vg_grid_save(const vg_grid* grid, const char* path);

/* OctoMap's .ot and .bt: the states, and a .ot's log-odds; the workspace is the box of the known
   voxels. prior_sigma [m], 0: half a voxel. Saving writes a .ot, in the world's frame where
   T_world_grid is a shift by whole voxels, else in the grid's own. */
VG_API vg_status vg_grid_load_octomap(const char* path, double prior_sigma, vg_grid** grid);
VG_API vg_status vg_grid_save_octomap(const vg_grid* grid, const char* path);
VG_API vg_status vg_grid_clone(const vg_grid* grid, vg_grid** copy);
VG_API void vg_grid_release(vg_grid* grid);

typedef struct vg_grid_info {
  size_t struct_size;
  int32_t min_index[3]; /* lowest voxel of the workspace on the grid's lattice */
  int32_t dims[3];      /* voxels along x, y, z */
  double voxel_size;    /* [m] */
  double prior_sigma;   /* [m] */
  double T_world_grid[16];
  uint64_t unknown, free, occupied; /* voxels */
  uint64_t views;                   /* frames integrated */
  uint64_t bytes;                   /* memory */
  double entropy_removed;           /* how far the map is, by log_diagonal [nat] */
} vg_grid_info;
VG_API void vg_grid_info_init(vg_grid_info* info, size_t struct_size);
VG_API vg_status vg_grid_get_info(const vg_grid* grid, vg_grid_info* info);

/* The dense array of states; count must be dims[0] * dims[1] * dims[2]. */
VG_API vg_status vg_grid_states(const vg_grid* grid, uint8_t* states, size_t count);

/* 16 hexadecimal digits and a 0 over all that the map holds; the same for equal maps. */
VG_API vg_status vg_grid_hash(const vg_grid* grid, char hash[17]);

/* ---- Depth frames ---- */

typedef struct vg_integrator vg_integrator;

enum { VG_CARVE_CONES = 0, VG_CARVE_LINES = 1 };
enum { VG_OCCUPANCY_PROBABILISTIC = 0, VG_OCCUPANCY_LITERAL = 1 };

typedef struct vg_integrator_config {
  size_t struct_size;
  int32_t carve;        /* VG_CARVE_CONES */
  int32_t occupancy;    /* VG_OCCUPANCY_PROBABILISTIC */
  int32_t num_threads;  /* 0: all; 1: the caller alone; never changes the map */
  double support_plane; /* height of the table, world z [m]; NaN (the default): none */
} vg_integrator_config;
VG_API void vg_integrator_config_init(vg_integrator_config* config, size_t struct_size);

/* Counts of one frame. */
typedef struct vg_integration_report {
  size_t struct_size;
  uint64_t readings, plane_readings, out_of_range, invalid, readings_inside;
  uint64_t voxels_hit, voxels_crossed;
} vg_integration_report;
VG_API void vg_integration_report_init(vg_integration_report* report, size_t struct_size);

/* Puts frames of one sensor into maps. config null: the defaults. */
VG_API vg_status vg_integrator_create(const vg_sensor* sensor, const vg_integrator_config* config,
                                      vg_integrator** integrator);

/* Integrates one frame: `depth` along the optical axis [m], row by row, width * height values, 0
   invalid, +infinity out of range; `amplitude` [1/m^2] of the same size, or null; `report` or null.
   A bad pose is VG_INVALID_ARGUMENT, and the map is unchanged. */
VG_API vg_status vg_integrate(vg_integrator* integrator, vg_grid* grid, const float* depth,
                              const float* amplitude, const double T_world_camera[16],
                              vg_integration_report* report);
VG_API void vg_integrator_release(vg_integrator* integrator);

/* ---- Scenes ---- */

/* An immutable snapshot of a grid, made for tracing, and known obstacles. */
typedef struct vg_scene vg_scene;

typedef struct vg_scene_config {
  size_t struct_size;
  int32_t num_threads; /* of the build; 0: all */
  const double* boxes; /* obstacles, world: 6 numbers each, min x y z, max x y z */
  size_t box_count;
  const double* vertices; /* an obstacle mesh, world: 3 numbers each */
  size_t vertex_count;
  const uint32_t* triangles; /* 3 vertex indices each */
  size_t triangle_count;
} vg_scene_config;
VG_API void vg_scene_config_init(vg_scene_config* config, size_t struct_size);

/* config null: no obstacles. */
VG_API vg_status vg_scene_build(const vg_grid* grid, const vg_scene_config* config,
                                vg_scene** scene);

/* The scene of what `grid` is now, with the obstacles of `before`; takes over what has not changed.
 */
VG_API vg_status vg_scene_update(const vg_scene* before, const vg_grid* grid, int32_t num_threads,
                                 vg_scene** scene);
VG_API void vg_scene_release(vg_scene* scene);

/* ---- Expected gain ---- */

typedef struct vg_evaluator vg_evaluator;

enum { VG_LOG_DIAGONAL = 0, VG_LOG_DETERMINANT = 1, VG_TRACE = 2 };

/* A task weight for a part of the workspace. */
typedef struct vg_weight_region {
  double box_min[3], box_max[3]; /* grid frame [m]; the last region that holds a voxel counts */
  double weight;                 /* >= 0; 1 outside all regions */
} vg_weight_region;

typedef struct vg_evaluator_config {
  size_t struct_size;
  int32_t criterion;           /* VG_LOG_DIAGONAL */
  int32_t pixel_stride;        /* 1: every pixel; s: every s-th of every s-th row */
  int32_t num_threads;         /* 0: all; 1: the caller alone; never changes a gain */
  double prior_sigma;          /* [m]; NaN (the default): the map's */
  double min_range, max_range; /* along the ray [m]; NaN (the default): the sensor's */
  const vg_weight_region* weights;
  size_t weight_count;
} vg_evaluator_config;
VG_API void vg_evaluator_config_init(vg_evaluator_config* config, size_t struct_size);

/* config null: the defaults. */
VG_API vg_status vg_evaluator_create(const vg_scene* scene, const vg_sensor* sensor,
                                     const vg_evaluator_config* config, vg_evaluator** evaluator);
VG_API void vg_evaluator_release(vg_evaluator* evaluator);

typedef struct vg_evaluator_info {
  size_t struct_size;
  int32_t image_width, image_height; /* of depth images: the sensor's by the stride [px] */
  uint64_t rays_per_pose;
  int32_t num_threads;
  double prior_sigma; /* [m] */
} vg_evaluator_info;
VG_API void vg_evaluator_info_init(vg_evaluator_info* info, size_t struct_size);
VG_API vg_status vg_evaluator_get_info(const vg_evaluator* evaluator, vg_evaluator_info* info);

enum { VG_VIEW_OK = 0, VG_VIEW_BAD_POSE = 1, VG_VIEW_CAMERA_IN_OCCUPIED = 2 };

/* What a view is expected to bring; gains in nats, in m^2 for VG_TRACE. */
typedef struct vg_view_gain {
  double gain;                    /* exploration + refinement; NaN: a bad pose */
  double exploration, refinement; /* share of unknown and of occupied voxels */
  double posterior_entropy;       /* the paper's eq. (6), lengths in metres */
  uint32_t rays, hits;
  uint32_t unknown_voxels, occupied_voxels; /* distinct */
  int32_t status;                           /* VG_VIEW_ */
} vg_view_gain;

/* The expected gain of every pose, on all threads of the evaluator: poses are count times 16
   doubles; a single one without a watch is traced on all threads together. A bad pose has gain NaN
   and spoils no other; a camera in an occupied voxel has 0. watch or null. VG_STOPPED: the gains
   not reached are NaN. */
VG_API vg_status vg_evaluate(const vg_evaluator* evaluator, const double* poses, size_t count,
                             double* gains, const vg_watch* watch);

/* The same with all that is known of each view; view_size is sizeof(vg_view_gain). */
VG_API vg_status vg_evaluate_views(const vg_evaluator* evaluator, const double* poses, size_t count,
                                   vg_view_gain* views, size_t view_size, const vg_watch* watch);

/* ---- Choosing views ---- */

/* The k best poses, exactly those of the largest gains, best first, ties to the lower index, NaN
   last; all poses are scored. `indices` and `gains` (null: not wanted) have room for
   k, *found says how many there are (fewer than k if there are fewer poses). VG_STOPPED: the best
   of those scored so far, which *found counts. */
VG_API vg_status vg_best(const vg_evaluator* evaluator, const double* poses, size_t count, size_t k,
                         size_t* indices, double* gains, size_t* found, const vg_watch* watch);

/* The k best poses, very probably, faster: poses are compared by random parts of their images, the
   survivors scored in full. The same for a seed and any number of threads. */
VG_API vg_status vg_race(const vg_evaluator* evaluator, const double* poses, size_t count, size_t k,
                         uint64_t seed, size_t* indices, double* gains, size_t* found,
                         const vg_watch* watch);

/* Up to k poses that are good together, in the order of their choice; gains: what each adds to
   those before it. VG_STOPPED: those chosen so far. */
VG_API vg_status vg_best_set(const vg_evaluator* evaluator, const double* poses, size_t count,
                             size_t k, size_t* indices, double* gains, size_t* found,
                             const vg_watch* watch);

/* ---- Looking at a view ---- */

enum { VG_HIT_NONE = 0, VG_HIT_UNKNOWN = 1, VG_HIT_OCCUPIED = 2, VG_HIT_OBSTACLE = 3 };

/* Where the rays of a pose end: depth along the optical axis [m], +infinity where a ray meets
   nothing, and what it meets (VG_HIT_; null: not wanted). count must be image_width *
   image_height. A bad pose is VG_INVALID_ARGUMENT. */
VG_API vg_status vg_depth_image(const vg_evaluator* evaluator, const double T_world_camera[16],
                                float* depth, uint8_t* labels, size_t count);

/* What one voxel adds to the gain of a view. */
typedef struct vg_contribution {
  int32_t voxel[3]; /* on the grid's lattice */
  int32_t state;    /* 0 unknown, 2 occupied */
  uint32_t rays;    /* that end in it */
  double gain;      /* [nat, or m^2] */
} vg_contribution;

/* Why a view is good: one entry a voxel in which rays end, the largest gain first; the gains add up
   to the view's. Fills at most `capacity` of them and says in *found how many there are; never more
   than rays_per_pose. contribution_size is sizeof(vg_contribution). None for a camera in an
   occupied voxel; a bad pose is VG_INVALID_ARGUMENT. */
VG_API vg_status vg_contributions(const vg_evaluator* evaluator, const double T_world_camera[16],
                                  vg_contribution* contributions, size_t contribution_size,
                                  size_t capacity, size_t* found);

/* ---- Which poses are possible ---- */

typedef struct vg_feasibility vg_feasibility;

enum {
  VG_FEASIBLE = 0,
  VG_INFEASIBLE_BAD_POSE = 1,
  VG_INFEASIBLE_UNREACHABLE = 2, /* `reachable` says no */
  VG_INFEASIBLE_TAKEN = 3,       /* a view was taken there already */
  VG_INFEASIBLE_PLANE = 4,       /* the body would touch the support plane or be under it */
  VG_INFEASIBLE_OBSTACLE = 5,    /* the body would overlap a known obstacle */
  VG_INFEASIBLE_COLLISION = 6,   /* the body would overlap voxels that are not free */
  VG_INFEASIBLE_TOO_NEAR = 7     /* much of the image would be nearer than the sensor can measure */
};

typedef struct vg_feasibility_config {
  size_t struct_size;
  double body_size[3];        /* width, height, depth of the housing [m]; 0.065 0.065 0.076 */
  int32_t has_flange;         /* nonzero: T_flange_camera counts; else the camera is in the */
  double T_flange_camera[16]; /* middle of the body's front face */
  double clearance;           /* the body is grown by this on each side [m]; 0 */
  double support_plane;       /* its height, world z [m]; NaN (the default): none */
  double taken_distance;      /* views this near ... [m]; 0.010 */
  double taken_angle;         /* ... and this much alike are the same [rad]; 2 degrees */
  const vg_sensor* sensor;    /* null (the default): nothing is too near; read during create */
  double max_near_share;      /* of the rays; 0.2 */
  /* Whether the robot can put the camera there: nonzero, yes. Null (the default): everywhere. Must
     be thread safe, and must not throw or jump out. */
  int32_t (*reachable)(const double T_world_camera[16], void* user);
  void* user; /* may be null */
} vg_feasibility_config;
VG_API void vg_feasibility_config_init(vg_feasibility_config* config, size_t struct_size);

/* config null: the defaults. */
VG_API vg_status vg_feasibility_create(const vg_scene* scene, const vg_feasibility_config* config,
                                       vg_feasibility** feasibility);

/* Why each pose is not possible (VG_FEASIBLE: it is); the first reason in the order above counts.
   `taken`: the poses of the views so far, 16 doubles each. On the calling thread. */
VG_API vg_status vg_feasibility_check(const vg_feasibility* feasibility, const double* poses,
                                      size_t count, const double* taken, size_t taken_count,
                                      int32_t* reasons);
VG_API void vg_feasibility_release(vg_feasibility* feasibility);

/* ---- Poses ---- */

/* count poses evenly on a sphere round `center`, looking at it, image up = world up (+z). */
VG_API vg_status vg_sphere_poses(size_t count, double radius, const double center[3],
                                 double* poses);
/* The same on its upper half. */
VG_API vg_status vg_dome_poses(size_t count, double radius, const double center[3], double* poses);

/* A camera at `eye` that looks at `target`, image up as near to `up` as can be (null: +z). */
VG_API vg_status vg_look_at(const double eye[3], const double target[3], const double up[3],
                            double T_world_camera[16]);

#ifdef __cplusplus
}
#endif
#endif
