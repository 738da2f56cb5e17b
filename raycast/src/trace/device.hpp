// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <string>

#include "embree_compat.hpp"
#include "viewgain/core/isa.hpp"

namespace viewgain::detail {

struct DeviceRelease {
  void operator()(RTCDevice device) const { rtcReleaseDevice(device); }
};
struct SceneRelease {
  void operator()(RTCScene scene) const { rtcReleaseScene(scene); }
};
using DevicePtr = std::unique_ptr<RTCDeviceTy, DeviceRelease>;
using ScenePtr = std::unique_ptr<RTCSceneTy, SceneRelease>;

/// An Embree device that uses at most num_threads threads (0: all) to build, and no instruction set
/// above `isa`. Throws Error(backend).
[[nodiscard]] DevicePtr make_device(Isa isa, int num_threads);

/// Throws Error(backend) with the device's message if the last calls on it failed.
void check_device(RTCDevice device, const std::string& what);

/// Attaches triangles to a scene as geometry `id`, vertices copied. Throws Error(backend).
void attach_triangles(RTCDevice device, RTCScene scene, unsigned id, const float* vertices,
                      std::size_t vertex_count, const unsigned* indices,
                      std::size_t triangle_count);

}  // namespace viewgain::detail
