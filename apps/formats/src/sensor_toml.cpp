// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include "viewgain/formats/sensor_toml.hpp"

#include <algorithm>
#include <cstdint>
#include <utility>
#include <vector>

#include "viewgain/core/error.hpp"
#include "viewgain/support/atomic_file.hpp"
#include "viewgain/support/file_names.hpp"
#include "viewgain/support/noise_fields.hpp"
#include "viewgain/support/text.hpp"
#include "viewgain/support/toml_table.hpp"

namespace viewgain {
namespace {

// Ten times the pixels of depth cameras. Rays and images of more would fill the memory.
constexpr std::int64_t kMostPixels = std::int64_t{1} << 24U;

PinholeCamera read_camera(TableReader reader) {
  PinholeCamera camera;
  camera.width = reader.whole_number("width");
  camera.height = reader.whole_number("height");
  if (static_cast<std::int64_t>(camera.width) * camera.height > kMostPixels) {
    reader.fail("width", "times height exceeds " + std::to_string(kMostPixels) + " pixels");
  }
  camera.fx = reader.number("fx");
  camera.fy = reader.number("fy");
  camera.cx = reader.number("cx");
  camera.cy = reader.number("cy");
  if (const toml::node* node = reader.find("distortion"); node != nullptr) {
    const std::vector<double> values = reader.numbers("distortion", *node, 5);
    std::copy(values.begin(), values.end(), camera.distortion.begin());
  }
  reader.refuse_unknown_keys();
  return camera;
}

NoiseModel read_noise(TableReader reader) {
  const std::string model = reader.text("model");
  const auto known =
      std::find_if(kNoiseModels.begin(), kNoiseModels.end(),
                   [&](const NoiseModel& one) { return noise_model_name(one) == model; });
  if (known == kNoiseModels.end()) {
    reader.fail(
        "model",
        "is \"" + model + "\"; valid values: shot, structured_light, stereo, quadratic, constant");
  }
  NoiseModel noise = *known;
  for_each_parameter(noise, [&](double& value, const auto& field) {
    if (!field.optional || reader.find(field.name) != nullptr) value = reader.number(field.name);
  });
  reader.refuse_unknown_keys();
  return noise;
}

Pose read_mounting(const TableReader& reader, const toml::node& node) {
  constexpr const char* kKey = "T_flange_camera";
  constexpr double kMendable = 1e-2, kExact = 1e-9;
  const toml::array* rows = node.as_array();
  if (rows == nullptr || rows->size() != 4)
    reader.fail(kKey, "must have four rows of four numbers");
  Pose pose;
  for (std::size_t r = 0; r < 4; ++r) {
    const std::vector<double> row = reader.numbers(kKey, *rows->get(r), 4);
    if (r < 3) {
      std::copy(row.begin(), row.end(), pose.m.begin() + static_cast<std::ptrdiff_t>(4 * r));
    } else if (row != std::vector<double>{0, 0, 0, 1}) {
      reader.fail(kKey, "must end with the row 0, 0, 0, 1");
    }
  }
  const double error = orthonormality_error(pose);
  if (!(error <= kMendable)) reader.fail(kKey, "is not a rigid transform");
  return error > kExact ? orthonormalized(pose) : pose;
}

RangeCalibration read_range_calibration(TableReader reader) {
  const auto read = [&reader](std::string_view key, std::size_t count) {
    return reader.numbers(key, reader.require(key), count);
  };
  const toml::array* list = reader.require("measured").as_array();
  if (list == nullptr || list->empty()) reader.fail("measured", "must be a list of numbers");
  const std::vector<double> measured = read("measured", list->size());
  const std::vector<double> error = read("error", list->size());
  reader.refuse_unknown_keys();
  RangeCalibration calibration;
  for (std::size_t i = 0; i < measured.size(); ++i) {
    calibration.table.push_back({measured[i], error[i]});
  }
  return calibration;
}

// The sensor in `file`.
Sensor sensor_of(const toml::table& root, const std::string& file) {
  TableReader reader(root, file, "");
  reader.check_format();
  Sensor sensor;
  sensor.name = reader.text("name");
  sensor.min_range = reader.number("min_range");
  sensor.max_range = reader.number("max_range");
  sensor.working_distance = reader.number("working_distance");
  if (const toml::node* node = reader.find("T_flange_camera"); node != nullptr) {
    sensor.T_flange_camera = read_mounting(reader, *node);
  }
  if (const toml::node* node = reader.find("body"); node != nullptr) {
    const std::vector<double> size = reader.numbers("body", *node, 3);
    sensor.body_size = {size[0], size[1], size[2]};
  }
  // The key's name has the unit, because the flag --register is in degrees. 0.1.0 wrote no unit.
  for (const char* key : {"pose_sigma", "pose_sigma_rad"}) {
    const toml::node* node = reader.find(key);
    if (node == nullptr) continue;
    if (sensor.pose_sigma != PoseSigma{}) reader.fail(key, "cannot be used with pose_sigma");
    const std::vector<double> sigmas = reader.numbers(key, *node, 2);
    sensor.pose_sigma = {sigmas[0], sigmas[1]};
  }
  if (reader.find("scale_sigma") != nullptr) sensor.scale_sigma = reader.number("scale_sigma");
  if (reader.find("out_of_range") != nullptr) {
    const std::string meaning = reader.text("out_of_range");
    if (meaning != "carve" && meaning != "invalid") {
      reader.fail("out_of_range", "is \"" + meaning + "\"; valid values: carve, invalid");
    }
    sensor.out_of_range =
        meaning == "carve" ? Sensor::OutOfRange::carve : Sensor::OutOfRange::invalid;
  }
  sensor.camera = read_camera(reader.table("camera"));
  sensor.noise = read_noise(reader.table("noise"));
  if (reader.find("range_calibration") != nullptr) {
    sensor.range_calibration = read_range_calibration(reader.table("range_calibration"));
  }
  reader.refuse_unknown_keys();
  try {
    sensor.validate();
  } catch (const Error& error) {
    throw Error(ErrorCode::format, file + ": " + error.what());
  }
  return sensor;
}

}  // namespace

void write_sensor_toml(const std::filesystem::path& path, const Sensor& sensor) {
  sensor.validate();
  require_ending(path, "a sensor file", {".toml"});
  write_file_atomically(path, sensor_toml(sensor));
}

Sensor read_sensor_toml(const std::filesystem::path& path) {
  return sensor_of(read_toml(path), path.string());
}

Sensor parse_sensor_toml(std::string_view text, const std::string& name) {
  return sensor_of(parse_toml(text, name), name);
}

bool is_sensor_file(const std::string& preset_or_file) {
  return small_ending(preset_or_file) == ".toml";
}

Sensor load_sensor(const std::string& preset_or_file) {
  if (is_sensor_file(preset_or_file)) return read_sensor_toml(preset_or_file);
  const std::vector<std::string>& names = sensor_preset_names();
  if (std::find(names.begin(), names.end(), preset_or_file) == names.end()) {
    refuse("sensor \"" + preset_or_file + "\" is neither a preset nor a .toml file" +
           did_you_mean(preset_or_file, names) + " (presets: " + listed(names) + ")");
  }
  return sensor_preset(preset_or_file);
}

}  // namespace viewgain
