// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include <cstdio>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "program/cli/flags/frame_folder.hpp"
#include "program/cli/help.hpp"
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
  std::string format = "auto";
  std::string sensor;
  std::string intrinsics;
  std::optional<double> max_time_gap;
  std::optional<double> depth_scale;
  std::string world, camera_frame, depth_topic, pose_topic;
  std::string mask, confidence;
  std::string out;
};

// In the order of RecordingFormat.
const std::vector<std::string> kFormats{"tum", "mcap", "rosbag2", "rosbag", "transforms"};

bool has_messages(RecordingFormat format) {
  return format != RecordingFormat::tum && format != RecordingFormat::transforms;
}

void check(const Options& options, RecordingFormat format) {
  const std::string& found = kFormats.at(static_cast<std::size_t>(format));
  if (options.format != "auto" && options.format != found) {
    refuse("--format", options.format, options.source + " has the format " + found);
  }
  if (options.max_time_gap) check_at_least_0("--max-time-gap", *options.max_time_gap);
  if (options.depth_scale) check_positive("--depth-scale", *options.depth_scale);
  if (format == RecordingFormat::tum && options.intrinsics.empty() && options.sensor.empty()) {
    refuse(
        "a recording in the TUM layout does not state its camera; give --intrinsics or --sensor");
  }
  for (const auto& [flag, value] :
       {std::pair("--world", options.world), std::pair("--depth-topic", options.depth_topic),
        std::pair("--camera-frame", options.camera_frame),
        std::pair("--pose-topic", options.pose_topic)}) {
    if (value.empty() || has_messages(format)) continue;
    refuse(flag, value,
           "this flag requires a recording of ROS messages; SOURCE has the format " + found);
  }
}

// Name and pose of NAME[,tx,ty,tz,qx,qy,qz,qw].
std::pair<std::string, std::optional<Pose>> parse_mount(const char* flag, const std::string& text) {
  const std::size_t comma = text.find(',');
  if (comma == std::string::npos) return {text, std::nullopt};
  if (comma == 0) refuse(flag, text, "expected a name before the pose");
  return {text.substr(0, comma), parse_pose(flag, text.substr(comma + 1))};
}

// The camera of the flag; without the flag the library chooses.
PinholeCamera camera_of(const Options& options) {
  if (options.intrinsics.empty()) return {};
  const std::vector<double> k = parse_numbers("--intrinsics", options.intrinsics, 4, 4);
  return {0, 0, k[0], k[1], k[2], k[3], {}};
}

void print_summary(const Options& options, RecordingFormat format, const ImportReport& report,
                   const std::optional<Sensor>& sensor, double seconds) {
  const PinholeCamera& camera = report.camera;
  const std::map<std::string, std::size_t> bad = bad_frames(report.bad);
  if (options.common.json) {
    Json json{{"format", kFormats.at(static_cast<std::size_t>(format))},
              {"frames", report.frames},
              {"bad", bad},
              {"orthonormalized_poses", report.orthonormalized},
              {"width", camera.width},
              {"height", camera.height},
              {"intrinsics", {camera.fx, camera.fy, camera.cx, camera.cy}},
              {"readings", report.readings},
              {"masks", report.masks},
              {"masked_pixels", report.masked_pixels},
              {"depth_scale", report.depth_scale},
              {"depth_topic", or_null(report.depth_topic)},
              {"world", or_null(report.world)},
              {"warnings", report.warnings},
              {"sensor", sensor ? Json(sensor->name) : Json()},
              {"out", options.out},
              {"seconds", seconds}};
    return print_json(json);
  }
  std::printf("%zu frames of %dx%d px, %s pixels with a depth: %s\n", report.frames, camera.width,
              camera.height, with_commas(report.readings).c_str(), options.out.c_str());
  if (has_messages(format)) {
    std::printf("depth images from the topic %s, poses in the tf frame %s\n",
                printable(report.depth_topic).c_str(), printable(report.world).c_str());
  }
  if (!bad.empty()) std::printf("left out: %s\n", counts_text(bad).c_str());
  print_mended(report.orthonormalized);
  if (!sensor) {
    std::printf(
        "no sensor.toml was written, because --sensor is missing; give model a --sensor "
        "for %dx%d px\n",
        camera.width, camera.height);
  }
  if (!options.mask.empty() || !options.confidence.empty()) {
    std::printf("%zu frames have a mask; masks removed %s pixels\n", report.masks,
                with_commas(report.masked_pixels).c_str());
  }
}

