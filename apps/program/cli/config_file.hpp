// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <istream>
#include <string>
#include <vector>

#include "program/cli/app.hpp"
#include "viewgain/support/json.hpp"

namespace viewgain::app {

/// Reads a subcommand's flags from a TOML file: keys are the flags without --, and
/// the positionals in small letters with - for _ (MESH is `mesh`, FRAMES_DIR `frames-dir`). Numbers
/// are numbers, switches and flags without a value true or false, options that may be repeated
/// lists; numbers and names with commas may be lists, too. Paths are as on the command line,
/// relative to where the program runs. An option on the command
/// line replaces all of the file's values for it.
class FlagFile : public CLI::Config {
 public:
  explicit FlagFile(const App& program) : program_(program) {}

  /// Of --config, for the subcommand that was called. Throws Error(format), naming file and line,
  /// for an unknown key, with the nearest, and a value of the wrong type.
  std::vector<CLI::ConfigItem> from_config(std::istream& in) const override;
  /// Of the subcommand that was called; config_text().
  std::string to_config(const App* app, bool with_defaults, bool with_descriptions,
                        std::string prefix) const override;

 private:
  const App& program_;
};

/// What a parsed subcommand was given, for --config, and as comments the defaults of the rest.
/// Without the keys `left_out`, config and save-config. A value that is no UTF-8, which TOML cannot
/// hold, becomes a comment.
[[nodiscard]] std::string config_text(const App& subcommand,
                                      const std::vector<std::string>& left_out = {});

/// The same keys of a parsed subcommand with their values as JSON: what was given, else the
/// default, null without one. Where a value names a regular file, `files` has its path and a hash
/// over its bytes. Throws Error(io) if such a file cannot be read.
struct CallSettings {
  Json flags = Json::object();
  Json files = Json::object();
};
[[nodiscard]] CallSettings call_settings(const App& subcommand,
                                         const std::vector<std::string>& left_out);

}  // namespace viewgain::app
