// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "viewgain/core/depth_frame.hpp"
#include "viewgain/core/export.hpp"
#include "viewgain/core/range_calibration.hpp"
#include "viewgain/core/sensor.hpp"

namespace viewgain {

/// What a frame of a wall gave to a calibration. Its readings are those used and those dropped.
struct VIEWGAIN_EXPORT WallFrameFigures {
  std::string name;                 ///< of the frame, for people
  double distance = 0;              ///< of the wall along the optical axis [m]
  double tilt = 0;                  ///< between the optical axis and the wall's normal [rad]
  std::uint64_t used = 0;           ///< readings
  std::uint64_t border = 0;         ///< dropped: within 2 % of the image's shorter side of its edge
  std::uint64_t sparse = 0;         ///< dropped: in blocks of pixels of which most have no reading
  std::uint64_t limits = 0;         ///< dropped: noise may take them over the sensor's range limits
  std::uint64_t off_wall = 0;       ///< dropped: in blocks that do not lie on the wall
  double rms_before = 0;            ///< of the systematic error [m]
  std::optional<double> rms_after;  ///< with the table of the other frames [m], if they tell
};

/// A table of the range error and how well it holds. RMS values are of medians over blocks of
/// pixels, averaged over steps of the range a frame, weighted by readings; `before` and `after` are
/// of the same steps, those within the ranges that the other frames cover.
struct VIEWGAIN_EXPORT WallCalibrationResult {
  RangeCalibration calibration;      ///< the table
  double nearest = 0, farthest = 0;  ///< true ranges between which 99 % of the blocks lie [m]
  double widest_gap = 0;             ///< between true ranges that were seen [m]
  double rms_before = 0;             ///< of the systematic error [m]
  std::optional<double> rms_after;   ///< each frame with the table of the others; if they tell [m]
  double rms_noise = 0;              ///< what the readings' noise alone would leave [m]
  std::vector<WallFrameFigures> frames;  ///< in the order given
};

/// Measures a depth camera's systematic, distance-dependent error from frames of a flat wall (after
/// the paper's ref. [7], Fuchs and Hirzinger, CVPR 2008): a smooth curve over the true range,
/// fitted robustly to the medians of blocks of pixels, as smooth as it is the likeliest. Where a
/// wall's distance is known and not its tilt, tilts are fitted with the curve. A frame tells of all
/// ranges that it shows: walls seen at a slant cover more of them. Thread safety: one call at a
/// time. Cost of adding a frame: some passes over its pixels; of solve() see there.
class VIEWGAIN_EXPORT WallCalibration {
 public:
  /// The sensor's own table does not count; its noise model says how far readings are trusted.
  /// Throws Error(invalid_argument) for a sensor that is not valid.
  explicit WallCalibration(const Sensor& sensor);
  ~WallCalibration();
  WallCalibration(WallCalibration&&) noexcept;
  WallCalibration& operator=(WallCalibration&&) noexcept;

  /// A frame, not corrected, of a wall that crosses the optical axis at the depth `distance` [m].
  /// `name` is what messages call it. Throws Error(invalid_argument) for a frame of another size, a
  /// distance that is not positive and finite, hardly any readings, readings that do not lie on a
  /// plane, and readings at quite another distance (over 0.1 m + 10 %).
  void add(const DepthFrame& frame, double distance, std::string name);

  /// The same of the wall normal · p = offset in the camera's frame [m]. The normal need not be
  /// unit.
  void add(const DepthFrame& frame, const Eigen::Vector3d& normal_camera, double offset,
           std::string name);

  /// The table from the frames so far. Throws Error(invalid_argument) for fewer than two frames, or
  /// all at one known distance, a frame that does not fit to the others, and an error that is no
  /// function of the range. Costs about a second for 50 frames.
  [[nodiscard]] WallCalibrationResult solve() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace viewgain
