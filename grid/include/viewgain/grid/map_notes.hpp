// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <set>
#include <string>

#include "viewgain/core/export.hpp"

namespace viewgain {

/// Where a map comes from. A value type.
struct VIEWGAIN_EXPORT MapNotes {
  /// The one sensor that all readings come from, as sensor_toml() writes it. Empty: several
  /// sensors, or an unknown one. map_sensor() of viewgain::formats reads it.
  std::string sensor{};
  /// The DepthFrame::identity of each frame in the map; frames without one are not listed.
  std::set<std::string> frames{};
  /// Notes of programs, by name.
  std::map<std::string, std::string> others{};
  bool operator==(const MapNotes&) const = default;
};

}  // namespace viewgain
