// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>

#include "viewgain/core/box.hpp"
#include "viewgain/core/exec_config.hpp"
#include "viewgain/core/export.hpp"
#include "viewgain/core/reach.hpp"
#include "viewgain/mesh/mesh_io.hpp"
#include "viewgain/raycast/surface_scene.hpp"

namespace viewgain {

/// The object and how it stands.
struct VIEWGAIN_EXPORT StageConfig {
  std::filesystem::path mesh;             ///< its file
  std::optional<double> size{};           ///< longest side to scale it to [m]; not given: its own
  UpAxis up = UpAxis::z;                  ///< the file's axis that points up
  std::optional<Box> workspace{};         ///< world [m]; default: see Stage
  std::optional<double> support_plane{};  ///< the object stands on it; world z [m]
};

/// The object to be modelled and the space around it, world frame.
struct VIEWGAIN_EXPORT Stage {
  std::shared_ptr<const SurfaceScene> scene;         ///< the object, placed
  Eigen::Vector3d center = Eigen::Vector3d::Zero();  ///< of the object's bounding box [m]
  double size = 0;                                   ///< longest side of that box [m]
  /// A cube of edge size · 0.4 / 0.35 around the object, or the one given; cut at the support
  /// plane, since what is under it is known.
  Box workspace{};
};

/// Reads and centres the mesh, scales it if a size is given; with a support plane it is put on it.
/// Throws Error for a mesh that cannot be read or has no extent, a size that is not positive, a
/// workspace under the plane.
[[nodiscard]] VIEWGAIN_EXPORT Stage set_stage(const StageConfig& config, const ExecConfig& exec);

/// A pose (T_world_camera) that looks at the object's centre from `distance` [m] and 27° above, at
/// an azimuth that depends on the seed; where that is out of reach or not above the support_plane
/// (world z [m]), the possible pose that is nearest to it among 2,562 on the sphere and the
/// region's list. Throws Error(invalid_argument) if there is none.
[[nodiscard]] VIEWGAIN_EXPORT Pose default_start(const Stage& stage, double distance,
                                                 std::uint64_t seed, const ReachRegion& reach,
                                                 const std::optional<double>& support_plane);

}  // namespace viewgain
