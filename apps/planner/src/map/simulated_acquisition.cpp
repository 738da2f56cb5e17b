// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include "viewgain/planner/simulated_acquisition.hpp"

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <cmath>
#include <numbers>
#include <string>

#include "viewgain/core/error.hpp"
#include "viewgain/support/hash64.hpp"
#include "viewgain/support/text.hpp"

namespace viewgain {
namespace {

// Separates these random numbers from those of the readings' noise with the same seed.
constexpr std::uint64_t kStream = 0x706F7365;

void check_noise(const PoseSigma& sigma) {
  for (const auto& [name, value] : {std::pair("sigma_translation", sigma.translation),
                                    std::pair("sigma_rotation", sigma.rotation)}) {
    if (!(value >= 0) || !std::isfinite(value)) {
      refuse("pose noise: " + std::string(name) + " must be at least 0 and finite, not " +
             short_text(value));
    }
  }
}

}  // namespace

Measurements SimulatedAcquisition::acquire(const Pose& T_world_camera, std::size_t view) {
  if (frames_per_view_ == 0) refuse("the number of frames per view must be at least 1, not 0");
  Measurements measurements{T_world_camera, {}};
  for (std::size_t i = 0; i < frames_per_view_; ++i) {
    measurements.frames.push_back(camera_.acquire(T_world_camera, view * frames_per_view_ + i));
    if (stop_.stop_requested()) break;
  }
  last_frame_ = measurements.frames.front();
  return measurements;
}

Pose reported_pose(const Pose& T_world_camera, std::size_t view, const PoseSigma& sigma,
                   std::uint64_t seed) {
  check_noise(sigma);
  if (view == 0) return T_world_camera;
  const std::uint64_t of_view = mix64(mix64(seed ^ mix64(kStream)) ^ view);
  std::uint64_t drawn = 0;
  // Box-Muller transform.
  const auto normal = [&] {
    const double u = 1 - unit_number(mix64(of_view ^ mix64(++drawn)));  // in (0, 1]
    const double turn = 2 * std::numbers::pi * unit_number(mix64(of_view ^ mix64(++drawn)));
    return std::sqrt(-2 * std::log(u)) * std::cos(turn);
  };
  Eigen::Vector3d shift, turn;
  for (int k = 0; k < 3; ++k) shift[k] = sigma.translation * normal();
  for (int k = 0; k < 3; ++k) turn[k] = sigma.rotation * normal();
  Eigen::Matrix3d R = T_world_camera.rotation();
  if (turn.norm() > 0) R = Eigen::AngleAxisd(turn.norm(), turn.normalized()).toRotationMatrix() * R;
  return {R, T_world_camera.translation() + shift};
}

Measurements MisreportedAcquisition::acquire(const Pose& T_world_camera, std::size_t view) {
  Measurements measurements = camera_.acquire(T_world_camera, view);
  measurements.T_world_camera = reported_pose(T_world_camera, view, sigma_, seed_);
  return measurements;
}

}  // namespace viewgain
