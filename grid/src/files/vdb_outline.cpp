// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include "vdb_outline.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cstring>
#include <exception>
#include <set>
#include <type_traits>
#include <utility>

namespace viewgain::detail {
namespace {

constexpr std::string_view kMagic = " BDV";  // followed by four zeros
// Node masks are compressed from this version on, in all files since OpenVDB 1.0.
constexpr std::uint32_t kOldestVersion = 222;
constexpr std::size_t kUuidSize = 36;

// A fault of the file.
struct Fault : std::exception {
  std::string of_file;
  explicit Fault(std::string what) : of_file(std::move(what)) {}
};
[[noreturn]] void corrupt(const std::string& what) { throw Fault("the file is corrupt: " + what); }

class Reader {
 public:
  Reader(std::string_view file, std::size_t position) : file_(file), position_(position) {}

  template <typename Number>
  Number number() {
    static_assert(std::is_arithmetic_v<Number>);
    Number value;
    std::memcpy(&value, take(sizeof(Number)).data(), sizeof(Number));
    return value;
  }
  std::string_view take(std::uint64_t count) {
    if (count > file_.size() - position_) throw Fault("the file is truncated");
    const std::string_view part = file_.substr(position_, count);
    position_ += part.size();
    return part;
  }
  std::string_view text() { return take(number<std::uint32_t>()); }
  [[nodiscard]] std::size_t position() const { return position_; }

 private:
  std::string_view file_;
  std::size_t position_;
};

using Sizes = std::pair<std::string_view, std::size_t>;

// Sizes of OpenVDB's metadata types; it reads this many bytes regardless of the file.
constexpr std::array<Sizes, 16> kMetadata{{{"bool", 1},
                                           {"int32", 4},
                                           {"int64", 8},
                                           {"float", 4},
                                           {"double", 8},
                                           {"vec2i", 8},
                                           {"vec2s", 8},
                                           {"vec2d", 16},
                                           {"vec3i", 12},
                                           {"vec3s", 12},
                                           {"vec3d", 24},
                                           {"vec4i", 16},
                                           {"vec4s", 16},
                                           {"vec4d", 32},
                                           {"mat4s", 64},
                                           {"mat4d", 128}}};
constexpr std::string_view kDelayedLoad = "__delayedload";

constexpr std::array<Sizes, 7> kMaps{{{"AffineMap", 128},
                                      {"UnitaryMap", 128},
                                      {"ScaleMap", 120},
                                      {"UniformScaleMap", 120},
                                      {"TranslationMap", 24},
                                      {"ScaleTranslateMap", 144},
                                      {"UniformScaleTranslateMap", 144}}};
constexpr std::string_view kFrustum = "NonlinearFrustumMap";
constexpr std::size_t kFrustumSize = 64;  // and a map

// Sizes of tree values.
constexpr std::array<Sizes, 2> kTrees{{{"Tree_float_5_4_3", 4}, {"Tree_vec3s_5_4_3", 12}}};
constexpr std::string_view kHalf = "_HalfFloat";  // suffix of a tree's name

template <std::size_t kCount>
std::size_t size_in(const std::array<Sizes, kCount>& sizes, std::string_view name) {
  const auto found = std::find_if(sizes.begin(), sizes.end(),
                                  [&](const Sizes& each) { return each.first == name; });
  return found == sizes.end() ? 0 : found->second;
}

// OpenVDB reads it into a bool unchecked.
void check_bool(char byte) {
  if (byte != 0 && byte != 1) corrupt("a flag must be 0 or 1, but is " + std::to_string(byte));
}

void follow_metadata(Reader& reader, std::string& image) {
  for (auto count = reader.number<std::uint32_t>(); count > 0; --count) {
    const std::string_view name = reader.text(), type = reader.text();
    const std::size_t type_end = reader.position();
    const auto size = reader.number<std::uint32_t>();
    const std::size_t read = size_in(kMetadata, type);
    if (read != 0 && size != read) {
      corrupt("metadata '" + std::string(name) + "' of type " + std::string(type) + " has " +
              std::to_string(size) + " bytes");
    }
    // Its reader trusts the contents; delayed loading is disabled.
    if (type == kDelayedLoad) image[type_end - type.size()] = '~';
    const std::string_view value = reader.take(size);
    if (type == "bool") check_bool(value.front());
  }
}

void follow_map(Reader& reader) {
  std::string_view type = reader.text();
  if (type == kFrustum) {
    (void)reader.take(kFrustumSize);
    type = reader.text();
  }
  const std::size_t size = size_in(kMaps, type);
  if (size == 0) throw Fault("the file has a grid with an unknown transform");
  (void)reader.take(size);
}

std::size_t count_on(std::string_view mask) {
  std::size_t count = 0;
  for (std::size_t i = 0; i < mask.size(); i += 8) {
    std::uint64_t word = 0;
    std::memcpy(&word, &mask[i], 8);
    count += static_cast<std::size_t>(std::popcount(word));
  }
  return count;
}

// A tree of nodes of 32^3, 16^3 and 8^3: first all masks and tiles, then the values of leaves.
class TreeWalk {
 public:
  TreeWalk(Reader& reader, std::uint32_t compression, std::size_t value_size, bool is_half)
      : reader_(reader),
        compression_(compression),
        value_size_(value_size),
        stored_size_(is_half ? value_size / 2 : value_size),
        is_half_(is_half) {}

