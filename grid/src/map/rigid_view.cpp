// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include "rigid_view.hpp"

#include <locale>
#include <sstream>

#include "viewgain/core/error.hpp"

namespace viewgain::detail {

Pose rigid_view(const Pose& T_world_camera) {
  constexpr double kTolerance = 1e-3;
  constexpr double kOrthonormal = 1e-12;  // rotations nearer to orthonormal are taken as they are
  const double error = orthonormality_error(T_world_camera);
  if (!(error <= kTolerance)) {
    std::ostringstream text;
    text.imbue(std::locale::classic());
    text << "camera pose is not rigid: its rotation is off by " << error;
    throw Error(ErrorCode::invalid_argument, text.str());
  }
  return error <= kOrthonormal ? T_world_camera : orthonormalized(T_world_camera);
}

}  // namespace viewgain::detail
