// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace viewgain::app {

/// The distances of a wall [m], one a depth image: of the text file's line i for image i, or of the
/// line that begins with its name, with or without .depth.png; nothing for those that a file with
/// names leaves out. Lines that begin with # do not count. Throws Error(io), and Error(format),
/// naming file and line, for another number of lines, names that are none or twice there, and
/// distances that are not positive.
[[nodiscard]] std::vector<std::optional<double>> read_wall_distances(
    const std::string& path, const std::vector<std::filesystem::path>& images);

}  // namespace viewgain::app
