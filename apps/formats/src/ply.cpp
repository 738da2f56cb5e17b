// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include "viewgain/formats/ply.hpp"

#include <bit>
#include <string>

#include "viewgain/core/error.hpp"
#include "viewgain/support/atomic_file.hpp"
#include "viewgain/support/file_names.hpp"

namespace viewgain {
namespace {

// The header states the machine's byte order, so values are written unchanged.
template <typename Value>
void append(std::string& bytes, Value value) {
  const auto raw = std::bit_cast<std::array<char, sizeof(Value)>>(value);
  bytes.append(raw.data(), raw.size());
}

}  // namespace

void write_ply(const std::filesystem::path& path, const PlyArrays& arrays) {
  require_ending(path, "a PLY file", {".ply"});
  const auto& [points, normals, sigma, triangles] = arrays;
  const auto refuse = [&](const std::string& what) {
    viewgain::refuse(path.string() + ": " + what);
  };
  const auto check_count = [&](std::size_t count, const char* what) {
    if (count == 0 || count == points.size()) return;
    refuse(std::string("one value per point is required; points: ") +
           std::to_string(points.size()) + ", " + what + ": " + std::to_string(count));
  };
  check_count(normals.size(), "normals");
  check_count(sigma.size(), "sigmas");
  constexpr bool kLittle = std::endian::native == std::endian::little;
  std::string bytes = std::string("ply\nformat binary_") + (kLittle ? "little" : "big") +
                      "_endian 1.0\nelement vertex " + std::to_string(points.size()) +
                      "\nproperty double x\nproperty double y\nproperty double z\n";
  if (!normals.empty()) bytes += "property float nx\nproperty float ny\nproperty float nz\n";
  if (!sigma.empty()) bytes += "property float sigma\n";
  if (!triangles.empty()) {
    bytes += "element face " + std::to_string(triangles.size()) +
             "\nproperty list uchar int vertex_indices\n";
  }
  bytes += "end_header\n";
  for (std::size_t i = 0; i < points.size(); ++i) {
    for (const double x : points[i]) append(bytes, x);
    if (!normals.empty()) {
      for (const double x : normals[i]) append(bytes, static_cast<float>(x));
    }
    if (!sigma.empty()) append(bytes, sigma[i]);
  }
  for (const auto& triangle : triangles) {
    append(bytes, std::uint8_t{3});
    for (const std::uint32_t v : triangle) {
      if (v >= points.size()) {
        refuse("a triangle has vertex " + std::to_string(v) +
               "; it must be less than the number of points, " + std::to_string(points.size()));
      }
      append(bytes, static_cast<std::int32_t>(v));
    }
  }
  write_file_atomically(path, bytes);
}

}  // namespace viewgain
