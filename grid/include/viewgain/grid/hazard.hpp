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

#include "viewgain/core/exec_config.hpp"
#include "viewgain/core/export.hpp"
#include "viewgain/grid/belief_grid.hpp"
#include "viewgain/grid/fused_points.hpp"
#include "viewgain/grid/grid_snapshot.hpp"
#include "viewgain/grid/hazard_counters.hpp"
#include "viewgain/grid/voxel.hpp"

namespace viewgain {
class ThreadPool;
namespace detail {
class FreeShare;
struct HazardLayout;
class NearestCells;
class OpenDirections;
}  // namespace detail

/// Settings of the hazard: the rate [1/m] at which a ray through unknown voxels meets the surface.
/// Where the rate is 0, there is no surface and no ray ends. A ray can reach known surface from
/// behind. Then the surface's back is expected in the last unknown voxels in front of it, unless
/// their rate is 0. Rates below 1e-30 /m are rounded to 0.
struct VIEWGAIN_EXPORT HazardConfig {
  /// Model of the hazard, which depends on the location relative to known surface
  /// (apps/docs/guide/surface_gain.md): h(d, s, o) = far_rate + near_rate c(s) g(o) exp(-d /
  /// decay_length). Beyond 5 decay lengths it is far_rate. c is continuation() and g is openness().
  /// - d: distance to known surface
  /// - s: sine of the location's elevation above the tangent plane at the nearest point of known
  ///   surface; 1 is straight towards free space
  /// - o: openness, the fraction of the 26 directions to neighbouring hazard cells (HazardField) in
  ///   which free space begins within 2.2 decay lengths, and before any occupied voxel
  ///
  /// Members do not check their arguments; validate() checks the rates.
  struct Model {
    double near_rate = 231;       ///< h_0 [1/m]
    double decay_length = 0.016;  ///< lambda [m]
    double far_rate = 0.029;      ///< h_inf [1/m]

    static constexpr double kCut = 5.0;        ///< beyond it, the rate is far_rate [decay lengths]
    static constexpr double kOpenReach = 2.2;  ///< length of the directions of o [decay lengths]

    /// Start values, for an object whose longest side is `size` [m]. They were fitted to seven
    /// objects of 0.35 m (perf/hazard/fit.py) and are scaled with the size.
    [[nodiscard]] static Model for_size(double size) {
      return {81.0 / size, 0.0457 * size, 0.01 / size};
    }
    /// A constant rate [1/m]. `size` [m] only sets the decay length, and with it the edge of the
    /// hazard cells.
    [[nodiscard]] static Model constant(double rate, double size) {
      return {0.0, 0.0457 * size, rate};
    }

    /// c(s), the effect of the direction: surfaces continue, and bend away from free space rather
    /// than into it. Fitted, and piecewise linear in steps of 1/5 of s. It is 1 at s = -0.4 and
    /// less elsewhere.
    [[nodiscard]] static VIEWGAIN_EXPORT double continuation(double sine_of_elevation);

    /// g(o), the effect of the openness: surface lies between free and hidden space. A location
    /// with free space in nearly all directions is a gap in free space; a location without any lies
    /// deep in hidden space. Fitted, and piecewise linear in steps of 1/13 of o.
    [[nodiscard]] static VIEWGAIN_EXPORT double openness(double share_of_directions);

    /// Hazard [1/m]. `distance` [m] is d and `shape` is c(s) g(o).
    [[nodiscard]] double rate(double distance, double shape = 1.0) const {
      return distance <= kCut * decay_length
                 ? far_rate + near_rate * shape * std::exp(-distance / decay_length)
                 : far_rate;
    }
    bool operator==(const Model&) const = default;
  };
  /// Rates from elsewhere that replace the model's, for example from a prior of the object's shape.
  struct Volume {
    VoxelBox box;              ///< the voxels, on the grid's lattice
    std::vector<float> rates;  ///< rates of the box's voxels [1/m], [x][y][z] with z fastest
    float outside = 0;         ///< rate outside the box [1/m]
  };

