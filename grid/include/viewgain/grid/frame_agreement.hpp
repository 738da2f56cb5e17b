// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "viewgain/core/depth_frame.hpp"
#include "viewgain/core/export.hpp"
#include "viewgain/core/pose.hpp"
#include "viewgain/core/sensor.hpp"
#include "viewgain/grid/belief_grid.hpp"

namespace viewgain {
class DisplacementFit;

/// How well a frame agrees with the other frames, measured on a sample of its readings (measured
/// depths).
struct VIEWGAIN_EXPORT FrameContradiction {
  std::size_t readings = 0;  ///< sampled readings of this frame in the workspace, on smooth surface
  std::size_t in_free = 0;   ///< those of `readings` in space that other frames saw as free
  std::size_t others = 0;    ///< readings of earlier frames that lie unhidden in this view
  std::size_t seen_past = 0;  ///< those of `others` in space that this frame sees as free
  /// Readings of earlier frames that project onto flat parts of this frame.
  std::size_t compared = 0;
  /// RMS distance between this frame's surface and the same surface in earlier frames, along the
  /// normals and without the part that noise explains [m]. 0 if too few readings were compared.
  double displacement = 0;
  /// The displacement that the stated uncertainties explain [m]. These are the uncertainty of a
  /// reading (at most 0.35 % of the range), the scale error, and the uncertainty of the poses of
  /// both frames.
  double expected = 0;
  /// Index of an earlier frame with the same image but another pose, if any.
  std::optional<std::size_t> same_image_as{};

  /// in_free / readings; 0 if there are no readings.
  [[nodiscard]] double share_in_free() const {
    return readings == 0 ? 0 : static_cast<double>(in_free) / static_cast<double>(readings);
  }
  /// seen_past / others; 0 if there are no such readings.
  [[nodiscard]] double share_seen_past() const {
    return others == 0 ? 0 : static_cast<double>(seen_past) / static_cast<double>(others);
  }
};

/// Compares frames while they are integrated into a map. Counts the readings in space that other
/// frames saw as free, and measures how far apart the surfaces of different frames lie. A reading
/// is in free space if its voxel and all voxels within three standard deviations along its ray are
/// free. It counts if it is in free space before its frame is integrated, or after all frames are
/// integrated.
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
  /// `support_plane` [m] is the height z of a table, as in IntegrationConfig. Throws
  /// Error(invalid_argument) if the sensor is invalid.
  explicit FrameAgreement(const Sensor& sensor, std::optional<double> support_plane = {});

  /// Call it before a frame is integrated. `before` is the map at that time. The frame must already
  /// be filtered (JumpEdgeFilter) and have its known depths (ObstacleView). `pose_sigma` is as in
  /// FrameIntegrator::integrate(). Throws Error(invalid_argument), and changes nothing, if the
  /// frame does not have the sensor's size, the pose is not rigid within 1e-3, or a sigma is
  /// negative or not finite.
  void look(const BeliefGrid& before, const DepthFrame& frame, const Pose& T_world_camera,
            const PoseSigma& pose_sigma = {});

  /// The results, one per call of look(). `after` must be the map with all these frames.
  [[nodiscard]] std::vector<FrameContradiction> frames(const BeliefGrid& after) const;

 private:
  struct Reading {
    Eigen::Vector3d p_world;
    Eigen::Vector3f ray;           ///< unit, world
    float axial = 0, lateral = 0;  ///< standard deviations along and across the ray [m]
    MeasurementSigmas of_pose{};   ///< of these, the part that all readings of a frame share
    Eigen::Vector3f normal;  ///< surface normal away from the camera, world; 0: not on a flat part
    std::uint32_t frame = 0;
    bool in_free = false;
  };
  struct Image {
    std::uint64_t hash = 0;
    std::size_t frame = 0;
    Pose T_world_camera{};
  };

  /// Standard deviations of a frame's readings, including those of pose and scale.
  [[nodiscard]] MeasurementSigmas sigmas(double range, const PoseSigma& pose_sigma) const;
  /// Readings on smooth surface in the workspace, at every stride-th pixel of rows and columns.
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
  std::shared_ptr<const std::vector<Eigen::Vector3d>> rays_;
  std::vector<FrameContradiction> frames_;
  std::vector<Reading> kept_;  ///< of all frames; fewer per frame as their number grows
  std::size_t keep_every_ = 1;
  std::vector<Image> images_;  ///< the latest different images
};

}  // namespace viewgain
