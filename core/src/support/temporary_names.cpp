// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include "viewgain/support/temporary_names.hpp"

#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <charconv>
#include <system_error>
#include <utility>

#include "viewgain/support/hash64.hpp"

namespace viewgain {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kMostNameBytes = 255;   // in most of Linux's file systems
constexpr std::size_t kMostNumberBytes = 21;  // PROCESS-COUNTER, of 10 digits each

// Some file systems allow less. Those that report more count other units than bytes.
std::size_t most_name_bytes(const fs::path& folder) {
  const long most = ::pathconf(folder.empty() ? "." : folder.c_str(), _PC_NAME_MAX);
  return most > 0 ? std::min(static_cast<std::size_t>(most), kMostNameBytes) : kMostNameBytes;
}

std::string prefix_of(const std::string& name) {
  // Appended piece by piece, because GCC 12 wrongly warns of overlap if a literal comes first in a
  // sum.
  std::string prefix(1, '.');
  return prefix.append(name).append(".tmp-");
}

}  // namespace

TemporaryNames::TemporaryNames(const fs::path& target, std::string stem, std::string ending)
    : folder_(target.parent_path()), prefix_(prefix_of(stem)), ending_(std::move(ending)) {
  const std::size_t most = most_name_bytes(folder_);
  const auto fits = [&] { return prefix_.size() + kMostNumberBytes + ending_.size() <= most; };
  if (fits()) return;
  prefix_ = prefix_of(hash_of(target.filename().string()));
  if (!fits()) ending_.clear();
}

TemporaryNames TemporaryNames::of_file(const fs::path& target) {
  return {target, target.stem().string(), target.extension().string()};
}

TemporaryNames TemporaryNames::of_folder(const fs::path& target) {
  return {target, target.filename().string(), ""};
}

fs::path TemporaryNames::next() const {
  static std::atomic<unsigned> counter{0};
  return folder_ / (prefix_ + std::to_string(::getpid()) + "-" +
                    std::to_string(counter.fetch_add(1)) + ending_);
}

pid_t TemporaryNames::writer_of(std::string_view name) const {
  if (name.size() < prefix_.size() + ending_.size() || !name.starts_with(prefix_) ||
      !name.ends_with(ending_)) {
    return 0;
  }
  name.remove_prefix(prefix_.size());
  name.remove_suffix(ending_.size());
  const char* const end = name.data() + name.size();
  pid_t process = 0;
  const auto number = std::from_chars(name.data(), end, process);
  if (number.ec != std::errc{} || process <= 0 || number.ptr == end || *number.ptr != '-') return 0;
  unsigned count = 0;
  const auto rest = std::from_chars(number.ptr + 1, end, count);
  return rest.ec == std::errc{} && rest.ptr == end ? process : 0;
}

}  // namespace viewgain
