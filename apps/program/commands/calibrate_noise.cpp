// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include "program/commands/calibrate_noise.hpp"

#include <cstddef>
#include <cstdio>
#include <map>

#include "calibration/noise_calibration.hpp"
#include "program/cli/json.hpp"
#include "program/cli/progress.hpp"
#include "program/cli/values.hpp"
#include "program/commands/commands.hpp"
#include "viewgain/core/error.hpp"
#include "viewgain/formats/sensor_toml.hpp"
#include "viewgain/support/stopwatch.hpp"

namespace viewgain::app {

void calibrate_noise(const FrameSequence& frames, const std::string& out, bool json, bool quiet) {
  const Stopwatch watch;
  NoiseCalibration calibration(frames.sensor, frames.depth_scale);
  std::map<std::string, std::size_t> dropped;
  std::size_t used = 0;
  std::string fault;  // of the first frame that cannot be used
  Progress progress("frame", quiet);
  for (std::size_t i = 0; i < frames.images.size(); ++i) {
    progress.update(i + 1, frames.images.size());
    const FrameReading reading = read_frame(frames, i);
    if (reading.fault.verdict != FrameVerdict::used) {
      ++dropped[std::string(frame_verdict_name(reading.fault.verdict))];
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
  write_sensor_toml(out, result.sensor);
  if (json) {
    Json steps = Json::array();
    for (const NoiseStep& step : result.steps) {
      steps.push_back({{"range", step.range},
                       {"sigma_axial", step.sigma_axial},
                       {"fitted_axial", step.fitted_axial},
                       {"pixels", step.pixels}});
    }
    print_json({{"frames", used},
                {"dropped", dropped},
                {"sensor", result.sensor.name},
                {"depth_scale", frames.depth_scale},
                {"sigma_lateral_px", result.sigma_lateral_px},
                {"lateral_in_model", result.lateral_in_model},
                {"edge_length", result.edge_length},
                {"moving_share", result.moving_share},
                {"ranges_tell_shape", result.ranges_tell_shape},
                {"steps", steps},
                {"out", out},
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
  if (!dropped.empty()) std::printf("frames dropped: %s\n", counts_text(dropped).c_str());
  std::printf("%s: %s with this noise\n", out.c_str(), result.sensor.name.c_str());
}

}  // namespace viewgain::app
