// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include "viewgain/support/settings_toml.hpp"

#include "viewgain/core/error.hpp"
#include "viewgain/support/text.hpp"
#include "viewgain/support/toml_table.hpp"

namespace viewgain {
namespace {

using Kind = SettingValue::Kind;

SettingValue value_of(const TableReader& reader, const std::string& key, const toml::node& node) {
  if (const auto* text = node.as_string()) return {Kind::text, text->get()};
  if (const auto* whole = node.as_integer()) {
    return {Kind::whole_number, std::to_string(whole->get())};
  }
  if (const auto* number = node.as_floating_point()) {
    return {Kind::number, short_text(number->get())};
  }
  if (const auto* boolean = node.as_boolean()) {
    return {Kind::boolean, boolean->get() ? "true" : "false"};
  }
  const toml::array* array = node.as_array();
  if (array == nullptr) {
    reader.fail(key, "must be a text, a number, true or false, or a list of these");
  }
  SettingValue list{Kind::list, {}, {}};
  for (const toml::node& element : *array) {
    list.elements.push_back(value_of(reader, key, element));
    list.text.append(list.elements.size() > 1 ? "," : "").append(list.elements.back().text);
  }
  return list;
}

}  // namespace

std::vector<Setting> read_settings_toml(const std::filesystem::path& path,
                                        const std::vector<std::string>& keys) {
  const toml::table root = read_toml(path);
  TableReader reader(root, path.string(), "");
  std::vector<Setting> settings;
  for (const std::string& key : keys) {
    const toml::node* node = reader.find(key);
    if (node == nullptr) continue;
    settings.push_back({key, node->source().begin.line, value_of(reader, key, *node)});
  }
  reader.refuse_unknown_keys();
  return settings;
}

void refuse_setting(const std::filesystem::path& path, const Setting& setting,
                    const std::string& what) {
  throw Error(ErrorCode::format, path.string() + ": line " + std::to_string(setting.line) +
                                     ": key \"" + setting.key + "\" " + what);
}

std::string setting_line(const std::string& key, const SettingValue& value) {
  std::string text = key + " = ";
  if (value.kind != Kind::list) {
    return text + (value.kind == Kind::text ? toml_string(value.text) : value.text) + "\n";
  }
  text += "[";
  for (const SettingValue& element : value.elements) {
    text.append(&element == &value.elements.front() ? "" : ", ").append(toml_string(element.text));
  }
  return text + "]\n";
}

}  // namespace viewgain
