// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gtest/gtest.h>

#include <clocale>
#include <cstdlib>
#include <locale>
#include <string>

namespace viewgain::test {

struct CommaPunctuation : std::numpunct<char> {
  char do_decimal_point() const override { return ','; }
  char do_thousands_sep() const override { return '.'; }
  std::string do_grouping() const override { return "\3"; }
};

/// Commas for decimals in C++ streams always, in the C library where there is such a locale, as
/// tests/run.sh makes one; a test that has none where CI is set fails.
class CommaLocale {
 public:
  CommaLocale() : old_(std::locale::global(std::locale(std::locale(), new CommaPunctuation))) {
    bool found = false;
    for (const char* name : {"de_DE.UTF-8", "de_DE.utf8", "de_DE", "fr_FR.UTF-8"}) {
      if ((found = std::setlocale(LC_NUMERIC, name) != nullptr)) break;
    }
    if (!found && std::getenv("CI") != nullptr) ADD_FAILURE() << "no locale with decimal commas";
  }
  ~CommaLocale() {
    std::locale::global(old_);
    std::setlocale(LC_NUMERIC, "C");
  }

 private:
  std::locale old_;
};

}  // namespace viewgain::test
