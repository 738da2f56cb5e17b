// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include "viewgain/support/toml_table.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <utility>

#include "viewgain/core/error.hpp"
#include "viewgain/support/file_bytes.hpp"
#include "viewgain/support/text.hpp"

namespace viewgain {

toml::table read_toml(const std::filesystem::path& path) {
  return parse_toml(file_bytes(path, kMostTomlBytes), path.string());
}

toml::table parse_toml(std::string_view text, const std::string& name) {
  try {
    return toml::parse(text);
  } catch (const toml::parse_error& error) {
    throw Error(ErrorCode::format, name + ": line " + std::to_string(error.source().begin.line) +
                                       ": " + std::string(error.description()));
  }
}

TableReader::TableReader(const toml::table& table, std::string file, std::string prefix)
    : table_(table), file_(std::move(file)), prefix_(std::move(prefix)) {}

void TableReader::fail(std::string_view key, const std::string& what) const {
  const toml::node* node = table_.get(key);
  const std::string line =
      node != nullptr ? "line " + std::to_string(node->source().begin.line) + ": " : "";
  throw Error(ErrorCode::format,
              file_ + ": " + line + "key \"" + prefix_ + std::string(key) + "\" " + what);
}

const toml::node* TableReader::find(std::string_view key) {
  known_.emplace_back(key);
  return table_.get(key);
}

const toml::node& TableReader::require(std::string_view key) {
  const toml::node* node = find(key);
  if (node == nullptr) fail(key, "is missing");
  return *node;
}

double TableReader::number(std::string_view key) { return number_of(require(key), key); }

double TableReader::number_of(const toml::node& node, std::string_view key) const {
  const auto value = node.value<double>();
  if (!value || !node.is_number()) fail(key, "must be a number");
  if (!std::isfinite(*value)) fail(key, "must be finite");
  return *value;
}

int TableReader::whole_number(std::string_view key) {
  const auto* number = require(key).as_integer();
  if (number == nullptr || number->get() < 0 || number->get() > 1'000'000) {
    fail(key, "must be a whole number from 0 to 1000000");
  }
  return static_cast<int>(number->get());
}

void TableReader::check_format() {
  if (find("format") == nullptr || whole_number("format") <= kTomlFormat) return;
  fail("format", "is " + std::to_string(whole_number("format")) +
                     ", which is too new; this library reads formats up to " +
                     std::to_string(kTomlFormat));
}

std::string TableReader::text(std::string_view key) {
  const toml::node& node = require(key);
  if (!node.is_string()) fail(key, "must be a string");
  return *node.value<std::string>();
}

std::vector<double> TableReader::numbers(std::string_view key, std::size_t count) {
  return numbers(key, require(key), count);
}

std::vector<double> TableReader::numbers(std::string_view key, const toml::node& node,
                                         std::size_t count) const {
  const toml::array* array = node.as_array();
  if (array == nullptr || array->size() != count) {
    fail(key, "must be a list of " + std::to_string(count) + " numbers");
  }
  std::vector<double> values;
  for (const toml::node& element : *array) values.push_back(number_of(element, key));
  return values;
}

TableReader TableReader::table(std::string_view key) {
  const toml::node& node = require(key);
  if (!node.is_table()) fail(key, "must be a table");
  return {*node.as_table(), file_, prefix_ + std::string(key) + "."};
}

std::vector<TableReader> TableReader::tables(std::string_view key) {
  std::vector<TableReader> readers;
  const toml::node* node = find(key);
  if (node == nullptr) return readers;
  const toml::array* array = node->as_array();
  if (array == nullptr) fail(key, "must be a list of tables");
  for (std::size_t i = 0; i < array->size(); ++i) {
    const std::string name = std::string(key) + "[" + std::to_string(i) + "]";
    const toml::table* element = array->get(i)->as_table();
    if (element == nullptr) fail(name, "must be a table");
    readers.emplace_back(*element, file_, prefix_ + name + ".");
  }
  return readers;
}

void TableReader::refuse_unknown_keys() const {
  for (const auto& [key, node] : table_) {
    if (std::find(known_.begin(), known_.end(), std::string(key.str())) == known_.end()) {
      fail(key.str(), "is unknown" + did_you_mean(key.str(), known_));
    }
  }
}

}  // namespace viewgain
