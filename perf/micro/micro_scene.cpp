// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include "micro_scene.hpp"

#include "hit_boxes.hpp"
#include "scene/scene_data.hpp"
#include "viewgain/core/generators.hpp"

namespace viewgain::bench {
namespace {

constexpr int kVoxels = 128;
constexpr std::size_t kViews = 8;

}  // namespace

MicroScene::MicroScene()
    : sensor(sensor_preset("sr4000")),
      frames(test::camel_views(4)),
      grid(test::camel_grid(kVoxels, {frames.begin(), frames.begin() + 3})),
      scene(VoxelScene::build(grid, {}, {.num_threads = 1})),
      tracer(make_tracer(ExecConfig::Tracer::sweep)) {
  for (const Pose& pose : sphere_poses(kViews, 0.6)) {
    View view;
    view.frame = tracer.frame_of(pose).value();
    const auto note = [&](std::size_t number, const detail::RayTile& tile) {
      if (tile.hit == 0) return;
      view.tiles.push_back(tile);
      view.numbers.push_back(number);
      view.leaves.push_back(hit_boxes(tile));
    };
    detail::ViewSweep sweep;
    tracer.prepare(view.frame, sweep);
    tracer.trace(view.frame, sweep, note);
    views.push_back(std::move(view));
  }
}

detail::ViewTracer MicroScene::make_tracer(ExecConfig::Tracer way) const {
  return {detail::SceneAccess::data(*scene),
          std::make_shared<const detail::SensorRays>(sensor.camera, 1), sensor.min_range,
          sensor.max_range, way};
}

const MicroScene& MicroScene::get() {
  static const MicroScene scene;
  return scene;
}

std::vector<Isa> micro_isas() {
  std::vector<Isa> isas;
  for (const Isa isa : supported_isas()) {
    if (isa <= select_isa()) isas.push_back(isa);
  }
  return isas;
}

}  // namespace viewgain::bench
