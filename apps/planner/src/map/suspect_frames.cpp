// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include "viewgain/planner/suspect_frames.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <optional>
#include <utility>
#include <vector>

#include "viewgain/core/error.hpp"
#include "viewgain/core/jump_edge_filter.hpp"

namespace viewgain {
namespace {

constexpr std::size_t kPoints = 500;  // of a frame that are looked for in the others
constexpr double kGate = 0.04;        // of the range: farther off is another surface
constexpr double kParallax = 0.05;    // of the range: frames that are nearer tell nothing of poses
constexpr double kOffCentre = 0.2;    // of the image's side
constexpr std::size_t kLeastMeetings = 100;

// A way in which frames may have been meant.
struct Reading {
  const char* kind;
  const char* what;  // "... if WHAT"
  double depth_factor = 1;
  bool is_along_ray = false;
  Pose (*pose)(const Pose&) = nullptr;
};

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

const std::vector<Reading>& readings() {
  static const std::vector<Reading> all{
      {"", ""},
      {"world_to_camera", "the poses are world to camera, not camera to world", 1, false,
       inverse_of},
      {"quaternion_order", "the quaternions have w first, not last", 1, false, w_first},
      {"body_frame", "the poses are of a body frame (x forward, z up), not of the optical one", 1,
       false, optical_of_body},
      {"upward_camera", "the poses' camera looks along -z with y up, not along z with y down", 1,
       false, optical_of_upward},
      {"pose_millimetres", "the poses are in millimetres", 1, false, in_metres},
      {"depth_scale", "the depth scale is 1000 times larger", 1000},
      {"depth_scale", "the depth scale is 10 times larger", 10},
      {"depth_scale", "the depth scale is 5 times larger", 5},
      {"depth_scale", "the depth scale is 5 times smaller", 0.2},
      {"depth_scale", "the depth scale is 10 times smaller", 0.1},
      {"depth_scale", "the depth scale is 1000 times smaller", 1e-3},
  };
  return all;
}

// What became of the readings of all frames in all others.
struct Meetings {
  std::size_t points = 0;     // in range
  std::size_t met = 0;        // in another frame, within the gate
  std::size_t close = 0;      // of these, within a quarter of it
  std::size_t seen_past = 0;  // another frame looks past them

  [[nodiscard]] double share_past() const {
    const std::size_t all = met + seen_past;
    return all == 0 ? 0 : static_cast<double>(seen_past) / static_cast<double>(all);
  }
  [[nodiscard]] double share_close() const {
    const std::size_t all = met + seen_past;
    return all == 0 ? 0 : static_cast<double>(close) / static_cast<double>(all);
  }
  // Enough have a counterpart to tell by.
  [[nodiscard]] bool has_overlap() const { return met >= kLeastMeetings && 5 * met >= 2 * points; }
};

class Meeting {
 public:
  Meeting(const Sensor& sensor, std::span<const DepthFrame> frames, std::span<const Pose> poses)
      : sensor_(sensor),
        frames_(frames.begin(), frames.end()),
        poses_(poses),
        rays_(sensor.camera.ray_table()) {
    const JumpEdgeFilter filter(sensor.camera);
    for (DepthFrame& frame : frames_) filter.apply(frame);
    const std::size_t pixels = rays_.size();
    const std::size_t step = std::max<std::size_t>(1, pixels / (3 * kPoints));
    for (const DepthFrame& frame : frames_) {
      std::vector<std::size_t>& own = samples_.emplace_back();
      for (std::size_t i = step / 2; i < pixels; i += step) {
        if (frame.depth[i] > 0 && std::isfinite(frame.depth[i]) && rays_[i].allFinite()) {
          own.push_back(i);
        }
      }
    }
  }

  [[nodiscard]] Meetings under(const Reading& reading) const {
    std::vector<Pose> T_world, T_camera;
    for (const Pose& pose : poses_) {
      T_world.push_back(reading.pose == nullptr ? pose : reading.pose(pose));
      T_camera.push_back(T_world.back().inverse());
    }
    Meetings sum;
    for (std::size_t i = 0; i < frames_.size(); ++i) {
      for (const std::size_t pixel : samples_[i]) {
        const std::optional<double> z = depth(reading, i, pixel);
        if (!z) continue;
        ++sum.points;
        const Eigen::Vector3d p_world = T_world[i] * (*z * rays_[pixel]);
        for (std::size_t j = 0; j < frames_.size(); ++j) {
          // Frames from one place agree however the poses are read.
          const double baseline = (T_world[j].translation() - T_world[i].translation()).norm();
          if (!(baseline > kParallax * *z)) continue;
          const std::optional<double> farther = beyond(reading, j, T_camera[j] * p_world);
          if (!farther || *farther < -1) continue;  // it looks elsewhere, or the point is hidden
          ++(*farther > 1 ? sum.seen_past : sum.met);
          sum.close += std::abs(*farther) < 0.25 ? 1 : 0;
        }
      }
    }
    return sum;
  }

