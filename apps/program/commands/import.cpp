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
  std::string format;
  std::string sensor;
  std::string intrinsics;
  double max_time_gap = RecordingConfig{}.max_time_gap;
  std::string mask, confidence;
  int least_confidence = 1;
  std::string amplitude;
  double amplitude_scale = ImportConfig{}.amplitude_scale;
  std::string out;
};

bool has_own_intrinsics(RecordingFormat format) {
  return format == RecordingFormat::bop || format == RecordingFormat::scannet;
}

void check(const Options& options, const App& app, RecordingFormat format) {
  const auto refuse = [&options](const std::string& what) {
    app::refuse(what + " --format " + options.format);
  };
  check_at_least_0("--max-time-gap", options.max_time_gap);
  check_positive("--amplitude-scale", options.amplitude_scale);
  if (app.count("--amplitude-scale") > 0 && options.amplitude.empty()) {
    app::refuse("--amplitude-scale goes with --amplitude");
  }
  if (app.count("--max-time-gap") > 0 && format != RecordingFormat::tum) {
    refuse("--max-time-gap is not for");
  }
  if (!options.intrinsics.empty() && has_own_intrinsics(format)) {
    refuse("--intrinsics is not for a recording that has its own:");
  }
  if (options.intrinsics.empty() && options.sensor.empty() && format == RecordingFormat::tum) {
    refuse("--intrinsics or --sensor is needed with");
  }
}

// From the flag, else a TUM recording's sensor.
RecordingConfig config_of(const Options& options, RecordingFormat format,
                          const std::optional<Sensor>& sensor) {
  RecordingConfig config;
  config.max_time_gap = options.max_time_gap;
  if (!options.intrinsics.empty()) {
    const std::vector<double> k = parse_numbers("--intrinsics", options.intrinsics, 4, 4);
    config.camera.emplace();
    config.camera->fx = k[0], config.camera->fy = k[1];
    config.camera->cx = k[2], config.camera->cy = k[3];
  } else if (format == RecordingFormat::tum) {
    config.camera = sensor->camera;
  }
  return config;
}

void print_summary(const Options& options, const Recording& recording, const ImportReport& report,
                   const std::optional<Sensor>& sensor, double seconds) {
  const PinholeCamera& camera = recording.camera;
  const std::size_t frames = recording.frames.size() - report.unreadable;
  FrameCounts counts = recording.dropped;
  if (report.unreadable > 0) counts[FrameVerdict::unreadable] += report.unreadable;
  const std::map<std::string, std::size_t> dropped = bad_frames(counts);
  if (options.common.json) {
    Json json{{"format", options.format},
              {"frames", frames},
              {"dropped", dropped},
              {"orthonormalized_poses", recording.orthonormalized},
              {"width", camera.width},
              {"height", camera.height},
              {"intrinsics", {camera.fx, camera.fy, camera.cx, camera.cy}},
              {"depth_scale", recording.depth_scale},
              {"rows_reversed", recording.rows_reversed},
              {"readings", report.readings},
              {"masks", report.masks},
              {"masked_pixels", report.masked_pixels},
              {"amplitudes", report.amplitudes},
              {"sensor", sensor ? Json(sensor->name) : Json()},
              {"out", options.out},
              {"seconds", seconds}};
    return print_json(json);
  }
  std::printf("%zu frames of %dx%d px, %s m per unit, %s readings: %s\n", frames, camera.width,
              camera.height, short_text(recording.depth_scale).c_str(),
              with_commas(report.readings).c_str(), options.out.c_str());
  if (!dropped.empty()) std::printf("left out: %s\n", counts_text(dropped).c_str());
  if (recording.orthonormalized > 0) {
    std::printf("rotations that were off and were orthonormalised: %zu of %zu\n",
                recording.orthonormalized, frames);
  }
  if (recording.rows_reversed) std::printf("rows of the images are reversed: fy was negative\n");
  if (!options.mask.empty() || !options.confidence.empty()) {
    std::printf("masks: of %zu frames, %s pixels taken away\n", report.masks,
                with_commas(report.masked_pixels).c_str());
  }
  if (!options.amplitude.empty()) std::printf("amplitudes: of %zu frames\n", report.amplitudes);
}

void import_frames(const Options& options, const App& app) {
  const Stopwatch watch;
  const RecordingFormat format = recording_format(options.format);
  check(options, app, format);
  ImportConfig config;
  if (!options.sensor.empty()) config.sensor = load_sensor(options.sensor);
  config.masks = options.mask;
  config.confidences = options.confidence;
  config.least_confidence = static_cast<std::uint8_t>(options.least_confidence);
  config.amplitudes = options.amplitude;
  config.amplitude_scale = options.amplitude_scale;
  const Recording recording =
      open_recording(options.source, format, config_of(options, format, config.sensor));
  Progress progress("frame", options.common.quiet);
  config.progress = [&progress](std::size_t done, std::size_t of) { progress.update(done, of); };
  const ImportReport report = import_recording(recording, options.out, config);
  print_summary(options, recording, report, config.sensor, watch.seconds());
}

}  // namespace

Command add_import(App& program) {
  auto options = std::make_shared<Options>();
  App* app = program.add_subcommand(
      "import",
      "A recording in another format as a folder of frames that integrate reads. tum: depth.txt, "
      "groundtruth.txt, images in 1/5000 m. bop: a scene's depth/ and scene_camera.json. scannet: "
      "depth/, pose/, intrinsic/intrinsic_depth.txt. icl-nuim: the PNGs like TUM's, depth/ and "
      "*.gt.freiburg. Frames that cannot be used are left out and counted by reason: no_pose, "
      "lost_pose, unreadable, wrong_size, intrinsics, depth_scale.");
  app->add_option("SOURCE", options->source, "folder of the recording")->required();
  app->add_option("--format", options->format, "how it is laid out")
      ->required()
      ->check(one_of(recording_format_names(), "format"));
  app->add_option("--sensor", options->sensor,
                  kSensorHelp +
                      ", whose noise and ranges the folder is to say; of tum its intrinsics, too, "
                      "without --intrinsics");
  app->add_option("--intrinsics", options->intrinsics,
                  "fx,fy,cx,cy [px], for tum and icl-nuim (481.2,-480,319.5,239.5 unless given); "
                  "of a negative fy the images' rows are reversed");
  app->add_option("--max-time-gap", options->max_time_gap,
                  "between an image and its pose, for tum [s]; nothing is interpolated")
      ->capture_default_str();
  app->add_option("--mask", options->mask, kMaskHelp);
  app->add_option("--confidence", options->confidence, kConfidenceHelp);
  app->add_option("--least-confidence", options->least_confidence, kLeastConfidenceHelp)
      ->capture_default_str()
      ->check(CLI::Range(1, 255, "confidence"));
  app->add_option("--amplitude", options->amplitude,
                  "folder of grayscale PNGs, up to 16 bits, with the names of the recording's "
                  "images: how strong the light is that comes back, which tells a shot noise "
                  "sensor how far a reading may be off");
  app->add_option("--amplitude-scale", options->amplitude_scale,
                  "of the images of --amplitude [1/m^2 per unit]: 1 is what a surface that faces "
                  "the camera at 1 m gives")
      ->capture_default_str();
  app->add_option(
         "--out", options->out,
         "folder to write; files that import has left in it are replaced, others are refused")
      ->required();
  add_common_options(*app, options->common);
  add_help(*app, kMapGroup, "import scene --format scannet --sensor sr4000 --out imported");
  return {app, [options, app] { import_frames(*options, *app); }};
}

}  // namespace viewgain::app
