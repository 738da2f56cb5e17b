// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0

// --config and --save-config: calls that are repeated from a file, and files that are refused.
#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "apps/program_runner.hpp"
#include "viewgain/support/json.hpp"

namespace viewgain {
namespace {

json without_seconds(json value) {
  if (value.is_object()) value.erase("seconds");
  for (json& inner : value) {
    if (inner.is_array() || inner.is_object()) inner = without_seconds(inner);
  }
  return value;
}

class ConfigFile : public test::ProgramTest {
 protected:
  ConfigFile() {
    write_cube();
    write_half_sensor();
  }
  const Strings frames_call{"simulate", "cube.off", "--poses", "orbit:3,0.6,27",
                            "--sensor", "tof.toml", "--size",  "0.3",
                            "--place",  "center",   "--seed",  "7",
                            "--noise",  "on",       "--out",   "frames"};
  const Strings map_call{"integrate", "frames",      "--voxel",
                         "0.02",      "--workspace", "-0.2,-0.2,-0.2,0.2,0.2,0.2",
                         "--out",     "map.vdb"};
  void make_map() const {
    run_well(frames_call);
    run_well(map_call);
  }
};

TEST_F(ConfigFile, ARunIsRepeatedByteForByte) {
  const Strings call = test::joined(
      {"reconstruct", "cube.off", "--sensor", "tof.toml", "--size", "0.2", "--voxel", "0.00625"},
      {"--seed", "3", "--max-views", "2", "--out", "run", "--json", "--quiet", "--threads", "2",
       "--gain", "surface", "--save-maps", "on", "--obstacle", "0.5,-1,-1,0.6,1,1",
       "--obstacle=-0.6,-1,-1,-0.5,1,1"});
  run_well(call);
  // Without where it went and how it was shown.
  for (const char* key : {"out", "json", "threads", "quiet", "config"}) {
    EXPECT_EQ(read("run/config.toml").find(std::string("\n") + key + " = "), std::string::npos);
  }
  EXPECT_NE(run({"reconstruct", "--config", "run/config.toml", "--out", "again"}).err, "");
  std::size_t cases = 0;
  for (const auto& [name, bytes] : contents("run")) {
    ++cases;
    if (name == "run.json") {
      EXPECT_EQ(without_seconds(json::parse(read("again/run.json"))),
                without_seconds(json::parse(bytes)));
    } else {
      EXPECT_TRUE(contents("again").at(name) == bytes) << name;
    }
  }
  EXPECT_EQ(cases, contents("again").size());
  EXPECT_EQ(cases, 15U);  // six files; two pictures and a map of each view; two folders
  // The run that the file is in is not replaced while it is read.
  expect_refused({"reconstruct", "--config", "run/config.toml", "--out", "run"},
                 "--config run/config.toml");
}

TEST_F(ConfigFile, EverySubcommandIsRepeated) {
  make_map();
  write("cloud.ply",
        "ply\nformat ascii 1.0\nelement vertex 2\nproperty float x\nproperty float y\n"
        "property float z\nend_header\n0 0 1\n0.01 0 1\n");
  const std::vector<std::pair<Strings, std::string>> calls{
      {frames_call, "frames/frame-000001.depth.png"},
      {map_call, "map.vdb"},
      {{"integrate", "--cloud", "cloud.ply", "--cloud", "cloud.ply", "--origin", "0,0,0", "--voxel",
        "0.001", "--sensor", "tof.toml", "--out", "clouds.vdb"},
       "clouds.vdb"},
      {{"score", "map.vdb", "--poses", "shell:20,0.5,0.7", "--center", "0,0,0.05", "--seed", "5",
        "--sensor", "tof.toml", "--weight", "0,0,0,1,1,1,2", "--weight", "0,0,0,0.1,1,1,0",
        "--race", "--top", "4", "--out", "s.csv"},
       "s.csv"},
      {{"next", "map.vdb", "--generator", "dome", "--count", "30", "--sensor", "tof.toml", "--out",
        "poses.txt"},
       "poses.txt"},
      {{"info", "map.vdb", "--criterion", "trace"}, ""},
      {{"convert", "map.vdb", "tree.ot"}, "tree.ot"},
      {{"sensors", "d435"}, ""},
      {{"reconstruct", "cube.off", "--sensor", "tof.toml", "--size", "0.2", "--voxel", "0.00625",
        "--max-views", "1", "--quiet", "--out", "run"},
       "run/surface.ply"}};
  for (const auto& [call, file] : calls) {
    const std::string out = run_well(test::joined(call, {"--save-config", "saved.toml"}));
    const std::string bytes = file.empty() ? out : read(file), saved = read("saved.toml");
    if (!file.empty()) std::filesystem::remove_all(dir / file.substr(0, file.find('/')));
    const std::string again =
        run_well({call[0], "--config", "saved.toml", "--save-config", "2.toml"});
    EXPECT_TRUE((file.empty() ? again : read(file)) == bytes) << call[0] << "\n" << saved;
    EXPECT_EQ(read("2.toml"), saved) << call[0];
  }
}

TEST_F(ConfigFile, TheCommandLineHolds) {
  make_map();
  write(
      "score.toml",
      "map = \"none.vdb\"\nposes = \"sphere:20,0.6\"\nsensor = \"tof.toml\"\ntop = 3\nrace = true\n"
      "json = true\nfeasible = false\nweight = [\n  [-1, -1, -1, 1, 1, 1, 0],  # nothing counts\n"
      "  \"-1,-1,-1,1,1,1,0\",\n]\n");
  const auto scored = [this](const Strings& more) {
    return json::parse(
        run_well(test::joined({"score", "map.vdb", "--config", "score.toml"}, more)));
  };
  const json as_written = scored({});
  EXPECT_EQ(as_written["poses"], 20);
  EXPECT_EQ(as_written["best"].size(), 3U);
  EXPECT_EQ(as_written["best"][0]["gain"], 0.0);
  EXPECT_EQ(scored({"--top", "5"})["best"].size(), 5U);
  EXPECT_EQ(scored({"--poses=sphere:30,0.6"})["poses"], 30);
  // All repetitions of an option, and what may be given once of a group.
  EXPECT_GT(scored({"--weight", "0,0,0,1,1,1,2"})["best"][0]["gain"], 0.0);
  EXPECT_EQ(scored({"--poses", "dome:40,0.6"})["poses"], 40);
  EXPECT_TRUE(scored({"--set", "2", "--gain", "paper"}).contains("set_gain"));
  // A positional: IN from here, OUT from there.
  write("convert.toml", "in = \"none.vdb\"\nout = \"tree.ot\"\n");
  run_well({"convert", "--config", "convert.toml", "map.vdb"});
  EXPECT_FALSE(read("tree.ot").empty());
}

TEST_F(ConfigFile, NamesOfAnyKind) {
  for (const std::string name : {"a \"b\" \\c\\ 'd'.off", "-x.off", "two\nlines\x01.off",
                                 "gr\xc3\xbc\xc3\x9f.off", "#=[1].off"}) {
    std::filesystem::copy_file(dir / "cube.off", dir / name);
    const Strings call{
        "simulate",     "--poses", "orbit:1,6,27",  "--sensor",   "tof.toml", "--out", "frames",
        "--background", "0",       "--save-config", "saved.toml", "--",       name};
    run_well(call);
    std::filesystem::remove_all(dir / "frames");
    run_well({"simulate", "--config", "saved.toml"});
    EXPECT_TRUE(std::filesystem::exists(dir / "frames/poses.txt")) << name;
    std::filesystem::remove_all(dir / "frames");
  }
  // TOML cannot hold this one: what is left is TOML, and says so.
  std::filesystem::copy_file(dir / "cube.off", dir / "lat\xe9.off");
  run_well({"simulate", "lat\xe9.off", "--poses", "orbit:1,6,27", "--sensor", "tof.toml", "--out",
            "frames", "--save-config", "saved.toml"});
  EXPECT_NE(read("saved.toml").find("# not UTF-8; give it on the command line: mesh"),
            std::string::npos);
  run_well({"simulate", "--config", "saved.toml", "lat\xe9.off"});
}

TEST_F(ConfigFile, WhatIsWrongIsNamedWithFileAndLine) {
  make_map();
  const std::string head = "map = \"map.vdb\"\nsensor = \"tof.toml\"\nposes = \"sphere:20,0.6\"\n";
  const std::vector<std::pair<std::string, std::string>> files{
      {"voxle = 3\n", "c.toml: line 4: key \"voxle\" is unknown"},
      {"wieght = []\n", "key \"wieght\" is unknown; did you mean weight?"},
      {"config = \"c.toml\"\n", "line 4: key \"config\" is unknown"},
      {"\n\ntop = \"three\"\n", "c.toml: line 6: key \"top\" must be a whole number"},
      {"top = 2.5\n", "line 4: key \"top\" must be a whole number"},
      {"deadline = \"far\"\n", "line 4: key \"deadline\" must be a number"},
      {"gain = true\n", "line 4: key \"gain\" must be a string"},
      {"feasible = 1\n", "line 4: key \"feasible\" must be true or false"},
      {"weight = \"0,0,0,1,1,1,2\"\n", "line 4: key \"weight\" must be a list"},
      {"weight = [0,0,0,1,1,1,2]\n", "--weight 0: expected 7 numbers"},
      {"center = []\n", "line 4: key \"center\" must be"},
      {"reach = 1979-05-27\n", "line 4: key \"reach\" must be"},
      {"reach = \"r.toml\\u0000x\"\n", "line 4: key \"reach\" must not contain a zero byte"},
      {"[gain]\nmodel = 1\n", "line 4: key \"gain\" must be"},
      {"top = 1\ntop = 2\n", "c.toml: line 5"},
      {"dome = \"20,0.6\"\n",
       "key \"dome\" belongs to a removed flag: --dome was removed; use --poses dome:N,RADIUS"}};
  for (const auto& [text, word] : files) {
    write("c.toml", head + text);
    expect_refused({"score", "--config", "c.toml", "--out", "s.csv"}, word);
  }
  // Files of a call: --config is read, --save-config is written, and only when all went well.
  write("c.toml", head);
  expect_refused_with(
      {"score"},
      {{{"--config", "none.toml"}, "none.toml"},
       {{"--config", "c.toml", "--save-config", "c.toml"}, "--config c.toml"},
       {{"--config", "c.toml", "--out", "c.toml"}, "--config c.toml"},
       {{"--config", "c.toml", "--save-config", "no/such/c.toml"}, "no/such"},
       {{"--config", "c.toml", "--save-config", "s.toml", "--reach", "none.toml"}, "none.toml"},
       {{"--config", "c.toml", "--save-config", "s.toml", "--out", "s.toml"}, "s.toml"}});
}

}  // namespace
}  // namespace viewgain
