// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include "program/cli/config_file.hpp"

#include <algorithm>
#include <cctype>
#include <cstddef>
#include <cstdint>
#include <utility>

#include "program/cli/values.hpp"
#include "program/cli/words.hpp"
#include "viewgain/support/settings_toml.hpp"
#include "viewgain/support/text.hpp"

namespace viewgain::app {
namespace {

using Kind = SettingValue::Kind;
using Options = std::vector<const Option*>;

std::string key_of(const Option& option) {
  if (option.nonpositional()) return option.long_name();
  std::string key = option.name();
  for (char& c : key) {
    c = c == '_' ? '-' : static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  }
  return key;
}

// Those that a file can hold.
Options settable_options(const App& subcommand) {
  Options options = all_options(subcommand);
  std::erase_if(options, [](const Option* option) {
    const std::string key = key_of(*option);
    return key == "help" || key == "config" || key == "save-config";
  });
  return options;
}

std::vector<std::string> keys_of(const Options& options) {
  std::vector<std::string> keys;
  for (const Option* option : options) keys.push_back(key_of(*option));
  return keys;
}

bool is_switch(const Option& option) {
  return option.choices() == std::vector<std::string>{"on", "off"};
}

Kind kind_of(const Option& option) {
  if (option.is_bare() || is_switch(option)) return Kind::boolean;
  const std::string type = option.type_name();
  if (type.starts_with("FLOAT")) return Kind::number;
  return type.starts_with("INT") || type.starts_with("UINT") ? Kind::whole_number : Kind::text;
}

// A value as the command line has it.
std::string word_of(const std::string& path, const Setting& setting, const SettingValue& value,
                    const Option& option) {
  const auto is_plain = [](const SettingValue& element) {
    return element.kind != Kind::list && element.kind != Kind::boolean;
  };
  switch (kind_of(option)) {
    case Kind::boolean:
      if (value.kind == Kind::boolean) return value.text == "true" ? "on" : "off";
      refuse_setting(path, setting, "must be true or false");
    case Kind::number:
      if (value.kind == Kind::number || value.kind == Kind::whole_number) return value.text;
      refuse_setting(path, setting, "must be a number");
    case Kind::whole_number:
      if (value.kind == Kind::whole_number) return value.text;
      refuse_setting(path, setting, "must be a whole number");
    case Kind::text:
    case Kind::list:
      break;
  }
  const bool is_list_of_plain = value.kind == Kind::list && !value.elements.empty() &&
                                std::all_of(value.elements.begin(), value.elements.end(), is_plain);
  if (value.text.find('\0') != std::string::npos) {
    refuse_setting(path, setting, "must not hold a zero byte");
  }
  if (is_plain(value) || is_list_of_plain) return value.text;
  refuse_setting(path, setting, "must be a text, a number, or a list of these");
}

void add_words(const std::string& path, const Setting& setting, const Option& option,
               std::vector<std::string>& words) {
  const std::string flag = option.name();
  if (option.is_bare()) {
    if (word_of(path, setting, setting.value, option) == "on") words.push_back(flag);
  } else if (!option.is_repeated()) {
    words.push_back(flag + "=" + word_of(path, setting, setting.value, option));
  } else {
    if (setting.value.kind != Kind::list) {
      refuse_setting(path, setting, "must be a list, with an element for each " + flag);
    }
    for (const SettingValue& element : setting.value.elements) {
      words.push_back(flag + "=" + word_of(path, setting, element, option));
    }
  }
}

std::vector<std::string> positional_words(const std::string& path, const Setting& setting,
                                          const Option& option) {
  if (!option.is_repeated() || setting.value.kind != Kind::list) {
    return {word_of(path, setting, setting.value, option)};
  }
  std::vector<std::string> words;
  for (const SettingValue& element : setting.value.elements) {
    words.push_back(word_of(path, setting, element, option));
  }
  return words;
}

// Whether the command line has said this, or another one of a group of which one may be given.
bool is_given(const App& subcommand, const Option& option, const GivenWords& given) {
  if (given.options.contains(&option)) return true;
  for (const App* group : subcommand.subcommands()) {
    if (!group->takes_one_option()) continue;
    const Options members = group->options();
    const auto is_on_the_line = [&](const Option* member) {
      return given.options.contains(member);
    };
    if (std::find(members.begin(), members.end(), &option) != members.end() &&
        std::any_of(members.begin(), members.end(), is_on_the_line)) {
      return true;
    }
  }
  return false;
}

// The last value of --config among the words; empty: not given.
std::string config_of(const std::vector<std::string>& words) {
  std::string path;
  for (std::size_t i = 0; i < words.size() && words[i] != "--"; ++i) {
    if (words[i] == "--config" && i + 1 < words.size()) path = words[++i];
    if (words[i].starts_with("--config=")) path = words[i].substr(9);
  }
  return path;
}

// What was given, as TOML has it.
SettingValue value_of(const Option& option) {
  const std::string& text = option.results().back();
  switch (kind_of(option)) {
    case Kind::boolean:
      return {Kind::boolean,
              text == "on" || (option.is_bare() && option.as<bool>()) ? "true" : "false"};
    case Kind::number:
      return {Kind::number, short_text(option.as<double>())};
    case Kind::whole_number:
      return {Kind::whole_number, std::to_string(option.as<std::int64_t>())};
    case Kind::text:
    case Kind::list:
      break;
  }
  return {Kind::text, text};
}

SettingValue default_of(const Option& option) {
  const std::string text = option.default_text();
  const Kind kind = kind_of(option);
  if (kind == Kind::boolean) return {kind, text == "on" ? "true" : "false"};
  return {kind, text};
}

}  // namespace

const App& form_of(const App& subcommand, const std::vector<std::string>& words) {
  const std::vector<const App*> forms = subcommand.forms();
  if (forms.size() == 1) return subcommand;
  const Options options = options_of_forms(subcommand);
  const GivenWords given = sort_words(subcommand, options, words);
  if (!given.positionals.empty()) {
    const auto form = std::find_if(forms.begin(), forms.end(), [&](const App* of_forms) {
      return of_forms->takes(given.positionals.front());
    });
    return form == forms.end() ? subcommand : **form;
  }
  const std::string path = config_of(words);
  if (path.empty()) return subcommand;
  for (const Setting& setting : read_settings_toml(path, keys_of(options))) {
    for (const App* form : forms) {
      for (const Option* option : form->options()) {
        if (!option->nonpositional() && key_of(*option) == setting.key) return *form;
      }
    }
  }
  return subcommand;
}

std::vector<std::string> with_config(const App& subcommand, const std::vector<std::string>& words) {
  const GivenWords given = sort_words(subcommand, all_options(subcommand), words);
  const std::string path = config_of(words);
  if (path.empty()) return words;
  const Options options = settable_options(subcommand);
  const std::vector<Setting> settings = read_settings_toml(path, keys_of(options));

  std::vector<std::string> all, positionals;
  std::size_t position = 0;
  for (const Option* option : options) {
    const std::string key = key_of(*option);
    const bool is_on_the_line = option->nonpositional() ? is_given(subcommand, *option, given)
                                                        : position++ < given.positionals.size();
    const auto setting = std::find_if(settings.begin(), settings.end(),
                                      [&](const Setting& s) { return s.key == key; });
    if (setting == settings.end()) continue;
    std::vector<std::string> more;  // looked at in any case: what is wrong in a file is an error
    if (option->nonpositional()) {
      add_words(path, *setting, *option, more);
    } else {
      for (std::string& word : positional_words(path, *setting, *option)) {
        if (!is_on_the_line) positionals.push_back(std::move(word));
      }
    }
    if (!is_on_the_line) all.insert(all.end(), more.begin(), more.end());
  }
  all.insert(all.end(), words.begin(), words.end());
  const bool needs_mark = std::any_of(positionals.begin(), positionals.end(),
                                      [](const std::string& p) { return p.starts_with("-"); });
  if (needs_mark && !given.has_mark) all.emplace_back("--");
  all.insert(all.end(), positionals.begin(), positionals.end());
  return all;
}

std::string config_text(const App& subcommand, const std::vector<std::string>& left_out) {
  std::string text = "# viewgain " + subcommand.name() + " --config FILE; what is behind a # is " +
                     "the default\n";
  for (const Option* option : settable_options(subcommand)) {
    const std::string key = key_of(*option);
    if (std::find(left_out.begin(), left_out.end(), key) != left_out.end()) continue;
    std::string line;
    if (option->empty()) {
      if (option->default_text().empty()) continue;
      line = "# " + setting_line(key, default_of(*option));
    } else if (option->is_repeated()) {
      SettingValue list{Kind::list, {}, {}};
      for (const std::string& value : option->results())
        list.elements.push_back({Kind::text, value});
      line = setting_line(key, list);
    } else {
      line = setting_line(key, value_of(*option));
    }
    const std::string shown = utf8_text(line);
    text += shown == line ? line : "# not UTF-8, to be given on the command line: " + shown;
  }
  return text;
}

}  // namespace viewgain::app
