// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>
#include <variant>

#include "check/figure.hpp"
#include "viewgain/raycast/suspect_set_up.hpp"

namespace viewgain {
namespace {

using detail::figure;

// Bounds that no real sensor exceeds, but wrong units do.
constexpr double kWidestView = 6;         // width / focal length: 143 degrees
constexpr double kLongestRange = 300;     // [m]
constexpr double kNoiseOfDistance = 0.1;  // standard deviation relative to the working distance
constexpr double kNoiseOfVoxel = 10;      // relative to the voxel size
// Standard deviation of the position relative to the working distance.
constexpr double kPoseOfDistance = 0.2;
constexpr double kPoseRotation = 0.05;  // [rad]: 2.9 degrees
constexpr double kLongestBody = 2;      // [m]

// "3 % of the working distance of 0.4 m", or in voxels if the voxel size is what makes it odd.
std::string compared(double length, double distance, double share,
                     const std::optional<double>& voxel_size) {
  if (length <= share * distance && voxel_size) {
    return figure(length / *voxel_size) + " times the voxel size of " + figure(*voxel_size) + " m";
  }
  return figure(100 * length / distance) + " % of the working distance of " + figure(distance) +
         " m";
}

bool is_much(double length, double distance, double share,
             const std::optional<double>& voxel_size) {
  return length > share * distance || (voxel_size && length > kNoiseOfVoxel * *voxel_size);
}

Suspicion suspect_view(const PinholeCamera& camera) {
  const auto odd = [](const char* name, double focal, const char* side, int size) -> Suspicion {
    if (size <= kWidestView * focal) return {};
    const double angle = 360 / std::numbers::pi * std::atan(0.5 * size / focal);
    return {"field_of_view", std::string(name) + " = " + figure(focal) + " px for an image " +
                                 std::to_string(size) + " px " + side +
                                 " gives a field of view of " + figure(angle) +
                                 " degrees. Focal lengths must be in pixels, not in millimetres"};
  };
  Suspicion suspicion = odd("fx", camera.fx, "wide", camera.width);
  return suspicion.kind.empty() ? odd("fy", camera.fy, "high", camera.height) : suspicion;
}

Suspicion suspect_ranges(const Sensor& sensor, const std::optional<double>& voxel_size) {
  const double footprint = sensor.working_distance / sensor.camera.fx;
  const bool is_coarse =
      voxel_size && sensor.working_distance > 5 && footprint > 0.5 * kNoiseOfVoxel * *voxel_size;
  if (sensor.max_range <= kLongestRange && !is_coarse) return {};
  std::string what = "the sensor measures from " + figure(sensor.min_range) + " to " +
                     figure(sensor.max_range) + " m and has a working distance of " +
                     figure(sensor.working_distance) + " m";
  if (is_coarse) {
    what += ", where a pixel is " + figure(footprint / *voxel_size) + " voxels wide";
  }
  return {
      "range_unit",
      what + ". min_range, max_range and working_distance must be in metres, not in millimetres"};
}

Suspicion suspect_times(const ShotNoise& noise) {
  constexpr double kLong = 0.1;  // [s]
  for (const auto& [name, seconds] :
       {std::pair("integration_time", noise.integration_time),
        std::pair("reference_integration_time", noise.reference_integration_time)}) {
    if (seconds < kLong) continue;
    return {"time_unit", "noise: " + std::string(name) + " = " + figure(seconds) +
                             " s. Integration times must be in seconds, not in milliseconds"};
  }
  return {};
}

Suspicion suspect_frequency(const ShotNoise& noise) {
  constexpr double kLow = 1e5;  // [Hz]: unambiguous to 1.5 km
  if (noise.modulation_frequency <= 0 || noise.modulation_frequency >= kLow) return {};
  return {"frequency_unit", "noise: modulation_frequency = " + figure(noise.modulation_frequency) +
                                " Hz. Frequencies must be in hertz, not in megahertz"};
}

// Parameters that make readings seem more precise than they are, which no sigma shows.
struct OddParameter {
  const Sensor& sensor;

  static Suspicion length(const std::string& name, double value) {
    return {"noise_unit", "noise: " + name + " = " + figure(value) +
                              " m. Lengths must be in metres, not in millimetres"};
  }
  Suspicion operator()(const ShotNoise& noise) const {
    if (Suspicion time = suspect_times(noise); !time.kind.empty()) return time;
    if (noise.reference_range <= 10 * sensor.max_range) return {};
    return length("reference_range", noise.reference_range);
  }
  Suspicion operator()(const StereoNoise& noise) const {
    if (noise.focal > 0 && noise.focal * kWidestView < sensor.camera.width) {
      return {"noise_unit", "noise: focal = " + figure(noise.focal) +
                                " px. Focal lengths must be in pixels, not in millimetres"};
    }
    if (noise.baseline <= std::max(2.0, sensor.working_distance)) return {};
    return length("baseline", noise.baseline);
  }
  Suspicion operator()(const StructuredLightNoise& noise) const {
    return noise.vertex > sensor.max_range ? length("vertex", noise.vertex) : Suspicion();
  }
  template <typename Other>
  Suspicion operator()(const Other&) const {
    return {};
  }
};

// Names of the parameters that determine a sigma.
struct ParameterNames {
  bool is_axial;

