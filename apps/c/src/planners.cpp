// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "convert.hpp"
#include "planner_handle.hpp"
#include "viewgain/planner.h"
#include "viewgain/planner/view_planner.hpp"
#include "watcher.hpp"

using namespace viewgain;
using namespace viewgain::c_api;

static_assert(VG_FRAME_VERDICTS == kFrameVerdictNames.size());
static_assert(VG_FRAME_NO_MASK == static_cast<int>(FrameVerdict::no_mask));
static_assert(VG_INFEASIBLE_MISSED == static_cast<int>(Infeasibility::too_near) + 1);

namespace {

Sensor sensor_with_body(const vg_sensor* given_sensor, const vg_planner_config& config) {
  Sensor sensor = sensor_of(given_sensor);
  sensor.body_size = std::to_array(config.body_size);
  if (config.has_flange != 0) sensor.T_flange_camera = rigid_pose_of(config.T_flange_camera);
  return sensor;
}

PlannerConfig settings_of(const vg_planner_config& config) {
  PlannerConfig settings;
  settings.grid = {config.voxel_size,
                   {std::to_array(config.box_min), std::to_array(config.box_max)},
                   rigid_pose_of(config.T_world_grid),
                   {}};
  settings.grid.prior_sigma = given(config.prior_sigma);
  settings.surroundings = surroundings_of(config);
  set_scales(config, settings.integration);
  settings.jump_edges.reset();
  if (config.jump_edge_angle != 0) {
    settings.jump_edges.emplace();
    settings.jump_edges->angle = config.jump_edge_angle;
  }
  settings.gain.model = enum_of<GainModel>(config.gain, VG_GAIN_COMBINED, "gain");
  settings.check_feasibility = config.check_feasibility != 0;
  settings.clearance = config.clearance;
  settings.reach.predicate = predicate_of(config.reachable, config.user);
  settings.max_views = static_cast<std::size_t>(config.max_views);
  settings.idle_views = static_cast<std::size_t>(config.idle_views);
  settings.broken_promises = static_cast<std::size_t>(config.broken_promises);
  settings.ahead.plan = static_cast<std::size_t>(config.plan);
  settings.ahead.take = static_cast<std::size_t>(config.take);
  settings.stop_gain = given(config.stop_gain);
  settings.stop_area = given(config.stop_area);
  return settings;
}

// In the order of StopReason; a planner has none of those after max_views.
std::int32_t code_of(std::optional<StopReason> reason) {
  return reason ? static_cast<std::int32_t>(*reason) + 1 : VG_GO_ON;
}
static_assert(static_cast<int>(StopReason::gain) + 1 == VG_STOP_GAIN);
static_assert(static_cast<int>(StopReason::max_views) + 1 == VG_STOP_MAX_VIEWS);

// "" for what is none.
std::string_view reason_name(std::size_t reason) {
  if (reason == VG_INFEASIBLE_MISSED) return kMissed;
  if (reason > VG_INFEASIBLE_MISSED) return "";
  return infeasibility_name(static_cast<Infeasibility>(reason));
}

vg_ranked_view written(const RankedView& view) {
  vg_ranked_view out{};
  out.index = view.index;
  write_pose(view.T_world_camera, out.T_world_camera);
  out.gain = view.gain.gain;
  out.area = view.gain.area;
  out.worth = view.worth;
  return out;
}

// What both rankings take but for the poses.
struct RankCall {
  std::size_t k;
  const double* costs;
  std::size_t cost_count;
  double cost_per_metre;
  const double* current_pose;
  vg_ranked_view* views;
  std::size_t view_size;
  std::size_t* found;
  const vg_watch* watch;

  void check() const {
    require("costs views found", {sized(costs, cost_count), sized(views, k), found});
    require_size<vg_ranked_view>(view_size, "vg_ranked_view (view_size)");
    *found = 0;
  }
  template <typename Rank>
  void run(std::size_t total, const Rank& rank) const {
    Watcher watcher(watch, total);
    RankConfig config;
    if (cost_count > 0) config.costs = {costs, cost_count};
    config.cost_per_metre = cost_per_metre;
    if (current_pose != nullptr) config.current_pose = rigid_pose_of(current_pose);
    const Ranking ranking = rank(config, watcher.control());
    std::transform(ranking.views.begin(), ranking.views.end(), views, written);
    *found = ranking.views.size();
    watcher.finish(ranking.complete);
  }
};

}  // namespace

