// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0

// Runs that were ended and go on.

#include <sys/wait.h>

#include <algorithm>
#include <csignal>
#include <filesystem>
#include <map>
#include <set>
#include <sstream>
#include <string>

#include "apps/program_runner.hpp"
#include "viewgain/formats/png.hpp"
#include "viewgain/formats/sensor_toml.hpp"
#include "viewgain/support/json.hpp"

namespace viewgain {
namespace {

json without_times(json value) {
  if (!value.is_structured()) return value;
  if (value.is_object()) value.erase("seconds");
  for (json& part : value) part = without_times(std::move(part));
  return value;
}

class Resume : public test::ProgramTest {
 protected:
  Resume() {
    write_cube();
    write_half_sensor();
  }

  static Strings run_of(const std::string& out, const Strings& more = {}) {
    return test::joined({"reconstruct", "cube.off", "--sensor", "tof.toml", "--voxel", "0.0125",
                         "--size", "0.2", "--max-views", "4", "--stop", "idle=0", "--stop",
                         "area=0", "--pictures", "off", "--resume", "--out", out},
                        more);
  }

  // All but times; hidden files too.
  [[nodiscard]] std::map<std::string, std::string> result(const std::string& out) const {
    std::map<std::string, std::string> files = contents(out);
    files["run.json"] = without_times(json::parse(files["run.json"])).dump();
    return files;
  }

  [[nodiscard]] fs::path left() const {
    for (const std::string& name : list(".")) {
      if (name.starts_with(".out.tmp-")) return dir / name;
    }
    return {};
  }

