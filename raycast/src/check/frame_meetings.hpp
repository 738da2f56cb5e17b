// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "viewgain/core/depth_frame.hpp"
#include "viewgain/core/pose.hpp"
#include "viewgain/core/sensor.hpp"

namespace viewgain::detail {

/// A way in which frames may have been meant.
struct Convention {
  const char* kind = "";
  std::string what{};  ///< "... if WHAT"
  double depth_factor = 1;
  bool is_along_ray = false;
  Pose (*pose)(const Pose&) = nullptr;
  double focal_factor = 1;
  double focal_x_factor = 1;  ///< of fx alone, beside that
  bool flips_columns = false, flips_rows = false;
  double pose_shift = 0;  ///< in frames: each has the pose of a later one, or one between two
  bool is_rolled = false;

  /// One of many that are alike, so that one of them may fit a little better by chance.
  [[nodiscard]] bool needs_proof() const {
    return flips_columns || flips_rows || pose_shift != 0 || is_rolled;
  }
};

inline constexpr const char* kScale = "depth_scale";
inline constexpr const char* kFocalLength = "focal_length";

/// What may be meant instead: poses first, then images and numbers, scales and focal lengths.
[[nodiscard]] std::vector<Convention> other_readings();

/// Of fewer nothing is said.
inline constexpr std::size_t kLeastMeetings = 100;

/// What became of the readings of all frames in all others.
struct Meetings {
  std::size_t points = 0;     ///< in range
  std::size_t met = 0;        ///< in another frame, within the gate
  std::size_t close = 0;      ///< of these, within a quarter of it
  std::size_t seen_past = 0;  ///< another frame looks past them

  [[nodiscard]] double share(std::size_t part) const {
    const std::size_t all = met + seen_past;
    return all == 0 ? 0 : static_cast<double>(part) / static_cast<double>(all);
  }
  [[nodiscard]] double share_past() const { return share(seen_past); }
  [[nodiscard]] double share_close() const { return share(close); }
  /// Enough have a counterpart to tell by.
  [[nodiscard]] bool has_overlap() const { return met >= kLeastMeetings && 5 * met >= 2 * points; }
};

/// Looks for readings of each frame in the others; keeps `sensor` and `sequence` by reference.
class FrameMeetings {
 public:
  /// `sequence`: the poses of all frames of the recording, `places`: those of `frames` in it.
  FrameMeetings(const Sensor& sensor, std::span<const DepthFrame> frames,
                std::span<const Pose> sequence, std::vector<std::size_t> places);
  /// As it is said.
  [[nodiscard]] const Pose& pose(std::size_t frame) const { return sequence_[places_[frame]]; }
  /// The camera's ray_table().
  [[nodiscard]] const std::vector<Eigen::Vector3d>& rays() const { return rays_; }
  /// Cost: 5 ms for a dozen frames.
  [[nodiscard]] Meetings under(const Convention& reading) const;
  /// Of pairs that fit either way and not equally well, where the surface is not steep, the share
  /// that fits better under the reading, which leaves poses as they are; nothing for too few pairs.
  [[nodiscard]] std::optional<double> share_better(const Convention& reading) const;

 private:
  /// Where each frame was; nothing where the sequence has no such pose.
  [[nodiscard]] std::vector<std::optional<Pose>> poses_under(const Convention& reading) const;
  /// The pixel of the ray that a stored pixel belongs to, and the other way round.
  [[nodiscard]] std::size_t flipped(const Convention& reading, std::size_t pixel) const;
  /// Distortion goes with it, as for the intrinsics of another resolution.
  [[nodiscard]] Eigen::Vector3d ray(const Convention& reading, std::size_t pixel) const;
  /// Along z; 0 where there is none or it is out of range.
  [[nodiscard]] double depth(const Convention& reading, std::size_t frame, std::size_t pixel) const;
  /// Between the four pixels round a place of the image. Where they do not make one surface: of the
  /// nearest one, or 0 if it is to be flat.
  [[nodiscard]] double depth(const Convention& reading, std::size_t frame, double u, double v,
                             bool is_flat) const;
  /// How much farther than the point the frame sees in its direction, in gates; nothing where it
  /// does not look.
  [[nodiscard]] std::optional<double> beyond(const Convention& reading, std::size_t frame,
                                             const Eigen::Vector3d& p, bool is_flat = false) const;

  const Sensor& sensor_;
  std::vector<DepthFrame> frames_;
  std::span<const Pose> sequence_;
  std::vector<std::size_t> places_;  ///< of the frames in it
  std::vector<Eigen::Vector3d> rays_;
  double least_squared_, most_squared_;            ///< ranges [m²]
  std::vector<std::vector<std::size_t>> samples_;  ///< pixels with a depth, of each frame
};

}  // namespace viewgain::detail
