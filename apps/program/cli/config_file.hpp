// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <istream>
#include <string>
#include <vector>

#include "program/cli/app.hpp"
#include "viewgain/support/json.hpp"

namespace viewgain::app {

/// Reads a subcommand's flags from a TOML file. Keys are the flags without --, and the positionals
/// in lower case with - for _ (MESH is `mesh`, FRAMES_DIR is `frames-dir`). Numbers are TOML
/// numbers, switches and flags without a value are true or false, and options that may be repeated
/// are lists. Values with commas may also be lists. Paths are relative to the current folder, as on
/// the command line. An option on the command line replaces all of the file's values for it.
class FlagFile : public CLI::Config {
 public:
  explicit FlagFile(const App& program) : program_(program) {}

  /// Reads the file of --config for the called subcommand. Throws Error(format), naming file and
  /// line, for an unknown key (and names the nearest one) and for a value of the wrong type.
  std::vector<CLI::ConfigItem> from_config(std::istream& in) const override;
  /// config_text() of the called subcommand.
  std::string to_config(const App* app, bool with_defaults, bool with_descriptions,
                        std::string prefix) const override;

 private:
  const App& program_;
};

/// The given values of a parsed subcommand, for --config, and as comments the defaults of the
/// others. Omits the keys `left_out`, config and save-config. A value that is not UTF-8, which TOML
/// does not allow, becomes a comment.
[[nodiscard]] std::string config_text(const App& subcommand,
                                      const std::vector<std::string>& left_out = {});

/// The same keys with their values as JSON: the given value, else the default, else null. For
/// values that name regular files, `files` has the path and a hash of the bytes. Throws Error(io)
/// if such a file cannot be read.
struct CallSettings {
  Json flags = Json::object();
  Json files = Json::object();
};
[[nodiscard]] CallSettings call_settings(const App& subcommand,
                                         const std::vector<std::string>& left_out);

}  // namespace viewgain::app
