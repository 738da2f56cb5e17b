// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <sstream>
#include <string>

namespace viewgain::python {

/// The text of a repr(): name=value, name=value.
class Fields {
 public:
  template <typename T>
  Fields& add(const char* name, const T& value) {
    if (!first_) text_ << ", ";
    first_ = false;
    text_ << name << '=' << value;
    return *this;
  }
  [[nodiscard]] std::string in(const char* type) const {
    return std::string(type) + "(" + text_.str() + ")";
  }

 private:
  std::ostringstream text_;
  bool first_ = true;
};

}  // namespace viewgain::python
