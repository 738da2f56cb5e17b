// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include "program/cli/config_file.hpp"

#include <algorithm>
#include <cctype>
#include <cstddef>
#include <cstdint>
#include <filesystem>

#include "program/cli/values.hpp"
#include "viewgain/support/file_bytes.hpp"
#include "viewgain/support/hash64.hpp"
#include "viewgain/support/text.hpp"
#include "viewgain/support/toml_table.hpp"

namespace viewgain::app {
namespace {

using Options = std::vector<const Option*>;
using Words = std::vector<std::string>;

enum class Kind { boolean, number, whole_number, text };

Kind kind_of(const Option& option) {
  if (is_bare(option) || choices_of(option) == Words{"on", "off"}) return Kind::boolean;
  const std::string type = option.get_type_name();
  if (type.starts_with("FLOAT")) return Kind::number;
  return type.starts_with("INT") || type.starts_with("UINT") ? Kind::whole_number : Kind::text;
}

bool is_repeated(const Option& option) { return option.get_expected_max() > 1; }

std::string key_of(const Option& option) {
  if (option.nonpositional()) return option.get_name().substr(2);
  std::string key = option.get_name();
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

// A value as the command line has it.
std::string word_of(const TableReader& reader, const std::string& key, const toml::node& node,
                    Kind kind) {
  if (kind == Kind::boolean) {
    if (!node.is_boolean()) reader.fail(key, "must be true or false");
    return node.as_boolean()->get() ? "on" : "off";
  }
  if (node.is_integer()) return std::to_string(node.as_integer()->get());
  if (kind == Kind::whole_number) reader.fail(key, "must be a whole number");
  if (node.is_floating_point()) return short_text(node.as_floating_point()->get());
  if (kind == Kind::number) reader.fail(key, "must be a number");
  if (node.is_string()) {
    const std::string& text = node.as_string()->get();
    if (text.find('\0') != std::string::npos) reader.fail(key, "must not hold a zero byte");
    return text;
  }
  const toml::array* list = node.as_array();
  if (list == nullptr || list->empty() ||
      std::any_of(list->begin(), list->end(), [](const auto& part) { return part.is_array(); })) {
    reader.fail(key, "must be a text, a number, or a list of these");
  }
  std::string words;
  for (const toml::node& part : *list) {
    words.append(words.empty() ? "" : ",").append(word_of(reader, key, part, kind));
  }
  return words;
}

// The words that a key stands for.
Words words_of(const TableReader& reader, const std::string& key, const toml::node& node,
               const Option& option) {
  const std::string name = option.get_name(), head = option.nonpositional() ? name + "=" : "";
  const toml::array* list = node.as_array();
  if (is_bare(option)) {
    return word_of(reader, key, node, Kind::boolean) == "on" ? Words{name} : Words{};
  }
  if (!is_repeated(option) || (list == nullptr && !option.nonpositional())) {
    return {head + word_of(reader, key, node, kind_of(option))};
  }
  if (list == nullptr) reader.fail(key, "must be a list, with an element for each " + name);
  Words words;
  for (const toml::node& part : *list) {
    words.push_back(head + word_of(reader, key, part, kind_of(option)));
  }
  return words;
}

// Whether the command line has said this, or another one of a group of which one may be given.
bool is_given(const App& subcommand, const Option& option, const GivenWords& given) {
  if (given.options.contains(&option)) return true;
  for (const App* group : subcommand.get_subcommands(nullptr)) {
    const Options members = group->get_options();
    if (group->get_require_option_max() == 1 &&
        std::find(members.begin(), members.end(), &option) != members.end() &&
        std::any_of(members.begin(), members.end(),
                    [&](const Option* member) { return given.options.contains(member); })) {
      return true;
    }
  }
  return false;
}

// The last value of --config among the words; empty: not given.
std::string config_of(const Words& words) {
  std::string path;
  for (std::size_t i = 0; i < words.size() && words[i] != "--"; ++i) {
    if (words[i] == "--config" && i + 1 < words.size()) path = words[++i];
    if (words[i].starts_with("--config=")) path = words[i].substr(9);
  }
  return path;
}

// What it was given, as TOML has it.
std::string value_of(const Option& option) {
  const std::string& text = option.results().back();
  switch (kind_of(option)) {
    case Kind::boolean:
      return text == "on" || (is_bare(option) && option.as<bool>()) ? "true" : "false";
    case Kind::number:
      return short_text(option.as<double>());
    case Kind::whole_number:
      return std::to_string(option.as<std::int64_t>());
    case Kind::text:
      break;
  }
  if (!is_repeated(option)) return toml_string(text);
  std::string list;
  for (const std::string& value : option.results()) {
    list.append(list.empty() ? "" : ", ").append(toml_string(value));
  }
  return "[" + list + "]";
}

std::string default_of(const Option& option) {
  const std::string text = option.get_default_str();
  const Kind kind = kind_of(option);
  if (kind == Kind::boolean) return text == "on" ? "true" : "false";
  return kind == Kind::text ? toml_string(text) : text;
}

// Of a value as value_of() and default_of() write it. Texts come as they were given, UTF-8 or not.
Json json_of(const std::string& value, const Option& option) {
  if (kind_of(option) != Kind::text) {
    const Json json = parse_or_null(value);
    return json.is_null() ? Json(value) : json;
  }
  if (option.empty()) return option.get_default_str();
  return is_repeated(option) ? Json(option.results()) : Json(option.results().back());
}

bool is_utf8(const std::string& text) {
  try {
    (void)Json(text).dump();
    return true;
  } catch (const Json::exception&) {
    return false;
  }
}

}  // namespace

App& form_of(const Forms& forms, const Words& words) {
  if (forms.size() == 1) return *forms[0];
  Options options = all_options(*forms[0]);
  for (const Option* option : all_options(*forms[1])) options.push_back(option);
  const GivenWords given = sort_words(*forms[0], forms, options, words);
  if (!given.positionals.empty()) {
    const std::string& source = given.positionals[0];
    std::error_code ignored;
    if (!std::filesystem::exists(source, ignored)) refuse(source + ": no such file or folder");
    return *forms[std::filesystem::is_directory(source, ignored) ? 1 : 0];
  }
  const std::string path = config_of(words);
  if (path.empty()) return *forms[0];
  const toml::table file = read_toml(path);
  for (const Option* option : forms[1]->get_options()) {
    if (!option->nonpositional() && file.contains(key_of(*option))) return *forms[1];
  }
  return *forms[0];
}

Words with_config(const App& subcommand, const Forms& forms, const Words& words) {
  const GivenWords given = sort_words(subcommand, forms, all_options(subcommand), words);
  const std::string path = config_of(words);
  if (path.empty()) return words;
  const toml::table file = read_toml(path);
  TableReader reader(file, path, "");

  Words all, positionals;
  std::size_t position = 0;
  for (const Option* option : settable_options(subcommand)) {
    const bool is_flag = option->nonpositional();
    const bool is_on_the_line =
        is_flag ? is_given(subcommand, *option, given) : position++ < given.positionals.size();
    const std::string key = key_of(*option);
    const toml::node* node = reader.find(key);
    if (node == nullptr) continue;
    // Looked at in any case: what is wrong in a file is an error.
    const Words more = words_of(reader, key, *node, *option);
    Words& to = is_flag ? all : positionals;
    if (!is_on_the_line) to.insert(to.end(), more.begin(), more.end());
  }
  reader.refuse_unknown_keys();
  all.insert(all.end(), words.begin(), words.end());
  const bool needs_mark = std::any_of(positionals.begin(), positionals.end(),
                                      [](const std::string& p) { return p.starts_with("-"); });
  if (needs_mark && !given.has_mark) all.emplace_back("--");
  all.insert(all.end(), positionals.begin(), positionals.end());
  return all;
}

std::string config_text(const App& subcommand, const Words& left_out) {
  std::string text =
      "# viewgain " + name_of(subcommand) + " --config FILE; what is behind a # is the default\n";
  for (const Option* option : settable_options(subcommand)) {
    const std::string key = key_of(*option);
    if (std::find(left_out.begin(), left_out.end(), key) != left_out.end()) continue;
    if (option->empty()) {
      if (option->get_default_str().empty()) continue;
      text += "# " + key + " = " + default_of(*option) + "\n";
    } else if (const std::string value = value_of(*option); is_utf8(value)) {
      text += key + " = " + value + "\n";
    } else {
      text += "# not UTF-8, to be given on the command line: " + key + "\n";
    }
  }
  return text;
}

CallSettings call_settings(const App& subcommand, const Words& left_out) {
  CallSettings settings;
  for (const Option* option : settable_options(subcommand)) {
    const std::string key = key_of(*option);
    if (std::find(left_out.begin(), left_out.end(), key) != left_out.end()) continue;
    Json& flag = settings.flags[key];
    if (option->empty()) {
      if (!option->get_default_str().empty()) flag = json_of(default_of(*option), *option);
      continue;
    }
    flag = json_of(value_of(*option), *option);
    if (kind_of(*option) != Kind::text) continue;
    for (const std::string& value : option->results()) {
      std::error_code ignored;
      if (!std::filesystem::is_regular_file(value, ignored)) continue;
      Hash64 hash;
      hash.add_bytes(file_bytes(value));
      settings.files[value] = hash.hex();
    }
  }
  return settings;
}

}  // namespace viewgain::app
