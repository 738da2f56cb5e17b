// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cstring>
#include <span>
#include <string>

#include "octomap/octomap_format.hpp"
#include "octomap/octomap_parts.hpp"
#include "viewgain/core/error.hpp"
#include "viewgain/formats/octomap_io.hpp"
#include "viewgain/support/atomic_file.hpp"
#include "viewgain/support/log_odds_code.hpp"
#include "viewgain/support/text.hpp"

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
