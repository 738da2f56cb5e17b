// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0

// What integrators note of a map's origin.
#include "viewgain/grid/map_notes.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cstddef>
#include <set>
#include <string>
#include <vector>

#include "core/expect_error.hpp"
#include "grid/analytic_frames.hpp"
#include "viewgain/core/generators.hpp"
#include "viewgain/grid/belief_grid.hpp"
#include "viewgain/grid/integrate.hpp"

namespace viewgain {
namespace {

using test::expect_error;
using test::small_sensor;

class MapNotesTest : public ::testing::Test {
 protected:
  Sensor sensor = small_sensor(8, 6);
  BeliefGrid grid{GridConfig{0.05, {{-0.5, -0.5, -0.5}, {0.5, 0.5, 0.5}}, {}, 0.1}};

  [[nodiscard]] static DepthFrame frame_of(const std::string& identity) {
    DepthFrame frame{8, 6, std::vector<float>(48, 1.0F)};
    frame.identity = identity;
    return frame;
  }
  void add(const Sensor& of, const std::string& identity = {}) {
    FrameIntegrator(of).integrate(grid, frame_of(identity), look_at({1, 0, 0}, {0, 0, 0}));
  }
  void add_cloud(const Sensor& of) {
    const std::vector<std::array<double, 3>> points{{0, 0, 0}, {0, 0.1, 0}};
    CloudIntegrator(of).integrate(grid, points, look_at({1, 0, 0}, {0, 0, 0}));
  }
  [[nodiscard]] const std::string& noted() const { return grid.notes().sensor; }
};

TEST_F(MapNotesTest, AMapNotesTheFramesThatHaveAnIdentity) {
  const std::string a = "0123456789abcdef a.png", b = "0123456789abcdef b.png";
  add(sensor, b);
  add(sensor);
  add(sensor, a);
  add(sensor, b);
  EXPECT_EQ(grid.notes().frames, (std::set<std::string>{a, b}));
  EXPECT_EQ(grid.views().size(), 4U);
  const BeliefGrid copy = grid.clone();
  EXPECT_EQ(copy.notes(), grid.notes());
  add(sensor, "0123456789abcdef c.png");
  EXPECT_EQ(copy.notes().frames.size(), 2U);
  const std::string hash = grid.content_hash();
  expect_error(ErrorCode::invalid_argument, "a space and a name, not 'a.png'",
               [&] { add(sensor, "a.png"); });
  EXPECT_EQ(grid.content_hash(), hash);
}

TEST_F(MapNotesTest, ASensorIsNotedWhileItIsTheOnlyOne) {
  EXPECT_EQ(noted(), "");
  add(sensor);
  EXPECT_EQ(noted(), sensor_toml(sensor));
  // Name, mounting and housing change no reading.
  Sensor renamed = sensor;
  renamed.name = "another";
  renamed.body_size = {0.1, 0.2, 0.3};
  renamed.T_flange_camera = Pose{};
  add(renamed);
  add_cloud(renamed);
  EXPECT_EQ(noted(), sensor_toml(sensor));
  std::vector<Sensor> others(7, sensor);
  others[0].max_range *= 2;
  others[1].camera.fx += 1e-9;
  others[2].noise = ConstantNoise{};
  others[3].pose_sigma = {1e-3, 0};
  others[4].scale_sigma = 1e-3;
  others[5].range_calibration.table = {{0.5, 1e-3}, {1.0, 2e-3}};
  others[6].out_of_range = Sensor::OutOfRange::invalid;
  for (std::size_t i = 0; i < others.size(); ++i) {
    for (const bool is_cloud : {false, true}) {
      const BeliefGrid before = grid.clone();
      is_cloud ? add_cloud(others[i]) : add(others[i]);
      EXPECT_EQ(noted(), "") << i;
      add(sensor);  // never known again
      EXPECT_EQ(noted(), "") << i;
      grid = before.clone();
    }
  }
}

TEST_F(MapNotesTest, ViewsOfNobodyKnowsWhichSensorStayThat) {
  grid.append_view(look_at({1, 0, 0}, {0, 0, 0}));
  add(sensor);
  EXPECT_EQ(noted(), "");
}

TEST_F(MapNotesTest, ANoteWithoutAViewGivesWayToTheFirstFramesSensor) {
  Sensor other = sensor;
  other.max_range *= 2;
  grid.set_notes({.sensor = sensor_toml(other)});
  add(sensor);
  EXPECT_EQ(noted(), sensor_toml(sensor));
}

}  // namespace
}  // namespace viewgain
