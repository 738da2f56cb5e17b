// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include "viewgain/formats/masks.hpp"

#include <algorithm>
#include <cstddef>
#include <string>
#include <system_error>
#include <utility>

#include "folders.hpp"
#include "viewgain/core/error.hpp"

namespace viewgain {
namespace {

template <typename Value>
std::uint64_t apply(const Gray8Image& mask, int width, int height, std::vector<Value>& depth) {
  if (mask.width != width || mask.height != height || mask.pixels.size() != depth.size()) {
    throw Error(ErrorCode::invalid_argument, "a mask of " + std::to_string(mask.width) + " x " +
                                                 std::to_string(mask.height) +
                                                 " px for an image of " + std::to_string(width) +
                                                 " x " + std::to_string(height) + " px");
  }
  std::uint64_t removed = 0;
  for (std::size_t i = 0; i < depth.size(); ++i) {
    if (mask.pixels[i] == 0) continue;
    removed += depth[i] != Value{0} ? 1 : 0;
    depth[i] = Value{0};
  }
  return removed;
}

}  // namespace

MaskFolder::MaskFolder(std::filesystem::path folder, std::optional<std::uint8_t> least_confidence)
    : folder_(std::move(folder)), least_confidence_(least_confidence) {
  std::error_code ignored;
  if (!std::filesystem::is_directory(folder_, ignored)) {
    throw Error(ErrorCode::io, folder_.string() + ": no such folder");
  }
}

void MaskFolder::require_mask_of_any(const std::vector<std::filesystem::path>& images) const {
  if (std::any_of(images.begin(), images.end(),
                  [this](const auto& image) { return is_there(file_of(image)); })) {
    return;
  }
  throw Error(ErrorCode::invalid_argument,
              folder_.string() + ": has no image of the name of a depth image" +
                  (images.empty() ? "" : ", as " + images.front().filename().string()));
}

std::filesystem::path MaskFolder::file_of(const std::filesystem::path& image) const {
  return folder_ / image.filename();
}

std::optional<Gray8Image> MaskFolder::mask_of(const std::filesystem::path& image, int width,
                                              int height) const {
  const std::filesystem::path file = file_of(image);
  if (!is_there(file)) return std::nullopt;
  Gray8Image mask = read_gray8_png(file, width, height);
  if (least_confidence_) {
    for (std::uint8_t& pixel : mask.pixels) pixel = pixel < *least_confidence_ ? 1 : 0;
  }
  return mask;
}

std::uint64_t apply_mask(const Gray8Image& mask, GrayImage& depth) {
  return apply(mask, depth.width, depth.height, depth.pixels);
}

std::uint64_t apply_mask(const Gray8Image& mask, DepthFrame& frame) {
  static_assert(DepthFrame::kInvalid == 0.0F);
  return apply(mask, frame.width, frame.height, frame.depth);
}

}  // namespace viewgain
