// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0

// Who has which piece of a study.
#include "program/commands/study/claims.hpp"

#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <atomic>
#include <chrono>
#include <filesystem>
#include <fstream>
#include <string>
#include <thread>
#include <vector>

#include "core/temporary_folder.hpp"

namespace viewgain {
namespace {

namespace fs = std::filesystem;
using test::read_all;
using test::TemporaryFolder;

class ClaimsTest : public testing::Test {
 protected:
  [[nodiscard]] std::size_t files() const { return static_cast<std::size_t>(own.entries()); }
  [[nodiscard]] std::string text(const std::string& name) const { return read_all(folder / name); }

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

// All pieces are of an owner who is gone.
TEST_F(ClaimsTest, ManyThreadsTakeEachPieceOnce) {
  constexpr int kPieces = 200;
  for (int i = 0; i < kPieces; ++i) {
    const fs::path claim = folder / (std::to_string(i) + ".claim");
    std::ofstream(claim) << "elsewhere 0-0 1";
    fs::last_write_time(claim, fs::last_write_time(claim) - std::chrono::seconds(61));
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

TEST_F(ClaimsTest, OfAnotherMachineIsTakenOverWhenItIsOld) {
  std::ofstream(folder / "a.claim") << "elsewhere 0-0 1";
  std::ofstream(folder / "b.claim") << "elsewhere 0-0 1";
  fs::last_write_time(folder / "b.claim",
                      fs::last_write_time(folder / "a.claim") - std::chrono::seconds(61));
  app::Claims claims(folder);
  EXPECT_FALSE(claims.take("a"));
  EXPECT_TRUE(claims.take("b"));
  EXPECT_NE(text("b.claim"), "elsewhere 0-0 1");
}

TEST_F(ClaimsTest, OfAProcessNumberInUseAgainIsTakenOverWhenItIsOld) {
  {
    app::Claims former(folder);
    ASSERT_TRUE(former.take("a"));
    fs::copy_file(folder / "a.claim", folder / "b.claim");  // of this process, which has no such
    fs::copy_file(folder / "a.claim", folder / "c.claim");
  }
  fs::last_write_time(folder / "c.claim",
                      fs::last_write_time(folder / "b.claim") - std::chrono::seconds(61));
  app::Claims claims(folder);
  EXPECT_FALSE(claims.take("b"));
  EXPECT_TRUE(claims.take("c"));
}

TEST_F(ClaimsTest, IsTouchedWhileItsOwnerLives) {
  app::Claims claims(folder);
  ASSERT_TRUE(claims.take("a"));
  const auto old = fs::last_write_time(folder / "a.claim") - std::chrono::seconds(59);
  fs::last_write_time(folder / "a.claim", old);
  const auto end = std::chrono::steady_clock::now() + std::chrono::seconds(20);
  while (fs::last_write_time(folder / "a.claim") == old && std::chrono::steady_clock::now() < end) {
    std::this_thread::sleep_for(std::chrono::milliseconds(50));
  }
  EXPECT_GT(fs::last_write_time(folder / "a.claim"), old + std::chrono::seconds(50));
}

}  // namespace
}  // namespace viewgain