  std::string operator()(const ShotNoise&) const { return is_axial ? "reference_sigma" : ""; }
  std::string operator()(const StructuredLightNoise&) const {
    return is_axial ? "offset [m], quadratic [1/m], grazing [m^1.5]"
                    : "lateral_px, lateral_grazing_px";
  }
  std::string operator()(const StereoNoise&) const {
    return is_axial ? "subpixel [px], focal [px], baseline [m]" : "";
  }
  std::string operator()(const QuadraticNoise&) const {
    return is_axial ? "offset [m], linear, quadratic [1/m]" : "";
  }
  std::string operator()(const ConstantNoise&) const {
    return is_axial ? "sigma_axial" : "sigma_lateral";
  }
};

Suspicion suspect_noise(const Sensor& sensor, const std::optional<double>& voxel_size) {
  Suspicion parameter = std::visit(OddParameter{sensor}, sensor.noise);
  if (!parameter.kind.empty()) return parameter;
  constexpr double kSlanted = 0.34;  // cosine of 70 degrees
  const double at = sensor.working_distance;
  const MeasurementSigmas frontal = sensor.noise_sigmas(at),
                          slanted = sensor.noise_sigmas(at, kSlanted);
  const auto odd = [&](double sigma, const char* where, bool is_axial) -> Suspicion {
    const std::string names = std::visit(ParameterNames{is_axial}, sensor.noise);
    if (names.empty() || !is_much(sigma, at, kNoiseOfDistance, voxel_size)) return {};
    return {"noise_unit", "the standard deviation of depths " + std::string(where) + " is " +
                              figure(sigma) + " m, " +
                              compared(sigma, at, kNoiseOfDistance, voxel_size) +
                              ". Noise parameters (" + names +
                              ") must be for lengths in metres, not in millimetres"};
  };
  Suspicion suspicion = odd(frontal.axial, "along the ray", true);
  if (suspicion.kind.empty()) suspicion = odd(frontal.lateral, "across the ray", false);
  // All sigmas grow with the angle of incidence, at most threefold.
  if (suspicion.kind.empty() && slanted.axial > 2 * kNoiseOfDistance * at) {
    suspicion = odd(slanted.axial, "along the ray at 70 degrees", true);
  }
  return suspicion;
}

Suspicion suspect_scale_sigma(const Sensor& sensor) {
  if (sensor.scale_sigma < 0.1) return {};
  return {"scale_sigma",
          "scale_sigma = " + figure(sensor.scale_sigma) + " means that ranges are " +
              figure(100 * sensor.scale_sigma) +
              " % wrong. scale_sigma must be a fraction, not a percentage or a length"};
}

Suspicion suspect_calibration(const Sensor& sensor) {
  const auto& table = sensor.range_calibration.table;
  for (const auto& [measured, error] : table) {
    if (table.front()[0] <= sensor.max_range && std::abs(error) <= 0.5 * measured) continue;
    return {"calibration_unit", "range_calibration has an error of " + figure(error) +
                                    " m at a measured range of " + figure(measured) +
                                    " m. Both must be in metres, not in millimetres"};
  }
  return {};
}

Suspicion suspect_body(const Sensor& sensor) {
  if (!sensor.body_size) return {};
  const auto& size = *sensor.body_size;
  if (*std::max_element(size.begin(), size.end()) <= kLongestBody) return {};
  return {"body_unit", "the sensor's body is " + figure(size[0]) + " x " + figure(size[1]) + " x " +
                           figure(size[2]) + " m. This size must be in metres, not in millimetres"};
}

Suspicion suspect_mounting(const Sensor& sensor) {
  if (!sensor.T_flange_camera) return {};
  const double distance = sensor.T_flange_camera->translation().norm();
  if (distance <= kLongestBody) return {};
  return {"mounting_unit",
          "T_flange_camera puts the camera " + figure(distance) +
              " m from the flange. Translations must be in metres, not in millimetres"};
}

}  // namespace

Suspicion suspect_pose_sigma(const PoseSigma& sigma, double working_distance,
                             std::optional<double> voxel_size) {
  const double turned = sigma.rotation * working_distance;
  if (is_much(sigma.translation, working_distance, kPoseOfDistance, voxel_size)) {
    return {"pose_sigma_unit",
            "the declared standard deviation of poses is " + figure(sigma.translation) + " m, " +
                compared(sigma.translation, working_distance, kPoseOfDistance, voxel_size) +
                ". Translations must be in metres, not in millimetres"};
  }
  if (sigma.rotation >= kPoseRotation || (voxel_size && turned > kNoiseOfVoxel * *voxel_size)) {
    return {"pose_sigma_unit", "the declared standard deviation of rotations is " +
                                   figure(sigma.rotation) + " rad, " +
                                   figure(sigma.rotation * 180 / std::numbers::pi) +
                                   " degrees. pose_sigma_rad must be in metres and radians, "
                                   "--register in metres and degrees"};
  }
  return {};
}

std::vector<Suspicion> suspect_sensor(const Sensor& sensor, std::optional<double> voxel_size) {
  std::vector<Suspicion> all;
  const auto add = [&all](Suspicion suspicion) {
    if (!suspicion.kind.empty()) all.push_back(std::move(suspicion));
    return !all.empty();
  };
  // These two mistakes would also make the noise look odd.
  if (!add(suspect_view(sensor.camera)) && !add(suspect_ranges(sensor, voxel_size))) {
    add(suspect_noise(sensor, voxel_size));
  }
  if (const auto* const shot = std::get_if<ShotNoise>(&sensor.noise)) add(suspect_frequency(*shot));
  add(suspect_pose_sigma(sensor.pose_sigma, sensor.working_distance, voxel_size));
  add(suspect_scale_sigma(sensor));
  add(suspect_calibration(sensor));
  add(suspect_body(sensor));
  add(suspect_mounting(sensor));
  return all;
}

bool explains_frames(const Suspicion& suspicion) {
  return suspicion.kind == "field_of_view" || suspicion.kind == "range_unit";
}

}  // namespace viewgain
