// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>

#include "viewgain/formats/cloud_io.hpp"

namespace viewgain::detail {

/// The contents of a file; `name` is the file's, for messages. They throw Error(format).
[[nodiscard]] PointCloud parse_pcd(std::string_view bytes, const std::string& name);
[[nodiscard]] PointCloud parse_ply(std::string_view bytes, const std::string& name);

}  // namespace viewgain::detail
