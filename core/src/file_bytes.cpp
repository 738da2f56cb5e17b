// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include "viewgain/core/file_bytes.hpp"

#include <array>
#include <fstream>
#include <system_error>

#include "viewgain/core/error.hpp"

namespace viewgain {

std::string file_bytes(const std::filesystem::path& path) {
  std::error_code code;
  if (std::filesystem::is_directory(path, code)) {
    throw Error(ErrorCode::io, path.string() + ": cannot be read: it is a directory");
  }
  std::ifstream file(path, std::ios::binary);
  if (!file) throw Error(ErrorCode::io, path.string() + ": cannot be opened");
  // Formatted and unformatted input catch what the buffer throws when a read fails; its iterators
  // do not.
  std::string bytes;
  std::array<char, 65536> part;
  do {
    file.read(part.data(), part.size());
    bytes.append(part.data(), static_cast<std::size_t>(file.gcount()));
  } while (file);
  if (file.bad()) throw Error(ErrorCode::io, path.string() + ": cannot be read");
  return bytes;
}

}  // namespace viewgain
