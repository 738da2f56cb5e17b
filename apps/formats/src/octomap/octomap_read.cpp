// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstring>
#include <limits>
#include <optional>
#include <utility>

#include "octomap/octomap_format.hpp"
#include "viewgain/core/error.hpp"
#include "viewgain/formats/octomap_io.hpp"
#include "viewgain/support/block_lattice.hpp"
#include "viewgain/support/file_bytes.hpp"
#include "viewgain/support/log_odds_code.hpp"
#include "viewgain/support/solid_voxels.hpp"
#include "viewgain/support/text.hpp"

namespace viewgain {
namespace {

using namespace detail;

static_assert(std::endian::native == std::endian::little, "OctoMap files are little-endian");

struct Header {
  bool binary = false;          ///< .bt
  std::size_t extra_bytes = 0;  ///< of a node of a .ot file, after its log-odds
  std::uint64_t nodes = 0;
  double resolution = 0;  ///< [m]
  std::size_t size = 0;   ///< of the header [bytes]
};

/// Reads the words of OctoMap's header up to "data". Skips unknown words, like OctoMap.
Header read_header(std::string_view bytes, const std::string& name) {
  Header header;
  if (bytes.starts_with(kOctomapBinaryMark)) {
    header.binary = true;
  } else if (bytes.starts_with(" BDV")) {
    throw Error(
        ErrorCode::format,
        name +
            ": the file is an OpenVDB file, not an OctoMap file; read it with load_vdb (in Python "
            "BeliefGrid.load), or rename it to end in .vdb for the program");
  } else if (!bytes.starts_with(kOctomapFullMark)) {
    throw Error(ErrorCode::format,
                name + ":1: the file is not an OctoMap file; it must begin with \"" +
                    std::string(kOctomapFullMark) + "\" or \"" + std::string(kOctomapBinaryMark) +
                    "\"");
  }
  LineReader lines(name, bytes);
  bool has_type = false, has_size = false, has_resolution = false;
  for (;;) {
    if (!lines.next()) lines.fail("the header is truncated; it has no line \"data\"");
    const auto& words = lines.words();
    if (words.empty() || words[0].front() == '#') continue;
    if (words[0] == "data") break;
    if (words[0] == "id") {
      const std::string_view type = words.size() > 1 ? words[1] : std::string_view();
      if (type != "OcTree" && type != "ColorOcTree") {
        lines.fail("trees of the type " + quoted(type) +
                   " are not supported; supported types: OcTree, ColorOcTree");
      }
      header.extra_bytes = type == "ColorOcTree" && !header.binary ? 3 : 0;
      has_type = true;
    } else if (words[0] == "size") {
      header.nodes = lines.count(1, std::numeric_limits<std::uint32_t>::max());
      has_size = true;
    } else if (words[0] == "res") {
      header.resolution = lines.number(1);
      if (!(std::isfinite(header.resolution) && header.resolution > 0)) {
        lines.fail("the resolution must be positive and finite, not " + quoted(words[1]));
      }
      has_resolution = true;
    }
  }
  const auto require = [&](bool has, const char* key) {
    if (!has) lines.fail("the header has no line \"" + std::string(key) + "\"");
  };
  require(has_type, "id");
  require(has_size, "size");
  require(has_resolution, "res");
  header.size = bytes.size() - lines.rest().size();
  return header;
}

/// Walks a tree's bytes and calls leaf(origin, size, code) in depth-first order, so that the leaves
/// of any cube follow each other.
template <typename Leaf>
class TreeWalk {
 public:
  TreeWalk(std::string_view bytes, const Header& header, const std::string& name,
           float occupied_from, Leaf leaf)
      : bytes_(bytes),
        at_(header.size),
        header_(header),
        name_(name),
        occupied_from_(occupied_from),
        leaf_(std::move(leaf)) {}