template <>
vg_planner_config viewgain::c_api::defaults() noexcept {
  const PlannerConfig own;
  const FeasibilityConfig::Body body;
  vg_planner_config config{};
  config.gain = static_cast<std::int32_t>(own.gain.model);
  write_pose(Pose{}, config.T_world_grid);
  config.prior_sigma = config.support_plane = kNone;
  config.jump_edge_angle = own.jump_edges->angle;
  config.check_feasibility = 1;
  std::copy(body.size.begin(), body.size.end(), config.body_size);
  write_pose(Pose{}, config.T_flange_camera);
  config.clearance = own.clearance;
  config.max_views = own.max_views;
  config.idle_views = own.idle_views;
  config.broken_promises = own.broken_promises;
  config.plan = own.ahead.plan;
  config.take = own.ahead.take;
  config.stop_gain = config.stop_area = kNone;
  return config;
}

VG_DEFINE_INIT(vg_planner_config)
VG_DEFINE_INIT(vg_planner_view)
VG_DEFINE_INIT(vg_registration)

vg_status vg_planner_create(const vg_sensor* sensor, const vg_planner_config* config,
                            vg_planner** planner) {
  return make_handle(planner, "planner", {}, [&] {
    const vg_planner_config chosen = read_struct(config, "vg_planner_config");
    return ViewPlanner(sensor_with_body(sensor, chosen), settings_of(chosen),
                       exec_of(chosen.num_threads, chosen.tracer));
  });
}

void vg_planner_release(vg_planner* planner) { delete planner; }

vg_status vg_planner_add_poses(vg_planner* planner, const double* poses, size_t count) {
  return guarded("planner", {planner}, [&] {
    planner->planner.add_poses({"poses", poses_of(poses, count)});
  });
}

vg_status vg_planner_add(vg_planner* planner, const float* depth, const float* amplitude,
                         const double T_world_camera[16], const double pose_sigma[2],
                         vg_planner_view* added) {
  return guarded("planner depth T_world_camera", {planner, depth, T_world_camera}, [&] {
    ViewPlanner& own = planner->planner;
    if (added != nullptr) require_struct(added, "vg_planner_view");
    const DepthFrame frame = frame_of(own.map().sensor().camera, depth, amplitude);
    const AddedView view = own.add(frame, pose_of(T_world_camera), pose_sigma_of(pose_sigma));
    if (added == nullptr) return;
    write_struct(added, {.struct_size = 0,
                         .verdict = static_cast<int32_t>(view.update.verdict),
                         .view = view.view,
                         .readings = view.update.counts.readings,
                         .readings_inside = view.update.counts.readings_inside,
                         .voxels_hit = view.update.counts.voxels_hit,
                         .voxels_crossed = view.update.counts.voxels_crossed,
                         .unknown_voxels = view.progress.unknown_voxels,
                         .entropy_removed = view.entropy_removed,
                         .total_entropy_removed = view.progress.entropy_removed,
                         .new_area = view.update.new_area,
                         .total_area = view.progress.surface_area});
  });
}

vg_status vg_planner_drop(vg_planner* planner, int32_t verdict, const double T_world_camera[16]) {
  return guarded("planner", {planner}, [&] {
    if (verdict < VG_FRAME_LOST_POSE || verdict >= VG_FRAME_VERDICTS) {
      refuse("verdict is " + std::to_string(verdict) + "; those of frames left out are 2 to 12");
    }
    std::optional<Pose> pose;
    if (T_world_camera != nullptr) pose = pose_of(T_world_camera);
    (void)planner->planner.drop(static_cast<FrameVerdict>(verdict), pose);
  });
}

vg_status vg_planner_frames(const vg_planner* planner, size_t* counts, size_t verdicts) {
  return guarded("planner counts", {planner, sized(counts, verdicts)}, [&] {
    for (std::size_t i = 0; i < verdicts; ++i) {
      counts[i] = count_of(planner->planner.frames(), static_cast<FrameVerdict>(i));
    }
  });
}

