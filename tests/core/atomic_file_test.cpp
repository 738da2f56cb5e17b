// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0

#include "viewgain/support/atomic_file.hpp"

#include <fcntl.h>
#include <grp.h>
#include <gtest/gtest.h>
#include <sys/file.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <csignal>
#include <fstream>
#include <functional>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include "expect_error.hpp"
#include "temporary_folder.hpp"
#include "viewgain/support/synced_together.hpp"

namespace {
std::atomic<int> files_synced{0}, folders_synced{0}, disks_synced{0};
std::atomic<bool> can_sync_files = true, can_sync_disks = true;
}  // namespace

// In the place of the C library's; the disk itself is not waited for.
extern "C" int fsync(int file) {
  struct stat status {};
  if (::fstat(file, &status) == 0) ++(S_ISDIR(status.st_mode) ? folders_synced : files_synced);
  if (can_sync_files) return 0;
  errno = EIO;
  return -1;
}
extern "C" int syncfs(int) noexcept {
  ++disks_synced;
  if (can_sync_disks) return 0;
  errno = EIO;
  return -1;
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

// What a child does in a process of its own; its exit code.
int in_a_child(const std::function<void()>& work) {
  const pid_t child = ::fork();
  if (child == 0) {
    work();
    ::_exit(testing::Test::HasFailure() ? 1 : 0);
  }
  int status = 0;
  EXPECT_EQ(::waitpid(child, &status, 0), child);
  return WIFEXITED(status) ? WEXITSTATUS(status) : 128;
}

// Modes and groups.

mode_t mode_of(const fs::path& file) {
  struct stat status {};
  EXPECT_EQ(::stat(file.c_str(), &status), 0) << file;
  return status.st_mode & 07777U;
}

TEST(AtomicFile, WhatReplacesAFileHasItsMode) {
  const mode_t before = ::umask(0);
  int cases = 0;
  for (const mode_t umask : {022U, 077U, 002U, 0U}) {
    ::umask(umask);
    for (const mode_t mode : {0600U, 0640U, 0660U, 0664U, 0644U, 0666U, 0400U, 0444U, 0755U}) {
      const TemporaryFolder folder;
      const fs::path target = folder.file("map.vdb", "old"), link = folder.path() / "link";
      fs::create_symlink("map.vdb", link);
      for (const fs::path& name : {target, link}) {
        ASSERT_EQ(::chmod(target.c_str(), mode), 0);
        AtomicFile file(name);
        EXPECT_EQ(mode_of(file.temporary_path()) & 077U, 0U);  // nobody else's
        file.write("new");
        file.commit();
        EXPECT_EQ(mode_of(target), mode) << std::oct << umask;
        EXPECT_EQ(read_all(target), "new");
        ++cases;
      }
      write_file_atomically(folder.path() / "new", "new");
      EXPECT_EQ(mode_of(folder.path() / "new"), 0666U & ~umask);
    }
  }
  ::umask(before);
  EXPECT_EQ(cases, 72);
}

// Only root has another group for sure.
TEST(AtomicFile, WhatReplacesAFileHasItsGroupOrGivesNobodyMore) {
  constexpr gid_t kOther = 4321;
  constexpr uid_t kNobody = 65534;
  const TemporaryFolder folder;
  ASSERT_EQ(::chmod(folder.path().c_str(), 0777), 0);
  const fs::path target = folder.file("map.vdb", "old");
  if (::geteuid() != 0 || ::chown(target.c_str(), kNobody, kOther) != 0) {
    GTEST_SKIP() << "needs another group and user";
  }
  const auto set_and_write = [&](mode_t mode, bool as_root) {
    ASSERT_EQ(::chown(target.c_str(), 0, kOther), 0);
    ASSERT_EQ(::chmod(target.c_str(), mode), 0);
    EXPECT_EQ(in_a_child([&] {
                if (!as_root) {
                  EXPECT_EQ(::setgroups(0, nullptr), 0);
                  EXPECT_EQ(::setgid(kNobody), 0);
                  EXPECT_EQ(::setuid(kNobody), 0);
                }
                write_file_atomically(target, "new");
              }),
              0);
  };
  struct stat status {};
  set_and_write(0640, true);
  ASSERT_EQ(::stat(target.c_str(), &status), 0);
  EXPECT_EQ(status.st_gid, kOther);
  EXPECT_EQ(mode_of(target), 0640U);
  int cases = 0;
  for (const auto& [mode, kept] : {std::pair<mode_t, mode_t>{0640, 0600},
                                   {0660, 0600},
                                   {0664, 0644},
                                   {0666, 0666},
                                   {0600, 0600}}) {
    set_and_write(mode, false);
    ASSERT_EQ(::stat(target.c_str(), &status), 0);
    EXPECT_EQ(status.st_gid, kNobody);
    EXPECT_EQ(mode_of(target), kept) << std::oct << mode;
    ++cases;
  }
  EXPECT_EQ(cases, 5);
}

// Names up to the limit of the file system.

TEST(AtomicFile, NamesMayBeAsLongAsTheFileSystemAllows) {
  const TemporaryFolder folder;
  const auto most = static_cast<std::size_t>(::pathconf(folder.path().c_str(), _PC_NAME_MAX));
  ASSERT_GE(most, 100U);
  int cases = 0;
  // Those from which on the name, the ending or both leave no room for more.
  for (const std::size_t less : {60U, 32U, 28U, 27U, 26U, 25U, 21U, 20U, 19U, 4U, 1U, 0U}) {
    const std::size_t size = most - less;
    for (const std::string& ending : {std::string(".vdb"), std::string(),
                                      "." + std::string(size - 2, 'e'), std::string(".\xc3\xa9")}) {
      const std::string name = std::string(size - ending.size(), 'x') + ending;
      const fs::path target = folder.path() / name;
      // What a killed writer leaves goes with the next.
      EXPECT_EQ(in_a_child([&] {
                  AtomicFile file(target), second(target);
                  file.write("half a map");
                  ::kill(::getpid(), SIGKILL);
                }),
                128);
      EXPECT_EQ(folder.entries(), 2) << name;
      write_file_atomically(target, "whole");
      EXPECT_EQ(folder.entries(), 1) << name;
      write_file_atomically(target, "anew");
      EXPECT_EQ(read_all(target), "anew");
      fs::remove(target);
      ++cases;
    }
  }
  EXPECT_EQ(cases, 48);
  // Two long names that differ in one byte are two targets.
  const fs::path one = folder.path() / (std::string(most - 1, 'x') + "1");
  const fs::path two = folder.path() / (std::string(most - 1, 'x') + "2");
  EXPECT_EQ(in_a_child([&] {
              const AtomicFile file(one);
              ::kill(::getpid(), SIGKILL);
            }),
            128);
  write_file_atomically(two, "two");
  EXPECT_EQ(folder.entries(), 2);
  expect_error(ErrorCode::io, "too long",
               [&] { AtomicFile{folder.path() / std::string(most + 1, 'x')}; });
}

TEST(AtomicFile, AFileOverTheLimitOnSizesIsNamed) {
  const TemporaryFolder folder;
  const fs::path target = folder.file("map.vdb", "old");
  EXPECT_EQ(in_a_child([&] {
              std::signal(SIGXFSZ, SIG_IGN);  // as the program and Python do
              const struct rlimit limit { 1000, 1000 };
              EXPECT_EQ(::setrlimit(RLIMIT_FSIZE, &limit), 0);
              write_file_atomically(target, std::string(1000, 'x'));
              expect_error(ErrorCode::io, target.string() + ": cannot write: File too large; ",
                           [&] { write_file_atomically(target, std::string(1001, 'x')); });
              expect_error(ErrorCode::io, "at most 1000 bytes (ulimit -f)",
                           [&] { write_file_atomically(target, std::string(1001, 'x')); });
            }),
            0);
  EXPECT_EQ(read_all(target), std::string(1000, 'x'));
  EXPECT_EQ(folder.entries(), 1);
}

// Folders that are synced as a whole.

TEST(SyncedTogether, FilesAreSyncedAtOnceAndNotOneByOne) {
  const TemporaryFolder folder;
  fs::create_directory(folder.path() / "in");
  fs::create_directory(folder.path() / "inside");
  const fs::path left = folder.file("in/.a.tmp-999999999-0.txt", "left");
  {
    const SyncedTogether synced(folder.path() / "in");
    const int files = files_synced, folders = folders_synced, disks = disks_synced;
    fs::create_directory(folder.path() / "in/below");
    for (const char* name : {"in/a.txt", "in/b.txt", "in/below/c.txt"}) {
      write_file_atomically(folder.path() / name, "whole");
    }
    EXPECT_EQ(files_synced - files, 0);
    EXPECT_EQ(folders_synced - folders, 0);
    EXPECT_TRUE(fs::exists(left));                                   // nobody has looked for it
    write_file_atomically(folder.path() / "inside/a.txt", "whole");  // of a name that begins so
    EXPECT_EQ(files_synced - files, 1);
    AtomicFile own(folder.path() / "in/own.txt");
    own.sync();
    own.commit();
    EXPECT_EQ(files_synced - files, 2);
    EXPECT_EQ(disks_synced - disks, 0);
    synced.sync();
    EXPECT_EQ(disks_synced - disks, 1);
    EXPECT_EQ(files_synced - files, 2);
  }
  const int files = files_synced;
  write_file_atomically(folder.path() / "in/a.txt", "anew");
  EXPECT_EQ(files_synced - files, 1);
  EXPECT_FALSE(fs::exists(left));
}

TEST(SyncedTogether, AFailureOfTheDiskIsLookedForFileByFile) {
  const TemporaryFolder folder;
  const SyncedTogether synced(folder.path());
  fs::create_directory(folder.path() / "below");
  for (const char* name : {"a.txt", "below/b.txt"}) {
    write_file_atomically(folder.path() / name, "whole");
  }
  const int files = files_synced, folders = folders_synced;
  can_sync_disks = false;
  EXPECT_NO_THROW(synced.sync());  // it was somebody else's
  EXPECT_EQ(files_synced - files, 2);
  EXPECT_EQ(folders_synced - folders, 2);
  can_sync_files = false;
  expect_error(ErrorCode::io, ": cannot write: Input/output error", [&] { synced.sync(); });
  can_sync_disks = can_sync_files = true;
}

}  // namespace
}  // namespace viewgain
