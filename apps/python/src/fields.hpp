// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "viewgain/support/text.hpp"

namespace viewgain::python {

/// The text of a repr(): name=value, name=value.
class Fields {
 public:
  Fields& add(const char* name, double value) {
    if (!text_.empty()) text_ += ", ";
    text_.append(name).append("=").append(short_text(value));
    return *this;
  }
  [[nodiscard]] std::string in(const char* type) const {
    return std::string(type) + "(" + text_ + ")";
  }

 private:
  std::string text_;
};

}  // namespace viewgain::python
