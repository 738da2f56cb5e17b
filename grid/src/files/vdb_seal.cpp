// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include "vdb_seal.hpp"

#include <algorithm>

#include "viewgain/support/hash64.hpp"

namespace viewgain::detail {
namespace {

constexpr std::string_view kMark = "VGSEAL01";
constexpr std::size_t kSealSize = 24;

// Whether the file ends in the beginning of its seal, so that it was truncated by a few bytes.
// Ignores fewer than four bytes, which could match by chance.
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

std::string make_seal(std::string_view bytes) {
  std::string seal(kMark);
  Hash64 hash;
  hash.add_bytes(bytes);
  for (const std::uint64_t word : {std::uint64_t{bytes.size()}, hash.value()}) {
    for (unsigned i = 0; i < 8; ++i) seal.push_back(static_cast<char>(word >> (8U * i) & 255U));
  }
  return seal;
}

SealCheck check_seal(std::string_view file) {
  if (ends_in_part_of_seal(file)) return SealCheck::broken;
  if (file.size() < kSealSize) return SealCheck::absent;
  const std::string_view bytes = file.substr(0, file.size() - kSealSize);
  const std::string_view seal = file.substr(bytes.size());
  if (!seal.starts_with(kMark)) return SealCheck::absent;
  return seal == make_seal(bytes) ? SealCheck::intact : SealCheck::broken;
}

}  // namespace viewgain::detail
