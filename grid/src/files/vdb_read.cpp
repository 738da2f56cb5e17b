// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
// OpenVDB keeps state in its templates; with hidden visibility each library would have a copy
// (grid/README.md).
#pragma GCC visibility push(default)
#include <openvdb/tree/ValueAccessor.h>
#pragma GCC visibility pop

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "map/belief_blocks.hpp"
#include "map/belief_sum.hpp"
#include "map/map_notes.hpp"
#include "pose_text.hpp"
#include "vdb_contents.hpp"
#include "vdb_layout.hpp"
#include "vdb_rates.hpp"
#include "viewgain/core/error.hpp"
#include "viewgain/grid/vdb_io.hpp"
#include "viewgain/support/belief_block.hpp"
#include "viewgain/support/solid_voxels.hpp"
#include "viewgain/support/text.hpp"
#include "viewgain/support/thread_pool.hpp"

namespace viewgain {
namespace {

using namespace detail;
using openvdb::Coord;
using openvdb::CoordBBox;
using openvdb::FloatGrid;
using openvdb::FloatTree;
using openvdb::Vec3f;
using openvdb::Vec3SGrid;
using FloatLeaf = FloatTree::LeafNodeType;
using Vec3Leaf = openvdb::Vec3STree::LeafNodeType;

class Loader {
 public:
  Loader(std::filesystem::path path, const ExecConfig& exec)
      : path_(std::move(path)), pool_(exec.num_threads) {}

  [[nodiscard]] BeliefGrid load() {
    const VdbContents contents(path_, pool_);
    try {
      const std::int32_t version = version_of(contents.metadata);
      auto storage = make_storage(contents.metadata);
      if (version == kVdbScaledVersion) {
        scales_ = &tree<FloatGrid>(contents, *storage, kScaleGridName);
      }
      load_states(contents, *storage);
      load_beliefs(contents, *storage);
      if (scales_ != nullptr) {
        const std::string fault = take_scales(*scales_, *storage);
        if (!fault.empty()) fail("grid '" + std::string(kScaleGridName) + "': " + fault);
      }
      storage->notes = map_notes(contents.metadata, path_);
      return GridAccess::wrap(std::move(storage));
    } catch (const openvdb::Exception& error) {
      fail(std::string("OpenVDB cannot read the file: ") + error.what());
    }
  }

 private:
  [[noreturn]] void fail(const std::string& what) const {
    throw Error(ErrorCode::format, path_.string() + ": " + what);
  }

  template <typename Metadata>
  [[nodiscard]] auto value(const openvdb::MetaMap& metadata, const char* name) const {
    const auto found = metadata.getMetadata<Metadata>(name);
    if (!found) {
      fail(std::string("the file is not a viewgain map: it has no metadata '") + name +
           "' of type " + Metadata::staticTypeName());
    }
    return found->value();
  }

  [[nodiscard]] std::vector<Pose> poses(const openvdb::MetaMap& metadata, const char* name) const {
    auto result = poses_from_text(value<openvdb::StringMetadata>(metadata, name));
    if (!result) fail(std::string("metadata '") + name + "' is not a list of poses");
    return *std::move(result);
  }

  /// Layout of vdb_layout.hpp.
  [[nodiscard]] std::int32_t version_of(const openvdb::MetaMap& metadata) const {
    const auto found = value<openvdb::Int32Metadata>(metadata, "viewgain_version");
    if (found != kVdbLayoutVersion && found != kVdbScaledVersion) {
      fail("the map's viewgain_version " + std::to_string(found) +
           " is not supported; this program reads versions " + std::to_string(kVdbLayoutVersion) +
           " and " + std::to_string(kVdbScaledVersion));
    }
    return found;
  }

  [[nodiscard]] std::unique_ptr<GridStorage> make_storage(const openvdb::MetaMap& metadata) const {
    const auto low = value<openvdb::Vec3IMetadata>(metadata, "workspace_min");
    const auto high = value<openvdb::Vec3IMetadata>(metadata, "workspace_max");
    std::int32_t dims[3];
    for (int a = 0; a < 3; ++a) {
      const std::int64_t count = std::int64_t{high[a]} - low[a];
      if (count < 1 || count > std::numeric_limits<std::int32_t>::max()) {
        fail("workspace_max must be above workspace_min");
      }
      dims[a] = static_cast<std::int32_t>(count);
    }
    const std::vector<Pose> T_world_grid = poses(metadata, "T_world_grid");
    if (T_world_grid.size() != 1) fail("metadata 'T_world_grid' is not a single pose");
    try {
      auto storage = std::make_unique<GridStorage>(
          value<openvdb::DoubleMetadata>(metadata, "voxel_size"), T_world_grid.front(),
          value<openvdb::DoubleMetadata>(metadata, "prior_sigma"), Index3{low[0], low[1], low[2]},
          Index3{dims[0], dims[1], dims[2]});
      storage->views = poses(metadata, "views");
      storage->hazard = read_counters(metadata, [&](const std::string& name) {
        return value<openvdb::Int64Metadata>(metadata, name.c_str());
      });
      return storage;
    } catch (const Error& error) {
      if (error.code() == ErrorCode::format) throw;
      fail(error.what());
    }
  }

