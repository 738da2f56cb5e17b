// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "viewgain/core/export.hpp"

namespace viewgain {

/// A value of a flat TOML file.
struct SettingValue {
  enum class Kind : std::uint8_t { text, whole_number, number, boolean, list };
  Kind kind = Kind::text;
  std::string text;  ///< of a list: its elements' with commas
  std::vector<SettingValue> elements{};
};

struct Setting {
  std::string key;
  std::uint32_t line = 0;
  SettingValue value;
};

/// The settings of a TOML file, for the program's --config. Throws Error(io) if the file cannot be
/// read, and Error(format), naming file and line, for what is no TOML, a key that is none of these
/// (with the nearest), a table or a date.
[[nodiscard]] VIEWGAIN_EXPORT std::vector<Setting> read_settings_toml(
    const std::filesystem::path& path, const std::vector<std::string>& keys);

/// Throws Error(format): "FILE: line N: key "KEY" WHAT".
[[noreturn]] VIEWGAIN_EXPORT void refuse_setting(const std::filesystem::path& path,
                                                 const Setting& setting, const std::string& what);

/// `key = value` as read_settings_toml() reads it back. The text of a value that is no text must be
/// what TOML has for it.
[[nodiscard]] VIEWGAIN_EXPORT std::string setting_line(const std::string& key,
                                                       const SettingValue& value);

}  // namespace viewgain