  // Of pairs that fit either way and not equally well, where the surface is not steep, the share
  // that fits better if depths are along the ray; nothing for too few pairs.
  [[nodiscard]] std::optional<double> share_along_ray() const {
    const Reading along_z{"", ""}, along_ray{"", "", 1, true};
    std::vector<Pose> T_camera;
    for (const Pose& pose : poses_) T_camera.push_back(pose.inverse());
    std::size_t better = 0, all = 0;
    for (std::size_t i = 0; i < frames_.size(); ++i) {
      for (const std::size_t pixel : samples_[i]) {
        const std::optional<double> z = depth(along_z, i, pixel),
                                    short_z = depth(along_ray, i, pixel);
        if (!z || !short_z) continue;
        for (std::size_t j = 0; j < frames_.size(); ++j) {
          if (j == i) continue;
          const Pose T = T_camera[j] * poses_[i];
          const auto by_z = beyond(along_z, j, T * (*z * rays_[pixel]), true);
          const auto by_ray = beyond(along_ray, j, T * (*short_z * rays_[pixel]), true);
          if (!by_z || !by_ray) continue;
          const double a = std::abs(*by_z), b = std::abs(*by_ray);
          if (std::min(a, b) > 0.5 || std::abs(a - b) < 0.1) continue;
          ++all;
          better += b < a ? 1 : 0;
        }
      }
    }
    if (all < kLeastMeetings) return std::nullopt;
    return static_cast<double>(better) / static_cast<double>(all);
  }

 private:
  // Along z; nothing out of range.
  [[nodiscard]] std::optional<double> depth(const Reading& reading, std::size_t frame,
                                            std::size_t pixel) const {
    double z = static_cast<double>(frames_[frame].depth[pixel]) * reading.depth_factor;
    const double length = rays_[pixel].norm();
    if (reading.is_along_ray) z /= length;
    const double range = z * length;
    if (!(range >= sensor_.min_range && range <= sensor_.max_range)) return std::nullopt;
    return z;
  }

  // Between the four pixels round a place of the image. Where they do not make one surface: of the
  // nearest one, or nothing if it is to be flat.
  [[nodiscard]] std::optional<double> depth(const Reading& reading, std::size_t frame, double u,
                                            double v, bool is_flat) const {
    const int width = sensor_.camera.width, height = sensor_.camera.height;
    const auto at = [&](double x, double y) -> std::optional<double> {
      if (!(x >= 0 && y >= 0 && x < width && y < height)) return std::nullopt;
      const auto pixel = static_cast<std::size_t>(y) * static_cast<std::size_t>(width) +
                         static_cast<std::size_t>(x);
      if (!rays_[pixel].allFinite()) return std::nullopt;
      return depth(reading, frame, pixel);
    };
    const std::optional<double> nearest = at(std::round(u), std::round(v));
    if (!nearest) return std::nullopt;
    const double x = std::floor(u), y = std::floor(v);
    const double gate = *nearest * (is_flat ? 2 / sensor_.camera.fx : kGate);
    double z = 0;
    for (const auto& [dx, dy] : {std::pair{0, 0}, {1, 0}, {0, 1}, {1, 1}}) {
      const std::optional<double> corner = at(x + dx, y + dy);
      if (!corner || std::abs(*corner - *nearest) > gate) return is_flat ? std::nullopt : nearest;
      z += *corner * (dx == 0 ? 1 - (u - x) : u - x) * (dy == 0 ? 1 - (v - y) : v - y);
    }
    return z;
  }

  // How much farther than the point the frame sees in its direction, in gates; nothing where it
  // does not look.
  [[nodiscard]] std::optional<double> beyond(const Reading& reading, std::size_t frame,
                                             const Eigen::Vector3d& p, bool is_flat = false) const {
    if (!(p.z() > 0)) return std::nullopt;
    const PinholeCamera& camera = sensor_.camera;
    const Eigen::Vector2d at = camera.project(p);
    const std::optional<double> z = depth(reading, frame, at.x(), at.y(), is_flat);
    if (!z) return std::nullopt;
    return (*z - p.z()) / (kGate * *z + 3 * *z / camera.fx);
  }

