// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include "viewgain/support/file_names.hpp"

#include <algorithm>
#include <system_error>

#include "viewgain/core/error.hpp"
#include "viewgain/support/atomic_file.hpp"

namespace viewgain {

std::string small_ending(const std::filesystem::path& path) {
  std::string text = path.extension().string();
  std::transform(text.begin(), text.end(), text.begin(), [](char c) {
    return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
  });
  return text;
}

bool is_special_file(const std::filesystem::path& path) {
  std::error_code ignored;
  const std::filesystem::file_status status = std::filesystem::status(path, ignored);
  return is_open_file(path) ||
         (std::filesystem::exists(status) && !std::filesystem::is_regular_file(status) &&
          !std::filesystem::is_directory(status));
}

std::string fault_of_ending(const std::filesystem::path& path, std::string_view what,
                            std::initializer_list<std::string_view> endings) {
  const std::string ending = small_ending(path);
  if (std::find(endings.begin(), endings.end(), ending) != endings.end() || is_special_file(path)) {
    return "";
  }
  std::string fault = std::string(what) + " must have the ending ";
  std::size_t left = endings.size();
  for (const std::string_view one : endings) {
    fault += one;
    if (--left > 0) fault += left > 1 ? ", " : " or ";
  }
  return fault;
}

void require_ending(const std::filesystem::path& path, std::string_view what,
                    std::initializer_list<std::string_view> endings) {
  const std::string fault = fault_of_ending(path, what, endings);
  if (!fault.empty()) refuse(path.string() + ": " + fault);
}

}  // namespace viewgain
