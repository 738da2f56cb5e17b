// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <stdexcept>
#include <string_view>
#include <vector>

#include "viewgain/viewgain.h"

namespace viewgain::test {

/// Places for objects of a kind; what is in one is released when another comes.
template <typename Object, void (*kRelease)(Object*)>
class Slots {
 public:
  ~Slots() {
    for (unsigned i = 0; i < objects_.size(); ++i) (void)fresh(i);
  }
  Object** fresh(unsigned place) {
    Object*& object = objects_[place % objects_.size()];
    kRelease(object);
    object = nullptr;
    return &object;
  }
  Object* operator[](unsigned place) const { return objects_[place % objects_.size()]; }

 private:
  std::array<Object*, 3> objects_{};
};

template <typename Struct>
Struct made(void (*init)(Struct*, std::size_t)) {
  Struct one;
  init(&one, sizeof one);
  return one;
}

/// Bytes that say which call comes next and with which numbers, and how many calls succeeded.
class CallBytes {
 public:
  static constexpr double kNan = std::numeric_limits<double>::quiet_NaN(), kInfinity = HUGE_VAL;

  explicit CallBytes(std::string_view bytes) : bytes_(bytes), sensor_(made(vg_sensor_init)) {
    expect(vg_sensor_preset("sr4000", &sensor_));
    sensor_.width = 12, sensor_.height = 9;
    sensor_.fx = sensor_.fy = 14, sensor_.cx = 5.5, sensor_.cy = 4;
  }

  [[nodiscard]] const vg_sensor& sensor() const { return sensor_; }
  [[nodiscard]] std::size_t pixels() const {
    return static_cast<std::size_t>(sensor_.width * sensor_.height);
  }
  [[nodiscard]] std::size_t succeeded() const { return succeeded_; }
  [[nodiscard]] bool empty() const { return bytes_.empty(); }

  /// Puts others in their place.
  std::string_view swap(std::string_view bytes) {
    const std::string_view old = bytes_;
    bytes_ = bytes;
    return old;
  }

  unsigned byte() {
    if (bytes_.empty()) return 12;  // what is usual
    const auto value = static_cast<unsigned char>(bytes_.front());
    bytes_.remove_prefix(1);
    return value;
  }
  std::int32_t below(unsigned end) { return static_cast<std::int32_t>(byte() % end); }
  double number() {
    constexpr std::array kSpecial{0.0, 1e-300, 1e300, kInfinity, -kInfinity, 1e-6,
                                  1e9, -1e9,   1e-3,  1e154,     kNan};
    const unsigned value = byte();
    return value < kSpecial.size() ? kSpecial[value] : (static_cast<double>(value) - 128) / 64;
  }
  double usually(double value) { return byte() % 8 == 0 ? number() : value; }

  bool expect(vg_status status) {
    require(status >= VG_OK && status <= VG_STOPPED && status != VG_BACKEND, vg_last_error());
    succeeded_ += status == VG_OK ? 1 : 0;
    return status == VG_OK;
  }
  static void require(bool is_so, const char* what) {
    if (!is_so) throw std::logic_error(what);
  }

  std::array<double, 16> pose() {
    std::array<double, 16> pose{};
    const std::array eye{number(), number(), number()}, at{0.1 * number(), 0.0, 0.0};
    expect(vg_look_at(eye.data(), at.data(), nullptr, pose.data()));
    return pose;
  }
  std::vector<float> depth() {
    std::vector<float> all(pixels(), static_cast<float>(0.5 * number()));
    all[byte() % all.size()] = static_cast<float>(number());
    return all;
  }

 private:
  std::string_view bytes_;
  std::size_t succeeded_ = 0;
  vg_sensor sensor_;
};

/// Ends a batch after so many looks of it.
struct Watch {
  explicit Watch(unsigned looks) : left(static_cast<int>(looks)) {
    watch.poll = [](std::size_t, std::size_t, void* user) {
      return (*static_cast<int*>(user))-- <= 0 ? 1 : 0;
    };
    watch.user = &left;
  }
  Watch(const Watch&) = delete;
  Watch& operator=(const Watch&) = delete;

  int left;
  vg_watch watch = made(vg_watch_init);
};

}  // namespace viewgain::test
