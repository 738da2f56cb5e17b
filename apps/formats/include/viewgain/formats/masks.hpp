// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <vector>

#include "viewgain/core/depth_frame.hpp"
#include "viewgain/core/export.hpp"
#include "viewgain/formats/png.hpp"

namespace viewgain {

/// A folder of masks, which say where depth images show what is no part of the scene, as the arm
/// that carries the camera. The mask of a depth image has the image's name and size; it is a
/// grayscale PNG of 1 to 8 bits. 0: the pixel counts; any other value: it says nothing. Or a folder
/// of confidences, images likewise, as many cameras give them: pixels under the least say nothing.
/// Thread safety: const members may run from many threads. Cost of mask_of(): a file is read,
/// O(pixels); of the others a look at the file system for each image.
class VIEWGAIN_EXPORT MaskFolder {
 public:
  /// With `least_confidence` the images are confidences. Throws Error(io), naming it, if there is
  /// no such folder.
  explicit MaskFolder(std::filesystem::path folder,
                      std::optional<std::uint8_t> least_confidence = {});

  /// Throws Error(invalid_argument), naming the folder, if none of the images, in any order, has a
  /// mask in it: it is another recording's.
  void require_mask_of_any(const std::vector<std::filesystem::path>& images) const;

  /// Where the mask of the depth image of this name is, or would be. Takes constant time; not
  /// checked is whether there is one.
  [[nodiscard]] std::filesystem::path file_of(const std::filesystem::path& image) const;

  /// The mask of the depth image of this name, made of the confidences where these are in the
  /// folder; nothing where the folder has none. Throws Error(io)
  /// or Error(format), naming the file, for one that cannot be used.
  [[nodiscard]] std::optional<Gray8Image> mask_of(const std::filesystem::path& image, int width,
                                                  int height) const;

 private:
  std::filesystem::path folder_;
  std::optional<std::uint8_t> least_confidence_;
};

/// Makes the pixels invalid (0) that the mask says; returns how many were not invalid before.
/// Throws Error(invalid_argument) if the sizes differ. Costs O(pixels).
VIEWGAIN_EXPORT std::uint64_t apply_mask(const Gray8Image& mask, GrayImage& depth);
/// The same of a frame: how many of the masked pixels had a depth.
VIEWGAIN_EXPORT std::uint64_t apply_mask(const Gray8Image& mask, DepthFrame& frame);

}  // namespace viewgain
