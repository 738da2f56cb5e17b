// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <fstream>
#include <string>
#include <string_view>
#include <system_error>

#include "recordings/messages.hpp"
#include "viewgain/core/error.hpp"

namespace viewgain {

/// The largest record, chunk or message that is read into memory [bytes].
inline constexpr std::uint64_t kMostRecordBytes = std::uint64_t{1} << 28U;

/// A regular file, read from the front, one record at a time.
class InputFile {
 public:
  explicit InputFile(const std::filesystem::path& path) : path_(path) {
    std::error_code code;
    if (!std::filesystem::is_regular_file(path, code)) {
      throw Error(ErrorCode::io, path.string() + ": the path is not a regular file");
    }
    size_ = std::filesystem::file_size(path, code);
    in_.open(path, std::ios::binary);
    if (code || !in_) throw Error(ErrorCode::io, path.string() + ": the file cannot be opened");
  }

  [[nodiscard]] std::uint64_t offset() const noexcept { return offset_; }
  [[nodiscard]] std::uint64_t left() const noexcept { return size_ - offset_; }

  /// The next bytes, valid until the next call; at least `count` must be left.
  std::string_view read(std::uint64_t count) {
    if (count > left()) fail("the file ends early");
    if (count > kMostRecordBytes) {
      fail("the record has " + std::to_string(count) + " bytes; the maximum is " +
           std::to_string(kMostRecordBytes));
    }
    buffer_.resize(count);
    in_.read(buffer_.data(), static_cast<std::streamsize>(count));
    if (!in_) throw Error(ErrorCode::io, path_.string() + ": the file cannot be read");
    offset_ += count;
    return buffer_;
  }

  void skip(std::uint64_t count) {
    if (count > left()) fail("the file ends early");
    seek(offset_ + count);
  }
  void seek(std::uint64_t offset) {
    if (offset > size_) fail("the file ends early");
    offset_ = offset;
    in_.seekg(static_cast<std::streamoff>(offset_));
  }

  /// "FILE: byte N: what".
  [[noreturn]] void fail(const std::string& what) const { fail_at(offset_, what); }
  [[noreturn]] void fail_at(std::uint64_t offset, const std::string& what) const {
    throw Error(ErrorCode::format, at(offset, what));
  }
  /// Returns the result of `parse`; adds the file and the record's position to its errors.
  template <typename Parse>
  auto checked(std::uint64_t begin, Parse parse) const {
    try {
      return parse();
    } catch (const Error& error) {
      fail_at(begin, std::string("a damaged record: ") + error.what());
    }
  }
  void warn_of_cut(std::uint64_t begin, Warnings& warnings) const {
    warnings.add(at(begin,
                    "the file ends here, within a record. The recording was interrupted, or the "
                    "file is truncated; the complete records are used"));
  }
  /// `why`: the reason why a chunk could not be unpacked completely.
  void warn_of_chunk(std::uint64_t begin, const std::string& why, Warnings& warnings) const {
    warnings.add(at(begin, "a chunk is damaged: " + why + "; the part before the damage is used"));
  }
  [[nodiscard]] std::string at(std::uint64_t offset, const std::string& what) const {
    return path_.string() + ": byte " + std::to_string(offset) + ": " + what;
  }

 private:
  std::filesystem::path path_;
  std::ifstream in_;
  std::string buffer_;
  std::uint64_t size_ = 0, offset_ = 0;
};

}  // namespace viewgain
