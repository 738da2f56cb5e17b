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
  /// The sensor of all readings, as written by sensor_toml(); map_sensor() of viewgain::formats
  /// reads it. Empty: several sensors, or an unknown one.
  std::string sensor{};
  /// DepthFrame::identity of each frame in the map that has one.
  std::set<std::string> frames{};
  /// Notes of other programs, by name.
  std::map<std::string, std::string> others{};
  bool operator==(const MapNotes&) const = default;
};

}  // namespace viewgain