  [[nodiscard]] static bool has_grid(const VdbContents& contents, const std::string& name) {
    return std::any_of(contents.grids.begin(), contents.grids.end(),
                       [&](const auto& grid) { return grid->getName() == name; });
  }

  template <typename Grid>
  [[nodiscard]] const typename Grid::TreeType& tree(const VdbContents& contents,
                                                    const GridStorage& s,
                                                    const std::string& name) const {
    typename Grid::Ptr found;
    for (const auto& grid : contents.grids) {
      if (grid->getName() != name) continue;
      found = openvdb::gridPtrCast<Grid>(grid);
      if (!found) fail("grid '" + name + "' has values of the wrong type, " + grid->valueType());
    }
    if (!found) fail("the file is not a viewgain map: it has no grid '" + name + "'");
    CoordBBox box;
    if (found->tree().evalActiveVoxelBoundingBox(box) &&
        !(s.lattice.contains(to_index(box.min())) && s.lattice.contains(to_index(box.max())))) {
      fail("grid '" + name + "' has values outside the workspace");
    }
    const auto expected = make_transform(s);
    for (const Coord& corner : {Coord(0, 0, 0), Coord(1, 0, 0), Coord(0, 1, 0), Coord(0, 0, 1)}) {
      if ((found->indexToWorld(corner) - expected->indexToWorld(corner)).length() >
          1e-6 * s.voxel_size) {
        fail("grid '" + name + "' has a transform that contradicts voxel_size and T_world_grid");
      }
    }
    return found->tree();
  }

  [[nodiscard]] static float state_of(std::uint8_t code) { return is_occupied(code) ? 2.0F : 1.0F; }

  [[nodiscard]] static std::string where(const Coord& at) {
    return " at voxel [" + std::to_string(at.x()) + ", " + std::to_string(at.y()) + ", " +
           std::to_string(at.z()) + "]";
  }

  [[nodiscard]] std::uint8_t checked_code(const Coord& at, float log_odds, float state) const {
    if (!(log_odds > -2.001F && log_odds < 3.501F)) {
      fail("log_odds " + short_text(log_odds) + where(at) + " is not within -2 .. 3.5");
    }
    const std::uint8_t code = log_odds_code(log_odds);
    if (std::abs(code_log_odds(code) - log_odds) > 1e-4F) {
      fail("log_odds " + short_text(log_odds) + where(at) + " is not a multiple of 0.05");
    }
    if (state != state_of(code)) {
      fail("state " + short_text(state) + where(at) + " contradicts log_odds " +
           short_text(log_odds));
    }
    return code;
  }

  static constexpr const char* kOtherVoxels =
      "grids 'state' and 'log_odds' contain different voxels";

  void load_states(const VdbContents& contents, GridStorage& s) {
    const auto& log_odds = tree<FloatGrid>(contents, s, "log_odds");
    const auto& state = tree<FloatGrid>(contents, s, "state");
    if (log_odds.activeVoxelCount() != state.activeVoxelCount()) fail(kOtherVoxels);
    struct Made {
      std::unique_ptr<CodeLeaf> leaf;
      std::uint8_t first_code = kUnknownCode;
    };
    std::vector<const FloatLeaf*> leaves;
    log_odds.getNodes(leaves);
    std::vector<Made> made(leaves.size());
    for_each_leaf(leaves.size(), [&](std::size_t i) {
      std::array<std::uint8_t, kBlockVoxels> codes;
      codes.fill(kUnknownCode);
      fill_codes(*leaves[i], state, codes);
      made[i] = {GridStorage::make_leaf(to_index(leaves[i]->origin()), codes.data()), codes[0]};
    });
    for (std::size_t i = 0; i < leaves.size(); ++i) {
      if (leaves[i]->isEmpty()) continue;
      s.put_leaf(to_index(leaves[i]->origin()), std::move(made[i].leaf), made[i].first_code);
    }
    const openvdb::tree::ValueAccessor<const FloatTree, false> states(state);
    SolidVoxels solid(path_.string());
    auto tile = log_odds.cbeginValueOn();
    tile.setMaxDepth(decltype(tile)::LEAF_DEPTH - 1);
    for (; tile; ++tile) {
      const Coord at = tile.getCoord();
      // The states are also a tile, at least as large, or a node of the tile's size.
      const auto depth = static_cast<int>(tile.getDepth());
      if (states.getValueDepth(at) > depth) {
        using Upper = FloatTree::RootNodeType::ChildNodeType;
        if (depth == 0) {
          check_states(*state.probeConstNode<Upper>(at), *tile);
        } else if (depth == 1) {
          check_states(*state.probeConstNode<Upper::ChildNodeType>(at), *tile);
        } else {
          check_states(*state.probeConstLeaf(at), *tile);
        }
      }
      float value = 0;
      if (!states.probeValue(at, value)) fail(kOtherVoxels);
      load_tile(tile.getBoundingBox(), checked_code(at, *tile, value), solid, s);
    }
  }

