// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <toml++/toml.h>

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "viewgain/core/export.hpp"
#include "viewgain/support/toml_text.hpp"

namespace viewgain {

/// The largest TOML file that is read [bytes].
inline constexpr std::uint64_t kMostTomlBytes = std::uint64_t{1} << 24U;

/// Throws Error(io) if the file cannot be read, Error(format) with the line if it is not TOML.
[[nodiscard]] VIEWGAIN_EXPORT toml::table read_toml(const std::filesystem::path& path);
/// As above for a text; `name` is its name in messages.
[[nodiscard]] VIEWGAIN_EXPORT toml::table parse_toml(std::string_view text,
                                                     const std::string& name);

/// One table of a TOML file. Remembers which keys were read, so that the others can be refused.
/// Must not outlive the table. Throws Error(format) that names the file, the key and its line.
class VIEWGAIN_EXPORT TableReader {
 public:
  TableReader(const toml::table& table, std::string file, std::string prefix);

  [[noreturn]] void fail(std::string_view key, const std::string& what) const;

  /// Null if the key is missing.
  const toml::node* find(std::string_view key);
  const toml::node& require(std::string_view key);

  double number(std::string_view key);
  [[nodiscard]] double number_of(const toml::node& node, std::string_view key) const;
  int whole_number(std::string_view key);
  /// Refuses a newer format. Without the key the format is 1.
  void check_format();
  std::string text(std::string_view key);
  std::vector<double> numbers(std::string_view key, std::size_t count);
  [[nodiscard]] std::vector<double> numbers(std::string_view key, const toml::node& node,
                                            std::size_t count) const;
  TableReader table(std::string_view key);
  /// The elements of a list of tables; none if the key is missing.
  std::vector<TableReader> tables(std::string_view key);

  /// Throws for a key that was not read, and names the nearest known key.
  void refuse_unknown_keys() const;

 private:
  const toml::table& table_;
  std::string file_;
  std::string prefix_;
  std::vector<std::string> known_;
};

}  // namespace viewgain
