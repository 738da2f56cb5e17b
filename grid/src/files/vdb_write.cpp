// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
// OpenVDB keeps state in its templates; with hidden visibility each library would have a copy
// (grid/README.md).
#pragma GCC visibility push(default)
#include <openvdb/io/Archive.h>
#include <openvdb/tree/ValueAccessor.h>
#pragma GCC visibility pop

#include <cmath>
#include <memory>
#include <new>
#include <sstream>
#include <string>
#include <utility>

#include "map/code_mask.hpp"
#include "map/map_notes.hpp"
#include "pose_text.hpp"
#include "vdb_layout.hpp"
#include "vdb_seal.hpp"
#include "viewgain/core/error.hpp"
#include "viewgain/grid/vdb_io.hpp"
#include "viewgain/support/atomic_file.hpp"
#include "viewgain/support/belief_block.hpp"
#include "viewgain/support/file_names.hpp"

namespace viewgain {
namespace {

using namespace detail;
using openvdb::FloatGrid;
using openvdb::Vec3f;
using openvdb::Vec3SGrid;

/// OpenVDB writes a random UUID into a file's header. A UUID from the contents replaces it, so that
/// equal maps give equal files.
void name_by_contents(std::string& image) {
  constexpr std::size_t kBegin = 21, kSize = 36;  // after magic, three versions and a flag
  const std::string sum = make_seal(std::string_view(image).substr(kBegin + kSize)).substr(8);
  std::string uuid;
  for (const char byte : sum) {
    for (const unsigned shift : {4U, 0U}) {
      uuid += "0123456789abcdef"[static_cast<unsigned char>(byte) >> shift & 15U];
    }
  }
  for (const std::size_t dash : {8U, 13U, 18U, 23U}) uuid.insert(dash, "-");
  image.replace(kBegin, kSize, uuid);
}

/// Writes a seekable file image to memory, so that our own writer detects a full disk.
class MemoryArchive : public openvdb::io::Archive {
 public:
  [[nodiscard]] std::string image(const openvdb::GridCPtrVec& grids,
                                  const openvdb::MetaMap& metadata) const {
    std::ostringstream stream(std::ios::binary);
    stream.exceptions(std::ios::badbit | std::ios::failbit);
    Archive::write(stream, grids, /*seekable=*/true, metadata);
    std::string bytes = std::move(stream).str();
    name_by_contents(bytes);
    return bytes;
  }
};

openvdb::MetaMap make_metadata(const GridStorage& s) {
  const BlockLattice& l = s.lattice;
  openvdb::MetaMap metadata;
  metadata.insertMeta(
      "viewgain_version",
      openvdb::Int32Metadata(s.scales.empty() ? kVdbLayoutVersion : kVdbScaledVersion));
  metadata.insertMeta("voxel_size", openvdb::DoubleMetadata(s.voxel_size));
  metadata.insertMeta("prior_sigma", openvdb::DoubleMetadata(s.prior_sigma));
  metadata.insertMeta("workspace_min", openvdb::Vec3IMetadata({l.min.x, l.min.y, l.min.z}));
  metadata.insertMeta("workspace_max", openvdb::Vec3IMetadata({l.max.x, l.max.y, l.max.z}));
  metadata.insertMeta("T_world_grid", openvdb::StringMetadata(poses_to_text({s.T_world_grid})));
  metadata.insertMeta("views", openvdb::StringMetadata(poses_to_text(s.views)));
  for (std::size_t k = 0; !s.hazard.empty() && k < HazardCounters::kClasses; ++k) {
    const HazardCounters::Class& c = s.hazard.classes[k];
    metadata.insertMeta(expected_name(k), openvdb::Int64Metadata(c.expected));
    metadata.insertMeta(met_name(k), openvdb::Int64Metadata(c.met));
  }
  return metadata;
}

/// Grids of one file with a common transform.
class GridSet {
 public:
  explicit GridSet(openvdb::math::Transform::Ptr transform) : transform_(std::move(transform)) {}

  template <typename Grid>
  typename Grid::TreeType& add(const char* name) {
    const typename Grid::Ptr grid(new Grid, [](Grid* last) {
      take_down(last->tree());
      delete last;
    });
    grid->setName(name);
    grid->setCreator("viewgain");
    grid->setTransform(transform_);
    grids_.push_back(grid);
    return grid->tree();
  }
  [[nodiscard]] const openvdb::GridCPtrVec& grids() const { return grids_; }

