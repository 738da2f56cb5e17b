// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include "device.hpp"

#include <algorithm>

#include "viewgain/core/error.hpp"

namespace viewgain::detail {
namespace {

const char* embree_isa(Isa isa) {
  switch (isa) {
    case Isa::avx512:
      return "avx512";
    case Isa::avx2:
      return "avx2";
    case Isa::sse4:
      return "sse4.2";
    case Isa::baseline:
      break;
  }
  return "sse2";
}

const char* error_text(RTCError code) {
  switch (code) {
    case RTC_ERROR_NONE:
      return "no error";
    case RTC_ERROR_INVALID_ARGUMENT:
      return "invalid argument";
    case RTC_ERROR_INVALID_OPERATION:
      return "invalid operation";
    case RTC_ERROR_OUT_OF_MEMORY:
      return "out of memory";
    case RTC_ERROR_UNSUPPORTED_CPU:
      return "unsupported CPU";
    case RTC_ERROR_CANCELLED:
      return "cancelled";
    default:
      return "unknown error";
  }
}

}  // namespace

DevicePtr make_device(Isa isa, int num_threads) {
  std::string config = std::string("isa=") + embree_isa(isa);
  if (num_threads > 0) config += ",threads=" + std::to_string(num_threads);
  DevicePtr device(rtcNewDevice(config.c_str()));
  if (!device) {
    throw Error(ErrorCode::backend,
                std::string("Embree gives no device: ") + error_text(rtcGetDeviceError(nullptr)));
  }
  return device;
}

void check_device(RTCDevice device, const std::string& what) {
  const RTCError code = rtcGetDeviceError(device);
  if (code == RTC_ERROR_OUT_OF_MEMORY) {
    throw Error(ErrorCode::capacity, what + ": Embree is out of memory");
  }
  if (code != RTC_ERROR_NONE)
    throw Error(ErrorCode::backend, what + ": Embree: " + error_text(code));
}

void attach_triangles(RTCDevice device, RTCScene scene, unsigned id, const float* vertices,
                      std::size_t vertex_count, const unsigned* indices,
                      std::size_t triangle_count) {
  RTCGeometry geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_TRIANGLE);
  auto* v = static_cast<float*>(rtcSetNewGeometryBuffer(
      geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, 3 * sizeof(float), vertex_count));
  auto* t = static_cast<unsigned*>(rtcSetNewGeometryBuffer(
      geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, 3 * sizeof(unsigned), triangle_count));
  if (v != nullptr && t != nullptr) {
    std::copy_n(vertices, 3 * vertex_count, v);
    std::copy_n(indices, 3 * triangle_count, t);
    rtcSetGeometryMask(geometry, 0xFFFFFFFFU);
    rtcCommitGeometry(geometry);
    rtcAttachGeometryByID(scene, geometry, id);
  }
  rtcReleaseGeometry(geometry);
  check_device(device, "triangles");
}

}  // namespace viewgain::detail
