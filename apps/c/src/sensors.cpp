// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <string>

#include "convert.hpp"
#include "viewgain/support/noise_fields.hpp"
#include "viewgain/support/text.hpp"

namespace viewgain::c_api {
namespace {

static_assert(VG_NOISE_SHOT == 0 && VG_NOISE_CONSTANT == kNoiseModels.size() - 1);

NoiseModel noise_of(const vg_sensor& sensor) {
  const auto model = enum_of<std::size_t>(sensor.noise_model, VG_NOISE_CONSTANT, "noise_model");
  NoiseModel noise = kNoiseModels[model];
  std::size_t used = 0;
  for_each_parameter(noise, [&](double& value, const auto&) { value = sensor.noise[used++]; });
  for (std::size_t i = used; i < std::size(sensor.noise); ++i) {
    if (sensor.noise[i] == 0) continue;
    refuse("noise[" + std::to_string(i) + "] is " + short_text(sensor.noise[i]) +
           "; the noise model " + std::to_string(model) + " has " + std::to_string(used) +
           " parameters and the rest must be 0");
  }
  return noise;
}

}  // namespace

Sensor sensor_of(const vg_sensor* given) {
  const vg_sensor sensor = read_struct(given, "vg_sensor");
  Sensor result;
  result.camera = {.width = sensor.width,
                   .height = sensor.height,
                   .fx = sensor.fx,
                   .fy = sensor.fy,
                   .cx = sensor.cx,
                   .cy = sensor.cy,
                   .distortion = std::to_array(sensor.distortion)};
  result.min_range = sensor.min_range;
  result.max_range = sensor.max_range;
  result.working_distance = sensor.working_distance;
  result.noise = noise_of(sensor);
  result.pose_sigma = {sensor.pose_sigma[0], sensor.pose_sigma[1]};
  result.scale_sigma = sensor.scale_sigma;
  const int meaning = enum_of<int>(sensor.out_of_range, VG_OUT_OF_RANGE_INVALID, "out_of_range");
  if (meaning != VG_OUT_OF_RANGE_BY_LAYOUT) {
    result.out_of_range =
        meaning == VG_OUT_OF_RANGE_CARVE ? Sensor::OutOfRange::carve : Sensor::OutOfRange::invalid;
  }
  return result;
}

void write_sensor(const Sensor& sensor, vg_sensor* out) {
  require_struct(out, "vg_sensor");
  const PinholeCamera& camera = sensor.camera;
  vg_sensor whole{};
  whole.width = camera.width;
  whole.height = camera.height;
  whole.fx = camera.fx;
  whole.fy = camera.fy;
  whole.cx = camera.cx;
  whole.cy = camera.cy;
  std::copy(camera.distortion.begin(), camera.distortion.end(), whole.distortion);
  whole.min_range = sensor.min_range;
  whole.max_range = sensor.max_range;
  whole.working_distance = sensor.working_distance;
  whole.noise_model = static_cast<std::int32_t>(sensor.noise.index());
  NoiseModel noise = sensor.noise;
  for_each_parameter(noise,
                     [&, i = 0U](double value, const auto&) mutable { whole.noise[i++] = value; });
  whole.pose_sigma[0] = sensor.pose_sigma.translation;
  whole.pose_sigma[1] = sensor.pose_sigma.rotation;
  whole.scale_sigma = sensor.scale_sigma;
  if (sensor.out_of_range) {
    whole.out_of_range = *sensor.out_of_range == Sensor::OutOfRange::carve
                             ? VG_OUT_OF_RANGE_CARVE
                             : VG_OUT_OF_RANGE_INVALID;
  }
  write_struct(out, whole);
}

}  // namespace viewgain::c_api

using namespace viewgain;
using namespace viewgain::c_api;

VG_DEFINE_INIT(vg_sensor)

vg_status vg_sensor_preset(const char* name, vg_sensor* sensor) {
  return guarded("name", {name}, [&] { write_sensor(sensor_preset(name), sensor); });
}

vg_status vg_default_prior_sigma(double voxel_size, const vg_sensor* sensor, double* sigma) {
  return guarded("sigma", {sigma}, [&] {
    const Sensor camera = sensor_of(sensor);
    camera.validate();
    *sigma = default_prior_sigma(voxel_size, camera);
  });
}

vg_status vg_range_calibration_create(const vg_sensor* sensor, const double* table, size_t rows,
                                      vg_range_calibration** calibration) {
  return make_handle(calibration, "calibration", {}, [&] {
    if (rows == 0) refuse("rows must be at least 1, not 0");
    require("table", {table});
    Sensor calibrated = sensor_of(sensor);
    for (std::size_t i = 0; i < rows; ++i) {
      calibrated.range_calibration.table.push_back({table[2 * i], table[2 * i + 1]});
    }
    calibrated.validate();  // checks the table more strictly than a corrector does
    return RangeCorrector(calibrated.camera, calibrated.range_calibration);
  });
}

vg_status vg_range_calibration_correct(const vg_range_calibration* calibration, float* depth) {
  return guarded("calibration depth", {calibration, depth}, [&] {
    const PinholeCamera& camera = calibration->corrector.camera();
    const auto pixels =
        static_cast<std::size_t>(camera.width) * static_cast<std::size_t>(camera.height);
    calibration->corrector.correct(std::span(depth, pixels));
  });
}

void vg_range_calibration_release(vg_range_calibration* calibration) { delete calibration; }
