/* SPDX-FileCopyrightText: 2026 The viewgain authors
   SPDX-License-Identifier: Apache-2.0 */
#ifndef VIEWGAIN_FORMATS_H
#define VIEWGAIN_FORMATS_H

/* Files of sensors, for C. Its functions are in the library
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

#ifdef __cplusplus
}
#endif
#endif
