// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "viewgain/core/depth_frame.hpp"
#include "viewgain/core/export.hpp"
#include "viewgain/core/pose.hpp"
#include "viewgain/core/sensor.hpp"
#include "viewgain/grid/belief_grid.hpp"

namespace viewgain {
class DisplacementFit;

/// Agreement of a frame with the others, counted on a sample of its readings (measured depths).
struct VIEWGAIN_EXPORT FrameContradiction {
  std::size_t readings = 0;   ///< readings of this frame in the workspace, on a smooth surface
  std::size_t in_free = 0;    ///< number of these in space that other frames saw as free
  std::size_t others = 0;     ///< readings of earlier frames that this frame sees, or sees past
  std::size_t seen_past = 0;  ///< number of these in space that this frame shows as free
  /// Readings of earlier frames that project onto flat parts of this one.
  std::size_t compared = 0;
  /// Distance between this frame's surface and the same surface in earlier frames [m]. It is the
  /// RMS along the normals, without the part that noise explains. 0 if too few readings were
  /// compared.
  double displacement = 0;
  /// Displacement that the declared errors explain [m]. These are the errors of a reading (at most
  /// 0.35 % of the range), of the scale, and of the poses of both frames.
  double expected = 0;
  /// An earlier frame with the same image from another pose, if any.
  std::optional<std::size_t> same_image_as{};

  /// in_free / readings; 0 without readings.
  [[nodiscard]] double share_in_free() const {
    return readings == 0 ? 0 : static_cast<double>(in_free) / static_cast<double>(readings);
  }
  /// seen_past / others; 0 without others.
  [[nodiscard]] double share_seen_past() const {
    return others == 0 ? 0 : static_cast<double>(seen_past) / static_cast<double>(others);
  }
};

/// Compares frames while they go into a map. Counts the readings in space that other frames saw as
/// free, and measures how far apart the surfaces of different frames lie. A reading is in free
/// space if its voxel and all voxels within three standard deviations along its ray are free. This
/// is checked twice, before the reading's frame is integrated and after all frames. The reading
/// counts if it is in free space at one of these times.
///
/// Thread safety: one call at a time. Deterministic. Cost: 0.3 ms per frame; at most 4 MB.
/// @code
/// FrameAgreement agreement(sensor);
/// for (const auto& [frame, T_world_camera] : frames) {
///   agreement.look(grid, frame, T_world_camera);
///   integrator.integrate(grid, frame, T_world_camera);
/// }
/// const auto contradictions = agreement.frames(grid);  // one per frame
/// @endcode
class VIEWGAIN_EXPORT FrameAgreement {
 public:
  /// `support_plane`: as in IntegrationConfig. Throws Error(invalid_argument) if the sensor is
  /// invalid.
  explicit FrameAgreement(const Sensor& sensor, std::optional<double> support_plane = {});

  /// Takes a frame that is about to be integrated into the map `before`. Flying pixels must be
  /// removed and known depths marked. `pose_sigma`: as in FrameIntegrator::integrate(). Throws
  /// Error(invalid_argument), and changes nothing, for a frame of another size, a pose that is not
  /// rigid, and a sigma that is negative or not finite.
  void look(const BeliefGrid& before, const DepthFrame& frame, const Pose& T_world_camera,
            const PoseSigma& pose_sigma = {});

  /// Results, one per call of look(). `after` must be the map with all frames.
  [[nodiscard]] std::vector<FrameContradiction> frames(const BeliefGrid& after) const;

 private:
  struct Reading {
    Eigen::Vector3d p_world;
    Eigen::Vector3f ray;           ///< unit, world
    float axial = 0, lateral = 0;  ///< standard deviations along and across the ray [m]
    MeasurementSigmas of_pose{};   ///< of these, the part common to all readings of a frame
    Eigen::Vector3f normal;        ///< surface normal away from the camera, world; 0: not flat
    std::uint32_t frame = 0;
    bool in_free = false;
  };
  struct Image {
    std::uint64_t hash = 0;
    std::size_t frame = 0;
    Pose T_world_camera{};
  };

  /// Standard deviations of a frame's readings, including its pose and the scale.
  [[nodiscard]] MeasurementSigmas sigmas(double range, const PoseSigma& pose_sigma) const;
  /// Readings of smooth surface in the workspace, at every stride-th pixel of rows and columns.
  [[nodiscard]] std::vector<Reading> sampled(const BeliefGrid& map, const DepthFrame& frame,
                                             const Pose& T_world_camera,
                                             const PoseSigma& pose_sigma, std::size_t stride) const;
  [[nodiscard]] static bool lies_in_free(const BeliefGrid& grid, const Reading& reading);
  [[nodiscard]] Eigen::Vector3f seen_normal(const DepthFrame& frame, std::size_t u, std::size_t v,
                                            double range,
                                            const Eigen::Matrix3d& R_world_camera) const;
  void look_at_others(const DepthFrame& frame, const Pose& T_world_camera,
                      const PoseSigma& pose_sigma, FrameContradiction& found) const;
  void compare(const DepthFrame& frame, std::size_t u, std::size_t v, const Reading& earlier,
               const Pose& T_camera_world, const PoseSigma& pose_sigma, DisplacementFit& fit) const;
  /// Pose uncertainty of the sensor combined with the given one.
  [[nodiscard]] PoseSigma both(const PoseSigma& pose_sigma) const;
  void look_for_copy(const DepthFrame& frame, const Pose& T_world_camera,
                     FrameContradiction& found);
  [[nodiscard]] bool is_smooth(const DepthFrame& frame, std::size_t u, std::size_t v) const;
  void keep(std::vector<Reading> readings);

  Sensor sensor_;
  std::optional<double> support_plane_;
  std::vector<Eigen::Vector3d> rays_;
  std::vector<FrameContradiction> frames_;
  std::vector<Reading> kept_;  ///< of all frames; thinned out as their number grows
  std::size_t keep_every_ = 1;
  std::vector<Image> images_;  ///< the latest ones that differ
};

}  // namespace viewgain
