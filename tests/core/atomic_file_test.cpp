// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0

#include "viewgain/support/atomic_file.hpp"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <sys/syscall.h>
#include <sys/wait.h>
#include <unistd.h>

#include <atomic>
#include <csignal>
#include <fstream>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include "expect_error.hpp"
#include "temporary_folder.hpp"

namespace {
std::atomic<int> files_synced{0}, folders_synced{0};
}  // namespace

// In the place of the C library's.
extern "C" int fsync(int file) {
  struct stat status {};
  if (::fstat(file, &status) == 0) ++(S_ISDIR(status.st_mode) ? folders_synced : files_synced);
  return static_cast<int>(::syscall(SYS_fsync, file));
}

namespace viewgain {
namespace {

namespace fs = std::filesystem;
using test::expect_error;
using test::read_all;
using test::TemporaryFolder;

TEST(AtomicFile, AppearsOnlyWithCommit) {
  const TemporaryFolder folder;
  const fs::path target = folder.path() / "map.vdb";
  {
    AtomicFile file(target);
    EXPECT_EQ(file.temporary_path().parent_path(), folder.path());
    EXPECT_EQ(file.temporary_path().extension(), ".vdb");
    EXPECT_TRUE(fs::exists(file.temporary_path()));
    // By which writers elsewhere know that it is in use.
    const int other = ::open(file.temporary_path().c_str(), O_WRONLY | O_CLOEXEC);
    EXPECT_NE(::flock(other, LOCK_EX | LOCK_NB), 0);
    ::close(other);
    file.write("one, ");
    file.write("");
    file.write("two");
    EXPECT_FALSE(fs::exists(target));
    file.commit();
    EXPECT_EQ(read_all(target), "one, two");
  }
  EXPECT_EQ(read_all(target), "one, two");
  EXPECT_EQ(folder.entries(), 1);
}

TEST(AtomicFile, ReachesTheDiskWithItsFolder) {
  const TemporaryFolder folder;
  const int files = files_synced, folders = folders_synced;
  write_file_atomically(folder.path() / "map.vdb", "whole");
  EXPECT_EQ(files_synced - files, 1);
  EXPECT_EQ(folders_synced - folders, 1);
}

TEST(AtomicFile, WithoutCommitNothingChanges) {
  const TemporaryFolder folder;
  const fs::path target = folder.file("scores.csv", "old");
  {
    AtomicFile file(target);
    file.write("half a");
  }
  EXPECT_EQ(read_all(target), "old");
  EXPECT_EQ(folder.entries(), 1);
  try {
    AtomicFile file(target);
    throw std::runtime_error("writer failed");
  } catch (const std::runtime_error&) {
  }
  EXPECT_EQ(folder.entries(), 1);
}

TEST(AtomicFile, TemporaryFilesOfAProgramThatIsEndedAreRemoved) {
  const TemporaryFolder folder;
  const fs::path done = folder.path() / "done.csv";
  const pid_t child = ::fork();
  if (child == 0) {
    std::signal(SIGTERM, [](int) {
      remove_temporary_files();
      ::_exit(7);
    });
    AtomicFile first(folder.path() / "map.vdb"), second(folder.path() / "scores.csv"), third(done);
    { const AtomicFile gone(folder.path() / "gone.csv"); }
    first.write("half a");
    third.commit();
    std::raise(SIGTERM);
    ::_exit(1);
  }
  int status = 0;
  ASSERT_EQ(::waitpid(child, &status, 0), child);
  EXPECT_TRUE(WIFEXITED(status) && WEXITSTATUS(status) == 7);
  EXPECT_TRUE(fs::exists(done));
  EXPECT_EQ(folder.entries(), 1);

  // More than are listed, and some that were removed already: nothing goes wrong.
  std::vector<std::unique_ptr<AtomicFile>> many;
  for (int i = 0; i < 70; ++i) {
    many.push_back(std::make_unique<AtomicFile>(folder.path() / std::to_string(i)));
  }
  EXPECT_EQ(folder.entries(), 71);
  remove_temporary_files();
  EXPECT_EQ(folder.entries(), 7);
  AtomicFile later(folder.path() / "later");
  many.clear();
  EXPECT_EQ(folder.entries(), 2);
  later.commit();
  EXPECT_TRUE(fs::exists(folder.path() / "later"));
}

TEST(AtomicFile, AnotherWriterMayWriteByName) {
  const TemporaryFolder folder;
  const fs::path target = folder.file("a.png", "old");
  AtomicFile file(target);
  std::ofstream(file.temporary_path(), std::ios::trunc) << "picture";
  file.commit();
  EXPECT_EQ(read_all(target), "picture");
  EXPECT_EQ(folder.entries(), 1);
}

TEST(AtomicFile, RefusesWhatCannotBeWritten) {
  const TemporaryFolder folder;
  const fs::path nowhere = folder.path() / "no" / "such" / "file";
  expect_error(ErrorCode::io, nowhere.string(), [&] { AtomicFile{nowhere}; });
  expect_error(ErrorCode::io, "No such file", [&] { AtomicFile{nowhere}; });
  expect_error(ErrorCode::io, "directory", [&] { AtomicFile{folder.path()}; });
  expect_error(ErrorCode::io, "directory", [&] { AtomicFile{folder.path() / "new" / ""}; });
  expect_error(ErrorCode::io, "without a name", [&] { AtomicFile{fs::path()}; });
  expect_error(ErrorCode::io, "too long",
               [&] { AtomicFile{folder.path() / std::string(300, 'x')}; });
  EXPECT_EQ(folder.entries(), 0);
}

TEST(AtomicFile, CommitFailsIfTheTargetBecameAFolder) {
  const TemporaryFolder folder;
  const fs::path target = folder.path() / "target";
  {
    AtomicFile file(target);
    fs::create_directories(target / "inside");
    expect_error(ErrorCode::io, target.string(), [&] { file.commit(); });
  }
  EXPECT_EQ(folder.entries(), 1);
}

TEST(AtomicFile, ALinkStaysALink) {
  const TemporaryFolder folder;
  const fs::path real = folder.file("real.txt", "old");
  const fs::path link = folder.path() / "link.txt";
  fs::create_symlink(real, link);
  write_file_atomically(link, "new");
  EXPECT_TRUE(fs::is_symlink(link));
  EXPECT_EQ(read_all(real), "new");
  EXPECT_EQ(folder.entries(), 2);
}

TEST(AtomicFile, ADeviceIsWrittenInPlace) {
  write_file_atomically("/dev/null", "nothing");
  EXPECT_TRUE(fs::is_character_file("/dev/null"));
}

TEST(AtomicFile, ManyWritersOfOneTargetNeverMix) {
  const TemporaryFolder folder;
  // It is there from the start, so that whoever looks sees a whole file.
  const fs::path target = folder.file("shared.txt", std::string(10'000, 'z'));
  std::vector<std::thread> writers;
  for (int w = 0; w < 8; ++w) {
    writers.emplace_back([&target, w] {
      const std::string contents(10'000, static_cast<char>('a' + w));
      for (int i = 0; i < 20; ++i) write_file_atomically(target, contents);
    });
  }
  int whole = 0;
  for (int look = 0; look < 200; ++look) {
    const std::string seen = read_all(target);
    whole += seen == std::string(10'000, seen.empty() ? '?' : seen[0]);
  }
  for (std::thread& writer : writers) writer.join();
  EXPECT_EQ(whole, 200);
  const std::string seen = read_all(target);
  EXPECT_EQ(seen, std::string(10'000, seen.empty() ? '?' : seen[0]));
  EXPECT_EQ(folder.entries(), 1);
}

// Atomic files whose target is a link, a pipe, or open already, and what killed writers leave.

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