vg_status vg_planner_register(vg_planner* planner, const float* depth, const float* amplitude,
                              const double T_reported[16], double sigma_translation,
                              double sigma_rotation, vg_registration* found) {
  return guarded("planner depth T_reported found", {planner, depth, T_reported, found}, [&] {
    const ViewPlanner& own = planner->planner;
    require_struct(found, "vg_registration");
    const DepthFrame frame = frame_of(own.map().sensor().camera, depth, amplitude);
    const FrameRegistration moved =
        own.register_frame(frame, rigid_pose_of(T_reported), {sigma_translation, sigma_rotation});
    vg_registration result{};
    result.status = static_cast<int32_t>(moved.status);
    result.free_directions = static_cast<int32_t>(moved.free_directions.size());
    write_pose(moved.T_world_camera, result.T_world_camera);
    std::copy(moved.covariance.begin(), moved.covariance.end(), result.covariance);
    const PoseSigma left = moved.pose_sigma();
    result.pose_sigma[0] = left.translation;
    result.pose_sigma[1] = left.rotation;
    result.translation = moved.translation;
    result.rotation = moved.rotation;
    result.residual_before = moved.residual_before;
    result.residual_after = moved.residual_after;
    result.overlap = moved.overlap;
    result.contradiction = moved.contradiction;
    write_struct(found, result);
  });
}

vg_status vg_planner_propose(vg_planner* planner, size_t* candidates, size_t* dropped,
                             size_t reasons) {
  return guarded("planner candidates dropped", {planner, candidates, sized(dropped, reasons)}, [&] {
    const Proposal& proposal = planner->planner.propose();
    *candidates = proposal.candidates.size();
    for (std::size_t reason = 0; reason < reasons; ++reason) {
      const auto found = proposal.dropped.find(std::string(reason_name(reason)));
      dropped[reason] = found == proposal.dropped.end() ? 0 : found->second;
    }
  });
}

vg_status vg_planner_rank(vg_planner* planner, size_t k, const double* costs, size_t cost_count,
                          double cost_per_metre, const double current_pose[16],
                          vg_ranked_view* views, size_t view_size, size_t* found,
                          const vg_watch* watch) {
  return guarded("planner", {planner}, [&] {
    ViewPlanner& own = planner->planner;
    const RankCall call{k,     costs,     cost_count, cost_per_metre, current_pose,
                        views, view_size, found,      watch};
    call.check();
    call.run(own.candidate_count(), [&](const RankConfig& config, const BatchControl& control) {
      return own.rank(k, config, control);
    });
  });
}

vg_status vg_planner_rank_poses(vg_planner* planner, const double* poses, size_t count, size_t k,
                                const double* costs, size_t cost_count, double cost_per_metre,
                                const double current_pose[16], vg_ranked_view* views,
                                size_t view_size, size_t* found, const vg_watch* watch) {
  return guarded("planner", {planner}, [&] {
    ViewPlanner& own = planner->planner;
    const RankCall call{k,     costs,     cost_count, cost_per_metre, current_pose,
                        views, view_size, found,      watch};
    call.check();
    const std::vector<Pose> given_poses = poses_of(poses, count);
    call.run(count, [&](const RankConfig& config, const BatchControl& control) {
      return own.rank(given_poses, k, config, control);
    });
  });
}

vg_status vg_planner_outcomes(vg_planner* planner, const double T_world_camera[16],
                              vg_ray_outcomes* outcomes) {
  return guarded("planner", {planner},
                 [&] { write_outcomes(planner->planner.evaluator(), T_world_camera, outcomes); });
}

vg_status vg_planner_tried(vg_planner* planner, const double T_world_camera[16], int32_t reached) {
  return guarded("planner T_world_camera", {planner, T_world_camera},
                 [&] { planner->planner.tried(rigid_pose_of(T_world_camera), reached != 0); });
}

vg_status vg_planner_should_stop(const vg_planner* planner, int32_t* reason) {
  return guarded("planner reason", {planner, reason},
                 [&] { *reason = code_of(planner->planner.should_stop()); });
}

vg_status vg_planner_save(const vg_planner* planner, const char* path) {
  return guarded("planner path", {planner, path}, [&] { planner->planner.save(path); });
}

vg_status vg_planner_load(const char* path, const vg_sensor* sensor,
                          const vg_planner_config* config, vg_planner** planner) {
  return make_handle(planner, "planner path", {path}, [&] {
    const vg_planner_config chosen = read_struct(config, "vg_planner_config");
    return ViewPlanner::load(path, sensor_with_body(sensor, chosen), settings_of(chosen),
                             exec_of(chosen.num_threads, chosen.tracer));
  });
}

vg_status vg_planner_grid(const vg_planner* planner, vg_grid** grid) {
  return make_handle(grid, "grid planner", {planner},
                     [&] { return planner->planner.grid().clone(); });
}