  /// Longest side of the object [m]. Unset: the longest side of the bounding box of the surface
  /// seen so far, or of the workspace if no surface was seen.
  std::optional<double> object_size{};
  std::optional<Model> model{};  ///< unset: Model::for_size(object_size)
  /// Rates per voxel that replace the model; null: none.
  std::shared_ptr<const Volume> volume{};
  /// Whether counts from the frames so far (HazardCounters) correct the start values. Has no effect
  /// if `model` or `volume` is set. The counts are per distance in decay lengths, so object_size
  /// should be the same for all scenes of a map.
  bool calibrated = true;

  /// Throws Error(invalid_argument), naming the value, if a size or decay length is not positive
  /// and finite, a rate is negative or not finite, or the number of rates in the volume is not that
  /// of the voxels in its box.
  void validate() const;
};

/// Settings for a constant `rate` [1/m] in a map. `object_size` [m] sets the edge of the hazard
/// cells. Default: the longest side of the workspace. Throws Error(invalid_argument) if object_size
/// is not positive and finite. The rate is not checked. Constant time.
[[nodiscard]] VIEWGAIN_EXPORT HazardConfig constant_hazard(double rate, const BeliefGrid& grid,
                                                           std::optional<double> object_size = {});

/// Hazard of a map in its current state. Immutable; members may be called from many threads. They
/// accept any voxel, never throw, and take constant time.
///
/// Rates are computed per hazard cell: a cube of 1, 2, 4 or 8 voxels per edge, about 0.28 decay
/// lengths wide. Rates from HazardConfig::volume are per voxel. A cell has evidence if it contains
/// an occupied voxel with at least 3 readings (Belief::hits). If voxels are smaller than the
/// footprint, the cubes of pooling_of() replace voxels here. The distance of a cell to known
/// surface is that of its centre to the centre of the nearest cell with evidence. Beyond the cut,
/// which is 5 decay lengths or 127 cells, whichever is shorter, it counts as infinite. The surface
/// normal points to where more of the surrounding 7³ cells are free. HazardCounters::factor()
/// scales the start values per class of distance.
class VIEWGAIN_EXPORT HazardField {
 public:
  /// Computes the rates of all cells within the cut of evidence, on the threads of `exec`. Results
  /// do not depend on the number of threads. Throws Error(capacity) above 2³¹ cells. Also throws
  /// whatever HazardConfig::validate() and thread_count() throw. Cost: some milliseconds per
  /// million cells (perf/README.md). Needs about 20 bytes per cell during the call and 4 bytes
  /// afterwards.
  explicit HazardField(const GridSnapshot& snapshot, const HazardConfig& config = {},
                       const ExecConfig& exec = {});

  /// HazardConfig::model if it was set, otherwise the start values (Model::for_size()). The
  /// counters of the map can make rates differ from the start values.
  [[nodiscard]] const HazardConfig::Model& model() const { return model_; }
  /// Rate beyond the cut [1/m]. With a volume: rate outside its box.
  [[nodiscard]] float far_rate() const { return far_rate_; }
  /// Whether the counters of the map correct the rates. False if HazardConfig sets a model or
  /// volume, or if `calibrated` is false.
  [[nodiscard]] bool follows_counters() const { return follows_counters_; }
  /// Binary logarithm of the edge of a hazard cell in voxels; 0 with a volume.
  [[nodiscard]] int cell_shift() const { return volume_ ? 0 : shift_; }
  [[nodiscard]] double voxel_size() const { return voxel_size_; }  ///< [m]

