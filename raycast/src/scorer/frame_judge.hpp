// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "viewgain/core/frame_verdict.hpp"
#include "viewgain/core/planning.hpp"
#include "viewgain/core/sensor.hpp"

namespace viewgain::detail {

/// Faults of measurements that show without a map: lost_pose, wrong_size, not_metres; otherwise
/// `used`. Throws Error(invalid_argument) for a sigma that is negative or not finite, and for an
/// invalid identity. Cost: a pass over the pixels.
[[nodiscard]] FrameVerdict judged(const Measurements& measurements, const Sensor& sensor);

}  // namespace viewgain::detail
