// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <bit>
#include <cstdint>
#include <span>
#include <vector>

#include "gain/gain_accumulator.hpp"
#include "scene/scene_data.hpp"
#include "trace/view_tracer.hpp"

namespace viewgain::detail {

/// Steps of a range [voxels]: the leading bits of its square, 16 an octave of the range.
inline constexpr unsigned kRangeStepShift = 20;
[[nodiscard]] inline std::uint32_t step_of(float squared) {
  return std::bit_cast<std::uint32_t>(squared) >> kRangeStepShift;
}

/// Upper bounds of what the rows of tiles of a view can gain, from where the scene's voxels lie in
/// its image and without tracing a ray.
///
/// With m rays in a voxel its gain is at most a concave g_v(m), so for any price λ >= 0 of a ray
/// the gain of M rays is at most λ M + Σ_v max_m (g_v(m) - λ m): M counts the pixels that some
/// voxel may cover, and the sum runs over the voxels in view with a face that is open towards the
/// camera. The best of several prices counts. Occlusion is left out.
///
/// Λ_r counts as diag(a, a, b) in the frame of the voxel's central ray, widened by how far rays
/// turn within a voxel: the sum of the concave function of the diagonal is the most that the
/// eigenvalues can make of it. An occupied voxel gains at most what the larger of a and b times I
/// does (DESIGN.md section 6), which is at most what an isotropic voxel with a certain covariance
/// does.
///
/// Immutable; thread safe.
class ViewBounds {
 public:
  ViewBounds(const VoxelScene::Data& scene, const GainSettings& settings, const TileTable& table,
             const PinholeCamera& camera, int pixel_stride, double min_range, double max_range);

  /// Whether views of the scene can be bounded: no obstacles, no task weights, no distortion, and
  /// few enough primitives to sort into the tiles.
  [[nodiscard]] bool usable() const { return usable_; }

  static constexpr std::size_t kPrices = 8;
  using PerPrice = std::array<double, kPrices>;

  /// What a thread needs.
  struct Workspace {
    std::vector<std::uint64_t> pixels;  ///< that may meet anything; one bit each
    /// Voxels by row of tiles, class and range: those whose last row it is, and those that lie in
    /// the row before as well.
    std::vector<std::uint32_t> ending, open;
    std::vector<float> column, row, squared_range;  ///< of a block's voxels
  };

  /// The most that rows r, r + 1, ... of tiles add to the gain of those before, into from[r], and 0
  /// into from[row_count()]. False if nothing can be said of the view: the camera stands among the
  /// blocks, or one is nearer than min_range, where rays may start inside.
  bool bound(const PoseFrame& frame, Workspace& workspace, std::span<double> from) const;

  [[nodiscard]] std::size_t row_count() const { return row_count_; }

 private:
  static constexpr std::size_t kClasses = 8;  // 0: unknown; occupied, by evidence

  // The cells of a primitive and the box round it.
  struct Block {
    std::size_t begin, end;
    std::array<float, 3> min, max;
  };

  void gather();
  void append_hull(const PrimitiveBox& box);
  void close_block(const PrimitiveBox& box, std::size_t begin);
  void append(std::array<int, 3> origin, const std::array<LeafMask, 6>& open,
              const SnapshotLeaf* leaf);
  unsigned class_of(const SnapshotLeaf& leaf, unsigned offset);
  void tabulate(double min_range, double max_range);
  bool splat(const PoseFrame& frame, Workspace& out) const;
  [[nodiscard]] std::size_t range_step(float squared_range) const;

  const VoxelScene::Data& scene_;
  const GainSettings& settings_;
  const TileTable& table_;
  float scale_x_, shift_x_, scale_y_, shift_y_;  // ray column = scale * x / z + shift
  bool usable_ = false;
  std::size_t row_count_ = 0, words_ = 0;      // tile rows; words a row of pixels
  std::array<double, kClasses> covariance_{};  // most of a class [m²]
  // Cells of 2³ or 4³ voxels that have open faces: centre [voxels] and members, one bit a voxel.
  struct Cell {
    std::array<std::uint64_t, 6> open;  // whose face in a direction is
    std::uint64_t occupied;
    unsigned evidence;  // the least class of the occupied ones
  };
  int edge_ = 2;  // of a cell [voxels]
  std::vector<float> x_, y_, z_;
  std::vector<Cell> cells_;
  std::vector<Block> blocks_;
  std::size_t largest_block_ = 0;
  std::array<double, kPrices> prices_{};
  // What is left to a voxel after paying for its rays, by range, class and price; and to one that
  // other rays have changed already.
  std::vector<std::array<PerPrice, kClasses>> left_;
  std::vector<PerPrice> left_changed_;
  std::vector<double> one_ray_;  // the most that one ray gains, by range
  std::uint32_t first_step_ = 0;
};

}  // namespace viewgain::detail
