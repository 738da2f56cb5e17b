// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <vector>

#include "viewgain/core/error.hpp"
#include "viewgain/support/hash64.hpp"

namespace viewgain::python {

// Values as bytes, for to_bytes() and pickles: what they are of, arrays with their lengths, and a
// hash of all that. Numbers are in the machine's byte order; in another one's the hash differs.

[[nodiscard]] inline std::uint64_t hash_of_bytes(std::string_view bytes) {
  Hash64 hash;
  hash.add_bytes(bytes);
  return hash.value();
}

class SealedWriter {
 public:
  explicit SealedWriter(std::string_view kind) : bytes_(kind) {}

  template <typename T>
  void add(const std::vector<T>& values) {
    static_assert(std::is_trivially_copyable_v<T>);
    append(std::uint64_t{values.size()});
    if (!values.empty()) {
      bytes_.append(reinterpret_cast<const char*>(values.data()), values.size() * sizeof(T));
    }
  }
  /// All of it; nothing can be added afterwards.
  [[nodiscard]] const std::string& seal() {
    append(hash_of_bytes(bytes_));
    return bytes_;
  }

 private:
  void append(std::uint64_t number) {
    bytes_.append(reinterpret_cast<const char*>(&number), sizeof number);
  }
  std::string bytes_;
};

/// Throws Error(format) where the bytes are not whole, or of another kind.
class SealedReader {
 public:
  /// `bytes` must live as long; `what` is for messages.
  SealedReader(std::string_view kind, std::string_view bytes, std::string what)
      : what_(std::move(what)), left_(bytes) {
    if (bytes.size() < kind.size() + sizeof(std::uint64_t) || !bytes.starts_with(kind)) refuse();
    left_.remove_suffix(sizeof(std::uint64_t));
    std::uint64_t hash = 0;
    std::memcpy(&hash, bytes.data() + left_.size(), sizeof hash);
    if (hash != hash_of_bytes(left_)) refuse();
    left_.remove_prefix(kind.size());
  }

  template <typename T>
  [[nodiscard]] std::vector<T> next() {
    static_assert(std::is_trivially_copyable_v<T>);
    std::uint64_t count = 0;
    if (left_.size() < sizeof count) refuse();
    std::memcpy(&count, left_.data(), sizeof count);
    left_.remove_prefix(sizeof count);
    if (count > left_.size() / sizeof(T)) refuse();
    std::vector<T> values(static_cast<std::size_t>(count));
    if (!values.empty()) std::memcpy(values.data(), left_.data(), values.size() * sizeof(T));
    left_.remove_prefix(values.size() * sizeof(T));
    return values;
  }
  void require_end() const {
    if (!left_.empty()) refuse();
  }
  [[noreturn]] void refuse() const {
    throw Error(ErrorCode::format, "these bytes are no " + what_ + " that to_bytes() made");
  }

 private:
  std::string what_;
  std::string_view left_;
};

}  // namespace viewgain::python
