// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <set>
#include <string>

#include "viewgain/core/export.hpp"

namespace viewgain {

/// Where the data of a map came from. A value type.
struct VIEWGAIN_EXPORT MapNotes {
  /// The sensor of all readings, as text from sensor_toml(). map_sensor() of viewgain::formats
  /// reads it. Empty if there are several sensors, or the sensor is unknown.
  std::string sensor{};
  /// DepthFrame::identity of the frames in the map.
  std::set<std::string> frames{};
  /// Notes of other programs, by name.
  std::map<std::string, std::string> others{};
  bool operator==(const MapNotes&) const = default;
};

}  // namespace viewgain
