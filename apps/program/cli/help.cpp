// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include "program/cli/help.hpp"

#include <algorithm>
#include <sstream>
#include <string_view>

namespace viewgain::app {
namespace {

constexpr std::size_t kColumns = 80;
constexpr const char* kMostNeed = "Options";

// The text in lines: the first after `head`, the others indented.
std::string wrapped(std::string head, const std::string& text, std::size_t indent) {
  std::istringstream words(text);
  std::string lines, line = std::move(head);
  bool is_empty = true;  // whether the line has no word yet
  for (std::string word; words >> word;) {
    if (!is_empty && line.size() + 1 + word.size() > kColumns) {
      lines += line + "\n";
      line.assign(indent, ' ');
      is_empty = true;
    }
    line += (is_empty ? "" : " ") + word;
    is_empty = false;
  }
  return lines + line + "\n";
}

// "{paper,surface}" may be broken after a comma.
std::string breakable(std::string type, std::size_t begin) {
  if (begin + type.size() <= kColumns) return type;
  for (std::size_t at = type.find(','); at != std::string::npos; at = type.find(',', at + 2)) {
    type.insert(at + 1, " ");
  }
  return type;
}

std::string text_of(const Option& option) {
  std::string head = "  " + option.get_name(!option.nonpositional());
  if (!is_bare(option) && option.nonpositional()) {
    head += " " + option.get_type_name();
    if (!option.get_default_str().empty()) head += " [" + option.get_default_str() + "]";
    if (option.get_required()) head += " REQUIRED";
  }
  return wrapped("  ", breakable(head.substr(2), 2), 4) +
         wrapped(std::string(6, ' '), option.get_description(), 6);
}

std::string text_of(const std::string& head, const std::vector<const Option*>& options) {
  std::string text = "\n" + head + ":\n";
  for (const Option* option : options) text += text_of(*option);
  return text;
}

// The headings in the order of their first options; those that most calls need come first.
std::vector<std::string> heads_of(const std::vector<const Option*>& options) {
  std::vector<std::string> heads{kMostNeed};
  for (const Option* option : options) {
    if (std::find(heads.begin(), heads.end(), option->get_group()) == heads.end()) {
      heads.push_back(option->get_group());
    }
  }
  return heads;
}

// Breaks long calls with a backslash, as in a shell.
std::string continued(const std::string& calls) {
  std::istringstream lines(calls);
  std::string text;
  for (std::string line; std::getline(lines, line);) {
    while (line.size() > kColumns) {
      const std::size_t at = line.rfind(' ', kColumns - 2);
      text += line.substr(0, at) + " \\\n";
      line = "    " + line.substr(at + 1);
    }
    text += line + "\n";
  }
  return text;
}

std::string subcommands_of(const App& program) {
  std::string text, last;
  for (const App* subcommand : program.get_subcommands(nullptr)) {
    if (subcommand->get_group() != last) text += "\n" + subcommand->get_group() + ":\n";
    last = subcommand->get_group();
    std::string head = "  " + subcommand->get_name();
    head.resize(16, ' ');
    text += wrapped(head, subcommand->get_description(), 16);
  }
  return text;
}

}  // namespace

void begin_group(App& app, const char* head) { app.option_defaults()->group(head); }

void explain_values(App& app, const std::string& text) {
  app.footer(app.get_footer() + text + "\n");
}

std::string explain_values_in(const char* home, App& app, const std::string& text) {
  if (app.get_name() != home) return "see viewgain " + std::string(home) + " --help";
  explain_values(app, text);
  return "see below";
}

void most_need(App& app, const std::vector<const char*>& names) {
  for (const char* name : names) app.get_option(name)->group(kMostNeed);
}

std::string HelpFormatter::make_help(const App* app, std::string, CLI::AppFormatMode mode) const {
  const bool is_program = app->get_parent() == nullptr;
  const bool shows_all = is_program || mode == CLI::AppFormatMode::All;
  std::vector<const Option*> positionals, flags;
  for (const Option* option : all_options(*app)) {
    if (option == app->get_help_ptr() || option == app->get_help_all_ptr()) {
      if (is_program) flags.push_back(option);
      continue;
    }
    (option->nonpositional() ? flags : positionals).push_back(option);
  }
  std::string usage = app->get_name();
  if (!is_program) usage = app->get_parent()->get_name() + " " + usage;
  std::string text = wrapped("", app->get_description(), 0) + "\nUsage: " + usage;
  for (const Option* option : positionals) {
    text += option->get_required() ? " " + option->get_name() : " [" + option->get_name() + "]";
  }
  text += is_program ? " SUBCOMMAND [OPTIONS]\n" : " [OPTIONS]\n";
  if (is_program) text += subcommands_of(*app);
  if (!positionals.empty()) text += text_of("Positionals", positionals);
  for (const std::string& head : heads_of(flags)) {
    std::vector<const Option*> group;
    std::copy_if(flags.begin(), flags.end(), std::back_inserter(group),
                 [&](const Option* option) { return option->get_group() == head; });
    if (!group.empty() && (shows_all || head == kMostNeed)) text += text_of(head, group);
  }
  if (!is_program) {
    text += shows_all ? "\nviewgain --help lists the global options.\n"
                      : "\nMore options: viewgain " + app->get_name() + " --help\n";
  }
  const std::string footer = app->get_footer();
  return text + "\n" + continued(shows_all ? footer : footer.substr(footer.find("Example")));
}

}  // namespace viewgain::app
