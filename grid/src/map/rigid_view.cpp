// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include "rigid_view.hpp"

#include <optional>
#include <string>

#include "viewgain/core/error.hpp"
#include "viewgain/support/text.hpp"

namespace viewgain::detail {

Pose rigid_view(const Pose& T_world_camera) {
  const std::optional<Pose> rigid = rigid_pose(T_world_camera);
  if (!rigid) {
    throw Error(ErrorCode::invalid_argument, "camera pose is not rigid: its rotation is off by " +
                                                 short_text(orthonormality_error(T_world_camera)));
  }
  return *rigid;
}

}  // namespace viewgain::detail
