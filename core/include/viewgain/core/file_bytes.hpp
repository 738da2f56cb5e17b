// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>

#include "viewgain/core/export.hpp"

namespace viewgain {

/// All bytes of a file, pipes included. Throws Error(io) that names it if it cannot be opened or a
/// read fails. Thread safe.
[[nodiscard]] VIEWGAIN_EXPORT std::string file_bytes(const std::filesystem::path& path);

}  // namespace viewgain
