// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0

// One reader of foreign bytes for libFuzzer, which CMakeLists.txt names: it reads or throws Error.

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

#include "clouds/cloud_formats.hpp"
#include "mesh_formats.hpp"
#include "viewgain/core/error.hpp"
#include "viewgain/formats/octomap_io.hpp"

namespace viewgain::detail {

// The workspace bounds what a pruned leaf may ask for.
[[maybe_unused]] static BeliefGrid octomap(std::string_view bytes, const std::string& name) {
  OctomapConfig config;
  config.workspace = Box{{-1, -1, -1}, {1, 1, 1}};
  return grid_from_octomap_bytes(bytes, config, name);
}

}  // namespace viewgain::detail

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  try {
    (void)viewgain::detail::VIEWGAIN_FUZZED({reinterpret_cast<const char*>(data), size}, "fuzzed");
  } catch (const viewgain::Error&) {
  }
  return 0;
}
