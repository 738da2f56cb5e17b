// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <deque>
#include <numeric>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "octomap/octomap_format.hpp"
#include "viewgain/core/error.hpp"
#include "viewgain/formats/octomap_io.hpp"
#include "viewgain/grid/belief_grid.hpp"
#include "viewgain/support/atomic_file.hpp"
#include "viewgain/support/block_lattice.hpp"
#include "viewgain/support/grid_blocks.hpp"
#include "viewgain/support/log_odds_code.hpp"
#include "viewgain/support/text.hpp"

namespace viewgain::detail {

// A part of the tree: a block's codes, or a uniform cube.
struct OctomapPart {
  std::uint64_t place = 0;  ///< of the lowest voxel on the curve of children's numbers
  int level = 0;            ///< the size is 2^level voxels
  std::uint8_t code = kUnknownCode;
  const std::uint8_t* codes = nullptr;
};

// A grid as cubes of the tree. The tree's cubes start at multiples of their size from a corner
// that is shifted against the grid's, so the grid's own blocks and tiles, clipped to the
// workspace, are cut where a cube of the tree ends. Cost: pieces of the grid times levels of the
// tree.
class OctomapParts {
 public:
  /// Throws Error(capacity) if a known block lies outside of a tree's space. The grid must stay as
  /// it is as long as the parts are used.
  OctomapParts(const BeliefGrid& grid, Index3 shift);

  /// In the order of their places.
  [[nodiscard]] std::span<const OctomapPart> parts() const { return parts_; }

 private:
  /// The part of a block or tile of the grid that lies in the workspace: [min, max), in voxels from
  /// the lowest corner of the tree's space.
  struct Piece {
    Index3 min, max;
    std::uint8_t code;
    const std::uint8_t* codes;  ///< of a block, else null
    Index3 origin;              ///< of the block
  };
  using Pieces = std::vector<std::size_t>;

  void add_block(Index3 origin, const std::uint8_t* codes);
  void add_piece(Index3 origin, std::int32_t size, std::uint8_t code, const std::uint8_t* codes);
  void cut(Index3 at, int level, const Pieces& inside);
  [[nodiscard]] std::uint8_t uniform_code(Index3 at, std::int32_t size, const Pieces& inside) const;
  void add_codes(Index3 at, const Pieces& inside);

