// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include "folders.hpp"

#include <algorithm>
#include <system_error>

#include "viewgain/core/error.hpp"

namespace viewgain {
namespace {

namespace fs = std::filesystem;

void check(const std::error_code& code, const fs::path& path) {
  if (code) throw Error(ErrorCode::io, path.string() + ": " + code.message());
}

}  // namespace

bool is_there(const fs::path& path) {
  std::error_code code;
  const fs::file_status status = fs::status(path, code);
  if (status.type() == fs::file_type::not_found) return false;
  check(code, path);
  return true;
}

std::vector<std::string> names_in(const fs::path& folder) {
  std::vector<std::string> names;
  std::error_code code;
  if (!fs::is_directory(folder, code)) return names;
  fs::directory_iterator entry(folder, code);
  check(code, folder);
  while (entry != fs::directory_iterator()) {
    names.push_back(entry->path().filename().string());
    entry.increment(code);
    check(code, folder);
  }
  std::sort(names.begin(), names.end());
  return names;
}

}  // namespace viewgain
