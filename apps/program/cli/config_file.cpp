// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include "program/cli/config_file.hpp"

#include <algorithm>
#include <cctype>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <iterator>
#include <utility>

#include "program/cli/flags/scene_sources.hpp"
#include "program/cli/successors.hpp"
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
  std::string key = option.get_name();
  if (option.nonpositional()) return key.substr(key.find_first_not_of('-'));
  for (char& c : key) {
    c = c == '_' ? '-' : static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  }
  return key;
}

bool is_of(const App& app, const Option& option) {
  const Options options = app.get_options();
  return std::find(options.begin(), options.end(), &option) != options.end();
}

// Options that a file can set.
Options settable_options(const App& subcommand) {
  Options options = options_of_call(subcommand);
  std::erase_if(options, [](const Option* option) {
    const std::string key = key_of(*option);
    return key == "help" || key == "h" || key == "version" || key == "config" ||
           key == "save-config";
  });
  return options;
}

// A value as on the command line.
std::string word_of(const TableReader& reader, const std::string& key, const toml::node& node,
                    Kind kind, bool may_be_switch = false) {
  if (kind == Kind::text && node.is_boolean() && may_be_switch) {
    return node.as_boolean()->get() ? "on" : "off";
  }
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
    if (text.find('\0') != std::string::npos) reader.fail(key, "must not contain a zero byte");
    return text;
  }
  const toml::array* list = node.as_array();
  if (list == nullptr || list->empty() ||
      std::any_of(list->begin(), list->end(), [](const auto& part) { return part.is_array(); })) {
    reader.fail(key, "must be a string, a number, or a list of these");
  }
  std::string words;
  for (const toml::node& part : *list) {
    words.append(words.empty() ? "" : ",").append(word_of(reader, key, part, kind));
  }
  return words;
}

// The values of a key; none for a flag that is not set.
Words values_of(const TableReader& reader, const std::string& key, const toml::node& node,
                const Option& option) {
  const toml::array* list = node.as_array();
  if (is_bare(option)) {
    return word_of(reader, key, node, Kind::boolean) == "on" ? Words{"true"} : Words{};
  }
  if (!is_repeated(option) || (list == nullptr && !option.nonpositional())) {
    // Noise, register and report take "on" and "off" and also other texts.
    const std::string usual = option.get_default_str();
    return {word_of(reader, key, node, kind_of(option), usual == "on" || usual == "off")};
  }
  if (list == nullptr) {
    reader.fail(key, "must be a list with one element for each " + option.get_name());
  }
  Words values;
  for (const toml::node& part : *list) {
    values.push_back(word_of(reader, key, part, kind_of(option)));
  }
  return values;
}

// The given value in TOML.
std::string value_of(const Option& option) {
  const std::string text = option.reduced_results().back();
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

// JSON of a value from value_of() or default_of(). Texts are unchanged, whether UTF-8 or not.
Json json_of(const std::string& value, const Option& option) {
  if (kind_of(option) != Kind::text) {
    const Json json = parse_or_null(value);
    return json.is_null() ? Json(value) : json;
  }
  if (option.empty()) return option.get_default_str();
  return is_repeated(option) ? Json(option.results()) : Json(option.reduced_results().back());
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

namespace {

// Whether the command line has another option of a group in which only one is allowed.
bool is_excluded(const App& subcommand, const Option& option) {
  for (const App* group : subcommand.get_subcommands(nullptr)) {
    const Options members = group->get_options();
    if (group->get_require_option_max() == 1 && is_of(*group, option) &&
        std::any_of(members.begin(), members.end(),
                    [](const Option* member) { return member->count() > 0; })) {
      return true;
    }
  }
  return false;
}

}  // namespace

std::vector<CLI::ConfigItem> FlagFile::from_config(std::istream& in) const {
  const std::string path = program_.get_option("--config")->results().back();
  const std::string text{std::istreambuf_iterator<char>(in), {}};
  std::vector<CLI::ConfigItem> given;
  const std::vector<App*> called = program_.get_subcommands();
  if (called.empty()) return given;
  const toml::table file = parse_toml(text, path);
  TableReader reader(file, path, "");
  for (const Option* option : settable_options(*called.front())) {
    const std::string key = key_of(*option);
    const toml::node* node = reader.find(key);
    if (node == nullptr) continue;
    CLI::ConfigItem item;
    item.inputs = values_of(reader, key, *node, *option);
    item.name = option->nonpositional() ? key : option->get_name();
    if (!is_of(program_, *option)) item.parents = {called.front()->get_name()};
    if (!item.inputs.empty() && !is_excluded(*called.front(), *option)) {
      given.push_back(std::move(item));
    }
  }
  for (const auto& [key, node] : file) {
    const std::string gone = successor_of("--" + std::string(key.str()));
    const Option* known = called.front()->get_option_no_throw("--" + std::string(key.str()));
    if (!gone.empty() && known == nullptr)
      reader.fail(key.str(), "belongs to a removed flag: " + gone);
  }
  reader.refuse_unknown_keys();
  return given;
}

std::string FlagFile::to_config(const App* app, bool, bool, std::string) const {
  return config_text(*app);
}

std::string config_text(const App& subcommand, const Words& left_out) {
  std::string text =
      "# viewgain " + subcommand.get_name() + " --config FILE; values after # are the defaults\n";
  for (const Option* option : settable_options(subcommand)) {
    const std::string key = key_of(*option);
    if (std::find(left_out.begin(), left_out.end(), key) != left_out.end()) continue;
    if (option->empty()) {
      if (option->get_default_str().empty()) continue;
      text += "# " + key + " = " + default_of(*option) + "\n";
    } else if (const std::string value = value_of(*option); is_utf8(value)) {
      text += key + " = " + value + "\n";
    } else {
      text += "# not UTF-8; give it on the command line: " + key + "\n";
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
    for (std::string value : option->results()) {
      if (key == "hazard") value = hazard_file_of(value);
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
