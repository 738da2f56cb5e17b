// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include "recordings/transform_tree.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <deque>

#include "viewgain/core/error.hpp"
#include "viewgain/support/text.hpp"

namespace viewgain {
namespace {

Eigen::Quaterniond rotation_of(const std::array<double, 7>& n) {
  return Eigen::Quaterniond(n[6], n[3], n[4], n[5]).normalized();
}

Pose pose_between(const std::array<double, 7>& a, const std::array<double, 7>& b, double share) {
  const Eigen::Vector3d from(a[0], a[1], a[2]), to(b[0], b[1], b[2]);
  return {rotation_of(a).slerp(share, rotation_of(b)).toRotationMatrix(),
          from + share * (to - from)};
}

std::string listed_frames(const std::set<std::string>& frames) {
  constexpr std::size_t kMost = 30;
  std::vector<std::string> names(frames.begin(), frames.end());
  const bool has_more = names.size() > kMost;
  names.resize(std::min(names.size(), kMost));
  for (std::string& name : names) name = viewgain::quoted(name);
  return listed(names) + (has_more ? ", ..." : "");
}

}  // namespace

bool TransformTree::add(const std::string& parent, const std::string& child, std::int64_t stamp,
                        const std::array<double, 7>& numbers, bool is_static) {
  const double norm =
      std::hypot(std::hypot(numbers[3], numbers[4]), std::hypot(numbers[5], numbers[6]));
  if (!std::all_of(numbers.begin(), numbers.end(), [](double x) { return std::isfinite(x); }) ||
      std::abs(norm - 1) > 1e-2 || parent == child) {
    return false;
  }
  const auto [found, is_new] = edges_.try_emplace({child, parent});
  Edge& edge = found->second;
  if (is_new) edge.parent = parent, edge.child = child, edge.is_static = is_static;
  // A moving transform replaces a static one between the same frames.
  if (edge.is_static && !is_static) edge.poses.clear(), edge.is_static = false;
  if (!edge.is_static && is_static) return true;
  if (is_static) edge.poses.clear();  // the last one counts
  if (edge.latest > stamp) edge.went_back = std::max(edge.went_back, edge.latest - stamp);
  edge.latest = std::max(edge.latest, stamp);
  edge.poses.push_back({stamp, numbers});
  return true;
}

void TransformTree::join(TransformTree& other, bool is_near) {
  for (auto& [key, edge] : other.edges_) {
    edge.is_near = is_near;
    const auto [found, is_new] = edges_.try_emplace(key, std::move(edge));
    if (!is_new && !found->second.is_near) found->second.is_ambiguous = true;
  }
}

void TransformTree::finish(Warnings& warnings) {
  constexpr std::int64_t kOutOfOrder = 500'000'000;  // tolerated, as with several senders [ns]
  for (auto& [key, edge] : edges_) {
    const auto is_earlier = [](const Stamped& a, const Stamped& b) { return a.stamp < b.stamp; };
    std::stable_sort(edge.poses.begin(), edge.poses.end(), is_earlier);
    if (edge.is_static || edge.went_back < kOutOfOrder) continue;
    warnings.add("the time stamps from " + viewgain::quoted(edge.parent) + " to " +
                 viewgain::quoted(edge.child) + " go back by " +
                 short_text(static_cast<double>(edge.went_back / 1'000'000) * 1e-3) +
                 " s. Either the clock was set back, or the file has two recordings");
  }
}

std::set<std::string> TransformTree::frames() const {
  std::set<std::string> names;
  for (const auto& [key, edge] : edges_) names.insert({edge.parent, edge.child});
  return names;
}

TransformTree::Chain TransformTree::chain(std::string& world, const std::string& frame) const {
  const auto fail = [](const std::string& what) -> void { throw Error(ErrorCode::format, what); };
  // How each frame is reached from `frame`, and how many transforms connect all these frames.
  std::map<std::string, std::pair<const Edge*, bool>> reached{{frame, {nullptr, false}}};
  std::set<std::string> roots, joined{frame};
  std::size_t edges = 0;
  for (std::deque<std::string> todo{frame}; !todo.empty(); todo.pop_front()) {
    const std::string at = todo.front();
    std::size_t parents = 0;
    for (const auto& [key, edge] : edges_) {
      if (edge.child != at && edge.parent != at) continue;
      const bool is_up = edge.child == at;
      parents += is_up ? 1 : 0;
      edges += is_up ? 1 : 0;
      const std::string& other = is_up ? edge.parent : edge.child;
      if (reached.try_emplace(other, std::pair(&edge, !is_up)).second) {
        joined.insert(other);
        todo.push_back(other);
      }
    }
    if (parents == 0) roots.insert(at);
  }
  if (edges == 0) {
    fail("no transform leads to the frame " + viewgain::quoted(frame) +
         "; existing frames: " + listed_frames(frames()) +
         ". Record /tf_static, too, or give --camera-frame with one of these frames and the "
         "camera's pose in this frame");
  }
  if (edges >= joined.size()) {
    fail("the transforms of " + listed_frames(joined) +
         " form a loop: a frame has two parents. Perhaps two nodes publish this frame");
  }
  if (world.empty() && roots.size() > 1) {
    fail("the coordinate frame " + viewgain::quoted(frame) +
         " is connected to several world frames: " + listed_frames(roots) +
         "; choose one with --world");
  }
  if (world.empty()) world = *roots.begin();
  if (!joined.contains(world)) {
    fail("no transforms connect the world " + viewgain::quoted(world) + " and the frame " +
         viewgain::quoted(frame) +
         "; choose a world that is connected to this frame with --world: " + listed_frames(joined));
  }
  Chain way;
  for (std::string at = world; at != frame;) {
    const auto& [edge, is_down] = reached.at(at);
    if (edge->is_ambiguous) {
      fail("the transform from " + viewgain::quoted(edge->parent) + " to " +
           viewgain::quoted(edge->child) +
           " comes from several topics, none of which is in the namespace of the depth images");
    }
    way.emplace_back(edge, is_down);
    at = is_down ? edge->parent : edge->child;
  }
  return way;
}

TransformTree::Found TransformTree::look_up(const Chain& chain, std::int64_t stamp,
                                            std::int64_t max_gap, Pose& T_world_frame) {
  T_world_frame = Pose();
  for (const auto& [edge, is_inverted] : chain) {
    Pose T_parent_child;
    const std::vector<Stamped>& poses = edge->poses;
    if (edge->is_static) {
      T_parent_child = pose_between(poses[0].numbers, poses[0].numbers, 0);
    } else {
      const auto after = std::lower_bound(
          poses.begin(), poses.end(), stamp,
          [](const Stamped& pose, std::int64_t time) { return pose.stamp < time; });
      if (after == poses.end()) return Found::after;
      if (after->stamp == stamp) {
        T_parent_child = pose_between(after->numbers, after->numbers, 0);
      } else {
        if (after == poses.begin()) return Found::before;
        const Stamped& before = *std::prev(after);
        const std::int64_t since = stamp - before.stamp, until = after->stamp - stamp;
        if (since + until > 2 * max_gap) return Found::gap;
        T_parent_child =
            pose_between(before.numbers, after->numbers,
                         static_cast<double>(since) / static_cast<double>(since + until));
      }
    }
    T_world_frame = T_world_frame * (is_inverted ? T_parent_child.inverse() : T_parent_child);
  }
  return Found::yes;
}

std::string TransformTree::largest_gap(const Chain& chain) {
  std::int64_t largest = -1;
  std::string text;
  for (const auto& [edge, is_inverted] : chain) {
    for (std::size_t i = 1; i < edge->poses.size(); ++i) {
      const std::int64_t gap = edge->poses[i].stamp - edge->poses[i - 1].stamp;
      if (gap <= largest) continue;
      largest = gap;
      text = short_text(static_cast<double>(gap / 1'000'000) * 1e-3) + " s, from " +
             viewgain::quoted(edge->parent) + " to " + viewgain::quoted(edge->child);
    }
  }
  return text;
}

std::array<std::int64_t, 2> TransformTree::span_of(const Chain& chain) {
  std::array<std::int64_t, 2> span{INT64_MIN, INT64_MAX};
  for (const auto& [edge, is_inverted] : chain) {
    if (edge->is_static) continue;
    span[0] = std::max(span[0], edge->poses.front().stamp);
    span[1] = std::min(span[1], edge->poses.back().stamp);
  }
  return span;
}

}  // namespace viewgain