  /// Calls body(i) for i < count in parallel. Throws the error with the lowest index.
  template <typename Body>
  void for_each_leaf(std::size_t count, const Body& body) {
    constexpr std::size_t kChunk = 64;
    try {
      pool_.for_each_chunk(count, kChunk, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) body(i);
      });
    } catch (const Error&) {
      for (std::size_t i = 0; i < count; ++i) body(i);
      throw;
    }
  }

  void fill_codes(const FloatLeaf& log_odds, const FloatTree& state,
                  std::array<std::uint8_t, kBlockVoxels>& codes) const {
    const FloatLeaf* const states = state.probeConstLeaf(log_odds.origin());
    for_each_bit(leaf_mask(log_odds.getValueMask()), [&](unsigned offset) {
      float known = 0;
      if (!probe(state, states, log_odds, offset, known)) fail(kOtherVoxels);
      const float value = log_odds.getValue(offset);
      // Nearly all values have this code; the others are checked closely.
      const bool is_within = value >= -2 && value <= 3.5F;
      const auto guess = static_cast<std::uint8_t>(is_within ? 20 * value + 41.5F : 0.0F);
      const bool is_code = code_log_odds(guess) == value && known == state_of(guess);
      codes[offset] =
          is_code ? guess : checked_code(log_odds.offsetToGlobalCoord(offset), value, known);
    });
  }

  /// Value of a tree at a voxel of another tree's leaf; `own` is its leaf there, or null.
  template <typename Tree, typename Leaf>
  [[nodiscard]] static bool probe(const Tree& tree, const typename Tree::LeafNodeType* own,
                                  const Leaf& leaf, unsigned offset,
                                  typename Tree::ValueType& value) {
    return own != nullptr ? own->probeValue(offset, value)
                          : tree.probeValue(leaf.offsetToGlobalCoord(offset), value);
  }

  // Checks the states of a node within a tile of one log-odds by the node's own tiles; single
  // voxels would take hours for a forged file of a few bytes.
  template <typename Node>
  void check_states(const Node& states, float log_odds) const {
    for (auto it = states.cbeginValueAll(); it; ++it) {
      if (!it.isValueOn()) fail(kOtherVoxels);
      (void)checked_code(it.getCoord(), log_odds, *it);
    }
    if constexpr (Node::LEVEL > 0) {
      for (auto child = states.cbeginChildOn(); child; ++child) check_states(*child, log_odds);
    }
  }

  void load_tile(const CoordBBox& box, std::uint8_t code, SolidVoxels& solid,
                 GridStorage& s) const {
    if (may_be_tile(code)) {
      s.tree.sparseFill(box, code, is_non_free(code));
      return;
    }
    if (scales_ != nullptr && put_cell(*scales_, box, code, solid, s)) return;
    solid.add(to_index(box.min()), to_index(box.max().offsetBy(1)));
    std::array<std::uint8_t, kBlockVoxels> codes;
    codes.fill(code);
    for (std::int32_t x = box.min().x(); x <= box.max().x(); x += kBlockSize) {
      for (std::int32_t y = box.min().y(); y <= box.max().y(); y += kBlockSize) {
        for (std::int32_t z = box.min().z(); z <= box.max().z(); z += kBlockSize) {
          s.put_block({x, y, z}, codes.data());
        }
      }
    }
  }

  static constexpr const char* kOtherBeliefs = "the grids of beliefs contain different voxels";

