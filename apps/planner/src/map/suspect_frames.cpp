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
#include "viewgain/raycast/gain_evaluator.hpp"
#include "viewgain/support/text.hpp"

namespace viewgain {
namespace {

constexpr std::size_t kPoints = 500;  // of a frame that are looked for in the others
constexpr double kGate = 0.04;        // of the range: farther off is another surface
constexpr double kParallax = 0.05;    // of the range: frames that are nearer tell nothing of poses
constexpr double kOffCentre = 0.12;   // of the image's side
constexpr double kAlike = 0.1;        // what fits less well than the best by this is named, too
constexpr std::size_t kLeastMeetings = 100;

// A way in which frames may have been meant.
struct Reading {
  const char* kind = "";
  std::string what{};  // "... if WHAT"
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

constexpr const char* kScale = "depth_scale";

// What may be meant instead: poses first, then scales.
std::vector<Reading> other_readings() {
  std::vector<Reading> all{
      {"world_to_camera", "the poses are world to camera, not camera to world", 1, false,
       inverse_of},
      {"quaternion_order", "the quaternions have w first, not last", 1, false, w_first},
      {"body_frame", "the poses are of a body frame (x forward, z up), not of the optical one", 1,
       false, optical_of_body},
      {"upward_camera", "the poses' camera looks along -z with y up, not along z with y down", 1,
       false, optical_of_upward},
      {"pose_millimetres", "the poses are in millimetres", 1, false, in_metres},
  };
  // Cameras have units of 0.1, 0.2, 0.25, 0.5 and 1 mm.
  for (const double factor : {2.0, 2.5, 4.0, 5.0, 10.0, 1000.0}) {
    const std::string times = "the depth scale is " + short_text(factor) + " times ";
    all.push_back({kScale, times + "larger", factor});
    all.push_back({kScale, times + "smaller", 1 / factor});
  }
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
    const double parallax = kParallax * std::clamp(1 / reading.depth_factor, 1.0, 10.0);
    Meetings sum;
    for (std::size_t i = 0; i < frames_.size(); ++i) {
      for (const std::size_t pixel : samples_[i]) {
        const std::optional<double> z = depth(reading, i, pixel);
        if (!z) continue;
        ++sum.points;
        const Eigen::Vector3d p_world = T_world[i] * (*z * rays_[pixel]);
        for (std::size_t j = 0; j < frames_.size(); ++j) {
          // Frames from one place agree however poses and depths are read.
          const double baseline = (T_world[j].translation() - T_world[i].translation()).norm();
          if (!(baseline > parallax * *z)) continue;
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
    const Reading along_z, along_ray{.is_along_ray = true};
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

// Do many more readings meet, or do frames contradict each other less and lie closer? Where
// fewer readings would be in range, or few would meet, that says nothing. Right frames contradict
// each other in up to 7 % of what they have in common, at edges.
bool is_better(const Meetings& other, const Meetings& as_said) {
  if (20 * other.points < 19 * as_said.points || !other.has_overlap() ||
      other.share_past() > 0.15) {
    return false;
  }
  if (4 * as_said.met < other.met) return true;
  return as_said.share_past() > 0.015 && other.share_past() < 0.6 * as_said.share_past() &&
         other.share_close() > as_said.share_close();
}

struct Fit {
  Reading reading;
  double agreement = 0;  // how much of the readings, in any unit
};

// The readings that fit best, and as well as that within `slack` of it.
std::vector<Fit> best_of(std::vector<Fit> fits, double slack) {
  std::stable_sort(fits.begin(), fits.end(),
                   [](const Fit& a, const Fit& b) { return a.agreement > b.agreement; });
  const double least = fits.empty() ? 0 : (1 - slack) * fits[0].agreement;
  std::erase_if(fits, [least](const Fit& fit) { return fit.agreement < least; });
  return fits;
}

std::vector<Fit> fits_by_meetings(const Meeting& meeting, const Meetings& as_said,
                                  const std::vector<Reading>& readings) {
  std::vector<Fit> fits;
  for (const Reading& reading : readings) {
    const Meetings other = meeting.under(reading);
    if (is_better(other, as_said)) fits.push_back({reading, static_cast<double>(other.close)});
  }
  return best_of(std::move(fits), kAlike);
}

// "A, or if B"
std::string words_of(const std::vector<Fit>& fits) {
  std::string text;
  for (const Fit& fit : fits) text += (text.empty() ? "" : ", or if ") + fit.reading.what;
  return text;
}

// Several scales may bring the depths into range: the frames tell which, if they meet.
Suspicion suspect_range(const Sensor& sensor, std::span<const DepthFrame> frames,
                        const Meeting& meeting) {
  const double now = share_in_range(sensor, frames, 1);
  if (now > 0.1) return {};
  std::vector<Fit> fits;
  for (const Reading& reading : other_readings()) {
    const double share = share_in_range(sensor, frames, reading.depth_factor);
    if (share > 0.8) fits.push_back({reading, share});
  }
  fits = best_of(std::move(fits), 0.01);
  if (fits.empty()) return {};
  const std::string text = percent(1 - now) + " of the depths are out of the sensor's range, " +
                           percent(1 - fits[0].agreement) + " if ";
  std::vector<Reading> scales;
  for (const Fit& fit : fits) scales.push_back(fit.reading);
  if (auto met = fits_by_meetings(meeting, {}, scales); !met.empty()) fits = std::move(met);
  return {kScale, text + words_of(fits)};
}

}  // namespace

Suspicion suspect_frames(const Sensor& sensor, std::span<const DepthFrame> frames,
                         std::span<const Pose> T_world_camera) {
  if (frames.size() != T_world_camera.size()) refuse("one pose a frame is needed");
  for (const DepthFrame& frame : frames) check_frame_size(frame, sensor.camera);
  if (Suspicion camera = suspect_camera(sensor.camera); !camera.kind.empty()) return camera;
  const Meeting meeting(sensor, frames, T_world_camera);
  if (Suspicion range = suspect_range(sensor, frames, meeting); !range.kind.empty()) return range;
  const Meetings as_said = meeting.under({});
  const std::vector<Fit> fits = fits_by_meetings(meeting, as_said, other_readings());
  const Meetings best = fits.empty() ? Meetings{} : meeting.under(fits[0].reading);
  const Meetings by_ray = meeting.under({.is_along_ray = true});
  const std::optional<double> along_ray = meeting.share_along_ray();
  if (along_ray && *along_ray >= 0.45 && as_said.has_overlap() && as_said.share_past() < 0.15 &&
      by_ray.close > best.close && by_ray.share_close() > best.share_close()) {
    return {"depth_along_ray", "of the readings for which it matters " + percent(*along_ray) +
                                   " fit the other frames better if depths are along the ray, not "
                                   "along z"};
  }
  if (fits.empty()) return {};
  const bool is_apart = as_said.met + as_said.seen_past < kLeastMeetings;
  const std::string now =
      is_apart ? "frames from different places have nothing in common; they"
               : percent(as_said.share_past()) +
                     " of the readings that frames have in common lie in the free space of "
                     "others; " +
                     percent(best.share_past());
  return {fits[0].reading.kind, now + " would if " + words_of(fits)};
}

Suspicion suspect_poses(const std::shared_ptr<const VoxelScene>& scene, const Sensor& sensor,
                        std::span<const Pose> T_world_camera) {
  constexpr std::size_t kPoses = 100, kRays = 400;
  std::vector<Pose> poses;
  const std::size_t step = (T_world_camera.size() + kPoses - 1) / kPoses;
  for (std::size_t i = 0; i < T_world_camera.size(); i += step) poses.push_back(T_world_camera[i]);
  const double pixels = static_cast<double>(sensor.camera.width) * sensor.camera.height;
  const auto stride = static_cast<int>(std::max(1.0, std::sqrt(pixels / kRays)));
  const GainEvaluator evaluator(scene, sensor, {.model = GainModel::paper, .pixel_stride = stride});
  const auto share_seeing = [&](const Reading& reading) {
    std::size_t seeing = 0;
    for (const Pose& pose : poses) {
      const Pose& meant = reading.pose == nullptr ? pose : reading.pose(pose);
      seeing += evaluator.evaluate(meant).hits > 0 ? 1 : 0;
    }
    return static_cast<double>(seeing) / static_cast<double>(poses.size());
  };
  if (poses.empty()) return {};
  const double now = share_seeing({});
  if (now >= 0.5) return {};
  // What is some metres off is not in millimetres.
  const bool is_far = poses[0].translation().norm() > 10 * sensor.max_range;
  const std::string text = percent(1 - now) + " of the poses see no voxel of the map";
  std::vector<Fit> fits;
  for (const Reading& reading : other_readings()) {
    if (reading.pose == nullptr || (reading.pose == in_metres && !is_far)) continue;
    if (const double share = share_seeing(reading); share > 0.8) fits.push_back({reading, share});
  }
  fits = best_of(std::move(fits), kAlike);
  if (fits.empty()) return {"no_voxel", text};
  return {fits[0].reading.kind,
          text + "; " + percent(1 - fits[0].agreement) + " would if " + words_of(fits)};
}

}  // namespace viewgain
