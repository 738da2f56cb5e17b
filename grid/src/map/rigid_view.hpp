// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "viewgain/core/pose.hpp"

namespace viewgain::detail {

/// A camera's pose as a map takes it, rigid_pose(). Throws Error(invalid_argument) if there is
/// none.
[[nodiscard]] Pose rigid_view(const Pose& T_world_camera);

}  // namespace viewgain::detail
