// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <memory>
#include <optional>
#include <vector>

#include "viewgain/core/export.hpp"
#include "viewgain/grid/belief_grid.hpp"
#include "viewgain/grid/fused_points.hpp"
#include "viewgain/grid/grid_snapshot.hpp"
#include "viewgain/grid/hazard_counters.hpp"
#include "viewgain/grid/voxel.hpp"

namespace viewgain {
namespace detail {
class FreeShare;
class NearestCells;
class OpenDirections;
}  // namespace detail

/// How likely rays meet the surface in unknown voxels. A rate of 0 means that there is no surface:
/// no ray ends there. In front of a wall seen from behind, the surface is then expected in the
/// voxels with positive rates, or nowhere if all are 0. Rates down to 1e-30 /m count; single
/// precision takes smaller ones for 0.
struct VIEWGAIN_EXPORT HazardConfig {
  /// The hazard of unknown space: the rate at which a ray through it meets the surface, by where
  /// it lies to what is known (apps/docs/guide/surface_gain.md):
  /// h(d, s, o) = far_rate + near_rate c(s) g(o) exp(-d / decay_length), and far_rate beyond 5
  /// decay lengths; d is the distance to known surface, s the sine of the elevation over its
  /// tangent plane at the nearest point, 1 towards free space, and o the share of the 26 directions
  /// to the cells around along which free space comes within 2.2 decay lengths and before anything
  /// occupied. Members check nothing; validate() does.
  struct Model {
    double near_rate = 231;       ///< h_0 [1/m]
    double decay_length = 0.016;  ///< lambda [m]
    double far_rate = 0.029;      ///< h_inf [1/m]

    static constexpr double kCut = 5.0;        ///< [decay lengths]
    static constexpr double kOpenReach = 2.2;  ///< of the directions of o [decay lengths]

    /// Start values for an object whose longest side is `size` [m]: fitted to seven objects of 0.35
    /// m (perf/hazard/fit.py) and taken to go with the size.
    [[nodiscard]] static Model for_size(double size) {
      return {81.0 / size, 0.0457 * size, 0.01 / size};
    }
    /// The same `rate` [1/m] everywhere; `size` [m] as above says how fine the cells are.
    [[nodiscard]] static Model constant(double rate, double size) {
      return {0.0, 0.0457 * size, rate};
    }

    /// c(s): surfaces go on as they are, bending away from free space rather than into it. Linear
    /// between values at each fifth of s, fitted with the rest; 1 at -0.4, less elsewhere.
    [[nodiscard]] static VIEWGAIN_EXPORT double continuation(double sine_of_elevation);

    /// g(o): surface lies between free space and what is hidden. What sees free space nearly all
    /// around is a rest that no ray happened to pass, what sees none is inside. Linear between
    /// values at each thirteenth of o, fitted with the rest.
    [[nodiscard]] static VIEWGAIN_EXPORT double openness(double share_of_directions);

    /// Hazard [1/m] at this distance from known surface [m], where `shape` is c g.
    [[nodiscard]] double rate(double distance, double shape = 1.0) const {
      return distance <= kCut * decay_length
                 ? far_rate + near_rate * shape * std::exp(-distance / decay_length)
                 : far_rate;
    }
    bool operator==(const Model&) const = default;
  };
  /// Rates from elsewhere, say from a prior of the object's shape, instead of the model's.
  struct Volume {
    VoxelBox box;              ///< voxels of the grid's lattice
    std::vector<float> rates;  ///< [1/m], [x][y][z] with z fastest: box.volume() of them
    float outside = 0;         ///< [1/m]
  };

  /// Longest side of the object [m]; unless given that of the box of voxels with evidence, or while
  /// there are none that of the workspace.
  std::optional<double> object_size{};
  std::optional<Model> model{};  ///< unless given Model::for_size
  /// Rates by place, instead of the model; null: none.
  std::shared_ptr<const Volume> volume{};
  /// Multiplies the start values by what frames have said (GridSnapshot::hazard). A model that is
  /// given, or a volume, stays what it is. Counters go by classes of distance in decay lengths: a
  /// size that is given should be the same for all scenes of a map.
  bool calibrated = true;

  /// Throws Error(invalid_argument), naming the value, for a size or decay length that is not
  /// positive and finite, a rate that is negative or not finite, or a volume whose count of rates
  /// is not that of its box.
  void validate() const;
};

/// The same rate [1/m] everywhere in the workspace of a map; `object_size` [m] says how fine the
/// cells are, its longest side unless given. Throws Error(invalid_argument) for an object size that
/// is not positive and finite; the rate is checked by HazardConfig::validate(). Takes constant
/// time.
[[nodiscard]] VIEWGAIN_EXPORT HazardConfig constant_hazard(double rate, const BeliefGrid& grid,
                                                           std::optional<double> object_size = {});

/// The hazard in a map as it stands. Immutable; all members may be called from many threads.
///
/// Rates are constant in hazard cells: cubes of 1, 2, 4 or 8 voxels an edge on the lattice of the
/// leaves, about 0.28 decay lengths wide. Distances are between centres of such cells,
/// to the nearest one with an occupied voxel of at least 3 hits, cut at 5 decay lengths or 127
/// cells; voxels that are finer than the sensor's footprint count in the cubes of pooling_of(). The
/// surface's normal at such a cell leads to where more of the 7³ cells around are free. The
/// model's start values are multiplied class by class by HazardCounters::factor(), pooled where
/// rates would rise with the distance. The rates of a volume are by voxel. Members take any voxel
/// and never throw; calls cost constant time.
class VIEWGAIN_EXPORT HazardField {
 public:
  /// Exact distances in 3 passes over the box of cells with evidence, widened by the cut, with 16
  /// bytes a cell of it, of which 4 stay: about 7 ms for 112³ voxels of object, whatever the size
  /// of the workspace. Throws as HazardConfig::validate(), and Error(capacity) for a box of more
  /// than 2³¹ cells.
  explicit HazardField(const GridSnapshot& snapshot, const HazardConfig& config = {});

