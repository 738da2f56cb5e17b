// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "view_driver.hpp"

namespace viewgain::detail {

/// What a measure of the user's own says of a view: NaN for a bad pose, 0 for a camera in an
/// occupied voxel, of which it is not asked. Throws what the measure throws.
[[nodiscard]] double measured(const ViewDriver& driver, const Pose& T_world_camera,
                              ViewDriver::Lease& lease, const ViewMeasure& measure);
[[nodiscard]] double measured(const ViewDriver& driver, const Pose& T_world_camera,
                              ViewDriver::Lease& lease, const RunMeasure& measure);

}  // namespace viewgain::detail
