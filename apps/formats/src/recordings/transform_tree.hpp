// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "recordings/messages.hpp"
#include "viewgain/core/pose.hpp"

namespace viewgain {

/// The transforms of a recording by time, as in tf. Interpolates between two of them, and never
/// extrapolates; static ones hold at all times.
class TransformTree {
 public:
  /// Adds T_parent_child as tx, ty, tz [m], qx, qy, qz, qw, at `stamp` [ns]. False, without adding,
  /// if a number is not finite, the quaternion's norm deviates by more than 1e-2, or both frames
  /// are the same.
  bool add(const std::string& parent, const std::string& child, std::int64_t stamp,
           const std::array<double, 7>& numbers, bool is_static);

  /// Adds the transforms of `other` between frames that have none here. Add those of near topics
  /// first; chain() refuses a transform that several far topics contain.
  void join(TransformTree& other, bool is_near);

  /// Sorts by time. Call it once, before the members below. Warns of clocks that went back.
  void finish(Warnings& warnings);

  [[nodiscard]] bool empty() const noexcept { return edges_.empty(); }
  /// All frames, sorted.
  [[nodiscard]] std::set<std::string> frames() const;

  struct Edge;
  /// The transforms to multiply, from the world to a frame; true for inverted ones.
  using Chain = std::vector<std::pair<const Edge*, bool>>;
  /// From `world` to `frame`. An empty `world` is set to the topmost parent. Throws Error(format)
  /// that lists the frames if no chain, or more than one, connects both.
  [[nodiscard]] Chain chain(std::string& world, const std::string& frame) const;

  enum class Found : std::uint8_t { yes, before, after, gap, unconnected };
  /// T_world_frame at `stamp` [ns]. Not found if a transform of the chain begins later, ends
  /// earlier, or is interpolated over more than 2 `max_gap` [ns].
  static Found look_up(const Chain& chain, std::int64_t stamp, std::int64_t max_gap,
                       Pose& T_world_frame);

  /// The first and last times [ns] that all moving transforms of the chain cover.
  static std::array<std::int64_t, 2> span_of(const Chain& chain);

  /// "1 s, from 'map' to 'base'": the largest gap between consecutive moving transforms of the
  /// chain.
  static std::string largest_gap(const Chain& chain);

  struct Stamped {
    std::int64_t stamp = 0;
    std::array<double, 7> numbers{};
  };
  struct Edge {
    std::string parent, child;
    bool is_static = false, is_near = true, is_ambiguous = false;
    std::vector<Stamped> poses;       // by time
    std::int64_t went_back = 0;       // largest step back in time [ns]
    std::int64_t latest = INT64_MIN;  // largest time stamp so far
  };

 private:
  std::map<std::pair<std::string, std::string>, Edge> edges_;  // by child and parent
};

}  // namespace viewgain