  /// Start values, or what was given; rates may differ from them by the map's counters.
  [[nodiscard]] const HazardConfig::Model& model() const { return model_; }
  /// Beyond the cut [1/m]; with a volume outside of its box.
  [[nodiscard]] float far_rate() const { return far_rate_; }
  /// Does it follow the map's counters? Not where a model or a volume was given, or `calibrated`
  /// is off.
  [[nodiscard]] bool follows_counters() const { return follows_counters_; }
  /// Logarithm to base 2 of the hazard cells' edge [voxels]; 0 with a volume.
  [[nodiscard]] int cell_shift() const { return volume_ ? 0 : shift_; }
  [[nodiscard]] double voxel_size() const { return voxel_size_; }  ///< [m]

  /// From a voxel's cell to the nearest one with evidence [m]; infinity beyond the cut.
  [[nodiscard]] double distance(Index3 voxel) const {
    const std::size_t cell = cell_of(voxel);
    return cell == kBeyond || squared_[cell] == kNoDistance
               ? std::numeric_limits<double>::infinity()
               : std::sqrt(static_cast<double>(squared_[cell])) * voxel_size_ * (1 << shift_);
  }
  /// c g of a voxel that is not free: HazardConfig::Model::continuation() at its cell, where
  /// several cells with evidence are the nearest at that of one of them, times openness(); in steps
  /// of 1/16384, 1 beyond the cut.
  [[nodiscard]] double shape(Index3 voxel) const {
    const std::size_t cell = cell_of(voxel);
    return cell == kBeyond ? 1.0 : shapes_[cell] / kShapeUnit;
  }
  /// In a voxel that is not free [1/m], as a ray meets it: single precision.
  [[nodiscard]] float rate(Index3 voxel) const {
    if (volume_) return volume_rate(voxel);
    const std::size_t cell = cell_of(voxel);
    if (cell == kBeyond || squared_[cell] == kNoDistance) return far_rate_;
    const std::array<float, 2>& rates = rates_[squared_[cell]];
    return rates[0] + rates[1] * static_cast<float>(shapes_[cell]);
  }
  /// The same by the model alone, without what the counters say [1/m].
  [[nodiscard]] double start_rate(Index3 voxel) const {
    return model_.rate(distance(voxel), shape(voxel));
  }
  [[nodiscard]] const Pooling& pooling() const { return pooling_; }  ///< of the map
  /// Does surface found in this voxel count as new? d > 1.2 pooling lengths.
  [[nodiscard]] bool is_new(Index3 voxel) const {
    const std::size_t cell = cell_of(voxel);
    return cell == kBeyond || squared_[cell] > most_known_;
  }

  /// The voxels outside of which nothing is nearer than the cut; empty while there is no evidence.
  [[nodiscard]] const VoxelBox& near_box() const { return near_box_; }
  /// Rates that are not the model's, null unless given.
  [[nodiscard]] const HazardConfig::Volume* volume() const { return volume_.get(); }

 private:
  static constexpr std::uint16_t kNoDistance = 0xFFFF;
  static constexpr std::size_t kBeyond = std::numeric_limits<std::size_t>::max();
  static constexpr int kMaxReach = 127;  // of distances [cells]
  static constexpr double kShapeUnit = 16384;

  [[nodiscard]] std::size_t cell_of(Index3 voxel) const {
    if (!near_box_.contains(voxel)) return kBeyond;
    const std::size_t x = static_cast<std::size_t>((voxel.x >> shift_) - low_cell_.x),
                      y = static_cast<std::size_t>((voxel.y >> shift_) - low_cell_.y),
                      z = static_cast<std::size_t>((voxel.z >> shift_) - low_cell_.z);
    return (x * size_[1] + y) * size_[2] + z;
  }
  [[nodiscard]] float volume_rate(Index3 voxel) const;
  [[nodiscard]] Index3 cell_at(Index3 v, int by) const {
    return {(v.x >> shift_) + by, (v.y >> shift_) + by, (v.z >> shift_) + by};
  }
  void find_distances(const GridSnapshot& snapshot, const std::vector<Index3>& evidence);
  void find_shapes(const detail::NearestCells& nearest, const detail::FreeShare& free,
                   const detail::OpenDirections& open);
  void find_rates(int reach);

  HazardConfig::Model model_;
  std::shared_ptr<const HazardConfig::Volume> volume_;
  Pooling pooling_;
  double voxel_size_;
  int shift_ = 0;  // of the cells that have a distance
  Index3 low_cell_{};
  std::array<std::size_t, 3> size_{};   // of the box of distances [cells]
  VoxelBox near_box_{};                 // the same in voxels
  std::vector<std::uint16_t> squared_;  // [cells²]
  std::vector<std::uint16_t> shapes_;   // c g [1/kShapeUnit]
  std::vector<std::array<float, 2>>
      rates_;  // by squared distance: where c g is 0, and each 1/kShapeUnit
  std::array<double, HazardCounters::kClasses> factors_{};  // by class of distance
  float far_rate_ = 0;
  bool follows_counters_ = false;
  std::uint32_t most_known_ = 0;  // squared distance up to which surface is not new
};

}  // namespace viewgain
