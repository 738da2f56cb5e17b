// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include "viewgain/formats/recordings.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <system_error>
#include <utility>

#include "folders.hpp"
#include "recordings/parts.hpp"
#include "viewgain/core/error.hpp"
#include "viewgain/formats/frames.hpp"
#include "viewgain/formats/masks.hpp"
#include "viewgain/support/nearest_name.hpp"
#include "viewgain/support/text.hpp"

namespace viewgain {
namespace {

namespace fs = std::filesystem;

constexpr std::uint16_t kSaturated = 65535;

std::string size_text(int width, int height) {
  return std::to_string(width) + "x" + std::to_string(height);
}

Recording opened(const fs::path& source, RecordingFormat format, const RecordingConfig& config) {
  switch (format) {
    case RecordingFormat::tum:
      return open_tum(source, config);
    case RecordingFormat::bop:
      return open_bop(source, config);
    case RecordingFormat::scannet:
      return open_scannet(source, config);
    case RecordingFormat::icl_nuim:
      return open_icl_nuim(source, config);
  }
  throw Error(ErrorCode::invalid_argument, "there is no such format of recordings");
}

// A recording may be of anybody, and leads to no files of elsewhere.
void refuse_links_out(const fs::path& source) {
  std::error_code ignored;
  const fs::path root = fs::canonical(source, ignored) / "";
  for (const fs::directory_entry& entry : fs::recursive_directory_iterator(source, ignored)) {
    if (!entry.is_symlink(ignored)) continue;
    std::error_code code;  // of one that leads nowhere, too
    const std::string to = fs::canonical(entry.path(), code).string();
    if (!code && to.starts_with(root.string())) continue;
    throw Error(ErrorCode::format, entry.path().string() + ": is a link out of the recording");
  }
}

// The camera takes the first frame's size; frames of another one are dropped.
void keep_one_size(Recording& recording) {
  PinholeCamera& camera = recording.camera;
  std::vector<RecordedFrame> kept;
  for (RecordedFrame& frame : recording.frames) {
    int width = 0, height = 0;
    try {
      const std::array<int, 2> size = png_size(frame.image);
      width = size[0], height = size[1];
    } catch (const Error& error) {
      drop_frame(recording, {FrameVerdict::unreadable, error.what()});
      continue;
    }
    if (kept.empty()) {
      if (camera.width != 0 && (camera.width != width || camera.height != height)) {
        throw Error(ErrorCode::format, frame.image.string() + ": the image has " +
                                           size_text(width, height) + " pixels, the sensor " +
                                           size_text(camera.width, camera.height));
      }
      camera.width = width, camera.height = height;
    }
    if (width != camera.width || height != camera.height) {
      drop_frame(recording, {FrameVerdict::wrong_size});
    } else {
      kept.push_back(std::move(frame));
    }
  }
  recording.frames = std::move(kept);
}

template <typename Image>
void reverse_rows(Image& image) {
  const auto columns = static_cast<std::ptrdiff_t>(image.width);
  for (std::ptrdiff_t v = 0, w = image.height - 1; v < w; ++v, --w) {
    std::swap_ranges(image.pixels.begin() + v * columns, image.pixels.begin() + (v + 1) * columns,
                     image.pixels.begin() + w * columns);
  }
}

// The amplitude image that belongs to a depth image, in units of kAmplitudeUnit.
std::optional<GrayImage> amplitude_of(const RecordedFrame& frame, const Recording& recording,
                                      const ImportConfig& config) {
  const fs::path file = config.amplitudes / frame.image.filename();
  if (config.amplitudes.empty() || !is_there(file)) return std::nullopt;
  GrayImage image = read_gray_png(file, recording.camera.width, recording.camera.height);
  for (std::uint16_t& value : image.pixels) {
    const double units = std::round(value * (config.amplitude_scale / kAmplitudeUnit));
    value = static_cast<std::uint16_t>(std::min(units, 65535.0));
  }
  if (recording.rows_reversed) reverse_rows(image);
  return image;
}

// Row v becomes row height - 1 - v. The rays in the camera's frame, and so the poses, stay.
void turn_camera(Recording& recording) {
  recording.rows_reversed = true;
  recording.camera.fy = -recording.camera.fy;
  recording.camera.cy = recording.camera.height - 1 - recording.camera.cy;
}

}  // namespace

const std::vector<std::string>& recording_format_names() {
  static const std::vector<std::string> names{"tum", "bop", "scannet", "icl-nuim"};
  return names;
}

RecordingFormat recording_format(std::string_view name) {
  const std::vector<std::string>& names = recording_format_names();
  const auto found = std::find(names.begin(), names.end(), name);
  if (found == names.end()) {
    throw Error(ErrorCode::invalid_argument,
                "format \"" + std::string(name) + "\": there is none of this name" +
                    did_you_mean(name, names) + " (there are " + listed(names) + ")");
  }
  return static_cast<RecordingFormat>(found - names.begin());
}

Recording open_recording(const fs::path& source, RecordingFormat format,
                         const RecordingConfig& config) {
  if (!(config.max_time_gap >= 0)) {
    throw Error(ErrorCode::invalid_argument,
                "the gap of time " + short_text(config.max_time_gap) + " must not be negative");
  }
  std::error_code ignored;
  if (!fs::is_directory(source, ignored)) {
    throw Error(ErrorCode::io, source.string() + ": no such folder");
  }
  refuse_links_out(source);
  Recording recording = opened(source, format, config);
  keep_one_size(recording);
  if (recording.frames.empty()) {
    std::string reasons;
    for (const auto& [reason, count] : bad_frames(recording.dropped)) {
      reasons += (reasons.empty() ? "" : ", ") + std::to_string(count) + ' ' + reason;
    }
    if (!recording.fault.empty()) reasons += "; " + recording.fault;
    throw Error(ErrorCode::format, source.string() + ": no frame can be used (" + reasons + ")");
  }
  if (recording.camera.fy < 0) turn_camera(recording);
  try {
    recording.camera.validate();
  } catch (const Error& error) {
    throw Error(error.code(), source.string() + ": " + error.what());
  }
  return recording;
}

GrayImage load_depth(const Recording& recording, std::size_t index) {
  if (index >= recording.frames.size()) {
    throw Error(ErrorCode::invalid_argument, "there is no frame " + std::to_string(index) + " of " +
                                                 std::to_string(recording.frames.size()));
  }
  const PinholeCamera& camera = recording.camera;
  GrayImage image = read_gray_png(recording.frames[index].image, camera.width, camera.height);
  std::replace(image.pixels.begin(), image.pixels.end(), kSaturated, std::uint16_t{0});
  if (recording.rows_reversed) reverse_rows(image);
  return image;
}

ImportReport import_recording(const Recording& recording, const fs::path& out,
                              const ImportConfig& config) {
  std::vector<MaskFolder> folders;
  if (!config.masks.empty()) folders.emplace_back(config.masks);
  if (!config.confidences.empty()) {
    folders.emplace_back(config.confidences, config.least_confidence);
  }
  std::vector<fs::path> images;
  for (const RecordedFrame& frame : recording.frames) images.push_back(frame.image);
  for (const MaskFolder& folder : folders) folder.require_mask_of_any(images);
  if (!config.amplitudes.empty()) MaskFolder(config.amplitudes).require_mask_of_any(images);
  if (!(config.amplitude_scale > 0) || !std::isfinite(config.amplitude_scale)) {
    throw Error(ErrorCode::invalid_argument, "the scale of amplitudes " +
                                                 short_text(config.amplitude_scale) +
                                                 " must be positive and finite");
  }
  RecordedFramesWriter writer(out);
  ImportReport report;
  std::string first_fault;
  for (std::size_t i = 0; i < recording.frames.size(); ++i) {
    const RecordedFrame& frame = recording.frames[i];
    GrayImage depth;
    try {
      depth = load_depth(recording, i);
    } catch (const Error& error) {
      if (error.code() != ErrorCode::io && error.code() != ErrorCode::format) throw;
      if (report.unreadable++ == 0) first_fault = error.what();
      continue;
    }
    bool is_masked = false;
    for (const MaskFolder& folder : folders) {
      std::optional<Gray8Image> mask = folder.mask_of(frame.image, depth.width, depth.height);
      if (!mask) continue;
      is_masked = true;
      if (recording.rows_reversed) reverse_rows(*mask);
      report.masked_pixels += apply_mask(*mask, depth);
    }
    report.masks += is_masked ? 1 : 0;
    report.readings += static_cast<std::uint64_t>(
        std::count_if(depth.pixels.begin(), depth.pixels.end(), [](auto z) { return z != 0; }));
    const std::optional<GrayImage> amplitude = amplitude_of(frame, recording, config);
    report.amplitudes += amplitude ? 1 : 0;
    writer.write_frame(frame.number, depth, frame.T_world_camera, amplitude);
    if (config.progress) config.progress(i + 1, recording.frames.size());
  }
  if (report.unreadable == recording.frames.size()) {
    throw Error(ErrorCode::format, first_fault + "; nor can any other image be read");
  }
  writer.commit(recording.camera, recording.depth_scale, config.sensor);
  return report;
}

}  // namespace viewgain
