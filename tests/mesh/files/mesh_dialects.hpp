// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string>
#include <vector>

namespace viewgain::test {

/// A mesh file as some program writes it, and what is to be read, or why it is refused.
struct MeshDialect {
  std::string file;  ///< its ending says the format
  std::string bytes;
  std::size_t vertices = 0, triangles = 0;
  double area = 0, volume = 0;  ///< the latter positive if the faces look outward
  std::string refusal;          ///< part of the message, where it is refused
};

/// The table of dialects.
[[nodiscard]] std::vector<MeshDialect> mesh_dialects();

}  // namespace viewgain::test
