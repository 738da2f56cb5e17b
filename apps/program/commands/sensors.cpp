// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <cstdio>
#include <memory>
#include <numbers>
#include <string>

#include "program/cli/values.hpp"
#include "program/commands/commands.hpp"
#include "viewgain/core/sensor.hpp"
#include "viewgain/formats/sensor_toml.hpp"

namespace viewgain::app {
namespace {

struct Options {
  CommonOptions common;
  std::string name;
};

// Field of view of the image along an axis [degrees].
double field_of_view(double pixels, double focal, double center) {
  const double low = (center + 0.5) / focal, high = (pixels - center - 0.5) / focal;
  return (std::atan(low) + std::atan(high)) * 180 / std::numbers::pi;
}

Json sensor_json(const Sensor& sensor) {
  const PinholeCamera& camera = sensor.camera;
  const MeasurementSigmas sigmas = sensor.sigmas(sensor.working_distance);
  return {{"name", sensor.name},
          {"width", camera.width},
          {"height", camera.height},
          {"field_of_view",
           {field_of_view(camera.width, camera.fx, camera.cx),
            field_of_view(camera.height, camera.fy, camera.cy)}},
          {"min_range", sensor.min_range},
          {"max_range", sensor.max_range},
          {"working_distance", sensor.working_distance},
          {"sigma_axial", sigmas.axial},
          {"sigma_lateral", sigmas.lateral},
          {"noise_model", noise_model_name(sensor.noise)}};
}

void print_row(const Sensor& sensor) {
  const PinholeCamera& camera = sensor.camera;
  const MeasurementSigmas sigmas = sensor.sigmas(sensor.working_distance);
  std::printf("%-18s %4d x %-4d %5.1f x %-5.1f %4g - %-5g %8g %7.2f %7.2f  %s\n",
              printable(sensor.name).c_str(), camera.width, camera.height,
              field_of_view(camera.width, camera.fx, camera.cx),
              field_of_view(camera.height, camera.fy, camera.cy), sensor.min_range,
              sensor.max_range, sensor.working_distance, 1e3 * sigmas.axial, 1e3 * sigmas.lateral,
              std::string(noise_model_name(sensor.noise)).c_str());
}

void sensors(const Options& options) {
  if (!options.name.empty()) {
    const Sensor sensor = load_sensor(options.name);
    if (options.common.json) return print_json(sensor_json(sensor));
    std::printf("%s", sensor_toml(sensor).c_str());
    return;
  }
  Json json = Json::array();
  if (!options.common.json) {
    std::printf("%-18s %11s %13s %12s %8s %7s %7s  %s\n%-18s %11s %13s %12s %8s %7s %7s\n",
                "preset", "image", "field of view", "range", "working", "axial", "lateral",
                "noise model", "", "[px]", "[deg]", "[m]", "[m]", "[mm]", "[mm]");
  }
  for (const std::string& name : sensor_preset_names()) {
    const Sensor sensor = sensor_preset(name);
    if (options.common.json) {
      json.push_back(sensor_json(sensor));
    } else {
      print_row(sensor);
    }
  }
  if (options.common.json) {
    print_json(json);
  } else {
    std::printf(
        "axial, lateral: standard deviation along and across the ray at the working distance\n");
  }
}

}  // namespace

Command add_sensors(App& program) {
  auto options = std::make_shared<Options>();
  App* app = program.add_subcommand("sensors",
                                    "List the presets for --sensor. With NAME, print the preset as "
                                    "a sensor file, which you can edit for your own camera.");
  app->add_option("NAME", options->name, "preset or .toml file to print");
  add_help(*app, kLookGroup, "sensors d435");
  return command_of(app, options, sensors);
}

}  // namespace viewgain::app
