// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
// OpenVDB keeps state in its templates: hidden, each library would have its own (grid/README.md).
#pragma GCC visibility push(default)
#include <openvdb/tree/ValueAccessor.h>
#pragma GCC visibility pop

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <string>
#include <utility>

#include "map/belief_check.hpp"
#include "pose_text.hpp"
#include "vdb_contents.hpp"
#include "vdb_layout.hpp"
#include "vdb_rates.hpp"
#include "viewgain/core/error.hpp"
#include "viewgain/grid/vdb_io.hpp"
#include "viewgain/support/belief_block.hpp"
#include "viewgain/support/solid_voxels.hpp"
#include "viewgain/support/text.hpp"

namespace viewgain {
namespace {

using namespace detail;
using openvdb::Coord;
using openvdb::CoordBBox;
using openvdb::FloatGrid;
using openvdb::FloatTree;
using openvdb::Vec3f;
using openvdb::Vec3SGrid;

class Loader {
 public:
  explicit Loader(std::filesystem::path path) : path_(std::move(path)) {}

  [[nodiscard]] BeliefGrid load(std::map<std::string, std::string>* notes) const {
    const VdbContents contents(path_);
    try {
      check_version(*contents.metadata);
      auto storage = make_storage(*contents.metadata);
      load_states(contents, *storage);
      load_beliefs(contents, *storage);
      if (notes != nullptr) *notes = notes_of(*contents.metadata);
      return GridAccess::wrap(std::move(storage));
    } catch (const openvdb::Exception& error) {
      fail(std::string("cannot be read by OpenVDB: ") + error.what());
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
      fail(std::string("has no metadata '") + name + "' of type " + Metadata::staticTypeName() +
           ": it is no viewgain map");
    }
    return found->value();
  }

  [[nodiscard]] std::vector<Pose> poses(const openvdb::MetaMap& metadata, const char* name) const {
    auto result = poses_from_text(value<openvdb::StringMetadata>(metadata, name));
    if (!result) fail(std::string("metadata '") + name + "' is no list of poses");
    return *std::move(result);
  }

  [[nodiscard]] std::map<std::string, std::string> notes_of(
      const openvdb::MetaMap& metadata) const {
    std::map<std::string, std::string> notes;
    for (auto entry = metadata.beginMeta(); entry != metadata.endMeta(); ++entry) {
      const std::string& name = entry->first;
      const auto text = metadata.getMetadata<openvdb::StringMetadata>(name);
      if (name.starts_with(kNotePrefix) && text) {
        notes[name.substr(kNotePrefix.size())] = text->value();
      }
    }
    return notes;
  }

  /// Of the layout (vdb_layout.hpp).
  void check_version(const openvdb::MetaMap& metadata) const {
    const auto found = value<openvdb::Int32Metadata>(metadata, "viewgain_version");
    if (found != kVdbLayoutVersion) {
      fail("has viewgain_version " + std::to_string(found) + ", this program reads " +
           std::to_string(kVdbLayoutVersion));
    }
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
    if (T_world_grid.size() != 1) fail("metadata 'T_world_grid' is not one pose");
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
    return std::any_of(contents.grids->begin(), contents.grids->end(),
                       [&](const auto& grid) { return grid->getName() == name; });
  }

  template <typename Grid>
  [[nodiscard]] const typename Grid::TreeType& tree(const VdbContents& contents,
                                                    const GridStorage& s,
                                                    const std::string& name) const {
    typename Grid::Ptr found;
    for (const auto& grid : *contents.grids) {
      if (grid->getName() != name) continue;
      found = openvdb::gridPtrCast<Grid>(grid);
      if (!found) fail("grid '" + name + "' has values of type " + grid->valueType());
    }
    if (!found) fail("has no grid '" + name + "': it is no viewgain map");
    CoordBBox box;
    if (found->tree().evalActiveVoxelBoundingBox(box) &&
        !(s.lattice.contains(to_index(box.min())) && s.lattice.contains(to_index(box.max())))) {
      fail("grid '" + name + "' has values outside the workspace");
    }
    const auto expected = make_transform(s);
    for (const Coord& corner : {Coord(0, 0, 0), Coord(1, 0, 0), Coord(0, 1, 0), Coord(0, 0, 1)}) {
      if ((found->indexToWorld(corner) - expected->indexToWorld(corner)).length() >
          1e-6 * s.voxel_size) {
        fail("grid '" + name + "' has another transform than voxel_size and T_world_grid say");
      }
    }
    return found->tree();
  }

