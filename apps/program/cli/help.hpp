// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "program/cli/app.hpp"

namespace viewgain::app {

/// Help lists options added after this call under this heading.
void begin_group(App& app, const char* head);

/// Puts these options, at most ten that most calls need, into the group that -h shows.
void most_need(App& app, const std::vector<const char*>& names);

/// --help ends with this text about the values of an option, before the examples. Its lines have at
/// most 80 columns.
void explain_values(App& app, const std::string& text);
/// As above, but only in the help of the subcommand `home`. Returns "see below" or, for other
/// subcommands, a reference to that help.
std::string explain_values_in(const char* home, App& app, const std::string& text);

/// -h shows the positionals and most_need(), --help all options in their groups, both in lines of
/// at most 80 columns.
class HelpFormatter : public CLI::Formatter {
 public:
  std::string make_help(const App* app, std::string name, CLI::AppFormatMode mode) const override;
};

}  // namespace viewgain::app