  BlockLattice lattice_;
  Index3 shift_;
  std::vector<Piece> pieces_;
  /// By level, those that reach into each child of the cube that is being cut.
  std::array<std::array<Pieces, 8>, kOctomapLevels + 1> pieces_at_;
  std::vector<OctomapPart> parts_;
  std::deque<std::array<std::uint8_t, kBlockVoxels>> cut_codes_;
};

namespace {

constexpr int kBlockLevel = 3;
static_assert(1 << kBlockLevel == kBlockSize);

std::uint64_t spread(std::int32_t v) {
  std::uint64_t result = 0;
  for (unsigned bit = 0; bit < kOctomapLevels; ++bit) {
    result |= (static_cast<std::uint64_t>(v) >> bit & 1U) << (3 * bit);
  }
  return result;
}

std::uint64_t place(Index3 at) { return spread(at.x) | spread(at.y) << 1U | spread(at.z) << 2U; }

}  // namespace

// Voxels to move the grid by, so that the tree's frame is the world's; nothing where that is no
// whole number of them, turns, or leaves a tree's space.
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

OctomapParts::OctomapParts(const BeliefGrid& grid, Index3 shift)
    : lattice_(grid.min_index(), grid.dims()),
      shift_{shift.x + kOctomapOffset, shift.y + kOctomapOffset, shift.z + kOctomapOffset} {
  visit_grid(
      grid, [&](Index3 origin, const std::uint8_t* codes) { add_block(origin, codes); },
      [&](Index3 origin, std::int32_t size, std::uint8_t code) {
        if (code != kUnknownCode) add_piece(origin, size, code, nullptr);
      });
  pieces_at_[kOctomapLevels].front().resize(pieces_.size());
  auto& all = pieces_at_[kOctomapLevels].front();
  std::iota(all.begin(), all.end(), std::size_t{0});
  cut({0, 0, 0}, kOctomapLevels, all);
}

void OctomapParts::add_block(Index3 origin, const std::uint8_t* codes) {
  bool known = false;
  for_each_bit(lattice_.clip(origin),
               [&](unsigned offset) { known = known || codes[offset] != kUnknownCode; });
  if (known) add_piece(origin, kBlockSize, kUnknownCode, codes);
}

void OctomapParts::add_piece(Index3 origin, std::int32_t size, std::uint8_t code,
                             const std::uint8_t* codes) {
  const auto in_tree = [](std::int32_t v, std::int32_t shift) {
    const std::int64_t shifted = std::int64_t{v} + shift;
    if (shifted < 0 || shifted >= 2 * kOctomapOffset) {
      throw Error(ErrorCode::capacity, "voxel index " + std::to_string(v) +
                                           " does not fit into an OctoMap tree, which holds "
                                           "-32768 to 32767");
    }
    return static_cast<std::int32_t>(shifted);
  };
  const auto low = [&](std::int32_t v, std::int32_t from, std::int32_t shift) {
    return in_tree(std::max(v, from), shift);
  };
  const auto high = [&](std::int32_t v, std::int32_t to, std::int32_t shift) {
    return in_tree(std::min(v + size, to) - 1, shift) + 1;
  };
  const Index3 &from = lattice_.min, &to = lattice_.max;
  pieces_.push_back({{low(origin.x, from.x, shift_.x), low(origin.y, from.y, shift_.y),
                      low(origin.z, from.z, shift_.z)},
                     {high(origin.x, to.x, shift_.x), high(origin.y, to.y, shift_.y),
                      high(origin.z, to.z, shift_.z)},
                     code,
                     codes,
                     {origin.x + shift_.x, origin.y + shift_.y, origin.z + shift_.z}});
}

// A cube of the tree and the pieces that reach into it.
void OctomapParts::cut(Index3 at, int level, const Pieces& inside) {
  if (inside.empty()) return;
  const std::int32_t size = std::int32_t{1} << level;
  if (const std::uint8_t code = uniform_code(at, size, inside); code != kUnknownCode) {
    parts_.push_back({place(at), level, code, nullptr});
    return;
  }
  if (level == kBlockLevel) {
    add_codes(at, inside);
    return;
  }
  auto& children = pieces_at_[static_cast<std::size_t>(level) - 1];
  const std::int32_t half = size / 2;
  for (Pieces& child : children) child.clear();
  for (const std::size_t number : inside) {
    const Piece& piece = pieces_[number];
    const bool low[3] = {piece.min.x < at.x + half, piece.min.y < at.y + half,
                         piece.min.z < at.z + half};
    const bool high[3] = {piece.max.x > at.x + half, piece.max.y > at.y + half,
                          piece.max.z > at.z + half};
    for (unsigned i = 0; i < 8; ++i) {
      if (((i & 1U) != 0 ? high : low)[0] && ((i & 2U) != 0 ? high : low)[1] &&
          ((i & 4U) != 0 ? high : low)[2]) {
        children[i].push_back(number);
      }
    }
  }
  for (unsigned i = 0; i < 8; ++i) {
    cut({at.x + ((i & 1U) != 0 ? half : 0), at.y + ((i & 2U) != 0 ? half : 0),
         at.z + ((i & 4U) != 0 ? half : 0)},
        level - 1, children[i]);
  }
}

// The code of a cube that uniform pieces of one code fill, else unknown.
std::uint8_t OctomapParts::uniform_code(Index3 at, std::int32_t size, const Pieces& inside) const {
  const std::uint8_t code = pieces_[inside.front()].code;
  std::int64_t filled = 0;
  for (const std::size_t number : inside) {
    const Piece& piece = pieces_[number];
    if (piece.codes != nullptr || piece.code != code) return kUnknownCode;
    const auto length = [size](std::int32_t from, std::int32_t min, std::int32_t max) {
      return std::int64_t{std::min(max, from + size)} - std::max(min, from);
    };
    filled += length(at.x, piece.min.x, piece.max.x) * length(at.y, piece.min.y, piece.max.y) *
              length(at.z, piece.min.z, piece.max.z);
  }
  return filled == std::int64_t{size} * size * size ? code : kUnknownCode;
}

void OctomapParts::add_codes(Index3 at, const Pieces& inside) {
  const Piece& first = pieces_[inside.front()];
  if (first.codes != nullptr && first.min == at &&
      first.max == Index3{at.x + kBlockSize, at.y + kBlockSize, at.z + kBlockSize}) {
    parts_.push_back({place(at), kBlockLevel, kUnknownCode, first.codes});
    return;
  }
  auto& own = cut_codes_.emplace_back();
  own.fill(kUnknownCode);
  for (const std::size_t number : inside) {
    const Piece& piece = pieces_[number];
    const Index3 from{std::max(piece.min.x, at.x), std::max(piece.min.y, at.y),
                      std::max(piece.min.z, at.z)};
    const Index3 to{std::min(piece.max.x, at.x + kBlockSize),
                    std::min(piece.max.y, at.y + kBlockSize),
                    std::min(piece.max.z, at.z + kBlockSize)};
    for (std::int32_t x = from.x; x < to.x; ++x) {
      for (std::int32_t y = from.y; y < to.y; ++y) {
        for (std::int32_t z = from.z; z < to.z; ++z) {
          own[block_offset({x - at.x, y - at.y, z - at.z})] =
              piece.codes == nullptr
                  ? piece.code
                  : piece.codes[block_offset(
                        {x - piece.origin.x, y - piece.origin.y, z - piece.origin.z})];
        }
      }
    }
  }
  parts_.push_back({place(at), kBlockLevel, kUnknownCode, own.data()});
}

}  // namespace viewgain::detail