  void run() {
    if (header_.nodes > 0) {
      constexpr std::int32_t kLow = -kOctomapOffset;
      ++nodes_;
      if (header_.binary) {
        binary_node({kLow, kLow, kLow}, 2 * kOctomapOffset);
      } else {
        full_node({kLow, kLow, kLow}, 2 * kOctomapOffset);
      }
    }
    if (nodes_ != header_.nodes) {
      throw Error(ErrorCode::format, name_ + ": the file has " + std::to_string(nodes_) +
                                         " nodes, but the header declares " +
                                         std::to_string(header_.nodes));
    }
  }

 private:
  [[noreturn]] void fail(const std::string& what) const {
    throw Error(ErrorCode::format, name_ + ": byte " + std::to_string(at_) + ": " + what);
  }

  const char* take(std::size_t count) {
    if (bytes_.size() - at_ < count) fail("the tree is truncated");
    const char* taken = bytes_.data() + at_;
    at_ += count;
    return taken;
  }

  static Index3 child(Index3 origin, std::int32_t half, unsigned i) {
    return {origin.x + ((i & 1U) != 0 ? half : 0), origin.y + ((i & 2U) != 0 ? half : 0),
            origin.z + ((i & 4U) != 0 ? half : 0)};
  }

  void full_node(Index3 origin, std::int32_t size) {
    float log_odds;
    std::memcpy(&log_odds, take(sizeof log_odds), sizeof log_odds);
    if (!std::isfinite(log_odds)) fail("a node's log-odds is not finite");
    take(header_.extra_bytes);
    const auto children = static_cast<unsigned char>(*take(1));
    if (children == 0) {
      const std::uint8_t code = log_odds_code(static_cast<double>(log_odds));
      leaf_(origin, size,
            log_odds >= occupied_from_ ? std::max<std::uint8_t>(code, kZeroCode + 1)
                                       : std::min(code, kZeroCode));
      return;
    }
    if (size == 1) fail("the tree is deeper than 16 levels");
    for (unsigned i = 0; i < 8; ++i) {
      if ((children >> i & 1U) == 0) continue;
      ++nodes_;
      full_node(child(origin, size / 2, i), size / 2);
    }
  }

  // Two bits per child: 0 unknown, 1 free, 2 occupied, 3 has children, which follow.
  void binary_node(Index3 origin, std::int32_t size) {
    if (size == 1) fail("the tree is deeper than 16 levels");
    const char* pair = take(2);
    const unsigned kinds = static_cast<unsigned char>(pair[0]) |
                           static_cast<unsigned>(static_cast<unsigned char>(pair[1])) << 8U;
    for (unsigned i = 0; i < 8; ++i) {
      const unsigned kind = kinds >> (2 * i) & 3U;
      if (kind == 0) continue;
      ++nodes_;
      const Index3 at = child(origin, size / 2, i);
      if (kind == 3) {
        binary_node(at, size / 2);
      } else {
        leaf_(at, size / 2, kind == 1 ? kMinCode : kMaxCode);
      }
    }
  }

  std::string_view bytes_;
  std::size_t at_;
  const Header& header_;
  const std::string& name_;
  float occupied_from_;
  Leaf leaf_;
  std::uint64_t nodes_ = 0;
};

/// Puts leaves into a grid. Leaves smaller than a block are collected until the block is complete.
class BlockFiller {
 public:
  BlockFiller(BeliefGrid& grid, const std::string& name)
      : grid_(grid), solid_(name, "; give a workspace"), lattice_(grid.min_index(), grid.dims()) {}

  void add(Index3 origin, std::int32_t size, std::uint8_t code) {
    if (!lattice_.overlaps(origin, size)) return;
    if (size >= kBlockSize) {
      if (is_occupied(code)) count_solid(origin, size);
      fill_cube(grid_, origin, size, code);
      return;
    }
    const Index3 block = block_origin(origin);
    if (!block_ || *block_ != block) {
      flush();
      block_ = block;
      codes_.fill(kUnknownCode);
    }
    for (std::int32_t x = origin.x; x < origin.x + size; ++x) {
      for (std::int32_t y = origin.y; y < origin.y + size; ++y) {
        std::memset(codes_.data() + block_offset({x, y, origin.z}), code,
                    static_cast<std::size_t>(size));
      }
    }
  }

