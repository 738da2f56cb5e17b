// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "viewgain/core/depth_frame.hpp"
#include "viewgain/core/exec_config.hpp"
#include "viewgain/core/export.hpp"
#include "viewgain/core/pose.hpp"
#include "viewgain/core/sensor.hpp"
#include "viewgain/grid/belief_grid.hpp"
#include "viewgain/grid/fused_points.hpp"

namespace viewgain {

/// A pose as it is reported, and how far it may be off: Gaussian, independent, the same in each of
/// the three axes, about the camera's centre.
struct VIEWGAIN_EXPORT PosePrior {
  Pose T_world_camera;               ///< as reported
  double sigma_translation = 0.005;  ///< [m]
  double sigma_rotation = 0.0087;    ///< of each component of the rotation vector [rad]
};

/// What a registration looks at and when it gives up.
struct VIEWGAIN_EXPORT RegistrationConfig {
  std::size_t max_readings = 20'000;  ///< about so many of a frame's readings are looked at
  double max_normal_angle = 0.9;      ///< between the surface of the reading and of the map [rad]
  double min_overlap = 0.1;           ///< a smaller share FrameRegistration::overlap is too little
  std::size_t min_pairs = 60;         ///< likewise of FrameRegistration::pairs
  /// In standard deviations of the prior, in translation or in rotation: a longer correction is
  /// refused.
  double max_sigmas = 5;
  /// A larger share FrameRegistration::contradiction is refused, unless it is of few readings.
  double max_contradiction = 0.2;
  std::optional<double> support_plane{};  ///< height z [m]: readings of it are no part of the map
};

/// What came of a registration.
enum class RegistrationStatus : std::uint8_t {
  registered,
  too_little_overlap,  ///< the map says too little of what the frame shows; the pose stays
  refused,             ///< frame and map contradict each other under every likely pose
};
/// Its name, for people and files; "unknown" for a number that is none of them: never throws.
[[nodiscard]] VIEWGAIN_EXPORT std::string_view registration_status_name(RegistrationStatus status);

/// A motion of the camera that changes nothing in how frame and map fit, one sigma of the prior
/// long: along a plane, round a sphere's centre.
struct VIEWGAIN_EXPORT FreeDirection {
  Eigen::Vector3d translation;  ///< of the camera's centre, world axes [m]
  Eigen::Vector3d rotation;     ///< about the camera's centre, world axes [rad]
};

/// What a registration did.
struct VIEWGAIN_EXPORT FrameRegistration {
  /// Whether the correction was found, and why not.
  RegistrationStatus status = RegistrationStatus::too_little_overlap;
  std::string reason;   ///< of the status, for people; empty if registered
  Pose T_world_camera;  ///< corrected if registered, else as reported
  /// The correction, of a frame that is refused the one that was found: the way of the camera's
  /// centre [m] and the angle [rad].
  double translation = 0;
  double rotation = 0;  ///< of the correction [rad]
  /// RMS distance of readings from the map's surface, along its normal [m]: of the pairs in the
  /// end, at the reported and at the corrected pose. 0 without pairs.
  double residual_before = 0;
  double residual_after = 0;  ///< after the correction [m]
  std::size_t readings = 0;   ///< that were looked at: in the workspace, with a normal
  std::size_t pairs = 0;      ///< of these, that belong to a point of the map in the end
  double overlap = 0;         ///< share pairs / readings
  /// Readings in space that the map knows to be free, or behind surface that it knows, as a share
  /// of these and the pairs.
  double contradiction = 0;
  int iterations = 0;  ///< of all levels together
  /// Of the pose given prior and frame, row by row: translation of the camera's centre [m], then
  /// rotation about it [rad], world axes. Relative to the map: how far that is off as a whole is
  /// not in it. The prior's unless registered; zero of a map's first frame, which says where it is.
  std::array<double, 36> covariance{};
  /// What the covariance leaves, for the readings of the frame: the roots of its mean variances of
  /// translation [m] and rotation [rad].
  [[nodiscard]] PoseSigma pose_sigma() const;
  /// The least information of the frame along any motion, in units of the prior's: under 1 the
  /// prior knows that motion better.
  double smallest_information = 0;
  /// In any order: along these the pose stays as reported.
  std::vector<FreeDirection> free_directions{};
};

/// Finds by how much the reported pose of a frame is off, from the surface that the map has so far.
///
/// Minimises, over the pose T, Σ_i w_i ρ(e_i) + |T ⊖ T_reported|² / σ², e_i = nᵀ(T s_i - m_j) the
/// distance of reading s_i from the fused point m_j along the surface's normal n: generalised ICP
/// where covariances along the surface are without bound, since the two are not the same place of
/// it. 1/w_i = nᵀ(k c C_t + R C_s Rᵀ)n: C_t is the point's covariance, C_s the reading's by the
/// sensor's model; the error of a point is shared by the c readings that belong to it and, since
/// each reading of the map is in about k = 3 pooled points, by those of its neighbours. ρ is
/// Cauchy's, of e² over the variance. m_j is found by projecting the fused points into the image
/// with a depth buffer, and gated by distance and angle of normals. Gauss-Newton in three levels:
/// each 4th, 2nd and every looked-at pixel of a row, with gates that begin at what the prior
/// allows.
///
/// Directions: normals that are wrong at random would hold a sphere. What counts as information is
/// therefore Σ w (J_t J_sᵀ + J_s J_tᵀ) / 2, J_t with the map's normals and J_s with the frame's
/// own, whose errors are independent. Where that is less than the prior's the direction is free.
///
/// Neighbours' errors are alike, so that residuals say less than if they were independent: by the
/// mean over the directions of the variance of the sums of J w e over cubes of 10 pooling lengths,
/// over what independent ones would give (a sandwich estimate, Huber 1967). Where that is over 1,
/// as with a real camera's systematic errors, the weights of the last level are divided by it. The
/// covariance is that of independent readings times it, and at least times 3, since errors that the
/// map's points share do not show in residuals.
///
/// Thread safety: const members may run from many threads at once. Deterministic: the same bits for
/// any number of threads. Cost: 10 to 60 ms a frame on two cores.
class VIEWGAIN_EXPORT FrameRegistrar {
 public:
  /// Undoes the lens distortion once. Throws Error(invalid_argument), naming the value, if the
  /// sensor is not valid or a setting is out of its range.
  explicit FrameRegistrar(const Sensor& sensor, const RegistrationConfig& config = {},
                          const ExecConfig& exec = {});
  ~FrameRegistrar();
  FrameRegistrar(FrameRegistrar&&) noexcept;
  FrameRegistrar& operator=(FrameRegistrar&&) noexcept;

  /// `points` are the fused_points() of `grid`, in their order. Flying pixels should be filtered
  /// from the frame. Throws Error(invalid_argument) as check_frame_size(), if the pose is not rigid
  /// (1e-3) or a sigma is not positive and finite.
  [[nodiscard]] FrameRegistration register_frame(const BeliefGrid& grid,
                                                 std::span<const FusedPoint> points,
                                                 const DepthFrame& frame,
                                                 const PosePrior& prior) const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace viewgain
