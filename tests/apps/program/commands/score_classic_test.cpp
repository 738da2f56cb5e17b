// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0

// `score` by gains of the literature: against the library's own answers, and what it refuses.
#include <algorithm>
#include <sstream>
#include <string>
#include <vector>

#include "apps/program_runner.hpp"
#include "program/cli/json.hpp"
#include "viewgain/core/generators.hpp"
#include "viewgain/formats/sensor_toml.hpp"
#include "viewgain/grid/vdb_io.hpp"
#include "viewgain/literature/classic_gains.hpp"

namespace viewgain {
namespace {

class ScoreClassic : public test::ProgramTest {
 protected:
  ScoreClassic() : poses(sphere_poses(40, 0.45)) {
    write_small_sensor();
    for (int x = -10; x < 10; ++x) {
      for (int y = -10; y < 10; ++y) {
        for (int z = 0; z < 10; ++z) grid.set({x, y, z}, -0.1F * static_cast<float>(1 + (x & 7)));
      }
    }
    for (int x = -3; x < 3; ++x) {
      for (int y = -3; y < 3; ++y) grid.set({x, y, 4}, 0.85F);
    }
    grid.append_view(poses[0]);
    save_vdb(grid, dir / "map.vdb");
  }

  [[nodiscard]] static Strings arguments(const Strings& more) {
    return test::joined({"score", "map.vdb", "--sensor", "small.toml", "--sphere", "40,0.45"},
                        more);
  }

  [[nodiscard]] std::vector<double> library(const ClassicConfig& config) const {
    const Sensor sensor = load_sensor((dir / "small.toml").string());
    const auto map = ClassicMap::build(VoxelScene::build(grid), grid, Acquisition{sensor});
    return ClassicGainEvaluator(map, sensor, config).evaluate(poses);
  }

  BeliefGrid grid{{0.02, {{-0.2, -0.2, -0.2}, {0.2, 0.2, 0.2}}, {}, 0.02}};
  std::vector<Pose> poses;
};

TEST_F(ScoreClassic, AllGainsAreTheLibrarys) {
  std::string names;
  ClassicConfig config;
  for (const std::string& name : classic_gain_names()) {
    names.append(names.empty() ? "" : ",").append(name);
    config.gains.push_back(parse_classic_gain(name));
  }
  std::size_t compared = 0;
  for (const std::string& semantics : gain_semantics_names()) {
    config.semantics = parse_gain_semantics(semantics);
    config.pixel_stride = 2;
    const std::vector<double> expected = library(config);
    const json result =
        json::parse(run_well(arguments({"--gain", names, "--semantics", semantics, "--stride", "2",
                                        "--top", "40", "--json", "--out", "all.csv"})));
    EXPECT_EQ(result.at("gains"), json(classic_gain_names()));
    EXPECT_EQ(result.at("semantics"), semantics);
    EXPECT_EQ(result.at("gain_units").size(), 10U);
    ASSERT_EQ(result.at("best").size(), 40U);
    double last = std::numeric_limits<double>::infinity();
    for (const json& view : result.at("best")) {
      EXPECT_EQ(view.at("status"), "ok");
      const auto index = view.at("index").get<std::size_t>();
      for (std::size_t g = 0; g < 10; ++g) {
        EXPECT_EQ(view.at(classic_gain_names()[g]).get<double>(), expected[index * 10 + g]);
        ++compared;
      }
      EXPECT_LE(view.at("occlusion_aware").get<double>(), last);
      last = view.at("occlusion_aware").get<double>();
    }
    std::istringstream csv(read("all.csv"));
    std::string line;
    std::getline(csv, line);
    EXPECT_EQ(line, "index," + names + ",status,tx,ty,tz,qx,qy,qz,qw");
    std::size_t rows = 0;
    for (; std::getline(csv, line); ++rows) {
      EXPECT_EQ(std::count(line.begin(), line.end(), ','), 18);
      EXPECT_TRUE(line.starts_with(std::to_string(rows) + ",")) << line;
    }
    EXPECT_EQ(rows, 40U);
  }
  EXPECT_EQ(compared, 800U);
}

TEST_F(ScoreClassic, RanksByTheFirstAndDropsPoses) {
  const json result = json::parse(
      run_well(arguments({"--gain", "unknown_count,occlusion_aware", "--top", "3", "--json",
                          "--feasible", "on", "--obstacle", "0.3,-1,-1,0.4,1,1"})));
  EXPECT_EQ(result.at("best").size(), 3U);
  EXPECT_GT(result.at("dropped").size(), 0U);
  EXPECT_LT(result.at("poses_scored").get<std::size_t>(), 40U);
  EXPECT_GE(result.at("best")[0].at("unknown_count"), result.at("best")[2].at("unknown_count"));
  const std::string table = run_well(arguments({"--gain", "unknown_volume,area_factor"}));
  EXPECT_NE(table.find("unknown_volume [m^3]"), std::string::npos);
  EXPECT_NE(table.find("area_factor [1]"), std::string::npos);
}

TEST_F(ScoreClassic, RefusesWhatDoesNotGoTogether) {
  const test::Refusals flags{{{"--race"}, "--race"},
                             {{"--set", "2"}, "--set"},
                             {{"--approximate", "0.1"}, "--approximate"},
                             {{"--picture", "p.png"}, "--picture"},
                             {{"--report", "r.html"}, "--report"},
                             {{"--weight", "0,0,0,1,1,1,2"}, "--weight"},
                             {{"--criterion", "trace"}, "--criterion"},
                             {{"--prior-sigma", "0.1"}, "--prior-sigma"},
                             {{"--object-size", "0.1"}, "--object-size"},
                             {{"--refinement-weight", "0.1"}, "--refinement-weight"}};
  expect_refused_with(arguments({"--gain", "unknown_count"}), flags);
  expect_refused_with(arguments({}), {{{"--gain", "paper,unknown_count"}, "paper stands alone"},
                                      {{"--gain", "unknown_count,unknown_count"}, "twice"},
                                      {{"--gain", "unknwn_count"}, "unknown_count"},
                                      {{"--semantics", "shipped"}, "--semantics shipped"}});
  // A map that remembers no views.
  BeliefGrid blank({0.02, {{-0.2, -0.2, -0.2}, {0.2, 0.2, 0.2}}, {}, 0.02});
  save_vdb(blank, dir / "map.vdb");
  expect_refused(arguments({"--gain", "proximity_count"}), "remembers no views");
}

}  // namespace
}  // namespace viewgain
