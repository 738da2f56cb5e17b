// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <span>
#include <string>
#include <vector>

#include "convert.hpp"
#include "viewgain/raycast/gain_evaluator.hpp"
#include "viewgain/support/text.hpp"
#include "watcher.hpp"

using namespace viewgain;
using namespace viewgain::c_api;

namespace {

static_assert(VG_GAIN_COMBINED == static_cast<int>(GainModel::combined));
static_assert(VG_TRACER_SWEEP == static_cast<int>(ExecConfig::Tracer::sweep));
static_assert(VG_TRACE == static_cast<int>(Criterion::trace));
static_assert(VG_VIEW_CAMERA_IN_OCCUPIED == static_cast<int>(ViewGain::Status::camera_in_occupied));
static_assert(VG_HIT_OBSTACLE == static_cast<int>(RayHit::Kind::obstacle));

GainConfig settings_of(const vg_evaluator_config& config) {
  require("weights", {sized(config.weights, config.weight_count)});
  GainConfig settings{.model = enum_of<GainModel>(config.gain, VG_GAIN_COMBINED, "gain"),
                      .criterion = enum_of<Criterion>(config.criterion, VG_TRACE, "criterion"),
                      .pixel_stride = config.pixel_stride,
                      .prior_sigma = given(config.prior_sigma),
                      .min_range = given(config.min_range),
                      .max_range = given(config.max_range),
                      .refinement_weight = config.refinement_weight,
                      .posterior_entropy = config.posterior_entropy != 0};
  for (const vg_weight_region& region : std::span(config.weights, config.weight_count)) {
    settings.weights.push_back(
        {{std::to_array(region.box_min), std::to_array(region.box_max)}, region.weight});
  }
  return settings;
}

/// Scores poses; returns whether all were scored.
bool score(const GainEvaluator& evaluator, std::span<const Pose> poses, std::span<ViewGain> views,
           bool is_watched, const BatchControl& control) {
  if (poses.size() == 1 && !is_watched) {
    views[0] = evaluator.evaluate(poses[0]);
    return true;
  }
  return evaluator.evaluate(poses, views, control) == poses.size();
}

vg_view_gain written(const ViewGain& view) {
  return {.gain = view.gain,
          .exploration = view.exploration,
          .refinement = view.refinement,
          .posterior_entropy = view.posterior_entropy,
          .rays = view.rays,
          .hits = view.hits,
          .unknown_voxels = view.unknown_voxels,
          .occupied_voxels = view.occupied_voxels,
          .status = static_cast<std::int32_t>(view.status),
          .area = view.area,
          .refinement_saturated = view.refinement_saturated};
}

const std::vector<ViewGain>& gains_of(const BestViews& best) { return best.gains; }
const std::vector<ViewGain>& gains_of(const ViewSet& set) { return set.marginal; }

/// Chooses poses with `choose` and writes the results; `gains` may be null.
template <typename Choose>
vg_status choice(const vg_evaluator* evaluator, const double* poses, std::size_t count,
                 std::size_t k, std::size_t total, std::size_t* indices, double* gains,
                 std::size_t* found, const vg_watch* watch, const Choose& choose) {
  return guarded("evaluator indices found", {evaluator, sized(indices, k), found}, [&] {
    *found = 0;
    Watcher watcher(watch, total);
    const auto chosen = choose(poses_of(poses, count), watcher.control());
    std::copy(chosen.indices.begin(), chosen.indices.end(), indices);
    *found = chosen.indices.size();
    const std::vector<ViewGain>& views = gains_of(chosen);
    for (std::size_t i = 0; gains != nullptr && i < views.size(); ++i) gains[i] = views[i].gain;
    watcher.finish(chosen.complete);
  });
}

}  // namespace

template <>
vg_evaluator_config viewgain::c_api::defaults() noexcept {
  vg_evaluator_config config{};
  config.gain = static_cast<std::int32_t>(kDefaultGain);
  config.pixel_stride = 1;
  config.prior_sigma = config.min_range = config.max_range = kNone;
  config.refinement_weight = GainConfig{}.refinement_weight;
  return config;
}

VG_DEFINE_INIT(vg_watch)
VG_DEFINE_INIT(vg_evaluator_config)

vg_status vg_evaluator_create(const vg_scene* scene, const vg_sensor* sensor,
                              const vg_evaluator_config* config, vg_evaluator** evaluator) {
  return make_handle(evaluator, "evaluator scene", {scene}, [&] {
    const vg_evaluator_config chosen = read_config(config, "vg_evaluator_config");
    return GainEvaluator(scene->scene, sensor_of(sensor), settings_of(chosen),
                         exec_of(chosen.num_threads, chosen.tracer));
  });
}

vg_status vg_evaluator_with_scene(const vg_evaluator* evaluator, const vg_scene* scene,
                                  vg_evaluator** following) {
  return make_handle(following, "following evaluator scene", {evaluator, scene},
                     [&] { return evaluator->evaluator.with_scene(scene->scene); });
}

void vg_evaluator_release(vg_evaluator* evaluator) { delete evaluator; }

VG_DEFINE_INIT(vg_evaluator_info)

vg_status vg_evaluator_get_info(const vg_evaluator* evaluator, vg_evaluator_info* info) {
  return guarded("evaluator", {evaluator}, [&] {
    require_struct(info, "vg_evaluator_info");
    const GainEvaluator& own = evaluator->evaluator;
    const PinholeCamera& camera = own.camera();
    const int stride = own.pixel_stride();
    write_struct(info, {.struct_size = 0,
                        .image_width = (camera.width - 1) / stride + 1,
                        .image_height = (camera.height - 1) / stride + 1,
                        .rays_per_pose = own.rays_per_pose(),
                        .num_threads = own.num_threads(),
                        .prior_sigma = own.prior_sigma()});
  });
}

