// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include "vdb_outline.hpp"

#include <algorithm>
#include <cstring>
#include <exception>
#include <type_traits>

#include "viewgain/support/hash64.hpp"

namespace viewgain::detail {
namespace {

constexpr std::string_view kMagic = " BDV";  // then four zeros
constexpr std::uint32_t kOldestVersion =
    222;  // of OpenVDB 1.0's release; older ones have other headers
constexpr std::size_t kUuidSize = 36;

struct CameShort : std::exception {};

class Reader {
 public:
  explicit Reader(std::string_view file) : rest_(file), size_(file.size()) {}

  template <typename Number>
  Number number() {
    static_assert(std::is_arithmetic_v<Number>);
    Number value;
    std::memcpy(&value, take(sizeof(Number)).data(), sizeof(Number));
    return value;
  }
  std::string_view take(std::size_t count) {
    if (count > rest_.size()) throw CameShort();
    const std::string_view part = rest_.substr(0, count);
    rest_.remove_prefix(count);
    return part;
  }
  std::string_view text() { return take(number<std::uint32_t>()); }
  [[nodiscard]] std::size_t position() const { return size_ - rest_.size(); }

 private:
  std::string_view rest_;
  std::size_t size_;
};

constexpr std::string_view kMark = "VGSEAL01";
constexpr std::size_t kSealSize = 24;

}  // namespace

std::string fault_in_outline(std::string_view file) {
  if (!file.starts_with(kMagic)) return "is no OpenVDB file";
  try {
    Reader reader(file);
    if (reader.number<std::int64_t>() != 0x56444220) return "is no OpenVDB file";
    if (reader.number<std::uint32_t>() < kOldestVersion)
      return "has an OpenVDB format that is too old";
    (void)reader.take(2 * sizeof(std::uint32_t));  // library version
    const bool has_positions = reader.number<char>() != 0;
    (void)reader.take(kUuidSize);
    for (auto count = reader.number<std::uint32_t>(); count > 0; --count) {
      (void)reader.text();  // name
      (void)reader.text();  // type
      (void)reader.text();  // value, with its size before it as text has
    }
    const auto grids = reader.number<std::int32_t>();
    if (grids < 0) return "is corrupt: it has a negative number of grids";
    if (!has_positions) return {};
    for (std::int32_t i = 0; i < grids; ++i) {
      for (int part = 0; part < 3; ++part) (void)reader.text();  // name, type, parent
      const auto grid = reader.number<std::int64_t>();
      const auto blocks = reader.number<std::int64_t>();
      const auto end = reader.number<std::int64_t>();
      const auto here = static_cast<std::int64_t>(reader.position());
      if (grid != here || blocks < grid || end < blocks) {
        return "is corrupt: a grid has no valid position";
      }
      (void)reader.take(static_cast<std::size_t>(end - here));
    }
  } catch (const CameShort&) {
    return "is truncated";
  }
  return {};
}

std::string make_seal(std::string_view bytes) {
  std::string seal(kMark);
  Hash64 hash;
  hash.add_bytes(bytes);
  for (const std::uint64_t word : {std::uint64_t{bytes.size()}, hash.value()}) {
    for (unsigned i = 0; i < 8; ++i) seal.push_back(static_cast<char>(word >> (8U * i) & 255U));
  }
  return seal;
}

namespace {

// Whether the file ends in the beginning of its seal: it was cut a few bytes short. Fewer than four
// bytes of it could be there by chance.
bool ends_in_part_of_seal(std::string_view file) {
  for (std::size_t kept = 4; kept < std::min(kSealSize, file.size()); ++kept) {
    const std::string_view tail = file.substr(file.size() - kept);
    const std::string_view mark = std::string_view(kMark).substr(0, kept);
    if (!tail.starts_with(mark)) continue;
    if (make_seal(file.substr(0, file.size() - kept)).starts_with(tail)) return true;
  }
  return false;
}

}  // namespace

SealCheck check_seal(std::string_view file) {
  if (ends_in_part_of_seal(file)) return SealCheck::broken;
  if (file.size() < kSealSize) return SealCheck::absent;
  const std::string_view bytes = file.substr(0, file.size() - kSealSize);
  const std::string_view seal = file.substr(bytes.size());
  if (!seal.starts_with(kMark)) return SealCheck::absent;
  return seal == make_seal(bytes) ? SealCheck::intact : SealCheck::broken;
}

}  // namespace viewgain::detail
