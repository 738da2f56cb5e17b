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

/// A set of chosen views with the surface or the combined gain, and the marginal gain of another
/// view (raycast/README.md, "Choosing views"). Several threads may call after() at once, for
/// different views.
class SurfaceSet {
 public:
  /// For a choice among `count` poses. The driver must outlive this object, and have a surface().
  SurfaceSet(const ViewDriver& driver, std::size_t count)
      : driver_(driver), surface_(*driver.surface()), looks_(count) {}

  /// Poses are scored again only while their earlier gain could win. The marginal new surface of a
  /// view never grows when another view is chosen; its refinement grows only rarely.
  [[nodiscard]] static bool is_lazy() { return true; }
  static constexpr bool kBoundIsFirst = false;
  static constexpr double kBoundFactor = 1 + 1e-4;  // for the kernel's single precision
  /// The view's own gain, which its marginal gain cannot exceed except by rounding. Takes an eighth
  /// of the time of after().
  [[nodiscard]] ViewGain bound(std::size_t /*i*/, const Pose& T_world_camera,
                               ViewDriver::Lease& lease) const {
    return driver_.evaluate(T_world_camera, lease);
  }
  /// A tighter bound after views are chosen: the kernel's gain without the surface that they show.
  /// Infinite with task weights, for which after() is as fast.
  static constexpr bool kTightens = true;
  [[nodiscard]] ViewGain tighter(const Pose& T_world_camera, ViewDriver::Lease& lease) const;
  /// Marginal gain of view `i`. What the view reaches is kept while memory allows, so that it is
  /// traced once.
  [[nodiscard]] ViewGain after(std::size_t i, const Pose& T_world_camera, ViewDriver::Lease& lease);
  void choose(std::size_t i, const Pose& T_world_camera, ViewDriver::Lease& lease);
  /// Gain of the chosen views if each cell counts only for its best view, in the gain's unit.
  [[nodiscard]] double by_best_alone() const;

 private:
  static constexpr std::size_t kMostKept = std::size_t{1} << 28;  // [bytes]

  struct Cell {
    double worth = 0;    // a p [m²]
    double missed = 1;   // Π (1 - R) of the chosen views
    double largest = 0;  // max R
  };

  [[nodiscard]] bool refines() const { return driver_.core()->config.model == GainModel::combined; }
  // What one view shows.
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
    std::vector<Reached> cells;    // in the order in which rays first reach them
    std::vector<Refined> refines;  // for the combined gain
  };
  [[nodiscard]] Look look(const Pose& T_world_camera, Workspace& workspace) const;
  // The look of view `i`; traces and keeps it if it is not kept yet.
  [[nodiscard]] std::shared_ptr<const Look> look_of(std::size_t i, const Pose& T_world_camera,
                                                    Workspace& workspace);
  /// The combined gain of this area and refinement.
  [[nodiscard]] double combined(double area, double refinement) const {
    return surface_.nats_per_area() * area + driver_.core()->config.refinement_weight * refinement;
  }
  /// a p of the hazard cell with this lowest voxel [m²].
  [[nodiscard]] double worth_of(Index3 least, double rate) const;
  /// Additional refinement of the voxel by `added` after the chosen views.
  [[nodiscard]] double refinement(const Refined& added) const;

  const ViewDriver& driver_;
  const SurfaceView& surface_;
  std::vector<std::shared_ptr<const Look>> looks_;  // null: not kept
  std::atomic<std::size_t> kept_ = 0;               // [bytes]
  std::unordered_map<std::uint64_t, Cell> cells_;
  std::vector<float> missed_;  // per cell, by BrickTable::place_of(); else 1
  std::unordered_map<std::uint64_t, SymmetricMatrix3> known_;  // Σ T Λ_r of the chosen views [m⁻²]
  double refined_ = 0;  // refinement by the chosen views [nat]
};

}  // namespace viewgain::detail