  // Returns the maximum memory of the tree in bytes.
  std::uint64_t follow() {
    (void)reader_.number<std::int32_t>();  // buffers
    (void)reader_.take(value_size_);       // background
    const auto tiles = reader_.number<std::uint32_t>(), children = reader_.number<std::uint32_t>();
    bytes_ = kTreeHead + kRootEntry * (std::uint64_t{tiles} + children);
    for (std::uint32_t i = 0; i < tiles; ++i) {
      (void)reader_.take(3 * sizeof(std::int32_t) + value_size_);
      check_bool(reader_.number<char>());  // active flag
    }
    std::set<std::array<std::int32_t, 3>> origins;
    std::size_t leaves = 0;
    for (std::uint32_t i = 0; i < children; ++i) {
      std::array<std::int32_t, 3> origin{};
      for (std::int32_t& at : origin) at = reader_.number<std::int32_t>();
      const bool is_place =
          std::all_of(origin.begin(), origin.end(), [](std::int32_t at) { return at % 4096 == 0; });
      if (!is_place || !origins.insert(origin).second) corrupt("a node is in the wrong place");
      for (std::size_t lower = node(32 * 32 * 32); lower > 0; --lower) {
        const std::size_t own = node(16 * 16 * 16);
        (void)reader_.take(own * kLeafMask);
        leaves += own;
      }
    }
    for (; leaves > 0; --leaves) {
      values(8 * 8 * 8, count_on(reader_.take(kLeafMask)));
      bytes_ += 8 * 8 * 8 * value_size_ + kNodeHead;
    }
    return bytes_;
  }

 private:
  static constexpr std::size_t kLeafMask = 64;
  static constexpr std::size_t kTreeHead = 4096, kRootEntry = 128;
  static constexpr std::size_t kNodeHead = 256;  // masks of leaf size, allocator overhead
  enum : std::uint32_t { kZip = 1, kActive = 2, kBlosc = 4 };

  // Returns the number of children.
  std::size_t node(std::size_t places) {
    const std::string_view children = reader_.take(places / 8), active = reader_.take(places / 8);
    for (std::size_t i = 0; i < children.size(); ++i) {
      if ((children[i] & active[i]) != 0)
        corrupt("a node has a child and a tile at the same place");
    }
    values(places, count_on(active));
    bytes_ += places * ((value_size_ + 7) / 8 * 8) + places / 4 + kNodeHead;
    return count_on(children);
  }

  // Stored form of a number of values: a code for the inactive ones, then the others.
  void values(std::size_t all, std::size_t active) {
    enum : signed char { kOneInactive = 2, kMask = 3, kMaskAndOne = 4, kMaskAndTwo = 5, kAll = 6 };
    const auto kind = reader_.number<signed char>();
    if (kind == kOneInactive || kind == kMaskAndOne) (void)reader_.take(value_size_);
    if (kind == kMaskAndTwo) (void)reader_.take(2 * value_size_);
    if (kind >= kMask && kind <= kMaskAndTwo) (void)reader_.take(all / 8);
    const bool has_all = (compression_ & kActive) == 0 || kind == kAll;
    const std::size_t bytes = (has_all ? all : active) * stored_size_;
    if (is_half_ && bytes == 0) return;
    if ((compression_ & (kBlosc | kZip)) == 0) {
      (void)reader_.take(bytes);
      return;
    }
    const auto packed = reader_.number<std::int64_t>();
    if (packed > 0) {
      const std::string_view chunk = reader_.take(static_cast<std::uint64_t>(packed));
      if ((compression_ & kBlosc) != 0) check_blosc(chunk, bytes);
    } else if (0 - static_cast<std::uint64_t>(packed) == bytes) {  // uncompressed
      (void)reader_.take(bytes);
    } else {
      corrupt(kOtherSize);
    }
  }

