// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "viewgain/formats/frames.hpp"

namespace viewgain {

/// open_frames() without images and poses: what holds for all of a folder's frames.
[[nodiscard]] FrameSequence open_frame_folder(const std::filesystem::path& dir,
                                              const std::string& sensor,
                                              std::optional<double> depth_scale);

}  // namespace viewgain
