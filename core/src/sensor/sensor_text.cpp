// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include <cstddef>
#include <ostream>
#include <sstream>
#include <string>
#include <string_view>
#include <utility>
#include <variant>

#include "viewgain/core/sensor.hpp"
#include "viewgain/support/noise_fields.hpp"
#include "viewgain/support/toml_text.hpp"

namespace viewgain {
namespace {

// One column of the table, ten numbers per line.
void write_column(std::ostream& text, const char* key, const RangeCalibration& calibration,
                  std::size_t column) {
  constexpr std::size_t kInALine = 10;
  text << key << " = [";
  for (std::size_t i = 0; i < calibration.table.size(); ++i) {
    text << (i % kInALine == 0 ? "\n  " : " ") << toml_float(calibration.table[i][column]) << ",";
  }
  text << "\n]\n";
}

}  // namespace

std::string sensor_toml(const Sensor& sensor) {
  std::ostringstream text;
  text << "# A depth camera for viewgain. Ranges are along the ray.\n"
       << "format = " << kTomlFormat << "\nname = " << toml_string(sensor.name) << "\n"
       << "min_range = " << toml_float(sensor.min_range) << "  # [m]\n"
       << "max_range = " << toml_float(sensor.max_range) << "  # [m]\n"
       << "working_distance = " << toml_float(sensor.working_distance) << "  # [m]\n";
  if (sensor.T_flange_camera) {
    const auto& m = sensor.T_flange_camera->m;
    text << "T_flange_camera = [  # rows, [m]\n";
    for (std::size_t r = 0; r < 3; ++r) {
      text << "  [" << toml_float(m[4 * r]) << ", " << toml_float(m[4 * r + 1]) << ", "
           << toml_float(m[4 * r + 2]) << ", " << toml_float(m[4 * r + 3]) << "],\n";
    }
    text << "  [0.0, 0.0, 0.0, 1.0],\n]\n";
  }
  if (sensor.body_size) {
    const auto& size = *sensor.body_size;
    text << "body = [" << toml_float(size[0]) << ", " << toml_float(size[1]) << ", "
         << toml_float(size[2]) << "]  # width, height, depth [m]\n";
  }
  if (sensor.pose_sigma != PoseSigma{}) {
    text << "pose_sigma_rad = [" << toml_float(sensor.pose_sigma.translation) << ", "
         << toml_float(sensor.pose_sigma.rotation)
         << "]  # standard deviations of the poses of frames [m], [rad]\n";
  }
  if (sensor.scale_sigma > 0) {
    text << "scale_sigma = " << toml_float(sensor.scale_sigma)
         << "  # relative sigma of one factor common to all ranges\n";
  }
  if (sensor.out_of_range) {
    text << "out_of_range = "
         << (sensor.out_of_range == Sensor::OutOfRange::carve ? "\"carve\"" : "\"invalid\"")
         << "  # meaning of 65535 in depth images\n";
  }
  const PinholeCamera& camera = sensor.camera;
  text << "\n[camera]  # pixel (0,0) has its centre at (0,0); [px]\n"
       << "width = " << std::to_string(camera.width)
       << "\nheight = " << std::to_string(camera.height) << "\nfx = " << toml_float(camera.fx)
       << "\nfy = " << toml_float(camera.fy) << "\ncx = " << toml_float(camera.cx)
       << "\ncy = " << toml_float(camera.cy) << "\ndistortion = [";
  for (std::size_t k = 0; k < camera.distortion.size(); ++k) {
    text << (k > 0 ? ", " : "") << toml_float(camera.distortion[k]);
  }
  text << "]  # k1 k2 p1 p2 k3, as in OpenCV\n\n[noise]\n";
  text << "model = \"" << noise_model_name(sensor.noise) << "\"\n";
  NoiseModel noise = sensor.noise;
  for_each_parameter(noise, [&text](double value, const auto& field) {
    if (field.unsaid_at_0 && value == 0) return;
    text << field.name << " = " << toml_float(value) << "\n";
  });
  if (!sensor.range_calibration.table.empty()) {
    text << "\n[range_calibration]  # subtracted from readings; linear in between, constant "
            "beyond; [m]\n";
    write_column(text, "measured", sensor.range_calibration, 0);
    write_column(text, "error", sensor.range_calibration, 1);
  }
  return std::move(text).str();
}

std::string_view noise_model_name(const NoiseModel& noise) {
  return std::visit(
      []<typename Model>(const Model&) { return std::string_view(NoiseLayout<Model>::kName); },
      noise);
}

}  // namespace viewgain
