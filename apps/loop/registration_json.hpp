// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <nlohmann/json.hpp>
#include <numbers>
#include <string>

#include "options/json_text.hpp"
#include "viewgain/planner/register_frame.hpp"

namespace viewgain::app {

/// The keys of `registration` in run.json.
[[nodiscard]] inline nlohmann::ordered_json to_json(const FrameRegistration& registration) {
  return {{"status", registration_status_name(registration.status)},
          {"reason", registration.reason},
          {"pose", to_json(registration.T_world_camera)},
          {"translation", registration.translation},
          {"rotation", registration.rotation * 180 / std::numbers::pi},
          {"residual_before", registration.residual_before},
          {"residual_after", registration.residual_after},
          {"overlap", registration.overlap},
          {"contradiction", registration.contradiction},
          {"smallest_information", registration.smallest_information},
          {"free_directions", registration.free_directions.size()}};
}

}  // namespace viewgain::app
