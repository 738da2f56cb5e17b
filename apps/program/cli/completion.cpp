// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include "program/cli/completion.hpp"

#include <vector>

#include "program/cli/choices.hpp"
#include "program/cli/words.hpp"
#include "viewgain/core/sensor.hpp"

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
  return option.name() == "--sensor" ? sensor_preset_names() : choices_of(option);
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

}  // namespace viewgain::app