  /// The grids of beliefs.
  struct BeliefTrees {
    std::array<const openvdb::Vec3STree*, 3> parts;
    const FloatTree* hits;
    const FloatTree* hits_rest;  ///< null if there is none
  };

  void load_beliefs(const VdbContents& contents, GridStorage& s) {
    const BeliefTrees trees{
        {&tree<Vec3SGrid>(contents, s, "information_diagonal"),
         &tree<Vec3SGrid>(contents, s, "information_offdiagonal"),
         &tree<Vec3SGrid>(contents, s, "information_vector")},
        &tree<FloatGrid>(contents, s, "hits"),
        has_grid(contents, "hits_rest") ? &tree<FloatGrid>(contents, s, "hits_rest") : nullptr};
    for (const openvdb::Vec3STree* part : trees.parts) {
      if (part->activeVoxelCount() != trees.hits->activeVoxelCount()) fail(kOtherBeliefs);
    }
    if (trees.parts[0]->activeTileCount() != 0)
      fail("grid 'information_diagonal' has tiles; it must have only single voxels");
    std::vector<const Vec3Leaf*> leaves;
    trees.parts[0]->getNodes(leaves);
    std::vector<std::shared_ptr<BeliefBlock>> blocks(leaves.size());
    for_each_leaf(leaves.size(),
                  [&](std::size_t i) { blocks[i] = block_of(*leaves[i], trees, s); });
    for (std::size_t i = 0; i < leaves.size(); ++i) {
      if (blocks[i]->beliefs.empty()) continue;
      s.beliefs[s.lattice.key(to_index(leaves[i]->origin()))] = std::move(blocks[i]);
    }
  }

  [[nodiscard]] std::shared_ptr<BeliefBlock> block_of(const Vec3Leaf& leaf,
                                                      const BeliefTrees& trees,
                                                      const GridStorage& s) const {
    auto block = std::make_shared<BeliefBlock>();
    block->mask = leaf_mask(leaf.getValueMask());
    block->beliefs.reserve(leaf.onVoxelCount());
    std::array<const Vec3Leaf*, 3> parts;
    for (std::size_t part = 0; part < 3; ++part) {
      parts[part] = trees.parts[part]->probeConstLeaf(leaf.origin());
    }
    const FloatLeaf* const hits = trees.hits->probeConstLeaf(leaf.origin());
    for_each_bit(block->mask, [&](unsigned offset) {
      Belief belief;
      for (std::size_t part = 0; part < 3; ++part) {
        Vec3f value;
        if (!probe(*trees.parts[part], parts[part], leaf, offset, value)) fail(kOtherBeliefs);
        float* const to =
            part < 2 ? &belief.information[3 * part] : belief.information_vector.data();
        std::copy_n(value.asPointer(), 3, to);
      }
      const Coord at = leaf.offsetToGlobalCoord(offset);
      float rounded = 0;
      if (!probe(*trees.hits, hits, leaf, offset, rounded)) fail(kOtherBeliefs);
      const double count =
          double{rounded} +
          double{trees.hits_rest != nullptr ? trees.hits_rest->getValue(at) : 0.0F};
      constexpr double kMost = std::numeric_limits<std::int32_t>::max();
      if (!(count >= 0 && count <= kMost && count == std::floor(count))) {
        fail("grid 'hits' has the invalid count " + short_text(count));
      }
      belief.hits = static_cast<std::uint32_t>(count);
      const std::string fault = fault_of_belief(belief, s.voxel_size);
      if (!fault.empty()) fail("the belief" + where(at) + " " + fault);
      if (s.tree.getValue(at) == kUnknownCode) {
        fail("grid 'hits' has a voxel that is unknown in 'state'");
      }
      block->beliefs.push_back(definite(belief));
    });
    return block;
  }

  std::filesystem::path path_;
  ThreadPool pool_;
  const FloatTree* scales_ = nullptr;  ///< of the file; null if there are none
};

}  // namespace

BeliefGrid load_vdb(const std::filesystem::path& path, const ExecConfig& exec) {
  return Loader(path, exec).load();
}

HazardConfig::Volume load_hazard_vdb(const std::filesystem::path& path, const BeliefGrid& grid) {
  ThreadPool pool(1);
  const VdbContents contents(path, pool);
  try {
    return RateReader(path, contents).rates_in(grid);
  } catch (const openvdb::Exception& error) {
    throw Error(ErrorCode::format,
                path.string() + ": OpenVDB cannot read the file: " + error.what());
  }
}

}  // namespace viewgain