  const Sensor& sensor_;
  std::vector<DepthFrame> frames_;
  std::span<const Pose> poses_;
  std::vector<Eigen::Vector3d> rays_;
  std::vector<std::vector<std::size_t>> samples_;  // pixels with a depth, of each frame
};

std::string percent(double share) {
  std::array<char, 16> text{};
  std::snprintf(text.data(), text.size(), "%.0f %%", 100 * share);
  return text.data();
}

Suspicion suspect_camera(const PinholeCamera& camera) {
  const std::vector<Eigen::Vector3d> rays = camera.ray_table();
  const auto lost = std::count_if(rays.begin(), rays.end(),
                                  [](const Eigen::Vector3d& ray) { return !ray.allFinite(); });
  if (const double share = static_cast<double>(lost) / static_cast<double>(rays.size());
      share > 0.5) {
    return {"distortion", percent(share) +
                              " of the image's pixels have no ray by the lens's distortion: are k1 "
                              "k2 p1 p2 k3 those of this camera?"};
  }
  const double u = camera.cx / (camera.width - 1), v = camera.cy / (camera.height - 1);
  if (std::abs(u - 0.5) < kOffCentre && std::abs(v - 0.5) < kOffCentre) return {};
  return {
      "principal_point",
      "the principal point lies at " + percent(u) + " of the image's width and " + percent(v) +
          " of its height, far from the middle: are the intrinsics those of another resolution?"};
}

// Of the pixels with a depth, those within the sensor's range if depths are so many times larger.
double share_in_range(const Sensor& sensor, std::span<const DepthFrame> frames, double factor) {
  std::size_t in_range = 0, all = 0;
  for (const DepthFrame& frame : frames) {
    for (const float z : frame.depth) {
      if (!(z > 0) || !std::isfinite(z)) continue;
      ++all;
      const double range = static_cast<double>(z) * factor;
      in_range += range >= sensor.min_range && range <= sensor.max_range ? 1 : 0;
    }
  }
  return all == 0 ? 0 : static_cast<double>(in_range) / static_cast<double>(all);
}

Suspicion suspect_range(const Sensor& sensor, std::span<const DepthFrame> frames) {
  const double now = share_in_range(sensor, frames, 1);
  if (now > 0.1) return {};
  const Reading* suspected = nullptr;
  double best = 0.8;
  for (const Reading& reading : readings()) {
    const double share = share_in_range(sensor, frames, reading.depth_factor);
    if (share > best) best = share, suspected = &reading;
  }
  if (suspected == nullptr) return {};
  return {suspected->kind, percent(1 - now) + " of the depths are out of the sensor's range, " +
                               percent(1 - best) + " if " + suspected->what};
}

// Do frames meet that did not, or contradict each other less and lie closer? Where fewer readings
// would be in range, or few would meet, that says nothing. Right frames contradict each other in up
// to 7 % of what they have in common, at edges.
bool is_better(const Meetings& other, const Meetings& as_said) {
  if (20 * other.points < 19 * as_said.points || !other.has_overlap() ||
      other.share_past() > 0.15) {
    return false;
  }
  if (10 * as_said.met < other.met) return true;
  return as_said.share_past() > 0.015 && other.share_past() < 0.6 * as_said.share_past() &&
         other.share_close() > as_said.share_close();
}

}  // namespace

Suspicion suspect_frames(const Sensor& sensor, std::span<const DepthFrame> frames,
                         std::span<const Pose> T_world_camera) {
  if (frames.size() != T_world_camera.size()) {
    throw Error(ErrorCode::invalid_argument, "one pose a frame is needed");
  }
  for (const DepthFrame& frame : frames) check_frame_size(frame, sensor.camera);
  if (Suspicion camera = suspect_camera(sensor.camera); !camera.kind.empty()) return camera;
  if (Suspicion range = suspect_range(sensor, frames); !range.kind.empty()) return range;
  const Meeting meeting(sensor, frames, T_world_camera);
  const Meetings as_said = meeting.under(readings().front());
  const Reading* suspected = nullptr;
  Meetings best;
  for (const Reading& reading : std::span(readings()).subspan(1)) {
    const Meetings other = meeting.under(reading);
    if (!is_better(other, as_said)) continue;
    if (suspected != nullptr && other.share_close() <= best.share_close()) continue;
    suspected = &reading;
    best = other;
  }
  const std::optional<double> along_ray = meeting.share_along_ray();
  if (along_ray && *along_ray >= 0.45 && as_said.has_overlap() && as_said.share_past() < 0.15 &&
      meeting.under({"", "", 1, true}).share_close() > best.share_close()) {
    return {"depth_along_ray", "of the readings for which it matters " + percent(*along_ray) +
                                   " fit the other frames better if depths are along the ray, not "
                                   "along z"};
  }
  if (suspected != nullptr) {
    const bool is_apart = as_said.met + as_said.seen_past < kLeastMeetings;
    const std::string now = is_apart
                                ? "frames from different places have nothing in common; they"
                                : percent(as_said.share_past()) +
                                      " of the readings that frames have in common lie in the free "
                                      "space of others; " +
                                      percent(best.share_past());
    return {suspected->kind, now + " would if " + suspected->what};
  }
  return {};
}

}  // namespace viewgain
