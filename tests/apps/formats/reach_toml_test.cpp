// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include "viewgain/formats/reach_toml.hpp"

#include <numbers>
#include <string>
#include <utility>
#include <vector>

#include "apps/program_runner.hpp"
#include "core/expect_error.hpp"
#include "viewgain/core/error.hpp"
#include "viewgain/core/pose_io.hpp"

namespace viewgain {
namespace {

constexpr const char* kEverything = R"(
poses = "poses.txt"
[[box]]
min = [-1, -2, 0.5]
max = [1, 2, 1.5]
[[box]]
min = [0, 0, 0]
max = [1, 1, 1]
[[shell]]
center = [0, 0, 0.25]
min_radius = 0.4
max_radius = 0.9
[[half_space]]
normal = [0, 0, 2]
offset = -1
[tolerance]
distance = 0.02
angle_deg = 5
)";

class ReachFiles : public test::ProgramTest {
 protected:
  ReachRegion read_region(const std::string& text) const {
    std::filesystem::create_directories(dir / "cell");
    write("cell/reach.toml", text);
    return read_reach_toml(dir / "cell" / "reach.toml");
  }
};

TEST_F(ReachFiles, AllParts) {
  std::filesystem::create_directories(dir / "cell");
  const std::vector<Pose> poses{look_at({0.6, 0, 0.7}, {0, 0, 0}), look_at({0, 0.3, 0}, {0, 0, 0})};
  write_tum(dir / "cell" / "poses.txt", poses);
  const ReachRegion region = read_region(kEverything);
  EXPECT_EQ(region.boxes, (std::vector<Box>{{{-1, -2, 0.5}, {1, 2, 1.5}}, {{0, 0, 0}, {1, 1, 1}}}));
  ASSERT_EQ(region.shells.size(), 1U);
  EXPECT_EQ(region.shells[0].center, Eigen::Vector3d(0, 0, 0.25));
  EXPECT_EQ(region.shells[0].min_radius, 0.4);
  EXPECT_EQ(region.shells[0].max_radius, 0.9);
  ASSERT_EQ(region.half_spaces.size(), 1U);
  EXPECT_EQ(region.half_spaces[0].normal, Eigen::Vector3d(0, 0, 2));
  EXPECT_EQ(region.half_spaces[0].offset, -1);
  EXPECT_EQ(region.poses.size(), 2U);
  EXPECT_EQ(region.tolerance.distance, 0.02);
  EXPECT_NEAR(region.tolerance.angle, 5 * std::numbers::pi / 180, 1e-15);
  EXPECT_TRUE(region.contains(poses[0]));
  EXPECT_FALSE(region.contains(poses[1]));  // outside the shell
}

TEST_F(ReachFiles, EveryPartMayBeMissing) {
  const ReachRegion empty = read_region("");
  EXPECT_TRUE(empty.boxes.empty() && empty.shells.empty() && empty.half_spaces.empty() &&
              empty.poses.empty());
  EXPECT_EQ(empty.tolerance.distance, ReachRegion::Tolerance{}.distance);
  EXPECT_EQ(read_region("[tolerance]\nangle_deg = 1").tolerance.distance,
            ReachRegion::Tolerance{}.distance);
  EXPECT_EQ(
      read_region("shell = [{center = [0,0,0], min_radius = 0, max_radius = 1}]").shells.size(),
      1U);
}

TEST_F(ReachFiles, ErrorsNameFileAndKey) {
  const std::vector<std::pair<std::string, std::string>> cases{
      {"[[bocks]]\nmin = [0,0,0]", "\"bocks\" is unknown"},
      {"box = 3", "\"box\" must be a list of tables"},
      {"box = [3]", "\"box[0]\" must be a table"},
      {"[box]\nmin = [0,0,0]\nmax = [1,1,1]", "\"box\" must be a list of tables"},
      {"[[box]]\nmin = [0,0,0]", "\"box[0].max\" is missing"},
      {"[[box]]\nmin = [0,0]\nmax = [1,1,1]", "\"box[0].min\" must be a list of 3 numbers"},
      {"[[box]]\nmin = [0,0,\"0\"]\nmax = [1,1,1]", "\"box[0].min\" must be a number"},
      {"[[box]]\nmin = [0,0,nan]\nmax = [1,1,1]", "\"box[0].min\" must be finite"},
      {"[[box]]\nmin = [0,0,0]\nmax = [1,1,1]\nname = \"a\"", "\"box[0].name\" is unknown"},
      {"[[box]]\nmin = [0,0,0]\nmax = [1,-1,1]", "box 0 is inside out"},
      {"[[shell]]\ncenter = [0,0,0]\nmax_radius = 1", "\"shell[0].min_radius\" is missing"},
      {"[[shell]]\ncenter = [0,0,0]\nmin_radius = 2\nmax_radius = 1", "shell 0 is inside out"},
      {"[[half_space]]\nnormal = [0,0,0]\noffset = 1", "half-space 0 has a normal with length 0"},
      {"[[half_space]]\nnormal = [0,0,1]\noffset = \"1\"", "\"half_space[0].offset\" must be a"},
      {"poses = 3", "\"poses\" must be a string"},
      {"tolerance = 3", "\"tolerance\" must be a table"},
      {"[tolerance]\nangle = 3", "\"tolerance.angle\" is unknown"},
      {"[tolerance]\nangle_deg = -3", "\"tolerance.angle_deg\" must be at least 0, not -3"},
      {"[[box]", "line 1"}};
  for (const auto& [text, wanted] : cases) {
    for (const std::string& part : {wanted, std::string("reach.toml")}) {
      test::expect_error(ErrorCode::format, part, [&] { (void)read_region(text); });
    }
  }
  EXPECT_THROW((void)read_reach_toml(dir / "none.toml"), Error);
  EXPECT_THROW((void)read_region("poses = \"none.txt\""), Error);
  std::filesystem::create_directories(dir / "cell");
  write("cell/empty.txt", "# nothing\n");
  EXPECT_THROW((void)read_region("poses = \"empty.txt\""), Error);
}

}  // namespace
}  // namespace viewgain
