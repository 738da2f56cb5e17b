// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include "octomap/octomap_parts.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <string>

#include "viewgain/core/error.hpp"
#include "viewgain/support/grid_blocks.hpp"

namespace viewgain::detail {
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
