// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "viewgain/core/error.hpp"

namespace viewgain {

/// How many letters must be added, taken away, changed or swapped with their neighbour to make one
/// word of the other, no letter being touched again after a swap.
[[nodiscard]] inline std::size_t edits_between(std::string_view a, std::string_view b) {
  std::vector<std::size_t> two_back(b.size() + 1), last(b.size() + 1), row(b.size() + 1);
  for (std::size_t j = 0; j <= b.size(); ++j) row[j] = j;
  for (std::size_t i = 1; i <= a.size(); ++i) {
    std::swap(two_back, last);
    std::swap(last, row);
    row[0] = i;
    for (std::size_t j = 1; j <= b.size(); ++j) {
      row[j] =
          std::min({last[j] + 1, row[j - 1] + 1, last[j - 1] + (a[i - 1] == b[j - 1] ? 0 : 1)});
      if (i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1]) {
        row[j] = std::min(row[j], two_back[j - 2] + 1);
      }
    }
  }
  return row[b.size()];
}

/// The name that was probably meant: the one that fewest edits away, at most one for each three
/// letters, or that begins with what was given; nothing where none is near. Ties to the first.
[[nodiscard]] inline std::optional<std::string> nearest_name(
    std::string_view given, const std::vector<std::string>& names) {
  std::optional<std::string> nearest;
  std::size_t least = std::max<std::size_t>(1, (given.size() + 1) / 3) + 1;
  for (const std::string& name : names) {
    const bool is_begun = given.size() >= 3 && name.starts_with(given);
    const std::size_t edits = is_begun ? 1 : edits_between(given, name);
    if (edits < least) least = edits, nearest = name;
  }
  return nearest;
}

/// "; did you mean NAME?", or nothing.
[[nodiscard]] inline std::string did_you_mean(std::string_view given,
                                              const std::vector<std::string>& names) {
  const std::optional<std::string> nearest = nearest_name(given, names);
  return nearest ? "; did you mean " + *nearest + "?" : std::string();
}

/// "a, b, c"
[[nodiscard]] inline std::string listed(const std::vector<std::string>& names) {
  std::string text;
  for (const std::string& name : names) text.append(text.empty() ? "" : ", ").append(name);
  return text;
}

/// The place of a name among `names`. Throws Error(invalid_argument), naming `what` it should be
/// of, that lists them.
[[nodiscard]] inline std::size_t place_of_name(std::string_view name,
                                               const std::vector<std::string>& names,
                                               std::string_view what) {
  const auto found = std::find(names.begin(), names.end(), name);
  if (found != names.end()) return static_cast<std::size_t>(found - names.begin());
  throw Error(ErrorCode::invalid_argument, std::string("unknown ").append(what).append(" '") +
                                               std::string(name) + "', valid are " + listed(names));
}

}  // namespace viewgain