 private:
  openvdb::math::Transform::Ptr transform_;
  openvdb::GridCPtrVec grids_;
};

/// Adds a leaf whose active voxels, those of the mask, have the values value_at(offset).
template <typename Tree, typename ValueAt>
void put_leaf(Tree& tree, Index3 origin, const LeafMask& mask, ValueAt&& value_at) {
  auto leaf =
      std::make_unique<typename Tree::LeafNodeType>(to_coord(origin), tree.background(), false);
  for_each_bit(mask, [&](unsigned offset) { leaf->setValueOn(offset, value_at(offset)); });
  tree.addLeaf(leaf.release());
}

void put_states(const GridStorage& s, GridSet& set) {
  auto& state = set.add<FloatGrid>("state");
  auto& log_odds = set.add<FloatGrid>("log_odds");
  const auto state_of = [](std::uint8_t code) { return static_cast<float>(code_state(code)); };
  visit_blocks(
      s,
      [&](const CodeLeaf& leaf, Index3 origin) {
        const std::uint8_t* codes = leaf.buffer().data();
        const LeafMask known = intersection(known_mask(codes), s.lattice.clip(origin));
        if (known == LeafMask{}) return;
        put_leaf(state, origin, known, [&](unsigned at) { return state_of(codes[at]); });
        put_leaf(log_odds, origin, known, [&](unsigned at) { return code_log_odds(codes[at]); });
      },
      [&](Index3 origin, int size, std::uint8_t code) {
        if (code == kUnknownCode) return;
        if (size == kBlockSize && s.lattice.covers(origin, size)) {
          state.addTile(kBlockTileLevel, to_coord(origin), state_of(code), true);
          log_odds.addTile(kBlockTileLevel, to_coord(origin), code_log_odds(code), true);
          return;
        }
        const VoxelBox box = clipped(s.lattice, origin, size);
        const openvdb::CoordBBox part(to_coord(box.min), to_coord(box.max).offsetBy(-1));
        state.sparseFill(part, state_of(code), true);
        log_odds.sparseFill(part, code_log_odds(code), true);
      });
}

/// Part of a voxel's hits that a float cannot hold.
float hits_rest(const Belief& belief) {
  return static_cast<float>(static_cast<double>(belief.hits) -
                            double{static_cast<float>(belief.hits)});
}

void put_hits_rest(const GridStorage& s, GridSet& set) {
  auto& rest = set.add<FloatGrid>("hits_rest");
  for (const auto& [key, block] : s.beliefs) {
    put_leaf(rest, s.lattice.origin(key), block->mask,
             [&](unsigned at) { return hits_rest(*block->find(at)); });
  }
}

void put_covariances(const GridStorage& s, GridSet& set) {
  auto& covariance = set.add<Vec3SGrid>("covariance_diagonal");
  auto& off_covariance = set.add<Vec3SGrid>("covariance_offdiagonal");
  auto& mean_offset = set.add<Vec3SGrid>("mean_offset");
  for (const auto& [key, block_pointer] : s.beliefs) {
    const Index3 origin = s.lattice.origin(key);
    const int scale = s.scale(key);
    // The variance from the resolution.
    const double floor = s.voxel_size * s.voxel_size / 12.0 * std::ldexp(1.0, 2 * scale);
    for_each_bit(block_pointer->mask, [&](unsigned at) {
      const Belief& belief = *block_pointer->find(at);
      const SymmetricMatrix3 sigma = belief.information_matrix().inverse();
      if (!std::isfinite(sigma.trace())) return;  // an importer's belief without information
      const auto& eta = belief.information_vector;
      const Eigen::Vector3d shift = sigma * Eigen::Vector3d(eta[0], eta[1], eta[2]);
      const Index3 v = offset_voxel(origin, at);
      const auto narrow = [](double x, double y, double z) {
        return Vec3f(static_cast<float>(x), static_cast<float>(y), static_cast<float>(z));
      };
      covariance.setValueOn(to_coord(v),
                            narrow(sigma.xx + floor, sigma.yy + floor, sigma.zz + floor));
      off_covariance.setValueOn(to_coord(v), narrow(sigma.xy, sigma.xz, sigma.yz));
      mean_offset.setValueOn(to_coord(v), narrow(shift.x(), shift.y(), shift.z()));
    });
  }
}

void put_beliefs(const GridStorage& s, GridSet& set, bool with_covariance) {
  auto& diagonal = set.add<Vec3SGrid>("information_diagonal");
  auto& offdiagonal = set.add<Vec3SGrid>("information_offdiagonal");
  auto& vector = set.add<Vec3SGrid>("information_vector");
  auto& hits = set.add<FloatGrid>("hits");
  bool are_exact = true;
  for (const auto& [key, block_pointer] : s.beliefs) {
    const BeliefBlock& block = *block_pointer;
    const Index3 origin = s.lattice.origin(key);
    const auto information = [&](unsigned at, std::size_t first) {
      const auto& values = block.find(at)->information;
      return Vec3f(values[first], values[first + 1], values[first + 2]);
    };
    put_leaf(diagonal, origin, block.mask, [&](unsigned at) { return information(at, 0); });
    put_leaf(offdiagonal, origin, block.mask, [&](unsigned at) { return information(at, 3); });
    put_leaf(vector, origin, block.mask,
             [&](unsigned at) { return Vec3f(block.find(at)->information_vector.data()); });
    put_leaf(hits, origin, block.mask,
             [&](unsigned at) { return static_cast<float>(block.find(at)->hits); });
    for (const Belief& belief : block.beliefs) are_exact = are_exact && hits_rest(belief) == 0;
  }
  if (!are_exact) put_hits_rest(s, set);
  if (with_covariance) put_covariances(s, set);
}

/// Writes the result of make_image() with a seal.
template <typename MakeImage>
void write_sealed(const std::filesystem::path& path, MakeImage&& make_image) {
  require_ending(path, "an OpenVDB file", {".vdb"});
  AtomicFile file(path);
  try {
    initialize_openvdb();
    const std::string image = make_image();
    file.write(image);
    file.write(make_seal(image));
  } catch (const Error&) {
    throw;
  } catch (const std::bad_alloc&) {
    throw;
  } catch (const std::exception& error) {
    throw Error(ErrorCode::io, path.string() + ": cannot be written: " + error.what());
  }
  file.commit();
}

}  // namespace

void save_vdb(const BeliefGrid& grid, const std::filesystem::path& path,
              const VdbWriteConfig& config) {
  write_sealed(path, [&] {
    const GridStorage& s = GridAccess::storage(grid);
    GridSet set(make_transform(s));
    put_states(s, set);
    put_beliefs(s, set, config.with_covariance);
    if (!s.scales.empty()) {
      auto& scales = set.add<FloatGrid>(kScaleGridName);
      for (const auto& [key, scale] : s.scales) {
        scales.sparseFill(block_box(s, s.lattice.origin(key)), static_cast<float>(scale), true);
      }
    }
    openvdb::MetaMap metadata = make_metadata(s);
    for (const auto& [name, text] : texts_of(config.notes ? *config.notes : s.notes)) {
      metadata.insertMeta(kNotePrefix + name, openvdb::StringMetadata(text));
    }
    return MemoryArchive().image(set.grids(), metadata);
  });
}

void save_hazard_vdb(const HazardConfig::Volume& volume, const BeliefGrid& grid,
                     const std::filesystem::path& path) {
  HazardConfig config;
  config.volume = std::make_shared<const HazardConfig::Volume>(volume);
  config.validate();
  write_sealed(path, [&] {
    GridSet set(make_transform(GridAccess::storage(grid)));
    auto& tree = set.add<FloatGrid>(kHazardGridName);
    tree.root().setBackground(volume.outside, /*updateChildNodes=*/false);
    std::size_t next = 0;
    openvdb::tree::ValueAccessor<openvdb::FloatTree, false> values(tree);
    const VoxelBox& box = volume.box;
    for (std::int32_t x = box.min.x; x < box.max.x; ++x) {
      for (std::int32_t y = box.min.y; y < box.max.y; ++y) {
        for (std::int32_t z = box.min.z; z < box.max.z; ++z) {
          values.setValueOn({x, y, z}, volume.rates[next++]);
        }
      }
    }
    return MemoryArchive().image(set.grids(), {});
  });
}

}  // namespace viewgain
