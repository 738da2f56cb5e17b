// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>

#include "block_kernels.hpp"
#include "readings.hpp"
#include "viewgain/core/thread_pool.hpp"
#include "viewgain/grid/integrate.hpp"

namespace viewgain::detail {

/// The pose, orthonormalised if it is off by less than 1e-3. Throws Error(invalid_argument).
[[nodiscard]] Pose rigid(const Pose& pose);

/// Throws Error(invalid_argument) unless the support plane, if there is one, is finite.
void check_plane(std::optional<double> height);

/// Puts readings from one origin into a grid, region by region (grid/README.md).
class MapUpdate {
 public:
  MapUpdate(Occupancy occupancy, const ExecConfig& exec);
  ~MapUpdate();
  MapUpdate(MapUpdate&&) noexcept;
  MapUpdate& operator=(MapUpdate&&) noexcept;

  [[nodiscard]] ThreadPool& pool();

  /// Updates states, log-odds and beliefs and appends `view` to the grid's views. With a camera the
  /// readings are its pixels and carve cones, else lines.
  IntegrationReport run(BeliefGrid& grid, const Readings& readings, const Pose& T_grid_readings,
                        const Pose& view, const ConeCamera* camera);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace viewgain::detail
