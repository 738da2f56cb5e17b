// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0

// Recordings that consist of PNG images and a list of them.
#include <algorithm>
#include <optional>
#include <system_error>

#include "recordings/importers.hpp"
#include "viewgain/core/error.hpp"
#include "viewgain/formats/frames.hpp"

namespace viewgain {
namespace {

namespace fs = std::filesystem;

constexpr std::uint16_t kSaturated = 65535;

// Masks may be anywhere, but files inside the recording are untrusted.
void refuse_mask_link_out(const fs::path& source, const fs::path& mask) {
  const fs::path within = mask.lexically_normal().lexically_relative(source.lexically_normal());
  if (!within.empty() && *within.begin() != "..") refuse_link_out(source, source / within);
}

// The image if it has the camera's size, otherwise the reason. If the camera has no size, the first
// image sets it.
std::optional<GrayImage> read_image_file(const fs::path& file, PinholeCamera& camera,
                                         Dropped& dropped) {
  try {
    const auto [width, height] = png_size(file);
    if (camera.width == 0) camera.width = width, camera.height = height;
    if (width == camera.width && height == camera.height) {
      GrayImage image = read_gray_png(file, width, height);
      std::replace(image.pixels.begin(), image.pixels.end(), kSaturated, std::uint16_t{0});
      return image;
    }
    dropped.add({FrameVerdict::wrong_size, file.string() + ": the image has " +
                                               size_text(width, height) + " pixels, not " +
                                               size_text(camera.width, camera.height)});
  } catch (const Error& error) {
    dropped.add({FrameVerdict::unreadable, error.what()});
  }
  return std::nullopt;
}

}  // namespace

void refuse_link_out(const fs::path& source, const fs::path& file) {
  std::error_code ignored;
  const fs::path root = fs::canonical(source, ignored) / "";
  fs::path path = source;
  for (const fs::path& name : file.lexically_relative(source)) {
    path /= name;
    if (!fs::is_symlink(path, ignored)) continue;
    std::error_code code;  // also for a broken link
    const std::string to = (fs::canonical(path, code) / "").string();
    if (!code && to.starts_with(root.string())) continue;
    throw Error(ErrorCode::format, path.string() + ": the link leads out of the recording");
  }
}

fs::path path_inside(const std::string& name) {
  const auto image = fs::path(name).lexically_normal();
  return image.empty() || image.is_absolute() || *image.begin() == ".." ? fs::path() : image;
}

void import_images(const fs::path& source, const std::vector<RecordedFrame>& frames,
                   double depth_scale, const ImportConfig& config, const fs::path& out,
                   Dropped& dropped, ImportReport& report) {
  std::vector<MaskFolder> mask_folders;
  if (!config.masks.empty()) mask_folders.emplace_back(config.masks);
  if (!config.confidences.empty()) {
    mask_folders.emplace_back(config.confidences, config.least_confidence);
  }
  std::vector<fs::path> images;
  for (const RecordedFrame& frame : frames) images.push_back(frame.image);
  for (const MaskFolder& masks : mask_folders) masks.require_mask_of_any(images);
  RecordedFolder folder(out);
  for (const auto& [number, image, pose] : frames) {
    std::optional<GrayImage> depth = read_image_file(image, report.camera, dropped);
    if (!depth) continue;
    bool is_masked = false;
    for (const MaskFolder& masks : mask_folders) {
      refuse_mask_link_out(source, masks.file_of(image));
      std::optional<Gray8Image> mask = masks.mask_of(image, depth->width, depth->height);
      if (!mask) continue;
      is_masked = true;
      report.masked_pixels += apply_mask(*mask, *depth);
    }
    report.masks += is_masked ? 1 : 0;
    report.readings += static_cast<std::uint64_t>(
        std::count_if(depth->pixels.begin(), depth->pixels.end(), [](auto z) { return z != 0; }));
    folder.write(number, *depth, pose.T_world_camera);
    ++report.frames;
    report.orthonormalized += pose.is_mended ? 1 : 0;
    if (config.progress) config.progress(report.frames, frames.size());
  }
  if (report.frames == 0) dropped.fail_without_frames(source);
  report.depth_scale = depth_scale;
  folder.commit(report.camera, config.sensor, depth_scale, Sensor::OutOfRange::invalid);
}

}  // namespace viewgain
