// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string_view>

namespace viewgain {

/// The side of the image at which a surface ends, in the last view that saw this boundary. The
/// order is that of section 5 of the paper (Foix et al. 2012).
enum class BoundaryClass : std::uint8_t { left, right, top, bottom };

/// Names of the classes, in enumeration order.
inline constexpr std::array<std::string_view, 4> kBoundaryClassNames{"left", "right", "top",
                                                                     "bottom"};

/// "left", "right", "top" or "bottom". Throws std::out_of_range for an invalid value.
[[nodiscard]] constexpr std::string_view boundary_class_name(BoundaryClass boundary_class) {
  return kBoundaryClassNames.at(static_cast<std::size_t>(boundary_class));
}

}  // namespace viewgain