void import_frames(const Options& options) {
  const Stopwatch watch;
  const RecordingFormat format = recording_format(options.source);
  check(options, format);
  ImportConfig config;
  if (!options.sensor.empty()) config.sensor = load_sensor(options.sensor);
  config.masks = options.mask;
  const Confidence confidence = parse_confidence(options.confidence);
  config.confidences = confidence.folder;
  config.least_confidence = confidence.least;
  config.camera = camera_of(options);
  config.max_time_gap = options.max_time_gap;
  config.depth_scale = options.depth_scale;
  config.world = options.world;
  config.depth_topic = options.depth_topic;
  std::tie(config.pose_topic, config.T_body_camera) =
      parse_mount("--pose-topic", options.pose_topic);
  const auto [frame, T_frame_camera] = parse_mount("--camera-frame", options.camera_frame);
  config.camera_frame = frame;
  config.T_frame_camera = T_frame_camera.value_or(Pose());
  Progress progress("frame", options.common.quiet);
  config.progress = [&progress](std::size_t done, std::size_t of) { progress.update(done, of); };
  const ImportReport report = import_recording(options.source, options.out, config);
  progress.wipe();
  for (const std::string& warning : report.warnings) {
    std::fprintf(stderr, "viewgain: warning: %s\n", printable(warning).c_str());
  }
  print_summary(options, format, report, config.sensor, watch.seconds());
}

}  // namespace

Command add_import(App& program) {
  auto options = std::make_shared<Options>();
  App* app = program.add_subcommand(
      "import",
      "Convert a recording into a folder of frames for integrate and model. Frames that cannot be "
      "used are left out and counted per reason: no_pose, lost_pose, unreadable or wrong_size.");
  app->add_option("SOURCE", options->source, "file or folder of the recording")->required();
  std::vector<std::string> formats{"auto"};
  formats.insert(formats.end(), kFormats.begin(), kFormats.end());
  app->add_option("--format", options->format,
                  "format of the recording; auto: detect from its contents")
      ->check(one_of(formats, "format"));
  app->add_option("--sensor", options->sensor,
                  kSensorHelp + "; its intrinsics are used if the recording has none");
  app->add_option("--intrinsics", options->intrinsics,
                  "fx,fy,cx,cy [px] (default: from the recording, else from the sensor)");
  app->add_option("--depth-topic", options->depth_topic,
                  "topic of the depth images (default: the only one)");
  app->add_option(
      "--world", options->world,
      "tf frame to use as the world (default: the topmost parent of the images' frame_id)");
  app->add_option("--camera-frame", options->camera_frame,
                  "FRAME[,tx,ty,tz,qx,qy,qz,qw]: tf frame to use instead of the images' frame_id, "
                  "and the camera's pose in FRAME");
  app->add_option("--pose-topic", options->pose_topic,
                  "TOPIC[,tx,ty,tz,qx,qy,qz,qw]: PoseStamped or Odometry topic of a body, used "
                  "instead of tf, and the camera's pose on this body");
  app->add_option(
      "--max-time-gap", options->max_time_gap,
      "longest time between an image and its pose [s] (default: 0.1; for TUM, 0.02); the tf "
      "transforms before and after an image may be up to twice this time apart");
  app->add_option(
      "--depth-scale", options->depth_scale,
      "metres per unit of 16-bit depth images (default: from the recording, else 1e-3)");
  add_mask_options(*app, options->mask, options->confidence);
  app->add_option(
         "--out", options->out,
         "folder to write; frames of an earlier import are replaced, other frames cause an error")
      ->required();
  explain_values(
      *app,
      "Formats of recordings:\n"
      "  MCAP, rosbag2 (.db3), ROS 1 (.bag)  depth images and tf\n"
      "  transforms.json  from nerfstudio or instant-ngp, with depth images\n"
      "  TUM              depth.txt, groundtruth.txt, depth images in units of 1/5000 m\n");
  add_help(*app, kMapGroup, "import scene --sensor kinect_v1 --out imported");
  return command_of(app, options, import_frames);
}

}  // namespace viewgain::app
