// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include "viewgain/support/atomic_file.hpp"

#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <fstream>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include "expect_error.hpp"
#include "temporary_folder.hpp"

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

}  // namespace
}  // namespace viewgain
