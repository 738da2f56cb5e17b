// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include "convert.hpp"
#include "viewgain/formats.h"
#include "viewgain/formats/sensor_toml.hpp"

using namespace viewgain;
using namespace viewgain::c_api;

vg_status vg_sensor_load(const char* preset_or_file, vg_sensor* sensor) {
  return guarded("preset_or_file", {preset_or_file}, [&] {
    require_struct(sensor, "vg_sensor");
    write_sensor(load_sensor(preset_or_file), sensor);
  });
}

vg_status vg_sensor_save(const vg_sensor* sensor, const char* path) {
  return guarded("path", {path}, [&] { write_sensor_toml(path, sensor_of(sensor)); });
}

vg_status vg_range_calibration_load(const char* preset_or_file,
                                    vg_range_calibration** calibration) {
  return make_handle(calibration, "calibration preset_or_file", {preset_or_file}, [&] {
    const Sensor sensor = load_sensor(preset_or_file);
    return RangeCorrector(sensor.camera, sensor.range_calibration);
  });
}
