// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include "program/cli/flags/frame_folder.hpp"

#include <algorithm>
#include <cstdio>

#include "program/cli/help.hpp"
#include "program/cli/values.hpp"
#include "viewgain/core/error.hpp"

namespace viewgain::app {
namespace {

FrameSequence frames_of(const FrameFolderOptions& options) {
  FrameSequence frames = opened(&open_frames, options.folder, options.sensor, options.depth_scale);
  if (const auto meaning = out_of_range_of(options)) {
    frames.out_of_range = *meaning;
    frames.is_out_of_range_assumed = false;
  }
  warn_of_assumptions(options.folder, frames);
  return frames;
}

// Throws Error like MaskFolder, also if no image has a mask.
std::vector<MaskFolder> mask_folders(const FrameFolderOptions& options,
                                     const std::vector<std::filesystem::path>& images) {
  std::vector<MaskFolder> folders;
  if (!options.mask.empty()) folders.emplace_back(options.mask);
  if (!options.confidence.empty()) {
    const Confidence confidence = parse_confidence(options.confidence);
    folders.emplace_back(confidence.folder, confidence.least);
  }
  for (const MaskFolder& folder : folders) folder.require_mask_of_any(images);
  return folders;
}

}  // namespace

FrameSequence opened(OpenFrames open, const std::string& folder, const std::string& sensor,
                     std::optional<double> depth_scale) {
  if (depth_scale) check_positive("--depth-scale", *depth_scale);
  try {
    return open(folder, sensor, depth_scale);
  } catch (const Error& error) {
    if (error.code() != ErrorCode::invalid_argument || !sensor.empty()) throw;
    throw Error(error.code(), std::string(error.what()) + " (--sensor)");
  }
}

void warn_of_assumptions(const std::string& folder, const FrameSequence& frames) {
  const std::string text = assumed_text(frames);
  if (text.empty()) return;
  std::fprintf(stderr, "viewgain: warning: %s: %s\n", folder.c_str(), text.c_str());
}

std::optional<Sensor::OutOfRange> out_of_range_of(const FrameFolderOptions& options) {
  if (options.out_of_range.empty()) return std::nullopt;
  return options.out_of_range == "carve" ? Sensor::OutOfRange::carve : Sensor::OutOfRange::invalid;
}

void check_contradiction(const FrameFolderOptions& options, bool registers) {
  if (options.on_contradiction != "keep" || registers) return;
  refuse("--on-contradiction keep requires --register on");
}

void add_frame_folder_options(App& app, FrameFolderOptions& options) {
  begin_group(app, "Frames");
  app.add_option("--depth-scale", options.depth_scale,
                 "metres per unit of the depth images (default: from frames.toml; else 1e-4 for "
                 "folders with poses.txt, 1e-3 for others)");
  app.add_option(
         "--out-of-range", options.out_of_range,
         "meaning of depth 65535: carve (space is free up to max_range) or invalid (default: from "
         "frames.toml or the sensor; else carve if poses.txt exists, invalid if not)")
      ->check(one_of({"carve", "invalid"}, "value"));
  add_mask_options(app, options.mask, options.confidence);
  app.add_option("--on-contradiction", options.on_contradiction,
                 "what to do with frames that contradict others: skip (omit frames that --register "
                 "refuses, warn about others), keep (requires --register on) or error")
      ->check(one_of({"skip", "keep", "error"}, "value"));
}

void add_mask_options(App& app, std::string& mask, std::string& confidence) {
  app.add_option(
      "--mask", mask,
      "folder of grayscale mask PNGs named like the depth images; nonzero pixels are ignored");
  app.add_option("--confidence", confidence,
                 "DIR[,LEAST]: folder of grayscale confidence PNGs named like the depth images; "
                 "pixels below LEAST (1..255; default: 1) are ignored");
}

Confidence parse_confidence(const std::string& text) {
  const std::size_t comma = text.rfind(',');
  const std::string number = comma == std::string::npos ? "" : text.substr(comma + 1);
  if (number.empty() || number.find_first_not_of("0123456789") != std::string::npos) {
    return {text};
  }
  if (comma == 0) refuse("--confidence " + text + ": expected DIR,LEAST");
  const std::size_t least =
      parse_count("--confidence", parse_numbers("--confidence", number, 1, 1)[0]);
  if (least < 1 || least > 255) refuse("--confidence " + text + ": LEAST must be in 1..255");
  return {text.substr(0, comma), static_cast<std::uint8_t>(least)};
}

FrameFolder::FrameFolder(const FrameFolderOptions& options)
    : name_(options.folder),
      frames_(frames_of(options)),
      masks_(mask_folders(options, frames_.images)),
      refuses_contradictions_(options.on_contradiction == "error") {}

std::optional<Box> workspace_around(std::size_t count, double voxel,
                                    const std::function<std::optional<Box>(std::size_t)>& bounds) {
  std::optional<Box> around;
  for (std::size_t i = 0; i < count; ++i) {
    const std::optional<Box> own = bounds(i);
    if (!own) continue;
    if (!around) around = own;
    for (std::size_t k = 0; k < 3; ++k) {
      around->min[k] = std::min(around->min[k], own->min[k]);
      around->max[k] = std::max(around->max[k], own->max[k]);
    }
  }
  if (!around) return std::nullopt;
  for (std::size_t k = 0; k < 3; ++k) {
    around->min[k] -= voxel / 2;
    around->max[k] += voxel / 2;
  }
  return around;
}

}  // namespace viewgain::app
