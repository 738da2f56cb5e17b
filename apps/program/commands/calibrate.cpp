// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include <Eigen/Core>
#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <map>
#include <memory>
#include <numbers>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "calibration/wall_calibration.hpp"
#include "program/cli/flags/frame_folder.hpp"
#include "program/cli/progress.hpp"
#include "program/cli/values.hpp"
#include "program/commands/calibrate_noise.hpp"
#include "program/commands/commands.hpp"
#include "viewgain/core/error.hpp"
#include "viewgain/formats/file_names.hpp"
#include "viewgain/formats/frames.hpp"
#include "viewgain/formats/masks.hpp"
#include "viewgain/formats/sensor_toml.hpp"
#include "viewgain/support/file_bytes.hpp"
#include "viewgain/support/stopwatch.hpp"
#include "viewgain/support/text.hpp"

namespace viewgain::app {
namespace {

namespace fs = std::filesystem;

struct Options {
  CommonOptions common;
  std::string frames;
  bool noise = false;
  std::string distances;
  std::string wall;
  std::string sensor;
  std::optional<double> depth_scale;
  std::string mask;
  std::string out;
};

// normal · p = offset, world frame [m].
struct Wall {
  Eigen::Vector3d normal;
  double offset;
};

Wall parse_wall(const std::string& text) {
  const std::vector<double> n = parse_numbers("--wall", text, 4, 4);
  const Wall wall{{n[0], n[1], n[2]}, n[3]};
  if (!wall.normal.isZero(0)) return wall;
  refuse("--wall " + text + ": the normal is zero");
}

// The number of the frame of this name, with or without the image's ending.
std::map<std::string, std::size_t> numbers_of(const std::vector<fs::path>& images) {
  constexpr std::string_view kEnding = ".depth.png";
  std::map<std::string, std::size_t> numbers;
  for (std::size_t i = 0; i < images.size(); ++i) {
    const std::string name = images[i].filename().string();
    numbers[name] = i;
    numbers[name.substr(0, name.size() - kEnding.size())] = i;
  }
  return numbers;
}

// The distances of a wall [m], one a depth image: of the text file's line i for image i, or of the
// line that begins with its name, with or without .depth.png; nothing for those that a file with
// names leaves out.
std::vector<std::optional<double>> read_wall_distances(const std::string& path,
                                                       const std::vector<fs::path>& images) {
  const std::map<std::string, std::size_t> numbers = numbers_of(images);
  std::vector<std::optional<double>> distances(images.size());
  const std::string bytes = file_bytes(path);
  std::size_t lines = 0, words = 0;
  for (LineReader line(path, bytes); line.next();) {
    if (line.words().empty() || line.words()[0].starts_with('#')) continue;
    if (lines++ == 0) words = line.words().size();
    if (line.words().size() != words || words > 2) {
      line.fail("needs a distance [m], or a frame's name and its distance, as all other lines");
    }
    std::size_t frame = lines - 1;
    if (words == 2) {
      const auto found = numbers.find(std::string(line.words()[0]));
      if (found == numbers.end()) {
        line.fail("there is no frame " + quoted(line.words()[0]) + " in the folder");
      }
      frame = found->second;
    } else if (frame >= distances.size()) {
      line.fail("is of no frame, the folder has " + std::to_string(distances.size()));
    }
    if (distances[frame]) line.fail("the frame has a distance already");
    const double distance = line.finite_number(words - 1);
    if (!(distance > 0)) line.fail("the distance " + short_text(distance) + " is not positive");
    distances[frame] = distance;
  }
  if (words != 2 && lines < distances.size()) {
    throw Error(ErrorCode::format, path + ": has " + std::to_string(lines) + " distances for " +
                                       std::to_string(distances.size()) +
                                       " frames; with names on its lines it may leave some out");
  }
  return distances;
}

// What the frames' readings come to.
struct Calibrated {
  Sensor sensor;  // with the table
  double depth_scale = 0;
  WallCalibrationResult result;
  std::map<std::string, std::size_t> dropped;  // frames, by the reason
  std::uint64_t masked_pixels = 0;
};

FrameSequence open_calibration_frames(const Options& options) {
  if (options.depth_scale) check_positive("--depth-scale", *options.depth_scale);
  try {
    // Poses need not be there where distances are.
    return options.wall.empty()
               ? open_depth_images(options.frames, options.sensor, options.depth_scale)
               : open_frames(options.frames, options.sensor, options.depth_scale);
  } catch (const Error& error) {
    if (error.code() != ErrorCode::invalid_argument || !options.sensor.empty()) throw;
    throw Error(error.code(), std::string(error.what()) + " (--sensor)");
  }
}

Calibrated measure(const Options& options) {
  FrameSequence frames = open_calibration_frames(options);
  frames.sensor.range_calibration = {};  // readings are to be as the camera gives them
  frames.out_of_range = Sensor::OutOfRange::invalid;
  std::optional<Wall> wall;
  if (!options.wall.empty()) wall = parse_wall(options.wall);
  std::vector<std::optional<double>> distances;
  if (!wall) distances = read_wall_distances(options.distances, frames.images);
  std::optional<MaskFolder> masks;
  if (!options.mask.empty()) {
    masks.emplace(options.mask);
    masks->require_mask_of_any(frames.images);
  }

  Calibrated calibrated;
  std::string fault;  // of the first frame that cannot be used
  WallCalibration calibration(frames.sensor);
  Progress progress("frame", options.common.quiet);
  for (std::size_t i = 0; i < frames.images.size(); ++i) {
    progress.update(i + 1, frames.images.size());
    if (!wall && !distances[i]) {
      ++calibrated.dropped["no_distance"];
      continue;
    }
    const FrameReading reading =
        read_frame(frames, i, masks ? std::span(&*masks, 1) : std::span<const MaskFolder>());
    if (reading.fault.verdict != FrameVerdict::used) {
      ++calibrated.dropped[std::string(frame_verdict_name(reading.fault.verdict))];
      if (fault.empty()) fault = reading.fault.what;
      continue;
    }
    calibrated.masked_pixels += reading.masked_pixels;
    const DepthFrame& frame = reading.frame;
    const std::string name = frames.images[i].string();
    if (wall) {
      const Pose& T_world_camera = frames.poses[i];
      calibration.add(frame, T_world_camera.rotation().transpose() * wall->normal,
                      wall->offset - wall->normal.dot(T_world_camera.translation()), name);
    } else {
      calibration.add(frame, *distances[i], name);
    }
  }
  try {
    calibrated.result = calibration.solve();
  } catch (const Error& error) {
    if (fault.empty()) throw;
    throw Error(error.code(), std::string(error.what()) + "; " + fault);
  }
  calibrated.depth_scale = frames.depth_scale;
  calibrated.sensor = frames.sensor;
  calibrated.sensor.range_calibration = calibrated.result.calibration;
  return calibrated;
}

// Readings, by the reason for which they were dropped.
std::map<std::string, std::size_t> dropped_readings(const WallCalibrationResult& result) {
  std::map<std::string, std::size_t> dropped;
  for (const WallFrameFigures& frame : result.frames) {
    dropped["border"] += frame.border;
    dropped["sparse"] += frame.sparse;
    dropped["limits"] += frame.limits;
    dropped["off_wall"] += frame.off_wall;
  }
  return dropped;
}

std::uint64_t used_readings(const WallCalibrationResult& result) {
  std::uint64_t used = 0;
  for (const WallFrameFigures& frame : result.frames) used += frame.used;
  return used;
}

Json or_null(const std::optional<double>& value) { return value ? Json(*value) : nullptr; }

double degrees(double angle) { return angle * 180 / std::numbers::pi; }

std::string base_name(const std::string& path) { return fs::path(path).filename().string(); }

Json frame_json(const WallFrameFigures& frame) {
  return {{"name", base_name(frame.name)},  {"distance", frame.distance},
          {"tilt", degrees(frame.tilt)},    {"readings", frame.used},
          {"border", frame.border},         {"sparse", frame.sparse},
          {"limits", frame.limits},         {"off_wall", frame.off_wall},
          {"rms_before", frame.rms_before}, {"rms_after", or_null(frame.rms_after)}};
}

void print_json_summary(const Options& options, const Calibrated& calibrated, double seconds) {
  const WallCalibrationResult& result = calibrated.result;
  Json per_frame = Json::array();
  for (const WallFrameFigures& frame : result.frames) per_frame.push_back(frame_json(frame));
  print_json({{"frames", result.frames.size()},
              {"dropped", calibrated.dropped},
              {"readings", used_readings(result)},
              {"dropped_readings", dropped_readings(result)},
              {"masked_pixels", calibrated.masked_pixels},
              {"sensor", calibrated.sensor.name},
              {"depth_scale", calibrated.depth_scale},
              {"nearest", result.nearest},
              {"farthest", result.farthest},
              {"widest_gap", result.widest_gap},
              {"rms_before", result.rms_before},
              {"rms_after", or_null(result.rms_after)},
              {"rms_noise", result.rms_noise},
              {"entries", result.calibration.table.size()},
              {"per_frame", per_frame},
              {"out", options.out},
              {"seconds", seconds}});
}

std::string millimetres(const std::optional<double>& value) {
  return value ? formatted("%.2f", 1e3 * *value) : "-";
}

void print_summary(const Options& options, const Calibrated& calibrated) {
  const WallCalibrationResult& result = calibrated.result;
  std::printf("%-28s %8s %6s %10s %8s %9s %9s\n", "frame", "wall [m]", "tilt", "readings",
              "off wall", "RMS [mm]", "after");
  for (const WallFrameFigures& frame : result.frames) {
    std::printf("%-28s %8.3f %6.1f %10s %8s %9s %9s\n", base_name(frame.name).c_str(),
                frame.distance, degrees(frame.tilt), with_commas(frame.used).c_str(),
                with_commas(frame.off_wall).c_str(), millimetres(frame.rms_before).c_str(),
                millimetres(frame.rms_after).c_str());
  }
  std::printf("%zu frames (%s), %s readings at ranges from %.3f to %.3f m, no gap over %.3f m\n",
              result.frames.size(), calibrated.sensor.name.c_str(),
              with_commas(used_readings(result)).c_str(), result.nearest, result.farthest,
              result.widest_gap);
  if (!calibrated.dropped.empty()) {
    std::printf("frames dropped: %s\n", counts_text(calibrated.dropped).c_str());
  }
  std::printf("readings dropped: %s\n", counts_text(dropped_readings(result)).c_str());
  if (!options.mask.empty()) {
    std::printf("pixels taken away by masks: %s\n", with_commas(calibrated.masked_pixels).c_str());
  }
  if (result.rms_after) {
    std::printf(
        "systematic error, RMS: %s mm; corrected by the table of the other frames: %s mm (noise "
        "alone: %s mm)\n",
        millimetres(result.rms_before).c_str(), millimetres(result.rms_after).c_str(),
        millimetres(result.rms_noise).c_str());
  } else {
    std::printf("what is left cannot be told: no frame lies within the ranges of the others\n");
  }
  std::printf("%s: %s with a table of %zu ranges\n", options.out.c_str(),
              calibrated.sensor.name.c_str(), result.calibration.table.size());
}

void calibrate(const Options& options) {
  const Stopwatch watch;
  const int ways = (options.noise ? 1 : 0) + (options.distances.empty() ? 0 : 1) +
                   (options.wall.empty() ? 0 : 1);
  if (ways != 1) refuse("needs one of --noise, --distances or --wall");
  if (options.noise && !options.mask.empty()) refuse("--mask does not go with --noise");
  if (!is_sensor_file(options.out) && !is_special_file(options.out)) {
    refuse("--out " + options.out + ": the name of a sensor file must end in .toml");
  }
  if (options.noise) {
    FrameSequence frames = open_calibration_frames(options);
    frames.out_of_range = Sensor::OutOfRange::invalid;
    return calibrate_noise(frames, options.out, options.common.json, options.common.quiet);
  }
  const Calibrated calibrated = measure(options);
  write_sensor_toml(options.out, calibrated.sensor);
  if (options.common.json) {
    print_json_summary(options, calibrated, watch.seconds());
  } else {
    print_summary(options, calibrated);
  }
}

}  // namespace

Command add_calibrate(App& program) {
  auto options = std::make_shared<Options>();
  App* app = program.add_subcommand(
      "calibrate",
      "The systematic error of a depth camera, by the range, from frames of a flat wall: a sensor "
      "file with a table that is subtracted from readings wherever frames are read. FRAMES_DIR is "
      "as of integrate; with --distances it needs no poses. Frames at a slant show more ranges, "
      "so ten may do: turn the camera by 30 to 40 degrees. With --noise how readings scatter "
      "instead: sigma_ax and "
      "sigma_lat in the sensor's noise model.");
  app->add_option("FRAMES_DIR", options->frames, "folder of frames of a wall, or of a static scene")
      ->required();
  app->add_flag("--noise", options->noise,
                "measure the noise from 30 frames or more of a static scene with edges before a "
                "wall, from one pose; poses need not be there");
  app->add_option("--distances", options->distances,
                  "text file: line i is the wall's distance [m] along the optical axis in frame i; "
                  "or lines of a frame's name and its distance, which may leave frames out. Tilts "
                  "are found");
  app->add_option(
      "--wall", options->wall,
      "nx,ny,nz,d: the wall in the world is normal . p = d [m]; the frames' poses hold");
  app->add_option("--sensor", options->sensor,
                  kSensorHelp +
                      "; default: FRAMES_DIR/sensor.toml. A table that it has is replaced, "
                      "with --noise kept");
  app->add_option(
      "--depth-scale", options->depth_scale,
      "metres per unit of the images; default: 1e-4 for what simulate writes (poses.txt and "
      "sensor.toml), else 1e-3");
  app->add_option("--mask", options->mask, kMaskHelp);
  app->add_option("--out", options->out, "sensor file to write (.toml)")->required();
  add_common_options(*app, options->common);
  add_help(*app, kMapGroup,
           "calibrate wall --distances distances.txt --sensor sr4000 --out calibrated.toml");
  return {app, [options] { calibrate(*options); }};
}

}  // namespace viewgain::app
