// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include "viewgain/core/reach.hpp"

#include <gtest/gtest.h>

#include <limits>

#include "expect_error.hpp"
#include "random_values.hpp"

namespace viewgain {
namespace {

using test::expect_error;
using test::RandomValues;

constexpr double kDegree = std::numbers::pi / 180;

Pose at(double x, double y, double z) { return {Eigen::Matrix3d::Identity(), {x, y, z}}; }

TEST(Reach, EmptyIsEverywhere) {
  EXPECT_TRUE(ReachRegion{}.contains(at(1e6, -1e6, 0)));
  EXPECT_NO_THROW(ReachRegion{}.validate());
}

TEST(Reach, Boxes) {
  ReachRegion region;
  region.boxes = {{{0, 0, 0}, {1, 2, 3}}, {{5, 5, 5}, {6, 6, 6}}};
  for (const Pose& inside : {at(0.5, 1, 1), at(0, 0, 0), at(1, 2, 3), at(5.5, 5.5, 5.5)}) {
    EXPECT_TRUE(region.contains(inside));
  }
  for (const Pose& outside :
       {at(-1e-9, 1, 1), at(1 + 1e-9, 1, 1), at(0.5, 2.1, 1), at(0.5, 1, 3.1), at(4, 4, 4)}) {
    EXPECT_FALSE(region.contains(outside));
  }
}

TEST(Reach, Shells) {
  ReachRegion region;
  region.shells = {{{1, 0, 0}, 0.5, 2}, {{100, 0, 0}, 0, 1}};
  for (const double distance : {0.5, 1.0, 2.0}) {
    EXPECT_TRUE(region.contains(at(1 + distance, 0, 0)));
    EXPECT_TRUE(region.contains(at(1, 0, -distance)));
  }
  EXPECT_TRUE(region.contains(at(100, 0, 0)));
  for (const double distance : {0.0, 0.499, 2.001}) {
    EXPECT_FALSE(region.contains(at(1, distance, 0)));
  }
}

TEST(Reach, EveryHalfSpaceCounts) {
  ReachRegion region;
  region.half_spaces = {{{0, 0, 2}, 1}, {{-1, 0, 0}, -3}};  // z >= 0.5 and x <= 3
  EXPECT_TRUE(region.contains(at(3, 0, 0.5)));
  EXPECT_TRUE(region.contains(at(-10, 7, 4)));
  EXPECT_FALSE(region.contains(at(3, 0, 0.499)));
  EXPECT_FALSE(region.contains(at(3.001, 0, 1)));
}

TEST(Reach, ToleranceOfPosesOnBothSides) {
  RandomValues random(1);
  int cases = 0;
  for (int i = 0; i < 500; ++i) {
    const Pose pose(random.rotation(), random.vector());
    const std::array<Pose, 3> poses{at(50, 0, 0), pose, at(0, 50, 0)};
    const auto moved = [&](double distance, double angle) {
      const Eigen::AngleAxisd turn(angle, random.unit_vector());
      return Pose(pose.rotation() * turn.toRotationMatrix(),
                  pose.translation() + distance * random.unit_vector());
    };
    EXPECT_TRUE(is_among(pose, poses));
    EXPECT_TRUE(is_among(moved(0.00999, 1.999 * kDegree), poses));
    EXPECT_FALSE(is_among(moved(0.01001, 0), poses));
    EXPECT_FALSE(is_among(moved(0, 2.001 * kDegree), poses));
    EXPECT_FALSE(is_among(moved(0, 179.9 * kDegree), poses));
    EXPECT_FALSE(is_among(moved(0, std::numbers::pi), poses));
    // Angles far under a millidegree are told apart.
    EXPECT_TRUE(is_among(moved(0, 1e-7), poses, {1e-9, 1.1e-7}));
    EXPECT_FALSE(is_among(moved(0, 1e-7), poses, {1e-9, 0.9e-7}));
    ++cases;
  }
  EXPECT_EQ(cases, 500);
  EXPECT_FALSE(is_among(Pose(), {}));
}

TEST(Reach, Poses) {
  ReachRegion region;
  region.poses = {at(1, 0, 0), at(2, 0, 0)};
  EXPECT_TRUE(region.contains(at(2.005, 0, 0)));
  EXPECT_FALSE(region.contains(at(1.5, 0, 0)));
  region.tolerance.distance = 0.6;
  EXPECT_TRUE(region.contains(at(1.5, 0, 0)));
  const Eigen::AngleAxisd turn(3 * kDegree, Eigen::Vector3d::UnitY());
  const Pose turned(turn.toRotationMatrix(), {1, 0, 0});
  EXPECT_FALSE(region.contains(turned));
  region.tolerance.angle = 4 * kDegree;
  EXPECT_TRUE(region.contains(turned));
}

TEST(Reach, PredicateIsAskedLast) {
  ReachRegion region;
  int asked = 0;
  region.boxes = {{{0, 0, 0}, {1, 1, 1}}};
  region.predicate = [&asked](const Pose& pose) {
    ++asked;
    return pose.translation().x() > 0.5;
  };
  EXPECT_FALSE(region.contains(at(2, 0, 0)));
  EXPECT_EQ(asked, 0);
  EXPECT_FALSE(region.contains(at(0.2, 0, 0)));
  EXPECT_TRUE(region.contains(at(0.7, 0, 0)));
  EXPECT_EQ(asked, 2);
}

// Each part says yes or no to a pose of its own; together they say yes only if all do.
TEST(Reach, AllPartsMustAgree) {
  int cases = 0, inside = 0;
  for (int agree = 0; agree < 32; ++agree, ++cases) {
    const auto says = [agree](int part) { return ((agree >> part) & 1) != 0; };
    ReachRegion region;
    const double x = says(0) ? 0 : 10;
    region.boxes = {{{x, 0, 0}, {x + 1, 1, 1}}};
    region.shells = {{{0.5, 0.5, 0.5}, says(1) ? 0.0 : 3.0, 4}};
    region.half_spaces = {{{0, 0, 1}, says(2) ? 0.0 : 5.0}};
    region.poses = {says(3) ? at(0.5, 0.5, 0.5) : at(9, 9, 9)};
    region.predicate = [&says](const Pose&) { return says(4); };
    EXPECT_NO_THROW(region.validate());
    EXPECT_EQ(region.contains(at(0.5, 0.5, 0.5)), agree == 31) << agree;
    inside += agree == 31 ? 1 : 0;
  }
  EXPECT_EQ(cases, 32);
  EXPECT_EQ(inside, 1);
}

TEST(Reach, RefusesWhatMakesNoSense) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const auto refuse = [](const std::string& part, const auto& change) {
    ReachRegion region;
    change(region);
    expect_error(ErrorCode::invalid_argument, part, [&region] { region.validate(); });
  };
  const Box good{{0, 0, 0}, {1, 1, 1}};
  refuse("box 1 is inside out", [&](ReachRegion& r) { r.boxes = {good, {{0, 2, 0}, {1, 1, 1}}}; });
  refuse("box 0 is not finite", [&](ReachRegion& r) { r.boxes = {{{0, nan, 0}, {1, 1, 1}}}; });
  refuse("shell 0 is inside out", [](ReachRegion& r) { r.shells = {{{0, 0, 0}, 2, 1}}; });
  refuse("shell 0 has the negative radius -", [](ReachRegion& r) {
    r.shells = {{{0, 0, 0}, -2, 1}};
  });
  refuse("shell 0 is not finite", [&](ReachRegion& r) { r.shells = {{{0, nan, 0}, 0, 1}}; });
  refuse("half-space 0 has a normal with length 0", [](ReachRegion& r) {
    r.half_spaces = {{{0, 0, 0}, 1}};
  });
  refuse("half-space 0 is not finite", [&](ReachRegion& r) { r.half_spaces = {{{0, 0, 1}, nan}}; });
  refuse("pose 0", [&](ReachRegion& r) { r.poses = {at(nan, 0, 0)}; });
  refuse("distance tolerance", [](ReachRegion& r) { r.tolerance.distance = -1; });
  refuse("angle tolerance", [&](ReachRegion& r) { r.tolerance.angle = nan; });
}

}  // namespace
}  // namespace viewgain
