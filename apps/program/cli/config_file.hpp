// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "program/cli/app.hpp"
#include "program/cli/json.hpp"

namespace viewgain::app {

// A TOML file says of a subcommand what its command line would: keys are the flags without --, and
// the positionals in small letters with - for _ (MESH is `mesh`, FRAMES_DIR `frames-dir`). Numbers
// are numbers, switches and flags without a value true or false, options that may be repeated
// lists; numbers and names with commas may be lists, too. Paths are as on the command line,
// relative to where the program runs.

/// The form that is for the source among the words after the subcommand, or for that in the file of
/// --config; else the first. The second is for folders. Throws Error as with_config().
[[nodiscard]] App& form_of(const Forms& forms, const std::vector<std::string>& words);

/// The words after the subcommand with those that its --config stands for. What the command line
/// says holds: an option, all repetitions of one, or one of a group of which only one may be given.
/// Throws Error: as sort_words() and read_toml(), and Error(format), naming file and line, for an
/// unknown key, with the nearest, and a value of the wrong type.
[[nodiscard]] std::vector<std::string> with_config(const App& subcommand, const Forms& forms,
                                                   const std::vector<std::string>& words);

/// What a parsed subcommand was given, as with_config() reads it back, and as comments the defaults
/// of the rest. Without the keys `left_out`, config and save-config. A value that is no UTF-8,
/// which TOML cannot hold, becomes a comment.
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
