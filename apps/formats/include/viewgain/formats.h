/* SPDX-FileCopyrightText: 2026 The viewgain authors
   SPDX-License-Identifier: Apache-2.0 */
#ifndef VIEWGAIN_FORMATS_H
#define VIEWGAIN_FORMATS_H

/* Files of sensors and poses, and OctoMap's, for C. Its functions are in the library
   viewgain_formats (pkg-config viewgain-formats); viewgain/viewgain.h says what holds for all
   functions. */

#include "viewgain/viewgain.h"

#ifdef __cplusplus
extern "C" {
#endif

/* Fills a sensor that vg_sensor_init has seen: from a .toml file, or a preset by its name. The
   file's name, T_flange_camera, body and range_calibration, which vg_sensor has not, are left out:
   frames of a calibrated camera need vg_range_calibration_load() as well. VG_FORMAT names the file
   and the key. */
VG_API vg_status vg_sensor_load(const char* preset_or_file, vg_sensor* sensor);

/* Writes a .toml file, whole or not at all; the name must end so. What
   vg_sensor has not is not written, a range_calibration neither: saved in the place of a calibrated
   file the table is lost. */
VG_API vg_status vg_sensor_save(const vg_sensor* sensor, const char* path);

/* Makes a calibration of ranges from what vg_sensor_load() takes: by the file's table
   range_calibration, for the file's camera, whose size frames must have. Without a table, as
   presets are, it changes no frame. Fails as vg_sensor_load() does; costs what
   vg_range_calibration_create() does. */
VG_API vg_status vg_range_calibration_load(const char* preset_or_file,
                                           vg_range_calibration** calibration);

/* Reads poses, of a name in .npy numpy's array, else TUM text: at most `capacity` of them, 16
   numbers each, and says in *found how many the file has. T_world_camera and timestamps [s] may be
   null: not wanted. */
VG_API vg_status vg_poses_load(const char* path, double* T_world_camera, double* timestamps,
                               size_t capacity, size_t* found);

/* Writes poses, whole or not at all; at least one: TUM text for .txt and .tum, numpy's array for
   .npy; other endings are VG_INVALID_ARGUMENT. timestamps [s], one a pose, or
   null: 0, 1, 2, ... */
VG_API vg_status vg_poses_save(const char* path, const double* T_world_camera,
                               const double* timestamps, size_t count);

/* OctoMap's .ot and .bt: the states, and a .ot's log-odds; the workspace is the box of the known
   voxels. prior_sigma [m], NaN: half a voxel. Saving writes a .ot, in the world's frame where
   T_world_grid is a shift by whole voxels, else in the grid's own. */
VG_API vg_status vg_grid_load_octomap(const char* path, double prior_sigma, vg_grid** grid);
/* Writes states and log-odds as OctoMap's .ot; the name must end so. */
VG_API vg_status vg_grid_save_octomap(const vg_grid* grid, const char* path);

#ifdef __cplusplus
}
#endif
#endif
