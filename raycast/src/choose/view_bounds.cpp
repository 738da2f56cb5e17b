// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include "view_bounds.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <limits>
#include <unordered_map>

namespace viewgain::detail {
namespace {

// Of each range, against rounding in the tracer [voxels].
constexpr float kRangeMargin = 0.1F;
// And of each outline in the image [rays].
constexpr float kPixelMargin = 0.05F;
// A ray within rounding of an edge may pass between two voxels and end in one that has no face
// open to it: this share of the rays is granted the most that a ray can gain.
constexpr double kSeamShare = 1.0 / 512;
// Blocks must be farther from the camera's plane than this [voxels].
constexpr float kNearestDepth = 2.0F;
using Words = LeafMask;

constexpr std::uint64_t kLowestZ = 0x0101010101010101ULL;

// The voxels of a block whose face in each direction (-x, +x, -y, ... ) is open, given the blocks
// on the six sides.
std::array<Words, 6> open_faces(const Words& own, const std::array<Words, 6>& beside) {
  std::array<Words, 6> open{};
  for (std::size_t x = 0; x < 8; ++x) {
    const std::uint64_t m = own[x];
    open[0][x] = m & ~(x > 0 ? own[x - 1] : beside[0][7]);
    open[1][x] = m & ~(x < 7 ? own[x + 1] : beside[1][0]);
    open[2][x] = m & ~(m << 8U | beside[2][x] >> 56U);
    open[3][x] = m & ~(m >> 8U | beside[3][x] << 56U);
    open[4][x] = m & ~((m << 1U & ~kLowestZ) | (beside[4][x] >> 7U & kLowestZ));
    open[5][x] = m & ~((m >> 1U & ~(kLowestZ << 7U)) | (beside[5][x] & kLowestZ) << 7U);
  }
  return open;
}

unsigned rounded_up(float x) {
  const auto whole = static_cast<unsigned>(x);
  return whole + (static_cast<float>(whole) < x ? 1U : 0U);
}

void set_bits(std::uint64_t* words, std::size_t first, std::size_t last) {
  for (std::size_t w = first / 64; w <= last / 64; ++w) {
    const std::size_t low = w == first / 64 ? first % 64 : 0;
    const std::size_t high = w == last / 64 ? last % 64 : 63;
    words[w] |= (~std::uint64_t{0} >> (63 - (high - low))) << low;
  }
}

// More cells than this cost more to project than they save; scenes with more primitives than
// kFinePrimitives have cells of 4³.
constexpr std::size_t kMaxCells = 1U << 17U;
constexpr std::size_t kFinePrimitives = 1000;

}  // namespace

ViewBounds::ViewBounds(const VoxelScene::Data& scene, const GainSettings& settings,
                       const TileTable& table, const PinholeCamera& camera, int pixel_stride,
                       double min_range, double max_range)
    : scene_(scene),
      settings_(settings),
      table_(table),
      scale_x_(static_cast<float>(camera.fx / pixel_stride)),
      shift_x_(static_cast<float>(camera.cx / pixel_stride)),
      scale_y_(static_cast<float>(camera.fy / pixel_stride)),
      shift_y_(static_cast<float>(camera.cy / pixel_stride)),
      usable_(!scene.has_obstacles && settings.weights.empty() && !camera.has_distortion() &&
              scene.scene_boxes->are_primitives()),
      row_count_(static_cast<std::size_t>((table.rows + kTileEdge - 1) / kTileEdge)),
      words_(static_cast<std::size_t>((table.columns + 63) / 64)) {
  if (!usable_) return;
  covariance_[0] = 1 / settings.prior_information;
  edge_ = scene.boxes.size() > kFinePrimitives ? 4 : 2;
  gather();
  usable_ = cells_.size() <= kMaxCells;
  if (usable_) tabulate(min_range, max_range);
}

// The cells of a block of 8³ voxels whose lowest is at `origin`.
void ViewBounds::append(std::array<int, 3> origin, const std::array<LeafMask, 6>& open,
                        const SnapshotLeaf* leaf) {
  const auto edge = static_cast<unsigned>(edge_);
  for (unsigned first = 0; first < 512; ++first) {
    const std::array<unsigned, 3> low{first >> 6U, first >> 3U & 7U, first & 7U};
    if (low[0] % edge != 0 || low[1] % edge != 0 || low[2] % edge != 0) continue;
    Cell cell{{}, 0, 0};
    std::uint64_t any = 0;
    for (unsigned i = 0; i < edge * edge * edge; ++i) {
      const unsigned offset = (low[0] + i / (edge * edge)) << 6U |
                              (low[1] + i / edge % edge) << 3U | (low[2] + i % edge);
      std::uint64_t is_open = 0;
      for (std::size_t face = 0; face < 6; ++face) {
        const std::uint64_t bit = open[face][offset >> 6U] >> (offset & 63U) & 1U;
        cell.open[face] |= bit << i;
        is_open |= bit;
      }
      any |= is_open;
      if (is_open == 0 || leaf == nullptr || !test_bit(leaf->occupied, offset)) continue;
      const unsigned evidence = class_of(*leaf, offset);
      cell.evidence = cell.occupied == 0 ? evidence : std::min(cell.evidence, evidence);
      cell.occupied |= std::uint64_t{1} << i;
    }
    if (any == 0) continue;
    const auto center = [&](std::size_t k) {
      return static_cast<float>(origin[k] + static_cast<int>(low[k])) +
             0.5F * static_cast<float>(edge);
    };
    x_.push_back(center(0)), y_.push_back(center(1)), z_.push_back(center(2));
    cells_.push_back(cell);
  }
}

// The cells along the faces of a larger box, all open.
void ViewBounds::append_hull(const PrimitiveBox& box) {
  const auto edge = static_cast<float>(edge_);
  const auto last = [&](std::size_t k) { return box.max[k] - edge; };
  for (float x = box.min[0]; x < box.max[0]; x += edge) {
    for (float y = box.min[1]; y < box.max[1]; y += edge) {
      const bool rim = x == box.min[0] || x >= last(0) || y == box.min[1] || y >= last(1);
      for (float z = box.min[2]; z < box.max[2]; z += edge) {
        if (!rim && z != box.min[2] && z < last(2)) continue;
        x_.push_back(x + 0.5F * edge), y_.push_back(y + 0.5F * edge), z_.push_back(z + 0.5F * edge);
        Cell cell{{}, 0, 0};
        cell.open.fill(~std::uint64_t{0} >> (64 - edge_ * edge_ * edge_));
        cells_.push_back(cell);
      }
    }
    if (cells_.size() > kMaxCells) return;
  }
}

void ViewBounds::close_block(const PrimitiveBox& box, std::size_t begin) {
  if (begin == x_.size()) return;
  largest_block_ = std::max(largest_block_, x_.size() - begin);
  blocks_.push_back({begin,
                     x_.size(),
                     {box.min[0], box.min[1], box.min[2]},
                     {box.max[0], box.max[1], box.max[2]}});
}

// Lists the voxels with an open face. What is not known to be closed counts as open.
void ViewBounds::gather() {
  std::unordered_map<std::uint64_t, std::size_t> at;
  for (std::size_t p = 0; p < scene_.block_count; ++p) at.emplace(scene_.block_keys[p] >> 9U, p);
  const auto words_of = [&](std::size_t p) {
    Words words;
    words.fill(~std::uint64_t{0});
    if (p < scene_.leaf_count) std::memcpy(words.data(), &scene_.masks[p], sizeof(words));
    return words;
  };
  const Index3& base = scene_.snapshot.min_index;
  const Index3& dims = scene_.snapshot.dims;
  const std::array<std::int32_t, 3> low{base.x >> 3, base.y >> 3, base.z >> 3},
      high{(base.x + dims.x - 1) >> 3, (base.y + dims.y - 1) >> 3, (base.z + dims.z - 1) >> 3};

  for (std::size_t p = 0; p < scene_.block_count; ++p) {
    const Index3 voxel = scene_.voxel_at(scene_.block_keys[p]);
    const std::array<std::int32_t, 3> block{voxel.x >> 3, voxel.y >> 3, voxel.z >> 3};
    std::array<Words, 6> beside{};
    for (std::size_t face = 0; face < 6; ++face) {
      std::array<std::int32_t, 3> next = block;
      next[face / 2] += face % 2 == 0 ? -1 : 1;
      if (next[face / 2] < low[face / 2] || next[face / 2] > high[face / 2]) continue;
      const auto found = at.find(scene_.block_of(next[0], next[1], next[2]));
      if (found != at.end()) beside[face] = words_of(found->second);
    }
    const std::array<Words, 6> open = open_faces(words_of(p), beside);
    const SnapshotLeaf* leaf = p < scene_.leaf_count && scene_.has_occupied[p] != 0
                                   ? &scene_.snapshot.leaves[scene_.leaf_source[p]]
                                   : nullptr;
    const std::size_t begin = x_.size();
    append({voxel.x - base.x, voxel.y - base.y, voxel.z - base.z}, open, leaf);
    close_block(scene_.boxes[p], begin);
  }
  for (std::size_t p = scene_.block_count; p < scene_.boxes.size(); ++p) {
    const std::size_t begin = x_.size();
    append_hull(scene_.boxes[p]);
    if (cells_.size() > kMaxCells) return;
    close_block(scene_.boxes[p], begin);
  }
}

std::size_t ViewBounds::range_step(float squared_range) const {
  const std::uint32_t step = step_of(squared_range);
  return step <= first_step_ ? 0 : std::min<std::size_t>(step - first_step_, left_.size() - 1);
}

// Adds up what the voxels in view may gain, by the last row of tiles that they lie in.
bool ViewBounds::splat(const PoseFrame& frame, Workspace& out) const {
  const std::size_t steps = left_.size();
  const auto& R = frame.rotation;
  const auto& eye = frame.origin;
  // Half a cell in the camera's axes.
  std::array<float, 3> half{};
  for (std::size_t k = 0; k < 3; ++k) {
    half[k] = 0.5F * static_cast<float>(edge_) *
              (std::abs(R[k]) + std::abs(R[3 + k]) + std::abs(R[6 + k]));
  }
  const float last_column = static_cast<float>(table_.columns - 1);
  const float last_row = static_cast<float>(table_.rows - 1);
  const float min_range = frame.min_range + kRangeMargin, max_range = frame.max_range + 2;

  for (const Block& block : blocks_) {
    // Where the block lies, and the faces that can be seen of it.
    std::array<std::uint64_t, 6> facing{};  // all bits or none
    float squared = 0;
    std::array<float, 3> off{}, reach{};
    for (std::size_t k = 0; k < 3; ++k) {
      const float below = block.min[k] - eye[k], above = eye[k] - block.max[k];
      if (!(above > kRangeMargin)) facing[2 * k] = ~std::uint64_t{0};
      if (!(below > kRangeMargin)) facing[2 * k + 1] = ~std::uint64_t{0};
      const float gap = std::max({below, above, 0.0F});
      squared += gap * gap;
      off[k] = 0.5F * (block.min[k] + block.max[k]) - eye[k];
      reach[k] = 0.5F * (block.max[k] - block.min[k]) + static_cast<float>(edge_);
    }
    const auto extent = [&](std::size_t k, float& low, float& high) {
      const float middle = R[k] * off[0] + R[3 + k] * off[1] + R[6 + k] * off[2];
      const float spread =
          std::abs(R[k]) * reach[0] + std::abs(R[3 + k]) * reach[1] + std::abs(R[6 + k]) * reach[2];
      low = middle - spread, high = middle + spread;
    };
    float x_low, x_high, y_low, y_high, z_low, z_high;
    extent(2, z_low, z_high);
    if (z_high < 0) continue;
    if (z_low < kNearestDepth) return false;
    if (squared > max_range * max_range) continue;
    extent(0, x_low, x_high), extent(1, y_low, y_high);
    const float x_most = std::max(x_high / z_low, x_high / z_high) * scale_x_ + shift_x_;
    const float x_least = std::min(x_low / z_low, x_low / z_high) * scale_x_ + shift_x_;
    const float y_most = std::max(y_high / z_low, y_high / z_high) * scale_y_ + shift_y_;
    const float y_least = std::min(y_low / z_low, y_low / z_high) * scale_y_ + shift_y_;
    if (x_most < -1 || x_least > last_column + 1 || y_most < -1 || y_least > last_row + 1) continue;
    if (squared <= min_range * min_range) return false;

    // First all of them without a branch, then those that face the camera.
    const std::size_t count = block.end - block.begin;
    const float* const x = &x_[block.begin];
    const float* const y = &y_[block.begin];
    const float* const z = &z_[block.begin];
    for (std::size_t i = 0; i < count; ++i) {
      const float dx = x[i] - eye[0], dy = y[i] - eye[1], dz = z[i] - eye[2];
      const float by_z = 1 / (R[2] * dx + R[5] * dy + R[8] * dz);
      out.column[i] = (R[0] * dx + R[3] * dy + R[6] * dz) * by_z * scale_x_ + shift_x_;
      out.row[i] = (R[1] * dx + R[4] * dy + R[7] * dz) * by_z * scale_y_ + shift_y_;
      out.squared_range[i] = dx * dx + dy * dy + dz * dz;
    }
    const float tan_x =
        std::max(std::abs(x_most - shift_x_), std::abs(x_least - shift_x_)) / scale_x_;
    const float tan_y =
        std::max(std::abs(y_most - shift_y_), std::abs(y_least - shift_y_)) / scale_y_;
    const float column_reach = (half[0] + tan_x * half[2]) / z_low * scale_x_ + kPixelMargin;
    const float row_reach = (half[1] + tan_y * half[2]) / z_low * scale_y_ + kPixelMargin;
    // A ray may end nearer than the cell's centre by half its diagonal.
    const float nearer =
        std::max(1 - 0.9F * static_cast<float>(edge_) / std::max(std::sqrt(squared), 1.0F), 0.0F);
    for (std::size_t i = 0; i < count; ++i) {
      const Cell& cell = cells_[block.begin + i];
      std::uint64_t seen = 0;
      for (std::size_t face = 0; face < 6; ++face) seen |= cell.open[face] & facing[face];
      if (seen == 0) continue;
      const float column0 = out.column[i] - column_reach, column1 = out.column[i] + column_reach;
      const float row0 = out.row[i] - row_reach, row1 = out.row[i] + row_reach;
      if (column1 < 0 || row1 < 0 || column0 > last_column || row0 > last_row) continue;
      const unsigned c0 = rounded_up(std::max(column0, 0.0F));
      const unsigned c1 = static_cast<unsigned>(std::min(column1, last_column));
      const unsigned r0 = rounded_up(std::max(row0, 0.0F));
      const unsigned r1 = static_cast<unsigned>(std::min(row1, last_row));
      if (c0 > c1 || r0 > r1) continue;
      for (std::size_t r = r0; r <= r1; ++r) set_bits(&out.pixels[r * words_], c0, c1);
      const std::size_t step = range_step(out.squared_range[i] * nearer * nearer);
      const std::size_t first = r0 / kTileEdge, last = r1 / kTileEdge;
      out.ending[last * kClasses * steps + step] +=
          static_cast<std::uint32_t>(std::popcount(seen & ~cell.occupied));
      const auto occupied = static_cast<std::uint32_t>(std::popcount(seen & cell.occupied));
      if (occupied == 0) continue;
      const unsigned c = cell.evidence;
      out.ending[(last * kClasses + c) * steps + step] += occupied;
      for (std::size_t r = first + 1; r <= last; ++r) {
        out.open[(r * kClasses + c) * steps + step] += occupied;
      }
    }
  }
  return true;
}

bool ViewBounds::bound(const PoseFrame& frame, Workspace& workspace, std::span<double> from) const {
  const std::size_t steps = left_.size();
  const std::size_t cells = kClasses * steps;
  workspace.pixels.assign(words_ * static_cast<std::size_t>(table_.rows), 0);
  workspace.ending.assign(row_count_ * cells, 0);
  workspace.open.assign(row_count_ * cells, 0);
  workspace.column.resize(largest_block_);
  workspace.row.resize(largest_block_);
  workspace.squared_range.resize(largest_block_);
  if (!splat(frame, workspace)) return false;

  // From the last row back.
  PerPrice left{};
  std::uint64_t rays = 0;
  from[row_count_] = 0;
  for (std::size_t row = row_count_; row-- > 0;) {
    PerPrice changed{};
    for (std::size_t c = 0; c < kClasses; ++c) {
      for (std::size_t step = 0; step < steps; ++step) {
        const std::size_t cell = row * cells + c * steps + step;
        if (const std::uint32_t n = workspace.ending[cell]; n != 0) {
          for (std::size_t i = 0; i < kPrices; ++i) left[i] += n * left_[step][c][i];
        }
        if (const std::uint32_t n = workspace.open[cell]; n != 0) {
          for (std::size_t i = 0; i < kPrices; ++i) {
            changed[i] += n * std::max(0.0, left_changed_[step][i] - left_[step][c][i]);
          }
        }
      }
    }
    const std::size_t end = std::min((row + 1) * kTileEdge, static_cast<std::size_t>(table_.rows));
    for (std::size_t i = row * kTileEdge * words_; i < end * words_; ++i) {
      rays += static_cast<std::uint64_t>(std::popcount(workspace.pixels[i]));
    }
    double best = std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i < kPrices; ++i) {
      best = std::min(best, prices_[i] * static_cast<double>(rays) + left[i] + changed[i]);
    }
    from[row] = best + kSeamShare * static_cast<double>(rays) * one_ray_[0];
  }
  return true;
}

}  // namespace viewgain::detail
