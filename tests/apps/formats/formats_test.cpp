// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0

// The library viewgain::formats as a user links it; what files look like inside is tested with the
// program.
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <set>
#include <string>
#include <vector>

#include "core/expect_error.hpp"
#include "core/temporary_folder.hpp"
#include "grid/voxels.hpp"
#include "viewgain/core/generators.hpp"
#include "viewgain/formats/frames.hpp"
#include "viewgain/formats/octomap_io.hpp"
#include "viewgain/formats/png.hpp"
#include "viewgain/formats/reach_toml.hpp"
#include "viewgain/formats/sensor_toml.hpp"

namespace viewgain {
namespace {

TEST(Formats, RegionsComeBackAsTheyWere) {
  const test::TemporaryFolder folder;
  ReachRegion region;
  const std::vector<ReachRegion> parts = [&] {
    std::vector<ReachRegion> regions(6);
    regions[1].boxes = {{{-1, -2, 0.1}, {1, 2, 1.0 / 3}}, {{0, 0, 0}, {1, 1, 1}}};
    regions[2].shells = {{{0.1, 0, 0.2}, 0.3, 1e-3 + 0.5}};
    regions[3].half_spaces = {{{0, 0, 2}, -0.1}};
    regions[4].poses = sphere_poses(5, 0.6);
    regions[5] = {regions[1].boxes, regions[2].shells, regions[3].half_spaces,
                  regions[4].poses, {0.02, 0.1},       {}};
    return regions;
  }();
  for (const ReachRegion& written : parts) {
    const auto path = folder.path() / "cell.toml";
    write_reach_toml(path, written);
    const ReachRegion read = read_reach_toml(path);
    EXPECT_EQ(read.boxes, written.boxes);
    ASSERT_EQ(read.shells.size(), written.shells.size());
    for (std::size_t i = 0; i < read.shells.size(); ++i) {
      EXPECT_EQ(read.shells[i].center, written.shells[i].center);
      EXPECT_EQ(read.shells[i].max_radius, written.shells[i].max_radius);
    }
    ASSERT_EQ(read.half_spaces.size(), written.half_spaces.size());
    for (std::size_t i = 0; i < read.half_spaces.size(); ++i) {
      EXPECT_EQ(read.half_spaces[i].normal, written.half_spaces[i].normal);
      EXPECT_EQ(read.half_spaces[i].offset, written.half_spaces[i].offset);
    }
    ASSERT_EQ(read.poses.size(), written.poses.size());
    for (std::size_t i = 0; i < read.poses.size(); ++i) {
      EXPECT_EQ(read.poses[i].translation(), written.poses[i].translation());
    }
    EXPECT_EQ(read.tolerance.distance, written.tolerance.distance);
    EXPECT_NEAR(read.tolerance.angle, written.tolerance.angle, 1e-15);
    EXPECT_EQ(reach_poses_file(path).has_value(), !written.poses.empty());
  }
  EXPECT_EQ(folder.entries(), 2);  // cell.toml, cell.poses.txt
  region.predicate = [](const Pose&) { return true; };
  test::expect_error(ErrorCode::invalid_argument, "predicate",
                     [&] { write_reach_toml(folder.path() / "p.toml", region); });
}

TEST(Formats, WhatIsNotThereIsNoFrame) {
  const test::TemporaryFolder folder;
  Sensor sensor = sensor_preset("sr4000");
  sensor.camera.width = 3, sensor.camera.height = 2;
  FramesWriter writer(folder.path() / "frames");
  writer.write_frame(0, {3, 2, std::vector<float>(6, 0.5F), {}});
  EXPECT_EQ(folder.entries(), 1);  // hidden
  writer.commit(sphere_poses(1, 0.6), sensor);
  const FrameSequence frames = open_frames(folder.path() / "frames");
  EXPECT_NEAR(load_frame(open_frames(folder.path() / "frames", "", 1e-3), 0).depth[1], 5.F, 1e-5);
  test::expect_error(ErrorCode::invalid_argument,
                     "frame 1 does not exist; the number of frames is 1",
                     [&] { (void)load_frame(frames, 1); });
  for (const double scale : {0.0, -1e-3, std::nan("")}) {
    test::expect_error(ErrorCode::invalid_argument, "depth scale",
                       [&] { (void)open_frames(folder.path() / "frames", "", scale); });
  }
  test::expect_error(ErrorCode::io, "nowhere",
                     [&] { (void)open_frames(folder.path() / "nowhere"); });
}

// With the sensor's table depths are corrected; without poses the images alone can be read.
TEST(Formats, FramesAreReadWithTheSensorsTable) {
  const test::TemporaryFolder folder;
  Sensor sensor = sensor_preset("sr4000");
  sensor.camera.width = 3, sensor.camera.height = 2;
  const auto dir = folder.path() / "frames";
  const DepthFrame frame{3, 2, {0.F, 0.5F, 1.25F, DepthFrame::kOutOfRange, 3.F, 2.F}, {}};
  FramesWriter writer(dir);
  writer.write_frame(0, frame);
  writer.commit({look_at({0, 0, 1}, {0, 0, 0})}, sensor);
  const FrameSequence plain = open_frames(dir);

  sensor.range_calibration.table = {{0.4, 0.02}, {3.5, -0.04}};
  write_sensor_toml(folder.path() / "calibrated.toml", sensor);
  const std::string calibrated = (folder.path() / "calibrated.toml").string();
  const FrameSequence corrected = open_frames(dir, calibrated);
  EXPECT_EQ(corrected.sensor.range_calibration, sensor.range_calibration);
  DepthFrame expected = load_frame(plain, 0);
  sensor.range_calibration.correct(sensor.camera, expected);
  EXPECT_EQ(load_frame(corrected, 0), expected);
  EXPECT_GT(std::abs(expected.depth[1] - frame.depth[1]), 0.01F);
  EXPECT_EQ(expected.depth[0], DepthFrame::kInvalid);
  EXPECT_EQ(expected.depth[3], DepthFrame::kOutOfRange);
  EXPECT_EQ(frame_identity(corrected, 0), frame_identity(plain, 0));

  std::filesystem::remove(dir / "poses.txt");
  test::expect_error(ErrorCode::io, "poses.txt", [&] { (void)open_frames(dir, calibrated); });
  const FrameSequence images = open_depth_images(dir, calibrated);
  ASSERT_EQ(images.images, plain.images);
  EXPECT_TRUE(images.poses.empty());
  EXPECT_EQ(load_frame(images, 0), expected);
  test::expect_error(ErrorCode::invalid_argument,
                     "frame 0 does not exist; the number of frames is 0",
                     [&] { (void)frame_identity(images, 0); });
  std::filesystem::create_directory(folder.path() / "empty");
  test::expect_error(ErrorCode::io, "no frame-NNNNNN.depth.png",
                     [&] { (void)open_depth_images(folder.path() / "empty", "sr4000"); });
}

// Who changes the sensor of an open folder gets depths by the changed one.
TEST(Formats, FramesAreReadByTheSensorAsItIs) {
  const test::TemporaryFolder folder;
  const auto dir = folder.path() / "frames";
  Sensor sensor = sensor_preset("sr4000");
  sensor.camera.width = 3, sensor.camera.height = 2;
  sensor.camera.fx = sensor.camera.fy = 2;  // rays that differ
  sensor.camera.cx = sensor.camera.cy = 0.5;
  sensor.range_calibration.table = {{0.4, 0.02}, {3.5, -0.04}};
  FramesWriter writer(dir);
  writer.write_frame(0, {3, 2, {0.F, 0.5F, 1.25F, DepthFrame::kOutOfRange, 3.F, 2.F}, {}});
  writer.commit({look_at({0, 0, 1}, {0, 0, 0})}, sensor);
  FrameSequence frames = open_frames(dir);
  ASSERT_NE(frames.corrector, nullptr);
  EXPECT_EQ(frames.corrector->camera(), frames.sensor.camera);
  EXPECT_EQ(frames.corrector->calibration(), sensor.range_calibration);

  FrameSequence plain = frames;
  plain.sensor.range_calibration = {};
  const DepthFrame read = load_frame(plain, 0);
  std::vector<DepthFrame> seen{read};
  const auto expect_by_the_sensor = [&](const char* what) {
    DepthFrame expected = read;
    frames.sensor.range_calibration.correct(frames.sensor.camera, expected);
    EXPECT_EQ(load_frame(frames, 0), expected) << what;
    for (const DepthFrame& other : seen) EXPECT_NE(expected, other) << what;
    seen.push_back(expected);
  };
  expect_by_the_sensor("as opened");
  frames.sensor.range_calibration.table[1][1] = 0.3;
  expect_by_the_sensor("another table");
  frames.sensor.camera.fx = 1;
  expect_by_the_sensor("another camera, too");
  frames.sensor.range_calibration = sensor.range_calibration;
  expect_by_the_sensor("another camera");
  frames.sensor.camera.distortion[0] = 0.1;
  expect_by_the_sensor("a lens");
  frames.sensor = sensor;
  EXPECT_EQ(load_frame(frames, 0), seen[1]);
  frames.corrector = nullptr;
  EXPECT_EQ(load_frame(frames, 0), seen[1]);

  plain.sensor.range_calibration.table = {{1, 0}, {1, 0}};
  test::expect_error(ErrorCode::invalid_argument, "must increase",
                     [&] { (void)load_frame(plain, 0); });
  write_sensor_toml(dir / "sensor.toml", sensor_preset("sr4000"));
  EXPECT_EQ(open_frames(dir).corrector, nullptr);
}

TEST(Formats, FramesThatCannotBeAreRefusedAndNothingIsWritten) {
  const test::TemporaryFolder folder;
  const Sensor sensor = sensor_preset("sr4000");
  const std::vector<float> six(6, 1.F), five(5, 1.F);
  const auto dir = folder.path() / "frames";
  FramesWriter writer(dir);
  writer.write_frame(0, {3, 2, six, {}});
  const auto refuses = [&](const char* part, const auto& call) {
    test::expect_error(ErrorCode::invalid_argument, part, call);
  };
  refuses("5 depths", [&] { writer.write_frame(1, {3, 2, five, {}}); });
  refuses("5 amplitudes", [&] { writer.write_frame(1, {3, 2, six, five}); });
  refuses("0 x 2", [&] { writer.write_frame(1, {0, 2, {}, {}}); });
  refuses("-3 x -2", [&] { writer.write_frame(1, {-3, -2, six, {}}); });
  refuses("frame 2: frames must be written in order; expected frame 1", [&] {
    writer.write_frame(2, {3, 2, six, {}});
  });
  refuses("differs in size", [&] { writer.write_frame(1, {2, 3, six, {}}); });
  refuses("poses: 2, frames: 1", [&] { writer.commit(sphere_poses(2, 1), sensor); });
  refuses("3 x 2 px, but the sensor has", [&] { writer.commit(sphere_poses(1, 1), sensor); });
  refuses("values", [&] { write_png(folder.path() / "a.png", GrayImage{3, 2, {1, 2, 3}}); });
  refuses("values", [&] { write_png(folder.path() / "a.png", RgbImage{1, 1, {1}}); });
  refuses("px", [&] { (void)read_gray_png(folder.file("b.png", ""), -1, 2); });
  EXPECT_FALSE(std::filesystem::exists(dir));
  EXPECT_FALSE(std::filesystem::exists(folder.path() / "a.png"));
}

TEST(Formats, WhatCannotBeLookedAtIsAnError) {
  const test::TemporaryFolder folder;
  std::size_t cases = 0;
  for (const char* name : {"sensor.toml", "poses.txt", "camera-intrinsics.txt"}) {
    const auto dir = folder.path() / std::to_string(cases);
    std::filesystem::create_directory(dir);
    std::ofstream(dir / "frame-000000.depth.png");
    std::ofstream(dir / "frame-000000.pose.txt") << "1 0 0 0 0 1 0 0 0 0 1 0 0 0 0 1";
    std::filesystem::create_symlink(name, dir / name);  // to itself
    test::expect_error(ErrorCode::io, name, [&] { (void)open_frames(dir, "sr4000"); });
    ++cases;
  }
  EXPECT_EQ(cases, 3U);
}

TEST(Formats, RegionsWithPosesNeedANameForThem) {
  const test::TemporaryFolder folder;
  ReachRegion region;
  region.poses = sphere_poses(3, 0.5);
  for (const std::string name : {"cell.txt", "cell", "\xff.toml"}) {
    test::expect_error(ErrorCode::invalid_argument, "cell",
                       [&] { write_reach_toml(folder.path() / ("cell" + name), region); });
  }
  test::expect_error(ErrorCode::io, "none",
                     [&] { write_reach_toml(folder.path() / "none" / "cell.toml", region); });
  EXPECT_EQ(folder.entries(), 0);
  region.poses.clear();
  test::expect_error(ErrorCode::invalid_argument, "must have the ending .toml",
                     [&] { write_reach_toml(folder.path() / "cell.txt", region); });
  write_reach_toml(folder.path() / "cell.toml", region);  // no second file
  EXPECT_EQ(folder.entries(), 1);
}

// A tree's great leaves become tiles of the map.

/// An octree of one free leaf, the lowest cube of 65,536 / 2^depth voxels, cut into eight `splits`
/// times along its lowest corner.
std::string free_octree(int depth, int splits) {
  const auto node = [](int children) {
    const float log_odds = -2;
    std::string bytes(reinterpret_cast<const char*>(&log_odds), sizeof log_odds);
    return bytes + static_cast<char>(children);
  };
  std::string nodes;
  for (int i = 0; i < depth; ++i) nodes += node(1);
  for (int i = 0; i < splits; ++i) nodes += node(255);
  for (int i = 0; i < 1 + 7 * splits; ++i) nodes += node(0);
  return "# Octomap OcTree file\nid OcTree\nsize " + std::to_string(nodes.size() / 5) +
         "\nres 0.1\ndata\n" + nodes;
}

TEST(OctomapTiles, HashOfLargeTilesIsThatOfSmallOnes) {
  // 2^39 free voxels. Block by block this would take minutes.
  OctomapConfig config;
  config.workspace = Box{{-3276.8, -3276.8, -3276.8}, {-2457.6, -2457.6, -2457.6}};
  const BeliefGrid whole = grid_from_octomap_bytes(free_octree(3, 0), config);
  ASSERT_EQ(whole.statistics().free, std::uint64_t{1} << 39U);
  const std::string hash = whole.content_hash();
  std::set<std::string> others;
  for (int splits = 1; splits <= 13; ++splits) {
    BeliefGrid cut = grid_from_octomap_bytes(free_octree(3, splits), config);
    EXPECT_EQ(cut.content_hash(), hash) << splits;
    cut.set({-32768, -32768, -32768 + splits}, -1.95F);
    others.insert(cut.content_hash());
    // Away and back leaves a leaf in a node of its own.
    cut.set({-32768, -32768, -32768 + splits}, -2.0F);
    EXPECT_EQ(cut.content_hash(), hash) << splits;
  }
  EXPECT_EQ(others.size(), 13U);
  EXPECT_FALSE(others.contains(hash));

  // Cubes that the workspace cuts: tiles of 128³ against blocks, and against voxels one by one.
  config.workspace = Box{{-3276.5, -3276.8, -3270.8}, {-3256.0, -3260.6, -3261.9}};
  const BeliefGrid tiles = grid_from_octomap_bytes(free_octree(3, 0), config);
  BeliefGrid blocks = tiles.clone(), voxels(GridConfig{0.1, *config.workspace, {}, 0.05});
  test::for_each_voxel(tiles, [&](Index3 voxel) {
    const auto [x, y, z] = voxel;
    if (x % 8 == 0 && y % 8 == 0 && z % 8 == 0) blocks.set({x, y, z}, -2.0F);
    voxels.set({x, y, z}, -2.0F);
  });
  EXPECT_EQ(blocks.content_hash(), tiles.content_hash());
  EXPECT_EQ(voxels.content_hash(), tiles.content_hash());
  EXPECT_LT(tiles.statistics().bytes, voxels.statistics().bytes);
}

}  // namespace
}  // namespace viewgain
