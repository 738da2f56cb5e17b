// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include "frames/frames_toml.hpp"

#include <cmath>
#include <string_view>

#include "folders.hpp"
#include "frames/frame_names.hpp"
#include "viewgain/support/file_bytes.hpp"
#include "viewgain/support/toml_table.hpp"

namespace viewgain {
namespace {

constexpr std::string_view kPoseFiles = "frame-NNNNNN.pose.txt";

// Whether the key has the second of two texts; empty if the key is missing.
std::optional<bool> is_second(TableReader& reader, std::string_view key, std::string_view first,
                              std::string_view second) {
  if (reader.find(key) == nullptr) return std::nullopt;
  const std::string text = reader.text(key);
  if (text != first && text != second) {
    reader.fail(key, "is " + toml_string(text) + "; valid values: " + std::string(first) + ", " +
                         std::string(second));
  }
  return text == second;
}

}  // namespace

FramesToml read_frames_toml(const std::filesystem::path& dir) {
  const std::filesystem::path path = dir / kFrames;
  if (!is_there(path)) return {};
  const toml::table root = parse_toml(folder_file_bytes(path, kMostTomlBytes), path.string());
  TableReader reader(root, path.string(), "");
  reader.check_format();
  FramesToml said;
  if (reader.find("depth_scale") != nullptr) {
    said.depth_scale = reader.number("depth_scale");
    if (!(*said.depth_scale > 0)) reader.fail("depth_scale", "must be positive");
  }
  if (const auto invalid = is_second(reader, "out_of_range", "carve", "invalid")) {
    said.out_of_range = *invalid ? Sensor::OutOfRange::invalid : Sensor::OutOfRange::carve;
  }
  said.recorded = is_second(reader, "poses", kPoses, kPoseFiles);
  if (const toml::node* node = reader.find("first_frame"); node != nullptr) {
    const auto number = node->value_exact<std::int64_t>();
    if (!number || *number < 0) reader.fail("first_frame", "must be a whole number of at least 0");
    said.first_frame = static_cast<std::uint64_t>(*number);
  }
  if (reader.find("pose_time_offset") != nullptr) {
    said.pose_time_offset = reader.number("pose_time_offset");
  }
  reader.refuse_unknown_keys();
  return said;
}

std::string frames_toml(const FramesToml& said) {
  std::string text = "# The images and poses of this folder, for viewgain.\nformat = " +
                     std::to_string(kTomlFormat) + "\n";
  if (said.depth_scale) {
    text += "depth_scale = " + toml_float(*said.depth_scale) +
            "  # metres per unit of the depth images\n";
  }
  if (said.out_of_range) {
    text += *said.out_of_range == Sensor::OutOfRange::carve
                ? "out_of_range = \"carve\"  # 65535: no surface up to max_range\n"
                : "out_of_range = \"invalid\"  # 65535: no reading\n";
  }
  if (said.recorded) {
    text += "poses = " + toml_string(*said.recorded ? std::string(kPoseFiles) : kPoses) + "\n";
  }
  if (said.first_frame) {
    text += "first_frame = " + std::to_string(*said.first_frame) +
            "  # number of the image of the first pose\n";
  }
  if (said.pose_time_offset != 0) {
    text += "pose_time_offset = " + toml_float(said.pose_time_offset) +
            "  # added to the times in poses.txt [s]\n";
  }
  return text;
}

}  // namespace viewgain
