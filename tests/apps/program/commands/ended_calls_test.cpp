// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0

// Calls that end otherwise than well: by signals, on a full disk, with names that are not UTF-8.

#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <csignal>
#include <filesystem>
#include <fstream>
#include <string>
#include <thread>

#include "apps/program_runner.hpp"
#include "viewgain/support/json.hpp"

namespace viewgain {
namespace {

class EndedCalls : public test::ProgramTest {
 protected:
  EndedCalls() {
    write_cube();
    write_half_sensor();
  }

  static Strings simulate(const std::string& out, const std::string& frames = "1") {
    return {"simulate",          "cube.off", "--poses", "orbit:1,0.6,27",
            "--sensor",          "tof.toml", "--size",  "0.2",
            "--place",           "center",   "--out",   out,
            "--frames-per-view", frames};
  }
  static Strings reconstruct(const std::string& out, const std::string& views) {
    return test::joined({"reconstruct", "cube.off", "--sensor", "tof.toml", "--voxel", "0.00625",
                         "--size", "0.2", "--save-maps", "on", "--pictures", "off", "--stop",
                         "gain=0", "--stop", "idle=0", "--json"},
                        {"--stop", "promises=0", "--out", out, "--max-views", views});
  }

  // On stderr, by the last call.
  [[nodiscard]] std::string said() const { return read("../stderr"); }

