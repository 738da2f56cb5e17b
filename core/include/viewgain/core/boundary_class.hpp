// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string_view>

namespace viewgain {

/// Towards which side of the image a surface ends, in the axes of the view that saw it last. The
/// order is that of the paper's section 5.
enum class BoundaryClass : std::uint8_t { left, right, top, bottom };

/// Names of the classes, in their order.
inline constexpr std::array<std::string_view, 4> kBoundaryClassNames{"left", "right", "top",
                                                                     "bottom"};

/// "left", "right", "top" or "bottom". Throws std::out_of_range for a number that is none of them.
[[nodiscard]] constexpr std::string_view boundary_class_name(BoundaryClass boundary_class) {
  return kBoundaryClassNames.at(static_cast<std::size_t>(boundary_class));
}

}  // namespace viewgain
