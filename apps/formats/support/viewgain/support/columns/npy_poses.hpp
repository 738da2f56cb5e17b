// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

#include "viewgain/core/export.hpp"
#include "viewgain/core/pose_io.hpp"

namespace viewgain {

/// Poses of a .npy file: rows with kPoseColumns ("<f8", others are passed over), or matrices
/// (n, 4, 4). Mended as read_tum() and read_pose_matrix() do; there are no timestamps. Throws
/// Error(io), or Error(format) that names the file and, of a pose, the row.
[[nodiscard]] VIEWGAIN_EXPORT PoseList read_npy_poses(const std::filesystem::path& path);

}  // namespace viewgain
