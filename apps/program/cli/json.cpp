// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include "program/cli/json.hpp"

#include <algorithm>
#include <limits>
#include <nlohmann/json.hpp>
#include <ostream>

namespace viewgain::app {
namespace {

constexpr int kDeepest = 500;  // levels: a Json is copied and destroyed by recursion

Json converted(const nlohmann::ordered_json& parsed, int levels = kDeepest) {
  if (levels == 0) throw JsonError("JSON: more than " + std::to_string(kDeepest) + " levels");
  switch (parsed.type()) {
    case nlohmann::ordered_json::value_t::boolean:
      return parsed.get<bool>();
    case nlohmann::ordered_json::value_t::number_integer:
      return parsed.get<std::int64_t>();
    case nlohmann::ordered_json::value_t::number_unsigned:
      return parsed.get<std::uint64_t>();
    case nlohmann::ordered_json::value_t::number_float:
      return parsed.get<double>();
    case nlohmann::ordered_json::value_t::string:
      return parsed.get_ref<const std::string&>();
    case nlohmann::ordered_json::value_t::array: {
      Json array = Json::array();
      for (const nlohmann::ordered_json& element : parsed) {
        array.push_back(converted(element, levels - 1));
      }
      return array;
    }
    case nlohmann::ordered_json::value_t::object: {
      Json object = Json::object();
      for (const auto& [key, value] : parsed.items()) object[key] = converted(value, levels - 1);
      return object;
    }
    default:
      return nullptr;
  }
}

std::string text_of(const nlohmann::json& value) {
  return value.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
}

// The types of Json's value in their order.
constexpr std::array<const char*, 8> kTypes{"null",     "a boolean", "a number", "a number",
                                            "a number", "a text",    "an array", "an object"};

[[noreturn]] void refuse(const char* wanted, std::size_t type) {
  throw JsonError(std::string("JSON: ") + wanted + " is wanted where " + kTypes[type] + " is");
}

bool is_member(const Json& element) {
  return element.is_array() && element.size() == 2 && element.front().is_string();
}

}  // namespace

Json::Json(std::initializer_list<Json> elements) {
  if (std::all_of(elements.begin(), elements.end(), is_member)) {
    Members members;
    for (const Json& element : elements) {
      members.keys.push_back(element.front().get<std::string>());
      members.values.push_back(element.back());
    }
    value_ = std::move(members);
  } else {
    value_ = std::vector<Json>(elements);
  }
}

Json::Json(const Json& other) = default;
Json::Json(Json&& other) noexcept = default;
Json& Json::operator=(const Json& other) = default;
Json& Json::operator=(Json&& other) noexcept = default;
Json::~Json() = default;

Json Json::array() {
  Json json;
  json.value_ = std::vector<Json>();
  return json;
}

Json Json::object() {
  Json json;
  json.value_ = Members();
  return json;
}

Json Json::parse(std::string_view text) {
  try {
    return converted(nlohmann::ordered_json::parse(text));
  } catch (const nlohmann::json::exception& error) {
    throw JsonError(error.what());
  }
}

Json Json::parse_or_null(std::string_view text) {
  try {
    return parse(text);
  } catch (const JsonError&) {
    return nullptr;
  }
}

bool Json::is_null() const noexcept { return value_.index() == 0; }
bool Json::is_boolean() const noexcept { return std::holds_alternative<bool>(value_); }
bool Json::is_number() const noexcept {
  return is_number_integer() || std::holds_alternative<double>(value_);
}
bool Json::is_number_integer() const noexcept {
  return std::holds_alternative<std::int64_t>(value_) ||
         std::holds_alternative<std::uint64_t>(value_);
}
bool Json::is_string() const noexcept { return std::holds_alternative<std::string>(value_); }
bool Json::is_array() const noexcept { return std::holds_alternative<std::vector<Json>>(value_); }
bool Json::is_object() const noexcept { return std::holds_alternative<Members>(value_); }

void Json::read(bool& value) const {
  if (!is_boolean()) refuse("a boolean", value_.index());
  value = std::get<bool>(value_);
}

namespace {

// Whether a value is a number that the type can hold; then `number` is that.
template <typename Number>
struct ToNumber {
  template <typename Value>
  bool operator()(const Value& value) const {
    if constexpr (!std::is_arithmetic_v<Value> || std::same_as<Value, bool>) {
      return false;
    } else {
      using Limits = std::numeric_limits<Number>;
      if constexpr (std::integral<Number> && std::integral<Value>) {
        if (!std::in_range<Number>(value)) return false;
      } else if constexpr (std::integral<Number>) {  // 2^63 and 2^64 themselves are too large
        if (!(value >= static_cast<Value>(Limits::min()) &&
              value < static_cast<Value>(Limits::max())))
          return false;
      }
      number = static_cast<Number>(value);
      return true;
    }
  }
  Number& number;
};

}  // namespace

void Json::read(double& value) const {
  if (!std::visit(ToNumber<double>{value}, value_)) refuse("a number", value_.index());
}

void Json::read(std::int64_t& value) const {
  if (!std::visit(ToNumber<std::int64_t>{value}, value_)) refuse("a whole number", value_.index());
}

void Json::read(std::uint64_t& value) const {
  if (!std::visit(ToNumber<std::uint64_t>{value}, value_))
    refuse("a number from 0", value_.index());
}

void Json::read(std::string& value) const {
  if (!is_string()) refuse("a text", value_.index());
  value = std::get<std::string>(value_);
}

void Json::check_array() const {
  if (!is_array()) refuse("an array", value_.index());
}

Json& Json::operator[](std::string_view key) {
  if (is_null()) value_ = Members();
  if (!is_object()) refuse("an object", value_.index());
  auto& [keys, values] = std::get<Members>(value_);
  const auto found = std::find(keys.begin(), keys.end(), key);
  if (found != keys.end()) return values[static_cast<std::size_t>(found - keys.begin())];
  keys.emplace_back(key);
  return values.emplace_back();
}

const Json& Json::at(std::string_view key) const {
  if (!is_object()) refuse("an object", value_.index());
  const auto& [keys, values] = std::get<Members>(value_);
  const auto found = std::find(keys.begin(), keys.end(), key);
  if (found == keys.end()) throw JsonError("JSON: there is no key " + std::string(key));
  return values[static_cast<std::size_t>(found - keys.begin())];
}

const Json& Json::element(std::size_t index) const {
  check_array();
  const auto& elements = std::get<std::vector<Json>>(value_);
  if (index >= elements.size()) {
    throw JsonError("JSON: element " + std::to_string(index) + " of " +
                    std::to_string(elements.size()));
  }
  return elements[index];
}

bool Json::contains(std::string_view key) const noexcept {
  if (!is_object()) return false;
  const std::vector<std::string>& keys = std::get<Members>(value_).keys;
  return std::find(keys.begin(), keys.end(), key) != keys.end();
}

void Json::push_back(Json json) {
  if (is_null()) value_ = std::vector<Json>();
  check_array();
  std::get<std::vector<Json>>(value_).push_back(std::move(json));
}

Json& Json::back() { return const_cast<Json&>(std::as_const(*this).back()); }

const Json& Json::back() const { return at(size() - 1); }

void Json::update(const Json& other) {
  if (is_null()) value_ = Members();
  if (!other.is_object()) refuse("an object", other.value_.index());
  const auto& [keys, values] = std::get<Members>(other.value_);
  for (std::size_t i = 0; i < keys.size(); ++i) (*this)[keys[i]] = values[i];
}

bool Json::erase(std::string_view key) {
  if (!is_object()) refuse("an object", value_.index());
  auto& [keys, values] = std::get<Members>(value_);
  const auto found = std::find(keys.begin(), keys.end(), key);
  if (found == keys.end()) return false;
  values.erase(values.begin() + (found - keys.begin()));
  keys.erase(found);
  return true;
}

std::size_t Json::size() const noexcept {
  if (is_null()) return 0;
  return is_array() || is_object() ? static_cast<std::size_t>(end() - begin()) : 1;
}

Json* Json::begin() noexcept { return const_cast<Json*>(std::as_const(*this).begin()); }
Json* Json::end() noexcept { return const_cast<Json*>(std::as_const(*this).end()); }

const Json* Json::begin() const noexcept {
  if (const auto* elements = std::get_if<std::vector<Json>>(&value_)) return elements->data();
  if (const auto* members = std::get_if<Members>(&value_)) return members->values.data();
  return nullptr;
}

const Json* Json::end() const noexcept {
  if (const auto* elements = std::get_if<std::vector<Json>>(&value_)) {
    return elements->data() + elements->size();
  }
  if (const auto* members = std::get_if<Members>(&value_)) {
    return members->values.data() + members->values.size();
  }
  return nullptr;
}

std::vector<Json::Item> Json::items() const {
  if (!is_object()) refuse("an object", value_.index());
  const auto& [keys, values] = std::get<Members>(value_);
  std::vector<Item> items;
  for (std::size_t i = 0; i < keys.size(); ++i) items.push_back({keys[i], values[i]});
  return items;
}

void Json::write(std::string& text, int indent, int depth) const {
  const auto new_line = [&](int level) {
    if (indent < 0) return;
    text += '\n';
    text.append(static_cast<std::size_t>(indent * level), ' ');
  };
  if (!is_array() && !is_object()) {
    text += std::visit(
        [](const auto& value) -> std::string {
          using Value = std::decay_t<decltype(value)>;
          if constexpr (std::same_as<Value, std::vector<Json>> || std::same_as<Value, Members>) {
            return {};
          } else {
            return text_of(value);
          }
        },
        value_);
    return;
  }
  text += is_array() ? '[' : '{';
  for (std::size_t i = 0; i < size(); ++i) {
    if (i > 0) text += ',';
    new_line(depth + 1);
    if (is_object()) {
      text += text_of(std::get<Members>(value_).keys[i]);
      text += indent < 0 ? ":" : ": ";
    }
    begin()[i].write(text, indent, depth + 1);
  }
  if (!empty()) new_line(depth);
  text += is_array() ? ']' : '}';
}

std::string Json::dump(int indent) const {
  std::string text;
  write(text, indent, 0);
  return text;
}

bool operator==(const Json& a, const Json& b) {
  if (a.is_number() && b.is_number() && a.value_.index() != b.value_.index()) {
    if (!a.is_number_integer() || !b.is_number_integer()) return a.get<double>() == b.get<double>();
    const auto* whole = std::get_if<std::int64_t>(&a.value_);
    return whole != nullptr ? std::cmp_equal(*whole, std::get<std::uint64_t>(b.value_)) : b == a;
  }
  if (a.value_.index() != b.value_.index()) return false;
  if (a.is_array()) return std::equal(a.begin(), a.end(), b.begin(), b.end());
  if (a.is_object()) {
    // In any order.
    const std::vector<std::string>& keys = std::get<Json::Members>(a.value_).keys;
    return a.size() == b.size() &&
           std::all_of(keys.begin(), keys.end(), [&](const std::string& key) {
             return b.contains(key) && a.at(key) == b.at(key);
           });
  }
  return std::visit(
      [&](const auto& value) {
        using Value = std::decay_t<decltype(value)>;
        if constexpr (std::same_as<Value, std::vector<Json>> ||
                      std::same_as<Value, Json::Members>) {
          return false;
        } else {
          return value == std::get<Value>(b.value_);
        }
      },
      a.value_);
}

std::ostream& operator<<(std::ostream& out, const Json& json) { return out << json.dump(); }

}  // namespace viewgain::app
