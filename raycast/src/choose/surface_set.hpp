// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <cstdint>
#include <memory>
#include <unordered_map>
#include <vector>

#include "gain/view_driver.hpp"

namespace viewgain::detail {

/// Views chosen together by the surface or the combined gain, and what another adds to them
/// (raycast/README.md, "Choosing views"). after() may be called by several threads at once, for
/// different views.
class SurfaceSet {
 public:
  /// To choose from `count` poses. The driver must outlive it, and have a surface().
  SurfaceSet(const ViewDriver& driver, std::size_t count)
      : driver_(driver), surface_(*driver.surface()), looks_(count) {}

  /// Poses are scored anew only while their earlier gain could win. What a view adds of new surface
  /// is never more after another has been chosen; of refinement it hardly ever is.
  [[nodiscard]] static bool is_lazy() { return true; }
  static constexpr bool kBoundIsFirst = false;
  static constexpr double kBoundFactor = 1 + 1e-4;  // the kernel's single precision
  /// The view's gain, which its cells cannot exceed but for rounding; an eighth of after()'s time.
  [[nodiscard]] ViewGain bound(std::size_t /*i*/, const Pose& T_world_camera,
                               ViewDriver::Lease& lease) const {
    return driver_.evaluate(T_world_camera, lease);
  }
  /// The same once views are chosen, closer: no more than the kernel finds if what they show of
  /// each cell is left out. Infinite with task weights, by which a look is as quick.
  static constexpr bool kTightens = true;
  [[nodiscard]] ViewGain tighter(const Pose& T_world_camera, ViewDriver::Lease& lease) const;
  /// What view `i` adds to those chosen. What it reaches is kept while there is room, so that it is
  /// traced once.
  [[nodiscard]] ViewGain after(std::size_t i, const Pose& T_world_camera, ViewDriver::Lease& lease);
  void choose(std::size_t i, const Pose& T_world_camera, ViewDriver::Lease& lease);
  /// What the chosen show if each cell is reached by the best of them alone, in the gain's unit.
  [[nodiscard]] double by_best_alone() const;

 private:
  static constexpr std::size_t kMostKept = std::size_t{1} << 28;  // [bytes]

  struct Cell {
    double worth = 0;    // a p [m²]
    double missed = 1;   // Π (1 - R) of the chosen views
    double largest = 0;  // max R
  };

  [[nodiscard]] bool refines() const { return driver_.core()->config.model == GainModel::combined; }
  // What a view shows by itself.
  struct Reached {
    std::uint64_t key;
    double worth, share;  // a p [m²], R
  };
  struct Refined {
    Index3 voxel;
    SymmetricMatrix3 information;  // Σ T Λ_r [m⁻²]
  };
  struct Look {
    ViewGain seen;                 // status, hits, occupied voxels
    std::vector<Reached> cells;    // in the order in which it first meets them
    std::vector<Refined> refines;  // by combined
  };
  [[nodiscard]] Look look(const Pose& T_world_camera, Workspace& workspace) const;
  // The same of view `i`, as kept; traces it and keeps it if it was not.
  [[nodiscard]] std::shared_ptr<const Look> look_of(std::size_t i, const Pose& T_world_camera,
                                                    Workspace& workspace);
  /// The combined gain of these.
  [[nodiscard]] double combined(double area, double refinement) const {
    return surface_.nats_per_area() * area + driver_.core()->config.refinement_weight * refinement;
  }
  /// a p of a hazard cell, by its least voxel [m²].
  [[nodiscard]] double worth_of(Index3 least, double rate) const;
  /// The refinement of the voxel by the chosen views and `added` beyond that of the chosen.
  [[nodiscard]] double refinement(const Refined& added) const;

  const ViewDriver& driver_;
  const SurfaceView& surface_;
  std::vector<std::shared_ptr<const Look>> looks_;  // null: not kept
  std::atomic<std::size_t> kept_ = 0;               // [bytes]
  std::unordered_map<std::uint64_t, Cell> cells_;
  std::vector<float> missed_;  // of the cells, at the places of rates; those that share one: 1
  std::unordered_map<std::uint64_t, SymmetricMatrix3> known_;  // Σ T Λ_r of the chosen [m⁻²]
  double refined_ = 0;                                         // by the chosen [nat]
};

}  // namespace viewgain::detail
