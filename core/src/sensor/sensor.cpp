// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include "viewgain/core/sensor.hpp"

#include <algorithm>

#include "viewgain/core/error.hpp"
#include "viewgain/support/noise_fields.hpp"
#include "viewgain/support/text.hpp"

namespace viewgain {
namespace {

Sensor make_sensor(std::string_view name, const PinholeCamera& camera, double min_range,
                   double max_range, double working_distance, const NoiseModel& noise) {
  Sensor sensor;
  sensor.name = name;
  sensor.camera = camera;
  sensor.min_range = min_range;
  sensor.max_range = max_range;
  sensor.working_distance = working_distance;
  sensor.noise = noise;
  return sensor;
}

Sensor with_body(Sensor sensor, const std::array<double, 3>& size) {
  sensor.body_size = size;
  return sensor;
}

PinholeCamera make_camera(int width, int height, double fx, double fy, double cx, double cy) {
  return {
      .width = width, .height = height, .fx = fx, .fy = fy, .cx = cx, .cy = cy, .distortion = {}};
}

/// Except for the laser, presets use the default parameters of their noise models.
const std::vector<Sensor>& presets() {
  static const std::vector<Sensor> sensors{
      Sensor{},  // sr4000
      with_body(make_sensor("azure_kinect_nfov", make_camera(640, 576, 417.0, 452.1, 319.5, 287.5),
                            0.5, 3.86, 1.0, QuadraticNoise{}),
                {0.103, 0.039, 0.126}),
      with_body(make_sensor("kinect_v1", make_camera(640, 480, 585.0, 585.0, 319.5, 239.5), 0.5,
                            4.5, 1.0, StructuredLightNoise{}),
                {0.28, 0.066, 0.066}),
      with_body(make_sensor("d435", make_camera(640, 480, 447.0, 447.0, 319.5, 239.5), 0.2, 3.0,
                            0.5, StereoNoise{}),
                {0.090, 0.025, 0.025}),
      // A line scanner of one row, for comparison with precise sensors.
      make_sensor("laser_line", make_camera(640, 1, 800.0, 800.0, 319.5, 0.0), 0.1, 1.0, 0.4,
                  ConstantNoise{.sigma_axial = 0.2e-3, .sigma_lateral = 0.2e-3}),
  };
  return sensors;
}

// Within the sensor's range limits, for frontal incidence [m].
double range_of_least_sigma(const Sensor& sensor) {
  const auto* structured = std::get_if<StructuredLightNoise>(&sensor.noise);
  if (structured == nullptr) return sensor.min_range;  // other models grow with the range
  return std::clamp(structured->vertex, sensor.min_range, sensor.max_range);
}

}  // namespace

void Sensor::validate() const {
  const auto fail = [](const std::string& what) { refuse("sensor: " + what); };
  camera.validate();
  if (!(std::isfinite(min_range) && min_range >= 0)) {
    fail("min_range must be at least 0 and finite, not " + short_text(min_range));
  }
  if (!(std::isfinite(max_range) && max_range > min_range)) {
    fail("max_range is " + short_text(max_range) +
         " m; it must be finite and larger than min_range, " + short_text(min_range) +
         " m (lengths are in metres)");
  }
  if (!(working_distance > 0 && working_distance >= min_range && working_distance <= max_range)) {
    fail("working_distance is " + short_text(working_distance) +
         " m; it must be positive and between min_range and max_range, " + short_text(min_range) +
         " to " + short_text(max_range) + " m (lengths are in metres)");
  }
  NoiseModel parameters = noise;
  for_each_parameter(parameters, [&](double value, const auto& field) {
    if (std::isfinite(value) && (field.may_be_0 ? value >= 0 : value > 0)) return;
    refuse(std::string("noise: ") + field.name + " must be " +
           (field.may_be_0 ? "at least 0" : "positive") + " and finite, not " + short_text(value));
  });
  const double least = range_of_least_sigma(*this);
  if (!(noise_sigmas(least).axial > 0)) {
    refuse("noise: the standard deviation along the ray is 0 at a range of " + short_text(least) +
           " m; set offset, linear or quadratic to a positive number");
  }
  if (T_flange_camera && !rigid_pose(*T_flange_camera)) {
    fail("T_flange_camera is not a rigid transform");
  }
  if (body_size) {
    for (const double length : *body_size) {
      if (!(std::isfinite(length) && length > 0)) {
        fail("body_size must be positive and finite, not " + std::to_string(length));
      }
    }
  }
  for (const double sigma : {pose_sigma.translation, pose_sigma.rotation}) {
    if (!(std::isfinite(sigma) && sigma >= 0)) {
      fail("pose_sigma must be at least 0 and finite, not " + short_text(sigma));
    }
  }
  if (!(std::isfinite(scale_sigma) && scale_sigma >= 0)) {
    fail("scale_sigma must be at least 0 and finite, not " + short_text(scale_sigma));
  }
  range_calibration.validate();
  for (const auto& [measured, error] : range_calibration.table) {
    if (measured > 0 && measured > error) continue;
    fail("range_calibration: a measured range of " + short_text(measured) +
         " m minus an error of " + short_text(error) + " m is not a valid range");
  }
}

const std::vector<std::string>& sensor_preset_names() {
  static const std::vector<std::string> names = [] {
    std::vector<std::string> list;
    for (const Sensor& sensor : presets()) list.push_back(sensor.name);
    return list;
  }();
  return names;
}

Sensor sensor_preset(std::string_view name) {
  return presets()[place_of_name(name, sensor_preset_names(), "sensor")];
}

double default_prior_sigma(double voxel_size, const Sensor& sensor) {
  if (!(voxel_size > 0 && std::isfinite(voxel_size))) {
    refuse("voxel_size is " + short_text(voxel_size) + " m; it must be positive and finite");
  }
  return std::max(voxel_size / 2.0, 2.0 * sensor.sigmas(sensor.working_distance).axial);
}

}  // namespace viewgain
