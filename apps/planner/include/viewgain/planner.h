/* SPDX-FileCopyrightText: 2026 The viewgain authors
   SPDX-License-Identifier: Apache-2.0 */
#ifndef VIEWGAIN_PLANNER_H
#define VIEWGAIN_PLANNER_H

/* Next best views step by step, for C: frames in, views out. Its functions are in the library
   viewgain_planner (pkg-config viewgain-planner); viewgain/viewgain.h says what holds for all
   functions, viewgain/planner/view_planner.hpp more about each step. One call at a time on
   a planner. */

#include "viewgain/viewgain.h"

#ifdef __cplusplus
extern "C" {
#endif

/* A planner: a map, what was tried, and how to choose. */
typedef struct vg_planner vg_planner;

/* Beside VG_INFEASIBLE_: the pose was tried and not reached. How many reasons there are. */
enum { VG_INFEASIBLE_MISSED = 8, VG_PLANNER_REASONS = 9 };

/* Why to end. */
enum {
  VG_GO_ON = 0,
  VG_STOP_GAIN = 1,          /* the best candidate promises too little */
  VG_STOP_AREA = 2,          /* no candidate promises enough new surface */
  VG_STOP_COST = 3,          /* going to the best candidate costs more than it promises */
  VG_STOP_NO_CANDIDATES = 4, /* nothing is left to look at */
  VG_STOP_UNREACHABLE = 5,   /* candidates are left, all of them out of reach */
  VG_STOP_IDLE = 6,          /* views in a row brought nothing new */
  VG_STOP_PROMISES = 7,      /* views in a row brought far less than they promised */
  VG_STOP_MAX_VIEWS = 8
};

/* What a planner is set up with; fields are as in C++'s PlannerConfig. */
typedef struct vg_planner_config {
  size_t struct_size;            /* as _init() sets it */
  int32_t num_threads;           /* 0: all; never changes a result */
  int32_t gain;                  /* VG_GAIN_COMBINED */
  double voxel_size;             /* [m]; must be given */
  double box_min[3], box_max[3]; /* the workspace, in the grid's frame [m]; must be given */
  double T_world_grid[16];       /* identity */
  double prior_sigma;            /* of an unknown voxel [m]; NaN (the default):
                                    vg_default_prior_sigma() */
  double support_plane;          /* height of the table, world z [m]; NaN (the default): none */
  /* Known obstacles, as in vg_scene_config: they block rays and the body, and readings of them
     carve but do not hit. */
  const double* boxes;
  size_t box_count;          /* how many boxes */
  const double* vertices;    /* obstacles, world: 3 numbers each */
  size_t vertex_count;       /* how many vertices */
  const uint32_t* triangles; /* 3 vertex indices each */
  size_t triangle_count;     /* how many triangles */
  double jump_edge_angle;    /* of the filter for flying pixels, 1 to 10 degrees [rad]; 5; 0: off */
  /* The body and where it can be, as in vg_feasibility_config. */
  int32_t check_feasibility;  /* 1; 0: all candidates are possible but those taken or tried */
  int32_t has_flange;         /* 0: the camera's centre is the middle of the body's front face */
  double body_size[3];        /* width, height, depth, in this order [m] */
  double T_flange_camera[16]; /* camera to flange, rows */
  double clearance;           /* round the body [m] */
  int32_t (*reachable)(const double T_world_camera[16],
                       void* user);                /* may the camera be there? null: anywhere */
  void* user;                                      /* handed to reachable */
  uint64_t max_views, idle_views, broken_promises; /* 20, 3, 3; the last two 0: never */
  /* So many views are planned together, in a short order (C++'s PlanAhead); 1: one. */
  uint64_t plan;
  /* So many of them are taken before it is planned anew, 1 to `plan`. */
  uint64_t take;
  double stop_gain, stop_area; /* NaN: the defaults of the gain; 0: never */
  int32_t tracer;              /* VG_TRACER_AUTOMATIC; never changes a result */
  int32_t coarsest;            /* scales, as in vg_integrator_config: 0 */
  const double* fine;          /* boxes in which scales stay 0 */
  size_t fine_count;           /* how many boxes */
  int32_t finest;              /* 0 */
} vg_planner_config;
/* The defaults. */
VG_API void vg_planner_config_init(vg_planner_config* config, size_t struct_size);

/* An empty map; the planner keeps copies of what it gets. */
VG_API vg_status vg_planner_create(const vg_sensor* sensor, const vg_planner_config* config,
                                   vg_planner** planner);
VG_API void vg_planner_release(vg_planner* planner); /* null: nothing */

/* Candidates that are proposed from the next vg_planner_propose() on, 16 doubles each. */
VG_API vg_status vg_planner_add_poses(vg_planner* planner, const double* poses, size_t count);

/* What became of a frame, as C++'s FrameVerdict: in the map, with readings or free space alone, or
   why not. How many verdicts there are. */
enum {
  VG_FRAME_USED = 0,
  VG_FRAME_CARVED = 1,
  VG_FRAME_LOST_POSE = 2,
  VG_FRAME_NO_POSE = 3,
  VG_FRAME_UNREADABLE = 4,
  VG_FRAME_WRONG_SIZE = 5,
  VG_FRAME_NOTHING_IN_RANGE = 6,
  VG_FRAME_OUTSIDE = 7,
  VG_FRAME_CONTRADICTS = 8,
  VG_FRAME_CHANGED = 9,
  VG_FRAME_NO_MASK = 10,
  VG_FRAME_VERDICTS = 11
};

/* What a view brought. */
typedef struct vg_planner_view {
  size_t struct_size;                            /* as _init() sets it */
  int32_t verdict;                               /* VG_FRAME_ */
  uint64_t view;                                 /* from 0 */
  uint64_t readings, readings_inside;            /* pixels; those in the workspace */
  uint64_t voxels_hit, voxels_crossed;           /* by it */
  uint64_t unknown_voxels;                       /* that are left */
  double entropy_removed, total_entropy_removed; /* by it and so far [nat] */
  double new_area, total_area; /* new surface that it showed, across the rays, and so far [m^2];
                                  new_area is NaN with VG_GAIN_PAPER */
} vg_planner_view;
/* Makes `view` ready for a call. */
VG_API void vg_planner_view_init(vg_planner_view* view, size_t struct_size);

/* Puts a frame into the map, as vg_integrate(); `pose_sigma`, after vg_planner_register() what it
   found, or null; `added` or null. A frame that cannot be used (a pose that is not rigid, too)
   leaves the map as it was, counts as a view that brought nothing, and is VG_OK: its verdict says
   why. */
VG_API vg_status vg_planner_add(vg_planner* planner, const float* depth, const float* amplitude,
                                const double T_world_camera[16], const double pose_sigma[2],
                                vg_planner_view* added);

/* A view that came to nothing before there was a frame to add, or whose frame is left out, counts
   as one that cannot be used. `verdict`: from VG_FRAME_LOST_POSE on; T_world_camera: where it was
   taken, or null. */
VG_API vg_status vg_planner_drop(vg_planner* planner, int32_t verdict,
                                 const double T_world_camera[16]);
/* How many frames had each verdict so far: counts[verdict], `verdicts` of them. */
VG_API vg_status vg_planner_frames(const vg_planner* planner, size_t* counts, size_t verdicts);

/* Whether the frames in the map fit one another, as C++'s FrameConsistency. */
typedef struct vg_consistency {
  size_t struct_size;     /* as _init() sets it */
  size_t frames;          /* in the map */
  size_t contradicting;   /* of these, those that contradict the others */
  double share_in_free;   /* of all readings, those in space that other frames saw as free */
  double share_seen_past; /* of earlier frames' readings, those that later frames see past */
  double displacement;    /* of frames against earlier ones, median [m]; NaN: none */
  double expected;        /* the displacement that the declared errors explain [m] */
  char kind[32];          /* the likely cause; empty: the frames agree */
  char what[480];         /* a sentence for people; cut off if it is longer */
} vg_consistency;
/* Makes `found` ready for a call. */
VG_API void vg_consistency_init(vg_consistency* found, size_t struct_size);

/* Compares the frames that went into the map since the planner was made or loaded. `contradicts`
   may be null; else it has room for `capacity` entries, at least one per frame, and an entry is
   nonzero for a frame that contradicts the others. Takes 50 ms, 0.5 s if frames do not fit. */
VG_API vg_status vg_planner_consistency(const vg_planner* planner, vg_consistency* found,
                                        int32_t* contradicts, size_t capacity);

/* The same for frames that a vg_integrator puts into a map. One call at a time on a check. */
typedef struct vg_frame_check vg_frame_check;
/* support_plane: height of the table, world z [m]; NaN: none. */
VG_API vg_status vg_frame_check_create(const vg_sensor* sensor, double support_plane,
                                       vg_frame_check** check);
/* Takes a frame that is about to be integrated into `before`; parameters as vg_integrate()'s.
   Flying pixels contradict other frames: set them to 0 before.
   Takes 0.5 ms for 25,344 pixels. */
VG_API vg_status vg_frame_check_look(vg_frame_check* check, const vg_grid* before,
                                     const float* depth, const double T_world_camera[16],
                                     const double pose_sigma[2]);
/* What the frames so far come to, by the map with all of them, as vg_planner_consistency(). */
VG_API vg_status vg_frame_check_result(const vg_frame_check* check, const vg_grid* after,
                                       vg_consistency* found, int32_t* contradicts,
                                       size_t capacity);
VG_API void vg_frame_check_release(vg_frame_check* check); /* null: nothing */

/* What became of a frame that was registered. */
enum {
  VG_REGISTERED = 0,
  VG_TOO_LITTLE_OVERLAP = 1, /* the map says too little of what it shows; add it as reported */
  VG_REFUSED = 2             /* it contradicts the map, or would move too far; do not add it */
};

/* Where a frame's camera was. */
typedef struct vg_registration {
  size_t struct_size;           /* as _init() sets it */
  int32_t status;               /* VG_REGISTERED, VG_TOO_LITTLE_OVERLAP or VG_REFUSED */
  int32_t free_directions;      /* motions that the frame does not hold: as reported */
  double T_world_camera[16];    /* corrected if registered, else as reported, made rigid; rows */
  double covariance[36];        /* 6 x 6, row by row: translation [m], rotation [rad], world axes */
  double pose_sigma[2];         /* the same by the axes' mean, as vg_planner_add() takes it */
  double translation, rotation; /* of the correction that was found [m], [rad] */
  double residual_before;       /* RMS distance from the map at the reported pose [m] */
  double residual_after;        /* and at the one that was found [m] */
  double overlap, contradiction; /* shares of the readings, as FrameRegistration's */
} vg_registration;
/* Makes `found` ready for a call. */
VG_API void vg_registration_init(vg_registration* found, size_t struct_size);

/* Where the camera was, by what the frame shows of the map so far; changes nothing. The sigmas say
   how far each coordinate [m] and each component of the rotation [rad] of the reported pose may be
   off. C++'s ViewPlanner::register_frame(). */
VG_API vg_status vg_planner_register(vg_planner* planner, const float* depth,
                                     const float* amplitude, const double T_reported[16],
                                     double sigma_translation, double sigma_rotation,
                                     vg_registration* found);

/* What is possible now of the candidates: *candidates, how many, and in dropped[reason] how many
   are not and why; dropped, or null, has one a reason, `reasons` of them. */
VG_API vg_status vg_planner_propose(vg_planner* planner, size_t* candidates, size_t* dropped,
                                    size_t reasons);

/* One of the best. */
typedef struct vg_ranked_view {
  size_t index;              /* of the candidate in the proposal, or of the pose that was given */
  double T_world_camera[16]; /* camera to world, rows */
  double gain;               /* as vg_view_gain's */
  double area;               /* as vg_view_gain's */
  double worth;              /* the gain less the cost */
} vg_ranked_view;

/* The k best candidates of the last proposal, which must have come since the last view, best first.
   costs: one a candidate, in the gain's unit, or null; cost_per_metre: of the straight way from
   current_pose, likewise. current_pose is where the camera is, camera to world; null: the pose of
   the last frame, whether it could be used or not, or of a later vg_planner_tried() that was
   reached. view_size is sizeof(vg_ranked_view). *found says how many there are. watch or null. */
VG_API vg_status vg_planner_rank(vg_planner* planner, size_t k, const double* costs,
                                 size_t cost_count, double cost_per_metre,
                                 const double current_pose[16], vg_ranked_view* views,
                                 size_t view_size, size_t* found, const vg_watch* watch);

/* The same of any poses; nobody looks whether they are possible. Bad ones are left out. Says
   nothing to vg_planner_should_stop(). */
VG_API vg_status vg_planner_rank_poses(vg_planner* planner, const double* poses, size_t count,
                                       size_t k, const double* costs, size_t cost_count,
                                       double cost_per_metre, const double current_pose[16],
                                       vg_ranked_view* views, size_t view_size, size_t* found,
                                       const vg_watch* watch);

/* Why a pose's gain is what it is on the map as it stands: what becomes of its rays. */
VG_API vg_status vg_planner_outcomes(vg_planner* planner, const double T_world_camera[16],
                                     vg_ray_outcomes* outcomes);

/* The pose was commanded; reached: nonzero if the camera got there. In both cases it is not
   proposed again and goes out of the proposal as it stands. Only for poses that were commanded. */
VG_API vg_status vg_planner_tried(vg_planner* planner, const double T_world_camera[16],
                                  int32_t reached);

/* *reason: VG_GO_ON or why to end. */
VG_API vg_status vg_planner_should_stop(const vg_planner* planner, int32_t* reason);

/* The whole state but for the last proposal in one file, a map that vg_grid_load() reads too, whole
   or not at all; and a planner that goes on from there, bit for bit, with the same sensor, config
   and candidates. */
VG_API vg_status vg_planner_save(const vg_planner* planner, const char* path);
/* Goes on where vg_planner_save() was called, by the same sensor and settings. */
VG_API vg_status vg_planner_load(const char* path, const vg_sensor* sensor,
                                 const vg_planner_config* config, vg_planner** planner);

/* A copy of the map as it is. */
VG_API vg_status vg_planner_grid(const vg_planner* planner, vg_grid** grid);

#ifdef __cplusplus
}
#endif
#endif
