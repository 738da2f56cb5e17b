/* SPDX-FileCopyrightText: 2026 The viewgain authors
   SPDX-License-Identifier: Apache-2.0 */
#ifndef VIEWGAIN_C_SCORER_H
#define VIEWGAIN_C_SCORER_H

/* Part of viewgain/viewgain.h: adds frames or labels, and scores poses, like ViewScorer in C++. */

#include "viewgain/c/gain.h"

#ifdef __cplusplus
extern "C" {
#endif

/* A map, its scene and its evaluator, kept up to date. vg_scorer_evaluate(), vg_scorer_best(),
   vg_scorer_scene() and vg_scorer_evaluator() may run in any thread at any time. During a change of
   the map they use the map before or after that change. Changes (add, set, forget) wait for one
   another. vg_scorer_save(), vg_scorer_grid() and vg_scorer_consistency() must not run during a
   change. */
typedef struct vg_scorer vg_scorer;

/* Settings of a scorer. */
typedef struct vg_scorer_config {
  size_t struct_size;            /* set by _init() */
  int32_t num_threads;           /* 0: all; does not affect results */
  int32_t tracer;                /* VG_TRACER_AUTOMATIC; does not affect results */
  int32_t gain;                  /* VG_GAIN_COMBINED */
  int32_t pixel_stride;          /* 1: every pixel; s: every s-th of every s-th row */
  double voxel_size;             /* 0.005 [m] */
  double box_min[3], box_max[3]; /* the workspace, grid frame: -0.25 to 0.25 [m] */
  double T_world_grid[16];       /* identity */
  double prior_sigma;            /* standard deviation of an unknown voxel [m]; NaN (the default):
                                    vg_default_prior_sigma() */
  double support_plane;          /* height z of an infinite table, world [m]; NaN: none */
  const double* boxes;           /* obstacles; measured depths of obstacles only mark free space */
  size_t box_count;              /* number of boxes */
  const double* vertices;        /* obstacles as triangles */
  size_t vertex_count;           /* number of vertices */
  const uint32_t* triangles;     /* 3 vertex indices each */
  size_t triangle_count;         /* number of triangles */
  double jump_edge_angle; /* angle of the filter for flying pixels [rad]; default 5 deg; 0: off */
  double object_size; /* longest side of the object [m]; NaN (the default): that of its seen part */
  double body_size[3]; /* width, height, depth of the sensor's housing [m]; all 0 (the default):
                          vg_scorer_best() does not check feasibility */
  int32_t has_flange;  /* nonzero: uses T_flange_camera, as in vg_feasibility_config */
  double T_flange_camera[16]; /* identity */
  double clearance;           /* free space required around the body [m]; default 0 */
  int32_t coarsest, finest;   /* scales of cells, as in vg_integrator_config; default 0 */
  const double* fine;         /* as in vg_integrator_config */
  size_t fine_count;          /* number of boxes */
} vg_scorer_config;
/* Sets the defaults. */
VG_API void vg_scorer_config_init(vg_scorer_config* config, size_t struct_size);

/* Creates a scorer with an empty map. If config is null, the defaults apply. Arguments are copied.
 */
VG_API vg_status vg_scorer_create(const vg_sensor* sensor, const vg_scorer_config* config,
                                  vg_scorer** scorer);
/* Continues a file of vg_scorer_save(), or another .vdb map of viewgain, whose layout and prior
   replace those of config. */
VG_API vg_status vg_scorer_load(const char* path, const vg_sensor* sensor,
                                const vg_scorer_config* config, vg_scorer** scorer);
/* Writes the map as .vdb, atomically. */
VG_API vg_status vg_scorer_save(const vg_scorer* scorer, const char* path);
VG_API void vg_scorer_release(vg_scorer* scorer); /* null: no effect */

/* Verdict of a frame: in the map with readings, in the map with free space only, or why it is not
   in the map. */
enum {
  VG_FRAME_USED = 0,
  VG_FRAME_CARVED = 1,
  VG_FRAME_LOST_POSE = 2,        /* not a rigid transform of finite numbers */
  VG_FRAME_NOTHING_IN_RANGE = 6, /* all pixels are invalid */
  VG_FRAME_OUTSIDE = 7,          /* it shows nothing of the workspace */
  VG_FRAME_NOT_METRES = 11       /* nearly all depths are beyond 10 times max_range */
};

/* Effect of a frame. */
typedef struct vg_map_update {
  size_t struct_size;                  /* set by _init() */
  int32_t verdict;                     /* VG_FRAME_; if it is 2 or more, the map did not change */
  uint64_t readings, readings_inside;  /* all readings; readings in the workspace */
  uint64_t voxels_hit, voxels_crossed; /* as in vg_integration_report */
  uint64_t flying_pixels;              /* pixels removed by the filter */
  double new_area; /* area of new surface, measured perpendicular to the rays [m^2]; NaN with
                      VG_GAIN_PAPER */
} vg_map_update;
/* Prepares `update` for a call. */
VG_API void vg_map_update_init(vg_map_update* update, size_t struct_size);

/* Adds a frame: `depth` and the other arguments as in vg_integrate(). Filters it, marks obstacles,
   and updates the hazard and the scene. `update` may be null. If the frame cannot be used, the
   result is VG_OK, and the verdict gives the reason. */
VG_API vg_status vg_scorer_add(vg_scorer* scorer, const float* depth, const float* amplitude,
                               const double T_world_camera[16], const double pose_sigma[2],
                               vg_map_update* update);
/* Labels a box of voxels, like vg_grid_update_box(). Labelled voxels add no refinement to the
   gain. */
VG_API vg_status vg_scorer_set(vg_scorer* scorer, const int32_t first[3], const int32_t dims[3],
                               const uint8_t* labels, uint64_t* changed);
/* Resets a box of the grid frame [m] to unknown, like vg_grid_forget(), for moved objects. */
VG_API vg_status vg_scorer_forget(vg_scorer* scorer, const double min[3], const double max[3],
                                  uint64_t* forgotten);

/* The gain of each pose on the current map, like vg_evaluate(). */
VG_API vg_status vg_scorer_evaluate(const vg_scorer* scorer, const double* poses, size_t count,
                                    double* gains, const vg_watch* watch);
/* The k best poses with high probability, best first, like vg_race(). If body_size is set, only
   feasible poses are chosen. costs: one per pose, subtracted from its gain, in the gain's unit; may
   be null. deadline: time limit of the call [s], as in vg_race(); INFINITY: none. */
VG_API vg_status vg_scorer_best(const vg_scorer* scorer, const double* poses, size_t count,
                                size_t k, const double* costs, double deadline, size_t* indices,
                                double* gains, size_t* found, const vg_watch* watch);

/* A copy of the map. */
VG_API vg_status vg_scorer_grid(const vg_scorer* scorer, vg_grid** grid);
/* The current scene, for the functions that take one. */
VG_API vg_status vg_scorer_scene(const vg_scorer* scorer, vg_scene** scene);
/* An evaluator of the current scene, for the functions that take one. */
VG_API vg_status vg_scorer_evaluator(const vg_scorer* scorer, vg_evaluator** evaluator);

/* How well the frames in the map agree, like FrameConsistency in C++. */
typedef struct vg_consistency {
  size_t struct_size;     /* set by _init() */
  size_t frames;          /* number of added frames */
  size_t contradicting;   /* number of frames that contradict the others */
  double share_in_free;   /* fraction of all readings in space that other frames saw as free */
  double share_seen_past; /* fraction of earlier frames' readings that later frames see past */
  double displacement;    /* median displacement of surfaces between frames [m]; NaN if no frames
                             could be compared */
  double expected;        /* displacement that the declared errors explain [m] */
  char kind[32];          /* likely cause; empty: the frames agree */
  char what[480];         /* a sentence for people, truncated if too long */
} vg_consistency;
/* Prepares `found` for a call. */
VG_API void vg_consistency_init(vg_consistency* found, size_t struct_size);

/* Compares the frames that were added since the scorer was made or loaded. `contradicts` may be
   null; otherwise it has room for `capacity` entries, at least one per frame, and an entry is
   nonzero for a frame that contradicts the others. Takes 50 ms, or 0.5 s if frames disagree. */
VG_API vg_status vg_scorer_consistency(const vg_scorer* scorer, vg_consistency* found,
                                       int32_t* contradicts, size_t capacity);

#ifdef __cplusplus
}
#endif
#endif
