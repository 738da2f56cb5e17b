// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include "check/frame_meetings.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "viewgain/support/shared_rays.hpp"
#include "viewgain/support/text.hpp"

namespace viewgain::detail {
namespace {

// Number of points to search for in the other frames: in total, and limits per frame.
constexpr std::size_t kPoints = 2000, kLeastPoints = 160, kMostPoints = 1000;
constexpr double kGate = 0.04;      // relative to range: farther points are another surface
constexpr double kParallax = 0.05;  // relative to range: nearer frames cannot show errors of poses

Pose optical_of_body(const Pose& T) {
  Eigen::Matrix3d R;  // its columns: x right, y down, z forward in axes forward, left, up
  R << 0, 0, 1, -1, 0, 0, 0, -1, 0;
  return {T.rotation() * R, T.translation()};
}
Pose optical_of_upward(const Pose& T) {
  return {T.rotation() * Eigen::Vector3d(1, -1, -1).asDiagonal(), T.translation()};
}
Pose inverse_of(const Pose& T) { return T.inverse(); }
Pose in_metres(const Pose& T) { return {T.rotation(), 1e-3 * T.translation()}; }
Pose w_first(const Pose& T) {
  const Eigen::Quaterniond q(T.rotation());
  return {Eigen::Quaterniond(q.x(), q.y(), q.z(), q.w()).toRotationMatrix(), T.translation()};
}
// Rotation of the camera about its optical axis.
template <int quarters>
Pose rolled(const Pose& T) {
  const Eigen::AngleAxisd roll(quarters * std::numbers::pi / 2, Eigen::Vector3d::UnitZ());
  return {T.rotation() * roll.toRotationMatrix(), T.translation()};
}

// The pose `shift` frames after the one at `place`, linearly interpolated.
std::optional<Pose> pose_after(std::span<const Pose> sequence, std::size_t place, double shift) {
  if (shift == 0) return sequence[place];
  const double at = static_cast<double>(place) + shift, last = std::floor(at);
  if (!(last >= 0) || at > static_cast<double>(sequence.size() - 1)) return std::nullopt;
  const auto i = static_cast<std::size_t>(last);
  if (at == last) return rigid_pose(sequence[i]);
  const std::optional<Pose> from = rigid_pose(sequence[i]), to = rigid_pose(sequence[i + 1]);
  if (!from || !to) return std::nullopt;
  const Eigen::Quaterniond a(from->rotation()), b(to->rotation());
  return Pose(a.slerp(at - last, b).toRotationMatrix(),
              from->translation() + (at - last) * (to->translation() - from->translation()));
}

}  // namespace

std::vector<Convention> other_readings() {
  std::vector<Convention> all{
      {"world_to_camera", "the poses are world to camera, not camera to world", 1, false,
       inverse_of},
      {"quaternion_order", "the quaternions have w first, not last", 1, false, w_first},
      {"body_frame",
       "the poses are those of a body frame (x forward, z up), not of the optical frame", 1, false,
       optical_of_body},
      {"upward_camera", "the camera of the poses looks along -z with y up, not along z with y down",
       1, false, optical_of_upward},
      {"pose_millimetres", "the poses are in millimetres", 1, false, in_metres},
      {"rolled_camera", "the camera is turned by 90 degrees about its optical axis", 1, false,
       rolled<1>, 1, 1, false, false, 0, true},
      {"rolled_camera", "the camera is turned by 180 degrees about its optical axis", 1, false,
       rolled<2>, 1, 1, false, false, 0, true},
      {"rolled_camera", "the camera is turned by -90 degrees about its optical axis", 1, false,
       rolled<3>, 1, 1, false, false, 0, true},
  };
  all.push_back({.kind = "mirrored", .what = "the images are mirrored", .flips_columns = true});
  all.push_back({.kind = "upside_down",
                 .what = "the images are upside down (their first row is at the bottom)",
                 .flips_rows = true});
  for (const int shift : {-3, -2, -1, 1, 2, 3}) {
    all.push_back({.kind = "numbering",
                   .what = std::string("image N belongs to pose N") + (shift > 0 ? "+" : "") +
                           std::to_string(shift),
                   .pose_shift = static_cast<double>(shift)});
  }
  for (const double shift : {-0.75, -0.5, -0.25, 0.25, 0.5, 0.75}) {
    all.push_back({.kind = "time_offset",
                   .what = std::string("the poses are ") + (shift > 0 ? "early" : "late") +
                           " by about " + short_text(std::abs(shift)) +
                           " of the time between two frames",
                   .pose_shift = shift});
  }
  // Cameras use units of 0.1, 0.2, 0.25, 0.5 and 1 mm.
  for (const double factor : {2.0, 2.5, 4.0, 5.0, 10.0, 1000.0}) {
    const std::string times = "the correct depth scale is " + short_text(factor) + " times ";
    all.push_back({kScale, times + "larger", factor});
    all.push_back({kScale, times + "smaller", 1 / factor});
  }
  for (const double factor : {0.5, 0.67, 0.75, 0.8, 0.9, 1.1, 1.25, 1.33, 1.5, 2.0}) {
    all.push_back(
        {.kind = kFocalLength,
         .what = "the correct focal length is " + short_text(factor) + " times the given one",
         .focal_factor = factor});
  }
  return all;
}

FrameMeetings::FrameMeetings(const Sensor& sensor, const JumpEdgeFilter& filter,
                             std::span<const DepthFrame> frames, std::span<const Pose> sequence,
                             std::vector<std::size_t> places)
    : sensor_(sensor),
      frames_(frames.begin(), frames.end()),
      sequence_(sequence),
      places_(std::move(places)),
      rays_(shared_rays(sensor.camera)),
      least_squared_(sensor.min_range * sensor.min_range),
      most_squared_(sensor.max_range * sensor.max_range) {
  for (DepthFrame& frame : frames_) filter.apply(frame);
  const std::size_t points =
      std::clamp(kPoints / std::max<std::size_t>(1, frames_.size()), kLeastPoints, kMostPoints);
  for (const DepthFrame& frame : frames_) {
    std::vector<std::size_t> seen;
    for (std::size_t i = 0; i < rays_->size(); ++i) {
      if (frame.depth[i] > 0 && std::isfinite(frame.depth[i]) && (*rays_)[i].allFinite()) {
        seen.push_back(i);
      }
    }
    std::vector<std::size_t>& own = samples_.emplace_back();
    const double step = static_cast<double>(seen.size()) / static_cast<double>(points);
    if (step <= 1) {
      own = std::move(seen);
      continue;
    }
    // Uses the golden section within each step, so that points do not all lie in one column.
    for (std::size_t k = 0; k < points; ++k) {
      const double part = std::fmod(static_cast<double>(k) / std::numbers::phi, 1.0);
      own.push_back(seen[static_cast<std::size_t>((static_cast<double>(k) + part) * step)]);
    }
  }
}

std::vector<std::optional<Pose>> FrameMeetings::poses_under(const Convention& reading) const {
  std::vector<std::optional<Pose>> poses;
  for (const std::size_t place : places_) {
    std::optional<Pose> pose = pose_after(sequence_, place, reading.pose_shift);
    if (pose && reading.pose != nullptr) pose = reading.pose(*pose);
    poses.push_back(pose);
  }
  return poses;
}

Meetings FrameMeetings::under(const Convention& reading) const {
  const std::vector<std::optional<Pose>> T_world = poses_under(reading);
  std::vector<Pose> T_camera;
  for (const auto& pose : T_world) T_camera.push_back(pose ? pose->inverse() : Pose());
  const double parallax = kParallax * std::clamp(1 / reading.depth_factor, 1.0, 10.0);
  Meetings sum;
  for (std::size_t i = 0; i < frames_.size(); ++i) {
    for (const std::size_t pixel : samples_[i]) {
      const double z = depth(reading, i, pixel);
      if (!(z > 0)) continue;
      ++sum.points;
      if (!T_world[i]) continue;
      const Eigen::Vector3d p_world = *T_world[i] * (z * ray(reading, pixel));
      for (std::size_t j = 0; j < frames_.size(); ++j) {
        if (!T_world[j]) continue;
        // Frames from the same position agree under any convention.
        const double baseline = (T_world[j]->translation() - T_world[i]->translation()).norm();
        if (!(baseline > parallax * z)) continue;
        const std::optional<double> farther = beyond(reading, j, T_camera[j] * p_world);
        if (!farther || *farther < -1) continue;  // the point is out of view or hidden
        ++(*farther > 1 ? sum.seen_past : sum.met);
        sum.close += std::abs(*farther) < 0.25 ? 1 : 0;
      }
    }
  }
  return sum;
}

std::optional<double> FrameMeetings::share_better(const Convention& reading) const {
  const Convention as_said;
  std::vector<Pose> T_world, T_camera;
  for (const std::size_t place : places_) {
    T_world.push_back(sequence_[place]);
    T_camera.push_back(T_world.back().inverse());
  }
  std::size_t better = 0, all = 0;
  for (std::size_t i = 0; i < frames_.size(); ++i) {
    for (const std::size_t pixel : samples_[i]) {
      const double z = depth(as_said, i, pixel), other_z = depth(reading, i, pixel);
      if (!(z > 0 && other_z > 0)) continue;
      for (std::size_t j = 0; j < frames_.size(); ++j) {
        if (j == i) continue;
        const Pose T = T_camera[j] * T_world[i];
        const auto one = beyond(as_said, j, T * (z * (*rays_)[pixel]), true);
        const auto other = beyond(reading, j, T * (other_z * ray(reading, pixel)), true);
        if (!one || !other) continue;
        const double a = std::abs(*one), b = std::abs(*other);
        if (std::min(a, b) > 0.5 || std::abs(a - b) < 0.1) continue;
        ++all;
        better += b < a ? 1 : 0;
      }
    }
  }
  if (all < kLeastMeetings) return std::nullopt;
  return static_cast<double>(better) / static_cast<double>(all);
}

std::size_t FrameMeetings::flipped(const Convention& reading, std::size_t pixel) const {
  if (!reading.flips_columns && !reading.flips_rows) return pixel;
  const auto width = static_cast<std::size_t>(sensor_.camera.width);
  const auto height = static_cast<std::size_t>(sensor_.camera.height);
  std::size_t u = pixel % width, v = pixel / width;
  if (reading.flips_columns) u = width - 1 - u;
  if (reading.flips_rows) v = height - 1 - v;
  return v * width + u;
}

Eigen::Vector3d FrameMeetings::ray(const Convention& reading, std::size_t pixel) const {
  const Eigen::Vector3d& stated = (*rays_)[flipped(reading, pixel)];
  return {stated.x() / (reading.focal_factor * reading.focal_x_factor),
          stated.y() / reading.focal_factor, 1};
}

double FrameMeetings::depth(const Convention& reading, std::size_t frame, std::size_t pixel) const {
  double z = static_cast<double>(frames_[frame].depth[pixel]) * reading.depth_factor;
  if (!(z > 0)) return 0;
  const double squared_length = ray(reading, pixel).squaredNorm();
  if (reading.is_along_ray) z /= std::sqrt(squared_length);
  const double squared = z * z * squared_length;
  return squared >= least_squared_ && squared <= most_squared_ ? z : 0;
}

double FrameMeetings::depth(const Convention& reading, std::size_t frame, double u, double v,
                            bool is_flat) const {
  const int width = sensor_.camera.width, height = sensor_.camera.height;
  const auto at = [&](int x, int y) -> double {
    if (x < 0 || y < 0 || x >= width || y >= height) return 0;
    const std::size_t pixel =
        static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(x);
    return depth(reading, frame, flipped(reading, pixel));
  };
  if (!(u > -1 && v > -1 && u < width && v < height)) return 0;
  const int x = static_cast<int>(u + 1) - 1, y = static_cast<int>(v + 1) - 1;  // rounded down
  const double right = u - x, below = v - y;
  const double nearest = at(right < 0.5 ? x : x + 1, below < 0.5 ? y : y + 1);
  if (!(nearest > 0)) return 0;
  const double gate = nearest * (is_flat ? 2 / sensor_.camera.fx : kGate);
  double z = 0;
  for (int corner = 0; corner < 4; ++corner) {
    const int dx = corner % 2, dy = corner / 2;
    const double of_corner = at(x + dx, y + dy);
    if (!(of_corner > 0 && std::abs(of_corner - nearest) <= gate)) return is_flat ? 0 : nearest;
    z += of_corner * (dx == 0 ? 1 - right : right) * (dy == 0 ? 1 - below : below);
  }
  return z;
}

std::optional<double> FrameMeetings::beyond(const Convention& reading, std::size_t frame,
                                            const Eigen::Vector3d& p, bool is_flat) const {
  if (!(p.z() > 0)) return std::nullopt;
  const PinholeCamera& camera = sensor_.camera;
  const Eigen::Vector2d at = camera.project(
      {reading.focal_factor * reading.focal_x_factor * p.x(), reading.focal_factor * p.y(), p.z()});
  const double z = depth(reading, frame, at.x(), at.y(), is_flat);
  if (!(z > 0)) return std::nullopt;
  return (z - p.z()) / (kGate * z + 3 * z / camera.fx);
}

}  // namespace viewgain::detail
