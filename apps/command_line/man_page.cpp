// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include "man_page.hpp"

#include <algorithm>
#include <cctype>
#include <sstream>
#include <vector>

#include "viewgain/version.hpp"
#include "words.hpp"

namespace viewgain::app {
namespace {

// Text that roff shows as it is.
std::string escaped(const std::string& text) {
  std::string roff;
  for (const char c : text) {
    const bool begins_a_line = roff.empty() || roff.back() == '\n';
    if (begins_a_line && (c == '.' || c == '\'')) roff += "\\&";
    switch (c) {
      case '\\':
        roff += "\\e";
        break;
      case '-':
        roff += "\\-";
        break;
      case '^':
        roff += "\\(ha";
        break;
      case '~':
        roff += "\\(ti";
        break;
      default:
        roff += c;
    }
  }
  return roff;
}

std::string bold(const std::string& text) { return "\\fB" + escaped(text) + "\\fR"; }
std::string italic(const std::string& text) { return "\\fI" + escaped(text) + "\\fR"; }

std::string heading(const std::string& page) {
  std::string title = page;
  for (char& c : title) c = static_cast<char>(std::toupper(static_cast<unsigned char>(c)));
  return ".TH " + escaped(title) + " 1 \"\" \"viewgain " VIEWGAIN_VERSION "\" \"User Commands\"\n";
}

// The first sentence, or what is before a colon, as NAME has it.
std::string brief(const std::string& description) {
  std::string text = description.substr(0, description.find_first_of(":."));
  text[0] = static_cast<char>(std::tolower(static_cast<unsigned char>(text[0])));
  return text;
}

// Lines of a help's footer: those that are indented stand as they are.
std::string examples(const std::string& footer) {
  if (footer.empty()) return "";
  std::string roff = ".SH EXAMPLES\n.nf\n";
  std::istringstream lines(footer);
  for (std::string line; std::getline(lines, line);) {
    if (line.starts_with("  ")) roff += escaped(line.substr(2)) + "\n";
  }
  return roff + ".fi\n";
}

std::string exit_status() {
  return ".SH EXIT STATUS\n0, 2 for bad input (one line on stderr, nothing half\\-written), 1 for "
         "an internal error.\n";
}

std::string value_text(const CLI::Option& option) {
  const std::string type = option.get_type_name();
  const std::size_t begin = type.find('{');
  if (begin == std::string::npos) {
    if (type.starts_with("FLOAT")) return italic("NUMBER");
    return italic(type.starts_with("TEXT") ? "TEXT" : "N");
  }
  std::string choices = type.substr(begin + 1, type.find('}') - begin - 1);
  std::replace(choices.begin(), choices.end(), ',', '|');
  return bold(choices);
}

std::string option_text(const CLI::Option& option) {
  std::string roff = ".TP\n" + (option.nonpositional() ? bold : italic)(flag_of(option));
  if (option.nonpositional() && !is_bare(option)) roff += " " + value_text(option);
  if (option.get_required() && option.nonpositional()) roff += " (needed)";
  roff += "\n" + escaped(option.get_description());
  if (!option.get_default_str().empty() && !is_bare(option)) {
    roff += " (default: " + escaped(option.get_default_str()) + ")";
  }
  return roff + "\n";
}

std::string options_text(const CLI::App& subcommand) {
  std::string roff;
  for (const bool positional : {true, false}) {
    for (const CLI::Option* option : subcommand.get_options()) {
      const bool is_of_group = subcommand.get_name().empty() && option == subcommand.get_help_ptr();
      if (option->nonpositional() != positional && !is_of_group) roff += option_text(*option);
    }
  }
  for (const CLI::App* group : subcommand.get_subcommands({})) {
    if (!group->get_name().empty()) continue;
    roff += ".SS " + escaped(group->get_group() + ", " + group->get_description()) + "\n";
    roff += options_text(*group);
  }
  return roff;
}

}  // namespace

std::string man_page(const CLI::App& program) {
  std::string roff =
      heading("viewgain") + ".SH NAME\nviewgain \\- scores camera poses by expected " +
      "information gain\n.SH SYNOPSIS\n" + bold("viewgain") + " " + italic("SUBCOMMAND") + " [" +
      italic("OPTIONS") + "]\n.SH DESCRIPTION\n" + escaped(program.get_description()) + "\n";
  std::string group;
  std::string also;
  for (const CLI::App* subcommand : program.get_subcommands({})) {
    if (subcommand->get_group().empty()) continue;
    if (subcommand->get_group() != group) {
      group = subcommand->get_group();
      roff += ".SS " + escaped(group) + "\n";
    }
    const std::string page = "viewgain-" + subcommand->get_name();
    roff += ".TP\n" + bold(subcommand->get_name()) + "\n" + escaped(subcommand->get_description()) +
            "\n";
    also += (also.empty() ? "" : ",\n") + bold(page) + "(1)";
  }
  return roff + examples(program.get_footer()) + exit_status() + ".SH SEE ALSO\n" + also + "\n";
}

std::string subcommand_man_page(const CLI::App& subcommand) {
  const std::string& name = subcommand.get_name();
  std::string roff = heading("viewgain-" + name) + ".SH NAME\n" + escaped("viewgain-" + name) +
                     " \\- " + escaped(brief(subcommand.get_description())) + "\n.SH SYNOPSIS\n" +
                     bold("viewgain " + name) + " [" + italic("OPTIONS") + "]";
  for (const CLI::Option* option : subcommand.get_options()) {
    if (option->nonpositional()) continue;
    const std::string shown = italic(flag_of(*option));
    roff += option->get_required() ? " " + shown : " [" + shown + "]";
  }
  return roff + "\n.SH DESCRIPTION\n" + escaped(subcommand.get_description()) + "\n.SH OPTIONS\n" +
         options_text(subcommand) + examples(subcommand.get_footer()) + exit_status() +
         ".SH SEE ALSO\n" + bold("viewgain") + "(1)\n";
}

}  // namespace viewgain::app
