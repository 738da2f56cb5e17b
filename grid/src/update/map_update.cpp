// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include "map_update.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <optional>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include "cone_cull.hpp"
#include "frame_hits.hpp"
#include "map/grid_storage.hpp"
#include "viewgain/core/error.hpp"
#include "viewgain/core/text.hpp"

namespace viewgain::detail {
namespace {

constexpr double kPoseTolerance = 1e-3;
constexpr double kOrthonormal = 1e-12;  // rotations nearer to orthonormal are taken as they are

// What a thread found in a region and may not put into the tree itself.
struct RegionResult {
  std::vector<std::unique_ptr<CodeLeaf>> leaves;
  std::vector<std::pair<Index3, std::uint8_t>> tiles;
  std::uint64_t crossed = 0;
  std::uint64_t hit = 0;
  bool changed = false;  // in what a snapshot tells
};

}  // namespace

Pose rigid(const Pose& pose) {
  const double error = orthonormality_error(pose);
  if (!(error <= kPoseTolerance)) {
    std::ostringstream text;
    text << "camera pose is not rigid: its rotation is off by " << error;
    throw Error(ErrorCode::invalid_argument, text.str());
  }
  return error <= kOrthonormal ? pose : orthonormalized(pose);
}

void check_plane(std::optional<double> height) {
  if (height && !std::isfinite(*height)) {
    throw Error(ErrorCode::invalid_argument,
                "support plane " + short_text(*height) + " m is not finite");
  }
}

struct MapUpdate::Impl {
  const BlockKernels& kernels;
  ThreadPool pool;
  bool literal;
  RangePyramid pyramid;
  FrameHits hits;
  FrameLines lines;
  std::vector<std::uint64_t> regions;
  std::vector<RegionResult> results;

  Impl(Occupancy occupancy, const ExecConfig& exec)
      : kernels(block_kernels(select_isa())),
        pool(exec.num_threads),
        literal(occupancy == Occupancy::literal) {}

