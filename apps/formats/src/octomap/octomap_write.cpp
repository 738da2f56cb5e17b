// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <map>
#include <memory>
#include <optional>
#include <string>

#include "octomap/octomap_format.hpp"
#include "viewgain/core/error.hpp"
#include "viewgain/formats/octomap_io.hpp"
#include "viewgain/grid/belief_grid.hpp"
#include "viewgain/support/atomic_file.hpp"
#include "viewgain/support/block_lattice.hpp"
#include "viewgain/support/file_names.hpp"
#include "viewgain/support/log_odds_code.hpp"
#include "viewgain/support/text.hpp"

namespace viewgain {
namespace {

using namespace detail;

constexpr int kBlockLevel = 3;
static_assert(1 << kBlockLevel == kBlockSize);

/// In OctoMap a log-odds of 0 means occupied. This value is free, and is rounded to 0 when read.
constexpr float kFreeZero = -1e-3F;

// Shift of the grid in voxels that makes the tree's frame the world's. Empty if there is a
// rotation, the shift is not a whole number of voxels, or the map would leave a tree's space.
std::optional<Index3> shift_to_world(const BeliefGrid& grid) {
  constexpr double kTurn = 1e-9, kWhole = 1e-6;
  const Pose& T = grid.T_world_grid();
  const auto axis = [&](std::size_t row, std::int32_t low, std::int32_t count,
                        std::int32_t& shift) {
    for (std::size_t column = 0; column < 3; ++column) {
      if (std::abs(T.m[4 * row + column] - (row == column ? 1.0 : 0.0)) > kTurn) return false;
    }
    const double voxels = T.m[4 * row + 3] / grid.voxel_size();
    const double whole = std::round(voxels);
    if (!(std::abs(voxels - whole) <= kWhole)) return false;
    if (whole != 0 && (low + whole < -kOctomapOffset || low + whole + count > kOctomapOffset)) {
      return false;
    }
    shift = static_cast<std::int32_t>(whole);
    return true;
  };
  const Index3 low = grid.min_index(), dims = grid.dims();
  Index3 shift;
  if (!axis(0, low.x, dims.x, shift.x) || !axis(1, low.y, dims.y, shift.y) ||
      !axis(2, low.z, dims.z, shift.z)) {
    return std::nullopt;
  }
  return shift;
}

Index3 sum(Index3 a, Index3 b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
Index3 child(Index3 at, std::int32_t half, unsigned i) {
  return sum(at, {(i & 1U) != 0 ? half : 0, (i & 2U) != 0 ? half : 0, (i & 4U) != 0 ? half : 0});
}

struct Part {
  int level = kBlockLevel;  // the size is 2^level voxels
  std::uint8_t code = kUnknownCode;
  std::unique_ptr<std::array<std::uint8_t, kBlockVoxels>> codes{};  // of a mixed block
};
// The known cubes of a tree, in the order of nodes, by their lowest voxels.
using Parts = std::map<std::uint64_t, Part>;

// The part of a block or tile of the grid inside the workspace, in voxels from the lowest corner of
// the tree's space.
struct Piece {
  VoxelBox box;
  Index3 origin;              // of the block
  const std::uint8_t* codes;  // of a block, else null
  std::uint8_t code;
};

std::uint64_t place(Index3 at) {
  std::uint64_t result = 0;
  for (unsigned bit = 0; bit < kOctomapLevels; ++bit) {
    const auto part = [&](std::int32_t v) { return static_cast<std::uint64_t>(v >> bit & 1); };
    result |= (part(at.x) | part(at.y) << 1U | part(at.z) << 2U) << 3 * bit;
  }
  return result;
}

// The tree's cubes are shifted relative to the grid's blocks, so a piece is cut at the ends of the
// tree's cubes.
void add_piece(Parts& parts, const Piece& piece, Index3 at, int level) {
  const std::int32_t size = std::int32_t{1} << level;
  const VoxelBox cube = VoxelBox::from_dims(at, {size, size, size});
  const VoxelBox inside = piece.box.intersection(cube);
  if (inside.volume() == 0) return;
  if (piece.codes == nullptr && inside == cube) {
    parts[place(at)] = {level, piece.code};
    return;
  }
  if (level > kBlockLevel) {
    for (unsigned i = 0; i < 8; ++i) add_piece(parts, piece, child(at, size / 2, i), level - 1);
    return;
  }
  auto& codes = parts[place(at)].codes;
  if (!codes) codes = std::make_unique<std::array<std::uint8_t, kBlockVoxels>>();
  for (std::int32_t x = inside.min.x; x < inside.max.x; ++x) {
    for (std::int32_t y = inside.min.y; y < inside.max.y; ++y) {
      for (std::int32_t z = inside.min.z; z < inside.max.z; ++z) {
        const Index3& from = piece.origin;
        (*codes)[block_offset({x - at.x, y - at.y, z - at.z})] =
            piece.codes == nullptr
                ? piece.code
                : piece.codes[block_offset({x - from.x, y - from.y, z - from.z})];
      }
    }
  }
}

// Throws Error(capacity) if a known block lies outside a tree's space.
Parts parts_of(const BeliefGrid& grid, Index3 shift) {
  const BlockLattice lattice(grid.min_index(), grid.dims());
  const auto in_tree = [](std::int32_t v, std::int32_t by) {
    const std::int64_t shifted = std::int64_t{v} + by + kOctomapOffset;
    if (shifted < 0 || shifted > 2 * kOctomapOffset) {
      throw Error(ErrorCode::capacity,
                  "voxel index " + std::to_string(v) +
                      " does not fit into an OctoMap tree; its range is -32768 to 32767");
    }
    return static_cast<std::int32_t>(shifted);
  };
  const auto to_tree = [&](Index3 v) -> Index3 {
    return {in_tree(v.x, shift.x), in_tree(v.y, shift.y), in_tree(v.z, shift.z)};
  };
  const Index3 to_low = sum(shift, {kOctomapOffset, kOctomapOffset, kOctomapOffset});
  Parts parts;
  const auto add = [&](Index3 origin, std::int32_t size, const std::uint8_t* codes,
                       std::uint8_t code) {
    const VoxelBox box = clipped(lattice, origin, size);
    add_piece(parts, {{to_tree(box.min), to_tree(box.max)}, sum(origin, to_low), codes, code},
              {0, 0, 0}, kOctomapLevels);
  };
  visit_grid(
      grid,
      [&](Index3 origin, const std::uint8_t* codes) {
        bool known = false;
        for_each_bit(lattice.clip(origin),
                     [&](unsigned offset) { known = known || codes[offset] != kUnknownCode; });
        if (known) add(origin, kBlockSize, codes, kUnknownCode);
      },
      [&](Index3 origin, std::int32_t size, std::uint8_t code) {
        if (code != kUnknownCode) add(origin, size, nullptr, code);
      });
  return parts;
}

// Writes nodes depth first, and joins equal leaves.
class TreeBytes {
 public:
  explicit TreeBytes(const Parts& parts) { cube(parts.begin(), parts.end(), kOctomapLevels); }

  [[nodiscard]] const std::string& bytes() const { return bytes_; }
  [[nodiscard]] std::uint64_t nodes() const { return bytes_.size() / kNodeBytes; }

 private:
  static constexpr std::size_t kNodeBytes = 5;
  // Result of writing a cube; nothing was written if it is unknown.
  struct Written {
    bool known = false;
    bool leaf = false;
    std::uint8_t code = kUnknownCode;  // the largest code in the cube
  };

  void put(std::size_t at, std::uint8_t code, unsigned children) {
    const float log_odds = code == kZeroCode ? kFreeZero : code_log_odds(code);
    std::memcpy(bytes_.data() + at, &log_odds, sizeof log_odds);
    bytes_[at + sizeof log_odds] = static_cast<char>(children);
  }

  Written leaf(std::uint8_t code) {
    if (code == kUnknownCode) return {};
    bytes_.append(kNodeBytes, '\0');
    put(bytes_.size() - kNodeBytes, code, 0);
    return {true, true, code};
  }

  // write(i) writes the i-th child.
  template <typename Write>
  Written inner(const Write& write) {
    const std::size_t start = bytes_.size();
    bytes_.append(kNodeBytes, '\0');
    unsigned children = 0;
    bool uniform = true;
    std::uint8_t greatest = kUnknownCode;
    for (unsigned i = 0; i < 8; ++i) {
      const Written child = write(i);
      uniform = uniform && child.known && child.leaf && (i == 0 || child.code == greatest);
      greatest = std::max(greatest, child.code);
      if (child.known) children |= 1U << i;
    }
    if (children == 0 || uniform) {
      bytes_.resize(start);
      return leaf(greatest);
    }
    put(start, greatest, children);
    return {true, false, greatest};
  }

  Written block(const std::array<std::uint8_t, kBlockVoxels>& codes, Index3 at, int level) {
    if (level == 0) return leaf(codes[block_offset(at)]);
    return inner([&](unsigned i) {
      return block(codes, child(at, std::int32_t{1} << (level - 1), i), level - 1);
    });
  }

  Written cube(Parts::const_iterator begin, Parts::const_iterator end, int level) {
    if (begin == end) return {};
    const Part& part = begin->second;
    if (part.level == level) {
      return part.codes ? block(*part.codes, {0, 0, 0}, level) : leaf(part.code);
    }
    return inner([&](unsigned i) {
      const auto first = begin;
      while (begin != end && (begin->first >> (3 * (level - 1)) & 7U) == i) ++begin;
      return cube(first, begin, level - 1);
    });
  }

  std::string bytes_;
};

}  // namespace

std::string octomap_bytes(const BeliefGrid& grid) {
  const TreeBytes tree(parts_of(grid, shift_to_world(grid).value_or(Index3{})));
  std::string file(kOctomapFullMark);
  file += "\nid OcTree\nsize " + std::to_string(tree.nodes()) + "\nres " +
          short_text(grid.voxel_size()) + "\ndata\n";
  file += tree.bytes();
  return file;
}

bool octomap_keeps_frame(const BeliefGrid& grid) { return shift_to_world(grid).has_value(); }

void save_octomap(const BeliefGrid& grid, const std::filesystem::path& path) {
  require_ending(path, "an OctoMap file", {".ot"});
  write_file_atomically(path, octomap_bytes(grid));
}

}  // namespace viewgain
