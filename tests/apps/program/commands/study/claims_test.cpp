// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0

// Who has which piece of a study.
#include "program/commands/study/claims.hpp"

#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <atomic>
#include <filesystem>
#include <fstream>
#include <string>
#include <thread>
#include <vector>

#include "core/temporary_folder.hpp"

namespace viewgain {
namespace {

namespace fs = std::filesystem;
using test::TemporaryFolder;

class ClaimsTest : public testing::Test {
 protected:
  [[nodiscard]] std::size_t files() const { return static_cast<std::size_t>(own.entries()); }

  TemporaryFolder own;
  const fs::path folder = own.path();
};

TEST_F(ClaimsTest, OneOwnerAPiece) {
  app::Claims mine(folder);
  {
    app::Claims other(folder);
    EXPECT_TRUE(mine.take("a"));
    EXPECT_FALSE(mine.take("a"));
    EXPECT_FALSE(other.take("a"));
    EXPECT_TRUE(other.take("b"));
    other.give_back("a");  // not its own
    EXPECT_FALSE(other.take("a"));
    mine.give_back("a");
    EXPECT_TRUE(other.take("a"));
  }
  EXPECT_EQ(files(), 0U);  // given back
}

// All pieces have files that an owner who is gone has left.
TEST_F(ClaimsTest, ManyThreadsTakeEachPieceOnce) {
  constexpr int kPieces = 200;
  for (int i = 0; i < kPieces; ++i) {
    std::ofstream(folder / (std::to_string(i) + ".claim"));
  }
  app::Claims one(folder), two(folder);
  std::atomic<int> taken{0};
  {
    std::vector<std::jthread> threads;
    for (int t = 0; t < 4; ++t) {
      threads.emplace_back([&, t] {
        for (int i = 0; i < 5 * kPieces; ++i) {
          if ((t % 2 == 0 ? one : two).take(std::to_string(i % kPieces))) ++taken;
        }
      });
    }
  }
  EXPECT_EQ(taken, kPieces);
}

TEST_F(ClaimsTest, OfADeadProcessIsTakenOver) {
  const pid_t child = ::fork();
  if (child == 0) {
    app::Claims claims(folder);
    ::_exit(claims.take("a") ? 0 : 1);  // without a destructor, as if killed
  }
  int status = 0;
  ASSERT_EQ(::waitpid(child, &status, 0), child);
  ASSERT_EQ(status, 0);
  ASSERT_EQ(files(), 1U);
  app::Claims claims(folder);
  EXPECT_TRUE(claims.take("a"));
  EXPECT_FALSE(app::Claims(folder).take("a"));
}

}  // namespace
}  // namespace viewgain
