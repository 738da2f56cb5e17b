// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "viewgain/core/export.hpp"
#include "viewgain/core/sensor.hpp"

/// @file
/// Sensor files. Each call reads or writes the file once. Cost: O(entries) of the table of range
/// errors.

namespace viewgain {

/// Reads a file in the format of sensor_toml() (core/sensor.hpp). Throws Error(io) if the file
/// cannot be read and Error(format) with file and key for a key that is missing, unknown, of the
/// wrong type or out of bounds.
[[nodiscard]] VIEWGAIN_EXPORT Sensor read_sensor_toml(const std::filesystem::path& path);

/// As above for a text; `name` is the file name in messages.
[[nodiscard]] VIEWGAIN_EXPORT Sensor parse_sensor_toml(std::string_view text,
                                                       const std::string& name);

/// Writes sensor_toml(). Atomic. Throws Error(io), and Error(invalid_argument) if the sensor is
/// invalid.
VIEWGAIN_EXPORT void write_sensor_toml(const std::filesystem::path& path, const Sensor& sensor);

/// Whether load_sensor() treats the argument as a file name rather than a preset. Never throws.
[[nodiscard]] VIEWGAIN_EXPORT bool is_sensor_file(const std::string& preset_or_file);

/// A preset by name, or the sensor in a file whose name ends in .toml. Throws
/// Error(invalid_argument) for an unknown name. Also throws whatever read_sensor_toml() throws.
[[nodiscard]] VIEWGAIN_EXPORT Sensor load_sensor(const std::string& preset_or_file);

}  // namespace viewgain
