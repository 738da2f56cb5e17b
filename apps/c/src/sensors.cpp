// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <string>

#include "convert.hpp"
#include "viewgain/core/noise.hpp"
#include "viewgain/support/text.hpp"

namespace viewgain::c_api {
namespace {

constexpr std::size_t kParameters = 6;
static_assert(sizeof(vg_sensor::noise) == kParameters * sizeof(double));
using Parameters = std::array<double, kParameters>;

/// A noise model as its number and its parameters in the header's order.
struct Noise {
  std::int32_t model;
  Parameters p;
};

struct Writer {
  Noise operator()(const ShotNoise& n) const {
    return {VG_NOISE_SHOT,
            {n.reference_sigma, n.reference_range, n.reference_integration_time, n.integration_time,
             n.modulation_frequency, n.min_amplitude}};
  }
  Noise operator()(const StructuredLightNoise& n) const {
    return {VG_NOISE_STRUCTURED_LIGHT,
            {n.offset, n.quadratic, n.vertex, n.grazing, n.lateral_px, n.lateral_grazing_px}};
  }
  Noise operator()(const StereoNoise& n) const {
    return {VG_NOISE_STEREO, {n.subpixel, n.focal, n.baseline}};
  }
  Noise operator()(const QuadraticNoise& n) const {
    return {VG_NOISE_QUADRATIC, {n.offset, n.quadratic}};
  }
  Noise operator()(const ConstantNoise& n) const {
    return {VG_NOISE_CONSTANT, {n.sigma_axial, n.sigma_lateral}};
  }
};

NoiseModel noise_of(std::int32_t model, const Parameters& p) {
  const auto rest_is_zero = [&](std::size_t used) {
    for (std::size_t i = used; i < p.size(); ++i) {
      if (p[i] != 0) {
        reject("noise[" + std::to_string(i) + "] is " + short_text(p[i]) + "; the noise model " +
               std::to_string(model) + " has " + std::to_string(used) +
               " parameters and the rest must be 0");
      }
    }
  };
  switch (model) {
    case VG_NOISE_SHOT:
      return ShotNoise{p[0], p[1], p[2], p[3], p[4], p[5]};
    case VG_NOISE_STRUCTURED_LIGHT:
      return StructuredLightNoise{p[0], p[1], p[2], p[3], p[4], p[5]};
    case VG_NOISE_STEREO:
      rest_is_zero(3);
      return StereoNoise{p[0], p[1], p[2]};
    case VG_NOISE_QUADRATIC:
      rest_is_zero(2);
      return QuadraticNoise{p[0], p[1]};
    case VG_NOISE_CONSTANT:
      rest_is_zero(2);
      return ConstantNoise{p[0], p[1]};
    default:
      reject("noise_model is " + std::to_string(model) + "; the models are 0 to 4 (VG_NOISE_)");
  }
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
  result.noise = noise_of(sensor.noise_model, std::to_array(sensor.noise));
  result.pose_sigma = {sensor.pose_sigma[0], sensor.pose_sigma[1]};
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
  const Noise noise = std::visit(Writer{}, sensor.noise);
  whole.noise_model = noise.model;
  std::copy(noise.p.begin(), noise.p.end(), whole.noise);
  whole.pose_sigma[0] = sensor.pose_sigma.translation;
  whole.pose_sigma[1] = sensor.pose_sigma.rotation;
  write_struct(out, whole);
}

}  // namespace viewgain::c_api

using namespace viewgain;
using namespace viewgain::c_api;

void vg_sensor_init(vg_sensor* sensor, size_t struct_size) { initialise(sensor, struct_size); }

vg_status vg_sensor_preset(const char* name, vg_sensor* sensor) {
  return guarded([&] {
    require(name, "name");
    write_sensor(sensor_preset(name), sensor);
  });
}

vg_status vg_default_prior_sigma(double voxel_size, const vg_sensor* sensor, double* sigma) {
  return guarded([&] {
    require(sigma, "sigma");
    const Sensor camera = sensor_of(sensor);
    camera.validate();
    *sigma = default_prior_sigma(voxel_size, camera);
  });
}
