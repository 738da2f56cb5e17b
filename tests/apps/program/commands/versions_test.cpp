// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0

// Files of earlier versions are read, those of later ones refused by name and number. What 0.1.0
// wrote lies in tests/data/0.1.0, whose make.sh says how.

#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "apps/planner/planner_set_up.hpp"
#include "apps/program_runner.hpp"
#include "viewgain/core/error.hpp"
#include "viewgain/formats/map_file.hpp"
#include "viewgain/formats/reach_toml.hpp"
#include "viewgain/formats/sensor_toml.hpp"
#include "viewgain/grid/integrate.hpp"
#include "viewgain/grid/vdb_io.hpp"
#include "viewgain/support/json.hpp"
#include "viewgain/viewgain.h"

namespace viewgain {
namespace {

class Versions : public test::ProgramTest {
 protected:
  Versions() {
    for (const fs::directory_entry& entry : fs::directory_iterator(VIEWGAIN_DATA "/0.1.0")) {
      fs::copy_file(entry.path(), dir / entry.path().filename());
    }
  }

  // A file with another text in the place of one that it has.
  void change(const std::string& name, const std::string& from, const std::string& to) const {
    std::string bytes = read(name);
    const std::size_t at = bytes.find(from);
    ASSERT_NE(at, std::string::npos) << name << " has no " << from;
    write(name, bytes.replace(at, from.size(), to));
  }