namespace viewgain {
namespace {

using namespace detail;

/// OctoMap calls a log-odds of 0 occupied; this one is free and rounds to 0.
constexpr float kFreeZero = -1e-3F;

float written_log_odds(std::uint8_t code) {
  return code == kZeroCode ? kFreeZero : code_log_odds(code);
}

/// Nodes depth first, equal leaves joined.
class TreeBytes {
 public:
  explicit TreeBytes(std::span<const OctomapPart> parts) { cube(parts, kOctomapLevels); }

  [[nodiscard]] const std::string& bytes() const { return bytes_; }
  [[nodiscard]] std::uint64_t nodes() const { return bytes_.size() / kNodeBytes; }

 private:
  static constexpr std::size_t kNodeBytes = 5;
  /// What was written for a cube; nothing if it is unknown.
  struct Written {
    bool known = false;
    bool leaf = false;
    std::uint8_t code = kUnknownCode;  ///< the greatest in it
  };

  void put(std::size_t at, std::uint8_t code, unsigned children) {
    const float log_odds = written_log_odds(code);
    std::memcpy(bytes_.data() + at, &log_odds, sizeof log_odds);
    bytes_[at + sizeof log_odds] = static_cast<char>(children);
  }

  Written leaf(std::uint8_t code) {
    if (code == kUnknownCode) return {};
    bytes_.append(kNodeBytes, '\0');
    put(bytes_.size() - kNodeBytes, code, 0);
    return {true, true, code};
  }

  /// write(i) writes the i-th child.
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

  // Most of a sparse block is unknown: looked at by rows along z.
  static bool is_unknown(const std::uint8_t* codes, unsigned offset, unsigned size) {
    for (unsigned x = 0; x < size; ++x) {
      for (unsigned y = 0; y < size; ++y) {
        const std::uint8_t* row = codes + offset + (x << 6U) + (y << 3U);
        for (unsigned z = 0; z < size; ++z) {
          if (row[z] != kUnknownCode) return false;
        }
      }
    }
    return true;
  }

  Written block(const std::uint8_t* codes, unsigned offset, int level) {
    if (level == 0) return leaf(codes[offset]);
    if (is_unknown(codes, offset, 1U << level)) return {};
    const unsigned half = 1U << (level - 1);
    return inner([&](unsigned i) {
      const unsigned to =
          (i & 1U) * (half << 6U) + (i >> 1U & 1U) * (half << 3U) + (i >> 2U & 1U) * half;
      return block(codes, offset + to, level - 1);
    });
  }

  Written cube(std::span<const OctomapPart> parts, int level) {
    if (parts.empty()) return {};
    if (parts.front().level == level) {
      const OctomapPart& part = parts.front();
      return part.codes != nullptr ? block(part.codes, 0, level) : leaf(part.code);
    }
    std::span<const OctomapPart> rest = parts;
    const int shift = 3 * (level - 1);
    return inner([&](unsigned i) {
      const auto end = std::partition_point(rest.begin(), rest.end(), [&](const OctomapPart& part) {
        return (part.place >> shift & 7U) == i;
      });
      const auto own = rest.first(static_cast<std::size_t>(end - rest.begin()));
      rest = rest.subspan(own.size());
      return cube(own, level - 1);
    });
  }

  std::string bytes_;
};

}  // namespace

std::string octomap_bytes(const BeliefGrid& grid) {
  const OctomapParts parts(grid, shift_to_world(grid).value_or(Index3{}));
  const TreeBytes tree(parts.parts());
  std::string file(kOctomapFullMark);
  file += "\nid OcTree\nsize " + std::to_string(tree.nodes()) + "\nres " +
          short_text(grid.voxel_size()) + "\ndata\n";
  file += tree.bytes();
  return file;
}

bool octomap_keeps_frame(const BeliefGrid& grid) { return shift_to_world(grid).has_value(); }

void save_octomap(const BeliefGrid& grid, const std::filesystem::path& path) {
  write_file_atomically(path, octomap_bytes(grid));
}

}  // namespace viewgain
