// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include "program/cli/help_files.hpp"

#include <algorithm>
#include <cctype>
#include <sstream>
#include <string>
#include <system_error>
#include <vector>

#include "program/cli/words.hpp"
#include "viewgain/core/sensor.hpp"
#include "viewgain/support/atomic_file.hpp"
#include "viewgain/version.hpp"

namespace viewgain::app {
namespace {

std::string joined(const std::vector<std::string>& words) {
  std::string text;
  for (const std::string& word : words) text.append(text.empty() ? "" : " ").append(word);
  return text;
}

std::vector<const App*> shown_subcommands(const App& program) {
  std::vector<const App*> shown = program.subcommands();
  std::erase_if(shown, [](const App* subcommand) { return subcommand->group_name().empty(); });
  return shown;
}

std::vector<std::string> values_of(const Option& option) {
  return option.name() == "--sensor" ? sensor_preset_names() : option.choices();
}

// The presets stand where sensors names one.
std::vector<std::string> positionals_of(const App& subcommand) {
  return subcommand.name() == "sensors" ? sensor_preset_names() : std::vector<std::string>();
}

// A text within single quotes of a shell.
std::string quoted(const std::string& text) {
  std::string shell;
  for (const char c : text) {
    if (c == '\'') {
      shell += "'\\''";
    } else {
      shell += c;
    }
  }
  return shell;
}

// What stands in the brackets of zsh's _arguments.
std::string bracketed(const std::string& text) {
  std::string zsh;
  for (const char c : quoted(text)) zsh.append(c == '[' || c == ']' ? "\\" : "").append(1, c);
  return zsh;
}

}  // namespace

std::string bash_completion(const App& program) {
  std::string names, cases;
  for (const App* subcommand : shown_subcommands(program)) {
    names += subcommand->name() + " ";
    std::vector<std::string> flags;
    std::string values;
    for (const Option* option : options_of_forms(*subcommand)) {
      if (!option->nonpositional()) continue;
      flags.push_back(option->name());
      if (option->is_bare()) continue;
      values.append("        ").append(flags.back()).append(") values='");
      values.append(joined(values_of(*option))).append("' flags= ;;\n");
    }
    cases.append("    ").append(subcommand->name()).append(")\n      flags='");
    cases.append(joined(flags)).append("' values='").append(joined(positionals_of(*subcommand)));
    cases.append("'\n      case $before in\n").append(values).append("      esac\n      ;;\n");
  }
  return R"(# bash completion for viewgain, made by viewgain itself
_viewgain() {
  local word=${COMP_WORDS[COMP_CWORD]} before=${COMP_WORDS[COMP_CWORD - 1]} flags= values=
  if [ "$word" = = ]; then
    word=
  elif [ "$before" = = ] && [ "$COMP_CWORD" -gt 2 ]; then
    before=${COMP_WORDS[COMP_CWORD - 2]}
  fi
  COMPREPLY=()
  if [ "$COMP_CWORD" -eq 1 ]; then
    COMPREPLY=($(compgen -W ')" +
         names + R"(--help --version' -- "$word"))
    return
  fi
  case ${COMP_WORDS[1]} in
)" + cases +
         R"(  esac
  if [[ $word == -* ]]; then
    COMPREPLY=($(compgen -W "$flags" -- "$word"))
  else
    COMPREPLY=($(compgen -W "$values" -- "$word"))
  fi
}
complete -o default -F _viewgain viewgain
)";
}

std::string zsh_completion(const App& program) {
  std::string names, cases;
  for (const App* subcommand : shown_subcommands(program)) {
    names += "    '" + subcommand->name() + ":" + quoted(subcommand->description()) + "'\n";
    cases += "    " + subcommand->name() + ")\n      _arguments \\\n";
    for (const Option* option : options_of_forms(*subcommand)) {
      if (!option->nonpositional()) continue;
      const std::string repeated = option->is_repeated() ? "*" : "";
      cases +=
          "        '" + repeated + option->name() + "[" + bracketed(option->description()) + "]";
      if (!option->is_bare()) {
        const std::string values = joined(values_of(*option));
        cases += ":value:" + (values.empty() ? "_files" : "(" + values + ")");
      }
      cases += "' \\\n";
    }
    const std::string values = joined(positionals_of(*subcommand));
    cases +=
        "        '*:file:" + (values.empty() ? "_files" : "(" + values + ")") + "'\n      ;;\n";
  }
  return "#compdef viewgain\n# zsh completion for viewgain, made by viewgain itself\n_viewgain() "
         "{\n"
         "  local -a subcommands\n  subcommands=(\n" +
         names +
         "  )\n  if (( CURRENT == 2 )); then\n    _describe subcommand subcommands\n    return\n  "
         "fi\n"
         "  case $words[2] in\n" +
         cases + "  esac\n}\n_viewgain \"$@\"\n";
}

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

std::string value_text(const Option& option) {
  const std::string type = option.type_name();
  const std::size_t begin = type.find('{');
  if (begin == std::string::npos) {
    if (type.starts_with("FLOAT")) return italic("NUMBER");
    return italic(type.starts_with("TEXT") ? "TEXT" : "N");
  }
  std::string choices = type.substr(begin + 1, type.find('}') - begin - 1);
  std::replace(choices.begin(), choices.end(), ',', '|');
  return bold(choices);
}

std::string option_text(const Option& option) {
  std::string roff = ".TP\n" + (option.nonpositional() ? bold : italic)(option.name());
  if (option.nonpositional() && !option.is_bare()) roff += " " + value_text(option);
  if (option.is_required() && option.nonpositional()) roff += " (needed)";
  roff += "\n" + escaped(option.description());
  if (!option.default_text().empty() && !option.is_bare()) {
    roff += " (default: " + escaped(option.default_text()) + ")";
  }
  return roff + "\n";
}

std::string options_text(const App& subcommand) {
  std::string roff;
  for (const bool positional : {true, false}) {
    for (const Option* option : subcommand.options()) {
      const bool is_of_group = subcommand.name().empty() && option == subcommand.help_option();
      if (option->nonpositional() != positional && !is_of_group) roff += option_text(*option);
    }
  }
  for (const App* group : subcommand.subcommands()) {
    if (!group->name().empty()) continue;
    roff += ".SS " + escaped(group->group_name() + ", " + group->description()) + "\n";
    roff += options_text(*group);
  }
  return roff;
}

std::string positionals_text(const App& form) {
  std::string roff;
  for (const Option* option : form.options()) {
    if (option->nonpositional()) continue;
    const std::string shown = italic(option->name());
    roff += option->is_required() ? " " + shown : " [" + shown + "]";
  }
  return roff;
}

}  // namespace

