// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include "viewgain/support/file_bytes.hpp"

#include <gtest/gtest.h>
#include <sys/stat.h>

#include <csignal>
#include <fstream>
#include <string>
#include <thread>

#include "expect_error.hpp"
#include "temporary_folder.hpp"
#include "viewgain/core/pose_io.hpp"

namespace viewgain {
namespace {

namespace fs = std::filesystem;
using test::expect_error;
using test::TemporaryFolder;

std::string some_bytes(std::size_t count) {
  std::string bytes(count, '\0');
  for (std::size_t i = 0; i < count; ++i) bytes[i] = static_cast<char>(i * 2654435761U >> 13U);
  return bytes;
}

TEST(FileBytes, OfFilesOfAnySize) {
  const TemporaryFolder folder;
  for (const std::size_t size :
       {0U, 1U, 15U, 16U, 4096U, 1U << 20U, (1U << 20U) + 1U, 5'000'000U}) {
    const std::string bytes = some_bytes(size);
    const fs::path path = folder.file("file", bytes);
    EXPECT_EQ(file_bytes(path), bytes);
    EXPECT_EQ(file_bytes(path, size), bytes);
    EXPECT_EQ(file_head(path, 100), bytes.substr(0, 100));
    if (size > 0) {
      expect_error(ErrorCode::capacity, path.string() + ": has more than",
                   [&] { (void)file_bytes(path, size - 1); });
    }
  }
  EXPECT_FALSE(file_bytes("/proc/self/status").empty());  // has a length of 0
}

TEST(FileBytes, OfAPipeUpToALimit) {
  const TemporaryFolder folder;
  const fs::path pipe = folder.path() / "pipe";
  ASSERT_EQ(::mkfifo(pipe.c_str(), 0600), 0);
  const std::string bytes = some_bytes(3'000'000);
  const auto write = [&] { std::ofstream(pipe, std::ios::binary) << bytes; };
  {
    std::thread writer(write);
    EXPECT_EQ(file_bytes(pipe), bytes);
    writer.join();
  }
  // A reader that stops leaves its writer a broken pipe.
  std::signal(SIGPIPE, SIG_IGN);
  std::thread writer(write);
  expect_error(ErrorCode::capacity, "more than 2000000 bytes",
               [&] { (void)file_bytes(pipe, 2'000'000); });
  writer.join();
  std::signal(SIGPIPE, SIG_DFL);
}

TEST(FileBytes, RefusesWhatHasNoEndOrIsNoFile) {
  const TemporaryFolder folder;
  const fs::path endless = folder.path() / "poses.txt";
  fs::create_symlink("/dev/zero", endless);
  expect_error(ErrorCode::io, "poses.txt: cannot be read: it is neither a file nor a pipe",
               [&] { (void)file_bytes(endless); });
  expect_error(ErrorCode::io, "neither a file nor a pipe", [&] { (void)file_head(endless, 10); });
  expect_error(ErrorCode::io, "neither a file nor a pipe", [&] { (void)read_tum(endless); });
  expect_error(ErrorCode::io, "is a directory", [&] { (void)file_bytes(folder.path()); });
  expect_error(ErrorCode::io, "No such file", [&] { (void)file_bytes(folder.path() / "none"); });
  // Larger than any file that is meant, though it takes no room on the disk.
  const fs::path sparse = folder.file("sparse", "");
  fs::resize_file(sparse, std::uintmax_t{1} << 40U);
  expect_error(ErrorCode::capacity, "sparse: has more than 17179869184 bytes",
               [&] { (void)file_bytes(sparse); });
}

}  // namespace
}  // namespace viewgain
