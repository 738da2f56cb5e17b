// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <memory>
#include <optional>

#include "block_kernels.hpp"
#include "readings.hpp"
#include "viewgain/core/error.hpp"
#include "viewgain/core/sensor.hpp"
#include "viewgain/grid/integrate.hpp"
#include "viewgain/support/text.hpp"
#include "viewgain/support/thread_pool.hpp"

namespace viewgain::detail {

/// Integrates readings from one origin into a grid: readings -> evidence by cones or lines -> hits
/// -> apply (grid/README.md).
class MapUpdate {
 public:
  /// Throws like FrameIntegrator's constructor for invalid scales.
  MapUpdate(const IntegrationConfig& config, const ExecConfig& exec);
  ~MapUpdate();
  MapUpdate(MapUpdate&&) noexcept;
  MapUpdate& operator=(MapUpdate&&) noexcept;

  [[nodiscard]] ThreadPool& pool();

  /// Updates states, log-odds and beliefs and appends the view to the grid's. With a camera the
  /// readings are its pixels and use cones, otherwise lines.
  IntegrationReport run(BeliefGrid& grid, const PlacedFrame& frame, const ConeCamera* camera);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

/// Throws Error(invalid_argument) unless the support plane, if any, is finite.
inline void check_plane(std::optional<double> height) {
  if (height && !std::isfinite(*height)) {
    refuse("the height of the support plane must be finite, not " + short_text(*height) + " m");
  }
}

/// Throws Error(invalid_argument) unless both sigmas are finite and not negative.
inline void check_pose_sigma(const PoseSigma& pose_sigma) {
  for (const double sigma : {pose_sigma.translation, pose_sigma.rotation}) {
    if (std::isfinite(sigma) && sigma >= 0) continue;
    refuse("pose_sigma must be at least 0 and finite, not " + short_text(sigma));
  }
}

}  // namespace viewgain::detail
