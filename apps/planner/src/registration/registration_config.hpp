// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "viewgain/planner/map_model.hpp"
#include "viewgain/planner/register_frame.hpp"

namespace viewgain::detail {

/// Of frames that go into such a map.
[[nodiscard]] inline RegistrationConfig registration_config(const MapModelConfig& map) {
  RegistrationConfig config;
  config.support_plane = map.integration.support_plane;
  return config;
}

}  // namespace viewgain::detail
