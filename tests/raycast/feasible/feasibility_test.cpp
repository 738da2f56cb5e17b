// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include "viewgain/raycast/feasibility.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <map>
#include <set>

#include "grid/voxels.hpp"
#include "raycast/scene_makers.hpp"
#include "solids.hpp"
#include "support/meshes.hpp"
#include "viewgain/core/error.hpp"
#include "viewgain/raycast/obstacle_view.hpp"

namespace viewgain {
namespace {

using test::cube_mesh;
using test::overlap;
using test::Random;
using test::random_rigid;
using test::reaches_into;
using test::Solid;
using test::uniform;

constexpr double kVoxel = 0.003;  // [m]

/// A map of n³ voxels of which those that `is_non_free` names are unknown or occupied in turn.
template <typename Choose>
BeliefGrid map_of(int n, const Pose& T_world_grid, const Choose& is_non_free) {
  const double side = kVoxel * n;
  const GridConfig config{kVoxel, {{0, 0, 0}, {side, side, side}}, T_world_grid, 0.01};
  std::vector<std::uint8_t> states;
  test::for_each_voxel(VoxelBox{{0, 0, 0}, {n, n, n}}, [&](Index3 voxel) {
    const auto [x, y, z] = voxel;
    states.push_back(is_non_free(x, y, z) ? ((x + y + z) % 2 == 0 ? 0 : 2) : 1);
  });
  return BeliefGrid::from_states(config, states);
}

BeliefGrid free_map() {
  return map_of(16, {}, [](int, int, int) { return false; });
}

FeasibilityChecker checker_of(const BeliefGrid& grid, const FeasibilityConfig& config = {},
                              const Surroundings& surroundings = {}) {
  return {VoxelScene::build(grid, surroundings), config};
}

// The camera looks along -z from `eye`, its x axis along the world's.
Pose looking_down(const Eigen::Vector3d& eye) {
  return {Eigen::Vector3d(1, -1, -1).asDiagonal(), eye};
}

Eigen::Vector3d half_size(const FeasibilityConfig& config) {
  const auto& s = config.body.size;
  return Eigen::Vector3d(s[0], s[1], s[2]) / 2 + Eigen::Vector3d::Constant(config.clearance);
}

// From the definition of FeasibilityConfig::Body, by another way than the checker's.
Solid body_of(const FeasibilityConfig& config, const Pose& T_world_camera) {
  const double depth = config.body.size[2];
  if (!config.body.T_flange_camera) {
    const Eigen::Matrix3d R = T_world_camera.rotation();
    return {T_world_camera.translation() - R.col(2) * depth / 2, R, half_size(config)};
  }
  const Eigen::Isometry3d T_world_flange =
      T_world_camera.isometry() * config.body.T_flange_camera->isometry().inverse();
  return {T_world_flange * Eigen::Vector3d(0, 0, depth / 2), T_world_flange.linear(),
          half_size(config)};
}

TEST(Feasibility, BodiesAgainstEveryVoxel) {
  Random random(1);
  std::map<Infeasibility, int> answers;
  for (int map = 0; map < 12; ++map) {
    const double share = map % 3 == 0 ? 0.001 : map % 3 == 1 ? 0.01 : 0.2;
    const Pose T_world_grid = map % 4 == 0 ? Pose() : random_rigid(random, 2.0);
    std::vector<Index3> non_free;
    // A block of 8³ that is unknown as a whole, and specks.
    const BeliefGrid grid = map_of(20, T_world_grid, [&](int x, int y, int z) {
      const bool block = map % 2 == 0 && x / 8 == 1 && y / 8 == 0 && z / 8 == 1;
      const bool is = block || uniform(random, 0, 1) < share;
      if (is) non_free.push_back({x, y, z});
      return is;
    });
    FeasibilityConfig config;
    config.body.size = {uniform(random, 0.001, 0.03), uniform(random, 0.001, 0.03),
                        uniform(random, 0.001, 0.03)};
    config.clearance = map % 5 == 0 ? 0.002 : 0;
    if (map % 3 != 0) config.body.T_flange_camera = random_rigid(random, 0.02);
    const FeasibilityChecker checker = checker_of(grid, config);
    const double radius = half_size(config).norm() + kVoxel;
    for (int i = 0; i < 150; ++i) {
      Pose pose = random_rigid(random, 1.0);
      const Eigen::Vector3d eye =
          T_world_grid * Eigen::Vector3d(uniform(random, -0.01, 0.07), uniform(random, -0.01, 0.07),
                                         uniform(random, -0.01, 0.07));
      pose = Pose(pose.rotation(), eye);
      const Solid body = body_of(config, pose);
      bool expected = false;
      for (const Index3& v : non_free) {
        const Eigen::Vector3d center =
            T_world_grid *
            Eigen::Vector3d(kVoxel * (v.x + 0.5), kVoxel * (v.y + 0.5), kVoxel * (v.z + 0.5));
        const Solid voxel{center, T_world_grid.rotation(), Eigen::Vector3d::Constant(kVoxel / 2)};
        if (voxel.contains(eye) ||
            ((center - body.center).norm() < radius && overlap(body, voxel))) {
          expected = true;
          break;
        }
      }
      const Infeasibility answer = checker.check(pose);
      ASSERT_EQ(answer, expected ? Infeasibility::collision : Infeasibility::none)
          << "map " << map << ", pose " << i;
      ++answers[answer];
    }
  }
  EXPECT_GT(answers[Infeasibility::none], 300);
  EXPECT_GT(answers[Infeasibility::collision], 300);
}

TEST(Feasibility, BodiesAgainstObstacles) {
  Random random(2);
  const BeliefGrid grid = free_map();
  std::map<Infeasibility, int> answers;
  const auto anywhere = [&random] {
    return Eigen::Vector3d(uniform(random, -0.2, 0.2), uniform(random, -0.2, 0.2),
                           uniform(random, -0.2, 0.2));
  };
  for (int scene = 0; scene < 20; ++scene) {
    Obstacles obstacles;
    std::vector<test::Polygon> triangles;
    TriangleMesh mesh;
    for (int i = 0; i < 15; ++i) {
      const Eigen::Vector3d at = anywhere();
      test::Polygon triangle;
      for (std::uint32_t k = 0; k < 3; ++k) {
        const Eigen::Vector3d p = at + 0.4 * anywhere();
        triangle.push_back(p);
        mesh.vertices.push_back({p.x(), p.y(), p.z()});
      }
      const auto first = static_cast<std::uint32_t>(3 * i);
      mesh.triangles.push_back({first, first + 1, first + 2});
      triangles.push_back(triangle);
    }
    obstacles.meshes.push_back(mesh);
    for (int i = 0; i < 5; ++i) {
      const Eigen::Vector3d p = anywhere(), size = 0.2 * anywhere().cwiseAbs();
      obstacles.boxes.push_back(
          {{p.x(), p.y(), p.z()}, {p.x() + size.x(), p.y() + size.y(), p.z() + size.z()}});
    }
    FeasibilityConfig config;
    config.body.size = {uniform(random, 0.02, 0.1), uniform(random, 0.02, 0.1),
                        uniform(random, 0.02, 0.1)};
    const FeasibilityChecker checker = checker_of(grid, config, {obstacles});
    for (int i = 0; i < 200; ++i) {
      const Pose pose(random_rigid(random, 1).rotation(), anywhere());
      const Solid body = body_of(config, pose);
      const bool expected =
          std::any_of(triangles.begin(), triangles.end(),
                      [&](const test::Polygon& t) { return reaches_into(t, body); }) ||
          std::any_of(obstacles.boxes.begin(), obstacles.boxes.end(),
                      [&](const Box& box) { return overlap(Solid::of(box), body); });
      const Infeasibility answer = checker.check(pose);
      ASSERT_EQ(answer, expected ? Infeasibility::obstacle : Infeasibility::none)
          << "scene " << scene << ", pose " << i;
      ++answers[answer];
    }
  }
  EXPECT_GT(answers[Infeasibility::none], 500);
  EXPECT_GT(answers[Infeasibility::obstacle], 500);
}

TEST(Feasibility, ClosedMeshesAreSolidOpenOnesAreSheets) {
  const BeliefGrid grid = free_map();
  const TriangleMesh cube = cube_mesh(0.1);
  const Pose inside = looking_down({0, 0, -0.04}), outside = looking_down({0, 0, 0.5});
  TriangleMesh separate;  // corners of its own for each triangle, as in an STL file
  for (const auto& triangle : cube.triangles) {
    for (const std::uint32_t i : triangle) separate.vertices.push_back(cube.vertices[i]);
    const auto n = static_cast<std::uint32_t>(separate.vertices.size());
    separate.triangles.push_back({n - 3, n - 2, n - 1});
  }
  TriangleMesh inward = cube, open = cube;
  for (auto& triangle : inward.triangles) std::swap(triangle[0], triangle[1]);
  open.triangles.pop_back();
  for (const TriangleMesh& mesh : {cube, separate, inward}) {
    const FeasibilityChecker checker = checker_of(grid, {}, {{{}, {mesh}}});
    EXPECT_EQ(checker.check(inside), Infeasibility::obstacle);
    EXPECT_EQ(checker.check(outside), Infeasibility::none);
  }
  const FeasibilityChecker bucket = checker_of(grid, {}, {{{}, {open}}});
  EXPECT_EQ(bucket.check(inside), Infeasibility::none);
  EXPECT_EQ(bucket.check(looking_down({0, 0, 0.08})), Infeasibility::obstacle);
  const FeasibilityChecker box = checker_of(grid, {}, {{{{{-1, -1, -1}, {1, 1, 1}}}, {}}});
  EXPECT_EQ(box.check(inside), Infeasibility::obstacle);
}

// Bodies of whole voxels that stand against occupied layers on all sides, at places whose
// coordinates are no round numbers.
TEST(Feasibility, TouchingFacesDoNotOverlap) {
  for (int low = 1; low <= 12; ++low) {
    const int high = low + 5;  // free: [low, high) along each axis
    const BeliefGrid grid = map_of(24, {}, [&](int x, int y, int z) {
      const auto in = [&](int v) { return v >= low && v < high; };
      return !(in(x) && in(y) && in(z));
    });
    FeasibilityConfig config;
    config.body.size = {5 * kVoxel, 5 * kVoxel, 5 * kVoxel};
    const double middle = kVoxel * (low + 2.5);
    for (const Pose& pose : {looking_down({middle, middle, kVoxel * low}),
                             Pose(Eigen::Matrix3d::Identity(), {middle, middle, kVoxel * high})}) {
      EXPECT_EQ(checker_of(grid, config).check(pose), Infeasibility::none) << low;
      FeasibilityConfig larger = config;
      larger.clearance = 1e-6;
      EXPECT_EQ(checker_of(grid, larger).check(pose), Infeasibility::collision) << low;
    }
  }

  const FeasibilityChecker on_box =
      checker_of(free_map(), {}, {{{{{-1, -1, -1}, {1, 1, 0.1}}}, {}}});
  EXPECT_EQ(on_box.check({Eigen::Vector3d(1, -1, -1).asDiagonal(), {0, 0, 0.1}}),
            Infeasibility::none);
  EXPECT_EQ(on_box.check({Eigen::Vector3d(1, -1, -1).asDiagonal(), {0, 0, 0.0999}}),
            Infeasibility::obstacle);
}

TEST(Feasibility, AnUnknownWorkspaceBlocksAndNothingBlocksOutside) {
  const GridConfig config{0.01, {{-2, -2, -2}, {2, 2, 2}}, {}, 0.01};
  const FeasibilityChecker checker = checker_of(BeliefGrid(config));  // 400³ voxels, all in tiles
  EXPECT_EQ(checker.check(looking_down({0.1, 0.3, 0.5})), Infeasibility::collision);
  EXPECT_EQ(checker.check(looking_down({0, 0, 1.999})), Infeasibility::collision);
  EXPECT_EQ(checker.check(looking_down({0, 0, 2.0})), Infeasibility::none);
  EXPECT_EQ(checker.check(looking_down({2.0 + 0.033, 0, 0})), Infeasibility::none);
  EXPECT_EQ(checker.check(looking_down({2.0 + 0.032, 0, 0})), Infeasibility::collision);
  EXPECT_EQ(checker.check(looking_down({1e6, -1e6, 0})), Infeasibility::none);
}

TEST(Feasibility, ACameraInsideARegionCollidesWhereverItsBodyIs) {
  const BeliefGrid grid = map_of(16, {}, [](int x, int, int) { return x >= 4; });
  FeasibilityConfig config;
  config.body.T_flange_camera = Pose(Eigen::Matrix3d::Identity(), {0, 0, 1});  // 1 m in front
  const FeasibilityChecker checker = checker_of(grid, config);
  const auto at = [&](double x_voxels, double y_voxels) {
    return checker.check(looking_down({kVoxel * x_voxels, kVoxel * y_voxels, kVoxel * 5.5}));
  };
  EXPECT_EQ(at(5.5, 5.5), Infeasibility::collision);
  EXPECT_EQ(at(6, 5.5), Infeasibility::collision);  // between two voxels of it
  EXPECT_EQ(at(6, 7), Infeasibility::collision);
  EXPECT_EQ(at(4, 5.5), Infeasibility::none);  // on its face
  EXPECT_EQ(at(3.5, 5.5), Infeasibility::none);
  EXPECT_EQ(at(15.9, 5.5), Infeasibility::collision);
  EXPECT_EQ(at(16, 5.5), Infeasibility::none);
  EXPECT_EQ(at(1e300, 5.5), Infeasibility::none);
}

// Its body, a metre behind it, meets nothing.
TEST(Feasibility, ACameraInsideAnObstacleMeetsItWhereverItsBodyIs) {
  FeasibilityConfig config;
  config.body.T_flange_camera = Pose(Eigen::Matrix3d::Identity(), {0, 0, 1});
  const Box box{{0.1, 0.1, 0.1}, {0.3, 0.3, 0.3}};
  for (const Obstacles& obstacles : {Obstacles{{box}, {}}, Obstacles{{}, {mesh_of({{box}, {}})}}}) {
    const FeasibilityChecker checker = checker_of(free_map(), config, {obstacles});
    EXPECT_EQ(checker.check(looking_down({0.2, 0.21, 0.22})), Infeasibility::obstacle);
    EXPECT_EQ(checker.check(looking_down({0.299, 0.11, 0.22})), Infeasibility::obstacle);
    EXPECT_EQ(checker.check(looking_down({0.2, 0.21, 0.31})), Infeasibility::none);
    EXPECT_EQ(checker.check(looking_down({0.301, 0.11, 0.22})), Infeasibility::none);
  }
}

// One pose that every check refuses; the reasons appear in order as they are taken away.
TEST(Feasibility, ReasonsInOrder) {
  const BeliefGrid grid = map_of(16, {}, [](int, int, int) { return true; });
  const Pose pose = looking_down({0.02, 0.02, 0.02});
  Pose bent = pose;
  bent.m[0] += 6e-4;  // RᵀR is off by 1.2e-3
  FeasibilityConfig config;
  config.reach.boxes = {{{1, 1, 1}, {2, 2, 2}}};
  Surroundings around{{{{{0, 0, 0}, {0.1, 0.1, 0.1}}}, {}}, 0.02};
  std::vector<Pose> taken{looking_down({0.025, 0.02, 0.02})};

  EXPECT_EQ(checker_of(grid, config, around).check(bent, taken), Infeasibility::bad_pose);
  EXPECT_EQ(checker_of(grid, config, around).check(pose, taken), Infeasibility::unreachable);
  config.reach = {};
  EXPECT_EQ(checker_of(grid, config, around).check(pose, taken), Infeasibility::taken);
  config.taken_tolerance.distance = 0.004;
  EXPECT_EQ(checker_of(grid, config, around).check(pose, taken), Infeasibility::plane);
  around.support_plane = 0.0199;
  EXPECT_EQ(checker_of(grid, config, around).check(pose, taken), Infeasibility::obstacle);
  around.obstacles = {};
  EXPECT_EQ(checker_of(grid, config, around).check(pose, taken), Infeasibility::collision);
  EXPECT_EQ(checker_of(free_map(), config, around).check(pose, taken), Infeasibility::none);

  Pose nan = pose;
  nan.m[3] = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(checker_of(free_map(), config).check(nan), Infeasibility::bad_pose);
  // A little off is mended.
  bent.m[0] = pose.m[0] + 4e-4;
  EXPECT_EQ(checker_of(free_map(), config).check(bent), Infeasibility::none);

  std::set<std::string_view> names;
  for (int i = 0; i <= static_cast<int>(Infeasibility::too_near); ++i) {
    names.insert(infeasibility_name(static_cast<Infeasibility>(i)));
  }
  EXPECT_EQ(names, (std::set<std::string_view>{"none", "bad_pose", "unreachable", "taken", "plane",
                                               "obstacle", "collision", "too_near"}));
}

TEST(Feasibility, TheLowestCornerDecidesAboutThePlane) {
  FeasibilityConfig config;
  const FeasibilityChecker checker = checker_of(free_map(), config, {{}, 0.5});
  Random random(3);
  for (int i = 0; i < 200; ++i) {
    const Eigen::Matrix3d R = random_rigid(random, 1).rotation();
    const Solid body = body_of(config, {R, {0, 0, 0}});
    double lowest = 0;
    for (unsigned corner = 0; corner < 8; ++corner) {
      Eigen::Vector3d p = body.center;
      for (int k = 0; k < 3; ++k) {
        p += ((corner >> k & 1U) != 0 ? 1 : -1) * body.half[k] * body.axes.col(k);
      }
      lowest = std::min(lowest, p.z());
    }
    EXPECT_EQ(checker.check({R, {3, 4, 0.5 - lowest + 1e-7}}), Infeasibility::none);
    EXPECT_EQ(checker.check({R, {3, 4, 0.5 - lowest}}), Infeasibility::plane);
    EXPECT_EQ(checker.check({R, {3, 4, -5}}), Infeasibility::plane);
  }
}

TEST(Feasibility, RefusesWhatMakesNoSense) {
  const auto scene = VoxelScene::build(free_map());
  const auto refuses = [&scene](const auto& change) {
    FeasibilityConfig config;
    change(config);
    try {
      const FeasibilityChecker checker(scene, config);
    } catch (const Error& error) {
      return error.code() == ErrorCode::invalid_argument;
    }
    return false;
  };
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW(FeasibilityChecker(nullptr, {}), Error);
  EXPECT_FALSE(refuses([](FeasibilityConfig&) {}));
  EXPECT_TRUE(refuses([](FeasibilityConfig& c) { c.body.size[1] = 0; }));
  EXPECT_TRUE(refuses([&](FeasibilityConfig& c) { c.body.size[2] = nan; }));
  EXPECT_TRUE(refuses([](FeasibilityConfig& c) { c.clearance = -1e-9; }));
  EXPECT_TRUE(refuses([](FeasibilityConfig& c) { c.taken_tolerance.angle = -1; }));
  EXPECT_TRUE(refuses([](FeasibilityConfig& c) { c.reach.shells = {{{0, 0, 0}, 2, 1}}; }));
  EXPECT_TRUE(refuses([](FeasibilityConfig& c) {
    c.body.T_flange_camera = Pose(2 * Eigen::Matrix3d::Identity(), {0, 0, 0});
  }));
}

}  // namespace
}  // namespace viewgain
