// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <filesystem>
#include <fstream>
#include <string>
#include <system_error>

#include "viewgain/core/error.hpp"

namespace viewgain::app {

/// The bytes of a regular file. Throws Error(io).
[[nodiscard]] inline std::string file_bytes(const std::filesystem::path& path) {
  std::error_code ignored;
  if (!std::filesystem::is_regular_file(path, ignored)) {
    throw Error(ErrorCode::io, path.string() + ": no such file");
  }
  std::ifstream file(path, std::ios::binary);
  if (!file) throw Error(ErrorCode::io, path.string() + ": cannot be opened");
  // Not by stream buffer iterators, out of which a failed read throws another exception.
  std::string bytes;
  std::array<char, 65536> part;
  do {
    file.read(part.data(), part.size());
    bytes.append(part.data(), static_cast<std::size_t>(file.gcount()));
  } while (file);
  if (file.bad()) throw Error(ErrorCode::io, path.string() + ": cannot be read");
  return bytes;
}

}  // namespace viewgain::app
