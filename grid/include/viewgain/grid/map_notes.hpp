// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <set>
#include <string>

#include "viewgain/core/export.hpp"

namespace viewgain {

/// What a map knows of its origin, beside its contents. A value type.
struct VIEWGAIN_EXPORT MapNotes {
  /// That all readings come from, as sensor_toml() describes it; empty: of several sensors, or not
  /// known. map_sensor() of viewgain::formats reads it.
  std::string sensor{};
  /// The frames that went into it, each by its DepthFrame::identity; those without are not here.
  std::set<std::string> frames{};
  /// Texts of programs by name.
  std::map<std::string, std::string> others{};
  bool operator==(const MapNotes&) const = default;
};

}  // namespace viewgain
