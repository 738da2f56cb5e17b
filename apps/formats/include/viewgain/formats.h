/* SPDX-FileCopyrightText: 2026 The viewgain authors
   SPDX-License-Identifier: Apache-2.0 */
#ifndef VIEWGAIN_FORMATS_H
#define VIEWGAIN_FORMATS_H

/* Files of sensors and poses, for C. Its functions are in the library viewgain_formats (pkg-config
   viewgain-formats); viewgain/viewgain.h says what holds for all functions. */

#include "viewgain/viewgain.h"

#ifdef __cplusplus
extern "C" {
#endif

/* Fills a sensor that vg_sensor_init has seen: from a .toml file, or a preset by its name. The
   file's name, T_flange_camera and body, which vg_sensor has not, are left out. VG_FORMAT names the
   file and the key. */
VG_API vg_status vg_sensor_load(const char* preset_or_file, vg_sensor* sensor);

/* Writes a .toml file, whole or not at all. vg_sensor_load takes names that end in .toml. */
VG_API vg_status vg_sensor_save(const vg_sensor* sensor, const char* path);

/* Reads poses in the TUM format: at most `capacity` of them, 16 numbers each, and says in *found
   how many the file has. T_world_camera and timestamps [s] may be null: not wanted. */
VG_API vg_status vg_poses_load(const char* path, double* T_world_camera, double* timestamps,
                               size_t capacity, size_t* found);

/* Writes poses in the TUM format, whole or not at all; at least one. timestamps [s] null: 0, 1,
   2, ... */
VG_API vg_status vg_poses_save(const char* path, const double* T_world_camera,
                               const double* timestamps, size_t count);

#ifdef __cplusplus
}
#endif
#endif
