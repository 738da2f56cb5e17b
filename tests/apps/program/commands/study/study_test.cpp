// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0

// `viewgain study` as a user calls it.
#include <signal.h>
#include <sys/wait.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <map>
#include <sstream>
#include <string>
#include <thread>
#include <vector>

#include "apps/program_runner.hpp"
#include "program/cli/json.hpp"
#include "program/commands/study/statistics.hpp"
#include "viewgain/core/pose_io.hpp"

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
[prediction]
views = [1, 3]
candidates = 8
)");
  }

  static Strings study(const std::string& out, const Strings& more = {}) {
    return test::joined({"study", "spec.toml", "--out", out, "--quiet"}, more);
  }

  // The cells of predictions.csv by policy, seed and view: "frontier1/3".
  [[nodiscard]] std::map<std::string, std::vector<Strings>> predictions(
      const std::string& out) const {
    std::map<std::string, std::vector<Strings>> found;
    std::istringstream lines(read(out + "/predictions.csv"));
    std::string line;
    std::getline(lines, line);
    EXPECT_EQ(line,
              "object,policy,gain,semantics,seed,sensor,voxel,size,view,candidate,score,"
              "predicted_area,new_samples,new_area,entropy_removed,generator,tx,ty,tz,qx,qy,qz,qw");
    while (std::getline(lines, line)) {
      std::istringstream in(line);
      Strings cells;
      for (std::string cell; std::getline(in, cell, ',');) cells.push_back(cell);
      EXPECT_EQ(cells.size(), 23U);
      found[cells.at(1) + cells.at(4) + "/" + cells.at(8)].push_back(cells);
    }
    return found;
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
  EXPECT_EQ(list("out"), (Strings{"plots.py", "predictions.csv", "results.csv", "results.json",
                                  "runs", "table.md"}));
  EXPECT_EQ(list("out/runs").size(), 6U);
  ASSERT_EQ(printed.size(), 6U);
  for (const json& run : printed) {
    EXPECT_EQ(run["object"], "cube");
    EXPECT_EQ(run["gain"], run["policy"] == "gain" ? json("combined") : json());
    EXPECT_EQ(run["views"], 3);  // the whole budget
    EXPECT_EQ(run["coverage_by_view"].size(), 3U);
    EXPECT_EQ(run["coverage_by_view"][2], run["coverage_visible"]);
    EXPECT_EQ(run["prediction"].size(), run["policy"] == "random" ? 0U : 2U);
  }
  // A run by itself is the same run.
  const json alone = json::parse(
      run_well({"reconstruct", "cube.off", "--sensor",    "tof.toml", "--voxel",         "0.0125",
                "--size",      "0.15",     "--max-views", "3",        "--seed",          "2",
                "--tolerance", "0.0125",   "--policy",    "frontier", "--stop-gain",     "0",
                "--stop-area", "0",        "--stop-idle", "0",        "--stop-promises", "0",
                "--pictures",  "off",      "--quiet",     "--json",   "--out",           "alone"}));
  EXPECT_EQ(printed[4]["policy"], "frontier");
  EXPECT_EQ(printed[4]["seed"], 2);
  EXPECT_EQ(printed[4]["decisions"], 2);
  EXPECT_GT(printed[4]["deciding_seconds"], 0);
  for (const char* key : {"coverage_visible", "rms_error", "consistency", "travelled"}) {
    EXPECT_EQ(printed[4][key], alone[key]) << key;
  }
}

