// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include "viewgain/support/file_bytes.hpp"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <cerrno>
#include <map>
#include <mutex>
#include <new>
#include <stdexcept>
#include <system_error>
#include <utility>

#include "viewgain/core/error.hpp"

namespace viewgain {
namespace {

constexpr std::size_t kPart = std::size_t{1} << 20U;  // [bytes]

std::string too_many_bytes(std::uint64_t most) {
  return "the file has more than " + std::to_string(most) + " bytes";
}

/// A regular file or a pipe, open for reading.
class Input {
 public:
  Input(const std::filesystem::path& path, bool may_be_a_pipe) : path_(path) {
    // Checked before opening, because opening a device can have effects.
    struct stat status {};
    if (::stat(path.c_str(), &status) != 0) fail("cannot be opened", errno);
    if (S_ISDIR(status.st_mode)) fail("cannot be read: it is a directory");
    if (!S_ISREG(status.st_mode) && !(may_be_a_pipe && S_ISFIFO(status.st_mode))) {
      fail(may_be_a_pipe ? "cannot be read: it is neither a file nor a pipe"
                         : "cannot be read: it is not a regular file");
    }
    size_ = S_ISREG(status.st_mode) ? static_cast<std::uint64_t>(status.st_size) : 0;
    file_ = ::open(path.c_str(), O_RDONLY | O_CLOEXEC);
    if (file_ < 0) fail("cannot be opened", errno);
  }
  ~Input() { ::close(file_); }
  Input(const Input&) = delete;
  Input& operator=(const Input&) = delete;

  /// Size according to the file system; 0 for pipes and for files in /proc.
  [[nodiscard]] std::uint64_t size() const { return size_; }

  /// The next bytes, at most `count`; fewer only at the end.
  [[nodiscard]] std::size_t read(char* bytes, std::size_t count) {
    std::size_t got = 0;
    while (got < count) {
      const ssize_t part = ::read(file_, bytes + got, count - got);
      if (part < 0 && errno == EINTR) continue;
      if (part < 0) fail("cannot be read", errno);
      if (part == 0) break;
      got += static_cast<std::size_t>(part);
    }
    return got;
  }

  [[noreturn]] void fail(const std::string& what, int error_number = 0) const {
    const std::string why =
        error_number == 0 ? "" : ": " + std::generic_category().message(error_number);
    throw Error(ErrorCode::io, path_.string() + ": " + what + why);
  }
  [[noreturn]] void fail_capacity(const std::string& what) const {
    throw Error(ErrorCode::capacity, path_.string() + ": " + what);
  }

 private:
  const std::filesystem::path& path_;
  std::uint64_t size_ = 0;
  int file_ = -1;
};

std::string bytes_of(Input& input, std::uint64_t most) {
  if (input.size() == 0) most = std::min(most, kMostPipeBytes);
  const auto refuse = [&] { input.fail_capacity(too_many_bytes(most)); };
  if (input.size() > most) refuse();
  try {
    std::string bytes;
    bytes.reserve(static_cast<std::size_t>(input.size()) + 1);  // one more, to detect the end
    for (;;) {
      const std::size_t before = bytes.size(), room = bytes.capacity() - before;
      const std::size_t part = room > 0 ? std::min(room, kPart) : kPart;
      bytes.resize(before + part);
      bytes.resize(before + input.read(bytes.data() + before, part));
      if (bytes.size() > most) refuse();
      if (bytes.size() < before + part) return bytes;
    }
  } catch (const std::bad_alloc&) {
  } catch (const std::length_error&) {
  }
  input.fail_capacity("the file does not fit into memory");
}

std::string read_bytes(const std::filesystem::path& path, std::uint64_t most) {
  Input input(path, true);
  return bytes_of(input, most);
}

/// Contents of pipes, each of which is read once under whatever name.
struct Pipes {
  std::atomic<bool> are_kept = false;
  std::mutex mutex;
  std::map<std::pair<dev_t, ino_t>, std::string> bytes;
} pipes;

}  // namespace

std::string file_bytes(const std::filesystem::path& path, std::uint64_t most) {
  struct stat status {};
  const bool is_kept =
      pipes.are_kept && ::stat(path.c_str(), &status) == 0 && S_ISFIFO(status.st_mode);
  if (!is_kept) return read_bytes(path, most);
  const std::lock_guard lock(pipes.mutex);
  const std::pair key(status.st_dev, status.st_ino);
  auto known = pipes.bytes.find(key);
  if (known == pipes.bytes.end()) {
    known = pipes.bytes.emplace(key, read_bytes(path, most)).first;
  } else if (known->second.size() > most) {
    throw Error(ErrorCode::capacity, path.string() + ": " + too_many_bytes(most));
  }
  return known->second;
}

void keep_bytes_of_pipes() noexcept { pipes.are_kept = true; }

std::string folder_file_bytes(const std::filesystem::path& path, std::uint64_t most) {
  Input input(path, false);
  return bytes_of(input, most);
}

std::string file_head(const std::filesystem::path& path, std::size_t count) {
  Input input(path, false);
  std::string bytes(count, '\0');
  bytes.resize(input.read(bytes.data(), count));
  return bytes;
}

}  // namespace viewgain
