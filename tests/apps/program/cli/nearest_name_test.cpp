// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0

#include <gtest/gtest.h>

#include <random>
#include <string>
#include <vector>

#include "apps/program_runner.hpp"
#include "viewgain/support/text.hpp"

namespace viewgain {
namespace {

// The same by its definition, from the words' ends.
std::size_t slow_edits(const std::string& a, const std::string& b) {
  if (a.empty() || b.empty()) return a.size() + b.size();
  const std::string a1 = a.substr(0, a.size() - 1), b1 = b.substr(0, b.size() - 1);
  std::size_t least = std::min({slow_edits(a1, b) + 1, slow_edits(a, b1) + 1,
                                slow_edits(a1, b1) + (a.back() == b.back() ? 0 : 1)});
  if (!a1.empty() && !b1.empty() && a.back() == b1.back() && a1.back() == b.back()) {
    least =
        std::min(least, slow_edits(a1.substr(0, a1.size() - 1), b1.substr(0, b1.size() - 1)) + 1);
  }
  return least;
}

TEST(NearestName, EditsAreThoseOfTheDefinition) {
  std::mt19937 random(7);
  int cases = 0;
  for (; cases < 300; ++cases) {
    std::string words[2];
    for (std::string& word : words) {
      for (auto length = random() % 6; length > 0; --length) {
        word += static_cast<char>('a' + random() % 3);
      }
    }
    EXPECT_EQ(edits_between(words[0], words[1]), slow_edits(words[0], words[1]))
        << words[0] << ' ' << words[1];
  }
  EXPECT_EQ(cases, 300);
}

TEST(NearestName, IsWhatWasProbablyMeant) {
  const std::vector<std::string> names{"--voxel", "--workspace", "--stop-gain", "--stop-area",
                                       "--gain"};
  EXPECT_EQ(nearest_name("--voxle", names), "--voxel");
  EXPECT_EQ(nearest_name("--work", names), "--workspace");
  EXPECT_EQ(nearest_name("--stop-aera", names), "--stop-area");
  EXPECT_EQ(nearest_name("--gian", names), "--gain");
  EXPECT_EQ(nearest_name("--picture", names), std::nullopt);
  EXPECT_EQ(nearest_name("x", {"y", "zz"}), "y");
  EXPECT_EQ(nearest_name("ab", {"cd"}), std::nullopt);
  EXPECT_EQ(did_you_mean("--gian", names), "; did you mean --gain?");
  EXPECT_EQ(did_you_mean("nothing", names), "");
  EXPECT_EQ(listed({"a", "b", "c"}), "a, b, c");
}

// What is misspelled is refused by naming what was meant.

class Spelling : public test::ProgramTest {
 protected:
  Spelling() {
    write_cube();
    write_small_sensor();
  }
};

TEST_F(Spelling, TheNearestIsNamed) {
  expect_refused(
      {{{"scor"},
        "unknown subcommand scor; did you mean score? Valid values: model, reconstruct, simulate"},
       {{"zzz"}, "unknown subcommand zzz; valid values: model, reconstruct, simulate"},
       {{"--versoin"}, "did you mean --version?"},
       {{"info", "map.vdb", "--jsno"}, "--jsno: info has no such flag; did you mean --json?"},
       {{"score", "map.vdb", "--poss=5,1"},
        "--poss: score has no such flag; did you mean --poses?"},
       {{"convert", "map.vdb", "--out", "map.ot"},
        "--out: OUT is a positional argument; give it without -- (see"},
       {{"reconstruct", "--voxel=0.01", "--policy=best", "--sensor=sr4000", "--out=run", "--",
         "cube.off"},
        "--policy: unknown policy best"},
       {{"reconstruct", "--nonsense"}, "--nonsense: reconstruct has no such flag (see"},
       {{"score", "map.vdb", "--gain", "surfce"},
        "--gain: unknown gain surfce; did you mean surface? Valid values: paper, surface, "
        "combined"},
       {{"next", "map.vdb", "--generator", "boundry"}, "did you mean boundary?"},
       {{"reconstruct", "cube.off", "--policy", "fronteir"}, "did you mean frontier?"},
       {{"integrate", "frames", "--out-of-range", "carv"}, "did you mean carve?"},
       {{"reconstruct", "cube.off", "--stop", "ares=2"}, "did you mean area?"},
       {{"sensors", "sr400"}, "did you mean sr4000?"},
       {{"simulate", "cube.off", "--sensor", "kinect", "--poses", "orbit:1,6,20", "--out",
         "frames"},
        "did you mean kinect_v1? (presets: sr4000"},
       {{"score", "map.vdb", "--top"}, "--top: the flag requires a value"},
       {{"simulate", "cube.off", "--out", "--quiet"}, "--out: the flag requires a value"},
       {{"scor", "map.vdb", "--poses", "sphere:3,0.6"}, "did you mean score?"},
       {{"follow", "frames", "--voxel", "0.1"}, "viewgain model FRAMES_DIR --watch"},
       {{"candidates", "map.vdb", "--out", "c.txt"}, "viewgain next MAP --top all"},
       {{"simulate", "cube.off", "--amplitude", "on"}, "shot noise"},
       {{"info", "a.vdb", "b.vdb"}, "b.vdb: info accepts no further arguments"},
       {{"simulate", "cube.off", "--noise", "pose=0.1,0.5", "--sensor", "sr4000", "--poses",
         "orbit:1,1,1", "--out", "frames"},
        "--noise"},
       {{"score", "map.vdb", "--gain", "--top", "3"}, "--gain"}});
}

}  // namespace
}  // namespace viewgain
