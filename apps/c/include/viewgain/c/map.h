/* SPDX-FileCopyrightText: 2026 The viewgain authors
   SPDX-License-Identifier: Apache-2.0 */
#ifndef VIEWGAIN_C_MAP_H
#define VIEWGAIN_C_MAP_H

/* Part of viewgain/viewgain.h: sensors, belief grids and their changes. */

#include "viewgain/c/base.h"

#ifdef __cplusplus
extern "C" {
#endif

/* ---- Sensors ---- */

/* Noise models: standard deviations of a reading (one measured depth), along and across the ray;
   see core's noise.hpp for the equations. The comments list the parameters in vg_sensor.noise, in
   order. */
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

/* Meaning of the value 65535 in a depth image. BY_LAYOUT: the default of the folder's layout;
   CARVE: space is free up to max_range; INVALID: no reading. */
enum { VG_OUT_OF_RANGE_BY_LAYOUT = 0, VG_OUT_OF_RANGE_CARVE = 1, VG_OUT_OF_RANGE_INVALID = 2 };

/* A depth camera. Pixel (0,0) has its centre at (0,0), as in OpenCV. If the camera has a table of
   range errors, correct its frames first with vg_range_calibration. */
typedef struct vg_sensor {
  size_t struct_size;          /* set by _init() */
  int32_t width, height;       /* [px] */
  double fx, fy, cx, cy;       /* [px] */
  double distortion[5];        /* k1 k2 p1 p2 k3, in this order */
  double min_range, max_range; /* along the ray [m] */
  double working_distance;     /* intended distance [m] */
  int32_t noise_model;         /* VG_NOISE_ */
  int32_t out_of_range;        /* VG_OUT_OF_RANGE_ */
  double noise[6];      /* the model's parameters, in the order of VG_NOISE_; unused entries: 0 */
  double pose_sigma[2]; /* standard deviations of the poses of frames: translation [m], rotation
                           [rad]; 0: exact */
  double scale_sigma;   /* relative standard deviation of a scale error common to all ranges; 0:
                           none */
} vg_sensor;
/* Sets everything to 0, which is not yet a valid sensor. */
VG_API void vg_sensor_init(vg_sensor* sensor, size_t struct_size);

/* Fills a sensor after vg_sensor_init with a preset, such as "sr4000". The message for an invalid
   name lists all names. */
VG_API vg_status vg_sensor_preset(const char* name, vg_sensor* sensor);

/* *sigma: the default prior sigma [m] for a voxel size and a sensor: max(voxel / 2, 2 sigma_ax at
   the working distance). */
VG_API vg_status vg_default_prior_sigma(double voxel_size, const vg_sensor* sensor, double* sigma);

/* A camera's systematic range error, and the rays of its pixels. Immutable; may be used from many
   threads at once. */
typedef struct vg_range_calibration vg_range_calibration;

/* Makes a calibration for the sensor's camera from a table of `rows` x 2 numbers, row-major: each
   row holds a measured range, and the measured minus the true range [m]. Measured ranges increase.
   The error is interpolated linearly and constant beyond the ends. Returns VG_INVALID_ARGUMENT,
   with a message that names the value, for a table without rows, a number that is not finite,
   measured ranges that do not increase, a measured or corrected range that is not positive, or an
   invalid sensor. Costs 8 bytes and 10 ns per pixel, or 0.4 us with lens distortion. */
VG_API vg_status vg_range_calibration_create(const vg_sensor* sensor, const double* table,
                                             size_t rows, vg_range_calibration** calibration);

/* Corrects a frame in place along the rays of its pixels, bit-identical to C++: `depth` along the
   optical axis [m], row-major, width * height values of the sensor, 0 invalid, +infinity out of
   range. A reading with a corrected range that is not positive becomes 0; other pixels do not
   change. Call it once per frame: a second call would correct the frame again. Costs 10 ns per
   pixel, with or without lens distortion. */
VG_API vg_status vg_range_calibration_correct(const vg_range_calibration* calibration,
                                              float* depth);
VG_API void vg_range_calibration_release(vg_range_calibration* calibration); /* null: no effect */

/* ---- Belief grids ---- */

/* A map of a workspace. No other call may use a map while a call changes it. */
typedef struct vg_grid vg_grid;

/* Layout of a map. */
typedef struct vg_grid_config {
  size_t struct_size;            /* set by _init() */
  double voxel_size;             /* [m] */
  double box_min[3], box_max[3]; /* the workspace, grid frame; extended to whole voxels */
  double T_world_grid[16];       /* identity */
  double prior_sigma;            /* standard deviation of an unknown voxel [m] */
} vg_grid_config;
VG_API void vg_grid_config_init(vg_grid_config* config, size_t struct_size); /* sets the defaults */

/* An empty map: all voxels of the workspace are unknown. */
VG_API vg_status vg_grid_create(const vg_grid_config* config, vg_grid** grid);

/* A map from a dense array of states, with dims voxels along x, y, z. The lowest corner of voxel
   (0,0,0) is at `origin`, world frame, and the grid's axes are those of the world. */
VG_API vg_status vg_grid_from_labels(const uint8_t* labels, const int32_t dims[3],
                                     const double origin[3], double voxel_size, double prior_sigma,
                                     vg_grid** grid);

VG_API vg_status vg_grid_load(const char* path, vg_grid** grid); /* reads a .vdb file of viewgain */
/* Writes the map as .vdb, atomically. */
VG_API vg_status vg_grid_save(const vg_grid* grid, const char* path);

/* A deep copy. */
VG_API vg_status vg_grid_clone(const vg_grid* grid, vg_grid** copy);
VG_API void vg_grid_release(vg_grid* grid); /* null: no effect */

/* Properties and progress of a map. */
typedef struct vg_grid_info {
  size_t struct_size;               /* set by _init() */
  int32_t min_index[3];             /* indices x, y, z of the lowest voxel on the lattice, in which
                                       voxel i begins at i * voxel_size */
  int32_t dims[3];                  /* voxels along x, y, z */
  double voxel_size;                /* [m] */
  double prior_sigma;               /* [m] */
  double T_world_grid[16];          /* grid to world, row-major */
  uint64_t unknown, free, occupied; /* number of voxels */
  uint64_t views;                   /* number of integrated frames */
  uint64_t bytes;                   /* memory */
  double entropy_removed; /* progress: entropy removed, with criterion log_diagonal [nat] */
  /* Correction factors of the hazard, the rate at which rays meet the surface in unknown space,
     from the statistics of frames (vg_calibrate_hazard()). One per class of distance, nearest
     first. */
  double hazard_factors[8];
} vg_grid_info;
/* Prepares `info` for the call below. */
VG_API void vg_grid_info_init(vg_grid_info* info, size_t struct_size);
/* Returns the properties of the map. Costs one pass over its blocks. */
VG_API vg_status vg_grid_get_info(const vg_grid* grid, vg_grid_info* info);

/* The dense array of states; count must be dims[0] * dims[1] * dims[2]. */
VG_API vg_status vg_grid_states(const vg_grid* grid, uint8_t* states, size_t count);

/* The value of all three indices if there is no voxel. */
enum { VG_NO_VOXEL = INT32_MIN };

/* The voxels that contain the points (3 numbers each, world [m]), as 3 indices each on the lattice.
   Subtract min_index to get array indices. For a point outside the workspace or not finite, all
   three are VG_NO_VOXEL. */
VG_API vg_status vg_grid_index_of(const vg_grid* grid, const double* points, size_t count,
                                  int32_t* voxels);

/* Centres of voxels, 3 numbers each, world [m]. Voxels have 3 indices each on the lattice and may
   lie outside the workspace. */
VG_API vg_status vg_grid_center(const vg_grid* grid, const int32_t* voxels, size_t count,
                                double* centers);

/* Sets voxels of the workspace (3 indices each, on the lattice) in order. A log-odds above 0 makes
   a voxel occupied, any other makes it free. The log-odds is rounded to the nearest step of 0.05
   and clamped to -2..3.5. Beliefs are removed. Returns VG_INVALID_ARGUMENT, without changes, for a
   voxel outside the workspace or a log-odds of NaN. */
VG_API vg_status vg_grid_set(vg_grid* grid, const int32_t* voxels, const float* log_odds,
                             size_t count);

/* Resets voxels whose centres lie in a box of the grid frame [m] to unknown; bounds may be
   infinite. Views remain. *forgotten (may be null) is the number of voxels that were known. Returns
   VG_INVALID_ARGUMENT for a bound that is NaN. */
VG_API vg_status vg_grid_forget(vg_grid* grid, const double min[3], const double max[3],
                                uint64_t* forgotten);

/* Sets the voxels of a box from labels, [x][y][z] with z fastest, as in vg_grid_from_labels.
   `first` is the lowest voxel of the box, on the lattice. For planners with their own growing map.
   Voxels that already have the state do not change; the others lose their beliefs. *changed (may be
   null) is the number of changed voxels. Returns VG_INVALID_ARGUMENT, without changes, for a box
   that is not inside the workspace or an invalid label. */
VG_API vg_status vg_grid_update_box(vg_grid* grid, const int32_t first[3], const int32_t dims[3],
                                    const uint8_t* labels, uint64_t* changed);

/* Scale of the cell that contains each voxel (3 indices each, on the lattice): s, 0 to 3, for a
   cell of 2^s voxels per edge; 0 outside the workspace. */
VG_API vg_status vg_grid_scale(const vg_grid* grid, const int32_t* voxels, size_t count,
                               uint8_t* scales);

/* Sets the scale of the leaves of 8^3 voxels that a box of the grid frame [m] touches; bounds may
   be infinite. When cells merge, their hits and information add up. When a cell is split, the new
   cell that contains the mean position of the readings gets all of them; the rest of an occupied
   cell becomes unknown. *changed (may be null) is the number of changed leaves. Returns
   VG_INVALID_ARGUMENT for a bound that is NaN or a scale outside 0..3. */
VG_API vg_status vg_grid_resample(vg_grid* grid, const double min[3], const double max[3],
                                  int32_t scale, uint64_t* changed);

/* The occupied voxels, 3 indices each, on the lattice; a larger cell is given by its lowest voxel.
   Equal maps give the same order. Writes at most `capacity` of them; *found is their total number.
   log_odds may be null. */
VG_API vg_status vg_grid_occupied(const vg_grid* grid, int32_t* voxels, float* log_odds,
                                  size_t capacity, size_t* found);

/* Hash of the map, 16 hexadecimal digits and a terminating zero; equal maps have equal hashes. */
VG_API vg_status vg_grid_hash(const vg_grid* grid, char hash[17]);

/* ---- Depth frames ---- */

/* Integrates depth frames of one sensor into maps. One call at a time. */
typedef struct vg_integrator vg_integrator;

/* Which voxels a pixel crosses: those whose centres lie in its cone, or those on its centre line.
 */
enum { VG_CARVE_CONES = 0, VG_CARVE_LINES = 1 };
/* How states change: by log-odds, or literally: crossed voxels are free and hit voxels occupied. */
enum { VG_OCCUPANCY_PROBABILISTIC = 0, VG_OCCUPANCY_LITERAL = 1 };

/* Settings of the integration. */
typedef struct vg_integrator_config {
  size_t struct_size;   /* set by _init() */
  int32_t carve;        /* VG_CARVE_CONES */
  int32_t occupancy;    /* VG_OCCUPANCY_PROBABILISTIC */
  int32_t num_threads;  /* 0: all; 1: the calling thread; does not affect the map */
  int32_t coarsest;     /* largest scale of cells (see vg_grid_scale), 0 to 3, for surface seen from
                           afar */
  double support_plane; /* height of the table, world z [m]; NaN (the default): none */
  const double* fine;   /* boxes that keep scale 0: lowest and highest corners, grid frame [m]; null
                           (the default): none */
  size_t fine_count;    /* number of boxes, 6 numbers each */
  int32_t finest;       /* smallest scale outside the boxes, at most coarsest */
} vg_integrator_config;
/* Sets the defaults. */
VG_API void vg_integrator_config_init(vg_integrator_config* config, size_t struct_size);

/* Counts of one frame. */
typedef struct vg_integration_report {
  size_t struct_size;                  /* set by _init() */
  uint64_t readings;                   /* pixels with a depth in the sensor's range */
  uint64_t plane_readings;             /* pixels that see the support plane, not in readings */
  uint64_t out_of_range;               /* pixels that are free up to max_range */
  uint64_t invalid;                    /* pixels without information */
  uint64_t readings_inside;            /* readings that lie in the workspace */
  uint64_t voxels_hit, voxels_crossed; /* voxels with readings; voxels crossed but not hit */
} vg_integration_report;
/* Prepares `report` for a call. */
VG_API void vg_integration_report_init(vg_integration_report* report, size_t struct_size);

/* Creates an integrator. If config is null, the defaults apply. */
VG_API vg_status vg_integrator_create(const vg_sensor* sensor, const vg_integrator_config* config,
                                      vg_integrator** integrator);

/* Integrates one frame: `depth` along the optical axis [m], row-major, width * height values, 0
   invalid, +infinity out of range. `amplitude` [1/m^2] has the same size. `pose_sigma` [m], [rad]
   is the uncertainty of this pose, in addition to the sensor's. `amplitude`, `pose_sigma` and
   `report` may be null. For an invalid pose or sigma, returns VG_INVALID_ARGUMENT, and the map does
   not change. */
VG_API vg_status vg_integrate(vg_integrator* integrator, vg_grid* grid, const float* depth,
                              const float* amplitude, const double T_world_camera[16],
                              const double pose_sigma[2], vg_integration_report* report);
VG_API void vg_integrator_release(vg_integrator* integrator); /* null: no effect */

#ifdef __cplusplus
}
#endif
#endif