vg_status vg_evaluate(const vg_evaluator* evaluator, const double* poses, size_t count,
                      double* gains, const vg_watch* watch) {
  return guarded("evaluator gains", {evaluator, sized(gains, count)}, [&] {
    Watcher watcher(watch, count);
    const std::vector<Pose> candidates = poses_of(poses, count);
    std::vector<ViewGain> views(count);
    const bool complete =
        score(evaluator->evaluator, candidates, views, watch != nullptr, watcher.control());
    for (std::size_t i = 0; i < count; ++i) gains[i] = views[i].gain;
    watcher.finish(complete);
  });
}

vg_status vg_evaluate_views(const vg_evaluator* evaluator, const double* poses, size_t count,
                            vg_view_gain* views, size_t view_size, const vg_watch* watch) {
  return guarded("evaluator views", {evaluator, sized(views, count)}, [&] {
    require_size<vg_view_gain>(view_size, "vg_view_gain (view_size)");
    Watcher watcher(watch, count);
    const std::vector<Pose> candidates = poses_of(poses, count);
    std::vector<ViewGain> own(count);
    const bool complete =
        score(evaluator->evaluator, candidates, own, watch != nullptr, watcher.control());
    std::transform(own.begin(), own.end(), views, written);
    watcher.finish(complete);
  });
}

vg_status vg_best(const vg_evaluator* evaluator, const double* poses, size_t count, size_t k,
                  size_t* indices, double* gains, size_t* found, const vg_watch* watch) {
  return choice(evaluator, poses, count, k, count, indices, gains, found, watch,
                [&](const std::vector<Pose>& among, const BatchControl& control) {
                  return evaluator->evaluator.best(among, k, {}, control);
                });
}

vg_status vg_race(const vg_evaluator* evaluator, const double* poses, size_t count, size_t k,
                  double deadline, uint64_t seed, size_t* indices, double* gains, size_t* found,
                  const vg_watch* watch) {
  return choice(evaluator, poses, count, k, count, indices, gains, found, watch,
                [&](const std::vector<Pose>& among, const BatchControl& control) {
                  const BestConfig config{.deadline = deadline, .seed = seed};
                  return evaluator->evaluator.race(among, k, config, control);
                });
}

vg_status vg_best_set(const vg_evaluator* evaluator, const double* poses, size_t count, size_t k,
                      size_t* indices, double* gains, size_t* found, const vg_watch* watch) {
  return choice(evaluator, poses, count, k, std::min(k, count), indices, gains, found, watch,
                [&](const std::vector<Pose>& among, const BatchControl& control) {
                  return evaluator->evaluator.best_set(among, k, control);
                });
}

vg_status vg_depth_image(const vg_evaluator* evaluator, const double T_world_camera[16],
                         float* depth, uint8_t* labels, size_t count) {
  return guarded("evaluator T_world_camera depth", {evaluator, T_world_camera, depth}, [&] {
    const std::size_t pixels = evaluator->evaluator.rays_per_pose();
    if (count != pixels) {
      refuse("the array has room for " + std::to_string(count) + " pixels, but the image has " +
             std::to_string(pixels));
    }
    std::vector<RayHit::Kind> kinds;
    const DepthFrame image =
        depth_image(evaluator->evaluator, rigid_pose_of(T_world_camera), &kinds);
    std::copy(image.depth.begin(), image.depth.end(), depth);
    if (labels == nullptr) return;
    std::transform(kinds.begin(), kinds.end(), labels,
                   [](RayHit::Kind kind) { return static_cast<std::uint8_t>(kind); });
  });
}

VG_DEFINE_INIT(vg_ray_outcomes)

vg_status vg_outcomes(const vg_evaluator* evaluator, const double T_world_camera[16],
                      vg_ray_outcomes* outcomes) {
  return guarded("evaluator", {evaluator},
                 [&] { write_outcomes(evaluator->evaluator, T_world_camera, outcomes); });
}

vg_status vg_contributions(const vg_evaluator* evaluator, const double T_world_camera[16],
                           vg_contribution* contributions, size_t contribution_size,
                           size_t capacity, size_t* found) {
  return guarded(
      "evaluator T_world_camera contributions found",
      {evaluator, T_world_camera, sized(contributions, capacity), found}, [&] {
        require_size<vg_contribution>(contribution_size, "vg_contribution (contribution_size)");
        const Pose pose = rigid_pose_of(T_world_camera);
        const std::vector<VoxelContribution> own = evaluator->evaluator.contributions(pose);
        if (own.empty() &&
            evaluator->evaluator.evaluate(pose).status == ViewGain::Status::bad_pose) {
          refuse("the pose deviates from a rigid transform by " +
                 short_text(orthonormality_error(pose)) + "; the tolerance is 1e-3");
        }
        *found = own.size();
        const std::span<const VoxelContribution> wanted(own.data(), std::min(capacity, own.size()));
        std::transform(wanted.begin(), wanted.end(), contributions,
                       [](const VoxelContribution& part) {
                         return vg_contribution{.voxel = {part.voxel.x, part.voxel.y, part.voxel.z},
                                                .state = static_cast<std::int32_t>(part.state),
                                                .rays = part.rays,
                                                .gain = part.gain,
                                                .expected_rays = part.expected_rays};
                       });
      });
}