TEST_F(Study, KeepsCandidatesOfEachView) {
  const std::string spec = read("spec.toml");
  write("spec.toml", "kept_candidates = 7\n" + spec.substr(0, spec.find("[prediction]")));
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

TEST_F(Study, PredictionIsThatOfItsRows) {
  const json results = json::parse(run_well(study("out", {"--json", "--plots", "off"})));
  // By policy, seed and view: score, new samples, entropy.
  std::map<std::string, std::vector<std::vector<double>>> columns;
  for (const auto& [key, rows] : predictions("out")) {
    auto& column = columns[key];
    column.resize(3);
    for (const Strings& cells : rows) {
      column[0].push_back(std::stod(cells[10]));
      column[1].push_back(std::stod(cells[12]));
      column[2].push_back(std::stod(cells[14]));
      EXPECT_EQ(cells[11] == "nan", cells[1] == "frontier");
      EXPECT_GE(std::stod(cells[13]) * std::stod(cells[12]), 0);
    }
  }
  std::size_t cases = 0;
  for (const json& run : results) {
    for (const json& entry : run["prediction"]) {
      const auto& column =
          columns.at(run["policy"].get<std::string>() + std::to_string(run["seed"].get<int>()) +
                     "/" + std::to_string(entry["view"].get<int>()));
      EXPECT_EQ(entry["candidates"], column[0].size());
      EXPECT_GE(column[0].size(), 4U);
      const std::vector<std::pair<const char*, double>> expected{
          {"spearman_area", app::spearman(column[0], column[1])},
          {"spearman_entropy", app::spearman(column[0], column[2])}};
      for (const auto& [key, value] : expected) {
        if (std::isnan(value)) {
          EXPECT_TRUE(entry[key].is_null());
        } else {
          EXPECT_EQ(entry[key].get<double>(), value) << key;
        }
      }
      const auto best = std::max_element(column[0].begin(), column[0].end()) - column[0].begin();
      const double most = *std::max_element(column[1].begin(), column[1].end());
      if (most > 0) {
        EXPECT_EQ(entry["top1_share"].get<double>(),
                  column[1][static_cast<std::size_t>(best)] / most);
      }
      ++cases;
    }
  }
  EXPECT_EQ(cases, 8U);
  // Early on the expected new surface says where there is some.
  EXPECT_GT(results[0]["prediction"][0]["spearman_area"].get<double>(), 0.4);
}

TEST_F(Study, ScoresAreHeldAgainstTheMapsOfOnePolicy) {
  run_well(study("own", {"--plots", "off"}));
  write("spec.toml", read("spec.toml") + "maps = \"frontier\"\n");
  const json results = json::parse(run_well(study("out", {"--json", "--plots", "off"})));
  EXPECT_NE(read("out/table.md").find("on the maps of frontier"), std::string::npos);
  const auto of_own = predictions("own"), same = predictions("out");
  EXPECT_EQ(same.size(), 8U);
  for (const char* seed : {"1", "2"}) {
    const auto at = [&](const auto& rows, const char* policy, const char* view) {
      return rows.at(std::string(policy) + seed + "/" + view);
    };
    // All runs begin alike, and those of frontier are what they were.
    EXPECT_EQ(at(same, "gain", "1"), at(of_own, "gain", "1"));
    EXPECT_EQ(at(same, "frontier", "1"), at(of_own, "frontier", "1"));
    EXPECT_EQ(at(same, "frontier", "3"), at(of_own, "frontier", "3"));
    // Other scores of the same candidates.
    const auto gain = at(same, "gain", "3"), frontier = at(same, "frontier", "3");
    ASSERT_EQ(gain.size(), frontier.size());
    for (std::size_t i = 0; i < gain.size(); ++i) {
      EXPECT_NE(gain[i][10], frontier[i][10]);
      EXPECT_TRUE(std::equal(gain[i].begin() + 12, gain[i].end(), frontier[i].begin() + 12));
    }
  }
  for (const json& run : results) {
    EXPECT_EQ(run["prediction"].size(), run["policy"] == "random" ? 0U : 2U);
  }
  // A run of frontier that says nothing of predictions is itself to blame.
  std::string damaged;
  for (const std::string& hash : list("out/runs")) {
    const std::string file = "out/runs/" + hash + "/run.json";
    if (!damaged.empty() || !fs::exists(dir / file)) continue;
    json one = json::parse(read(file));
    if (one["prediction"].size() == 0) continue;
    damaged = file;
    one.erase("prediction");
    write(file, one.dump());
  }
  const test::ProgramResult result = run(study("out", {"--plots", "off"}));
  EXPECT_EQ(result.exit_code, 2);
  EXPECT_NE(result.err.find(damaged + ": "), std::string::npos) << damaged << " " << result.err;
}

TEST_F(Study, VoxelsLargerThanTheToleranceAreSaid) {
  std::string spec = read("spec.toml");
  spec.replace(spec.find("tolerance = 0.0125"), 18, "tolerance = 0.005");
  write("spec.toml", spec.substr(0, spec.find("[prediction]")));
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
    const pid_t child = start(study("killed", {"--plots", "off", "--jobs", "2"}));
    int status = 0;
    while (runs_in("killed") < wanted && ::waitpid(child, &status, WNOHANG) == 0) {
      std::this_thread::sleep_for(std::chrono::milliseconds(2));
    }
    if (::kill(child, SIGKILL) == 0) ++kills;
    ::waitpid(child, &status, 0);
    EXPECT_FALSE(fs::exists(dir / "killed/results.json"));
  }
  EXPECT_EQ(kills, 4U);
  const std::size_t there = runs_in("killed");
  EXPECT_GE(there, 4U);
  run_well(study("killed", {"--plots", "off"}));
  EXPECT_EQ(rows("killed"), rows("whole"));
  EXPECT_EQ(read("killed/predictions.csv"), read("whole/predictions.csv"));
  EXPECT_EQ(list("killed/runs"), list("whole/runs"));  // no claim is left
  // All there: nothing is made again.
  const auto before = contents("killed/runs");
  run_well(study("killed", {"--plots", "off"}));
  EXPECT_TRUE(contents("killed/runs") == before);
}

TEST_F(Study, AWishToStopLeavesWhatIsWhole) {
  const pid_t child = start(study("out", {"--plots", "off", "--jobs", "1"}));
  int status = 0;
  while (runs_in("out") < 1 && ::waitpid(child, &status, WNOHANG) == 0) {
    std::this_thread::sleep_for(std::chrono::milliseconds(2));
  }
  ASSERT_EQ(::kill(child, SIGINT), 0);
  ASSERT_EQ(::waitpid(child, &status, 0), child);
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
           {"max_views", "flags = [\"--overlap=2\"]\nmax_views", "--overlap"},
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
  for (const auto& [name, from] :
       std::vector<std::pair<std::string, std::string>>{{"run.json", "\"per_view\""},
                                                        {"run.json", "\"stop_reason\""},
                                                        {"prediction.csv", "\n"}}) {
    for (const char* of_before : {"results.csv", "results.json", "predictions.csv"}) {
      fs::remove(dir / "out" / of_before);
    }
    const std::string whole = read(folder + name);
    std::string text = whole;
    text.replace(text.rfind(from), from.size(), name == "run.json" ? "\"other\"" : "");
    write(folder + name, text);
    const test::ProgramResult result = run(study("out", {"--plots", "off"}));
    EXPECT_EQ(result.exit_code, 2) << from;
    EXPECT_NE(result.err.find(hash + "/" + name), std::string::npos) << result.err;
    EXPECT_FALSE(fs::exists(dir / "out/results.csv")) << from;
    write(folder + name, whole);
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
  for (const char* name : {"coverage.png", "prediction.png", "calibration.png"}) {
    EXPECT_TRUE(read(std::string("out/") + name).starts_with("\x89PNG")) << name;
  }
}

}  // namespace
}  // namespace viewgain