std::string man_page(const App& program) {
  std::string roff =
      heading("viewgain") + ".SH NAME\nviewgain \\- scores camera poses by expected " +
      "information gain\n.SH SYNOPSIS\n" + bold("viewgain") + " " + italic("SUBCOMMAND") + " [" +
      italic("OPTIONS") + "]\n.SH DESCRIPTION\n" + escaped(program.description()) + "\n";
  std::string group;
  std::string also;
  for (const App* subcommand : program.subcommands()) {
    if (subcommand->group_name().empty()) continue;
    if (subcommand->group_name() != group) {
      group = subcommand->group_name();
      roff += ".SS " + escaped(group) + "\n";
    }
    const std::string page = "viewgain-" + subcommand->name();
    roff += ".TP\n" + bold(subcommand->name()) + "\n" + escaped(subcommand->description()) + "\n";
    also += (also.empty() ? "" : ",\n") + bold(page) + "(1)";
  }
  return roff + examples(program.footer_text()) + exit_status() + ".SH SEE ALSO\n" + also + "\n";
}

std::string subcommand_man_page(const App& subcommand) {
  const std::string name = subcommand.name();
  std::string synopsis, description, options, footers;
  const std::vector<const App*> forms = subcommand.forms();
  for (const App* form : forms) {
    const std::string call =
        bold("viewgain " + name) + " [" + italic("OPTIONS") + "]" + positionals_text(*form) + "\n";
    const char* const paragraph = form == &subcommand ? "" : ".PP\n";
    synopsis += paragraph + call;
    description += paragraph + escaped(form->description()) + "\n";
    if (forms.size() > 1) options += ".SS " + call;
    options += options_text(*form);
    footers += form->footer_text() + "\n";
  }
  return heading("viewgain-" + name) + ".SH NAME\n" + escaped("viewgain-" + name) + " \\- " +
         escaped(brief(subcommand.description())) + "\n.SH SYNOPSIS\n" + synopsis +
         ".SH DESCRIPTION\n" + description + ".SH OPTIONS\n" + options + examples(footers) +
         exit_status() + ".SH SEE ALSO\n" + bold("viewgain") + "(1)\n";
}

void write_help_files(const App& program, const std::filesystem::path& folder) {
  const auto write = [&](const std::string& name, const std::string& text) {
    std::error_code ignored;
    std::filesystem::create_directories((folder / name).parent_path(), ignored);
    write_file_atomically(folder / name, text);  // which says what is wrong
  };
  write("man1/viewgain.1", man_page(program));
  for (const App* subcommand : program.subcommands()) {
    if (subcommand->group_name().empty()) continue;
    write("man1/viewgain-" + subcommand->name() + ".1", subcommand_man_page(*subcommand));
  }
  write("bash-completion/completions/viewgain", bash_completion(program));
  write("zsh/site-functions/_viewgain", zsh_completion(program));
}

}  // namespace viewgain::app