  /// Distance of a voxel's cell to known surface [m]; infinity beyond the cut.
  [[nodiscard]] double distance(Index3 voxel) const {
    const std::size_t cell = cell_of(voxel);
    return cell == kBeyond || squared_[cell] == kNoDistance
               ? std::numeric_limits<double>::infinity()
               : std::sqrt(static_cast<double>(squared_[cell])) * voxel_size_ * (1 << shift_);
  }
  /// Factor c(s) g(o) of HazardConfig::Model for a voxel that is not free, in steps of 1/16384; 1
  /// beyond the cut. If several cells with evidence are equally near, one of them determines s.
  [[nodiscard]] double shape(Index3 voxel) const {
    const std::size_t cell = cell_of(voxel);
    return cell == kBeyond ? 1.0 : shapes_[cell] / kShapeUnit;
  }
  /// Rate in a voxel that is not free [1/m]. Rays use this value.
  [[nodiscard]] float rate(Index3 voxel) const {
    if (volume_) return volume_rate(voxel);
    const std::size_t cell = cell_of(voxel);
    if (cell == kBeyond || squared_[cell] == kNoDistance) return far_rate_;
    const std::array<float, 2>& rates = rates_[squared_[cell]];
    return rates[0] + rates[1] * static_cast<float>(shapes_[cell]);
  }
  /// Rate of the model without the correction by counters [1/m].
  [[nodiscard]] double start_rate(Index3 voxel) const {
    return model_.rate(distance(voxel), shape(voxel));
  }
  [[nodiscard]] const Pooling& pooling() const { return pooling_; }  ///< pooling of the map
  /// Whether surface in this voxel counts as new. True if its cell is more than 1.2 pooling lengths
  /// from known surface.
  [[nodiscard]] bool is_new(Index3 voxel) const {
    const std::size_t cell = cell_of(voxel);
    return cell == kBeyond || squared_[cell] > most_known_;
  }

  /// Box of the voxels within the cut of evidence; empty if no cell has evidence.
  [[nodiscard]] const VoxelBox& near_box() const { return near_box_; }
  /// HazardConfig::volume, or null.
  [[nodiscard]] const HazardConfig::Volume* volume() const { return volume_.get(); }

 private:
  friend class HazardProbe;  // for kShapeUnit
  static constexpr std::uint16_t kNoDistance = 0xFFFF;
  static constexpr std::size_t kBeyond = std::numeric_limits<std::size_t>::max();
  static constexpr double kShapeUnit = 16384;

  [[nodiscard]] std::size_t cell_of(Index3 voxel) const {
    if (!near_box_.contains(voxel)) return kBeyond;
    const std::size_t x = static_cast<std::size_t>((voxel.x >> shift_) - low_cell_.x),
                      y = static_cast<std::size_t>((voxel.y >> shift_) - low_cell_.y),
                      z = static_cast<std::size_t>((voxel.z >> shift_) - low_cell_.z);
    return (x * size_[1] + y) * size_[2] + z;
  }
  [[nodiscard]] float volume_rate(Index3 voxel) const;
  void find_distances(const GridSnapshot& snapshot, const detail::HazardLayout& layout,
                      ThreadPool& pool);
  void find_shapes(const detail::NearestCells& nearest, const detail::FreeShare& free,
                   const detail::OpenDirections& open, const std::vector<std::uint32_t>& sources,
                   ThreadPool& pool);
  void find_rates(int reach);

  HazardConfig::Model model_;
  std::shared_ptr<const HazardConfig::Volume> volume_;
  Pooling pooling_;
  double voxel_size_;
  int shift_ = 0;  // of the cells with a distance
  Index3 low_cell_{};
  std::array<std::size_t, 3> size_{};   // of the box of distances [cells]
  VoxelBox near_box_{};                 // of the box of distances [voxels]
  std::vector<std::uint16_t> squared_;  // [cells²]
  std::vector<std::uint16_t> shapes_;   // c g [1/kShapeUnit]
  std::vector<std::array<float, 2>>
      rates_;  // by squared distance: the rate where c g is 0, and its increase per 1/kShapeUnit
  std::array<double, HazardCounters::kClasses> factors_{};  // by distance class
  float far_rate_ = 0;
  bool follows_counters_ = false;
  std::uint32_t most_known_ = 0;  // squared distance up to which surface is not new
};

}  // namespace viewgain
