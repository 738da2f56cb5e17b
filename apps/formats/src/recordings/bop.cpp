// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include <Eigen/Core>
#include <array>
#include <cmath>
#include <cstddef>
#include <nlohmann/json.hpp>
#include <string>
#include <utility>

#include "recordings/parts.hpp"
#include "viewgain/core/error.hpp"
#include "viewgain/core/pose.hpp"
#include "viewgain/support/file_bytes.hpp"

namespace viewgain {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

[[noreturn]] void fail(const std::string& what) { throw Error(ErrorCode::format, what); }

json read_json(const fs::path& path) {
  try {
    json root = json::parse(file_bytes(path));
    if (!root.is_object()) fail(path.string() + ": must be a JSON object, a key a frame");
    return root;
  } catch (const json::exception& error) {
    fail(path.string() + ": " + error.what());
  }
}

// What scene_camera.json says of a frame; `name` begins messages.
class Entry {
 public:
  Entry(const json& entry, std::string name) : entry_(entry), name_(std::move(name)) {
    if (!entry_.is_object()) fail(name_ + ": must be an object");
  }

  [[nodiscard]] bool has(const char* key) const { return entry_.contains(key); }

  template <std::size_t N>
  [[nodiscard]] std::array<double, N> numbers(const char* key) const {
    const auto found = entry_.find(key);
    if (found == entry_.end() || !found->is_array() || found->size() != N) {
      fail(name_ + ": " + key + " must be a list of " + std::to_string(N) + " numbers");
    }
    std::array<double, N> values{};
    for (std::size_t i = 0; i < N; ++i) values[i] = number((*found)[i], key);
    return values;
  }

  [[nodiscard]] double depth_scale() const {
    constexpr const char* kKey = "depth_scale";
    const double scale = has(kKey) ? number(entry_[kKey], kKey) : 0;
    if (!(scale > 0)) fail(name_ + ": depth_scale must be a positive number");
    return scale * kMillimetre;
  }

  [[nodiscard]] PinholeCamera camera() const {
    return camera_of_matrix(numbers<9>("cam_K"), name_ + ": cam_K");
  }

  // Camera to world; no_pose where the data set keeps it to itself.
  [[nodiscard]] ReadPose pose() const {
    if (!has("cam_R_w2c") || !has("cam_t_w2c")) return unknown_pose(FrameVerdict::no_pose, {});
    try {
      return read_pose();
    } catch (const Error& error) {
      return unknown_pose(FrameVerdict::lost_pose, error.what());
    }
  }

 private:
  [[nodiscard]] ReadPose read_pose() const {
    const std::array<double, 9> r = numbers<9>("cam_R_w2c");
    const std::array<double, 3> t = numbers<3>("cam_t_w2c");
    Pose T_camera_world;
    for (std::size_t row = 0; row < 3; ++row) {
      for (std::size_t k = 0; k < 3; ++k) T_camera_world.m[4 * row + k] = r[3 * row + k];
      T_camera_world.m[4 * row + 3] = t[row] * kMillimetre;
    }
    const double error = orthonormality_error(T_camera_world);
    if (!(error <= kMendableRotation)) fail(name_ + ": cam_R_w2c is not a rotation");
    const bool is_mended = error > kUnnoticedRotation;
    return {(is_mended ? orthonormalized(T_camera_world) : T_camera_world).inverse(), is_mended};
  }

  [[nodiscard]] double number(const json& value, const char* key) const {
    if (!value.is_number() || !std::isfinite(value.get<double>())) {
      fail(name_ + ": " + key + " must be of finite numbers");
    }
    return value.get<double>();
  }

  const json& entry_;
  std::string name_;
};

}  // namespace

Recording open_bop(const fs::path& source, const RecordingConfig& config) {
  refuse_camera(config, source);
  const fs::path file = source / "scene_camera.json";
  const json cameras = read_json(file);
  Recording recording;
  for (const auto& [number, image] : numbered_images(source / "depth")) {
    const std::string key = std::to_string(number);
    const auto found = cameras.find(key);
    if (found == cameras.end()) {
      drop_frame(recording, {FrameVerdict::no_pose});
      continue;
    }
    const Entry entry(*found, file.string() + ": frame " + key);
    const PinholeCamera camera = entry.camera();
    const double scale = entry.depth_scale();
    const ReadPose pose = entry.pose();
    if (pose.fault.verdict == FrameVerdict::used && recording.frames.empty()) {
      recording.camera = camera;
      recording.depth_scale = scale;
    }
    if (pose.fault.verdict == FrameVerdict::used && camera != recording.camera) {
      drop_frame(recording, {FrameVerdict::intrinsics});
    } else if (pose.fault.verdict == FrameVerdict::used && scale != recording.depth_scale) {
      drop_frame(recording, {FrameVerdict::depth_scale});
    } else {
      add_frame(recording, number, image, pose);
    }
  }
  return recording;
}

}  // namespace viewgain