  [[nodiscard]] std::uint8_t checked_code(const Coord& at, float log_odds, float state) const {
    const auto where = [&at] {
      return " at voxel [" + std::to_string(at.x()) + ", " + std::to_string(at.y()) + ", " +
             std::to_string(at.z()) + "]";
    };
    if (!(log_odds > -2.001F && log_odds < 3.501F)) {
      fail("log_odds " + short_text(log_odds) + where() + " is not within -2 .. 3.5");
    }
    const std::uint8_t code = log_odds_code(log_odds);
    if (std::abs(code_log_odds(code) - log_odds) > 1e-4F) {
      fail("log_odds " + short_text(log_odds) + where() + " is no multiple of 0.05");
    }
    if (state != (is_occupied(code) ? 2.0F : 1.0F)) {
      fail("state " + short_text(state) + where() + " contradicts log_odds " +
           short_text(log_odds));
    }
    return code;
  }

  void load_states(const VdbContents& contents, GridStorage& s) const {
    const auto& log_odds = tree<FloatGrid>(contents, s, "log_odds");
    const auto& state = tree<FloatGrid>(contents, s, "state");
    if (log_odds.activeVoxelCount() != state.activeVoxelCount()) {
      fail("grids 'state' and 'log_odds' do not know the same voxels");
    }
    const openvdb::tree::ValueAccessor<const FloatTree, false> states(state);
    const auto state_at = [&](const Coord& at) {
      float found = 0;
      if (!states.probeValue(at, found)) {
        fail("grids 'state' and 'log_odds' do not know the same voxels");
      }
      return found;
    };

    std::array<std::uint8_t, kBlockVoxels> codes;
    for (auto leaf = log_odds.cbeginLeaf(); leaf; ++leaf) {
      codes.fill(kUnknownCode);
      bool any = false;
      for (auto it = leaf->cbeginValueOn(); it; ++it) {
        codes[it.pos()] = checked_code(it.getCoord(), *it, state_at(it.getCoord()));
        any = true;
      }
      if (any) s.put_block(to_index(leaf->origin()), codes.data());
    }
    SolidVoxels solid(path_.string());
    auto tile = log_odds.cbeginValueOn();
    tile.setMaxDepth(decltype(tile)::LEAF_DEPTH - 1);
    for (; tile; ++tile) {
      const Coord at = tile.getCoord();
      // The states are a tile too, as large or larger, or a node of the tile's size.
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
      load_tile(tile.getBoundingBox(), checked_code(at, *tile, state_at(at)), solid, s);
    }
  }

