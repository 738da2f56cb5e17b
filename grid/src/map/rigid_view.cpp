// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include "rigid_view.hpp"

#include <string>

#include "viewgain/core/error.hpp"
#include "viewgain/support/text.hpp"

namespace viewgain::detail {

Pose rigid_view(const Pose& T_world_camera) {
  constexpr double kTolerance = 1e-3;
  constexpr double kOrthonormal = 1e-12;  // rotations nearer to orthonormal are taken as they are
  const double error = orthonormality_error(T_world_camera);
  if (!(error <= kTolerance)) {
    throw Error(ErrorCode::invalid_argument,
                "camera pose is not rigid: its rotation is off by " + short_text(error));
  }
  return error <= kOrthonormal ? T_world_camera : orthonormalized(T_world_camera);
}

}  // namespace viewgain::detail
