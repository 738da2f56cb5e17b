// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include "options/pose_source.hpp"

#include <gtest/gtest.h>

#include <string>
#include <utility>
#include <vector>

#include "viewgain/core/error.hpp"
#include "viewgain/core/generators.hpp"

namespace viewgain::app {
namespace {

std::vector<Pose> rings(const std::string& text) {
  PoseOptions options;
  options.rings = text;
  return make_poses(options).poses;
}

std::vector<Pose> shell(const std::string& text) {
  PoseOptions options;
  options.shell = text;
  return make_poses(options).poses;
}

TEST(PoseSource, RingsAndShells) {
  EXPECT_EQ(rings("80,0.6"), literature_ring_poses(80, 0.6));
  EXPECT_EQ(rings("288,0.5,1,2,3"), literature_ring_poses(288, 0.5, {1, 2, 3}));
  EXPECT_EQ(shell("10,0.4,0.9,7"), shell_poses(10, 0.4, 0.9, 7));
  EXPECT_EQ(shell("10,0.4,0.9,9007199254740992,1,2,3"),
            shell_poses(10, 0.4, 0.9, 9007199254740992U, {1, 2, 3}));
}

TEST(PoseSource, ErrorsNameTheFlag) {
  const std::vector<std::pair<bool, std::string>> cases{
      {true, "64,0.5"},           {true, "48"},          {true, "48,0"},
      {true, "48,0.5,1,2"},       {true, "48.5,1"},      {false, "10,0.4,0.9"},
      {false, "10,0.9,0.4,1"},    {false, "10,0,1,1"},   {false, "0,0.4,0.9,1"},
      {false, "10,0.4,0.9,-1"},   {false, "10,1,2,0.5"}, {false, "10,1,2,9007199254740994"},
      {false, "10,1,2,3,0.1,0.2"}};
  std::size_t count = 0;
  for (const auto& [is_rings, text] : cases) {
    try {
      (void)(is_rings ? rings(text) : shell(text));
      ADD_FAILURE() << text;
    } catch (const Error& error) {
      EXPECT_EQ(error.code(), ErrorCode::invalid_argument);
      const std::string flag = is_rings ? "--rings" : "--shell";
      EXPECT_NE(std::string(error.what()).find(flag), std::string::npos) << error.what();
    }
    ++count;
  }
  EXPECT_EQ(count, 13U);
}

}  // namespace
}  // namespace viewgain::app
