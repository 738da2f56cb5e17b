// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include "viewgain/formats/reach_toml.hpp"

#include <array>
#include <numbers>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include "viewgain/core/error.hpp"
#include "viewgain/formats/pose_files.hpp"
#include "viewgain/support/atomic_file.hpp"
#include "viewgain/support/file_names.hpp"
#include "viewgain/support/text.hpp"
#include "viewgain/support/toml_table.hpp"

namespace viewgain {
namespace {

std::array<double, 3> triple(TableReader& reader, std::string_view key) {
  const std::vector<double> values = reader.numbers(key, 3);
  return {values[0], values[1], values[2]};
}

Eigen::Vector3d vector(TableReader& reader, std::string_view key) {
  const std::array<double, 3> values = triple(reader, key);
  return {values[0], values[1], values[2]};
}

Box read_box(TableReader& reader) {
  const std::array<double, 3> min = triple(reader, "min");
  return {min, triple(reader, "max")};
}

ReachRegion::Shell read_shell(TableReader& reader) {
  ReachRegion::Shell shell;
  shell.center = vector(reader, "center");
  shell.min_radius = reader.number("min_radius");
  shell.max_radius = reader.number("max_radius");
  return shell;
}

ReachRegion::HalfSpace read_half_space(TableReader& reader) {
  ReachRegion::HalfSpace half_space;
  half_space.normal = vector(reader, "normal");
  half_space.offset = reader.number("offset");
  return half_space;
}

ReachRegion::Tolerance read_tolerance(TableReader reader) {
  ReachRegion::Tolerance tolerance;
  const auto at_least_0 = [&](const char* key) {
    const double value = reader.number(key);
    if (value < 0) reader.fail(key, "must be at least 0, not " + short_text(value));
    return value;
  };
  if (reader.find("distance") != nullptr) tolerance.distance = at_least_0("distance");
  if (reader.find("angle_deg") != nullptr) {
    tolerance.angle = at_least_0("angle_deg") * std::numbers::pi / 180;
  }
  reader.refuse_unknown_keys();
  return tolerance;
}

template <typename Part>
std::vector<Part> read_parts(TableReader& reader, std::string_view key,
                             Part (*read)(TableReader&)) {
  std::vector<Part> parts;
  for (TableReader& table : reader.tables(key)) {
    parts.push_back(read(table));
    table.refuse_unknown_keys();
  }
  return parts;
}

}  // namespace

std::optional<std::filesystem::path> reach_poses_file(const std::filesystem::path& path) {
  const auto name = read_toml(path)["poses"].value<std::string>();
  if (!name) return std::nullopt;
  return path.parent_path() / *name;
}

ReachRegion read_reach_toml(const std::filesystem::path& path) {
  const toml::table root = read_toml(path);
  TableReader reader(root, path.string(), "");
  reader.check_format();
  ReachRegion region;
  region.boxes = read_parts(reader, "box", read_box);
  region.shells = read_parts(reader, "shell", read_shell);
  region.half_spaces = read_parts(reader, "half_space", read_half_space);
  if (reader.find("poses") != nullptr) {
    region.poses = load_poses(path.parent_path() / reader.text("poses")).poses;
    // No poses at all would mean that every pose is in reach.
    if (region.poses.empty()) reader.fail("poses", "names a file without poses");
  }
  if (reader.find("tolerance") != nullptr) {
    region.tolerance = read_tolerance(reader.table("tolerance"));
  }
  reader.refuse_unknown_keys();
  try {
    region.validate();
  } catch (const Error& error) {
    throw Error(ErrorCode::format, path.string() + ": " + error.what());
  }
  return region;
}

void write_reach_toml(const std::filesystem::path& path, const ReachRegion& region) {
  region.validate();
  require_ending(path, "a reach file", {".toml"});
  if (region.predicate)
    refuse(path.string() + ": a reach region with a predicate cannot be written");
  const auto xyz = [](const auto& v) { return toml::array{v[0], v[1], v[2]}; };
  toml::table root{{"format", kTomlFormat}};
  std::filesystem::path poses = path;
  poses.replace_extension(".poses.txt");
  if (!region.poses.empty()) {
    if (is_special_file(path)) {
      refuse(path.string() +
             ": a reach region with poses must be written to a regular file, because its poses are "
             "written to a second file next to it");
    }
    root.insert("poses", poses.filename().string());
  }
  toml::array boxes, shells, half_spaces;
  for (const Box& box : region.boxes) {
    boxes.push_back(toml::table{{"min", xyz(box.min)}, {"max", xyz(box.max)}});
  }
  for (const ReachRegion::Shell& shell : region.shells) {
    shells.push_back(toml::table{{"center", xyz(shell.center)},
                                 {"min_radius", shell.min_radius},
                                 {"max_radius", shell.max_radius}});
  }
  for (const ReachRegion::HalfSpace& half : region.half_spaces) {
    half_spaces.push_back(toml::table{{"normal", xyz(half.normal)}, {"offset", half.offset}});
  }
  if (!boxes.empty()) root.insert("box", std::move(boxes));
  if (!shells.empty()) root.insert("shell", std::move(shells));
  if (!half_spaces.empty()) root.insert("half_space", std::move(half_spaces));
  root.insert("tolerance",
              toml::table{{"distance", region.tolerance.distance},
                          {"angle_deg", region.tolerance.angle * 180 / std::numbers::pi}});
  std::ostringstream text;
  text << root << "\n";
  if (!region.poses.empty()) {
    if (toml::parse(text.str())["poses"].value<std::string>() != poses.filename().string()) {
      refuse(path.string() + ": a TOML file cannot name " + poses.filename().string());
    }
    const AtomicFile writable(path);  // checked before the poses change
    write_tum(poses, region.poses);
  }
  write_file_atomically(path, text.str());
}

}  // namespace viewgain
