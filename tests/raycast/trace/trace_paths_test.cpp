// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0

// A view is swept by its primitives or traced through the BVH; which one is a matter of speed
// alone. Sweeping has special ways for primitives that are small in the image, cells larger than a
// node of 128³ voxels, and cameras among the cells, on their faces and far off.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>

#include "core/expect_error.hpp"
#include "grid/voxels.hpp"
#include "raycast/scene_makers.hpp"
#include "viewgain/core/error.hpp"

namespace viewgain {
namespace {

GainEvaluator evaluator_by(ExecConfig::Tracer tracer,
                           const std::shared_ptr<const VoxelScene>& scene, const Sensor& sensor,
                           GainModel model = GainModel::paper) {
  return GainEvaluator(scene, sensor, {.model = model}, {.num_threads = 1, .tracer = tracer});
}

// Compares gains and hits of the two ways; returns the number of rays that hit something.
std::size_t compare(const BeliefGrid& grid, const Sensor& sensor, const std::vector<Pose>& poses,
                    const Obstacles& obstacles = {}) {
  const auto scene = VoxelScene::build(grid, {obstacles});
  const GainEvaluator free_choice = evaluator_by(ExecConfig::Tracer::sweep, scene, sensor);
  const GainEvaluator bvh = evaluator_by(ExecConfig::Tracer::embree, scene, sensor);
  EXPECT_TRUE(test::same_bits(free_choice.evaluate(poses), bvh.evaluate(poses)));
  for (const double share : {0.02, 0.1, 0.4}) {
    std::vector<ApproximateGain> a(poses.size()), b(poses.size());
    const ApproximateConfig config{.share = share, .seed = poses.size()};
    EXPECT_EQ(free_choice.approximate(poses, a, config), poses.size());
    bvh.approximate(poses, b, config);
    for (std::size_t i = 0; i < poses.size(); ++i) {
      EXPECT_EQ(a[i].gain, b[i].gain);
      EXPECT_EQ(a[i].standard_error, b[i].standard_error);
    }
  }
  std::size_t hits = 0;
  for (const Pose& pose : poses) {
    const std::vector<RayHit> a = free_choice.trace(pose);
    test::expect_same_hits(a, bvh.trace(pose));
    for (const RayHit& hit : a) hits += hit.kind == RayHit::Kind::none ? 0U : 1U;
  }
  return hits;
}

// Under each instruction set.
std::size_t compare_isas(const BeliefGrid& grid, const Sensor& sensor,
                         const std::vector<Pose>& poses, const Obstacles& obstacles = {}) {
  std::size_t hits = 0;
  for (const std::string& isa : available_isas()) {
    SCOPED_TRACE(isa);
    const test::ScopedIsa scoped(isa);
    hits = compare(grid, sensor, poses, obstacles);
  }
  return hits;
}

TEST(TracePaths, SweepAndBvhGiveTheSameBits) {
  std::size_t hits = 0;
  for (const test::MapFamily family :
       {test::MapFamily::salt_and_pepper_01, test::MapFamily::salt_and_pepper_30,
        test::MapFamily::tiles_8, test::MapFamily::odd_and_far, test::MapFamily::rotated}) {
    for (std::uint64_t seed = 0; seed < 8; ++seed) {
      test::Random random(100 + seed);
      const test::RandomMap map = test::random_map(family, random);
      const Sensor sensor = test::random_sensor(map.grid, random);
      hits += compare(map.grid, sensor, test::random_poses(map, 12, random));
    }
  }
  EXPECT_GT(hits, 50'000U);
}

// Obstacles in front of voxels, among them and behind them; some cameras have a lens.
TEST(TracePaths, ObstaclesEndTheSameRaysEitherWay) {
  std::size_t hits = 0, in_obstacles = 0, walked = 0;
  for (std::uint64_t seed = 0; seed < 24; ++seed) {
    test::Random random(900 + seed);
    const test::RandomMap map = test::random_map(
        seed % 2 == 0 ? test::MapFamily::salt_and_pepper_1 : test::MapFamily::rotated, random);
    Sensor sensor = test::random_sensor(map.grid, random);
    if (seed % 5 == 2) sensor.min_range = 0;
    if (seed % 3 == 0) sensor.camera.distortion = {-0.25, 0.08, 2e-3, -3e-3, -0.02};
    const Box w = map.grid.workspace();
    const double extent = w.max[0] - w.min[0];
    const auto point = [&](double reach) {
      const double r = reach * extent;
      const Eigen::Vector3d p(test::uniform(random, w.min[0] - r, w.max[0] + r),
                              test::uniform(random, w.min[1] - r, w.max[1] + r),
                              test::uniform(random, w.min[2] - r, w.max[2] + r));
      return Eigen::Vector3d(map.grid.T_world_grid() * p);
    };
    Obstacles obstacles;
    for (int i = 0; i < 4; ++i) {
      const Eigen::Vector3d low = point(0.4);
      const double size = test::uniform(random, 0.02, 0.3) * extent;
      obstacles.boxes.push_back(
          {{low.x(), low.y(), low.z()}, {low.x() + size, low.y() + 0.3 * size, low.z() + size}});
    }
    TriangleMesh& mesh = obstacles.meshes.emplace_back();
    const int triangles =
        seed % 4 == 1 ? 3000 : 12;  // more than there are pieces, or few large ones
    for (int i = 0; i < 3 * triangles; ++i) {
      const Eigen::Vector3d corner =
          i % 3 == 0 || triangles < 100
              ? point(1.5)
              : Eigen::Vector3d(Eigen::Vector3d::Map(mesh.vertices.back().data()) +
                                0.05 * extent * test::random_rigid(random, 0).rotation().col(0));
      mesh.vertices.push_back({corner.x(), corner.y(), corner.z()});
    }
    for (std::uint32_t i = 0; i < static_cast<std::uint32_t>(triangles); ++i) {
      mesh.triangles.push_back({3 * i, 3 * i + 1, 3 * i + 2});
    }
    const std::vector<Pose> poses = test::random_poses(map, 6, random);
    hits += compare(map.grid, sensor, poses, obstacles);
    const auto scene = VoxelScene::build(map.grid, {obstacles});
    const GainEvaluator swept =
        evaluator_by(ExecConfig::Tracer::sweep, scene, sensor, GainModel::combined);
    const GainEvaluator bvh =
        evaluator_by(ExecConfig::Tracer::embree, scene, sensor, GainModel::combined);
    const std::vector<ViewGain> gains = swept.evaluate(poses);
    EXPECT_TRUE(test::same_bits(gains, bvh.evaluate(poses)));
    walked += test::gaining(gains);
    for (const Pose& pose : poses) {
      // What no obstacle ends is what there is without them; no gain needs to know of the others.
      const std::vector<RayHit> rays = swept.trace(pose);
      std::uint32_t in_voxels = 0;
      for (const RayHit& hit : rays) {
        in_obstacles += hit.kind == RayHit::Kind::obstacle ? 1U : 0U;
        in_voxels +=
            hit.kind == RayHit::Kind::occupied || hit.kind == RayHit::Kind::unknown ? 1 : 0;
      }
      const ViewGain view = evaluator_by(ExecConfig::Tracer::sweep, scene, sensor).evaluate(pose);
      if (view.status == ViewGain::Status::ok) {
        EXPECT_EQ(view.hits, in_voxels);
      }
    }
  }
  EXPECT_GT(hits, 30'000U);
  EXPECT_GT(in_obstacles, 5'000U);
  EXPECT_GT(walked, 50U);
}

// Voxels at range 0, before an obstacle, at it, and at the sensor's last range.
TEST(TracePaths, ObstaclesAtTheEndsOfRangesAreTheSameEitherWay) {
  std::vector<Index3> unknown;
  for (int y = 0; y < 16; ++y) {
    for (int z = 0; z < 16; ++z) {
      unknown.push_back({11, y, z});
      if (y < 8) unknown.push_back({4, y, z});
    }
  }
  const BeliefGrid grid = test::sparse_map({16, 16, 16}, unknown, VoxelState::unknown);
  const double v = test::kExactVoxel;
  Sensor sensor = test::lattice_sensor(24, 20);
  sensor.camera.fx = sensor.camera.fy = 40;
  sensor.camera.cx = 12, sensor.camera.cy = 10;
  const std::vector<Pose> poses{
      test::axis_pose({4, 8, 8.5}, 0, true),      // on a face: some rays end at once
      test::axis_pose({4.5, 7.5, 8.5}, 0, true),  // in a voxel
      test::axis_pose({-9, 8.5, 8.5}, 0, true)};
  std::size_t hits = 0, at_once = 0;
  for (const double last : {7.0, 20.0, 1000.0}) {  // to the second wall, beyond
    sensor.max_range = last * v;
    sensor.working_distance = 3 * v;
    for (const double x : {4.0, 6.0, 11.0, 13.0}) {
      const Obstacles obstacles{{Box{{x * v, -v, -v}, {(x + 1) * v, 17 * v, 17 * v}}}, {}};
      hits += compare(grid, sensor, poses, obstacles);
      const GainEvaluator evaluator =
          evaluator_by(ExecConfig::Tracer::sweep, VoxelScene::build(grid, {obstacles}), sensor);
      for (const Pose& pose : poses) {
        std::uint32_t in_voxels = 0;
        for (const RayHit& hit : evaluator.trace(pose)) {
          in_voxels += hit.kind == RayHit::Kind::unknown ? 1U : 0U;
          at_once += hit.kind == RayHit::Kind::unknown && hit.range == 0 ? 1U : 0U;
        }
        EXPECT_EQ(evaluator.evaluate(pose).hits, in_voxels) << last << " " << x;
      }
    }
  }
  EXPECT_GT(hits, 5000U);
  EXPECT_GT(at_once, 500U);
}

// An obstacle that single precision does not hold is left out; the others block as before.
TEST(TracePaths, ObstaclesBeyondSinglePrecisionHideNothing) {
  const BeliefGrid grid =
      test::sparse_map({16, 16, 16}, {{8, 8, 8}, {8, 9, 8}, {9, 2, 3}}, VoxelState::unknown);
  const double v = test::kExactVoxel;
  Sensor sensor = test::lattice_sensor(31, 31);
  sensor.camera.fx = sensor.camera.fy = 20;
  const Box wall{{-2 * v, 0, -v}, {-v, 8.4 * v, 17 * v}};
  const Obstacles alone{{wall}, {}};
  const std::vector<Pose> poses{test::axis_pose({-9, 8.5, 8.5}, 0, true)};
  std::size_t blocked = 0;
  for (const double huge : {1e12, 1e25, 1e37, 1e300}) {
    const Obstacles both{{wall, Box{{-huge, -huge, -huge}, {huge, huge, -1e9}}}, {}};
    (void)compare(grid, sensor, poses, both);
    const std::vector<RayHit> a = evaluator_by(ExecConfig::Tracer::sweep,
                                               VoxelScene::build(grid, {alone}), sensor)
                                      .trace(poses[0]),
                              b = evaluator_by(ExecConfig::Tracer::sweep,
                                               VoxelScene::build(grid, {both}), sensor)
                                      .trace(poses[0]);
    for (std::size_t i = 0; i < a.size(); ++i) {
      EXPECT_EQ(a[i].kind, b[i].kind) << huge << " " << i;
      blocked += b[i].kind == RayHit::Kind::obstacle ? 1U : 0U;
    }
  }
  EXPECT_GT(blocked, 4U * 20U);
}

// What a strong lens bends, all over the image: nothing that the BVH finds is missed by the sweep.
TEST(TracePaths, StrongLensesSeeTheSameBits) {
  std::size_t hits = 0;
  const std::array<std::array<double, 5>, 4> lenses{{{-0.35, 0.12, 0, 0, -0.02},
                                                     {0.3, 0.1, 4e-3, 5e-3, 0.05},
                                                     {-0.28, 0.09, -6e-3, 4e-3, 0},
                                                     {0.25, -0.8, -2e-3, -1e-4, 0.9}}};
  for (std::uint64_t seed = 0; seed < 16; ++seed) {
    test::Random random(700 + seed);
    const test::RandomMap map = test::random_map(
        seed % 2 == 0 ? test::MapFamily::salt_and_pepper_01 : test::MapFamily::odd_and_far, random);
    Sensor sensor = test::random_sensor(map.grid, random);
    sensor.camera.width = 101;
    sensor.camera.height = 77;
    sensor.camera.cx = 53.2;
    sensor.camera.cy = 36.4;
    sensor.camera.fx = sensor.camera.fy = 72;
    sensor.camera.distortion = lenses.at(seed % 4);
    hits += compare(map.grid, sensor, test::random_poses(map, 6, random));
  }
  EXPECT_GT(hits, 50'000U);
}

TEST(TracePaths, TracersAreNamed) {
  EXPECT_EQ(parse_tracer("embree"), ExecConfig::Tracer::embree);
  EXPECT_EQ(tracer_names().at(static_cast<std::size_t>(ExecConfig::Tracer::sweep)), "sweep");
  test::expect_error(ErrorCode::invalid_argument,
                     "'octree'; valid values: automatic, embree, sweep",
                     [] { (void)parse_tracer("octree"); });
}

constexpr int kSmallEdge = 24;

// A cube of voxels, this share of them unknown.
BeliefGrid speckled(double share, test::Random& random) {
  std::vector<Index3> unknown;
  for (int i = 0; i < kSmallEdge * kSmallEdge * kSmallEdge; ++i) {
    const Index3 voxel{i / kSmallEdge / kSmallEdge, i / kSmallEdge % kSmallEdge, i % kSmallEdge};
    if (test::uniform(random, 0, 1) < share) unknown.push_back(voxel);
  }
  return test::sparse_map({kSmallEdge, kSmallEdge, kSmallEdge}, unknown, VoxelState::unknown);
}

// Rays that count from the camera on, where it touches the faces, edges and corners of voxels: what
// lies beside it is met in any direction, however near.
TEST(TracePaths, CamerasThatTouchVoxelsSeeTheSameBits) {
  test::Random random(7);
  const BeliefGrid grid = speckled(0.2, random);
  Sensor sensor = test::lattice_sensor(21, 17);
  sensor.camera.fx = sensor.camera.fy = 12;
  std::vector<Pose> poses;
  for (const double step : {0.0, 0.5, 0.25, 1e-4}) {  // corners; edges and faces; inside; next to
    for (int i = 0; i < 40; ++i) {
      Eigen::Vector3d at;
      for (int k = 0; k < 3; ++k) {
        const bool is_moved = (i >> k & 1) != 0;
        at[k] = test::uniform_int(random, 1, kSmallEdge - 1) + (is_moved ? step : 0.0);
      }
      poses.push_back(test::axis_pose(at, i % 3, i % 2 == 0));
      Pose turned = test::random_rigid(random, 1);
      for (int k = 0; k < 3; ++k) {
        turned.m[static_cast<std::size_t>(4 * k + 3)] = at[k] * test::kExactVoxel;
      }
      poses.push_back(turned);
    }
  }
  EXPECT_GT(compare(grid, sensor, poses), 320U * 21U * 17U / 2);
}

// Cameras so far away that single precision moves a box by many hundredths of a voxel: neither way
// may lose what the kernels meet.
TEST(TracePaths, FarCamerasSeeTheSameBits) {
  test::Random random(16);
  const BeliefGrid grid = speckled(0.05, random);
  Sensor sensor = test::lattice_sensor(61, 47);
  sensor.max_range = 2e6 * test::kExactVoxel;
  const double middle = 0.5 * kSmallEdge * test::kExactVoxel;
  std::size_t hits = 0;
  for (const double distance : {1.5e4, 5e4, 1.3e5, 4e5, 9e5}) {  // [voxels]
    sensor.camera.fx = sensor.camera.fy = 2 * distance;          // two pixels a voxel
    std::vector<Pose> poses;
    for (int i = 0; i < 10; ++i) {
      const Eigen::Vector3d away(test::uniform(random, -1, 1), test::uniform(random, -1, 1),
                                 test::uniform(random, -1, 1));
      const Eigen::Vector3d eye =
          Eigen::Vector3d::Constant(middle) + distance * test::kExactVoxel * away.normalized();
      poses.push_back(look_at({eye.x(), eye.y(), eye.z()}, {middle, middle, middle}));
    }
    hits += compare(grid, sensor, poses);
  }
  EXPECT_GT(hits, 5U * 10U * 61U * 47U / 4);
}

// Thousands of regions.
TEST(TracePaths, ManyRegionsGiveTheSameBits) {
  constexpr int kEdge = 544, kRegion = 32;
  std::vector<Index3> unknown;
  const auto add = [&](Index3 v) {
    for (int i = 0; i < 6; ++i) unknown.push_back({v.x + i, v.y + (v.x + v.z) / 32 % 17, v.z + i});
  };
  test::for_each_voxel(VoxelBox{{5, 9, 3}, {kEdge, kEdge, kEdge}}, add, kRegion);
  const BeliefGrid grid = test::sparse_map({kEdge, kEdge, kEdge}, unknown, VoxelState::unknown);
  ASSERT_GT(grid.snapshot().regions.size(), 4096U);
  Sensor sensor = test::lattice_sensor(61, 47);
  sensor.camera.fx = sensor.camera.fy = 80;
  const double middle = 0.5 * kEdge * grid.voxel_size();
  std::vector<Pose> poses;
  for (const double off : {-1.4, 1.3}) {
    poses.push_back(look_at({middle * (1 + off), middle * 0.9, middle * (1 - 0.5 * off)},
                            {middle, middle, middle}));
    poses.push_back(look_at({middle * 1.02, middle * 0.97, middle * 1.05},
                            {middle * (1 + off), middle * 0.8, middle * 0.7}));
  }
  EXPECT_GT(compare(grid, sensor, poses), 100U);
}

// A large unknown tile of which the workspace leaves no more than one block, among many primitives.
TEST(TracePaths, ABlockLeftOfALargeTileIsSeenAmongManyPrimitives) {
  constexpr int kEdge = 136, kCorner = 128;
  std::vector<Index3> unknown;
  const auto add = [&](Index3 voxel) { unknown.push_back(voxel); };
  test::for_each_voxel(VoxelBox{{3, 3, 3}, {kEdge, kEdge, kEdge}}, add, 8);
  test::for_each_voxel(VoxelBox{{kCorner, kCorner, kCorner}, {kEdge, kEdge, kEdge}}, add);
  const BeliefGrid grid = test::sparse_map({kEdge, kEdge, kEdge}, unknown, VoxelState::unknown);
  ASSERT_GT(VoxelScene::build(grid)->primitive_count(), 4096U);
  ASSERT_EQ(grid.snapshot().tiles_of(0)[0], 1U);
  Sensor sensor = test::lattice_sensor(61, 47);
  sensor.camera.fx = sensor.camera.fy = 80;
  const double corner = (kCorner + 4) * grid.voxel_size();
  const Pose pose = look_at({corner + 1.5, corner + 1.4, corner + 1.3}, {corner, corner, corner});
  EXPECT_GT(compare(grid, sensor, {pose}), 20U);
  std::size_t seen = 0;
  for (const RayHit& hit : GainEvaluator(VoxelScene::build(grid), sensor).trace(pose)) {
    const Index3& v = hit.voxel;
    seen += hit.kind == RayHit::Kind::unknown && v.x >= kCorner && v.y >= kCorner && v.z >= kCorner
                ? 1
                : 0;
  }
  EXPECT_GT(seen, 20U);
}

// The middle of the workspace in the world, and half its diagonal [m].
struct Ball {
  Eigen::Vector3d middle;
  double radius;
};
Ball ball_round(const BeliefGrid& grid) {
  const Box box = grid.workspace();
  const Eigen::Vector3d low(box.min[0], box.min[1], box.min[2]),
      high(box.max[0], box.max[1], box.max[2]);
  return {grid.T_world_grid() * Eigen::Vector3d(0.5 * (low + high)), 0.5 * (high - low).norm()};
}

// Blocks of 8³ voxels are from a fifth of a ray to twelve rays wide, so that several primitives
// share a window, or a primitive takes many; images end between tiles.
TEST(Sweep, PrimitivesOfAllSizesInTheImageGiveTheSameBits) {
  std::size_t hits = 0, cases = 0;
  for (const test::MapFamily family :
       {test::MapFamily::salt_and_pepper_1, test::MapFamily::salt_and_pepper_30,
        test::MapFamily::tiles_8, test::MapFamily::rotated}) {
    for (const double rays : {0.2, 0.9, 2.0, 3.9, 4.2, 12.0}) {
      test::Random random(300 + cases);
      const test::RandomMap map = test::random_map(family, random);
      const Ball ball = ball_round(map.grid);
      const double distance = 3 * ball.radius;
      Sensor sensor = test::random_sensor(map.grid, random);
      sensor.camera = {.width = 70, .height = 51, .cx = 34.3, .cy = 25.8};
      sensor.camera.fx = sensor.camera.fy = rays * distance / (8 * map.grid.voxel_size());
      if (cases % 3 == 0) sensor.min_range = distance;
      sensor.max_range = distance + (cases % 3 == 1 ? 0.2 : 2.0) * ball.radius;
      sensor.working_distance = 0.5 * (sensor.min_range + sensor.max_range);
      std::vector<Pose> poses;
      for (int i = 0; i < 4; ++i) {
        const Eigen::Vector3d away = test::random_rigid(random, 0).rotation().col(0);
        poses.push_back(look_at(
            ball.middle + distance * away,
            ball.middle + 0.3 * ball.radius * test::random_rigid(random, 0).rotation().col(1),
            test::random_rigid(random, 0).rotation().col(0)));
      }
      hits += compare_isas(map.grid, sensor, poses);
      ++cases;
    }
  }
  EXPECT_EQ(cases, 24U);
  EXPECT_GT(hits, 20'000U);
}

// A workspace of which nothing is known but a room beside its corner: its unknown part is boxes
// that reach over many nodes, before and behind the blocks of the room.
TEST(Sweep, BoxesLargerThanNodesGiveTheSameBits) {
  constexpr double kVoxel = 0.02;
  test::Random random(11);
  const auto face = [](int i) { return kVoxel * i; };
  BeliefGrid grid(
      GridConfig{.voxel_size = kVoxel,
                 .workspace = {{face(4000), face(-30), face(-5)}, {face(4300), face(90), face(70)}},
                 .prior_sigma = 0.02});
  // The workspace crosses a boundary of the tree's largest nodes, at 4096; what lies beyond it
  // stays boxes that are 204 voxels long.
  test::for_each_voxel(VoxelBox{{4000, 0, 0}, {4050, 60, 50}}, [&](Index3 voxel) {
    if (test::uniform(random, 0, 1) < 0.03) return;
    grid.set(voxel, test::uniform(random, 0, 1) < 0.01 ? 0.85F : -0.4F);
  });
  const GridSnapshot snapshot = grid.snapshot();
  const auto is_larger = [](const VoxelBox& box) {
    return box.min.x >> 7 != (box.max.x - 1) >> 7 || box.min.y >> 7 != (box.max.y - 1) >> 7 ||
           box.min.z >> 7 != (box.max.z - 1) >> 7;
  };
  ASSERT_TRUE(std::any_of(snapshot.tiles.begin(), snapshot.tiles.end(), is_larger));
  Sensor sensor = test::lattice_sensor(61, 47);
  sensor.camera.fx = sensor.camera.fy = 50;
  sensor.min_range = 0.05;
  std::vector<Pose> poses;
  for (int i = 0; i < 12; ++i) {
    const Eigen::Vector3d inside(face(4000 + test::uniform_int(random, 2, 48)),
                                 face(test::uniform_int(random, 2, 58)),
                                 face(test::uniform_int(random, 2, 48)));
    const Eigen::Vector3d away = test::random_rigid(random, 0).rotation().col(0);
    poses.push_back(look_at(inside, inside + away));
    poses.push_back(look_at(inside + 4.0 * away, inside));
  }
  EXPECT_GT(compare_isas(grid, sensor, poses), 24U * 61U * 47U / 4);
  Obstacles obstacles;
  obstacles.boxes.push_back({{face(4020), face(10), face(10)}, {face(4030), face(40), face(40)}});
  EXPECT_GT(compare_isas(grid, sensor, poses, obstacles), 24U * 61U * 47U / 4);
}

// Cameras on faces, edges and corners of cells, where distances to cells jump, and in them.
TEST(Sweep, CamerasAmongTheCellsSeeTheSameBits) {
  constexpr int kEdge = 144;
  test::Random random(5);
  std::vector<Index3> unknown;
  const auto off = [&] { return test::uniform_int(random, 0, 6); };
  const auto add = [&](Index3 v) { unknown.push_back({v.x + off(), v.y + off(), v.z + off()}); };
  test::for_each_voxel(VoxelBox{{1, 1, 1}, {kEdge, kEdge, kEdge}}, add, 8);
  const BeliefGrid grid = test::sparse_map({kEdge, kEdge, kEdge}, unknown, VoxelState::unknown);
  Sensor sensor = test::lattice_sensor(45, 33);
  sensor.camera.fx = sensor.camera.fy = 30;
  std::vector<Pose> poses;
  for (const int lattice : {8, 32, 128}) {
    for (int i = 0; i < 24; ++i) {
      Eigen::Vector3d at;
      for (int k = 0; k < 3; ++k) {
        at[k] = (i >> k & 1) != 0 ? test::uniform(random, 0, kEdge)
                                  : lattice * test::uniform_int(random, 0, kEdge / lattice);
      }
      Pose turned = test::random_rigid(random, 1);
      for (int k = 0; k < 3; ++k) {
        turned.m[static_cast<std::size_t>(4 * k + 3)] = at[k] * test::kExactVoxel;
      }
      poses.push_back(turned);
      poses.push_back(test::axis_pose(at, i % 3, i % 2 == 0));
    }
  }
  EXPECT_EQ(poses.size(), 144U);
  EXPECT_GT(compare_isas(grid, sensor, poses), 20'000U);
}

}  // namespace
}  // namespace viewgain
