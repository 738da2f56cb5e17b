// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include "program/cli/flags/set_up_warnings.hpp"

#include <algorithm>
#include <cstdio>

#include "program/cli/flags/scene_sources.hpp"
#include "program/cli/values.hpp"
#include "viewgain/raycast/suspect_set_up.hpp"

namespace viewgain::app {
namespace {

void warn_of_sensor(const Sensor& sensor, std::optional<double> voxel_size, bool frames_follow) {
  const std::vector<Suspicion> alone = suspect_sensor(sensor);
  for (const Suspicion& suspicion : suspect_sensor(sensor, voxel_size)) {
    const bool is_told_of_frames =
        frames_follow && explains_frames(suspicion) &&
        std::any_of(alone.begin(), alone.end(),
                    [&](const Suspicion& other) { return other.kind == suspicion.kind; });
    if (!is_told_of_frames) warn(suspicion, "sensor " + printable(sensor.name));
  }
}

void warn_of_obstacles(const SetUp& set_up) {
  if (set_up.obstacles == nullptr || set_up.obstacle_values == nullptr) return;
  auto mesh = set_up.obstacles->meshes.begin();
  auto box = set_up.obstacles->boxes.begin();
  for (const std::string& value : *set_up.obstacle_values) {
    const Box bounds = is_obstacle_file(value) ? obstacle_bounds(*mesh++) : *box++;
    Suspicion suspicion = suspect_obstacle(bounds, set_up.map, set_up.sensor);
    if (suspicion.kind.empty()) continue;
    suspicion.what = "--obstacle " + value + " " + suspicion.what;
    warn(suspicion);
  }
}

}  // namespace

void warn(const Suspicion& suspicion, const std::string& about) {
  if (suspicion.kind.empty()) return;
  const std::string subject = about.empty() ? "" : about + ": ";
  std::fprintf(stderr, "viewgain: warning: %s%s\n", subject.c_str(), suspicion.what.c_str());
}

void warn_of_set_up(const SetUp& set_up) {
  const Sensor& sensor = set_up.sensor;
  const BeliefGrid& map = set_up.map;
  warn_of_sensor(sensor, map.voxel_size(), set_up.frames_follow);
  warn(suspect_workspace(map, sensor), "--workspace");
  warn_of_obstacles(set_up);
  if (set_up.support_plane) {
    warn(suspect_support_plane(*set_up.support_plane, map, sensor), "--support-plane");
  }
  if (set_up.reach != nullptr && !set_up.reach_file.empty()) {
    warn(suspect_reach(*set_up.reach, map, sensor), "--reach " + set_up.reach_file);
  }
  if (set_up.object_size) warn(suspect_object_size(*set_up.object_size, map), "--hazard size");
  if (set_up.pose_sigma) {
    warn(suspect_pose_sigma(*set_up.pose_sigma, sensor.working_distance, map.voxel_size()));
  }
}

void warn_of_sensor(const Sensor& sensor) { warn_of_sensor(sensor, std::nullopt, false); }

void warn_of_views_in_obstacles(const Obstacles& obstacles, const BeliefGrid& map) {
  warn(suspect_solid_obstacles(obstacles, map.views()), "--obstacle");
}

}  // namespace viewgain::app
