// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0

// What a scene takes, and what building it leaves alone.
#include <dlfcn.h>
#include <gtest/gtest.h>

#include <stdexcept>

#include "core/expect_error.hpp"
#include "grid/voxels.hpp"
#include "raycast/scene_makers.hpp"
#include "viewgain/viewgain.hpp"

namespace {
bool has_ray_packets = true;
}

/// Embree's, but that it can be one that was built without packets of rays.
extern "C" ssize_t rtcGetDeviceProperty(void* device, int property) {
  using Original = ssize_t (*)(void*, int);
  static const auto original = reinterpret_cast<Original>(dlsym(RTLD_NEXT, "rtcGetDeviceProperty"));
  return has_ray_packets ? original(device, property) : 0;
}

namespace viewgain {
namespace {

// More primitives than are listed one by one: a voxel in every block.
BeliefGrid many_leaves() {
  constexpr int kEdge = 144;
  std::vector<Index3> unknown;
  test::for_each_voxel(
      VoxelBox{{3, 3, 3}, {kEdge, kEdge, kEdge}}, [&](Index3 v) { unknown.push_back(v); }, 8);
  return test::sparse_map({kEdge, kEdge, kEdge}, unknown, VoxelState::unknown);
}

TEST(VoxelScene, BytesCountTheBoxesAndTheObstacles) {
  const BeliefGrid grid = many_leaves();
  const auto scene = VoxelScene::build(grid);
  ASSERT_EQ(scene->primitive_count(), 18U * 18U * 18U);
  // A mask, a box, a key, a source and a class a leaf, and six floats where it is sorted by cell.
  const std::uint64_t each = 64 + 32 + 8 + 4 + 1, sorted = 6 * 4 + 4;
  EXPECT_GE(scene->bytes(), (each + sorted) * scene->primitive_count());

  TriangleMesh mesh;
  mesh.vertices = {{9, 9, 9}, {9, 9, 10}, {9, 10, 9}};
  mesh.triangles.assign(1000, {0, 1, 2});
  const auto with_mesh = VoxelScene::build(grid, {{.boxes = {}, .meshes = {mesh}}});
  EXPECT_GE(with_mesh->bytes(), scene->bytes() + 12'000U);
}

// The threads that the process's TBB may use, as TBB's own headers would ask for them.
std::size_t tbb_limit() {
  using ActiveValue = std::size_t (*)(int parameter);
  static const auto active_value = reinterpret_cast<ActiveValue>(
      dlsym(RTLD_DEFAULT, "_ZN3tbb6detail2r127global_control_active_valueEi"));
  if (active_value == nullptr) throw std::runtime_error("there is no TBB to ask");
  constexpr int kMaxAllowedParallelism = 0;
  return active_value(kMaxAllowedParallelism);
}

TEST(VoxelScene, EmbreeDoesNotLimitTheProcessesTbb) {
  const std::size_t before = tbb_limit();
  ASSERT_GT(before, 1U) << "on one thread a limit would not show";
  const BeliefGrid grid = test::sparse_map({8, 8, 8}, {{1, 2, 3}});
  const ExecConfig one{.num_threads = 1};
  const Obstacles obstacles{.boxes = {{{5, 5, 5}, {6, 6, 6}}}, .meshes = {}};
  const auto scene = VoxelScene::build(grid, {obstacles}, one);
  EXPECT_EQ(tbb_limit(), before);
  TriangleMesh mesh;
  mesh.vertices = {{0, 0, 0}, {0, 1, 0}, {1, 0, 0}};
  mesh.triangles = {{0, 1, 2}};
  const SurfaceScene surface(mesh, one);
  EXPECT_EQ(tbb_limit(), before);
}

TEST(VoxelScene, NeedsRayPacketsOnlyForObstaclesAndTheTracerEmbree) {
  const BeliefGrid grid = many_leaves();
  const Obstacles obstacles{.boxes = {{{5, 5, 5}, {6, 6, 6}}}, .meshes = {}};
  const Sensor sensor = test::lattice_sensor(9, 9);
  const std::vector<Pose> poses{test::axis_pose({-9, 8.5, 8.5}, 0, true)};
  const std::vector<ViewGain> expected =
      GainEvaluator(VoxelScene::build(grid), sensor, test::kPaper).evaluate(poses);
  has_ray_packets = false;
  const auto scene = VoxelScene::build(grid);
  EXPECT_TRUE(
      test::same_bits(GainEvaluator(scene, sensor, test::kPaper).evaluate(poses), expected));
  test::expect_error(ErrorCode::backend, "no ray packets", [&] {
    GainEvaluator(scene, sensor, test::kPaper, {1, ExecConfig::Tracer::embree});
  });
  test::expect_error(ErrorCode::backend, "no ray packets",
                     [&] { (void)VoxelScene::build(grid, {obstacles}); });
  TriangleMesh mesh;
  mesh.vertices = {{0, 0, 0}, {0, 1, 0}, {1, 0, 0}};
  mesh.triangles = {{0, 1, 2}};
  test::expect_error(ErrorCode::backend, "no ray packets", [&] { SurfaceScene surface(mesh); });
  has_ray_packets = true;
  EXPECT_TRUE(test::same_bits(
      GainEvaluator(scene, sensor, test::kPaper, {1, ExecConfig::Tracer::embree}).evaluate(poses),
      expected));
}

TEST(Umbrella, HasTheFilesOfTheGridToo) {
  EXPECT_THROW((void)load_vdb("none.vdb"), Error);
  EXPECT_EQ(reading_bounds(sensor_preset("sr4000"), std::vector<std::array<double, 3>>{}, Pose{}),
            std::nullopt);
}

}  // namespace
}  // namespace viewgain
