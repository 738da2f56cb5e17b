// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "viewgain/core/pose.hpp"

namespace viewgain::detail {

/// A camera's pose as a map keeps it: orthonormalised if it is off by less than 1e-3. Throws
/// Error(invalid_argument) if it is off by more or not finite.
[[nodiscard]] Pose rigid_view(const Pose& T_world_camera);

}  // namespace viewgain::detail
