// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0

// What is misspelled, or was spelled otherwise once, is refused by naming what was meant.
#include <algorithm>
#include <sstream>
#include <string>
#include <vector>

#include "apps/program_runner.hpp"

namespace viewgain {
namespace {

using Strings = std::vector<std::string>;

struct Refused {
  Strings arguments;
  std::string word;  // that the message must have
};

class Spelling : public test::ProgramTest {
 protected:
  Spelling() {
    write_cube();
    write_small_sensor();
  }
  // The second column.
  [[nodiscard]] std::vector<double> gains(const std::string& csv) const {
    std::istringstream lines(read(csv));
    std::vector<double> column;
    std::string line;
    std::getline(lines, line);
    while (std::getline(lines, line)) column.push_back(std::stod(line.substr(line.find(',') + 1)));
    return column;
  }
  void expect_refused(const std::vector<Refused>& calls, std::size_t count) const {
    const auto before = contents();
    std::size_t cases = 0;
    for (const Refused& call : calls) {
      const test::ProgramResult result = run(call.arguments);
      std::string shown = "viewgain";
      for (const std::string& argument : call.arguments) shown += " " + argument;
      EXPECT_EQ(result.exit_code, 2) << shown << "\n" << result.err;
      EXPECT_EQ(std::count(result.err.begin(), result.err.end(), '\n'), 1) << shown;
      EXPECT_NE(result.err.find(call.word), std::string::npos)
          << shown << "\n"
          << call.word << " is not in " << result.err;
      EXPECT_EQ(result.out, "") << shown;
      EXPECT_TRUE(contents() == before) << shown;
      ++cases;
    }
    EXPECT_EQ(cases, count);
  }
};

TEST_F(Spelling, TheNearestIsNamed) {
  expect_refused(
      {{{"scor"}, "no such subcommand; did you mean score? There are reconstruct, simulate"},
       {{"recon"}, "did you mean reconstruct?"},
       {{"candiates"}, "did you mean candidates?"},
       {{"zzz"}, "zzz: no such subcommand; there are reconstruct, simulate"},
       {{"--versoin"}, "did you mean --version?"},
       {{"info", "map.vdb", "--jsno"}, "--jsno: no such flag of info; did you mean --json?"},
       {{"info", "map.vdb", "--criterium", "trace"}, "did you mean --criterion?"},
       {{"score", "map.vdb", "--spere=5,1"},
        "--spere: no such flag of score; did you mean --sphere?"},
       {{"reconstruct", "--nonsense"}, "--nonsense: no such flag of reconstruct (see"},
       {{"score", "map.vdb", "--gain", "surfce"},
        "--gain surfce: no such gain; did you mean surface? There are paper, surface, combined"},
       {{"score", "map.vdb", "--criterion", "tarce"}, "did you mean trace?"},
       {{"candidates", "map.vdb", "--generator", "boundry"}, "did you mean boundary?"},
       {{"reconstruct", "cube.off", "--policy", "fronteir"}, "did you mean frontier?"},
       {{"reconstruct", "cube.off", "--generator", "sphere,sequnce"}, "did you mean sequence?"},
       {{"reconstruct", "cube.off", "--noise", "offf"}, "did you mean off?"},
       {{"integrate", "frames", "--carve", "cone"}, "did you mean cones?"},
       {{"sensors", "sr400"}, "did you mean sr4000?"},
       {{"simulate", "cube.off", "--sensor", "kinect", "--orbit", "1,6,20", "--out", "frames"},
        "did you mean kinect_v1? (there are sr4000"},
       {{"score", "map.vdb", "--top"}, "--top: needs a value"},
       {{"score", "map.vdb", "--gain", "--top", "3"},
        "--gain: needs a value; there are paper, surface, combined"}},
      20);
}

TEST_F(Spelling, WhatHadAnotherNameOnceIsTold) {
  expect_refused(
      {{{"reconstruct", "cube.off", "--no-refine"}, "--refine off"},
       {{"reconstruct", "cube.off", "--no-pictures"}, "--pictures off"},
       {{"reconstruct", "cube.off", "--sphere-poses", "60"}, "--count"},
       {{"reconstruct", "cube.off", "--save-maps", "--out", "run"}, "there are on, off"},
       {{"reconstruct", "cube.off", "--generator", "fibonacci"}, "sphere"},
       {{"candidates", "map.vdb", "--generator=fibonacci"}, "sphere"},
       {{"simulate", "cube.off", "--center", "--sensor", "small.toml"}, "--recenter on"},
       {{"score", "map.vdb", "--feasible", "--body", "1,1,1"}, "there are on, off"},
       {{"integrate", "frames", "--jump-edge-two-sided"}, "there are on, off"},
       {{"integrate", "frames", "--calibrate-hazard"}, "there are on, off"},
       {{"convert", "map.vdb", "b.vdb", "--with-covariance"}, "there are on, off"},
       {{"simulate", "cube.off", "--sensor", "small.toml", "--out", "frames", "--shell", "9,1,2,5"},
        "--seed"},
       {{"simulate", "cube.off", "--sensor", "small.toml", "--out", "frames", "--sphere",
         "9,1,0,0,0"},
        "--center"},
       {{"simulate", "cube.off", "--sensor", "small.toml", "--out", "frames", "--size", "0",
         "--orbit", "1,6,20"},
        "--size 0"}},
      14);
}

TEST_F(Spelling, SetsOfPosesAreTheSameEverywhere) {
  int cases = 0;
  for (const std::string set :
       {"--sphere 3,4", "--dome 3,4", "--rings 48,4", "--shell 3,3,4", "--orbit 3,4,20"}) {
    const std::size_t space = set.find(' ');
    const Strings poses{
        set.substr(0, space), set.substr(space + 1), "--center", "1,1,1", "--seed", "7"};
    Strings simulate{"simulate", "cube.off", "--sensor", "small.toml",   "--out",
                     "frames",   "--noise",  "off",      "--background", "0"};
    simulate.insert(simulate.end(), poses.begin(), poses.end());
    run_well(simulate);
    run_well({"integrate", "frames", "--voxel", "0.2", "--out", "map.vdb"});
    Strings score{"score", "map.vdb", "--sensor", "small.toml", "--out", "of_set.csv"};
    score.insert(score.end(), poses.begin(), poses.end());
    run_well(score);
    run_well({"score", "map.vdb", "--sensor", "small.toml", "--poses", "frames/poses.txt", "--out",
              "of_file.csv"});
    // The file's numbers round: gains agree to a thousandth.
    const std::vector<double> by_set = gains("of_set.csv"), by_file = gains("of_file.csv");
    ASSERT_EQ(by_set.size(), by_file.size()) << set;
    ASSERT_GE(by_set.size(), 3U) << set;
    for (std::size_t i = 0; i < by_set.size(); ++i) {
      EXPECT_GT(by_set[i], 0) << set;
      EXPECT_NEAR(by_set[i], by_file[i], 1e-3 * by_set[i]) << set;
    }
    ++cases;
  }
  EXPECT_EQ(cases, 5);
}

TEST_F(Spelling, AMeshKeepsItsSizeUnlessAsked) {
  const auto reconstruct = [this](const Strings& more) {
    Strings arguments{"reconstruct", "cube.off",    "--sensor", "small.toml", "--voxel",
                      "0.1",         "--out",       "run",      "--quiet",    "--pictures",
                      "off",         "--max-views", "1"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    run_well(arguments);
    return read("run/run.json");
  };
  EXPECT_NE(reconstruct({}).find("\"size\": 2.0,"), std::string::npos) << read("run/run.json");
  EXPECT_NE(reconstruct({"--size", "1.5"}).find("\"size\": 1.5,"), std::string::npos);
  const test::ProgramResult large = run({"reconstruct", "cube.off", "--sensor", "small.toml",
                                         "--voxel", "1", "--size", "2000", "--out", "large"});
  EXPECT_EQ(large.exit_code, 2);
  EXPECT_NE(large.err.find("2000 m"), std::string::npos) << large.err;
  EXPECT_NE(large.err.find("in millimetres? (--size)"), std::string::npos) << large.err;
  // From outside the cube of 2 m and 4 m away; the wall of a cube of 0.35 m would be farther.
  const auto near = [this](const Strings& more) {
    Strings arguments{"simulate", "cube.off", "--orbit",    "1,4,0",        "--center",
                      "1,1,1",    "--sensor", "small.toml", "--background", "0",
                      "--out",    "frames",   "--json"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    const std::string json = run_well(arguments);
    const std::size_t at = json.find("\"readings\": ") + 12;
    return std::stoi(json.substr(at));
  };
  EXPECT_EQ(near({}), near({"--size", "2"}));
  EXPECT_NE(near({}), near({"--size", "1"}));
}

}  // namespace
}  // namespace viewgain
