// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include "viewgain/grid/belief_grid.hpp"

#include <algorithm>
#include <array>
#include <atomic>
#include <cstring>
#include <utility>

#include "belief_blocks.hpp"
#include "code_mask.hpp"
#include "grid_layout.hpp"
#include "grid_storage.hpp"
#include "leaf_scales.hpp"
#include "map_notes.hpp"
#include "viewgain/support/belief_block.hpp"
#include "viewgain/support/block_lattice.hpp"
#include "viewgain/support/state_reader.hpp"

namespace viewgain {
namespace {

using namespace detail;

std::unique_ptr<GridStorage> make_storage(const GridConfig& config, const Sensor& sensor) {
  const auto [low, dims] = layout_of(config);
  const double prior = config.prior_sigma.value_or(default_prior_sigma(config.voxel_size, sensor));
  return std::make_unique<GridStorage>(config.voxel_size, config.T_world_grid, prior, low, dims);
}

std::uint64_t tree_bytes(const CodeTree& tree) {
  std::uint64_t bytes = sizeof(CodeTree);
  const auto& root = tree.root();
  // A map node: key, entry, and the links and colour of the red-black tree.
  bytes += root.getTableSize() * (sizeof(openvdb::Coord) + 2 * sizeof(void*) + 4 * sizeof(void*));
  for (auto upper = root.cbeginChildOn(); upper; ++upper) {
    bytes += sizeof(CodeUpper);
    for (auto node = upper->cbeginChildOn(); node; ++node) {
      bytes += sizeof(CodeNode) +
               std::uint64_t{node->getChildMask().countOn()} * (sizeof(CodeLeaf) + kBlockVoxels);
    }
  }
  return bytes;
}

}  // namespace

LeafMask detail::occupied_in(const BeliefGrid& grid, Index3 origin) {
  LeafMask mask{};
  const CodeTree& tree = GridAccess::storage(grid).tree;
  if (const CodeLeaf* leaf = tree.probeConstLeaf(to_coord(origin))) {
    mask = occupied_mask(leaf->buffer().data());
  } else if (is_occupied(tree.getValue(to_coord(origin)))) {
    mask.fill(~std::uint64_t{0});
  }
  return mask;
}
const BeliefMap& detail::beliefs_of(const BeliefGrid& grid) {
  return GridAccess::storage(grid).beliefs;
}

std::uint64_t detail::GridStorage::next_number() {
  static std::atomic<std::uint64_t> last{0};
  return ++last;
}

std::unique_ptr<detail::GridStorage> detail::GridStorage::copy() const {
  auto result = std::make_unique<GridStorage>(*this);
  result->copy_of = number;
  result->copied_at = time;
  result->number = next_number();
  return result;
}

detail::GridStorage::GridStorage(double voxel_size_in, const Pose& T_world_grid_in,
                                 double prior_sigma_in, Index3 min_index_in, Index3 dims_in)
    : voxel_size(voxel_size_in),
      T_world_grid(T_world_grid_in),
      prior_sigma(prior_sigma_in),
      min_index(min_index_in),
      dims(dims_in),
      lattice(BlockLattice({0, 0, 0}, {1, 1, 1})) {
  check_layout(voxel_size, T_world_grid, prior_sigma, {min_index, dims});
  lattice = BlockLattice(min_index, dims);

  constexpr std::int32_t kSpan = CodeUpper::DIM;
  const auto down = [](std::int32_t v) { return v & ~(kSpan - 1); };
  const auto up = [&](std::int32_t v) { return down(v - 1) + kSpan - 1; };
  tree.sparseFill(
      openvdb::CoordBBox({down(lattice.min.x), down(lattice.min.y), down(lattice.min.z)},
                         {up(lattice.max.x), up(lattice.max.y), up(lattice.max.z)}),
      kUnknownCode, true);
}

std::unique_ptr<detail::CodeLeaf> detail::GridStorage::make_leaf(Index3 origin,
                                                                 const std::uint8_t* codes) {
  const bool uniform =
      std::all_of(codes, codes + kBlockVoxels, [&](std::uint8_t code) { return code == codes[0]; });
  if (uniform && may_be_tile(codes[0])) return nullptr;
  auto leaf = std::make_unique<CodeLeaf>(to_coord(origin), kUnknownCode, true);
  std::memcpy(leaf->buffer().data(), codes, kBlockVoxels);
  const LeafMask known = known_mask(codes), occupied = occupied_mask(codes);
  for (openvdb::Index i = 0; i < 8; ++i) {
    leaf->getValueMask().getWord<std::uint64_t>(i) = ~known[i] | occupied[i];
  }
  return leaf;
}

void detail::GridStorage::put_leaf(Index3 origin, std::unique_ptr<CodeLeaf> leaf,
                                   std::uint8_t code) {
  if (leaf == nullptr) {
    tree.addTile(kBlockTileLevel, to_coord(origin), code, is_non_free(code));
  } else {
    tree.addLeaf(leaf.release());
  }
}

bool detail::GridStorage::is_held(std::uint64_t key) const {
  const openvdb::Coord at = to_coord(lattice.origin(key));
  return beliefs.contains(key) || tree.probeConstLeaf(at) != nullptr ||
         is_occupied(tree.getValue(at));
}

void detail::GridStorage::fold_cell(std::uint64_t key) {
  if (scale(key) != kMaxScale) return;
  const Index3 origin = lattice.origin(key);
  if (const CodeLeaf* leaf = tree.probeConstLeaf(to_coord(origin))) {
    put_leaf(origin, nullptr, leaf->buffer().data()[0]);
  }
}

std::uint64_t detail::GridStorage::bytes() const {
  std::uint64_t bytes = sizeof(GridStorage) + tree_bytes(tree) + views.capacity() * sizeof(Pose);
  // Each map entry: its node (link, key, pointer), its bucket and the shared block.
  constexpr std::size_t kSharedCounts = 2 * sizeof(void*);
  for (const auto& [key, block] : beliefs) {
    bytes += sizeof(void*) + sizeof(std::pair<std::uint64_t, std::shared_ptr<BeliefBlock>>) +
             kSharedCounts + sizeof(BeliefBlock) + block->beliefs.capacity() * sizeof(Belief);
  }
  constexpr std::size_t kScaleNode = sizeof(void*) + sizeof(std::pair<std::uint64_t, std::uint8_t>);
  bytes += scales.size() * kScaleNode;
  if (!scales.empty()) bytes += scales.bucket_count() * sizeof(void*);
  return bytes + beliefs.bucket_count() * sizeof(void*);
}

BeliefGrid::BeliefGrid(std::unique_ptr<GridStorage> storage) : storage_(std::move(storage)) {}
BeliefGrid::BeliefGrid(const GridConfig& c, const Sensor& s) : storage_(make_storage(c, s)) {}
BeliefGrid::~BeliefGrid() = default;
BeliefGrid::BeliefGrid(BeliefGrid&&) noexcept = default;
BeliefGrid& BeliefGrid::operator=(BeliefGrid&&) noexcept = default;

BeliefGrid BeliefGrid::clone() const {
  // Belief blocks are immutable, so they can be shared.
  return BeliefGrid(storage_->copy());
}

double BeliefGrid::voxel_size() const noexcept { return storage_->voxel_size; }
const Pose& BeliefGrid::T_world_grid() const noexcept { return storage_->T_world_grid; }
double BeliefGrid::prior_sigma() const noexcept { return storage_->prior_sigma; }
Index3 BeliefGrid::min_index() const noexcept { return storage_->min_index; }
Index3 BeliefGrid::dims() const noexcept { return storage_->dims; }
const std::vector<Pose>& BeliefGrid::views() const noexcept { return storage_->views; }
void BeliefGrid::append_view(const Pose& T_world_camera) {
  storage_->views.push_back(rigid_view(T_world_camera));
}

const HazardCounters& BeliefGrid::hazard_counters() const noexcept { return storage_->hazard; }
void BeliefGrid::set_hazard_counters(const HazardCounters& counters) {
  check_counters(counters);
  storage_->hazard = counters;
}

const MapNotes& BeliefGrid::notes() const noexcept { return storage_->notes; }
void BeliefGrid::set_notes(MapNotes notes) {
  detail::check_notes(notes);
  storage_->notes = std::move(notes);
}

Box BeliefGrid::workspace() const noexcept {
  const BlockLattice& l = storage_->lattice;
  const double V = storage_->voxel_size;
  return {{l.min.x * V, l.min.y * V, l.min.z * V}, {l.max.x * V, l.max.y * V, l.max.z * V}};
}

std::uint64_t BeliefGrid::voxel_count() const noexcept {
  const Index3 d = storage_->dims;
  return static_cast<std::uint64_t>(d.x) * static_cast<std::uint64_t>(d.y) *
         static_cast<std::uint64_t>(d.z);
}

std::optional<Index3> BeliefGrid::index_of(const Eigen::Vector3d& p_world) const {
  return storage_->lattice.voxel_at(storage_->T_world_grid.inverse() * p_world /
                                    storage_->voxel_size);
}
Eigen::Vector3d BeliefGrid::center(Index3 voxel) const {
  return storage_->T_world_grid * voxel_center(voxel, storage_->voxel_size);
}

VoxelState BeliefGrid::state(Index3 voxel) const {
  if (!storage_->lattice.contains(voxel)) return VoxelState::unknown;
  return code_state(storage_->tree.getValue(to_coord(voxel)));
}

void StateReader::enter(Index3 block) {
  const CodeTree& tree = GridAccess::storage(grid_).tree;
  const openvdb::Coord origin(block.x * 8, block.y * 8, block.z * 8);
  const CodeLeaf* leaf = tree.probeConstLeaf(origin);
  codes_ = leaf != nullptr ? leaf->buffer().data() : nullptr;
  if (leaf == nullptr) tile_code_ = tree.getValue(origin);
  block_ = block;
}

std::optional<float> BeliefGrid::log_odds(Index3 voxel) const {
  if (!storage_->lattice.contains(voxel)) return std::nullopt;
  const std::uint8_t code = storage_->tree.getValue(to_coord(voxel));
  if (code == kUnknownCode) return std::nullopt;
  return code_log_odds(code);
}

std::optional<Belief> BeliefGrid::belief(Index3 voxel) const {
  if (!storage_->lattice.contains(voxel)) return std::nullopt;
  const BeliefBlock* block = storage_->find_beliefs(storage_->lattice.key(voxel));
  const Belief* found = block != nullptr ? block->find(block_offset(voxel)) : nullptr;
  return found != nullptr ? std::optional<Belief>(*found) : std::nullopt;
}

std::uint64_t BeliefGrid::forget(const Box& region) {
  GridStorage& s = *storage_;
  for (std::size_t a = 0; a < 3; ++a) {
    if (region.min[a] > region.max[a]) {
      refuse(std::string("forget: the region is inside out along ") + "xyz"[a] +
             ": it extends from " + short_text(region.min[a]) + " to " + short_text(region.max[a]) +
             " m");
    }
  }
  VoxelBox range = voxels_in(*this, region);
  int coarsest = 0;
  for (const auto& [key, scale] : s.scales) coarsest = std::max<int>(coarsest, scale);
  if (coarsest > 0 && range.volume() > 0) {
    const std::int32_t low = (1 << coarsest) - 1;
    range = s.lattice.intersection(
        {{range.min.x & ~low, range.min.y & ~low, range.min.z & ~low},
         {(range.max.x + low) & ~low, (range.max.y + low) & ~low, (range.max.z + low) & ~low}});
  }
  const auto part_of = [&](Index3 origin, int size) {
    return range.intersection(VoxelBox::from_dims(origin, {size, size, size}));
  };
  // Collect first: the tree must not change during the visit.
  std::vector<VoxelBox> known_tiles;
  std::vector<Index3> leaves;
  visit_blocks(
      s,
      [&](const CodeLeaf&, Index3 origin) {
        if (part_of(origin, kBlockSize).volume() > 0) leaves.push_back(origin);
      },
      [&](Index3 origin, int size, std::uint8_t code) {
        const VoxelBox part = part_of(origin, size);
        if (code != kUnknownCode && part.volume() > 0) known_tiles.push_back(part);
      });

  std::uint64_t forgotten = 0;
  for (const VoxelBox& part : known_tiles) {
    forgotten += part.volume();
    const auto region_of = [](std::int32_t v) { return v & ~(kRegionSize - 1); };
    for (std::int32_t x = region_of(part.min.x); x < part.max.x; x += kRegionSize) {
      for (std::int32_t y = region_of(part.min.y); y < part.max.y; y += kRegionSize) {
        for (std::int32_t z = region_of(part.min.z); z < part.max.z; z += kRegionSize) {
          s.mark_changed(s.lattice.key({x, y, z}));
        }
      }
    }
    s.tree.sparseFill({to_coord(part.min), {part.max.x - 1, part.max.y - 1, part.max.z - 1}},
                      kUnknownCode, true);
  }
  for (const Index3& origin : leaves) {
    std::array<std::uint8_t, kBlockVoxels> codes;
    std::memcpy(codes.data(), s.tree.probeConstLeaf(to_coord(origin))->buffer().data(),
                kBlockVoxels);
    std::uint64_t known = 0;
    for_each_bit(block_mask(range, origin), [&](unsigned offset) {
      known += codes[offset] != kUnknownCode ? 1U : 0U;
      codes[offset] = kUnknownCode;
    });
    if (known == 0) continue;
    forgotten += known;
    s.mark_changed(s.lattice.key(origin));
    s.put_block(origin, codes.data());
  }
  for (auto entry = s.beliefs.begin(); entry != s.beliefs.end();) {
    const BeliefBlock& block = *entry->second;
    LeafMask left = block_mask(range, s.lattice.origin(entry->first));
    for (std::size_t i = 0; i < left.size(); ++i) left[i] = block.mask[i] & ~left[i];
    if (left == LeafMask{}) {
      entry = s.beliefs.erase(entry);
      continue;
    }
    if (left != block.mask) entry->second = reshaped(&block, left);
    ++entry;
  }
  drop_idle_scales(s);
  ++s.time;
  return forgotten;
}

void BeliefGrid::for_each_belief(const std::function<void(Index3, const Belief&)>& visit) const {
  for (const BeliefBlockAt& block : belief_blocks(*this)) block.for_each(visit);
}

void BeliefGrid::for_each_occupied(
    const std::function<void(const BeliefGrid::VoxelValue&)>& visit) const {
  const GridSnapshot now = snapshot();
  for (const GridSnapshot::Leaf& leaf : now.leaves) {
    if (leaf.occupied == LeafMask{}) continue;
    const CodeLeaf* codes = storage_->tree.probeConstLeaf(to_coord(leaf.origin));
    const std::uint8_t tile_code = storage_->tree.getValue(to_coord(leaf.origin));
    const int scale = storage_->scale(storage_->lattice.key(leaf.origin));
    for_each_bit(leaf.occupied, [&](unsigned offset) {
      if (cell_offset(offset, scale) != offset) return;
      const Belief* belief = leaf.beliefs != nullptr ? leaf.beliefs->find(offset) : nullptr;
      visit({offset_voxel(leaf.origin, offset),
             code_log_odds(codes != nullptr ? codes->getValue(offset) : tile_code),
             belief != nullptr ? std::optional(*belief) : std::nullopt});
    });
  }
}

void put_block(BeliefGrid& grid, Index3 origin, const std::uint8_t* codes) {
  GridStorage& s = GridAccess::storage(grid);
  s.mark_changed(s.lattice.key(origin));
  s.put_block(origin, codes);
  ++s.time;
}

void fill_cube(BeliefGrid& grid, Index3 origin, std::int32_t size, std::uint8_t code) {
  GridStorage& s = GridAccess::storage(grid);
  if (!s.lattice.overlaps(origin, size)) return;
  if (size <= kRegionSize) {
    s.mark_changed(s.lattice.key(block_origin(clipped(s.lattice, origin, size).min)));
    ++s.time;
  } else {
    s.forget_snapshots();  // a mark per region of a large cube would cost more than it saves
  }
  // The part in the workspace, extended to whole blocks or, for large cubes, whole nodes.
  const std::int32_t unit = may_be_tile(code) && size > kNodeSize ? kNodeSize : kBlockSize;
  const VoxelBox part = clipped(s.lattice, origin, size);
  const auto down = [&](std::int32_t v) { return v & ~(unit - 1); };
  const auto up = [&](std::int32_t v) { return down(v - 1) + unit; };
  const Index3 from{down(part.min.x), down(part.min.y), down(part.min.z)};
  const Index3 to{up(part.max.x), up(part.max.y), up(part.max.z)};
  if (may_be_tile(code)) {
    s.tree.sparseFill({to_coord(from), {to.x - 1, to.y - 1, to.z - 1}}, code, is_non_free(code));
    return;
  }
  std::array<std::uint8_t, kBlockVoxels> codes;
  codes.fill(code);
  for (std::int32_t x = from.x; x < to.x; x += kBlockSize) {
    for (std::int32_t y = from.y; y < to.y; y += kBlockSize) {
      for (std::int32_t z = from.z; z < to.z; z += kBlockSize) s.put_block({x, y, z}, codes.data());
    }
  }
}

void visit_grid(const BeliefGrid& grid,
                const std::function<void(Index3, const std::uint8_t*)>& block,
                const std::function<void(Index3, std::int32_t, std::uint8_t)>& cube) {
  visit_blocks(
      GridAccess::storage(grid),
      [&](const CodeLeaf& leaf, Index3 origin) { block(origin, leaf.buffer().data()); },
      [&](Index3 origin, int size, std::uint8_t code) {
        if (may_be_tile(code)) {
          cube(origin, size, code);
        } else {
          std::array<std::uint8_t, kBlockVoxels> codes;
          codes.fill(code);
          block(origin, codes.data());
        }
      });
}

namespace detail {

const BeliefBlock* find_beliefs(const BeliefGrid& grid, Index3 voxel) {
  const GridStorage& s = GridAccess::storage(grid);
  return s.find_beliefs(s.lattice.key(voxel));
}

MapNotes& notes_to_change(BeliefGrid& grid) noexcept { return GridAccess::storage(grid).notes; }

std::uint64_t bytes_of(const BeliefGrid& grid) { return GridAccess::storage(grid).bytes(); }

}  // namespace detail

}  // namespace viewgain
