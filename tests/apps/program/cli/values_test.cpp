// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0

#include "program/cli/values.hpp"

#include <gtest/gtest.h>

#include <cstdint>
#include <limits>
#include <numbers>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include "core/expect_error.hpp"
#include "program/cli/flags/pose_source.hpp"
#include "viewgain/core/error.hpp"
#include "viewgain/core/generators.hpp"

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

std::vector<Pose> poses(const std::string& text, const std::string& center = "",
                        std::uint64_t seed = 1) {
  return make_poses({text, center}, seed).poses;
}

TEST(PoseSource, EverySetRoundItsCentre) {
  EXPECT_EQ(poses("sphere:50,0.6"), sphere_poses(50, 0.6));
  EXPECT_EQ(poses("sphere:50,0.6", "1,2,3"), sphere_poses(50, 0.6, {1, 2, 3}));
  EXPECT_EQ(poses("dome:50,0.6", "1,2,3"), dome_poses(50, 0.6, {1, 2, 3}));
  EXPECT_EQ(poses("rings:80,0.6"), literature_ring_poses(80, 0.6));
  EXPECT_EQ(poses("rings:288,0.5", "1,2,3"), literature_ring_poses(288, 0.5, {1, 2, 3}));
  EXPECT_EQ(poses("shell:10,0.4,0.9", "", 7), shell_poses(10, 0.4, 0.9, 7));
  constexpr std::uint64_t kLarge = 1ULL << 62U;
  EXPECT_EQ(poses("shell:10,0.4,0.9", "1,2,3", kLarge),
            shell_poses(10, 0.4, 0.9, kLarge, {1, 2, 3}));
  EXPECT_EQ(poses("orbit:3,0.6,90,0,180", "1,2,3"),
            orbit_poses(3, 0.6, std::numbers::pi / 2, 0, std::numbers::pi, {1, 2, 3}));
}

TEST(Printable, AStrangersTextCommandsNoTerminal) {
  const std::vector<std::pair<std::string, std::string>> cases{
      {"", ""},
      {"sr4000, 2 m~", "sr4000, 2 m~"},
      {"a\nhash  0\r\n", "a hash  0  "},
      {"\x1b[31mred\a\t\x7f", "?[31mred???"},
      {std::string("nul\0", 4), "nul?"},
      {"\xC2\x9B"
       "31m",
       "??31m"},                                     // CSI in one character
      {"\xC3\xA9 \xC2\xB5m", "\xC3\xA9 \xC2\xB5m"},  // e acute, micro
      {"\x9B", "\x9B"},
      {"\xC2", "\xC2"}};
  for (const auto& [text, safe] : cases) EXPECT_EQ(printable(text), safe);
}

TEST(PoseSource, ErrorsNameTheFlag) {
  struct Case {
    std::string poses, center, word;
  };
  const std::vector<Case> cases{
      {"rings:64,0.5", "", "--poses rings:64,0.5: "},
      {"rings:48,0", "", "--poses rings:48,0: "},
      {"rings:48.5,1", "", "--poses"},
      {"shell:10,0.9,0.4", "", "--poses shell"},
      {"shell:10,0,1", "", "--poses shell"},
      {"shell:10,0.4", "", "--poses"},
      {"orbit:10,0.4", "", "--poses"},
      {"sphere:10,0.4", "0,0,x", "--center"},
      {"poses.txt", "0,0,0", "--center"},
      {"shell:10,0.4,0.9,7", "", "expected 3 numbers separated by commas; found 4"},
      {"dome:10,0.4,1", "", "expected 2 numbers separated by commas; found 3"}};
  for (const Case& wrong : cases) {
    test::expect_error(ErrorCode::invalid_argument, wrong.word,
                       [&] { (void)poses(wrong.poses, wrong.center); });
  }
  EXPECT_TRUE(is_set_of_poses("orbit:1,2,3"));
  for (const char* file : {"orbit", "sphere.txt", "a/sphere:2", "cone:3,1", ""}) {
    EXPECT_FALSE(is_set_of_poses(file)) << file;
  }
}

}  // namespace
}  // namespace viewgain::app
