// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <compare>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <initializer_list>
#include <iosfwd>
#include <map>
#include <optional>
#include <stdexcept>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <variant>
#include <vector>

namespace viewgain::app {

/// What Json throws: a text that is no JSON, a key that is missing, a value of another type.
class JsonError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// A JSON value: what --json, run.json and results.json hold. Objects keep the order in which their
/// keys came. Text is read and written by nlohmann/json, which json.cpp alone includes, since it
/// takes ten times as long to compile as this.
class Json {
 public:
  Json() noexcept = default;
  Json(std::nullptr_t) noexcept {}
  Json(const char* text) : value_(std::string(text)) {}
  Json(std::string text) noexcept : value_(std::move(text)) {}
  Json(std::string_view text) : value_(std::string(text)) {}
  Json(const std::filesystem::path& path) : value_(path.string()) {}
  template <typename Number>
  requires std::is_arithmetic_v<Number> Json(Number number)
  noexcept {
    if constexpr (std::same_as<Number, bool>) {
      value_ = number;
    } else if constexpr (std::floating_point<Number>) {
      value_ = static_cast<double>(number);
    } else if constexpr (std::signed_integral<Number>) {
      value_ = static_cast<std::int64_t>(number);
    } else {
      value_ = static_cast<std::uint64_t>(number);
    }
  }
  template <typename Element>
  Json(const std::vector<Element>& elements) : Json(array()) {
    for (const auto& element : elements) push_back(Json(element));
  }
  template <typename Element, std::size_t size>
  Json(const std::array<Element, size>& elements) : Json(array()) {
    for (const Element& element : elements) push_back(Json(element));
  }
  template <typename Element>
  Json(const std::map<std::string, Element>& members) : Json(object()) {
    for (const auto& [key, member] : members) (*this)[key] = Json(member);
  }
  /// Null where there is none.
  template <typename Value>
  Json(const std::optional<Value>& value) {
    if (value) *this = Json(*value);
  }
  /// An object where each element is a pair of a text and a value, else an array.
  Json(std::initializer_list<Json> elements);

  Json(const Json& other);
  Json(Json&& other) noexcept;
  Json& operator=(const Json& other);
  Json& operator=(Json&& other) noexcept;
  ~Json();

  /// A text, or null for an empty one.
  [[nodiscard]] static Json or_null(std::string_view text) {
    return text.empty() ? Json() : Json(text);
  }
  [[nodiscard]] static Json array();
  [[nodiscard]] static Json object();
  /// Throws JsonError.
  [[nodiscard]] static Json parse(std::string_view text);
  /// Null for a text that is no JSON.
  [[nodiscard]] static Json parse_or_null(std::string_view text);

  [[nodiscard]] bool is_null() const noexcept;
  [[nodiscard]] bool is_boolean() const noexcept;
  [[nodiscard]] bool is_number() const noexcept;
  [[nodiscard]] bool is_number_integer() const noexcept;
  [[nodiscard]] bool is_string() const noexcept;
  [[nodiscard]] bool is_array() const noexcept;
  [[nodiscard]] bool is_object() const noexcept;

  /// The value as a bool, a number, a text, or a vector or array of such. Throws JsonError.
  template <typename Value>
  [[nodiscard]] Value get() const {
    Value value{};
    read(value);
    return value;
  }
  template <typename Value>
  requires(std::is_arithmetic_v<Value> || std::same_as<Value, std::string>) operator Value() const {
    return get<Value>();
  }

  /// Of an object, adding the key where it is new; a null becomes an object. Throws JsonError.
  Json& operator[](std::string_view key);
  /// As at().
  const Json& operator[](std::string_view key) const { return at(key); }
  const Json& operator[](const char* key) const { return at(key); }
  Json& operator[](const char* key) { return (*this)[std::string_view(key)]; }
  template <std::integral Index>
  Json& operator[](Index index) {
    return const_cast<Json&>(element(static_cast<std::size_t>(index)));
  }
  template <std::integral Index>
  const Json& operator[](Index index) const {
    return at(index);
  }
  /// Throws JsonError where there is no such key or index.
  [[nodiscard]] const Json& at(std::string_view key) const;
  [[nodiscard]] const Json& at(const char* key) const { return at(std::string_view(key)); }
  template <std::integral Index>
  [[nodiscard]] const Json& at(Index index) const {
    return element(static_cast<std::size_t>(index));
  }
  [[nodiscard]] bool contains(std::string_view key) const noexcept;
  /// The value under the key, or another one where the key is missing.
  template <typename Value>
  [[nodiscard]] Value value(std::string_view key, Value other) const {
    return contains(key) ? at(key).get<Value>() : other;
  }
  [[nodiscard]] std::string value(std::string_view key, const char* other) const {
    return value(key, std::string(other));
  }