  void flush() {
    if (block_) put_block(grid_, *block_, codes_.data());
    block_.reset();
  }

 private:
  // Counts the blocks of a cube that lie in the workspace.
  void count_solid(Index3 origin, std::int32_t size) {
    const auto low = [](std::int32_t from, std::int32_t least) {
      return std::max(from, least & ~(kBlockSize - 1));
    };
    const auto high = [size](std::int32_t from, std::int32_t end) {
      return std::min(from + size, (end + kBlockSize - 1) & ~(kBlockSize - 1));
    };
    const Index3 &min = lattice_.min, &max = lattice_.max;
    solid_.add({low(origin.x, min.x), low(origin.y, min.y), low(origin.z, min.z)},
               {high(origin.x, max.x), high(origin.y, max.y), high(origin.z, max.z)});
  }

  BeliefGrid& grid_;
  SolidVoxels solid_;
  BlockLattice lattice_;
  std::optional<Index3> block_;
  std::array<std::uint8_t, kBlockVoxels> codes_{};
};

/// Checks all bytes of a tree. Returns the box of its leaves [m], or nothing if it has none.
std::optional<Box> check_tree(std::string_view bytes, const Header& header,
                              const std::string& name) {
  constexpr std::int32_t kMost = std::numeric_limits<std::int32_t>::max();
  Index3 low{kMost, kMost, kMost}, high{-kMost, -kMost, -kMost};
  TreeWalk(bytes, header, name, 0.0F, [&](Index3 at, std::int32_t size, std::uint8_t) {
    low = {std::min(low.x, at.x), std::min(low.y, at.y), std::min(low.z, at.z)};
    high = {std::max(high.x, at.x + size), std::max(high.y, at.y + size),
            std::max(high.z, at.z + size)};
  }).run();
  if (low.x >= high.x) return std::nullopt;
  const double V = header.resolution;
  return Box{{low.x * V, low.y * V, low.z * V}, {high.x * V, high.y * V, high.z * V}};
}

BeliefGrid empty_grid(const GridConfig& config, const std::string& name) {
  try {
    return BeliefGrid(config);
  } catch (const Error& error) {
    throw Error(error.code(), name + ": " + error.what());
  }
}

}  // namespace

BeliefGrid grid_from_octomap_bytes(std::string_view bytes, const OctomapConfig& config,
                                   const std::string& name) {
  if (!std::isfinite(config.occupied_from)) {
    refuse("occupied_from must be finite, not " + short_text(config.occupied_from));
  }
  const Header header = read_header(bytes, name);
  const std::optional<Box> known = check_tree(bytes, header, name);
  if (!known && !config.workspace) {
    throw Error(ErrorCode::format, name + ": the tree has no known voxel; give a workspace");
  }
  BeliefGrid grid = empty_grid({header.resolution,
                                config.workspace ? *config.workspace : *known,
                                {},
                                config.prior_sigma.value_or(header.resolution / 2)},
                               name);
  BlockFiller filler(grid, name);
  TreeWalk(bytes, header, name, config.occupied_from,
           [&](Index3 at, std::int32_t size, std::uint8_t code) { filler.add(at, size, code); })
      .run();
  filler.flush();
  return grid;
}

BeliefGrid load_octomap(const std::filesystem::path& path, const OctomapConfig& config) {
  return grid_from_octomap_bytes(file_bytes(path), config, path.string());
}

double octomap_resolution_of_bytes(std::string_view bytes, const std::string& name) {
  return read_header(bytes, name).resolution;
}

}  // namespace viewgain
