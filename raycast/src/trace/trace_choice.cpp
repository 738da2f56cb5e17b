// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include "trace_choice.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <string>
#include <string_view>

#include "device.hpp"
#include "leaf_traversal.hpp"
#include "viewgain/core/error.hpp"

namespace viewgain::detail {
namespace {

constexpr double kLevelZeroReach = 2e4;

}  // namespace

TraceWay wished_way() {
  const char* wish = std::getenv("VIEWGAIN_TRACE");
  if (wish == nullptr || std::string_view(wish) == "sweep") return TraceWay::sweep;
  if (std::string_view(wish) == "bvh") return TraceWay::bvh;
  throw Error(ErrorCode::invalid_argument,
              std::string("VIEWGAIN_TRACE is '").append(wish).append("', not sweep or bvh"));
}

Isa choose_isa() {
  const Isa best = select_isa();
  for (const Isa isa : supported_isas()) {
    if (isa > best) continue;
    const int width = trace_kernels(isa).width;
    const RTCDeviceProperty native = width == 16  ? RTC_DEVICE_PROPERTY_NATIVE_RAY16_SUPPORTED
                                     : width == 8 ? RTC_DEVICE_PROPERTY_NATIVE_RAY8_SUPPORTED
                                                  : RTC_DEVICE_PROPERTY_NATIVE_RAY4_SUPPORTED;
    if (rtcGetDeviceProperty(shared_device(isa), native) != 0) return isa;
  }
  throw Error(ErrorCode::backend, "this build of Embree has no ray packets");
}

int choose_margin_level(double reach) {
  int level = 0;
  while (level + 1 < kMarginLevels && reach > std::ldexp(kLevelZeroReach, level)) ++level;
  return level;
}

ViewChoice choose_tracing(const SceneData& scene, TraceWay way, double max_range) {
  // A camera that sees anything is no farther than its range from the workspace.
  const Index3& dims = scene.snapshot.dims;
  const double reach = max_range + std::max({dims.x, dims.y, dims.z});
  ViewChoice choice;
  choice.by_sweep = way == TraceWay::sweep;
  choice.margin_level = choose_margin_level(reach);
  return choice;
}

}  // namespace viewgain::detail
