// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include "readers/readers.hpp"

#include <algorithm>
#include <cstdint>
#include <string>
#include <vector>

#include "choose/planner_state.hpp"
#include "mesh/files/mesh_dialects.hpp"
#include "program/commands/reconstruct/checkpoint.hpp"
#include "support/pose_file_text.hpp"
#include "viewgain/core/error.hpp"
#include "viewgain/core/pose_io.hpp"
#include "viewgain/core/sensor.hpp"
#include "viewgain/formats/cloud_io.hpp"
#include "viewgain/formats/frames.hpp"
#include "viewgain/formats/octomap_io.hpp"
#include "viewgain/formats/png.hpp"
#include "viewgain/formats/reach_toml.hpp"
#include "viewgain/formats/recordings.hpp"
#include "viewgain/formats/sensor_toml.hpp"
#include "viewgain/mesh/mesh_io.hpp"
#include "viewgain/support/columns/table.hpp"
#include "viewgain/support/pose_numbers.hpp"

namespace viewgain::test {
namespace {

namespace fs = std::filesystem;

std::vector<Pose> three_poses() {
  return {look_at({1, 0, 0.5}, {0, 0, 0}), look_at({0, 1, 0.5}, {0, 0, 0}),
          look_at({-1, 0.2, 0.3}, {0, 0, 0})};
}

GrayImage small_image(int width, int height) {
  GrayImage image{width, height, {}};
  for (int k = 0; k < width * height; ++k) {
    image.pixels.push_back(static_cast<std::uint16_t>(2000 + 37 * k));
  }
  return image;
}

Sensor small_sensor() {
  Sensor sensor = sensor_preset("kinect_v1");
  sensor.camera = {8, 6, 9.0, 9.0, 3.5, 2.5, {0.1, -0.05, 0.001, 0.002, 0.01}};
  return sensor;
}

template <typename Value>
void append(std::string& bytes, Value value) {
  bytes.append(reinterpret_cast<const char*>(&value), sizeof value);
}

void write_images(const TemporaryFolder& folder, const std::string& below,
                  const std::vector<std::string>& names) {
  fs::create_directories(folder.path() / below);
  for (const std::string& name : names) {
    write_png(folder.path() / below / name, small_image(8, 6));
  }
}

void load_recording(const fs::path& folder) {
  ImportConfig config;
  config.camera = {8, 6, 9, 9, 3.5, 2.5, {}};
  (void)import_recording(folder, folder.string() + "/frames", config);
}

void load_messages(const fs::path& file) {
  ImportConfig config;
  config.sensor = small_sensor();
  (void)import_recording(file, file.parent_path() / "frames", config);
}

std::string binary_ply(const std::string& order) {
  std::string bytes = "ply\nformat binary_" + order +
                      "_endian 1.0\nelement vertex 4\nproperty float x\nproperty float "
                      "y\nproperty float z\nproperty list uchar short w\nend_header\n";
  for (int k = 0; k < 4; ++k) {
    bytes += std::string(12, static_cast<char>(k * k)) + std::string("\2abcd");
  }
  return bytes;
}

std::string binary_pcd() {
  std::string bytes =
      "VERSION 0.7\nFIELDS x y z rgb\nSIZE 4 4 4 4\nTYPE F F F U\nCOUNT 1 1 1 1\nWIDTH 4\nHEIGHT "
      "1\nVIEWPOINT 0 0 1 1 0 0 0\nPOINTS 4\nDATA binary\n";
  for (int k = 0; k < 16; ++k) append(bytes, static_cast<float>(k * k % 11));
  return bytes;
}

// A free and an occupied voxel at the tree's corner.
std::string binary_octomap() {
  std::string bytes = "# Octomap OcTree binary file\nid OcTree\nsize 18\nres 0.1\ndata\n";
  for (int level = 0; level < 15; ++level) bytes += std::string("\3\0", 2);
  return bytes + std::string("\x09\0", 2);
}

std::string octomap_of_boxes() {
  BeliefGrid grid(
      {.voxel_size = 0.1, .workspace = {{-0.4, -0.4, -0.4}, {0.4, 0.4, 0.4}}, .prior_sigma = 0.1});
  for (std::int32_t i = -3; i < 3; ++i) {
    grid.set({i, i, -i}, 0.85F);
    grid.set({i, 0, 3}, -0.4F);
  }
  return octomap_bytes(grid);
}

// One file, its bytes and what reads it.
Reader file_reader(const std::string& name, const std::string& bytes,
                   std::function<void(const fs::path&)> read) {
  return {name,
          [=](const TemporaryFolder& folder) { folder.file(name, bytes); },
          {name},
          [=](const fs::path& folder) { read(folder / name); }};
}

std::vector<Reader> pose_readers() {
  const auto write_columns = [](const TemporaryFolder& folder) {
    Table table{};
    for (const char* name : kPoseColumns) table.columns.push_back({name, ColumnType::real});
    for (const Pose& pose : three_poses()) {
      for (const double x : numbers_of_pose(pose)) table.add(x);
    }
    write_table(folder.path() / "poses.npy", table);
  };
  return {
      {"poses.txt",
       [](const TemporaryFolder& folder) { write_tum(folder.path() / "poses.txt", three_poses()); },
       {"poses.txt"},
       [](const fs::path& folder) { (void)read_tum(folder / "poses.txt"); }},
      file_reader("pose.txt", matrix_text(three_poses()[0]),
                  [](const fs::path& path) { (void)read_pose_matrix(path); }),
      {"poses.npy", write_columns, {"poses.npy"}, [](const fs::path& folder) {
         (void)read_npy_poses(folder / "poses.npy");
       }}};
}

std::vector<Reader> settings_readers() {
  return {file_reader("sensor.toml", sensor_toml(small_sensor()),
                      [](const fs::path& path) { (void)read_sensor_toml(path); }),
          {"reach.toml",
           [](const TemporaryFolder& folder) {
             ReachRegion region;
             region.boxes.push_back({{0, 0, 0}, {1, 1, 1}});
             region.poses = three_poses();
             write_reach_toml(folder.path() / "reach.toml", region);
           },
           {"reach.toml", "reach.poses.txt"},
           [](const fs::path& folder) { (void)read_reach_toml(folder / "reach.toml"); }}};
}

std::vector<Reader> image_readers() {
  const auto write_both = [](const TemporaryFolder& folder) {
    write_images(folder, ".", {"gray.png"});
    write_png(folder.path() / "gray8.png",
              Gray8Image{8, 6, std::vector<std::uint8_t>(48, std::uint8_t{255})});
  };
  return {{"png", write_both, {"gray.png", "gray8.png"}, [](const fs::path& folder) {
             (void)png_size(folder / "gray.png");
             (void)read_gray_png(folder / "gray.png", 8, 6);
             (void)read_gray8_png(folder / "gray8.png", 8, 6);
           }}};
}

std::vector<Reader> frame_readers() {
  const auto write_frames = [](const TemporaryFolder& folder) {
    write_images(folder, "frames", {"frame-000000.depth.png", "frame-000001.depth.png"});
    write_images(folder, "masks", {"frame-000000.depth.png"});
    write_tum(folder.path() / "frames/poses.txt", std::vector(2, three_poses()[0]));
    write_sensor_toml(folder.path() / "frames/sensor.toml", small_sensor());
  };
  const auto write_tum_recording = [](const TemporaryFolder& folder) {
    write_images(folder, "depth", {"1.png", "2.png"});
    folder.file("depth.txt", "# timestamp filename\n1.0 depth/1.png\n2.0 depth/2.png\n");
    write_tum(folder.path() / "groundtruth.txt", std::vector(2, three_poses()[0]),
              std::vector<double>{1.0, 2.0});
  };
  // Others' layout: a file a pose, and what the images' pixels mean.
  const auto write_recorded = [](const TemporaryFolder& folder) {
    write_images(folder, "frames", {"frame-000000.depth.png"});
    folder.file("frames/frame-000000.pose.txt", "1 0 0 0\n0 1 0 0\n0 0 1 0.5\n0 0 0 1\n");
    folder.file("frames/camera-intrinsics.txt", "9.5 0 3.5\n0 9.25 2.5\n0 0 1\n");
    folder.file("frames/depth-scale.txt", "0.0010000000000\n");
    folder.file("frames/frames.toml", "out_of_range = \"invalid\"\npose_time_offset = 0.5\n");
    write_sensor_toml(folder.path() / "frames/sensor.toml", small_sensor());
  };
  const auto read_frames = [](const fs::path& folder) {
    const FrameSequence frames = open_frames(folder / "frames");
    for (std::size_t i = 0; i < frames.images.size(); ++i) {
      const FrameFault fault = read_frame(frames, i).fault;
      if (fault.verdict != FrameVerdict::used) throw Error(ErrorCode::format, fault.what);
    }
  };
  return {{"frames",
           write_frames,
           {"frames/frame-000001.depth.png", "frames/poses.txt", "frames/sensor.toml"},
           read_frames},
          {"recorded",
           write_recorded,
           {"frames/camera-intrinsics.txt", "frames/depth-scale.txt", "frames/frames.toml"},
           read_frames,
           4},
          {"tum", write_tum_recording, {"depth.txt", "groundtruth.txt"}, load_recording, 20}};
}

// Recordings that the formats' own writers have written.
std::vector<Reader> recording_readers() {
  std::vector<Reader> readers;
  for (const auto& [name, file] :
       {std::pair("mcap", "tiny_plain.mcap"), std::pair("bag", "tiny_none.bag"),
        std::pair("db3", "tiny.db3")}) {
    const std::string bytes = read_all(fs::path(VIEWGAIN_DATA) / "recordings" / file);
    readers.push_back(file_reader(std::string("recording.") + name, bytes, load_messages));
    readers.back().name = name;
    readers.back().one_in = 8;
  }
  readers.push_back(
      {"transforms.json",
       [](const TemporaryFolder& folder) {
         write_images(folder, "depth", {"1.png", "2.png"});
         folder.file("transforms.json",
                     R"({"camera_model": "OPENCV", "w": 8, "h": 6, "fl_x": 9.5, "cx": 4, "cy": 3,
 "k1": 0.01, "integer_depth_scale": 0.001, "frames": [
 {"depth_file_path": "depth/1.png", "transform_matrix": [[1,0,0,0.5],[0,1,0,0],[0,0,1,0],[0,0,0,1]]},
 {"depth_path": "./depth/2.png", "transform_matrix": [[1,0,0,1],[0,0,-1,2],[0,1,0,3],[0,0,0,1]]}]})");
       },
       {"transforms.json"},
       [](const fs::path& folder) { load_messages(folder / "transforms.json"); },
       8});
  return readers;
}

std::vector<Reader> cloud_and_map_readers() {
  const auto cloud = [](const fs::path& path) { (void)load_cloud(path); };
  const auto map = [](const fs::path& path) { (void)load_octomap(path); };
  return {file_reader("ascii.pcd",
                      "VERSION 0.7\nFIELDS x y z\nSIZE 4 4 4\nTYPE F F F\nCOUNT 1 1 1\nWIDTH "
                      "3\nHEIGHT 1\nVIEWPOINT 0 0 1 1 0 0 0\nPOINTS 3\nDATA ascii\n0 0 0\n1 0.5 "
                      "2\n0.1 0.2 0.3\n",
                      cloud),
          file_reader("binary.pcd", binary_pcd(), cloud),
          file_reader("ascii.ply",
                      "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float "
                      "y\nproperty float z\nend_header\n0 0 0\n1 0.5 2\n0.1 0.2 0.3\n",
                      cloud),
          file_reader("little.ply", binary_ply("little"), cloud),
          file_reader("big.ply", binary_ply("big"), cloud),
          file_reader("map.bt", binary_octomap(), map),
          file_reader("map.ot", octomap_of_boxes(), map)};
}

std::vector<Reader> mesh_readers() {
  std::vector<Reader> readers;
  for (const std::string name : {"mesh.off", "mesh.obj", "mesh.stl", "mesh.ply"}) {
    const std::vector<MeshDialect> rows = mesh_dialects();
    const auto row = std::find_if(rows.begin(), rows.end(), [&](const MeshDialect& dialect) {
      return dialect.refusal.empty() && dialect.bytes.size() > 40 &&
             dialect.file.ends_with(name.substr(4));
    });
    readers.push_back(file_reader(name, row->bytes, [](const fs::path& path) {
      const TriangleMesh mesh = read_mesh(path);
      for (const auto& t : mesh.triangles) {
        for (const std::uint32_t corner : t) (void)mesh.vertices.at(corner);
      }
    }));
  }
  return readers;
}

// What a planner keeps in a map's note, and a run in its folder.
std::vector<Reader> state_readers() {
  detail::PlannerState state;
  state.seen_area = 0.25;
  state.frames[FrameVerdict::used] = 3;
  state.reached = state.missed = state.planned = three_poses();
  state.promised = three_poses()[1];
  state.of_choice = StopReason::area;
  const app::Json head{{"format", 1}, {"settings", {{"voxel", 0.01}, {"mesh", "cube.off"}}}};
  const auto checkpoint = [head](const fs::path& folder, const std::string* text) {
    RunFolder run(folder / "run", text == nullptr);
    if (text != nullptr) return run.write_checkpoint(*text), run.commit(true);
    const app::Checkpoint known(run, head, true);
    for (std::size_t view = 0; known.decision(view); ++view) {
    }
  };
  app::Json good = head;
  good["decisions"] = {{{"map_hash", "0123456789abcdef"},
                        {"candidate", 4},
                        {"gain", 1.5},
                        {"gain_per_voxel", nullptr},
                        {"area", 0.25},
                        {"best_area", 0.5},
                        {"worth", nullptr}}};
  const std::string text = good.dump(1) + "\n";
  return {file_reader("planner.txt", detail::text_of(state),
                      [](const fs::path& path) { (void)detail::state_of(path, read_all(path)); }),
          {"checkpoint",
           [=](const TemporaryFolder& folder) { checkpoint(folder.path(), &text); },
           {"run/checkpoint.json"},
           [=](const fs::path& folder) { checkpoint(folder, nullptr); }}};
}

}  // namespace

std::vector<Reader> all_readers() {
  std::vector<Reader> all;
  for (const auto& some :
       {pose_readers(), settings_readers(), image_readers(), frame_readers(), recording_readers(),
        cloud_and_map_readers(), mesh_readers(), state_readers()}) {
    all.insert(all.end(), some.begin(), some.end());
  }
  return all;
}

std::string damaged_name(const Reader& reader, std::string_view& bytes) {
  std::size_t which = 0;
  if (reader.damaged.size() > 1 && !bytes.empty()) {
    which = static_cast<unsigned char>(bytes.front()) % reader.damaged.size();
    bytes.remove_prefix(1);
  }
  return reader.damaged[which];
}

void read_in_place(const Reader& reader, const TemporaryFolder& folder, std::string_view bytes) {
  const std::string name = damaged_name(reader, bytes);
  const std::string good = read_all(folder.path() / name);
  folder.file(name, bytes);
  try {
    reader.read(folder.path());
  } catch (...) {
    folder.file(name, good);
    throw;
  }
  folder.file(name, good);
}

}  // namespace viewgain::test
