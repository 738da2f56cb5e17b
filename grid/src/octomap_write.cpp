// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <bit>
#include <charconv>
#include <cstring>
#include <deque>
#include <span>
#include <string>
#include <vector>

#include "grid_blocks.hpp"
#include "log_odds_code.hpp"
#include "octomap_format.hpp"
#include "viewgain/core/atomic_file.hpp"
#include "viewgain/core/error.hpp"
#include "viewgain/grid/octomap_io.hpp"

namespace viewgain {
namespace {

using namespace detail;

/// OctoMap calls a log-odds of 0 occupied; this one is free and rounds to 0.
constexpr float kFreeZero = -1e-3F;

float written_log_odds(std::uint8_t code) {
  return code == kZeroCode ? kFreeZero : code_log_odds(code);
}

/// A part of the grid: a block's codes, or a uniform cube.
struct Part {
  std::uint64_t place = 0;  ///< of the lowest voxel on the curve of children's numbers
  int level = 0;            ///< the size is 2^level voxels
  std::uint8_t code = kUnknownCode;
  const std::uint8_t* codes = nullptr;
};

std::uint64_t spread(std::uint64_t v) {
  std::uint64_t result = 0;
  for (unsigned bit = 0; bit < kOctomapLevels; ++bit) result |= (v >> bit & 1U) << (3 * bit);
  return result;
}

class PartList {
 public:
  explicit PartList(const BeliefGrid& grid) : lattice_(grid.min_index(), grid.dims()) {
    visit_grid(
        grid,
        [&](Index3 origin, const std::uint8_t* codes) {
          if (lattice_.covers(origin, kBlockSize)) {
            add(origin, 3, kUnknownCode, codes);
          } else {
            add_clipped(origin, codes);
          }
        },
        [&](Index3 origin, std::int32_t size, std::uint8_t code) {
          if (code != kUnknownCode) add_cube(origin, size, code);
        });
    std::sort(parts_.begin(), parts_.end(),
              [](const Part& a, const Part& b) { return a.place < b.place; });
  }

  [[nodiscard]] std::span<const Part> parts() const { return parts_; }

 private:
  void add(Index3 origin, int level, std::uint8_t code, const std::uint8_t* codes) {
    const auto coordinate = [](std::int32_t v) {
      const std::int64_t shifted = std::int64_t{v} + kOctomapOffset;
      if (shifted < 0 || shifted >= 2 * kOctomapOffset) {
        throw Error(ErrorCode::capacity, "voxel index " + std::to_string(v) +
                                             " does not fit into an OctoMap tree, which holds "
                                             "-32768 to 32767");
      }
      return spread(static_cast<std::uint64_t>(shifted));
    };
    parts_.push_back(
        {coordinate(origin.x) | coordinate(origin.y) << 1U | coordinate(origin.z) << 2U, level,
         code, codes});
  }

  // A cube's part in the workspace, by halves.
  void add_cube(Index3 origin, std::int32_t size, std::uint8_t code) {
    if (!lattice_.overlaps(origin, size)) return;
    if (lattice_.covers(origin, size)) {
      add(origin, std::countr_zero(static_cast<std::uint32_t>(size)), code, nullptr);
    } else if (size > kBlockSize) {
      const std::int32_t half = size / 2;
      for (const std::int32_t x : {0, half}) {
        for (const std::int32_t y : {0, half}) {
          for (const std::int32_t z : {0, half}) {
            add_cube({origin.x + x, origin.y + y, origin.z + z}, half, code);
          }
        }
      }
    } else {
      std::array<std::uint8_t, kBlockVoxels> codes;
      codes.fill(code);
      add_clipped(origin, codes.data());
    }
  }

  void add_clipped(Index3 origin, const std::uint8_t* codes) {
    auto& own = clipped_.emplace_back();
    own.fill(kUnknownCode);
    for_each_bit(lattice_.clip(origin), [&](unsigned offset) { own[offset] = codes[offset]; });
    if (std::any_of(own.begin(), own.end(), [](std::uint8_t c) { return c != kUnknownCode; })) {
      add(origin, 3, kUnknownCode, own.data());
    } else {
      clipped_.pop_back();
    }
  }

  BlockLattice lattice_;
  std::vector<Part> parts_;
  std::deque<std::array<std::uint8_t, kBlockVoxels>> clipped_;
};

/// Nodes depth first, equal leaves joined.
class TreeBytes {
 public:
  explicit TreeBytes(std::span<const Part> parts) { cube(parts, kOctomapLevels); }

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

  Written cube(std::span<const Part> parts, int level) {
    if (parts.empty()) return {};
    if (parts.front().level == level) {
      const Part& part = parts.front();
      return part.codes != nullptr ? block(part.codes, 0, level) : leaf(part.code);
    }
    std::span<const Part> rest = parts;
    const int shift = 3 * (level - 1);
    return inner([&](unsigned i) {
      const auto end = std::partition_point(rest.begin(), rest.end(), [&](const Part& part) {
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
  const PartList parts(grid);
  const TreeBytes tree(parts.parts());
  std::array<char, 32> resolution;
  const auto end =
      std::to_chars(resolution.data(), resolution.data() + resolution.size(), grid.voxel_size());
  std::string file(kOctomapFullMark);
  file += "\nid OcTree\nsize " + std::to_string(tree.nodes()) + "\nres ";
  file.append(resolution.data(), end.ptr);
  file += "\ndata\n";
  file += tree.bytes();
  return file;
}

void save_octomap(const BeliefGrid& grid, const std::filesystem::path& path) {
  write_file_atomically(path, octomap_bytes(grid));
}

}  // namespace viewgain
