// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "viewgain/core/export.hpp"
#include "viewgain/core/sensor.hpp"

/// @file
/// Files of sensors. Cost: they are read or written once; a table of the range error takes
/// O(entries).

namespace viewgain {

/// Reads what sensor_toml() of core/sensor.hpp writes. Throws Error(io) if the file cannot be read
/// and Error(format), naming the file and the key, for a key that is missing, unknown, of the wrong
/// type or out of bounds.
[[nodiscard]] VIEWGAIN_EXPORT Sensor read_sensor_toml(const std::filesystem::path& path);

/// The same of a text; `name` is what errors call it.
[[nodiscard]] VIEWGAIN_EXPORT Sensor parse_sensor_toml(std::string_view text,
                                                       const std::string& name);

/// Writes sensor_toml(). Atomic. Throws Error(io), and Error(invalid_argument) if the sensor is not
/// valid.
VIEWGAIN_EXPORT void write_sensor_toml(const std::filesystem::path& path, const Sensor& sensor);

/// Whether load_sensor takes this for a file's name and not for a preset's. Never throws.
[[nodiscard]] VIEWGAIN_EXPORT bool is_sensor_file(const std::string& preset_or_file);

/// A preset by its name, or a file that ends in .toml. Throws Error(invalid_argument) for a name
/// that is none, and as read_sensor_toml().
[[nodiscard]] VIEWGAIN_EXPORT Sensor load_sensor(const std::string& preset_or_file);

}  // namespace viewgain
