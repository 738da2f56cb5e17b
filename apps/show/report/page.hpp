// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "viewgain/support/json.hpp"

namespace viewgain::app {

/// Throws Error(invalid_argument), naming the flag and what to install, in a program that was built
/// where npm was missing, so that there is no page to put data into.
void check_report_page(std::string_view flag);

/// The page with these data in it: `page`, or the one that the program was built with. Text that is
/// not UTF-8 is shown with replacement characters; nothing in the data can end the element that
/// holds them. Throws Error(format) unless the page has the place for data once.
[[nodiscard]] std::string report_page(const Json& data);
[[nodiscard]] std::string report_page(const Json& data, std::string_view page);

/// Atomic: a temporary file is renamed. Throws Error(io).
void write_report(const std::filesystem::path& path, const Json& data);

// Numbers as the report's page reads them; README.md, "Data", says how a block is stored. Rows one
// after the other; throws Error(backend) if zlib fails.

[[nodiscard]] Json float_block(const std::vector<float>& values, std::size_t columns);
[[nodiscard]] Json index_block(const std::vector<std::uint32_t>& values, std::size_t columns);
[[nodiscard]] Json byte_block(const std::vector<std::uint8_t>& values);

/// Points [m], each coordinate to 1/65,534 of their bounding box.
[[nodiscard]] Json point_block(std::span<const Eigen::Vector3d> points);

/// One number a row, to 1/254 of their range; not finite is NaN. For colours.
[[nodiscard]] Json shade_block(const std::vector<double>& values);

[[nodiscard]] std::string base64(std::string_view bytes);

}  // namespace viewgain::app
