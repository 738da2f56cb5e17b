// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include "program/cli/flags/pose_source.hpp"

#include <gtest/gtest.h>

#include <cstdint>
#include <numbers>
#include <string>
#include <vector>

#include "core/expect_error.hpp"
#include "viewgain/core/error.hpp"
#include "viewgain/core/generators.hpp"

namespace viewgain::app {
namespace {

std::vector<Pose> poses(std::string PoseOptions::*set, const std::string& text,
                        const std::string& center = "", std::uint64_t seed = 1) {
  PoseOptions options;
  options.*set = text;
  options.center = center;
  return make_poses(options, seed).poses;
}

TEST(PoseSource, EverySetRoundItsCentre) {
  EXPECT_EQ(poses(&PoseOptions::sphere, "50,0.6"), sphere_poses(50, 0.6));
  EXPECT_EQ(poses(&PoseOptions::sphere, "50,0.6", "1,2,3"), sphere_poses(50, 0.6, {1, 2, 3}));
  EXPECT_EQ(poses(&PoseOptions::dome, "50,0.6", "1,2,3"), dome_poses(50, 0.6, {1, 2, 3}));
  EXPECT_EQ(poses(&PoseOptions::rings, "80,0.6"), literature_ring_poses(80, 0.6));
  EXPECT_EQ(poses(&PoseOptions::rings, "288,0.5", "1,2,3"),
            literature_ring_poses(288, 0.5, {1, 2, 3}));
  EXPECT_EQ(poses(&PoseOptions::shell, "10,0.4,0.9", "", 7), shell_poses(10, 0.4, 0.9, 7));
  constexpr std::uint64_t kLarge = 1ULL << 62U;
  EXPECT_EQ(poses(&PoseOptions::shell, "10,0.4,0.9", "1,2,3", kLarge),
            shell_poses(10, 0.4, 0.9, kLarge, {1, 2, 3}));
  EXPECT_EQ(poses(&PoseOptions::orbit, "3,0.6,90,0,180", "1,2,3"),
            orbit_poses(3, 0.6, std::numbers::pi / 2, 0, std::numbers::pi, {1, 2, 3}));
}

TEST(PoseSource, ErrorsNameTheFlag) {
  struct Case {
    std::string PoseOptions::*set;
    std::string text, center, word;
  };
  const std::vector<Case> cases{
      {&PoseOptions::rings, "64,0.5", "", "--rings"},
      {&PoseOptions::rings, "48", "", "--rings"},
      {&PoseOptions::rings, "48,0", "", "--rings"},
      {&PoseOptions::rings, "48.5,1", "", "--rings"},
      {&PoseOptions::shell, "10,0.9,0.4", "", "--shell"},
      {&PoseOptions::shell, "10,0,1", "", "--shell"},
      {&PoseOptions::shell, "0,0.4,0.9", "", "--shell"},
      {&PoseOptions::shell, "10,0.4", "", "--shell"},
      {&PoseOptions::orbit, "10,0.4", "", "--orbit"},
      {&PoseOptions::sphere, "10,0.4", "0,0", "--center"},
      {&PoseOptions::sphere, "10,0.4", "0,0,x", "--center"},
      {&PoseOptions::file, "poses.txt", "0,0,0", "--center"},
      {&PoseOptions::shell, "10,0.4,0.9,7", "", "--shell 10,0.4,0.9,7: needs 3 numbers"},
      {&PoseOptions::sphere, "10,0.4,1,2,3", "", "--sphere 10,0.4,1,2,3: needs 2 numbers"},
      {&PoseOptions::dome, "10,0.4,1", "", "--dome 10,0.4,1: needs 2 numbers"}};
  for (const Case& wrong : cases) {
    test::expect_error(ErrorCode::invalid_argument, wrong.word,
                       [&] { (void)poses(wrong.set, wrong.text, wrong.center); });
  }
}

}  // namespace
}  // namespace viewgain::app
