// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "view_driver.hpp"

namespace viewgain::detail {

/// As ViewDriver::evaluate(), the same bits, with all threads at one view.
[[nodiscard]] ViewGain evaluate_together(const ViewDriver& driver, const Pose& T_world_camera);

}  // namespace viewgain::detail
