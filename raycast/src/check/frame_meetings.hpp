// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "viewgain/core/depth_frame.hpp"
#include "viewgain/core/jump_edge_filter.hpp"
#include "viewgain/core/pose.hpp"
#include "viewgain/core/sensor.hpp"

namespace viewgain::detail {

/// A convention that the data may follow.
struct Convention {
  const char* kind = "";
  std::string what{};  ///< "... if WHAT"
  double depth_factor = 1;
  bool is_along_ray = false;
  Pose (*pose)(const Pose&) = nullptr;
  double focal_factor = 1;
  double focal_x_factor = 1;  ///< additional factor for fx
  bool flips_columns = false, flips_rows = false;
  /// In frames: each frame has the pose of a later frame, possibly interpolated.
  double pose_shift = 0;
  bool is_rolled = false;

  /// Whether this is one of many similar conventions, so that one of them can fit slightly better
  /// by chance.
  [[nodiscard]] bool needs_proof() const {
    return flips_columns || flips_rows || pose_shift != 0 || is_rolled;
  }
};

inline constexpr const char* kScale = "depth_scale";
inline constexpr const char* kFocalLength = "focal_length";

/// The conventions to try: poses first, then images and numbers, scales and focal lengths.
[[nodiscard]] std::vector<Convention> other_readings();

/// With fewer, nothing is suspected.
inline constexpr std::size_t kLeastMeetings = 100;

/// How the readings of all frames fit all other frames.
struct Meetings {
  std::size_t points = 0;     ///< in range
  std::size_t met = 0;        ///< near the surface of another frame, within the gate
  std::size_t close = 0;      ///< of these, within a quarter of the gate
  std::size_t seen_past = 0;  ///< another frame sees past them

  [[nodiscard]] double share(std::size_t part) const {
    const std::size_t all = met + seen_past;
    return all == 0 ? 0 : static_cast<double>(part) / static_cast<double>(all);
  }
  [[nodiscard]] double share_past() const { return share(seen_past); }
  [[nodiscard]] double share_close() const { return share(close); }
  /// Whether enough readings have a counterpart.
  [[nodiscard]] bool has_overlap() const { return met >= kLeastMeetings && 5 * met >= 2 * points; }
};

/// Searches for readings of each frame in the other frames. Keeps references to `sensor` and
/// `sequence`.
class FrameMeetings {
 public:
  /// `sequence`: the poses of all frames of the recording; `places`: indices of `frames` in it.
  /// Frames are filtered first.
  FrameMeetings(const Sensor& sensor, const JumpEdgeFilter& filter,
                std::span<const DepthFrame> frames, std::span<const Pose> sequence,
                std::vector<std::size_t> places);
  /// The given pose of a frame.
  [[nodiscard]] const Pose& pose(std::size_t frame) const { return sequence_[places_[frame]]; }
  /// The camera's ray_table().
  [[nodiscard]] const std::vector<Eigen::Vector3d>& rays() const { return *rays_; }
  /// Cost: 5 ms for a dozen frames.
  [[nodiscard]] Meetings under(const Convention& reading) const;
  /// Considers pairs that fit both as given and under the convention, but not equally well, on
  /// surface that is not steep. Returns the fraction that fits better under the convention, which
  /// must not change poses. Empty for too few pairs.
  [[nodiscard]] std::optional<double> share_better(const Convention& reading) const;

 private:
  /// Pose of each frame; empty if the sequence has none.
  [[nodiscard]] std::vector<std::optional<Pose>> poses_under(const Convention& reading) const;
  /// Maps a stored pixel to the pixel of its ray, and back.
  [[nodiscard]] std::size_t flipped(const Convention& reading, std::size_t pixel) const;
  /// Ray of a pixel under the convention. Distortion is scaled too, as for another resolution.
  [[nodiscard]] Eigen::Vector3d ray(const Convention& reading, std::size_t pixel) const;
  /// Depth along z; 0 if there is none or it is out of range.
  [[nodiscard]] double depth(const Convention& reading, std::size_t frame, std::size_t pixel) const;
  /// Interpolates between four pixels. If these do not show one surface, returns the depth of the
  /// nearest pixel, or 0 if a flat surface is required.
  [[nodiscard]] double depth(const Convention& reading, std::size_t frame, double u, double v,
                             bool is_flat) const;
  /// How much farther than the point the frame sees in its direction, in gates; empty if the point
  /// is out of view.
  [[nodiscard]] std::optional<double> beyond(const Convention& reading, std::size_t frame,
                                             const Eigen::Vector3d& p, bool is_flat = false) const;

  const Sensor& sensor_;
  std::vector<DepthFrame> frames_;
  std::span<const Pose> sequence_;
  std::vector<std::size_t> places_;  ///< indices of the frames in the sequence
  std::shared_ptr<const std::vector<Eigen::Vector3d>> rays_;
  double least_squared_, most_squared_;            ///< ranges [m²]
  std::vector<std::vector<std::size_t>> samples_;  ///< pixels with a depth, of each frame
};

}  // namespace viewgain::detail