  void list_regions(const GridStorage& s, const std::optional<ConeCull>& cull);
  void update_region(GridStorage& s, const Readings& readings, const std::optional<ConeCull>& cull,
                     const ConeCamera* camera, const Pose& T_grid_readings, std::uint64_t region,
                     RegionResult& result);
  void put_results(GridStorage& s);
};

// The regions that the frame may change, in rising order.
void MapUpdate::Impl::list_regions(const GridStorage& s, const std::optional<ConeCull>& cull) {
  std::vector<std::uint64_t> crossed;
  if (cull) {
    for (std::uint64_t node = 0; node < s.lattice.node_count(); ++node) {
      if (cull->classify(s.lattice.origin(node << 12U), kNodeSize) == CubeClass::untouched)
        continue;
      for (std::uint64_t region = node << 6U; region < (node + 1) << 6U; ++region) {
        if (s.lattice.overlaps(s.lattice.origin(region << 6U), kRegionSize))
          crossed.push_back(region);
      }
    }
  } else {
    crossed = lines.regions();
  }
  std::vector<std::uint64_t> hit;
  for (const HitBlock& block : hits.blocks()) {
    if (hit.empty() || hit.back() != block.key >> 6U) hit.push_back(block.key >> 6U);
  }
  regions.clear();
  std::set_union(crossed.begin(), crossed.end(), hit.begin(), hit.end(),
                 std::back_inserter(regions));
}

// Runs on many threads at once: writes leaves and belief blocks of this region only, and reads the
// rest of the tree, whose shape stays as it is.
void MapUpdate::Impl::update_region(GridStorage& s, const Readings& readings,
                                    const std::optional<ConeCull>& cull, const ConeCamera* camera,
                                    const Pose& T_grid_readings, std::uint64_t region,
                                    RegionResult& result) {
  const Index3 region_origin = s.lattice.origin(region << 6U);
  std::span<const HitBlock> hit_blocks = hits.in_region(region);
  const CubeClass region_class =
      cull ? cull->classify(region_origin, kRegionSize) : CubeClass::mixed;
  if (region_class == CubeClass::untouched && hit_blocks.empty()) return;

  auto* node = s.tree.probeNode<CodeNode>(to_coord(region_origin));
  const std::uint8_t node_code =
      node != nullptr ? kUnknownCode : s.tree.getValue(to_coord(region_origin));
  alignas(64) std::array<std::int8_t, kBlockVoxels> deltas;
  alignas(64) std::array<std::uint8_t, kBlockVoxels> fresh;

  for (std::uint64_t key = region << 6U; key < (region + 1) << 6U; ++key) {
    const Index3 origin = s.lattice.origin(key);
    const HitBlock* hit_block = nullptr;
    if (!hit_blocks.empty() && hit_blocks.front().key == key) {
      hit_block = &hit_blocks.front();
      hit_blocks = hit_blocks.subspan(1);
    }
    const bool whole = s.lattice.covers(origin, kBlockSize);
    if (!whole && !s.lattice.overlaps(origin, kBlockSize)) continue;

    CubeClass block_class = region_class;
    if (cull && region_class == CubeClass::mixed) block_class = cull->classify(origin, kBlockSize);
    if (block_class == CubeClass::untouched && hit_block == nullptr) continue;

    CodeLeaf* leaf = node != nullptr ? node->probeLeaf(to_coord(origin)) : nullptr;
    std::uint8_t tile_code = node_code;
    if (node != nullptr && leaf == nullptr) {
      tile_code = node->getTable()[CodeNode::coordToOffset(to_coord(origin))].getValue();
    }
    if (block_class == CubeClass::crossed && hit_block == nullptr && leaf == nullptr &&
        may_be_tile(tile_code)) {
      const std::uint8_t code = updated_code(tile_code, kMissDelta, literal);
      if (code != tile_code) result.tiles.emplace_back(origin, code);
      result.changed = result.changed || is_non_free(tile_code);
      result.crossed += whole ? kBlockVoxels : count_bits(s.lattice.clip(origin));
      continue;
    }

    bool any = block_class == CubeClass::crossed;
    if (block_class == CubeClass::mixed) {
      any = cull ? kernels.project(*camera, readings.reach_taper().data(), s.voxel_size, origin,
                                   deltas.data())
                 : lines.deltas(key, deltas.data());
    } else {
      deltas.fill(any ? kMissDelta : kNoDelta);
    }
    if (!any && hit_block == nullptr) continue;

    if (hit_block != nullptr) {
      LeafMask mask{};
      for (const Hit& hit : hits.of(*hit_block)) {
        deltas[hit.offset] = kHitDelta;  // beats a crossing
        mask[hit.offset >> 6U] |= std::uint64_t{1} << (hit.offset & 63U);
      }
      result.hit += count_bits(mask);
      *hit_block->beliefs = with_hits(hit_block->beliefs->get(), hits.of(*hit_block), readings,
                                      T_grid_readings, origin, s.voxel_size);
    }

    std::uint8_t* codes = leaf != nullptr ? leaf->buffer().data() : fresh.data();
    if (leaf == nullptr) fresh.fill(tile_code);
    LeafMask non_free;
    non_free.fill(is_non_free(tile_code) ? ~std::uint64_t{0} : 0);
    if (leaf != nullptr) non_free = leaf_mask(leaf->getValueMask());
    BlockUpdate update;
    kernels.update(deltas.data(), literal, codes, update);
    if (!whole) {
      const LeafMask inside = s.lattice.clip(origin);
      for (std::size_t i = 0; i < 8; ++i) update.crossed[i] &= inside[i];
    }
    result.crossed += count_bits(update.crossed);
    // What is free stays free when it is crossed.
    result.changed = result.changed || hit_block != nullptr ||
                     intersection(update.crossed, non_free) != LeafMask{};

    // At once, so that codes and mask agree whatever allocation fails below.
    if (leaf != nullptr) {
      for (openvdb::Index i = 0; i < 8; ++i) {
        leaf->getValueMask().getWord<std::uint64_t>(i) = update.non_free[i];
      }
    }
    if (update.uniform && may_be_tile(codes[0])) {
      if (leaf != nullptr || codes[0] != tile_code) result.tiles.emplace_back(origin, codes[0]);
      continue;
    }
    if (leaf == nullptr) {
      // At the rim of the workspace perhaps only because of voxels outside.
      result.changed = result.changed || is_non_free(tile_code);
      result.leaves.push_back(std::make_unique<CodeLeaf>(to_coord(origin), kUnknownCode, true));
      leaf = result.leaves.back().get();
      std::copy(fresh.begin(), fresh.end(), leaf->buffer().data());
      for (openvdb::Index i = 0; i < 8; ++i) {
        leaf->getValueMask().getWord<std::uint64_t>(i) = update.non_free[i];
      }
    }
  }
}

// Blocks that changed between leaf and tile, and nodes that became uniform.
void MapUpdate::Impl::put_results(GridStorage& s) {
  for (std::size_t i = 0; i < regions.size(); ++i) {
    RegionResult& result = results[i];
    if (result.leaves.empty() && result.tiles.empty()) continue;
    const Index3 origin = s.lattice.origin(regions[i] << 6U);
    auto* node = s.tree.probeNode<CodeNode>(to_coord(origin));
    if (node == nullptr) {
      // A tile of the same value one level down makes the nodes above it.
      const std::uint8_t code = s.tree.getValue(to_coord(origin));
      s.tree.addTile(kBlockTileLevel, to_coord(origin), code, is_non_free(code));
      node = s.tree.probeNode<CodeNode>(to_coord(origin));
    }
    for (auto& leaf : result.leaves) node->addLeaf(leaf.release());
    for (const auto& [at, code] : result.tiles) {
      node->addTile(kBlockTileLevel, to_coord(at), code, is_non_free(code));
    }
    result.leaves.clear();
    result.tiles.clear();
  }
  for (std::size_t i = 0; i < regions.size(); ++i) {
    if (i + 1 < regions.size() && regions[i] >> 6U == regions[i + 1] >> 6U) continue;
    const openvdb::Coord origin = to_coord(s.lattice.origin(regions[i] << 6U));
    const auto* node = s.tree.probeConstNode<CodeNode>(origin);
    std::uint8_t code = 0;
    bool active = false;
    if (node != nullptr && node->isConstant(code, active)) {
      s.tree.addTile(kNodeTileLevel, origin, code, active);
    }
  }
}

MapUpdate::MapUpdate(Occupancy occupancy, const ExecConfig& exec)
    : impl_(std::make_unique<Impl>(occupancy, exec)) {}
MapUpdate::~MapUpdate() = default;
MapUpdate::MapUpdate(MapUpdate&&) noexcept = default;
MapUpdate& MapUpdate::operator=(MapUpdate&&) noexcept = default;

ThreadPool& MapUpdate::pool() { return impl_->pool; }

IntegrationReport MapUpdate::run(BeliefGrid& grid, const Readings& readings,
                                 const Pose& T_grid_readings, const Pose& view,
                                 const ConeCamera* camera) {
  Impl& m = *impl_;
  GridStorage& s = GridAccess::storage(grid);
  std::optional<ConeCull> cull;
  m.hits.find(readings, s.lattice, s.voxel_size, T_grid_readings, m.pool);
  if (camera != nullptr) {
    cull.emplace(*camera, m.pyramid, s.voxel_size);
    m.pyramid.build(readings.reach_taper(), camera->width, camera->height);
  } else {
    m.lines.walk(readings, s.lattice, s.voxel_size, T_grid_readings, m.pool);
  }
  m.list_regions(s, cull);

  const auto empty = std::make_shared<const BeliefBlock>();
  try {
    // Entries are made here, alone; the map's values do not move when it grows.
    for (HitBlock& block : m.hits.blocks()) {
      block.beliefs = &s.beliefs.try_emplace(block.key, empty).first->second;
    }
    if (m.results.size() < m.regions.size()) m.results.resize(m.regions.size());
    for (std::size_t i = 0; i < m.regions.size(); ++i) {
      m.results[i].crossed = m.results[i].hit = 0;
      m.results[i].changed = false;
    }
    m.pool.for_each_chunk(m.regions.size(), 1, [&](std::size_t i, std::size_t) {
      m.update_region(s, readings, cull, camera, T_grid_readings, m.regions[i], m.results[i]);
    });
    m.put_results(s);
    for (std::size_t i = 0; i < m.regions.size(); ++i) {
      if (m.results[i].changed) s.mark_changed(m.regions[i] << 6U);
    }
    s.views.push_back(view);
  } catch (...) {
    // Memory ran out with some regions written. Nothing that a snapshot told before holds for sure,
    // and what waits to be put into the tree is not for another frame's regions.
    s.forget_snapshots();
    for (RegionResult& result : m.results) result = {};
    for (const HitBlock& block : m.hits.blocks()) {
      const auto found = s.beliefs.find(block.key);
      if (found != s.beliefs.end() && found->second == empty) s.beliefs.erase(found);
    }
    throw;
  }
  ++s.time;

  IntegrationReport report;
  for (const PixelKind kind : readings.kinds()) {
    ++(kind == PixelKind::reading        ? report.readings
       : kind == PixelKind::on_plane     ? report.plane_readings
       : kind == PixelKind::out_of_range ? report.out_of_range
                                         : report.invalid);
  }
  report.readings_inside = m.hits.size();
  for (std::size_t i = 0; i < m.regions.size(); ++i) {
    report.voxels_hit += m.results[i].hit;
    report.voxels_crossed += m.results[i].crossed;
  }
  return report;
}

}  // namespace viewgain::detail
