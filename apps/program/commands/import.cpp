// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include <cstdio>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "program/cli/flags/frame_folder.hpp"
#include "program/cli/progress.hpp"
#include "program/cli/values.hpp"
#include "program/commands/commands.hpp"
#include "viewgain/formats/recordings.hpp"
#include "viewgain/formats/sensor_toml.hpp"
#include "viewgain/support/stopwatch.hpp"

namespace viewgain::app {
namespace {

struct Options {
  CommonOptions common;
  std::string source;
  std::string format = "tum";
  std::string sensor;
  std::string intrinsics;
  double max_time_gap = ImportConfig{}.max_time_gap;
  std::string mask, confidence;
  std::string out;
};

void check(const Options& options) {
  check_at_least_0("--max-time-gap", options.max_time_gap);
  if (options.intrinsics.empty() && options.sensor.empty()) {
    refuse("--intrinsics or --sensor is needed: a recording does not say its camera");
  }
}

// From the flag, else the sensor's.
PinholeCamera camera_of(const Options& options, const std::optional<Sensor>& sensor) {
  if (options.intrinsics.empty()) return sensor->camera;
  const std::vector<double> k = parse_numbers("--intrinsics", options.intrinsics, 4, 4);
  return {0, 0, k[0], k[1], k[2], k[3], {}};
}

void print_summary(const Options& options, const ImportReport& report,
                   const std::optional<Sensor>& sensor, double seconds) {
  const PinholeCamera& camera = report.camera;
  const std::map<std::string, std::size_t> bad = bad_frames(report.bad);
  if (options.common.json) {
    Json json{{"frames", report.frames},
              {"bad", bad},
              {"orthonormalized_poses", report.orthonormalized},
              {"width", camera.width},
              {"height", camera.height},
              {"intrinsics", {camera.fx, camera.fy, camera.cx, camera.cy}},
              {"readings", report.readings},
              {"masks", report.masks},
              {"masked_pixels", report.masked_pixels},
              {"sensor", sensor ? Json(sensor->name) : Json()},
              {"out", options.out},
              {"seconds", seconds}};
    return print_json(json);
  }
  std::printf("%zu frames of %dx%d px, %s readings: %s\n", report.frames, camera.width,
              camera.height, with_commas(report.readings).c_str(), options.out.c_str());
  if (!bad.empty()) std::printf("left out: %s\n", counts_text(bad).c_str());
  print_mended(report.orthonormalized);
  if (!options.mask.empty() || !options.confidence.empty()) {
    std::printf("masks: of %zu frames, %s pixels taken away\n", report.masks,
                with_commas(report.masked_pixels).c_str());
  }
}

void import_frames(const Options& options) {
  const Stopwatch watch;
  check(options);
  ImportConfig config;
  if (!options.sensor.empty()) config.sensor = load_sensor(options.sensor);
  config.masks = options.mask;
  const Confidence confidence = parse_confidence(options.confidence);
  config.confidences = confidence.folder;
  config.least_confidence = confidence.least;
  config.camera = camera_of(options, config.sensor);
  config.max_time_gap = options.max_time_gap;
  Progress progress("frame", options.common.quiet);
  config.progress = [&progress](std::size_t done, std::size_t of) { progress.update(done, of); };
  const ImportReport report = import_recording(options.source, options.out, config);
  print_summary(options, report, config.sensor, watch.seconds());
}

}  // namespace

Command add_import(App& program) {
  auto options = std::make_shared<Options>();
  App* app = program.add_subcommand(
      "import",
      "A recording in TUM's layout (depth.txt, groundtruth.txt, images in 1/5000 m) as a folder of "
      "frames that integrate reads. Frames that cannot be used are left out and counted by reason: "
      "no_pose, lost_pose, unreadable, wrong_size.");
  app->add_option("SOURCE", options->source, "folder of the recording")->required();
  app->add_option("--format", options->format,
                  "layout of the recording, of which there is one: tum")
      ->check(one_of({"tum"}, "layout"));
  app->add_option("--sensor", options->sensor,
                  kSensorHelp +
                      ", whose noise and ranges the folder is to say; its intrinsics, too, "
                      "without --intrinsics");
  app->add_option("--intrinsics", options->intrinsics, "fx,fy,cx,cy [px]; default: the sensor's");
  app->add_option("--max-time-gap", options->max_time_gap,
                  "between an image and its pose [s]; nothing is interpolated");
  add_mask_options(*app, options->mask, options->confidence);
  app->add_option(
         "--out", options->out,
         "folder to write; files that import has left in it are replaced, others are refused")
      ->required();
  add_help(*app, kMapGroup, "import scene --sensor kinect_v1 --out imported");
  return command_of(app, options, import_frames);
}

}  // namespace viewgain::app
