// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include "viewgain/raycast/voxel_scene.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <string>

#include "scene_data.hpp"
#include "viewgain/core/error.hpp"
#include "voxel_bvh.hpp"

namespace viewgain {
namespace {

using detail::PrimitiveBox;

constexpr std::size_t kMaxPrimitives = std::size_t{1} << 23U;

void check(const Obstacles& obstacles) {
  for (const Box& box : obstacles.boxes) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      if (!std::isfinite(box.min[axis]) || !std::isfinite(box.max[axis]) ||
          box.min[axis] >= box.max[axis]) {
        throw Error(ErrorCode::invalid_argument, "an obstacle box is inside out or not finite");
      }
    }
  }
  for (const TriangleMesh& mesh : obstacles.meshes) {
    for (const auto& vertex : mesh.vertices) {
      for (const double c : vertex) {
        if (!std::isfinite(static_cast<float>(c))) {
          throw Error(ErrorCode::invalid_argument, "an obstacle has a vertex that is not finite");
        }
      }
    }
    for (const auto& triangle : mesh.triangles) {
      for (const std::uint32_t index : triangle) {
        if (index >= mesh.vertices.size()) {
          throw Error(ErrorCode::invalid_argument, "an obstacle's triangle refers to vertex " +
                                                       std::to_string(index) + " of " +
                                                       std::to_string(mesh.vertices.size()));
        }
      }
    }
  }
}

// The tightest box round the set bits of a leaf.
PrimitiveBox tight_box(const LeafMask& mask, const std::array<float, 3>& origin) {
  unsigned x_min = 8, x_max = 0;
  std::uint64_t any = 0;
  for (unsigned x = 0; x < 8; ++x) {
    if (mask[x] == 0) continue;
    x_min = std::min(x_min, x);
    x_max = x;
    any |= mask[x];
  }
  // Bits of `any` are y << 3 | z: fold the bytes for z, take first and last byte for y.
  const auto y_min = static_cast<unsigned>(std::countr_zero(any)) / 8U;
  const auto y_max = 7U - static_cast<unsigned>(std::countl_zero(any)) / 8U;
  std::uint64_t fold = any | any >> 32U;
  fold |= fold >> 16U;
  const auto z_bits = static_cast<std::uint8_t>(fold | fold >> 8U);
  const auto z_min = static_cast<unsigned>(std::countr_zero(z_bits));
  const auto z_max = 7U - static_cast<unsigned>(std::countl_zero(z_bits));
  return {{origin[0] + static_cast<float>(x_min), origin[1] + static_cast<float>(y_min),
           origin[2] + static_cast<float>(z_min)},
          {origin[0] + static_cast<float>(x_max + 1U), origin[1] + static_cast<float>(y_max + 1U),
           origin[2] + static_cast<float>(z_max + 1U)},
          x_min << 6U | y_min << 3U | z_min};
}

std::array<float, 3> relative(const Index3& voxel, const Index3& base) {
  return {static_cast<float>(voxel.x - base.x), static_cast<float>(voxel.y - base.y),
          static_cast<float>(voxel.z - base.z)};
}

// Cuts a box into pieces whose offsets fit.
void append_pieces(const Index3& min, const Index3& max, const Index3& base,
                   std::vector<PrimitiveBox>& out) {
  constexpr std::int32_t kEdge = detail::kMaxBoxEdge;
  for (std::int32_t x = min.x; x < max.x; x += kEdge) {
    for (std::int32_t y = min.y; y < max.y; y += kEdge) {
      for (std::int32_t z = min.z; z < max.z; z += kEdge) {
        const auto low = relative({x, y, z}, base);
        const auto high = relative(
            {std::min(x + kEdge, max.x), std::min(y + kEdge, max.y), std::min(z + kEdge, max.z)},
            base);
        out.push_back({{low[0], low[1], low[2]}, {high[0], high[1], high[2]}, 0});
      }
    }
  }
}

bool is_whole_block(const SnapshotTile& tile) {
  const auto aligned = [](std::int32_t min, std::int32_t max) {
    return max - min == 8 && (min & 7) == 0;
  };
  return aligned(tile.min.x, tile.max.x) && aligned(tile.min.y, tile.max.y) &&
         aligned(tile.min.z, tile.max.z);
}

bool is_wholly_unknown(const SnapshotLeaf& leaf) {
  return std::all_of(leaf.non_free.begin(), leaf.non_free.end(),
                     [](std::uint64_t word) { return word == ~std::uint64_t{0}; }) &&
         std::all_of(leaf.occupied.begin(), leaf.occupied.end(),
                     [](std::uint64_t word) { return word == 0; });
}

