// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <algorithm>
#include <numbers>
#include <string>
#include <vector>

#include "program/cli/json.hpp"
#include "viewgain/planner/register_frame.hpp"

namespace viewgain::app {

/// The keys of `registration` in run.json.
[[nodiscard]] inline Json to_json(const FrameRegistration& registration) {
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

/// How many came to what.
[[nodiscard]] inline Json registration_counts(const std::vector<FrameRegistration>& registrations) {
  Json json;
  for (const auto status : {RegistrationStatus::registered, RegistrationStatus::too_little_overlap,
                            RegistrationStatus::refused}) {
    json[registration_status_name(status)] =
        std::count_if(registrations.begin(), registrations.end(),
                      [&](const FrameRegistration& r) { return r.status == status; });
  }
  return json;
}

/// registration_counts() for people.
[[nodiscard]] inline std::string registration_text(const Json& counts) {
  return "registration: " + counts["registered"].dump() + " registered, " +
         counts["too_little_overlap"].dump() + " too_little_overlap, " + counts["refused"].dump() +
         " refused";
}

}  // namespace viewgain::app
