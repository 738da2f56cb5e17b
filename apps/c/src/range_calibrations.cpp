// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include <cstddef>
#include <span>

#include "convert.hpp"
#include "handles.hpp"

using namespace viewgain;
using namespace viewgain::c_api;

vg_status vg_range_calibration_create(const vg_sensor* sensor, const double* table, size_t rows,
                                      vg_range_calibration** calibration) {
  return make_handle(calibration, "calibration", [&] {
    if (rows == 0) reject("rows is 0: a table of ranges has at least one");
    require(table, "table");
    Sensor calibrated = sensor_of(sensor);
    for (std::size_t i = 0; i < rows; ++i) {
      calibrated.range_calibration.table.push_back({table[2 * i], table[2 * i + 1]});
    }
    calibrated.validate();  // of the table it asks more than a corrector does, as files do
    return RangeCorrector(calibrated.camera, calibrated.range_calibration);
  });
}

vg_status vg_range_calibration_correct(const vg_range_calibration* calibration, float* depth) {
  return guarded([&] {
    require(calibration, "calibration");
    require(depth, "depth");
    const PinholeCamera& camera = calibration->corrector.camera();
    const auto pixels =
        static_cast<std::size_t>(camera.width) * static_cast<std::size_t>(camera.height);
    calibration->corrector.correct(std::span(depth, pixels));
  });
}

void vg_range_calibration_release(vg_range_calibration* calibration) { delete calibration; }
