// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0

// What is misspelled is refused by naming what was meant.
#include <string>

#include "apps/program_runner.hpp"

namespace viewgain {
namespace {

class Spelling : public test::ProgramTest {
 protected:
  Spelling() {
    write_cube();
    write_small_sensor();
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
        "--gain: needs a value; there are paper, surface, combined"}});
}

TEST_F(Spelling, AMeshKeepsItsSizeUnlessAsked) {
  const auto reconstruct = [this](const Strings& more) {
    run_well(test::joined({"reconstruct", "cube.off", "--sensor", "small.toml", "--voxel", "0.1",
                           "--out", "run", "--quiet", "--pictures", "off", "--max-views", "1"},
                          more));
    return read("run/run.json");
  };
  EXPECT_NE(reconstruct({}).find("\"size\": 2.0,"), std::string::npos) << read("run/run.json");
  EXPECT_NE(reconstruct({"--size", "1.5"}).find("\"size\": 1.5,"), std::string::npos);
  const test::ProgramResult large = run({"reconstruct", "cube.off", "--sensor", "small.toml",
                                         "--voxel", "1", "--size", "2000", "--out", "large"});
  EXPECT_EQ(large.exit_code, 2);
  EXPECT_NE(large.err.find("2000 m"), std::string::npos) << large.err;
  EXPECT_NE(large.err.find("in millimetres? (--size)"), std::string::npos) << large.err;
  expect_refused({"simulate", "cube.off", "--sensor", "small.toml", "--out", "frames", "--size",
                  "0", "--orbit", "1,6,20"},
                 "--size 0");
}

}  // namespace
}  // namespace viewgain
