// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <string>
#include <vector>

#include "viewgain/core/depth_frame.hpp"
#include "viewgain/core/export.hpp"
#include "viewgain/core/pose.hpp"
#include "viewgain/core/sensor.hpp"

namespace viewgain {

/// Readings at about one range.
struct VIEWGAIN_EXPORT RangeStep {
  double range = 0;     ///< measured, mean [m]
  double error = 0;     ///< mean of measured minus true range [m]
  double residual = 0;  ///< mean error that remains with the table [m]
  std::size_t pixels = 0;
};

/// A sensor with the measured table of its range error.
struct VIEWGAIN_EXPORT RangeFitResult {
  Sensor sensor;                        ///< with the table `range_calibration`
  double rms_before = 0;                ///< of the frames' mean errors, without the table [m]
  double rms_after = 0;                 ///< with it [m]
  double offset_sigma = 0;              ///< of an offset of all ranges, from pixel noise alone [m]
  std::size_t distances = 0;            ///< different distances; those within 2 % count as one
  std::vector<RangeStep> steps{};       ///< by range
  std::vector<std::string> left_out{};  ///< frames left out, with the reason
};

/// Measures the systematic error of a depth camera as a function of range (Fuchs and Hirzinger,
/// CVPR 2008), from frames of a flat wall at known poses. The wall's position is fitted too. Thread
/// safety: one call at a time. Cost: add() O(pixels); solve() ten passes over some thousand
/// readings per frame.
class VIEWGAIN_EXPORT RangeFit {
 public:
  static constexpr std::size_t kLeastDistances = 8;

  /// Throws Error(invalid_argument) for an invalid sensor.
  explicit RangeFit(const Sensor& sensor);

  /// `name` is for messages. A frame that shows no wall, or has more than 5 % saturated pixels, is
  /// left out and named in the result. Throws Error(invalid_argument) for a frame of another size.
  void add(const DepthFrame& frame, const Pose& T_world_camera, const std::string& name);

  /// Throws Error(invalid_argument) for fewer than kLeastDistances distances, a wall that is not
  /// flat, frames of different walls, and views too frontal to distinguish an offset of the camera
  /// from one of the wall.
  [[nodiscard]] RangeFitResult solve() const;

 private:
  struct Reading {
    Eigen::Vector3d ray_world;  // unit
    double range;               // measured [m]
  };
  struct Frame {
    std::string name;
    Eigen::Vector3d center;  // camera centre, world [m]
    double distance;         // mean range [m]
    std::vector<Reading> readings;
    Eigen::Vector3d normal_world;  // of this frame's plane, towards the wall
    double plane_offset;           // normal · p of it [m]
  };
  struct Wall;

  Sensor sensor_;
  std::vector<Eigen::Vector3d> rays_;
  std::vector<Frame> frames_;
  std::vector<std::string> left_out_;
};

}  // namespace viewgain
