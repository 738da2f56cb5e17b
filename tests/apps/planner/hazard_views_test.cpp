// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: GPL-3.0-or-later

// Views of places where the hazard expects surface, against sums voxel by voxel.
#include "viewgain/planner/hazard_views.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <memory>
#include <vector>

#include "apps/planner/planner_scene.hpp"
#include "core/expect_error.hpp"
#include "grid/voxels.hpp"
#include "support/meshes.hpp"
#include "viewgain/planner_mesh/candidate_generation.hpp"

namespace viewgain {
namespace {

constexpr double kVoxel = 0.01;
constexpr double kDistance = 0.45, kSpacing = 0.03;  // [m]
constexpr double kMost = 1e6;
constexpr std::array<std::array<int, 3>, 6> kSides{
    {{-1, 0, 0}, {1, 0, 0}, {0, -1, 0}, {0, 1, 0}, {0, 0, -1}, {0, 0, 1}}};

// A box of 0.2 m, seen from some sides.
SurfaceModel box_model(const std::vector<Pose>& views) {
  const Sensor sensor = test::half_sr4000();
  SurfaceModel model(sensor, test::model_config(sensor, 0.2, kVoxel), nullptr, {});
  const SimulatedSensor camera(std::make_shared<const SurfaceScene>(test::cube_mesh(0.1)), sensor,
                               {});
  for (std::size_t i = 0; i < views.size(); ++i) {
    (void)model.update({views[i], std::vector<DepthFrame>(3, camera.acquire(views[i], i)), {}});
  }
  return model;
}

const Pose kFromAbove = look_at({0.2, 0.3, 0.5}, {0, 0, 0});

// What is to be expected behind the faces of a cube, by grid and hazard alone.
struct Expected {
  double area = 0;                                // [m²]
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();  // [m³]
  std::array<double, 6> by_side{};                // [m²]
};

// A scene whose hazard cells are voxels.
std::vector<Expected> expected_places(const VoxelScene& scene) {
  const GridSnapshot& snapshot = scene.snapshot();
  const HazardField& hazard = scene.hazard();
  const VoxelBox box = hazard.near_box();
  std::map<std::array<int, 3>, Expected> cubes;
  const auto is_unknown = [&](Index3 v) {
    if (!box.contains(v) || snapshot.is_free(v)) return false;
    const GridSnapshot::Leaf* leaf = snapshot.find_leaf(v);
    const unsigned offset = static_cast<unsigned>(((v.x & 7) * 8 + (v.y & 7)) * 8 + (v.z & 7));
    return leaf == nullptr || (leaf->occupied[offset / 64] >> (offset % 64) & 1U) == 0;
  };
  test::for_each_voxel(box, [&](Index3 voxel) {
    const auto [x, y, z] = voxel;
    if (!is_unknown({x, y, z})) return;
    for (std::size_t s = 0; s < kSides.size(); ++s) {
      const auto [dx, dy, dz] = kSides[s];
      const Index3 before{x + dx, y + dy, z + dz};
      if (!box.contains(before) || !snapshot.is_free(before)) continue;
      double survives = 1;
      for (Index3 v{x, y, z}; is_unknown(v) && hazard.is_new(v);
           v = {v.x - dx, v.y - dy, v.z - dz}) {
        survives *= std::exp(-kVoxel * static_cast<double>(hazard.rate(v)));
      }
      const double area = kVoxel * kVoxel * (1 - survives);
      if (area == 0) continue;
      const Eigen::Vector3d p = kVoxel * Eigen::Vector3d(x + 0.5, y + 0.5, z + 0.5);
      const auto cube = [](double value) { return static_cast<int>(std::floor(value / kSpacing)); };
      Expected& e = cubes[{cube(p.x()), cube(p.y()), cube(p.z())}];
      e.area += area, e.sum += area * p, e.by_side[s] += area;
    }
  });
  std::vector<Expected> places;
  for (const auto& [key, place] : cubes) places.push_back(place);
  std::stable_sort(places.begin(), places.end(),
                   [](const Expected& a, const Expected& b) { return a.area > b.area; });
  return places;
}

TEST(HazardViews, LookAtThePlacesOfMostAreaToBeExpected) {
  const SurfaceModel model = box_model({kFromAbove});
  ASSERT_EQ(model.scene()->hazard().cell_shift(), 0);
  const std::vector<Expected> places = expected_places(*model.scene());
  const std::vector<Pose> views =
      hazard_views(*model.scene(), kDistance, kSpacing, static_cast<std::size_t>(kMost));
  ASSERT_GT(places.size(), 20U);
  ASSERT_EQ(views.size(), 5 * places.size());
  int cases = 0;
  for (std::size_t k = 0; k < places.size(); ++k) {
    if (k > 0 && places[k - 1].area - places[k].area < 1e-12) continue;  // in either order
    if (k + 1 < places.size() && places[k].area - places[k + 1].area < 1e-12) continue;
    const Eigen::Vector3d target = places[k].sum / places[k].area;
    Eigen::Vector3d n;
    for (std::size_t a = 0; a < 3; ++a) {
      const double low = places[k].by_side[2 * a], high = places[k].by_side[2 * a + 1];
      n[static_cast<Eigen::Index>(a)] = high >= low ? high : -low;
    }
    for (std::size_t i = 0; i < 5; ++i, ++cases) {
      const Pose& view = views[5 * k + i];
      EXPECT_LT((view * Eigen::Vector3d(0, 0, kDistance) - target).norm(), 1e-7) << k;
      const double cosine = (view.translation() - target).dot(n.normalized()) / kDistance;
      EXPECT_NEAR(cosine, i == 0 ? 1 : std::sqrt(0.75), 1e-7) << k << ' ' << i;
    }
  }
  EXPECT_GT(cases, 100);
}

// Rates that are given in one octant alone: nothing is looked at but what has it straight behind.
TEST(HazardViews, FollowRatesThatAreGiven) {
  const SurfaceModel seen = box_model({kFromAbove});
  const VoxelBox box = seen.scene()->hazard().near_box();
  HazardConfig config;
  auto volume = std::make_shared<HazardConfig::Volume>();
  volume->box = box;
  test::for_each_voxel(box, [&](Index3 v) {
    volume->rates.push_back(v.x < 0 && v.y < 0 && v.z < 0 ? 50.0F : 0.0F);
  });
  config.volume = volume;
  const auto scene = VoxelScene::build(seen.grid(), {}, {}, config);
  int cases = 0;
  for (const Pose& view : hazard_views(*scene, kDistance, kSpacing, 200)) {
    const Eigen::Vector3d target = view * Eigen::Vector3d(0, 0, kDistance);
    EXPECT_GE((target.array() < 0).count(), 2) << target.transpose();
    ++cases;
  }
  EXPECT_GE(cases, 5);
  volume = std::make_shared<HazardConfig::Volume>(*volume);
  volume->rates.assign(volume->rates.size(), 0.0F);
  config.volume = volume;
  EXPECT_TRUE(hazard_views(*VoxelScene::build(seen.grid(), {}, {}, config), kDistance, kSpacing, 9)
                  .empty());
}

TEST(HazardViews, AreNoneOfAnEmptyMapAndAtMostAsManyAsAskedFor) {
  const SurfaceModel seen = box_model({kFromAbove});
  const std::vector<Pose> all = hazard_views(*seen.scene(), kDistance, kSpacing, 1000);
  for (const std::size_t most : {std::size_t{0}, std::size_t{1}, std::size_t{7}}) {
    const std::vector<Pose> first = hazard_views(*seen.scene(), kDistance, kSpacing, most);
    ASSERT_EQ(first.size(), most);
    for (std::size_t i = 0; i < most; ++i) EXPECT_EQ(first[i].m, all[i].m);
  }
  const BeliefGrid empty(test::model_config(test::half_sr4000(), 0.2, kVoxel).map.grid());
  EXPECT_TRUE(hazard_views(*VoxelScene::build(empty), kDistance, kSpacing, 10).empty());
  int cases = 0;
  for (const double bad : {0.0, -1.0, std::numeric_limits<double>::infinity(),
                           std::numeric_limits<double>::quiet_NaN()}) {
    for (const bool first : {true, false}) {
      test::expect_error(ErrorCode::invalid_argument, "distance and spacing must be positive", [&] {
        (void)hazard_views(*seen.scene(), first ? bad : 1, first ? 1 : bad, 10);
      });
      ++cases;
    }
  }
  EXPECT_EQ(cases, 8);
}

// Where many boundaries are open they alone are proposed; of a box that was seen from all sides few
// or none are, but rests of unknown space.
TEST(HazardViews, AreProposedWhereFewBoundariesAreOpen) {
  std::vector<Pose> views{kFromAbove};
  for (const int count : {1, 8}) {
    for (int i = 1; i < count; ++i) {
      views.push_back(
          look_at({i & 1 ? 0.3 : -0.3, i & 2 ? 0.3 : -0.3, i & 4 ? 0.3 : -0.3}, {0, 0, 0}));
    }
    const SurfaceModel model = box_model(views);
    BoundaryGeneration generation(model, default_boundary(model.scorer().sensor(), kVoxel));
    const Proposal proposal = generation.generate({});
    const std::size_t of_boundaries = generation.estimated().candidates.size();
    EXPECT_EQ(of_boundaries >= 200, count == 1) << of_boundaries;
    EXPECT_EQ(proposal.candidates.size() > of_boundaries, count > 1);
    EXPECT_LE(proposal.candidates.size(), std::max<std::size_t>(200, of_boundaries));
    for (std::size_t i = 0; i < proposal.candidates.size(); ++i) {
      EXPECT_EQ(proposal.candidates[i].generator, i < of_boundaries ? "boundary" : kHazardViews);
    }
  }
}

// Each stands in the reach, before one of the places, and looks at it, at the middle of all or
// between the two.
TEST(ReachableHazardViews, StandInTheReachBeforeThePlaces) {
  const SurfaceModel model = box_model({kFromAbove});
  const std::vector<Expected> places = expected_places(*model.scene());
  double sum = 0;
  Eigen::Vector3d middle = Eigen::Vector3d::Zero();
  for (const Expected& place : places) sum += place.area, middle += place.sum;
  middle /= sum;
  ReachRegion half;
  half.half_spaces = {{Eigen::Vector3d(1, 0, 1), 0.05}};
  int cases = 0;
  for (const ReachRegion& reach : {ReachRegion{}, half}) {
    const std::vector<Pose> views =
        reachable_hazard_views(*model.scene(), reach, kDistance, kSpacing, 90);
    EXPECT_EQ(views.size(), 90U);
    std::map<double, int> at_distance;
    for (const Pose& view : views) {
      ASSERT_TRUE(reach.contains(view));
      const Eigen::Vector3d eye = view.translation(), axis = view.rotation().col(2);
      bool found = false;
      for (const Expected& place : places) {
        const Eigen::Vector3d target = place.sum / place.area;
        for (const double far : {1.0, 1.6, 2.5}) {
          if (std::abs((eye - target).norm() - far * kDistance) > 1e-7) continue;
          for (const double to_middle : {0.0, 0.5, 1.0}) {
            const Eigen::Vector3d aim = target + to_middle * (middle - target);
            if (axis.dot((aim - eye).normalized()) < 1 - 1e-9) continue;
            if (!found) ++at_distance[far];
            found = true;
          }
        }
      }
      EXPECT_TRUE(found) << eye.transpose();
      ++cases;
    }
    for (const double far : {1.0, 1.6, 2.5}) EXPECT_GE(at_distance[far], 25) << far;
  }
  EXPECT_EQ(cases, 180);
}

TEST(ReachableHazardViews, AreNoneWhereNothingIsWantedOrReached) {
  const SurfaceModel model = box_model({kFromAbove});
  EXPECT_TRUE(reachable_hazard_views(*model.scene(), {}, kDistance, kSpacing, 0).empty());
  ReachRegion far;
  far.shells = {{{10, 0, 0}, 0, 1}};
  EXPECT_TRUE(reachable_hazard_views(*model.scene(), far, kDistance, kSpacing, 50).empty());
  const BeliefGrid empty(test::model_config(test::half_sr4000(), 0.2, kVoxel).map.grid());
  EXPECT_TRUE(
      reachable_hazard_views(*VoxelScene::build(empty), {}, kDistance, kSpacing, 50).empty());
}

// Candidates of boundaries are joined by views from the reach, if it is a region.
TEST(ReachableHazardViews, JoinTheBoundaries) {
  const SurfaceModel model = box_model({kFromAbove});
  ReachRegion half, list;
  half.half_spaces = {{Eigen::Vector3d::UnitX(), 0.1}};
  list.poses = {look_at({0.4, 0, 0.1}, {0, 0, 0})};
  int cases = 0;
  for (const auto& [reach, expected] :
       {std::pair(ReachRegion{}, false), std::pair(half, true), std::pair(list, false)}) {
    for (const bool at_boundaries : {true, false}) {
      GenerationConfig config = default_generation(model.scorer().sensor(), kVoxel);
      config.feasibility.reach = reach;
      config.at_boundaries = at_boundaries;
      config.sets = {{"one", {look_at({0.3, 0.2, 0.2}, {0, 0, 0})}}};
      CandidateGeneration generation(model, config, {});
      const Proposal proposal = generation.generate({});
      const auto from_reach = std::count_if(
          proposal.candidates.begin(), proposal.candidates.end(),
          [](const Candidate& candidate) { return candidate.generator == kReachViews; });
      EXPECT_EQ(from_reach > 100, expected && at_boundaries) << from_reach;
      EXPECT_EQ(from_reach > 0, expected && at_boundaries) << from_reach;
      for (const Candidate& candidate : proposal.candidates) {
        EXPECT_TRUE(reach.contains(candidate.T_world_camera));
      }
      ++cases;
    }
  }
  EXPECT_EQ(cases, 6);
}

}  // namespace
}  // namespace viewgain