  // How many decisions the run has written down.
  [[nodiscard]] std::size_t decisions() const {
    const fs::path folder = left();
    if (folder.empty() || !fs::exists(folder / "checkpoint.json")) return 0;
    const std::string text = read(folder.filename().string() + "/checkpoint.json");
    std::size_t count = 0;
    for (std::size_t at = 0; (at = text.find("map_hash", at)) != std::string::npos; ++at) ++count;
    return count;
  }
};

TEST_F(Resume, AKilledRunEndsWithTheSameBytes) {
  std::size_t cases = 0;
  for (const Strings& more : {Strings{"--save-maps", "on"}, Strings{"--policy", "kriegel"},
                              Strings{"--policy", "frontier"}, Strings{"--plan", "3,2"},
                              Strings{"--register", "on", "--noise", "on"}}) {
    ASSERT_EQ(run(run_of("whole", more)).exit_code, 0) << more[1];
    const auto whole = result("whole");
    EXPECT_FALSE(whole.contains("checkpoint.json"));
    for (const std::size_t after : {1U, 2U}) {
      fs::remove_all(dir / "out");
      const int status =
          ended_by(run_of("out", more), SIGKILL, [&] { return decisions() >= after; });
      ASSERT_TRUE(WIFSIGNALED(status)) << more[1] << ": " << status;
      EXPECT_FALSE(fs::exists(dir / "out"));
      EXPECT_GE(decisions(), after);
      // Again, right at the start.
      (void)ended_by(run_of("out", more), SIGKILL, [] { return true; });
      EXPECT_GE(decisions(), after);
      ASSERT_EQ(run(run_of("out", more)).exit_code, 0) << more[1];
      EXPECT_TRUE(result("out") == whole) << more[1] << " after " << after;
      EXPECT_TRUE(left().empty());
      ++cases;
    }
    fs::remove_all(dir / "whole");
  }
  EXPECT_EQ(cases, 10U);
}

TEST_F(Resume, WhatWasDecidedIsNotDecidedAgain) {
  const int status = ended_by(run_of("out"), SIGKILL, [&] { return decisions() >= 2; });
  ASSERT_TRUE(WIFSIGNALED(status));
  // Another choice in the first decision's place: the run goes by it.
  const std::string name = left().filename().string() + "/checkpoint.json";
  json checkpoint = json::parse(read(name));
  checkpoint["decisions"] = json::array();
  const json first = json::parse(read(name))["decisions"][0];
  json changed = first;
  changed["candidate"] = first["candidate"].get<int>() == 0 ? 1 : 0;
  checkpoint["decisions"].push_back(changed);
  write(name, checkpoint.dump());
  ASSERT_EQ(run(run_of("out")).exit_code, 0);
  ASSERT_EQ(run(run_of("whole")).exit_code, 0);
  EXPECT_NE(read("out/views.txt"), read("whole/views.txt"));
}

TEST_F(Resume, AnInterruptedRunGoesOnFromItsFolder) {
  ASSERT_EQ(run(run_of("whole")).exit_code, 0);
  const auto whole = result("whole");
  std::size_t cases = 0;
  for (const int signal : {SIGTERM, SIGHUP, SIGINT}) {
    const int status = ended_by(run_of("out"), signal, [&] { return decisions() >= 1; });
    ASSERT_TRUE(WIFEXITED(status) && WEXITSTATUS(status) == 0) << signal;
    EXPECT_TRUE(left().empty());
    EXPECT_EQ(json::parse(read("out/run.json"))["stop_reason"], "interrupted") << signal;
    EXPECT_TRUE(fs::exists(dir / "out/checkpoint.json"));
    ASSERT_EQ(run(run_of("out")).exit_code, 0);
    EXPECT_TRUE(result("out") == whole) << signal;
    fs::remove_all(dir / "out");
    ++cases;
  }
  EXPECT_EQ(cases, 3U);
}

TEST_F(Resume, OfFramesWhatWasDrawnIsKept) {
  run_well({"simulate", "cube.off", "--poses", "orbit:5,0.6,27", "--sensor", "tof.toml", "--size",
            "0.2", "--place", "center", "--out", "frames"});
  const auto of = [](const std::string& out) {
    return Strings{"model",    "frames",      "--voxel",
                   "0.0125",   "--workspace", "-0.2,-0.2,-0.2,0.2,0.2,0.2",
                   "--resume", "--out",       out};
  };
  ASSERT_EQ(run(of("whole")).exit_code, 0);
  const auto drawn = [&] {
    const fs::path folder = left();
    return !folder.empty() && fs::exists(folder / "views/01.png");
  };
  const int status = ended_by(of("out"), SIGKILL, drawn);
  ASSERT_TRUE(WIFSIGNALED(status)) << status;
  const auto time = fs::last_write_time(left() / "views/01.png");
  const test::ProgramResult other = run(test::joined(of("out"), {"--scales", "1"}));
  EXPECT_EQ(other.exit_code, 2);
  EXPECT_NE(other.err.find("the run has other settings"), std::string::npos) << other.err;
  ASSERT_EQ(run(of("out")).exit_code, 0);
  EXPECT_EQ(fs::last_write_time(dir / "out/views/01.png"), time);
  EXPECT_TRUE(result("out") == result("whole"));
  EXPECT_TRUE(left().empty());
}

// Every option of the command, from its help: one that nobody has thought of here fails.
TEST_F(Resume, OfFramesEveryFlagThatChangesBytesIsCompared) {
  run_well({"simulate", "cube.off", "--poses", "orbit:2,0.6,27", "--sensor", "tof.toml", "--size",
            "0.2", "--place", "center", "--out", "frames"});
  const std::map<std::string, Strings> others{
      {"sensor", {"tof.toml"}},
      {"voxel", {"0.02"}},
      {"workspace", {"-0.3,-0.3,-0.3,0.3,0.3,0.3"}},
      {"jump-edge-filter", {"off"}},
      {"scales", {"1"}},
      {"fine", {"0,0,0,0.1,0.1,0.1", "--scales", "1"}},
      {"depth-scale", {"1.1e-4"}},
      {"out-of-range", {"invalid"}},
      {"mask", {"masks"}},
      {"confidence", {"masks"}},
      {"register", {"on"}},
      {"on-contradiction", {"keep", "--register", "on"}},
      {"generator", {"sphere"}},
      {"gain", {"surface"}},
      {"count", {"40", "--generator", "sphere"}},
      {"distance", {"0.7", "--generator", "sphere"}},
      {"center", {"0,0,0.01", "--generator", "sphere"}},
      {"reach", {"reach.toml"}},
      {"body", {"0.01,0.01,0.02"}},
      {"support-plane", {"-0.15"}},
      {"obstacle", {"0.9,0.9,0.9,1,1,1"}},
      {"hazard", {"5"}},
      {"poses", {"frames/poses.txt"}},
      {"seed", {"7", "--generator", "sphere"}},
      {"cost-per-metre", {"0.1"}},
      {"costs", {"costs.csv", "--poses", "frames/poses.txt"}},
      {"from", {"0,0,0.6", "--cost-per-metre", "0.1"}},
      {"plan", {"2"}},
      {"top", {"3"}},
      {"pictures", {"on"}},
      {"save-maps", {"on"}}};
  const std::set<std::string> same{"out", "resume", "threads", "trace", "quiet", "json", "help",
                                   "report", "config", "save-config",
                                   // Of calls that are not resumed.
                                   "watch", "max-views", "stop"};
  write("reach.toml", "[[box]]\nmin = [-2.0, -2.0, -2.0]\nmax = [2.0, 2.0, 2.0]\n");
  write("costs.csv", "0\n1\n");
  fs::create_directories(dir / "masks");
  fs::copy_file(dir / "frames/frame-000000.depth.png", dir / "masks/frame-000000.depth.png");
  const Strings call{
      "model",      "frames", "--voxel",  "0.025", "--workspace", "-0.2,-0.2,-0.2,0.2,0.2,0.2",
      "--pictures", "off",    "--resume", "--out", "out"};
  const int status = ended_by(
      call, SIGKILL, [&] { return !left().empty() && fs::exists(left() / "checkpoint.json"); });
  ASSERT_TRUE(WIFSIGNALED(status)) << status;
  std::istringstream help(run_well({"model", "--help"}));
  std::size_t flags = 0;
  for (std::string line; std::getline(help, line);) {
    if (!line.starts_with("  --")) continue;
    const std::string name = line.substr(4, line.find(' ', 4) - 4);
    if (same.contains(name)) continue;
    ASSERT_TRUE(others.contains(name)) << "a new flag: " << line;
    Strings changed = call;
    for (const std::string& given : {"--" + name, others.at(name)[0]}) changed.push_back(given);
    if (name == "voxel" || name == "workspace" || name == "pictures") {
      changed = call;
      *(std::find(changed.begin(), changed.end(), "--" + name) + 1) = others.at(name)[0];
    }
    changed.insert(changed.end(), others.at(name).begin() + 1, others.at(name).end());
    const test::ProgramResult result = run(changed);
    EXPECT_EQ(result.exit_code, 2) << name;
    EXPECT_NE(result.err.find("the run has other settings"), std::string::npos)
        << name << ": " << result.err;
    ++flags;
  }
  EXPECT_EQ(flags, others.size());
  // Files of the same names with other bytes.
  const auto refused = [&](const Strings& with) {
    const test::ProgramResult result = run(test::joined(call, with));
    return result.err.find("the run has other settings") != std::string::npos;
  };
  EXPECT_FALSE(refused({"--threads", "1", "--quiet", "--json", "--report", "off"}));
}

TEST_F(Resume, OfFramesFilesThatFlagsNameAreCompared) {
  run_well({"simulate", "cube.off", "--poses", "orbit:2,0.6,27", "--sensor", "tof.toml", "--size",
            "0.2", "--place", "center", "--out", "frames"});
  const std::string reach = "[[box]]\nmin = [-2.0, -2.0, -2.0]\nmax = [2.0, 2.0, 2.0]\n";
  write("reach.toml", reach);
  fs::create_directories(dir / "masks");
  const fs::path mask = dir / "masks/frame-000000.depth.png";
  const Strings call{
      "model",      "frames", "--voxel", "0.025", "--workspace", "-0.2,-0.2,-0.2,0.2,0.2,0.2",
      "--pictures", "off",    "--mask",  "masks", "--reach",     "reach.toml",
      "--resume",   "--out",  "out"};
  const auto write_mask = [&](std::size_t pixel) {  // one pixel is ignored
    const Sensor sensor = load_sensor((dir / "frames/sensor.toml").string());
    Gray8Image image{sensor.camera.width, sensor.camera.height, {}};
    image.pixels.resize(static_cast<std::size_t>(image.width * image.height));
    image.pixels[pixel] = 255;
    write_png(mask, image);
  };
  write_mask(0);
  const int status = ended_by(
      call, SIGKILL, [&] { return !left().empty() && fs::exists(left() / "checkpoint.json"); });
  ASSERT_TRUE(WIFSIGNALED(status)) << status;
  write("reach.toml", "# wider\n" + reach);
  expect_refused(call, "the run has other settings");
  write("reach.toml", reach);
  write_mask(1);
  expect_refused(call, "the run has other settings");
  write_mask(0);
  EXPECT_EQ(run(call).exit_code, 0);
}

TEST_F(Resume, AnothersCheckpointIsRefusedAndStays) {
  const int status = ended_by(run_of("out"), SIGKILL, [&] { return decisions() >= 1; });
  ASSERT_TRUE(WIFSIGNALED(status));
  const std::string name = left().filename().string() + "/checkpoint.json";
  const std::string good = read(name);
  expect_refused(run_of("out", {"--seed", "2"}), "checkpoint.json: the run has other settings");
  json newer = json::parse(good);
  newer["format"] = 7;
  json otherwise = json::parse(good);
  otherwise["decisions"][0]["map_hash"] = "0";
  json cut = json::parse(good);
  cut["decisions"][0].erase("area");
  json real_format = json::parse(good), real = real_format;
  real_format["format"] = 3e31;
  real["decisions"][0]["candidate"] = 3e31;
  std::size_t cases = 0;
  for (const auto& [text, word] :
       {std::pair{newer.dump(),
                  "the file's format, 7, is too new; this program reads formats up to 1"},
        std::pair{cut.dump(), "checkpoint.json: the file is not a checkpoint: "},
        std::pair{real_format.dump(), "checkpoint.json: the file is not a checkpoint: "},
        std::pair{real.dump(), "checkpoint.json: the file is not a checkpoint: "},
        std::pair{good.substr(0, good.size() / 2),
                  "checkpoint.json: the file is not a checkpoint: "}}) {
    write(name, text);
    expect_refused(run_of("out"), word);
    ++cases;
  }
  EXPECT_EQ(cases, 5U);
  write(name, otherwise.dump());
  const test::ProgramResult result = run(run_of("out"));
  EXPECT_EQ(result.exit_code, 2);
  EXPECT_NE(result.err.find("the map after view 0 differs"), std::string::npos) << result.err;
  // Without the flag it is cleared away.
  Strings anew = run_of("out");
  std::erase(anew, "--resume");
  EXPECT_EQ(run(anew).exit_code, 0);
  EXPECT_TRUE(left().empty());
}

// A link that somebody put into what was left leads no file out of it.
TEST_F(Resume, LinksInWhatWasLeftAreNotFollowed) {
  const int status = ended_by(run_of("out"), SIGKILL, [&] { return decisions() >= 1; });
  ASSERT_TRUE(WIFSIGNALED(status));
  write("mine.txt", "mine");
  fs::create_directory(dir / "elsewhere");
  fs::remove_all(left() / "views");
  fs::create_symlink(dir / "mine.txt", left() / "map.vdb");
  fs::create_directory_symlink(dir / "elsewhere", left() / "views");
  EXPECT_EQ(run(run_of("out")).exit_code, 0);
  EXPECT_EQ(read("mine.txt"), "mine");
  EXPECT_TRUE(list("elsewhere").empty());
  EXPECT_FALSE(fs::is_symlink(dir / "out/map.vdb"));
}

}  // namespace
}  // namespace viewgain