  [[nodiscard]] ViewPlanner planner_of(const char* name) const {
    const Sensor sensor = read_sensor_toml(dir / "sensor.toml");
    test::PlannerSetUp config;
    config.map.voxel_size = 0.0375;
    config.map.workspace = {{0, 0, 0}, {0.3, 0.3, 0.3}};
    config.map.prior_sigma = default_prior_sigma(0.0375, sensor);
    return config.load(dir / name, sensor);
  }
};

TEST_F(Versions, TheFirstOnesFilesAreRead) {
  const std::string made = read("made.txt"), hash = made.substr(made.find('\n') + 1, 16);
  EXPECT_EQ(made.substr(0, made.find('\n')), "viewgain 0.1.0");

  const BeliefGrid map = load_map(dir / "state.vdb");
  EXPECT_EQ(map.content_hash(), hash);
  EXPECT_EQ(map.notes().frames.size(), 2U);
  EXPECT_EQ(map.notes().others.count("planner"), 1U);
  const std::optional<Sensor> of_map = map_sensor(map);
  ASSERT_TRUE(of_map);
  EXPECT_EQ(of_map->name, "small");

  const Sensor sensor = read_sensor_toml(dir / "sensor.toml");
  // A frame more of the same sensor leaves the note, though keys have new names.
  BeliefGrid grown = load_vdb(dir / "state.vdb");
  const std::string note = grown.notes().sensor;
  const auto pixels = static_cast<std::size_t>(sensor.camera.width * sensor.camera.height);
  FrameIntegrator(*of_map).integrate(
      grown, {sensor.camera.width, sensor.camera.height, std::vector<float>(pixels, 0.3F)},
      grown.views().front());
  EXPECT_EQ(grown.notes().sensor, note);
  EXPECT_EQ(sensor.camera.distortion[0], 0.01);
  EXPECT_EQ(sensor.pose_sigma.rotation, 0.002);
  EXPECT_EQ(sensor.range_calibration.table.size(), 2U);
  EXPECT_EQ(sensor.out_of_range, Sensor::OutOfRange::carve);

  const ReachRegion reach = read_reach_toml(dir / "reach.toml");
  EXPECT_EQ(reach.boxes.size(), 1U);
  EXPECT_EQ(reach.shells.size(), 1U);
  EXPECT_EQ(reach.half_spaces.size(), 1U);
  EXPECT_EQ(reach.poses.size(), 4U);

  const ViewPlanner planner = planner_of("state.vdb");
  EXPECT_EQ(planner.scorer().grid().content_hash(), hash);
  EXPECT_EQ(count_of(planner.frames(), FrameVerdict::used), 2U);

  const json run = json::parse(read("run.json")), checkpoint = json::parse(read("checkpoint.json"));
  EXPECT_EQ(run["format"], 1);
  EXPECT_EQ(checkpoint["format"], 1);
  EXPECT_GE(checkpoint["decisions"].size(), 1U);
}

TEST_F(Versions, AMapThatGoesThroughCRemembers) {
  const BeliefGrid before = load_vdb(dir / "state.vdb");
  vg_grid *grid = nullptr, *copy = nullptr;
  ASSERT_EQ(vg_grid_load((dir / "state.vdb").c_str(), &grid), VG_OK) << vg_last_error();
  ASSERT_EQ(vg_grid_clone(grid, &copy), VG_OK) << vg_last_error();
  ASSERT_EQ(vg_grid_save(copy, (dir / "copy.vdb").c_str()), VG_OK) << vg_last_error();
  vg_grid_release(grid);
  vg_grid_release(copy);
  const BeliefGrid after = load_vdb(dir / "copy.vdb");
  EXPECT_EQ(after.notes(), before.notes());
  EXPECT_EQ(after.notes().frames.size(), 2U);
  EXPECT_EQ(after.content_hash(), before.content_hash());
}

TEST_F(Versions, NewerOnesAreRefused) {
  change("sensor.toml", "\nformat = 1", "\nformat = 2");
  change("reach.toml", "format = 1", "format = 2");
  expect_refused(
      {{{"score", "state.vdb", "--poses", "sphere:9,0.5", "--sensor", "sensor.toml"},
        "sensor.toml: line 2: key \"format\" is 2, which is too new; this library reads formats up "
        "to 1"},
       {{"next", "state.vdb", "--generator", "sphere", "--reach", "reach.toml", "--out", "p.txt"},
        "reach.toml: line 1: key \"format\" is 2, which is too new; this library reads formats up "
        "to 1"}});

  change("sensor.toml", "\nformat = 2", "\nformat = 1");
  const BeliefGrid grid = load_vdb(dir / "state.vdb");
  MapNotes notes = grid.notes();
  std::string& planner = notes.others.at("planner");
  planner.replace(planner.find("version 2"), 9, "version 5");
  save_vdb(grid, dir / "newer.vdb", {.notes = notes});
  try {
    (void)planner_of("newer.vdb");
    ADD_FAILURE() << "a newer planner's state was read";
  } catch (const Error& error) {
    EXPECT_NE(std::string(error.what())
                  .find("newer.vdb (note planner):1: version 5 of the planner's state is "
                        "not supported; this library reads versions 2 to 4"),
              std::string::npos)
        << error.what();
  }
}

// Names in a map of somebody else's lead nowhere.
TEST_F(Versions, AStrangersMapWritesNothingElsewhere) {
  Sensor sensor = read_sensor_toml(dir / "sensor.toml");
  sensor.name = "../../evil/<script>";
  const BeliefGrid grid = load_vdb(dir / "state.vdb");
  MapNotes notes = grid.notes();
  notes.sensor = sensor_toml(sensor);
  notes.frames = {"0123456789abcdef ../../evil.depth.png", "0123456789abcdee /tmp/evil.depth.png"};
  fs::create_directories(dir / "in");
  fs::create_directories(dir / "out");
  save_vdb(grid, dir / "in/map.vdb", {.notes = notes});
  fs::rename(dir / "sensor.toml", dir / "in/sensor.toml");
  fs::create_directories(dir / "in/frames");
  write("in/frames/done", "");
  const auto outside = [&] {
    auto files = contents();
    std::erase_if(files, [](const auto& entry) { return entry.first.starts_with("out/"); });
    return files;
  };
  const auto before = outside();
  Strings score{"score",    "in/map.vdb",     "--poses", "sphere:9,0.5",
                "--sensor", "in/sensor.toml", "--out",   "out/s.csv"};
  if (has_report_page()) score.insert(score.end(), {"--report", "out/s.html"});
  std::size_t cases = 0;
  for (const Strings& call : {score,
                              Strings{"next", "in/map.vdb", "--generator", "sphere", "--sensor",
                                      "in/sensor.toml", "--out", "out/c.txt"},
                              Strings{"render", "in/map.vdb", "map", "--out", "out/m.png"},
                              Strings{"convert", "in/map.vdb", "out/m.ot"},
                              Strings{"surface", "in/map.vdb", "--out", "out/s.ply"},
                              Strings{"info", "in/map.vdb", "--json"}}) {
    const test::ProgramResult result = run(call);
    EXPECT_EQ(result.exit_code, 0) << call[0] << ": " << result.err;
    EXPECT_TRUE(outside() == before) << call[0];
    ++cases;
  }
  fs::copy_file(dir / "in/map.vdb", dir / "out/state.vdb");
  (void)run({"model", "in/frames", "--watch", "--sensor", "in/sensor.toml", "--voxel", "0.0375",
             "--workspace", "0,0,0,0.3,0.3,0.3", "--out", "out"});
  EXPECT_TRUE(outside() == before);
  EXPECT_EQ(cases, 6U);
  EXPECT_TRUE(fs::exists(dir / "out/s.csv") && fs::exists(dir / "out/m.ot"));
}

// Programs that were compiled with 0.1.0 hold these, on machines of 64 bits.
#define VG_SIZE(type, size) static_assert(sizeof(type) == (size))
VG_SIZE(vg_watch, 24);
VG_SIZE(vg_scene_config, 112);
VG_SIZE(vg_weight_region, 56);
VG_SIZE(vg_evaluator_config, 88);
VG_SIZE(vg_evaluator_info, 40);
VG_SIZE(vg_view_gain, 72);
VG_SIZE(vg_contribution, 40);
VG_SIZE(vg_ray_outcomes, 40);
VG_SIZE(vg_feasibility_config, 232);
VG_SIZE(vg_sensor, 192);
VG_SIZE(vg_grid_config, 200);
VG_SIZE(vg_grid_info, 288);
VG_SIZE(vg_integrator_config, 56);
VG_SIZE(vg_integration_report, 64);
VG_SIZE(vg_scorer_config, 480);
VG_SIZE(vg_map_update, 64);
VG_SIZE(vg_consistency, 568);
#undef VG_SIZE

}  // namespace
}  // namespace viewgain
