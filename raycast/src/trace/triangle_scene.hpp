// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <string>

#include "device.hpp"
#include "viewgain/support/isa.hpp"

namespace viewgain::detail {

/// As many rays as Embree's widest packet has; directions of unit length.
struct alignas(64) TriangleRays {
  static constexpr int kCount = 16;
  float ox[kCount], oy[kCount], oz[kCount];
  float dx[kCount], dy[kCount], dz[kCount];
  float far[kCount];               ///< no triangle farther than this is met; 0: none at all
  std::uint32_t triangle[kCount];  ///< what was met
};

/// Triangles, traced by Embree in packets as wide as the instruction set's registers. Immutable;
/// thread safe.
class TriangleScene {
 public:
  /// Three numbers a vertex, three indices a triangle; copies them. Throws Error(backend), also
  /// where Embree has no ray packets; `what` says what was being built.
  TriangleScene(Isa isa, std::span<const float> vertices, std::span<const unsigned> indices,
                const std::string& what);

  /// First hits of rays that look much the same way: shortens `far` to them and says which triangle
  /// it is. Returns the lanes that meet one.
  std::uint32_t meet(TriangleRays& rays, std::uint32_t lanes) const;

  /// The lanes that meet any triangle at all, whichever way they look.
  [[nodiscard]] std::uint32_t block(const TriangleRays& rays, std::uint32_t lanes) const;

 private:
  Isa isa_;
  ScenePtr bvh_;
};

}  // namespace viewgain::detail
