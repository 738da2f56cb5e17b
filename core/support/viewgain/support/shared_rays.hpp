// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <memory>
#include <vector>

#include "viewgain/core/camera.hpp"
#include "viewgain/core/export.hpp"

namespace viewgain {

/// The camera's ray_table(), shared by all who hold one of an equal camera. A table is freed with
/// its last holder. Any thread may call it; a call during another one makes a table of its own
/// instead of waiting.
[[nodiscard]] VIEWGAIN_EXPORT std::shared_ptr<const std::vector<Eigen::Vector3d>> shared_rays(
    const PinholeCamera& camera);

}  // namespace viewgain
