// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>

#include "block_kernels.hpp"
#include "readings.hpp"
#include "viewgain/grid/integrate.hpp"
#include "viewgain/support/thread_pool.hpp"

namespace viewgain::detail {

/// Puts readings from one origin into a grid: readings -> evidence by cones or lines -> hits ->
/// apply (grid/README.md).
class MapUpdate {
 public:
  /// Throws as FrameIntegrator's constructor for scales that it refuses.
  MapUpdate(const IntegrationConfig& config, const ExecConfig& exec);
  ~MapUpdate();
  MapUpdate(MapUpdate&&) noexcept;
  MapUpdate& operator=(MapUpdate&&) noexcept;

  [[nodiscard]] ThreadPool& pool();

  /// Updates states, log-odds and beliefs and appends the view to the grid's. With a camera the
  /// readings are its pixels and carve cones, else lines.
  IntegrationReport run(BeliefGrid& grid, const PlacedFrame& frame, const ConeCamera* camera);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace viewgain::detail
