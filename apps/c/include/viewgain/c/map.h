/* SPDX-FileCopyrightText: 2026 The viewgain authors
   SPDX-License-Identifier: Apache-2.0 */
#ifndef VIEWGAIN_C_MAP_H
#define VIEWGAIN_C_MAP_H

/* Part of viewgain/viewgain.h: sensors, belief grids and what changes them. */

#include "viewgain/c/base.h"

#ifdef __cplusplus
extern "C" {
#endif

/* ---- Sensors ---- */

/* Standard deviations of a reading at range t, along the ray and across it; see core's noise.hpp.
   The parameters are those of vg_sensor.noise, in this order. */
enum {
  VG_NOISE_SHOT = 0,             /* time of flight: reference_sigma, reference_range,
                                    reference_integration_time, integration_time,
                                    modulation_frequency, min_amplitude */
  VG_NOISE_STRUCTURED_LIGHT = 1, /* offset, quadratic, vertex, grazing, lateral_px,
                                    lateral_grazing_px */
  VG_NOISE_STEREO = 2,           /* subpixel, focal (0: fx), baseline */
  VG_NOISE_QUADRATIC = 3,        /* offset, quadratic, linear */
  VG_NOISE_CONSTANT = 4          /* sigma_axial, sigma_lateral */
};

/* What the value 65535 of a depth image says: as the layout of its folder has it, nothing up to
   max_range, or no reading. */
enum { VG_OUT_OF_RANGE_BY_LAYOUT = 0, VG_OUT_OF_RANGE_CARVE = 1, VG_OUT_OF_RANGE_INVALID = 2 };

/* A depth camera. Pixel (0,0) has its centre at (0,0), as in OpenCV. It has no table of ranges:
   frames of a camera that has one are corrected first, see vg_range_calibration. */
typedef struct vg_sensor {
  size_t struct_size;          /* as _init() sets it */
  int32_t width, height;       /* [px] */
  double fx, fy, cx, cy;       /* [px] */
  double distortion[5];        /* k1 k2 p1 p2 k3, in this order */
  double min_range, max_range; /* along the ray [m] */
  double working_distance;     /* where it is meant to be used [m] */
  int32_t noise_model;         /* VG_NOISE_ */
  int32_t out_of_range;        /* VG_OUT_OF_RANGE_ */
  double noise[6];             /* the model's parameters, in the order of VG_NOISE_; the rest 0 */
  double pose_sigma[2];        /* of the poses of frames, in this order: [m], [rad]; 0: exact */
  double scale_sigma;          /* of one factor, less 1, that all ranges are off by; 0: none */
} vg_sensor;
VG_API void vg_sensor_init(vg_sensor* sensor, size_t struct_size); /* all 0: nothing is valid yet */

/* Fills a sensor that vg_sensor_init has seen: the preset of a name, say "sr4000"; the message of
   a wrong one lists them. */
VG_API vg_status vg_sensor_preset(const char* name, vg_sensor* sensor);

/* *sigma: the prior sigma [m] that suits a voxel size and a sensor: max(voxel / 2, 2 sigma_ax at
   the working distance). */
VG_API vg_status vg_default_prior_sigma(double voxel_size, const vg_sensor* sensor, double* sigma);

/* A camera's systematic error by the range, and the rays of its pixels. Never changes: may be used
   from many threads at once. */
typedef struct vg_range_calibration vg_range_calibration;

/* For the sensor's camera, from a table of `rows` x 2 numbers, row by row: a measured range, and
   measured minus true range [m]; measured ranges rise. The error is interpolated linearly between
   rows and held beyond the ends. VG_INVALID_ARGUMENT, naming the value: no row, a number that is
   not finite, measured ranges that do not rise, a range that is not positive, measured or
   corrected, or a sensor that is not valid. Costs 8 bytes and 10 ns a pixel, with lens distortion
   0.4 us. */
VG_API vg_status vg_range_calibration_create(const vg_sensor* sensor, const double* table,
                                             size_t rows, vg_range_calibration** calibration);

/* Corrects a frame in place, along the rays of its pixels, with the same bits as C++: `depth` along
   the optical axis [m], row by row, width * height values of the sensor, 0 invalid, +infinity out
   of range. A reading whose corrected range is not positive becomes 0; what is no reading stays as
   it is. Once a frame: a second call would correct it again. Costs 10 ns a pixel, with lens
   distortion or without. */
VG_API vg_status vg_range_calibration_correct(const vg_range_calibration* calibration,
                                              float* depth);
VG_API void vg_range_calibration_release(vg_range_calibration* calibration); /* null: nothing */

/* ---- Belief grids ---- */

/* A map of what is known of a workspace. Nothing may run beside a call that changes it. */
typedef struct vg_grid vg_grid;

/* How a map is laid out. */
typedef struct vg_grid_config {
  size_t struct_size;            /* as _init() sets it */
  double voxel_size;             /* [m] */
  double box_min[3], box_max[3]; /* the workspace, in the grid's frame; grown to whole voxels */
  double T_world_grid[16];       /* identity */
  double prior_sigma;            /* of an unknown voxel [m] */
} vg_grid_config;
VG_API void vg_grid_config_init(vg_grid_config* config, size_t struct_size); /* the defaults */

/* An empty map: every voxel of the workspace is unknown. */
VG_API vg_status vg_grid_create(const vg_grid_config* config, vg_grid** grid);

/* A map from a dense array of states of dims voxels along x, y, z. The corner of voxel (0,0,0) is
   at `origin`, world: the grid's frame is moved there, its axes are the world's. */
VG_API vg_status vg_grid_from_labels(const uint8_t* labels, const int32_t dims[3],
                                     const double origin[3], double voxel_size, double prior_sigma,
                                     vg_grid** grid);

VG_API vg_status vg_grid_load(const char* path, vg_grid** grid); /* a .vdb file of viewgain */
/* Writes the map as .vdb, whole or not at all. */
VG_API vg_status vg_grid_save(const vg_grid* grid, const char* path);

/* A deep copy. */
VG_API vg_status vg_grid_clone(const vg_grid* grid, vg_grid** copy);
VG_API void vg_grid_release(vg_grid* grid); /* null: nothing */

/* What a map is, and how far. */
typedef struct vg_grid_info {
  size_t struct_size;               /* as _init() sets it */
  int32_t min_index[3];             /* x, y, z of the lowest voxel on the grid's lattice */
  int32_t dims[3];                  /* voxels along x, y, z */
  double voxel_size;                /* [m] */
  double prior_sigma;               /* [m] */
  double T_world_grid[16];          /* grid to world, rows */
  uint64_t unknown, free, occupied; /* voxels */
  uint64_t views;                   /* frames integrated */
  uint64_t bytes;                   /* memory */
  double entropy_removed;           /* how far the map is, by log_diagonal [nat] */
  double hazard_factors[8];         /* what frames have said of the hazard of unknown space, one a
                                       class of distance from known surface, nearest first, before
                                       rates are made to fall with it: vg_calibrate_hazard() */
} vg_grid_info;
/* Makes `info` ready for the call below. */
VG_API void vg_grid_info_init(vg_grid_info* info, size_t struct_size);
/* Tells what the map is. Costs a pass over its blocks. */
VG_API vg_status vg_grid_get_info(const vg_grid* grid, vg_grid_info* info);

/* The dense array of states; count must be dims[0] * dims[1] * dims[2]. */
VG_API vg_status vg_grid_states(const vg_grid* grid, uint8_t* states, size_t count);

/* In all three places of an index where there is no voxel. */
enum { VG_NO_VOXEL = INT32_MIN };

/* The voxels that hold points of the world, 3 numbers each [m]: 3 indices each, on the lattice
   (minus min_index for arrays), or VG_NO_VOXEL for a point outside the workspace or not finite. */
VG_API vg_status vg_grid_index_of(const vg_grid* grid, const double* points, size_t count,
                                  int32_t* voxels);

/* Centres of voxels in the world, 3 numbers each [m]; the voxels (3 indices each) need not lie in
   the workspace. */
VG_API vg_status vg_grid_center(const vg_grid* grid, const int32_t* voxels, size_t count,
                                double* centers);

/* Sets voxels of the workspace (3 indices each, on the lattice), in their order, all or none. A
   log-odds above 0 makes a voxel occupied, another one free; it is rounded to the nearest step of
   0.05 and clamped to -2..3.5. The voxels have no belief afterwards. VG_INVALID_ARGUMENT: a voxel
   outside the workspace or a log-odds that is NaN. */
VG_API vg_status vg_grid_set(vg_grid* grid, const int32_t* voxels, const float* log_odds,
                             size_t count);

/* Makes the voxels unknown again whose centres lie in a box of the grid's frame [m]; bounds may be
   infinite. Views stay. *forgotten, or null: how many of them were known. VG_INVALID_ARGUMENT: a
   bound that is not a number. */
VG_API vg_status vg_grid_forget(vg_grid* grid, const double min[3], const double max[3],
                                uint64_t* forgotten);

/* Makes the voxels of a box of the lattice, from its lowest voxel `first`, what labels say,
   [x][y][z] with z fastest, as vg_grid_from_labels has it: for a planner whose own map grows.
   Voxels that are that already stay as they are, the others have no belief afterwards. *changed, or
   null: how many voxels have changed. VG_INVALID_ARGUMENT, with nothing changed: a box that is not
   inside the workspace, another label. */
VG_API vg_status vg_grid_update_box(vg_grid* grid, const int32_t first[3], const int32_t dims[3],
                                    const uint8_t* labels, uint64_t* changed);

/* How large the cells are as which voxels (3 indices each, on the lattice) are known: s, 0 to 3, of
   2^s voxels an edge; 0 outside the workspace. */
VG_API vg_status vg_grid_scale(const vg_grid* grid, const int32_t* voxels, size_t count,
                               uint8_t* scales);

/* Gives the leaves of 8^3 voxels that a box of the grid's frame [m] touches cells of another size;
   bounds may be infinite. Hits and information of larger cells are sums; what goes to smaller ones
   goes to the one that holds the mean of the readings, and what else was occupied with it becomes
   unknown. *changed, or null: how many leaves have. VG_INVALID_ARGUMENT: a bound that is not a
   number, a scale that is not 0 to 3. */
VG_API vg_status vg_grid_resample(vg_grid* grid, const double min[3], const double max[3],
                                  int32_t scale, uint64_t* changed);

/* The occupied voxels, of a larger cell the lowest, 3 indices each, on the lattice; equal maps give
   the same order. Fills at most `capacity` of them and says in *found how many there are. log_odds
   or null: not wanted. */
VG_API vg_status vg_grid_occupied(const vg_grid* grid, int32_t* voxels, float* log_odds,
                                  size_t capacity, size_t* found);

/* 16 hexadecimal digits and a 0 over all that the map holds; the same for equal maps. */
VG_API vg_status vg_grid_hash(const vg_grid* grid, char hash[17]);

/* ---- Depth frames ---- */

/* Puts depth frames of one sensor into maps. One call at a time. */
typedef struct vg_integrator vg_integrator;

/* What a pixel is: a cone, which carves the voxels whose centres lie in it, or a line. */
enum { VG_CARVE_CONES = 0, VG_CARVE_LINES = 1 };
/* How a map follows: by log-odds, or crossed is free and hit is occupied. */
enum { VG_OCCUPANCY_PROBABILISTIC = 0, VG_OCCUPANCY_LITERAL = 1 };

/* What changes the map. */
typedef struct vg_integrator_config {
  size_t struct_size;   /* as _init() sets it */
  int32_t carve;        /* VG_CARVE_CONES */
  int32_t occupancy;    /* VG_OCCUPANCY_PROBABILISTIC */
  int32_t num_threads;  /* 0: all; 1: the caller alone; never changes the map */
  int32_t coarsest;     /* greatest scale of a leaf, 0 to 3, where a pixel covers as much */
  double support_plane; /* height of the table, world z [m]; NaN (the default): none */
  const double* fine;   /* boxes in which scales stay 0: lowest and highest corners, grid's frame
                           [m]; null (the default): none */
  size_t fine_count;    /* of the boxes, 6 numbers each */
  int32_t finest;       /* least scale outside the boxes, at most coarsest */
} vg_integrator_config;
/* The defaults. */
VG_API void vg_integrator_config_init(vg_integrator_config* config, size_t struct_size);

/* Counts of one frame. */
typedef struct vg_integration_report {
  size_t struct_size;                  /* as _init() sets it */
  uint64_t readings;                   /* pixels with a depth in the sensor's range */
  uint64_t plane_readings;             /* such pixels that see the support plane, not in readings */
  uint64_t out_of_range;               /* pixels that carve up to max_range */
  uint64_t invalid;                    /* pixels that say nothing */
  uint64_t readings_inside;            /* readings that lie in the workspace */
  uint64_t voxels_hit, voxels_crossed; /* voxels that readings lie in; voxels crossed and not hit */
} vg_integration_report;
/* Makes `report` ready for a call. */
VG_API void vg_integration_report_init(vg_integration_report* report, size_t struct_size);

/* Puts frames of one sensor into maps. config null: the defaults. */
VG_API vg_status vg_integrator_create(const vg_sensor* sensor, const vg_integrator_config* config,
                                      vg_integrator** integrator);

/* Integrates one frame: `depth` along the optical axis [m], row by row, width * height values, 0
   invalid, +infinity out of range; `amplitude` [1/m^2] of the same size, or null; `pose_sigma` [m],
   [rad], what this pose may be off beside the sensor's own pose_sigma, or null: nothing; `report`
   or null. A bad pose or sigma is VG_INVALID_ARGUMENT, and the map is unchanged. */
VG_API vg_status vg_integrate(vg_integrator* integrator, vg_grid* grid, const float* depth,
                              const float* amplitude, const double T_world_camera[16],
                              const double pose_sigma[2], vg_integration_report* report);
VG_API void vg_integrator_release(vg_integrator* integrator); /* null: nothing */

#ifdef __cplusplus
}
#endif
#endif
