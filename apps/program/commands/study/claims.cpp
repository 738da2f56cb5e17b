// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include "program/commands/study/claims.hpp"

#include <fcntl.h>
#include <signal.h>
#include <sys/stat.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <chrono>
#include <condition_variable>
#include <cstring>
#include <fstream>
#include <sstream>
#include <stop_token>
#include <system_error>
#include <utility>

#include "viewgain/core/error.hpp"

namespace viewgain::app {
namespace {

namespace fs = std::filesystem;
using namespace std::chrono_literals;

constexpr auto kTouched = 5s, kAbandoned = 60s;

std::string text_of(const fs::path& file) {
  std::ifstream stream(file);
  std::ostringstream text;
  text << stream.rdbuf();
  return text.str();
}

// A name of this machine that no other has and that changes when it starts anew.
std::string machine() {
  std::array<char, 256> host{};
  ::gethostname(host.data(), host.size() - 1);
  std::string boot = text_of("/proc/sys/kernel/random/boot_id");
  if (!boot.empty() && boot.back() == '\n') boot.pop_back();
  return std::string(host.data()) + " " + boot;
}

// By the clock of the file system, which the machines share.
fs::file_time_type now_at(const fs::path& folder, const std::string& owner) {
  std::string name = ".clock-" + owner;
  for (char& c : name) {
    if (c == ' ' || c == '/') c = '-';
  }
  const fs::path file = folder / name;
  std::ofstream(file) << "\n";
  std::error_code ignored;
  const fs::file_time_type now = fs::last_write_time(file, ignored);
  fs::remove(file, ignored);
  return now;
}

}  // namespace

Claims::Claims(fs::path folder)
    : folder_(std::move(folder)),
      owner_(machine() + " " + std::to_string(::getpid())),
      toucher_([this](const std::stop_token& stop) {
        std::mutex mutex;
        std::condition_variable_any waiting;
        std::unique_lock lock(mutex);
        while (!waiting.wait_for(lock, stop, kTouched, [] { return false; }) &&
               !stop.stop_requested()) {
          touch_all();
        }
      }) {}

Claims::~Claims() {
  toucher_.request_stop();
  toucher_.join();
  for (const std::string& piece : std::set<std::string>(taken_)) give_back(piece);
}

fs::path Claims::file_of(const std::string& piece) const { return folder_ / (piece + ".claim"); }

void Claims::touch_all() {
  const std::lock_guard lock(mutex_);
  for (const std::string& piece : taken_) {
    ::utimensat(AT_FDCWD, file_of(piece).c_str(), nullptr, 0);
  }
}

bool Claims::is_abandoned(const fs::path& file) const {
  const std::string owner = text_of(file);
  const std::size_t at = owner.rfind(' ');
  if (at != std::string::npos && owner.substr(0, at) == machine()) {
    const pid_t process = static_cast<pid_t>(std::atol(owner.c_str() + at + 1));
    if (process > 0 && ::kill(process, 0) != 0 && errno == ESRCH) return true;
    // It may be another process by now.
  }
  return is_old(file);
}

bool Claims::is_old(const fs::path& file) const {
  std::error_code failed;
  const fs::file_time_type touched = fs::last_write_time(file, failed);
  return !failed && now_at(folder_, owner_) - touched > kAbandoned;
}

bool Claims::take(const std::string& piece) {
  const fs::path file = file_of(piece);
  for (int attempt = 0; attempt < 2; ++attempt) {
    const int descriptor = ::open(file.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
    if (descriptor >= 0) {
      const ssize_t written = ::write(descriptor, owner_.data(), owner_.size());
      ::close(descriptor);
      if (written == static_cast<ssize_t>(owner_.size())) {
        const std::lock_guard lock(mutex_);
        taken_.insert(piece);
        return true;
      }
      ::unlink(file.c_str());
      throw Error(ErrorCode::io, file.string() + ": cannot be written");
    }
    if (errno != EEXIST) {
      throw Error(ErrorCode::io, file.string() + ": cannot be made: " + std::strerror(errno));
    }
    if (!remove_abandoned(file)) return false;
  }
  return false;
}

// Of several who find a claim abandoned one alone may remove it: what another finds there later
// may be a new one.
bool Claims::remove_abandoned(const fs::path& claim) const {
  if (!is_abandoned(claim)) return false;
  const fs::path lock = claim.string() + ".abandoned";
  const int descriptor = ::open(lock.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
  if (descriptor < 0) {
    if (is_old(lock)) ::unlink(lock.c_str());  // who held it is gone; next time
    return false;
  }
  ::close(descriptor);
  const bool is_removed = is_abandoned(claim) && ::unlink(claim.c_str()) == 0;
  ::unlink(lock.c_str());
  return is_removed;
}

void Claims::clear_abandoned(const std::string& piece) {
  if (fs::exists(file_of(piece)) && take(piece)) give_back(piece);
}

void Claims::give_back(const std::string& piece) {
  const std::lock_guard lock(mutex_);
  if (taken_.erase(piece) > 0) ::unlink(file_of(piece).c_str());
}

}  // namespace viewgain::app
