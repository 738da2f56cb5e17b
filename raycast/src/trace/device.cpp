// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include "device.hpp"

#include <array>
#include <atomic>
#include <new>
#include <string>

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
    case RTC_ERROR_UNSUPPORTED_CPU:
      return "unsupported CPU";
    case RTC_ERROR_CANCELLED:
      return "cancelled";
    default:
      return "unknown error";
  }
}

[[noreturn]] void fail(RTCError code, const std::string& what) {
  if (code == RTC_ERROR_OUT_OF_MEMORY) throw std::bad_alloc();
  throw Error(ErrorCode::backend, what + ": Embree: " + error_text(code));
}

}  // namespace

RTCDevice shared_device(Isa isa) {
  static std::array<std::atomic<RTCDevice>, 4> devices{};  // by Isa
  std::atomic<RTCDevice>& kept = devices.at(static_cast<std::size_t>(isa));
  RTCDevice device = kept.load(std::memory_order_acquire);
  if (device != nullptr) {
    // What an earlier failure of this thread left is nothing of its next call.
    (void)rtcGetDeviceError(device);
    return device;
  }
  const std::string config = std::string("isa=") + embree_isa(isa);
  RTCDevice made = rtcNewDevice(config.c_str());
  if (made == nullptr) fail(rtcGetDeviceError(nullptr), "no device");
  if (kept.compare_exchange_strong(device, made, std::memory_order_acq_rel)) return made;
  rtcReleaseDevice(made);  // another thread was faster
  return device;
}

void commit_scene(RTCDevice device, ScenePtr& scene, const std::string& what) {
  rtcJoinCommitScene(scene.get());
  const RTCError code = rtcGetDeviceError(device);
  if (code == RTC_ERROR_NONE) return;
  // Not released: that would wait, for ever, for tasks that there was no memory to start.
  (void)scene.release();
  fail(code, what);
}

void check_device(RTCDevice device, const std::string& what) {
  const RTCError code = rtcGetDeviceError(device);
  if (code != RTC_ERROR_NONE) fail(code, what);
}

}  // namespace viewgain::detail
