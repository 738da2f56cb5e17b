// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <string>

#include "viewgain/core/error.hpp"
#include "viewgain/raycast/simulated_sensor.hpp"
#include "viewgain/support/text.hpp"

namespace viewgain {
namespace {

// A board in the plane z = 0, wide enough for one pixel.
TriangleMesh board() {
  constexpr double kHalf = 100.0;  // [m]
  TriangleMesh mesh;
  mesh.vertices = {{-kHalf, -kHalf, 0}, {kHalf, -kHalf, 0}, {kHalf, kHalf, 0}, {-kHalf, kHalf, 0}};
  mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
  return mesh;
}

}  // namespace

RangeCalibration measure_calibration(const Sensor& sensor, const SimulationConfig& config,
                                     double min_range, double max_range, std::size_t count) {
  sensor.validate();
  if (!(count >= 2 && min_range > 0 && min_range < max_range && min_range >= sensor.min_range &&
        max_range <= sensor.max_range && max_range < unambiguous_range(sensor.noise))) {
    throw Error(ErrorCode::invalid_argument, "cannot calibrate " + sensor.name + " at " +
                                                 std::to_string(count) + " ranges from " +
                                                 short_text(min_range) + " to " +
                                                 short_text(max_range) + " m");
  }
  // One pixel that looks straight ahead, and that reads on where the error leaves the range limits.
  Sensor probe = sensor;
  probe.camera = {.width = 1,
                  .height = 1,
                  .fx = sensor.camera.fx,
                  .fy = sensor.camera.fy,
                  .cx = 0,
                  .cy = 0,
                  .distortion = {}};
  probe.min_range = 0;
  probe.max_range = 2 * sensor.max_range;
  SimulationConfig undisturbed = config;
  undisturbed.background_radius = 0;
  undisturbed.noise = false;
  undisturbed.lateral_noise = false;
  undisturbed.calibration = {};
  undisturbed.support_plane.reset();
  const ExecConfig caller_alone{1};
  const SimulatedSensor camera(std::make_shared<const SurfaceScene>(board(), caller_alone), probe,
                               undisturbed, caller_alone);

  RangeCalibration calibration;
  for (std::size_t i = 0; i < count; ++i) {
    const double share = static_cast<double>(i) / static_cast<double>(count - 1);
    const double distance = min_range + share * (max_range - min_range);
    const Pose T_world_camera(Eigen::Matrix3d::Identity(), {0, 0, -distance});
    const double reading = camera.acquire(T_world_camera).depth[0];
    if (!(reading > 0) || !std::isfinite(reading)) {
      throw Error(
          ErrorCode::invalid_argument,
          "cannot calibrate " + sensor.name + ": no reading at " + short_text(distance) + " m");
    }
    calibration.table.push_back({reading, reading - distance});
  }
  calibration.validate();
  return calibration;
}

}  // namespace viewgain
