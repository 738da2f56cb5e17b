// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0

// `viewgain study` as a user calls it.
#include <signal.h>
#include <sys/wait.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <sstream>
#include <string>
#include <vector>

#include "apps/program_runner.hpp"
#include "viewgain/core/pose_io.hpp"
#include "viewgain/support/json.hpp"

namespace viewgain {
namespace {

class Study : public test::ProgramTest {
 protected:
  Study() {
    write_cube();
    write_half_sensor();
    write("spec.toml", R"(objects = ["cube.off"]
policies = ["gain:combined", "frontier", "random"]
seeds = [1, 2]
sensors = ["tof.toml"]
voxels = [0.0125]
sizes = [0.15]
max_views = 3
tolerance = 0.0125
)");
  }

  static Strings study(const std::string& out, const Strings& more = {}) {
    return test::joined({"study", "spec.toml", "--out", out, "--quiet"}, more);
  }

  // The lines without their last columns, seconds.
  [[nodiscard]] std::string rows(const std::string& out) const {
    std::istringstream lines(read(out + "/results.csv"));
    std::string text;
    for (std::string line; std::getline(lines, line);) {
      text += line.substr(0, line.rfind(',', line.rfind(',') - 1));
    }
    return text;
  }

  [[nodiscard]] std::size_t runs_in(const std::string& out) const {
    if (!fs::exists(dir / out / "runs")) return 0;
    std::size_t count = 0;
    for (const auto& entry : fs::directory_iterator(dir / out / "runs")) {
      count += fs::exists(entry.path() / "run.json") ? 1 : 0;
    }
    return count;
  }
};

TEST_F(Study, LeavesWhatItSays) {
  const json printed = json::parse(run_well(study("out", {"--json", "--plots", "off"})));
  EXPECT_EQ(printed, json::parse(read("out/results.json")));
  EXPECT_EQ(list("out"), (Strings{"plots.py", "results.csv", "results.json", "runs", "table.md"}));
  EXPECT_EQ(list("out/runs").size(), 6U);
  ASSERT_EQ(printed.size(), 6U);
  for (const json& run : printed) {
    EXPECT_EQ(run["object"], "cube");
    EXPECT_EQ(run["gain"], run["policy"] == "gain" ? json("combined") : json());
    EXPECT_EQ(run["views"], 3);  // the whole budget
    EXPECT_EQ(run["coverage_by_view"].size(), 3U);
    EXPECT_EQ(run["coverage_by_view"][2], run["coverage_visible"]);
  }
  // A run by itself is the same run.
  const json alone = json::parse(
      run_well({"reconstruct", "cube.off", "--sensor",    "tof.toml", "--voxel", "0.0125",
                "--size",      "0.15",     "--max-views", "3",        "--seed",  "2",
                "--tolerance", "0.0125",   "--policy",    "frontier", "--stop",  "gain=0",
                "--stop",      "area=0",   "--stop",      "idle=0",   "--stop",  "promises=0",
                "--pictures",  "off",      "--quiet",     "--json",   "--out",   "alone"}));
  EXPECT_EQ(printed[4]["policy"], "frontier");
  EXPECT_EQ(printed[4]["seed"], 2);
  EXPECT_EQ(printed[4]["decisions"], 2);
  EXPECT_GT(printed[4]["deciding_seconds"], 0);
  for (const char* key : {"coverage_visible", "rms_error", "consistency", "travelled"}) {
    EXPECT_EQ(printed[4][key], alone[key]) << key;
  }
}

TEST_F(Study, KeepsCandidatesOfEachView) {
  write("spec.toml", "kept_candidates = 7\n" + read("spec.toml"));
  run_well(study("out", {"--plots", "off"}));
  std::size_t cases = 0;
  for (const std::string& hash : list("out/runs")) {
    const std::string folder = "out/runs/" + hash;
    const json run = json::parse(read(folder + "/run.json"));
    const PoseList kept = read_tum(dir / folder / "candidates.txt");
    // For each view but the first, which is given.
    for (std::size_t view = 1; view < 3; ++view) {
      const auto count =
          std::count(kept.timestamps.begin(), kept.timestamps.end(), static_cast<double>(view));
      EXPECT_EQ(count, std::min(7, run["per_view"][view]["candidates"].get<int>()));
      ++cases;
    }
    EXPECT_EQ(kept.poses.size(), kept.timestamps.size());
  }
  EXPECT_EQ(cases, 12U);
  EXPECT_FALSE(fs::exists(dir / "out" / "candidates.txt"));
}

TEST_F(Study, VoxelsLargerThanTheToleranceAreSaid) {
  std::string spec = read("spec.toml");
  spec.replace(spec.find("tolerance = 0.0125"), 18, "tolerance = 0.005");
  write("spec.toml", spec);
  const test::ProgramResult result = run(study("out", {"--plots", "off"}));
  EXPECT_EQ(result.exit_code, 0);
  EXPECT_NE(result.err.find("warning: coverage is counted to 5 mm, finer than voxels of 12.5 mm"),
            std::string::npos)
      << result.err;
}

TEST_F(Study, KilledItGoesOn) {
  run_well(study("whole", {"--plots", "off", "--jobs", "1"}));
  std::size_t kills = 0;
  for (std::size_t wanted : {0U, 1U, 3U, 4U}) {
    const int status = ended_by(study("killed", {"--plots", "off", "--jobs", "2"}), SIGKILL,
                                [&] { return runs_in("killed") >= wanted; });
    if (WIFSIGNALED(status)) ++kills;
    EXPECT_FALSE(fs::exists(dir / "killed/results.json"));
  }
  EXPECT_EQ(kills, 4U);
  const std::size_t there = runs_in("killed");
  EXPECT_GE(there, 4U);
  run_well(study("killed", {"--plots", "off"}));
  EXPECT_EQ(rows("killed"), rows("whole"));
  EXPECT_EQ(list("killed/runs"), list("whole/runs"));  // no claim is left
  // All there: nothing is made again.
  const auto before = contents("killed/runs");
  run_well(study("killed", {"--plots", "off"}));
  EXPECT_TRUE(contents("killed/runs") == before);
}

TEST_F(Study, AWishToStopLeavesWhatIsWhole) {
  const int status = ended_by(study("out", {"--plots", "off", "--jobs", "1"}), SIGINT,
                              [&] { return runs_in("out") >= 1; });
  EXPECT_TRUE(WIFEXITED(status) && WEXITSTATUS(status) == 130) << status;
  EXPECT_EQ(list("out"), Strings{"runs"});
  EXPECT_LT(runs_in("out"), 6U);
  EXPECT_EQ(list("out/runs").size(), runs_in("out"));
}

TEST_F(Study, WrongNamesAreKnownBeforeTheFirstRun) {
  const std::string spec = read("spec.toml");
  for (const auto& [from, to, word] : std::vector<std::array<std::string, 3>>{
           {"gain:combined", "gain:combine", "combined"},
           {"\"random\"", "\"randm\"", "random"},
           {"max_views", "flags = [\"--cost-per-metre=-2\"]\nmax_views", "--cost-per-metre"},
           {"max_views", "flags = [\"--no-such\"]\nmax_views", "--no-such"},
           {"[0.0125]", "[0.0125, 0.2]", "--voxel"}}) {
    std::string text = spec;
    text.replace(text.find(from), from.size(), to);
    write("wrong.toml", text);
    const test::ProgramResult result = run({"study", "wrong.toml", "--out", "out"});
    EXPECT_EQ(result.exit_code, 2) << to;
    EXPECT_NE(result.err.find(word), std::string::npos) << result.err;
    EXPECT_NE(result.err.find("wrong.toml"), std::string::npos) << result.err;
    EXPECT_FALSE(fs::exists(dir / "out")) << to;
  }
}

TEST_F(Study, DamagedRunsAreNamedAndNothingIsLeft) {
  run_well(study("out", {"--plots", "off"}));
  const std::string hash = json::parse(read("out/results.json"))[0]["hash"];
  const std::string folder = "out/runs/" + hash + "/";
  const std::string whole = read(folder + "run.json");
  for (const std::string from : {"\"per_view\"", "\"stop_reason\""}) {
    for (const char* of_before : {"results.csv", "results.json"})
      fs::remove(dir / "out" / of_before);
    std::string text = whole;
    text.replace(text.rfind(from), from.size(), "\"other\"");
    write(folder + "run.json", text);
    const test::ProgramResult result = run(study("out", {"--plots", "off"}));
    EXPECT_EQ(result.exit_code, 2) << from;
    EXPECT_NE(result.err.find(hash + "/run.json"), std::string::npos) << result.err;
    EXPECT_FALSE(fs::exists(dir / "out/results.csv")) << from;
  }
}

TEST_F(Study, AFolderOfOtherThingsIsRefused) {
  write("other/notes.txt", "mine");
  const test::ProgramResult result = run(study("other"));
  EXPECT_EQ(result.exit_code, 2);
  EXPECT_NE(result.err.find("other"), std::string::npos) << result.err;
  EXPECT_EQ(list("other"), Strings{"notes.txt"});
  // The spec may lie there, and stays as it is.
  write("home/my.toml",
        "objects = [\"../cube.off\"]\npolicies = [\"random\"]\nseeds = [1]\n"
        "sensors = [\"../tof.toml\"]\nvoxels = [0.0125]\nsizes = [0.15]\nmax_views = 1\n"
        "tolerance = 0.02\n");
  const std::string spec = read("home/my.toml");
  // What draws the plots can be stopped: it does not inherit the signals that the program blocks.
  write("bin/python3",
        "#!/bin/sh\nexec grep SigBlk /proc/self/status > '" + dir.string() + "/blocked'\n");
  fs::permissions(dir / "bin/python3", fs::perms::owner_all);
  const std::string path = std::getenv("PATH");
  ::setenv("PATH", (dir.string() + "/bin:" + path).c_str(), 1);
  run_well({"study", "home/my.toml", "--out", "home", "--quiet"});
  ::setenv("PATH", path.c_str(), 1);
  EXPECT_TRUE(fs::exists(dir / "home/results.csv"));
  EXPECT_EQ(read("home/my.toml"), spec);
  EXPECT_EQ(read("blocked"), "SigBlk:\t0000000000000000\n");
}

TEST_F(Study, PlotsAreDrawnByTheScriptItLeaves) {
  if (std::system("(python3 -c 'import matplotlib' || /usr/bin/python3 -c 'import matplotlib') 2> "
                  "/dev/null") != 0) {
    GTEST_SKIP() << "no matplotlib";
  }
  run_well(study("out"));
  EXPECT_TRUE(read("out/coverage.png").starts_with("\x89PNG"));
  // As of every file that is written anew the mode stays.
  const auto own = fs::perms::owner_read | fs::perms::owner_write;
  fs::permissions(dir / "out/coverage.png", own);
  run_well(study("out"));
  EXPECT_TRUE(read("out/coverage.png").starts_with("\x89PNG"));
  EXPECT_EQ(fs::status(dir / "out/coverage.png").permissions(), own);
}

}  // namespace
}  // namespace viewgain
