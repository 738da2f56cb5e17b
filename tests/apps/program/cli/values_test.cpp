// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include "program/cli/values.hpp"

#include <gtest/gtest.h>

#include <limits>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include "core/expect_error.hpp"
#include "viewgain/core/error.hpp"

namespace viewgain::app {
namespace {

TEST(Values, NumbersAndBoxes) {
  EXPECT_EQ(parse_numbers("--x", "1,-2.5e-3, +4", 1, 3), (std::vector<double>{1, -2.5e-3, 4}));
  for (const char* bad : {"", "1,", "a", "1,nan", "inf", "1;2", "1,2,3,4", "0x10"}) {
    EXPECT_THROW((void)parse_numbers("--x", bad, 1, 3), Error) << bad;
  }
  EXPECT_EQ(parse_box("--b", "-1,-2,-3,1,2,3"), (Box{{-1, -2, -3}, {1, 2, 3}}));
  EXPECT_THROW((void)parse_box("--b", "0,0,0,1,1,0"), Error);
  EXPECT_THROW((void)parse_box("--b", "0,0,0,1,-1,1"), Error);
  EXPECT_EQ(parse_count("--n", 12), 12U);
  for (const double bad : {-1.0, 0.5, 1e9, std::nan("")}) {
    EXPECT_THROW((void)parse_count("--n", bad), Error) << bad;
  }
  std::mt19937_64 random(3);
  for (int i = 0; i < 1000; ++i) {
    const double value = std::ldexp(static_cast<double>(random()), i % 200 - 150);
    EXPECT_EQ(std::stod(exact_text(value)), value);
    EXPECT_EQ(std::stod(short_text(value)), value);
  }
  EXPECT_EQ(exact_text(-std::nan("")), "nan");
}

TEST(Utf8Text, BytesThatAreNoUtf8AreShown) {
  const std::vector<std::pair<std::string, std::string>> texts{
      {"map.vdb", "map.vdb"},
      {"gr\xc3\xbc\xc3\x9f \xe2\x82\xac \xf0\x9f\x99\x82",
       "gr\xc3\xbc\xc3\x9f \xe2\x82\xac \xf0\x9f\x99\x82"},
      {"lat\xe9.off", "lat\\xE9.off"},
      {"\xc3", "\\xC3"},                             // cut
      {"\xc0\xaf", "\\xC0\\xAF"},                    // longer than needed
      {"\xe0\x80\xaf", "\\xE0\\x80\\xAF"},           // longer than needed
      {"\xed\xa0\x80", "\\xED\\xA0\\x80"},           // half of a surrogate pair
      {"\xf4\x90\x80\x80", "\\xF4\\x90\\x80\\x80"},  // past the last code point
      {"a\nb", "a\nb"}};
  for (const auto& [bytes, text] : texts) {
    EXPECT_EQ(utf8_text(bytes), text);
  }
}

TEST(Values, ChecksNameFlagAndValue) {
  constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  using Check = void (*)(std::string_view, double);
  const std::vector<std::pair<Check, std::vector<double>>> refused{
      {&check_finite, {kNan, kInfinity, -kInfinity}},
      {&check_positive, {kNan, kInfinity, 0, -1}},
      {&check_at_least_0, {kNan, kInfinity, -1e-300}},
      {&check_inside_0_1, {kNan, kInfinity, 0, 1, -0.5, 1.5}},
  };
  std::size_t cases = 0;
  for (const auto& [check, values] : refused) {
    for (const double value : values) {
      test::expect_error(ErrorCode::invalid_argument, "--flag " + short_text(value),
                         [&] { check("--flag", value); });
      ++cases;
    }
    check("--flag", 0.5);
  }
  check_finite("--flag", -3);
  check_at_least_0("--flag", 0);
  EXPECT_EQ(cases, 16U);
}

TEST(Values, CountsAreAList) {
  EXPECT_EQ(counts_text({}), "");
  EXPECT_EQ(counts_text({{"unreachable", 3}, {"collision", 12}}), "12 collision, 3 unreachable");
}

}  // namespace
}  // namespace viewgain::app
