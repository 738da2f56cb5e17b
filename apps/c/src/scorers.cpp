// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "convert.hpp"
#include "viewgain/raycast/view_scorer.hpp"
#include "watcher.hpp"

using namespace viewgain;
using namespace viewgain::c_api;

struct vg_scorer {
  ViewScorer scorer;
};

namespace {

static_assert(VG_FRAME_LOST_POSE == static_cast<int>(FrameVerdict::lost_pose));
static_assert(VG_FRAME_NOTHING_IN_RANGE == static_cast<int>(FrameVerdict::nothing_in_range));
static_assert(VG_FRAME_NOT_METRES == static_cast<int>(FrameVerdict::not_metres));
static_assert(VG_FRAME_OUTSIDE == static_cast<int>(FrameVerdict::outside));

Sensor sensor_with_body(const vg_sensor* given_sensor, const vg_scorer_config& config) {
  Sensor sensor = sensor_of(given_sensor);
  const std::span<const double> size(config.body_size);
  if (std::any_of(size.begin(), size.end(), [](double side) { return side != 0; })) {
    sensor.body_size = std::to_array(config.body_size);
  }
  if (config.has_flange != 0) sensor.T_flange_camera = rigid_pose_of(config.T_flange_camera);
  return sensor;
}

ScorerConfig settings_of(const vg_scorer_config& config) {
  ScorerConfig settings;
  settings.voxel_size = config.voxel_size;
  settings.workspace = {std::to_array(config.box_min), std::to_array(config.box_max)};
  settings.T_world_grid = rigid_pose_of(config.T_world_grid);
  settings.prior_sigma = given(config.prior_sigma);
  Surroundings surroundings = surroundings_of(config);
  settings.support_plane = surroundings.support_plane;
  settings.obstacles = std::move(surroundings.obstacles);
  settings.jump_edges.reset();
  if (config.jump_edge_angle != 0) {
    settings.jump_edges.emplace();
    settings.jump_edges->angle = config.jump_edge_angle;
  }
  set_scales(config, settings);
  settings.hazard.object_size = given(config.object_size);
  settings.gain.model = enum_of<GainModel>(config.gain, VG_GAIN_COMBINED, "gain");
  settings.gain.pixel_stride = config.pixel_stride;
  settings.clearance = config.clearance;
  return settings;
}

}  // namespace

template <>
vg_scorer_config viewgain::c_api::defaults() noexcept {
  const ScorerConfig own;
  vg_scorer_config config{};
  config.gain = static_cast<std::int32_t>(own.gain.model);
  config.pixel_stride = own.gain.pixel_stride;
  config.voxel_size = own.voxel_size;
  std::copy(own.workspace.min.begin(), own.workspace.min.end(), config.box_min);
  std::copy(own.workspace.max.begin(), own.workspace.max.end(), config.box_max);
  write_pose(Pose{}, config.T_world_grid);
  write_pose(Pose{}, config.T_flange_camera);
  config.prior_sigma = config.support_plane = config.object_size = kNone;
  config.jump_edge_angle = own.jump_edges->angle;
  return config;
}

VG_DEFINE_INIT(vg_scorer_config)
VG_DEFINE_INIT(vg_map_update)
VG_DEFINE_INIT(vg_consistency)

vg_status vg_scorer_create(const vg_sensor* sensor, const vg_scorer_config* config,
                           vg_scorer** scorer) {
  return make_handle(scorer, "scorer", {}, [&] {
    const vg_scorer_config chosen = read_config(config, "vg_scorer_config");
    return ViewScorer(sensor_with_body(sensor, chosen), settings_of(chosen),
                      exec_of(chosen.num_threads, chosen.tracer));
  });
}

vg_status vg_scorer_load(const char* path, const vg_sensor* sensor, const vg_scorer_config* config,
                         vg_scorer** scorer) {
  return make_handle(scorer, "scorer path", {path}, [&] {
    const vg_scorer_config chosen = read_config(config, "vg_scorer_config");
    return ViewScorer::load(path, sensor_with_body(sensor, chosen), settings_of(chosen),
                            exec_of(chosen.num_threads, chosen.tracer));
  });
}

vg_status vg_scorer_save(const vg_scorer* scorer, const char* path) {
  return guarded("scorer path", {scorer, path}, [&] { scorer->scorer.save(path); });
}

void vg_scorer_release(vg_scorer* scorer) { delete scorer; }

vg_status vg_scorer_add(vg_scorer* scorer, const float* depth, const float* amplitude,
                        const double T_world_camera[16], const double pose_sigma[2],
                        vg_map_update* update) {
  return guarded("scorer depth T_world_camera", {scorer, depth, T_world_camera}, [&] {
    if (update != nullptr) require_struct(update, "vg_map_update");
    const DepthFrame frame = frame_of(scorer->scorer.sensor().camera, depth, amplitude);
    const MapUpdate added =
        scorer->scorer.add(frame, pose_of(T_world_camera), pose_sigma_of(pose_sigma));
    if (update == nullptr) return;
    write_struct(update, {.struct_size = 0,
                          .verdict = static_cast<std::int32_t>(added.verdict),
                          .readings = added.counts.readings,
                          .readings_inside = added.counts.readings_inside,
                          .voxels_hit = added.counts.voxels_hit,
                          .voxels_crossed = added.counts.voxels_crossed,
                          .flying_pixels = added.flying_pixels,
                          .new_area = added.new_area});
  });
}

