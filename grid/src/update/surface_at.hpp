// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <optional>

#include "readings.hpp"

namespace viewgain::detail {

/// The reading put along the normal onto the surface that the pixels around say [m]: the plane, by
/// least squares of depth over the image, through the readings of 5×5 pixels whose depth differs
/// from the pixel's by no more than a slope of 2 and noise explain. Nothing where fewer than 6 are
/// left, they are in one line, the plane is seen at under kMinCosIncidence, or the reading is over
/// 3 sigma off it, and so of something else. Nothing for clouds, whose points have no neighbours.
/// `pixel` must be a reading.
[[nodiscard]] std::optional<Eigen::Vector3d> surface_at(const Readings& readings,
                                                        std::size_t pixel);

}  // namespace viewgain::detail