  // Looks at the states of a node in a tile of one log-odds, by the node's own tiles: one by one,
  // the voxels of a few forged bytes would take hours.
  template <typename Node>
  void check_states(const Node& states, float log_odds) const {
    for (auto it = states.cbeginValueAll(); it; ++it) {
      if (!it.isValueOn()) fail("grids 'state' and 'log_odds' do not know the same voxels");
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

  /// The hits of a voxel, whichever grids say them.
  class Hits {
   public:
    Hits(const Loader& loader, const VdbContents& contents, const GridStorage& s)
        : loader_(loader), hits_(loader.tree<FloatGrid>(contents, s, "hits")) {
      if (loader.has_grid(contents, "hits_rest")) {
        rest_ = &loader.tree<FloatGrid>(contents, s, "hits_rest");
      }
    }

    [[nodiscard]] std::uint64_t voxels() const { return hits_.activeVoxelCount(); }

    [[nodiscard]] std::uint32_t at(const Coord& voxel) const {
      float rounded = 0;
      if (!hits_.probeValue(voxel, rounded)) {
        loader_.fail("the grids of beliefs do not hold the same voxels");
      }
      const double hits =
          double{rounded} + double{rest_ != nullptr ? rest_->getValue(voxel) : 0.0F};
      constexpr double kMost = std::numeric_limits<std::int32_t>::max();
      if (!(hits >= 0 && hits <= kMost && hits == std::floor(hits))) {
        loader_.fail("grid 'hits' has the count " + short_text(hits));
      }
      return static_cast<std::uint32_t>(hits);
    }

   private:
    const Loader& loader_;
    const FloatTree& hits_;
    const FloatTree* rest_ = nullptr;
  };

  void load_beliefs(const VdbContents& contents, GridStorage& s) const {
    const Hits hits(*this, contents, s);
    const std::array<const openvdb::Vec3STree*, 3> parts{
        &tree<Vec3SGrid>(contents, s, "information_diagonal"),
        &tree<Vec3SGrid>(contents, s, "information_offdiagonal"),
        &tree<Vec3SGrid>(contents, s, "information_vector")};
    for (const openvdb::Vec3STree* part : parts) {
      if (part->activeVoxelCount() != hits.voxels()) {
        fail("the grids of beliefs do not hold the same voxels");
      }
    }
    if (parts[0]->activeTileCount() != 0) fail("grid 'information_diagonal' has tiles");
    for (auto leaf = parts[0]->cbeginLeaf(); leaf; ++leaf) {
      if (leaf->isEmpty()) continue;
      auto block = std::make_shared<BeliefBlock>();
      for (openvdb::Index i = 0; i < 8; ++i) {
        block->mask[i] = leaf->getValueMask().getWord<std::uint64_t>(i);
      }
      block->beliefs.reserve(leaf->onVoxelCount());
      for (auto it = leaf->cbeginValueOn(); it; ++it) {
        block->beliefs.push_back(
            checked_belief(it.getCoord(), hits.at(it.getCoord()), parts, s.voxel_size));
        if (s.tree.getValue(it.getCoord()) == kUnknownCode) {
          fail("grid 'hits' has a voxel that is unknown in 'state'");
        }
      }
      s.beliefs[s.lattice.key(to_index(leaf->cbeginValueOn().getCoord()))] = std::move(block);
    }
  }

  [[nodiscard]] Belief checked_belief(const Coord& at, std::uint32_t hits,
                                      const std::array<const openvdb::Vec3STree*, 3>& parts,
                                      double voxel_size) const {
    Belief belief;
    for (std::size_t part = 0; part < 3; ++part) {
      Vec3f value;
      if (!parts[part]->probeValue(at, value))
        fail("the grids of beliefs do not hold the same voxels");
      for (int i = 0; i < 3; ++i) {
        const auto position = static_cast<std::size_t>(i);
        if (part < 2) belief.information[3 * part + position] = value[i];
        if (part == 2) belief.information_vector[position] = value[i];
      }
    }
    belief.hits = hits;
    const std::string fault = fault_of_belief(belief, voxel_size);
    if (!fault.empty()) {
      fail("belief at voxel [" + std::to_string(at.x()) + ", " + std::to_string(at.y()) + ", " +
           std::to_string(at.z()) + "] " + fault);
    }
    return belief;
  }

  std::filesystem::path path_;
};

}  // namespace

BeliefGrid load_vdb(const std::filesystem::path& path, std::map<std::string, std::string>* notes) {
  return Loader(path).load(notes);
}

HazardConfig::Volume load_hazard_vdb(const std::filesystem::path& path, const BeliefGrid& grid) {
  const VdbContents contents(path);
  try {
    return RateReader(path, contents).rates_in(grid);
  } catch (const openvdb::Exception& error) {
    throw Error(ErrorCode::format, path.string() + ": cannot be read by OpenVDB: " + error.what());
  }
}

}  // namespace viewgain
