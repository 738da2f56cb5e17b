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

/// The transforms of a recording by time, as tf has them. Interpolates between two of them and
/// never beyond the first or the last; static ones hold at all times.
class TransformTree {
 public:
  /// T_parent_child as tx, ty, tz [m], qx, qy, qz, qw, at `stamp` [ns]. False, and nothing is
  /// added, if a number is not finite, the quaternion's norm is off by over 1e-2, or both frames
  /// are one.
  bool add(const std::string& parent, const std::string& child, std::int64_t stamp,
           const std::array<double, 7>& numbers, bool is_static);

  /// Takes the transforms of `other` between frames that have none here. Those of near topics come
  /// first; chain() refuses transforms of which several far topics have some.
  void join(TransformTree& other, bool is_near);

  /// Sorts by time; to be called once, before what follows. Warns of clocks that went back.
  void finish(Warnings& warnings);

  [[nodiscard]] bool empty() const noexcept { return edges_.empty(); }
  /// All frames, sorted.
  [[nodiscard]] std::set<std::string> frames() const;

  struct Edge;
  /// The transforms to multiply, from the world to a frame; true: inverted.
  using Chain = std::vector<std::pair<const Edge*, bool>>;
  /// From `world`, or with an empty one from the topmost parent, which it then names. Throws
  /// Error(format) that lists what there is if no chain joins both, or more than one.
  [[nodiscard]] Chain chain(std::string& world, const std::string& frame) const;

  enum class Found : std::uint8_t { yes, before, after, gap, unconnected };
  /// T_world_frame at `stamp` [ns]; not if a transform of the chain begins after it, ends before
  /// it, or has two beside it that are over 2 `max_gap` [ns] apart.
  static Found look_up(const Chain& chain, std::int64_t stamp, std::int64_t max_gap,
                       Pose& T_world_frame);

  /// The first and last times [ns] that all moving transforms of the chain have.
  static std::array<std::int64_t, 2> span_of(const Chain& chain);

  /// "1 s, from 'map' to 'base'": between two moving transforms of the chain.
  static std::string largest_gap(const Chain& chain);

  struct Stamped {
    std::int64_t stamp = 0;
    std::array<double, 7> numbers{};
  };
  struct Edge {
    std::string parent, child;
    bool is_static = false, is_near = true, is_ambiguous = false;
    std::vector<Stamped> poses;       // by time
    std::int64_t went_back = 0;       // the farthest that a stamp was before an earlier one [ns]
    std::int64_t latest = INT64_MIN;  // stamp so far
  };

 private:
  std::map<std::pair<std::string, std::string>, Edge> edges_;  // by child and parent
};

}  // namespace viewgain
