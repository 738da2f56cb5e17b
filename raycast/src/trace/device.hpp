// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
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

/// Builds the BVH of a scene of so many primitives; the calling thread joins in. Throws
/// Error(backend), of which `what` says what was being built, and std::bad_alloc where there is not
/// the memory for it. If Embree has failed the scene is null, and not freed.
void commit_scene(RTCDevice device, ScenePtr& scene, std::size_t primitives,
                  const std::string& what);

/// Throws so if the last calls on the device failed.
void check_device(RTCDevice device, const std::string& what);

}  // namespace viewgain::detail
