// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <string>

#include "convert.hpp"
#include "planner_handle.hpp"
#include "viewgain/planner.h"
#include "viewgain/planner/frame_check.hpp"

using namespace viewgain;
using namespace viewgain::c_api;

struct vg_frame_check {
  FrameCheck check;
  PinholeCamera camera;
};

namespace {

void write(const FrameConsistency& all, vg_consistency* found, std::int32_t* contradicts,
           std::size_t capacity) {
  if (contradicts != nullptr) {
    if (capacity < all.frames.size()) {
      refuse("capacity is " + std::to_string(capacity) + " for " +
             std::to_string(all.frames.size()) + " frames");
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
}

}  // namespace

VG_DEFINE_INIT(vg_consistency)

vg_status vg_planner_consistency(const vg_planner* planner, vg_consistency* found,
                                 int32_t* contradicts, size_t capacity) {
  return guarded("planner found", {planner, found}, [&] {
    require_struct(found, "vg_consistency");
    write(planner->planner.map().consistency(), found, contradicts, capacity);
  });
}

vg_status vg_frame_check_create(const vg_sensor* sensor, double support_plane,
                                vg_frame_check** check) {
  return make_handle(check, "check", {}, [&] {
    const Sensor camera = sensor_of(sensor);
    return vg_frame_check{FrameCheck(camera, given(support_plane)), camera.camera};
  });
}

vg_status vg_frame_check_look(vg_frame_check* check, const vg_grid* before, const float* depth,
                              const double T_world_camera[16], const double pose_sigma[2]) {
  return guarded("check before depth T_world_camera", {check, before, depth, T_world_camera}, [&] {
    const DepthFrame frame = frame_of(check->camera, depth, nullptr);
    const Pose pose = rigid_pose_of(T_world_camera);
    const PoseSigma sigma = pose_sigma_of(pose_sigma);
    check->check.look(before->grid, frame, pose, sigma);
    check->check.see(frame, pose);
  });
}

vg_status vg_frame_check_result(const vg_frame_check* check, const vg_grid* after,
                                vg_consistency* found, int32_t* contradicts, size_t capacity) {
  return guarded("check after found", {check, after, found}, [&] {
    require_struct(found, "vg_consistency");
    write(check->check.result(after->grid), found, contradicts, capacity);
  });
}

void vg_frame_check_release(vg_frame_check* check) { delete check; }
