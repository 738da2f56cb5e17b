// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include "device.hpp"

#include <algorithm>
#include <array>
#include <atomic>
#include <cstdio>
#include <new>
#include <string>
#include <thread>

#include "viewgain/core/error.hpp"
#include "viewgain/support/room.hpp"

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

// What Embree said of the last failure in this thread. An array, so that keeping it cannot fail.
thread_local std::array<char, 256> last_message{};

void keep_message(void*, RTCError, const char* message) {
  std::snprintf(last_message.data(), last_message.size(), "%s", message == nullptr ? "" : message);
}

[[noreturn]] void fail(RTCError code, const std::string& what) {
  if (code == RTC_ERROR_OUT_OF_MEMORY) throw std::bad_alloc();
  throw Error(ErrorCode::backend, what + ": Embree: " + last_message.data());
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
  if (made == nullptr) {
    const RTCError code = rtcGetDeviceError(nullptr);
    keep_message(nullptr, code, ("error " + std::to_string(code)).c_str());
    fail(code, "cannot create a device for tracing");
  }
  rtcSetDeviceErrorFunction(made, keep_message, nullptr);
  if (kept.compare_exchange_strong(device, made, std::memory_order_acq_rel)) return made;
  rtcReleaseDevice(made);  // another thread was faster
  return device;
}

void commit_scene(RTCDevice device, ScenePtr& scene, std::size_t primitives,
                  const std::string& what) {
  // Embree does not come through a lack of memory, nor TBB, which starts its threads here: their
  // stacks, and what trees of the largest quality take.
  constexpr std::size_t kThreadBytes = std::size_t{8} << 20U, kBytes = std::size_t{16} << 20U;
  constexpr std::size_t kPrimitiveBytes = 512;
  const std::size_t threads = std::max(1U, std::thread::hardware_concurrency());
  check_room(kBytes + threads * kThreadBytes + primitives * kPrimitiveBytes);
  rtcJoinCommitScene(scene.get());
  const RTCError code = rtcGetDeviceError(device);
  if (code == RTC_ERROR_NONE) return;
  // Not released: that would wait for tasks, some of which may never have begun.
  (void)scene.release();
  fail(code, what);
}

void check_device(RTCDevice device, const std::string& what) {
  const RTCError code = rtcGetDeviceError(device);
  if (code != RTC_ERROR_NONE) fail(code, what);
}

}  // namespace viewgain::detail
