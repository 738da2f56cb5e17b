// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <string>

#include "embree_compat.hpp"
#include "viewgain/support/isa.hpp"

namespace viewgain::detail {

struct SceneRelease {
  void operator()(RTCScene scene) const { rtcReleaseScene(scene); }
};
using ScenePtr = std::unique_ptr<RTCSceneTy, SceneRelease>;

/// The process's Embree device that uses no instruction set above `isa`: made when first asked for
/// and kept until the process ends. It is told no number of threads, since Embree would make that a
/// limit for all of the process's TBB. Thread safe. Throws Error(backend), or std::bad_alloc as
/// below.
[[nodiscard]] RTCDevice shared_device(Isa isa);

/// Builds a scene's BVH; the calling thread joins in. Throws Error(backend), of which `what` says
/// what was being built, or std::bad_alloc where Embree has no memory; the
/// scene is null then.
void commit_scene(RTCDevice device, ScenePtr& scene, const std::string& what);

/// Throws so if the last calls on the device failed.
void check_device(RTCDevice device, const std::string& what);

}  // namespace viewgain::detail