void gather(VoxelScene::Data& data) {
  const GridSnapshot& snapshot = data.snapshot;
  const Index3& base = snapshot.min_index;
  std::vector<Index3> blocks;
  const std::size_t leaves = snapshot.leaves.size(), most = leaves + snapshot.tiles.size();
  data.masks.reserve(leaves);
  data.leaf_source.reserve(leaves);
  data.has_occupied.reserve(leaves);
  data.boxes.reserve(most);
  data.block_keys.reserve(most);
  for (std::size_t i = 0; i < snapshot.leaves.size(); ++i) {
    const SnapshotLeaf& leaf = snapshot.leaves[i];
    const Index3& origin = leaf.origin;
    if (is_wholly_unknown(leaf)) {
      blocks.push_back(origin);
      continue;
    }
    detail::TraceMask mask;
    static_assert(sizeof(mask.words) == sizeof(leaf.non_free) &&
                  std::endian::native == std::endian::little);
    std::memcpy(mask.words.data(), leaf.non_free.data(), sizeof(mask.words));
    const std::uint64_t block = data.block_of(origin.x >> 3, origin.y >> 3, origin.z >> 3);
    data.masks.push_back(mask);
    data.boxes.push_back(tight_box(leaf.non_free, relative(origin, base)));
    data.block_keys.push_back(block << 9U);
    data.leaf_source.push_back(static_cast<std::uint32_t>(i));
    data.has_occupied.push_back(leaf.occupied != LeafMask{} ? 1 : 0);
    if (data.has_occupied.back() != 0) {
      data.occupied_leaves.emplace_back(block, static_cast<std::uint32_t>(i));
    }
  }
  std::sort(data.occupied_leaves.begin(), data.occupied_leaves.end());
  data.leaf_count = data.masks.size();

  std::vector<PrimitiveBox> larger;
  for (const SnapshotTile& tile : snapshot.tiles) {
    if (is_whole_block(tile)) {
      blocks.push_back(tile.min);
    } else {
      append_pieces(tile.min, tile.max, base, larger);
    }
  }
  for (const Index3& origin : blocks) {
    const auto low = relative(origin, base);
    data.boxes.push_back(
        {{low[0], low[1], low[2]}, {low[0] + 8.0F, low[1] + 8.0F, low[2] + 8.0F}, 0});
    data.block_keys.push_back(data.block_of(origin.x >> 3, origin.y >> 3, origin.z >> 3) << 9U);
  }
  data.block_count = data.boxes.size();
  data.boxes.insert(data.boxes.end(), larger.begin(), larger.end());
  if (data.boxes.size() > kMaxPrimitives) {
    throw Error(ErrorCode::capacity, "the map has " + std::to_string(data.boxes.size()) +
                                         " leaves and tiles that are not free; a scene holds " +
                                         std::to_string(kMaxPrimitives));
  }
}

}  // namespace

std::shared_ptr<const VoxelScene> VoxelScene::build(const BeliefGrid& grid,
                                                    const Obstacles& obstacles,
                                                    const ExecConfig& exec) {
  return build(grid.snapshot(), obstacles, exec);
}

std::shared_ptr<const VoxelScene> VoxelScene::build(GridSnapshot snapshot,
                                                    const Obstacles& obstacles,
                                                    const ExecConfig& exec) {
  check(obstacles);
  auto data = std::make_unique<Data>();
  data->snapshot = std::move(snapshot);
  gather(*data);
  data->scene_boxes.emplace(data->boxes);
  data->kernels = &detail::trace_kernels(detail::packet_isa());
  data->obstacles = obstacles;
  data->has_obstacles = !obstacles.boxes.empty() || !obstacles.meshes.empty();
  data->build_threads = exec.num_threads;
  if (data->has_obstacles) data->ensure_bvh();
  return std::shared_ptr<const VoxelScene>(new VoxelScene(std::move(data)));
}

std::shared_ptr<const VoxelScene> VoxelScene::update(
    const std::shared_ptr<const VoxelScene>& before, const BeliefGrid& grid,
    const ExecConfig& exec) {
  if (!before) throw Error(ErrorCode::invalid_argument, "there is no scene to update");
  return build(grid.snapshot(before->snapshot()), before->data().obstacles, exec);
}

VoxelScene::VoxelScene(std::unique_ptr<const Data> data) : data_(std::move(data)) {}
VoxelScene::~VoxelScene() = default;

const GridSnapshot& VoxelScene::snapshot() const noexcept { return data_->snapshot; }
std::string_view VoxelScene::isa() const noexcept { return isa_name(data_->kernels->isa); }
std::size_t VoxelScene::primitive_count() const noexcept { return data_->boxes.size(); }

std::uint64_t VoxelScene::bytes() const noexcept {
  return data_->masks.size() * sizeof(detail::TraceMask) +
         data_->boxes.size() * sizeof(PrimitiveBox) +
         data_->block_keys.size() * sizeof(std::uint64_t) +
         data_->leaf_source.size() * (sizeof(std::uint32_t) + sizeof(std::uint8_t)) +
         data_->occupied_leaves.size() * sizeof(data_->occupied_leaves.front());
}

std::vector<std::string> available_isas() {
  std::vector<std::string> names;
  for (const Isa isa : supported_isas()) names.emplace_back(isa_name(isa));
  return names;
}

}  // namespace viewgain
