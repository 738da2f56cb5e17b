// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0

// How far a call is: what is said, and where nothing is.
#include "program/cli/progress.hpp"

#include <pty.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <string>
#include <vector>

#include "apps/program_runner.hpp"

namespace viewgain::app {
namespace {

TEST(ProgressText, HasRateAndTimeLeft) {
  EXPECT_EQ(progress_text("frame", 30, 120, 2.5), "frame 30 of 120, 25 %, 12/s, 8 s left");
  EXPECT_EQ(progress_text("pose", 1500, 200'000, 3),
            "pose 1,500 of 200,000, 0 %, 500/s, 397 s left");
  EXPECT_EQ(progress_text("view", 12, 12, 6), "view 12 of 12, 100 %, 2/s, 0 s left");
  EXPECT_EQ(progress_text("view", 0, 12, 6), "view 0 of 12, 0 %");
}

class ProgressLine : public test::ProgramTest {
 protected:
  ProgressLine() {
    write_cube();
    write_half_sensor();
  }

  // What the program writes to stderr where that is a terminal.
  [[nodiscard]] std::string on_a_terminal(const Strings& arguments) const {
    int terminal = -1, other_end = -1;
    if (::openpty(&terminal, &other_end, nullptr, nullptr, nullptr) != 0) return "no terminal";
    std::vector<char*> argv{const_cast<char*>("viewgain")};
    for (const std::string& argument : arguments) {
      argv.push_back(const_cast<char*>(argument.c_str()));
    }
    argv.push_back(nullptr);
    const pid_t child = ::fork();
    if (child == 0) {
      if (::dup2(other_end, STDERR_FILENO) >= 0 && ::chdir(dir.c_str()) == 0 &&
          ::freopen("/dev/null", "w", stdout) != nullptr) {
        ::close(terminal);
        ::close(other_end);
        ::execv(VIEWGAIN_PROGRAM, argv.data());
      }
      ::_exit(127);
    }
    ::close(other_end);
    std::string text;
    std::array<char, 4096> buffer{};
    for (ssize_t n = 0; (n = ::read(terminal, buffer.data(), buffer.size())) > 0;) {
      text.append(buffer.data(), static_cast<std::size_t>(n));
    }
    ::close(terminal);
    int status = 0;
    ::waitpid(child, &status, 0);
    EXPECT_TRUE(WIFEXITED(status) && WEXITSTATUS(status) == 0) << text;
    return text;
  }

  // In views of 20 frames: a call takes no more than 1,000 of a view.
  static Strings simulate(int frames, const Strings& more = {}) {
    return test::joined(
        {"simulate", "cube.off", "--poses", "orbit:" + std::to_string(frames / 20) + ",6,20",
         "--sensor", "tof.toml", "--out", "frames", "--frames-per-view", "20"},
        more);
  }
};

TEST_F(ProgressLine, IsShownOnATerminalAfterASecondAndWiped) {
  // As many frames as take this machine so much more than a second that a rate is known.
  int frames = 60;
  std::string text;
  const auto has_rate = [&] { return text.find(" s left") != std::string::npos; };
  for (; !has_rate() && frames <= 15360; frames *= 2) text = on_a_terminal(simulate(frames));
  EXPECT_NE(text.find("\rframe "), std::string::npos);
  EXPECT_NE(text.find("/s, "), std::string::npos) << text;
  EXPECT_NE(text.find(" s left\033[K"), std::string::npos) << text;
  EXPECT_TRUE(text.ends_with("\r\033[K")) << text;
  EXPECT_EQ(on_a_terminal(simulate(frames / 2, {"--quiet"})), "");
  // Off a terminal nothing is said.
  EXPECT_EQ(run(simulate(frames / 2)).err, "");
}

TEST_F(ProgressLine, ReconstructIsQuietWhenAsked) {
  Strings arguments{"reconstruct", "cube.off",  "--size", "0.2",         "--sensor",   "tof.toml",
                    "--voxel",     "0.00625",   "--out",  "run",         "--pictures", "off",
                    "--json",      "--threads", "2",      "--max-views", "2"};
  EXPECT_NE(run(arguments).err.find("view  1"), std::string::npos);
  arguments.emplace_back("--quiet");
  const test::ProgramResult result = run(arguments);
  EXPECT_EQ(result.err, "");
  EXPECT_NE(result.out.find("per_view"), std::string::npos);
}

}  // namespace
}  // namespace viewgain::app