  // Blosc reads the size of the chunk from the chunk's header.
  static void check_blosc(std::string_view chunk, std::size_t bytes) {
    constexpr std::size_t kHead = 16;
    if (chunk.size() < kHead) corrupt(kOtherSize);
    Reader head(chunk, 4);
    const auto unpacked = head.number<std::uint32_t>();
    (void)head.number<std::uint32_t>();  // of a block
    if (unpacked != bytes || head.number<std::uint32_t>() != chunk.size()) corrupt(kOtherSize);
  }

  static constexpr const char* kOtherSize = "the number of values does not match the node";

  Reader& reader_;
  std::uint32_t compression_;
  std::size_t value_size_, stored_size_;
  bool is_half_;
  std::uint64_t bytes_ = 0;
};

std::string_view without_half(std::string_view type) {
  return type.ends_with(kHalf) ? type.substr(0, type.size() - kHalf.size()) : type;
}

// Returns the memory of its tree in bytes.
std::uint64_t follow_grid(Reader& reader, std::string& image, std::string_view type,
                          bool is_instance) {
  const auto compression = reader.number<std::uint32_t>();
  follow_metadata(reader, image);
  follow_map(reader);
  if (is_instance) return 0;
  const std::size_t value_size = size_in(kTrees, without_half(type));
  return TreeWalk(reader, compression, value_size, type.ends_with(kHalf)).follow();
}

std::uint64_t follow_file(std::string& image) {
  const std::string_view file(image);
  Reader reader(file, 0);
  if (!file.starts_with(kMagic) || reader.number<std::int64_t>() != 0x56444220) {
    if (file.starts_with("# Octomap OcTree")) {
      throw Fault(
          "the file is an OctoMap tree, not an OpenVDB file; rename it to end in .ot or .bt");
    }
    throw Fault("the file is not an OpenVDB file; a map must be a .vdb, .ot or .bt file");
  }
  if (reader.number<std::uint32_t>() < kOldestVersion) {
    throw Fault("the file has an OpenVDB format that is too old");
  }
  (void)reader.take(2 * sizeof(std::uint32_t));  // library version
  const bool has_positions = reader.number<char>() != 0;
  (void)reader.take(kUuidSize);
  follow_metadata(reader, image);
  const auto grids = reader.number<std::int32_t>();
  if (grids < 0) corrupt("it has a negative number of grids");
  std::uint64_t bytes = 0;
  for (std::int32_t i = 0; i < grids; ++i) {
    (void)reader.text();  // name
    const std::string_view type = reader.text(), parent = reader.text();
    const auto grid = reader.number<std::int64_t>();
    const auto blocks = reader.number<std::int64_t>();
    const auto end = reader.number<std::int64_t>();
    const bool is_known = is_followed(without_half(type));
    if (!has_positions) {
      if (!is_known) throw Fault("the size of a grid of type " + std::string(type) + " is unknown");
      bytes += follow_grid(reader, image, type, !parent.empty());
      continue;
    }
    const std::size_t begin = reader.position();
    if (grid != static_cast<std::int64_t>(begin) || blocks < grid || end < blocks) {
      corrupt("a grid has no valid position");
    }
    (void)reader.take(static_cast<std::size_t>(end) - begin);
    if (!is_known) continue;
    Reader own(file.substr(0, reader.position()), begin);
    bytes += follow_grid(own, image, type, !parent.empty());
  }
  return bytes;
}

}  // namespace

bool is_followed(std::string_view grid_type) { return size_in(kTrees, grid_type) != 0; }

VdbOutline outline_of(std::string& image) {
  try {
    return {{}, follow_file(image)};
  } catch (const Fault& fault) {
    return {fault.of_file, 0};
  }
}

}  // namespace viewgain::detail
