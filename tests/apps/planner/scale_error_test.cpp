// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: GPL-3.0-or-later

// A camera whose ranges are all off by one factor: points are honest where the sensor says so.
#include <gtest/gtest.h>

#include <memory>

#include "apps/planner/planner_scene.hpp"
#include "support/meshes.hpp"
#include "viewgain/core/generators.hpp"
#include "viewgain/grid/fused_points.hpp"
#include "viewgain/grid/integrate.hpp"
#include "viewgain/mesh/quality.hpp"
#include "viewgain/planner/point_arrays.hpp"

namespace viewgain {
namespace {

constexpr double kScaleSigma = 0.015;
constexpr double kRadius = 0.1;  // [m]

// What twelve views, taken `times` times, make of the ball.
BeliefGrid map_of_ball(const Sensor& sensor, double scale_error, std::size_t times) {
  const SimulatedSensor camera(std::make_shared<const SurfaceScene>(test::sphere_mesh(kRadius, 48)),
                               sensor,
                               {.noise = true, .lateral_noise = true, .scale_error = scale_error});
  BeliefGrid grid(test::model_config(sensor, 0.125, 0.005).map.grid());
  FrameIntegrator integrator(sensor);
  const std::vector<Pose> views = sphere_poses(12, 0.4);
  for (std::size_t i = 0; i < times * views.size(); ++i) {
    const Pose& view = views[i % views.size()];
    integrator.integrate(grid, camera.acquire(view, i), view);
  }
  return grid;
}

// Mean of min(z^2, 25).
double consistency(const BeliefGrid& grid, double scale_sigma) {
  const PointArrays points = arrays_of(fused_points(grid, {.scale_sigma = scale_sigma}));
  EXPECT_GT(points.positions.size(), 1000U);
  const Consistency found =
      GroundTruth(test::sphere_mesh(kRadius, 48)).consistency(points.positions, points.covariances);
  EXPECT_LT(found.outliers, points.positions.size() / 100);
  return found.mean_clipped;
}

TEST(ScaleError, PointsAreHonestWhereItIsDeclaredHoweverOftenTheyWereSeen) {
  const Sensor sensor = test::half_sr4000();
  int cases = 0;
  for (const std::size_t times : {std::size_t{1}, std::size_t{4}}) {
    double declared = 0, undeclared = 0;
    // An error of plus and minus a sigma has its variance.
    for (const double error : {-kScaleSigma, kScaleSigma}) {
      const BeliefGrid grid = map_of_ball(sensor, error, times);
      declared += 0.5 * consistency(grid, kScaleSigma);
      undeclared += 0.5 * consistency(grid, 0);
      ++cases;
    }
    EXPECT_GT(declared, 0.8) << times;
    EXPECT_LT(declared, 1.25) << times;
    EXPECT_GT(undeclared, 4) << times;
    EXPECT_LT(consistency(map_of_ball(sensor, 0, times), 0), 1.25) << times;
  }
  EXPECT_EQ(cases, 4);
}

TEST(ScaleError, IsInTheModelOfASensorThatDeclaresIt) {
  Sensor sensor = test::half_sr4000();
  sensor.scale_sigma = kScaleSigma;
  const BeliefGrid grid = map_of_ball(sensor, 0, 1);
  const std::vector<FusedPoint> points = fused_points(grid, {.scale_sigma = kScaleSigma});
  const SurfaceModel model(grid.clone(), sensor, test::model_config(sensor, 0.125, 0.005), {});
  ASSERT_EQ(model.points().size(), points.size());
  for (std::size_t i = 0; i < points.size(); ++i) {
    EXPECT_EQ(model.points()[i].covariance.xx, points[i].covariance.xx);
  }
}

}  // namespace
}  // namespace viewgain
