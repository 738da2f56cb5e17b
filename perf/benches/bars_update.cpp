// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0

// A scene after one more frame, made from the scene before or anew.
#include <algorithm>
#include <cmath>

#include "bars.hpp"
#include "measure.hpp"
#include "support/camel_scene.hpp"
#include "viewgain/raycast/gain_evaluator.hpp"

namespace viewgain::bench {
namespace {

constexpr double kShareSeen = 0.125;  // of the workspace

/// The half edges of a window round the image's middle, as a share of the image's.
bool is_in_window(const PinholeCamera& camera, double u, double v, double share) {
  return std::abs(u + 0.5 - 0.5 * camera.width) <= 0.5 * share * camera.width &&
         std::abs(v + 0.5 - 0.5 * camera.height) <= 0.5 * share * camera.height;
}

/// Of points spread evenly over the workspace, the share that the window looks at.
double share_seen(const PinholeCamera& camera, const Pose& T_world_camera, const Box& workspace,
                  double window) {
  constexpr int kPoints = 48;  // a side
  const Pose T_camera_world = T_world_camera.inverse();
  const Eigen::Vector3d low(workspace.min.data()), high(workspace.max.data());
  const Eigen::Vector3d step = (high - low) / kPoints;
  int seen = 0;
  for (int i = 0; i < kPoints * kPoints * kPoints; ++i) {
    const Eigen::Vector3d cell(i / (kPoints * kPoints) + 0.5, i / kPoints % kPoints + 0.5,
                               i % kPoints + 0.5);
    const Eigen::Vector2d pixel = camera.project(T_camera_world * (low + cell.cwiseProduct(step)));
    seen += is_in_window(camera, pixel.x(), pixel.y(), window) ? 1 : 0;
  }
  return seen / static_cast<double>(kPoints * kPoints * kPoints);
}

/// The frame with all pixels invalid but those of a window that looks at an eighth of the
/// workspace.
DepthFrame eighth_of(test::CamelView view, const Sensor& sensor, const Box& workspace) {
  double low = 0, high = 1;
  for (int i = 0; i < 12; ++i) {
    const double middle = 0.5 * (low + high);
    const double share = share_seen(sensor.camera, view.T_world_camera, workspace, middle);
    (share < kShareSeen ? low : high) = middle;
  }
  for (int v = 0; v < sensor.camera.height; ++v) {
    for (int u = 0; u < sensor.camera.width; ++u) {
      if (is_in_window(sensor.camera, u, v, high)) continue;
      view.frame.depth[static_cast<std::size_t>(v * sensor.camera.width + u)] = 0;  // invalid
    }
  }
  return view.frame;
}

}  // namespace

std::vector<Figure> update_figures(const BarsOptions& options) {
  const ExecConfig exec{.num_threads = options.num_threads};
  const Sensor sensor = sensor_preset("sr4000");
  constexpr std::size_t kViewsBefore = 3;  // camel-N
  const auto views = test::camel_views(
      kViewsBefore + static_cast<std::size_t>(options.repetitions) + 1, options.mesh);
  BeliefGrid grid =
      test::camel_grid(options.large_voxels, {views.begin(), views.begin() + kViewsBefore});
  FrameIntegrator integrator(sensor, {}, exec);
  auto scene = VoxelScene::build(grid, {}, exec);

  std::vector<double> update_seconds, build_seconds;
  bool agree = true;
  for (std::size_t i = kViewsBefore; i < views.size(); ++i) {
    const DepthFrame frame = eighth_of(views[i], sensor, grid.workspace());
    integrator.integrate(grid, frame, views[i].T_world_camera);
    std::shared_ptr<const VoxelScene> updated, built;
    const double of_update = seconds_of([&] { updated = VoxelScene::update(scene, grid, exec); });
    const double of_build = seconds_of([&] { built = VoxelScene::build(grid, {}, exec); });
    agree = agree && updated->primitive_count() == built->primitive_count();
    scene = updated;
    if (i == kViewsBefore) continue;  // warming up
    update_seconds.push_back(of_update);
    build_seconds.push_back(of_build);
  }
  return {{"update_over_build", median(update_seconds) / median(build_seconds), agree,
           agree ? "" : "scenes differ"}};
}

}  // namespace viewgain::bench
