// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "viewgain/core/exec_config.hpp"
#include "viewgain/core/export.hpp"
#include "viewgain/core/pose.hpp"
#include "viewgain/core/sensor.hpp"
#include "viewgain/grid/belief_grid.hpp"
#include "viewgain/raycast/gain_evaluator.hpp"
#include "viewgain/raycast/voxel_scene.hpp"

/// @file
/// Additional gains by which policies and the program can rank views, such as those of
/// viewgain::literature. They are registered at run time and found by name.

namespace viewgain {

/// Scores poses on one map with one or more gains of a GainFamily.
class VIEWGAIN_EXPORT FamilyEvaluator {
 public:
  virtual ~FamilyEvaluator() = default;
  /// Writes gain g of pose i to results[i * gains + g], where `gains` is the number of gains; NaN
  /// for an invalid pose. Traces every s-th pixel of every s-th row, where s is pixel_stride.
  /// `statuses`, if not empty, receives one status per pose. Throws Error(invalid_argument) if the
  /// sizes do not match.
  virtual void evaluate(std::span<const Pose> T_world_camera, int pixel_stride,
                        std::span<double> results, std::span<ViewGain::Status> statuses,
                        const BatchControl& control) = 0;
  /// Rays per pose at pixel stride 1.
  [[nodiscard]] virtual std::size_t rays_per_pose() const = 0;
};

/// A set of gains that are accessed by name. Thread safety: const members may run from many threads
/// at once.
class VIEWGAIN_EXPORT GainFamily {
 public:
  virtual ~GainFamily() = default;
  /// Names of the gains, in a fixed order.
  [[nodiscard]] virtual const std::vector<std::string>& names() const = 0;
  /// Unit of the gain with this name, such as "nat" or "voxels".
  [[nodiscard]] virtual std::string_view unit(std::string_view name) const = 0;
  /// An evaluator of the gains with these names, for views of `sensor` on the current map. `scene`
  /// must be made from `grid`, and the frames of the map must be from the same sensor. Throws
  /// Error(invalid_argument) for an unknown name, and whatever the constructor of the evaluator
  /// throws.
  [[nodiscard]] virtual std::unique_ptr<FamilyEvaluator> evaluator(
      std::shared_ptr<const VoxelScene> scene, const BeliefGrid& grid, const Sensor& sensor,
      std::span<const std::string> names, const ExecConfig& exec) const = 0;
};

/// Registers a family for this process. It replaces the family that was registered before, if any.
/// Null only removes that family. Call it before other threads look up gains.
VIEWGAIN_EXPORT void register_gains(std::shared_ptr<const GainFamily> family);
/// The registered family, or a family without names if none is registered.
[[nodiscard]] VIEWGAIN_EXPORT const GainFamily& registered_gains() noexcept;
/// Whether `name` is the name of a registered gain.
[[nodiscard]] VIEWGAIN_EXPORT bool is_registered_gain(std::string_view name);

}  // namespace viewgain
