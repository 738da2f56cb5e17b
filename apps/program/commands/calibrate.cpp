// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include <cstddef>
#include <cstdio>
#include <map>
#include <memory>
#include <optional>
#include <string>

#include "calibration/noise_calibration.hpp"
#include "program/cli/flags/common_options.hpp"
#include "program/cli/flags/frame_folder.hpp"
#include "program/cli/progress.hpp"
#include "program/cli/values.hpp"
#include "program/commands/commands.hpp"
#include "viewgain/core/error.hpp"
#include "viewgain/formats/frames.hpp"
#include "viewgain/formats/sensor_toml.hpp"
#include "viewgain/support/json.hpp"
#include "viewgain/support/stopwatch.hpp"

namespace viewgain::app {
namespace {

struct Options {
  CommonOptions common;
  std::string frames;
  bool noise = false;
  std::string sensor;
  std::optional<double> depth_scale;
  std::string out;
};

void calibrate(const Options& options) {
  const Stopwatch watch;
  FrameSequence frames =
      opened(&open_depth_images, options.frames, options.sensor, options.depth_scale);
  frames.out_of_range = Sensor::OutOfRange::invalid;
  frames.is_out_of_range_assumed = false;
  warn_of_assumptions(options.frames, frames);
  NoiseCalibration calibration(frames.sensor, frames.depth_scale);
  std::map<std::string, std::size_t> bad;
  std::size_t used = 0;
  std::string fault;  // of the first frame that cannot be used
  Progress progress("frame", options.common.quiet);
  for (std::size_t i = 0; i < frames.images.size(); ++i) {
    progress.update(i + 1, frames.images.size());
    const FrameReading reading = read_frame(frames, i);
    if (reading.fault.verdict != FrameVerdict::used) {
      ++bad[std::string(frame_verdict_name(reading.fault.verdict))];
      if (fault.empty()) fault = "; " + reading.fault.what;
      continue;
    }
    calibration.add(reading.frame);
    ++used;
  }
  NoiseCalibrationResult result;
  try {
    result = calibration.solve();
  } catch (const Error& error) {
    throw Error(error.code(), error.what() + fault);
  }
  write_sensor_toml(options.out, result.sensor);
  if (options.common.json) {
    Json steps = Json::array();
    for (const NoiseStep& step : result.steps) {
      steps.push_back({{"range", step.range},
                       {"sigma_axial", step.sigma_axial},
                       {"fitted_axial", step.fitted_axial},
                       {"pixels", step.pixels}});
    }
    print_json({{"frames", used},
                {"bad", bad},
                {"sensor", result.sensor.name},
                {"depth_scale", frames.depth_scale},
                {"sigma_lateral_px", result.sigma_lateral_px},
                {"lateral_in_model", result.lateral_in_model},
                {"edge_length", result.edge_length},
                {"moving_share", result.moving_share},
                {"ranges_tell_shape", result.ranges_tell_shape},
                {"steps", steps},
                {"out", options.out},
                {"seconds", watch.seconds()}});
    return;
  }
  std::printf("%10s %10s %16s %12s\n", "range [m]", "pixels", "sigma_ax [mm]", "model [mm]");
  for (const NoiseStep& step : result.steps) {
    std::printf("%10.3f %10s %16.3f %12.3f\n", step.range, with_commas(step.pixels).c_str(),
                1e3 * step.sigma_axial, 1e3 * step.fitted_axial);
  }
  std::printf("%zu frames (%s); across the ray %.3f px, by %.0f px of edges%s\n", used,
              result.sensor.name.c_str(), result.sigma_lateral_px, result.edge_length,
              result.lateral_in_model ? "" : "; its model always has 1 px");
  if (!bad.empty()) std::printf("left out: %s\n", counts_text(bad).c_str());
  std::printf("%s: %s with this noise\n", options.out.c_str(), result.sensor.name.c_str());
}

}  // namespace

Command add_calibrate(App& program) {
  auto options = std::make_shared<Options>();
  App* app = program.add_subcommand(
      "calibrate",
      "How a depth camera's readings scatter, from 30 frames or more of a static scene: a sensor "
      "file with sigma_ax and sigma_lat in the sensor's own noise model.");
  app->add_option("FRAMES_DIR", options->frames, "folder of frames from one pose")->required();
  app->add_flag("--noise", options->noise,
                "what is measured; the scene needs edges before a wall, poses need not be there")
      ->required();
  app->add_option("--sensor", options->sensor,
                  kSensorHelp + "; default: FRAMES_DIR/sensor.toml. Its noise is replaced");
  app->add_option("--depth-scale", options->depth_scale,
                  "metres per unit of the depth images (default: from frames.toml, else 1e-4 with "
                  "poses.txt, 1e-3 with pose files)");
  app->add_option("--out", options->out, "sensor file to write (.toml)")->required();
  add_help(*app, kMapGroup,
           "calibrate --noise static --sensor sr4000 --depth-scale 1e-4 --out calibrated.toml");
  return command_of(app, options, calibrate);
}

}  // namespace viewgain::app
