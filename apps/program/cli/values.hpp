// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "viewgain/core/box.hpp"
#include "viewgain/core/error.hpp"
#include "viewgain/core/pose.hpp"
#include "viewgain/support/text.hpp"

namespace viewgain::app {

using viewgain::refuse;
/// Throws Error(invalid_argument) with "FLAG VALUE: what".
[[noreturn]] void refuse(std::string_view flag, std::string_view value, const std::string& what);

/// Numbers separated by commas; each must be finite and their count in [min_count, max_count].
/// Throws Error(invalid_argument) that names the flag and the text.
[[nodiscard]] std::vector<double> parse_numbers(std::string_view flag, std::string_view text,
                                                std::size_t min_count, std::size_t max_count);

/// Converts a value of parse_numbers() to a count: a whole number from 0 to 1e7.
[[nodiscard]] std::size_t parse_count(std::string_view flag, double value);

/// x0,y0,z0,x1,y1,z1 [m]. Throws Error(invalid_argument) if it is inside out or has no extent.
[[nodiscard]] Box parse_box(std::string_view flag, std::string_view text);
[[nodiscard]] Box box_of(std::string_view flag, const std::vector<double>& numbers);

/// Width, height, depth of a box [m]. Throws Error(invalid_argument) naming the flag if one is not
/// positive.
[[nodiscard]] std::array<double, 3> parse_size(std::string_view flag, std::string_view text);

/// tx,ty,tz,qx,qy,qz,qw. Throws Error(invalid_argument) naming the flag.
[[nodiscard]] Pose parse_pose(std::string_view flag, std::string_view text);

/// x,y,z [m]. Throws Error(invalid_argument) naming the flag.
[[nodiscard]] Eigen::Vector3d parse_point(std::string_view flag, std::string_view text);

/// The error text for a value that must be one of the names: "unknown gain surfce; did you mean
/// surface? Valid: paper, surface, combined". Empty if nothing is wrong.
[[nodiscard]] std::string fault_of_name(const std::string& value,
                                        const std::vector<std::string>& names, const char* what);

/// The names in a list with commas; none for an empty text.
[[nodiscard]] std::vector<std::string> names_in(std::string_view text);

/// "x0, y0, z0 .. x1, y1, z1", for messages.
[[nodiscard]] std::string describe(const Box& box);

/// Formats like std::printf, to at most 511 bytes.
[[nodiscard]] __attribute__((format(printf, 1, 2))) std::string formatted(const char* format, ...);

/// Makes untrusted text safe for a terminal: line ends become blanks, other control characters (C0,
/// C1 in UTF-8, DEL) question marks.
[[nodiscard]] std::string printable(std::string text) noexcept;

/// 2,097,152 for 2097152.
[[nodiscard]] std::string with_commas(unsigned long long value);

/// 83.2 M for 83200000; uses k, M or G if it helps.
[[nodiscard]] std::string with_unit(double value);

/// "12 collision, 3 unreachable"
[[nodiscard]] std::string counts_text(const std::map<std::string, std::size_t>& counts);

/// Prints how many poses were not exactly rigid and were repaired, if any.
void print_mended(std::size_t poses);

/// Checks of a flag's value. Each throws Error(invalid_argument) that names flag and value, also
/// for NaN.
void check_finite(std::string_view flag, double value);
void check_positive(std::string_view flag, double value);    ///< and finite
void check_at_least_0(std::string_view flag, double value);  ///< and finite
void check_inside_0_1(std::string_view flag, double value);  ///< neither 0 nor 1

}  // namespace viewgain::app