  /// A null becomes an array. Throws JsonError for what is neither.
  void push_back(Json json);
  Json& back();
  [[nodiscard]] const Json& back() const;
  [[nodiscard]] const Json& front() const { return at(0); }
  /// Sets the members of another object. Throws JsonError.
  void update(const Json& other);
  /// Takes a member out; returns whether it was there.
  bool erase(std::string_view key);
  /// Of elements or members; 0 for null, 1 for what is one value.
  [[nodiscard]] std::size_t size() const noexcept;
  [[nodiscard]] bool empty() const noexcept { return size() == 0; }

  /// Elements of an array, values of an object; of anything else none.
  [[nodiscard]] Json* begin() noexcept;
  [[nodiscard]] Json* end() noexcept;
  [[nodiscard]] const Json* begin() const noexcept;
  [[nodiscard]] const Json* end() const noexcept;
  struct Item;
  /// Keys and values of an object, in order. Throws JsonError.
  [[nodiscard]] std::vector<Item> items() const;

  /// As text, its levels indented by so many blanks, or in one line. A number that is not finite is
  /// null; bytes that are no UTF-8 are replaced, as a file name may be any bytes.
  [[nodiscard]] std::string dump(int indent = -1) const;

  /// Numbers are equal by their values.
  friend bool operator==(const Json& a, const Json& b);
  template <typename Number>
  requires std::is_arithmetic_v<Number>
  friend bool operator==(const Json& a, Number b) { return a == Json(b); }
  template <typename Number>
  requires std::is_arithmetic_v<Number>
  friend std::partial_ordering operator<=>(const Json& a, Number b) {
    return a.get<double>() <=> static_cast<double>(b);
  }
  friend std::partial_ordering operator<=>(const Json& a, const Json& b) {
    return a.get<double>() <=> b.get<double>();
  }
  friend std::ostream& operator<<(std::ostream& out, const Json& json);

 private:
  struct Members {
    std::vector<std::string> keys;
    std::vector<Json> values;
  };

  [[nodiscard]] const Json& element(std::size_t index) const;
  void read(bool& value) const;
  void read(double& value) const;
  void read(std::int64_t& value) const;
  void read(std::uint64_t& value) const;
  void read(std::string& value) const;
  template <typename Number>
  requires std::is_arithmetic_v<Number>
  void read(Number& value) const {
    std::conditional_t<
        std::floating_point<Number>, double,
        std::conditional_t<std::signed_integral<Number>, std::int64_t, std::uint64_t>>
        wide{};
    read(wide);
    if constexpr (std::integral<Number>) {
      if (!std::in_range<Number>(wide)) throw JsonError("JSON: " + dump() + " is out of range");
    }
    value = static_cast<Number>(wide);
  }
  void read(Json& value) const { value = *this; }
  template <typename Element>
  void read(std::vector<Element>& value) const {
    check_array();
    for (const Json& element : *this) value.push_back(element.get<Element>());
  }
  template <typename Element, std::size_t size_of_value>
  void read(std::array<Element, size_of_value>& value) const {
    check_array();
    for (std::size_t i = 0; i < size_of_value; ++i) value[i] = at(i).template get<Element>();
  }
  void check_array() const;
  void write(std::string& text, int indent, int depth) const;

  std::variant<std::nullptr_t, bool, std::int64_t, std::uint64_t, double, std::string,
               std::vector<Json>, Members>
      value_;
};

struct Json::Item {
  const std::string& key;
  const Json& value;
};

}  // namespace viewgain::app
