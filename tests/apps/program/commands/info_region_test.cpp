// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include <string>

#include "apps/program_runner.hpp"
#include "program/cli/json.hpp"
#include "viewgain/grid/belief_grid.hpp"
#include "viewgain/grid/vdb_io.hpp"

namespace viewgain {
namespace {

class InfoRegion : public test::ProgramTest {
 protected:
  InfoRegion() {
    const GridConfig config{0.01, {{0, 0, 0}, {0.2, 0.1, 0.1}}, {}, 0.02};
    BeliefGrid grid(config);
    for (int i = 0; i < 10; ++i) {
      grid.set({i, 2, 3}, 0.85F, Belief{{1e5F, 2e5F, 3e5F, 0, 0, 0}, {}, 7});
      grid.set({i, 5, 5}, -0.4F);
    }
    save_vdb(grid, dir / "map.vdb");
  }
};

TEST_F(InfoRegion, SaysHowWellAPartIsKnown) {
  const json info = json::parse(run_well({"info", "map.vdb", "--region", "0.025,0,0,0.065,0.1,0.1",
                                          "--criterion", "trace", "--json"}));
  const json& part = info.at("region");
  EXPECT_EQ(part.at("box"), (json{0.025, 0, 0, 0.065, 0.1, 0.1}));
  // Voxels 2 to 5 along x have their centres in it, the last of them at 0.055.
  EXPECT_EQ(part.at("occupied"), 4);
  EXPECT_EQ(part.at("free"), 4);
  EXPECT_EQ(part.at("unknown"), 4 * 100 - 8);
  EXPECT_EQ(part.at("hits"), 28);
  const BeliefGrid::Statistics expected =
      load_vdb(dir / "map.vdb").statistics({{0.025, 0, 0}, {0.065, 0.1, 0.1}}, Criterion::trace);
  EXPECT_EQ(part.at("entropy_removed"), expected.entropy_removed);
  const double variance = (1e-5 + 0.5e-5 + 1e-5 / 3) / 3 + 1e-4 / 12;
  EXPECT_NEAR(part.at("mean_sigma").get<double>(), std::sqrt(variance), 1e-9);

  const std::string text = run_well({"info", "map.vdb", "--region", "0.025,0,0,0.065,0.1,0.1"});
  for (const char* word : {"region", "mean sigma", "hits", "28", "entropy removed"}) {
    EXPECT_NE(text.find(word), std::string::npos) << word << "\n" << text;
  }
  EXPECT_FALSE(json::parse(run_well({"info", "map.vdb", "--json"})).contains("region"));
}

TEST_F(InfoRegion, BadRegionsAreRefused) {
  for (const char* bad : {"0,0,0,1,1", "0,0,0,1,1,0", "5,5,5,6,6,6", "a,0,0,1,1,1"}) {
    expect_refused({"info", "map.vdb", "--region", bad}, "--region");
  }
}

}  // namespace
}  // namespace viewgain
