// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <memory>
#include <vector>

#include "viewgain/core/camera.hpp"
#include "viewgain/core/export.hpp"

namespace viewgain {

/// Returns the camera's ray_table(). Calls with equal cameras share one table as long as somebody
/// holds it. Thread safety: may run from many threads. Does not wait: calls at the same time may
/// each make a table.
[[nodiscard]] VIEWGAIN_EXPORT std::shared_ptr<const std::vector<Eigen::Vector3d>> shared_rays(
    const PinholeCamera& camera);

}  // namespace viewgain