vg_status vg_scorer_set(vg_scorer* scorer, const int32_t first[3], const int32_t dims[3],
                        const uint8_t* labels, uint64_t* changed) {
  return guarded("scorer first dims labels", {scorer, first, dims, labels}, [&] {
    const VoxelBox box = box_in(scorer->scorer.voxels(), first, dims);
    const std::uint64_t count = scorer->scorer.set(box, {labels, box.volume()});
    if (changed != nullptr) *changed = count;
  });
}

vg_status vg_scorer_forget(vg_scorer* scorer, const double min[3], const double max[3],
                           uint64_t* forgotten) {
  return guarded("scorer min max", {scorer, min, max}, [&] {
    const std::uint64_t count =
        scorer->scorer.forget({{min[0], min[1], min[2]}, {max[0], max[1], max[2]}});
    if (forgotten != nullptr) *forgotten = count;
  });
}

vg_status vg_scorer_evaluate(const vg_scorer* scorer, const double* poses, size_t count,
                             double* gains, const vg_watch* watch) {
  return guarded("scorer gains", {scorer, sized(gains, count)}, [&] {
    Watcher watcher(watch, count);
    const std::vector<Pose> candidates = poses_of(poses, count);
    std::vector<ViewGain> views(count);
    const auto evaluator = scorer->scorer.evaluator();
    bool complete = true;
    if (count == 1 && watch == nullptr) {
      views[0] = evaluator->evaluate(candidates[0]);  // uses all threads
    } else {
      complete = evaluator->evaluate(candidates, views, watcher.control()) == count;
    }
    for (std::size_t i = 0; i < count; ++i) gains[i] = views[i].gain;
    watcher.finish(complete);
  });
}

vg_status vg_scorer_best(const vg_scorer* scorer, const double* poses, size_t count, size_t k,
                         const double* costs, double deadline, size_t* indices, double* gains,
                         size_t* found, const vg_watch* watch) {
  return guarded("scorer indices found", {scorer, sized(indices, k), found}, [&] {
    *found = 0;
    Watcher watcher(watch, count);
    BestConfig config{.deadline = deadline};
    if (costs != nullptr) config.costs = {costs, count};
    const BestViews best =
        scorer->scorer.best(poses_of(poses, count), k, config, watcher.control());
    std::copy(best.indices.begin(), best.indices.end(), indices);
    *found = best.indices.size();
    for (std::size_t i = 0; gains != nullptr && i < best.gains.size(); ++i) {
      gains[i] = best.gains[i].gain;
    }
    watcher.finish(best.complete);
  });
}

vg_status vg_scorer_grid(const vg_scorer* scorer, vg_grid** grid) {
  return make_handle(grid, "grid scorer", {scorer}, [&] { return scorer->scorer.grid().clone(); });
}

vg_status vg_scorer_scene(const vg_scorer* scorer, vg_scene** scene) {
  return make_handle(scene, "scene scorer", {scorer}, [&] { return scorer->scorer.scene(); });
}

vg_status vg_scorer_evaluator(const vg_scorer* scorer, vg_evaluator** evaluator) {
  return make_handle(evaluator, "evaluator scorer", {scorer}, [&] {
    return scorer->scorer.evaluator()->with_scene(scorer->scorer.scene());
  });
}

vg_status vg_scorer_consistency(const vg_scorer* scorer, vg_consistency* found,
                                int32_t* contradicts, size_t capacity) {
  return guarded("scorer found", {scorer, found}, [&] {
    require_struct(found, "vg_consistency");
    const FrameConsistency all = scorer->scorer.consistency();
    if (contradicts != nullptr) {
      if (capacity < all.frames.size()) {
        refuse("capacity is " + std::to_string(capacity) +
               "; it must be at least the number of frames, " + std::to_string(all.frames.size()));
      }
      std::fill_n(contradicts, all.frames.size(), 0);
      for (const std::size_t frame : all.contradicting) contradicts[frame] = 1;
    }
    vg_consistency result{};
    result.frames = all.frames.size();
    result.contradicting = all.contradicting.size();
    result.share_in_free = all.share_in_free;
    result.share_seen_past = all.share_seen_past;
    result.displacement = all.displacement;
    result.expected = all.expected;
    all.suspicion.kind.copy(result.kind, sizeof result.kind - 1);
    all.suspicion.what.copy(result.what, sizeof result.what - 1);
    write_struct(found, result);
  });
}
