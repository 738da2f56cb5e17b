// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0

// Atomic files whose target is a link, a pipe, or open already, and what killed writers leave.

#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <string>
#include <thread>
#include <vector>

#include "expect_error.hpp"
#include "temporary_folder.hpp"
#include "viewgain/support/atomic_file.hpp"

namespace viewgain {
namespace {

namespace fs = std::filesystem;
using test::expect_error;
using test::read_all;
using test::TemporaryFolder;

void put(int file, const std::string& text) {
  ASSERT_EQ(::write(file, text.data(), text.size()), static_cast<ssize_t>(text.size()));
}

// { echo head; viewgain ... --out /dev/stdout; echo tail; } > log, and >> log
TEST(AtomicFile, AnOpenFileIsWrittenThrough) {
  for (const int flags : {O_TRUNC, O_APPEND}) {
    for (const char* const names : {"/dev/fd/", "/proc/self/fd/", "link"}) {
      const TemporaryFolder folder;
      const fs::path log = folder.file("log.txt", flags == O_APPEND ? "before, " : "gone");
      const int file = ::open(log.c_str(), O_WRONLY | O_CLOEXEC | flags);
      ASSERT_GE(file, 0);
      put(file, "head, ");
      fs::path target = names + std::to_string(file);
      if (names == std::string("link")) {
        target = folder.path() / "link";
        fs::create_symlink("/dev/fd/" + std::to_string(file), target);
      }
      write_file_atomically(target, "body, ");
      {
        AtomicFile parts(target);
        parts.write("two ");
        parts.write("parts, ");
        parts.commit();
      }
      put(file, "tail");
      ::close(file);
      EXPECT_EQ(read_all(log),
                std::string(flags == O_APPEND ? "before, " : "") + "head, body, two parts, tail");
      EXPECT_EQ(folder.entries(), names == std::string("link") ? 2 : 1);
    }
  }
}

TEST(AtomicFile, AFileThatIsOpenForReadingIsNoTarget) {
  const TemporaryFolder folder;
  const fs::path input = folder.file("input.txt", "input");
  const int file = ::open(input.c_str(), O_RDONLY | O_CLOEXEC);
  const std::string target = "/dev/fd/" + std::to_string(file);
  expect_error(ErrorCode::io, target + ": cannot write", [&] { AtomicFile{target}; });
  ::close(file);
  expect_error(ErrorCode::io, target + ": cannot write", [&] { AtomicFile{target}; });
  EXPECT_EQ(read_all(input), "input");
  EXPECT_EQ(folder.entries(), 1);
}

TEST(AtomicFile, ALinkToNothingIsFollowed) {
  const TemporaryFolder folder;
  fs::create_directory(folder.path() / "there");
  const fs::path real = folder.path() / "there" / "real.txt";
  fs::create_symlink("there/next.txt", folder.path() / "link.txt");
  fs::create_symlink("real.txt", folder.path() / "there" / "next.txt");
  {
    AtomicFile file(folder.path() / "link.txt");
    EXPECT_EQ(file.temporary_path().parent_path().filename(), "there");
  }
  EXPECT_FALSE(fs::exists(real));
  write_file_atomically(folder.path() / "link.txt", "new");
  EXPECT_TRUE(fs::is_symlink(folder.path() / "link.txt"));
  EXPECT_TRUE(fs::is_symlink(folder.path() / "there" / "next.txt"));
  EXPECT_EQ(read_all(real), "new");

  const fs::path loop = folder.path() / "loop";
  fs::create_symlink("loop", loop);
  expect_error(ErrorCode::io, "loop: cannot write: Too many levels", [&] { AtomicFile{loop}; });
  const fs::path nowhere = folder.path() / "nowhere";
  fs::create_symlink("no/such/folder", nowhere);
  expect_error(ErrorCode::io, "nowhere: cannot write: No such file", [&] { AtomicFile{nowhere}; });
}

TEST(AtomicFile, APipeIsOpenedOnce) {
  const TemporaryFolder folder;
  const fs::path pipe = folder.path() / "pipe";
  ASSERT_EQ(::mkfifo(pipe.c_str(), 0600), 0);
  std::string seen;
  // Reads up to the first end, as `cat` does.
  std::thread reader([&] { seen = read_all(pipe); });
  {
    const AtomicFile unused(pipe);  // whether it can be written: no end for the reader
  }
  AtomicFile file(pipe);
  file.write("one, ");
  file.write("two");
  file.commit();
  reader.join();
  EXPECT_EQ(seen, "one, two");
  EXPECT_TRUE(fs::is_fifo(pipe));
  EXPECT_EQ(folder.entries(), 1);
}

TEST(AtomicFile, WhatAKilledWriterLeftIsRemovedByTheNext) {
  const TemporaryFolder folder;
  const fs::path target = folder.path() / "map.vdb";
  const pid_t child = ::fork();
  if (child == 0) {
    AtomicFile file(target), second(target), other(folder.path() / "other.vdb");
    file.write("half a map");
    ::kill(::getpid(), SIGKILL);
  }
  int status = 0;
  ASSERT_EQ(::waitpid(child, &status, 0), child);
  ASSERT_TRUE(WIFSIGNALED(status));
  EXPECT_EQ(folder.entries(), 3);

  // Names that are nearly such ones, and a writer that is alive.
  const std::string dead = std::to_string(child);
  const std::vector<std::string> foreign{".map.tmp-" + dead + ".vdb",
                                         ".map.tmp-" + dead + "-.vdb",
                                         ".map.tmp-" + dead + "-1.ply",
                                         ".mapp.tmp-" + dead + "-1.vdb",
                                         ".map.tmp-x-1.vdb",
                                         ".map.tmp-0-1.vdb",
                                         "map.tmp-" + dead + "-1.vdb",
                                         ".map.tmp-1-1.vdb"};
  for (const std::string& name : foreign) (void)folder.file(name, "mine");
  AtomicFile alive(target);
  alive.write("alive");
  EXPECT_EQ(folder.entries(), static_cast<std::ptrdiff_t>(foreign.size()) + 2);  // and other's
  write_file_atomically(target, "whole");
  alive.commit();
  EXPECT_EQ(read_all(target), "alive");
  for (const std::string& name : foreign) EXPECT_EQ(read_all(folder.path() / name), "mine") << name;
  EXPECT_EQ(folder.entries(), static_cast<std::ptrdiff_t>(foreign.size()) + 2);
}

}  // namespace
}  // namespace viewgain