  // The hidden folder of a call that is writing; empty if there is none.
  [[nodiscard]] fs::path hidden(const std::string& folder) const {
    for (const std::string& name : list(folder)) {
      if (name[0] == '.') return dir / folder / name;
    }
    return {};
  }
};

TEST_F(EndedCalls, SimulateLeavesNothing) {
  const auto before = contents();
  for (const int signal : {SIGINT, SIGTERM, SIGHUP, SIGQUIT}) {
    // Also the folders on the way are not there yet.
    const int status = ended_by(simulate("new/frames", "1000"), signal,
                                [&] { return fs::exists(dir / "new") && !hidden("new").empty(); });
    EXPECT_TRUE(WIFSIGNALED(status) && WTERMSIG(status) == signal) << signal << ": " << status;
    EXPECT_TRUE(contents() == before) << signal;
  }
}

// The processor's time is up.
TEST_F(EndedCalls, ALimitOnTimeEndsACallWithAMessage) {
  const auto before = contents();
  const auto is_writing = [&] { return fs::exists(dir / "new") && !hidden("new").empty(); };
  Strings call = test::joined(simulate("new/frames", "1000"), {"--quiet"});
  call[3] = "orbit:20,0.6,27";  // views enough for more than a second
  const pid_t child = start(call);
  int status = 0;
  while (!is_writing()) {
    ASSERT_EQ(::waitpid(child, &status, WNOHANG), 0);
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  const struct rlimit limit { 1, RLIM_INFINITY };
  ASSERT_EQ(::prlimit(child, RLIMIT_CPU, &limit, nullptr), 0);
  ASSERT_EQ(::waitpid(child, &status, 0), child);
  EXPECT_TRUE(WIFEXITED(status) && WEXITSTATUS(status) == 1) << status;
  EXPECT_EQ(said(), "viewgain: processor time limit reached (ulimit -t)\n");
  EXPECT_TRUE(contents() == before);
}

TEST_F(EndedCalls, ALimitOnTimeIsAWishToStopAsOftenAsItComes) {
  const pid_t child = start(reconstruct("run", "60"));
  int status = 0;
  while (!fs::exists(hidden(".") / "maps/00.vdb")) {
    ASSERT_EQ(::waitpid(child, &status, WNOHANG), 0);
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  for (int i = 0; i < 3; ++i) {
    EXPECT_EQ(::kill(child, SIGXCPU), 0);
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
  }
  ASSERT_EQ(::waitpid(child, &status, 0), child);
  EXPECT_TRUE(WIFEXITED(status) && WEXITSTATUS(status) == 0) << status;
  EXPECT_EQ(json::parse(read("run/run.json"))["stop_reason"], "interrupted");
  const std::string message = "the command stops after this step";
  EXPECT_NE(said().find(message), std::string::npos) << said();
  EXPECT_EQ(said().find(message), said().rfind(message)) << said();
}

TEST_F(EndedCalls, ALimitOnSizesIsAnErrorThatNamesTheFile) {
  run_well(test::joined(simulate("frames"), {"--quiet"}));
  run_well({"integrate", "frames", "--voxel", "0.02", "--out", "map.vdb", "--quiet"});
  // The poses of so many views are over the limit, whatever the images take.
  const auto simulate_many = [](const std::string& out) {
    return Strings{"simulate", "cube.off", "--poses", "orbit:40,0.6,27", "--sensor",
                   "tof.toml", "--size",   "0.2",     "--place",         "center",
                   "--quiet",  "--out",    out};
  };
  struct rlimit before {};
  ASSERT_EQ(::getrlimit(RLIMIT_FSIZE, &before), 0);
  const struct rlimit few { 2000, before.rlim_max };
  ASSERT_EQ(::setrlimit(RLIMIT_FSIZE, &few), 0);  // which a child inherits
  expect_refused({
      {simulate_many("new/frames"), "File too large; "},
      {simulate_many("frames"), "File too large; "},
      {{"integrate", "frames", "--voxel", "0.02", "--out", "map.vdb", "--quiet"},
       "map.vdb: cannot write: File too large; this process may write files of at most 2000 bytes"},
      {{"convert", "map.vdb", "map.ot"}, "map.ot: cannot write: File too large"},
      {{"surface", "map.vdb", "--out", "surface.ply"}, "surface.ply: cannot write: File too large"},
      {{"render", "map.vdb", "map", "--out", "a.png"}, "a.png: cannot write: File too "},
      {{"next", "map.vdb", "--top", "all", "--generator", "sphere", "--out", "poses.txt"},
       "poses.txt: cannot write: File too large"},
  });
  ASSERT_EQ(::setrlimit(RLIMIT_FSIZE, &before), 0);
}

TEST_F(EndedCalls, ASignalThatWasIgnoredStaysSo) {
  int cases = 0;
  for (const int signal : {SIGINT, SIGHUP, SIGTERM, SIGQUIT, SIGXCPU}) {
    const auto old = ::signal(signal, SIG_IGN);  // which a child inherits
    const int status = ended_by(simulate("frames", "20"), signal,
                                [&] { return !hidden(cases == 0 ? "." : "frames").empty(); });
    ::signal(signal, old);
    EXPECT_TRUE(WIFEXITED(status) && WEXITSTATUS(status) == 0) << signal << ": " << status;
    EXPECT_EQ(list("frames").size(), 44U)
        << signal;  // 20 of two images, poses, sensor, layout, mark
    ++cases;
  }
  EXPECT_EQ(cases, 5);
}

// Frames are aligned before any goes into the map, which takes most of such a call's time.
TEST_F(EndedCalls, FramesThatWereAlignedByThenAreKept) {
  run_well({"simulate", "cube.off", "--poses", "orbit:24,0.6,27,0,9", "--sensor", "tof.toml",
            "--size", "0.2", "--place", "center", "--noise", "on", "--out", "frames"});
  const pid_t child = start({"model", "frames", "--voxel", "0.01", "--workspace",
                             "-0.2,-0.2,-0.2,0.2,0.2,0.2", "--register", "on", "--pictures", "off",
                             "--report", "off", "--threads", "1", "--out", "run", "--json"});
  // Some frames' time of the processor, however busy the machine is.
  const auto ticks = [child] {
    std::ifstream file("/proc/" + std::to_string(child) + "/stat");
    std::string word;
    for (int i = 0; i < 14; ++i) file >> word;
    return std::atol(word.c_str());
  };
  while (ticks() < ::sysconf(_SC_CLK_TCK)) {
    std::this_thread::sleep_for(std::chrono::milliseconds(2));
  }
  EXPECT_EQ(::kill(child, SIGINT), 0);
  int status = 0;
  EXPECT_EQ(::waitpid(child, &status, 0), child);
  EXPECT_TRUE(WIFEXITED(status) && WEXITSTATUS(status) == 0) << status;
  const json run = json::parse(read("run/run.json"));
  EXPECT_EQ(run["stop_reason"], "interrupted");
  EXPECT_GE(run["frames"], 1);
  EXPECT_LT(run["frames"], 24);
}

TEST_F(EndedCalls, AKilledRunLeavesTheOneBeforeWhole) {
  ASSERT_EQ(run(reconstruct("run", "2")).exit_code, 0);
  write("run/notes.txt", "mine");
  const auto before = contents("run");
  const auto is_writing = [&] {
    const fs::path folder = hidden("run");
    return !folder.empty() && fs::exists(folder / "maps/01.vdb");
  };
  (void)ended_by(reconstruct("run", "60"), SIGKILL, is_writing);
  const fs::path left = hidden("run");
  ASSERT_FALSE(left.empty());
  auto after = contents("run");
  std::erase_if(after, [](const auto& entry) { return entry.first[0] == '.'; });
  EXPECT_TRUE(after == before);
  // The next run clears that away, and puts itself in the place of the first: one map less.
  ASSERT_EQ(run(reconstruct("run", "1")).exit_code, 0);
  EXPECT_FALSE(fs::exists(left));
  EXPECT_EQ(list("run"), (Strings{"config.toml", "map.vdb", "maps", "notes.txt", "points.ply",
                                  "run.json", "surface.ply", "views.txt"}));
  EXPECT_EQ(list("run/maps"), Strings{"00.vdb"});
}

TEST_F(EndedCalls, NamesThatAreNoUtf8) {
  const std::string name = "lat\xe9";
  fs::copy_file(dir / "cube.off", dir / (name + ".off"));
  Strings arguments = reconstruct(name, "1");
  arguments[1] = name + ".off";
  test::ProgramResult result = run(arguments);
  EXPECT_EQ(result.exit_code, 0) << result.err;
  EXPECT_EQ(json::parse(read(name + "/run.json"))["settings"]["mesh"], "lat\uFFFD.off");

  const std::string frames = name + "_frames", map = name + ".vdb", poses = name + ".txt";
  Strings simulation = simulate(frames);
  simulation.emplace_back("--json");
  for (const auto& [call, out] :
       {std::pair{simulation, frames},
        std::pair{Strings{"integrate", frames, "--voxel", "0.02", "--out", map, "--json"}, map},
        std::pair{Strings{"convert", map, name + ".ot", "--json"}, name + ".ot"},
        std::pair{Strings{"next", map, "--generator", "sphere", "--sensor", "tof.toml", "--out",
                          poses, "--json"},
                  poses}}) {
    result = run(call);
    ASSERT_EQ(result.exit_code, 0) << call[0] << ": " << result.err;
    EXPECT_EQ(json::parse(result.out)["out"], "lat\uFFFD" + out.substr(name.size())) << call[0];
    EXPECT_TRUE(fs::exists(dir / out)) << call[0];
  }
}

TEST_F(EndedCalls, AFullDeviceIsAnError) {
  for (const Strings& arguments : {Strings{"--help"}, Strings{"score", "--help"},
                                   Strings{"--version"}, Strings{"simulate", "--help"}}) {
    const test::ProgramResult result = run_into("/dev/full", arguments);
    EXPECT_EQ(result.exit_code, 1) << arguments[0];
    EXPECT_NE(result.err.find("standard output"), std::string::npos) << result.err;
  }
}

}  // namespace
}  // namespace viewgain
