// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdio>
#include <map>
#include <memory>
#include <optional>
#include <string>

#include "calibration/noise_calibration.hpp"
#include "calibration/range_fit.hpp"
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
  bool noise = false, range = false;
  std::string sensor;
  std::optional<double> depth_scale;
  std::string out;
};

// Opens the frames for both calibrations; for `range`, without an earlier range calibration.
FrameSequence opened_frames(const Options& options, OpenFrames open) {
  FrameSequence frames = opened(open, options.frames, options.sensor, options.depth_scale);
  frames.out_of_range = Sensor::OutOfRange::invalid;
  frames.is_out_of_range_assumed = false;
  warn_of_assumptions(options.frames, frames);
  if (options.range) frames.sensor.range_calibration = {};
  return frames;
}

struct FrameCountsRead {
  std::map<std::string, std::size_t> bad{};
  std::size_t used = 0;
};

// Runs the calibration on the frames that can be used.
template <typename Calibration, typename Add>
auto solved(const Options& options, const FrameSequence& frames, Calibration& calibration, Add add,
            FrameCountsRead& counts) {
  std::string fault;  // fault of the first frame that cannot be used
  Progress progress("frame", options.common.quiet);
  for (std::size_t i = 0; i < frames.images.size(); ++i) {
    progress.update(i + 1, frames.images.size());
    const FrameReading reading = read_frame(frames, i);
    if (reading.fault.verdict != FrameVerdict::used) {
      ++counts.bad[std::string(frame_verdict_name(reading.fault.verdict))];
      if (fault.empty()) fault = "; " + reading.fault.what;
      continue;
    }
    add(i, reading.frame);
    ++counts.used;
  }
  try {
    return calibration.solve();
  } catch (const Error& error) {
    throw Error(error.code(), error.what() + fault);
  }
}

void calibrate_range(const Options& options) {
  const Stopwatch watch;
  const FrameSequence frames = opened_frames(options, &open_frames);
  RangeFit fit(frames.sensor);
  FrameCountsRead counts;
  const RangeFitResult result = solved(
      options, frames, fit,
      [&](std::size_t i, const DepthFrame& frame) {
        fit.add(frame, frames.poses[i], frames.images[i].filename().string());
      },
      counts);
  write_sensor_toml(options.out, result.sensor);
  for (const std::string& text : result.left_out) {
    std::fprintf(stderr, "viewgain: warning: a frame is left out: %s\n", printable(text).c_str());
  }
  double largest = 1e-6;  // largest error [m]
  for (const RangeStep& step : result.steps) largest = std::max(largest, std::abs(step.error));
  Json steps = Json::array();
  if (!options.common.json) {
    std::printf("%10s %10s %14s\n", "range [m]", "error [mm]", "residual [mm]");
  }
  for (const RangeStep& step : result.steps) {
    steps.push_back({{"range", step.range},
                     {"error", step.error},
                     {"residual", step.residual},
                     {"pixels", step.pixels}});
    if (options.common.json) continue;
    const auto bar = static_cast<int>(std::round(20 * std::abs(step.error) / largest));
    const std::string left(static_cast<std::size_t>(step.error < 0 ? 20 - bar : 20), ' ');
    std::printf("%10.3f %10.2f %14.2f  %s%s\n", step.range, 1e3 * step.error, 1e3 * step.residual,
                left.c_str(), std::string(static_cast<std::size_t>(bar), '#').c_str());
  }
  if (options.common.json) {
    print_json({{"frames", counts.used - result.left_out.size()},
                {"bad", counts.bad},
                {"left_out", result.left_out},
                {"sensor", result.sensor.name},
                {"depth_scale", frames.depth_scale},
                {"distances", result.distances},
                {"rms_before", result.rms_before},
                {"rms_after", result.rms_after},
                {"offset_sigma", result.offset_sigma},
                {"steps", steps},
                {"out", options.out},
                {"seconds", watch.seconds()}});
    return;
  }
  std::printf("%zu frames at %zu distances: RMS range error %.2f mm, after calibration %.2f mm\n",
              counts.used - result.left_out.size(), result.distances, 1e3 * result.rms_before,
              1e3 * result.rms_after);
  if (!counts.bad.empty()) std::printf("left out: %s\n", counts_text(counts.bad).c_str());
  std::printf("%s: sensor %s with this range_calibration\n", options.out.c_str(),
              result.sensor.name.c_str());
}

void calibrate(const Options& options) {
  if (options.noise == options.range) refuse("give either --noise or --range");
  if (options.range) return calibrate_range(options);
  const Stopwatch watch;
  const FrameSequence frames = opened_frames(options, &open_depth_images);
  NoiseCalibration calibration(frames.sensor, frames.depth_scale);
  FrameCountsRead counts;
  const NoiseCalibrationResult result = solved(
      options, frames, calibration,
      [&](std::size_t, const DepthFrame& frame) { calibration.add(frame); }, counts);
  const auto& [bad, used] = counts;
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
  std::printf(
      "%zu frames (%s); standard deviation across the ray %.3f px, from %.0f px of edges%s\n", used,
      result.sensor.name.c_str(), result.sigma_lateral_px, result.edge_length,
      result.lateral_in_model ? "" : "; the noise model always has 1 px");
  if (!bad.empty()) std::printf("left out: %s\n", counts_text(bad).c_str());
  std::printf("%s: sensor %s with this noise\n", options.out.c_str(), result.sensor.name.c_str());
}

}  // namespace

Command add_calibrate(App& program) {
  auto options = std::make_shared<Options>();
  App* app = program.add_subcommand(
      "calibrate",
      "Calibrate a depth camera and write a sensor file. --noise measures the random error; it "
      "needs at least 30 frames of a static scene, taken from one pose. --range measures the "
      "systematic error; it needs frames of one flat wall, with poses, from at least 8 distances.");
  app->add_option("FRAMES_DIR", options->frames, "folder of frames")->required();
  app->add_flag(
      "--noise", options->noise,
      "measure the standard deviations along and across the ray; the scene must contain an "
      "object in front of a wall; poses are not needed");
  app->add_flag("--range", options->range,
                "measure the range error (range_calibration in the sensor file); in some frames, "
                "rotate the camera by 10 to 30 deg");
  app->add_option("--sensor", options->sensor,
                  kSensorHelp + " to calibrate (default: FRAMES_DIR/sensor.toml)");
  app->add_option("--depth-scale", options->depth_scale,
                  "metres per unit of the depth images (default: from frames.toml; else 1e-4 for "
                  "folders with poses.txt, 1e-3 for others)");
  app->add_option("--out", options->out, "sensor file to write (.toml)")->required();
  add_help(*app, kMapGroup,
           "calibrate --noise static --sensor sr4000 --depth-scale 1e-4 --out calibrated.toml");
  return command_of(app, options, calibrate);
}

}  // namespace viewgain::app
