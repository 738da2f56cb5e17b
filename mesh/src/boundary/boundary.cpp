// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "viewgain/mesh/boundary.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <utility>

#include "boundary_edges.hpp"
#include "viewgain/core/error.hpp"
#include "viewgain/support/text.hpp"

namespace viewgain {
namespace {

using detail::BoundaryEdge;

// A view, prepared for queries about many edges.
struct ViewAxes {
  Pose T_camera_world;
  Eigen::Matrix3d R_camera_world;
  Eigen::Vector3d eye;  // world [m]
};

// The class of an edge and the view that classified it.
struct EdgeClass {
  BoundaryClass boundary_class = BoundaryClass::left;
  std::uint32_t view = 0;
};

class EdgeClassifier {
 public:
  EdgeClassifier(std::span<const Pose> views, const Sensor& sensor, double max_view_angle,
                 const std::function<bool(std::size_t, const Eigen::Vector3d&)>& sees)
      : sensor_(sensor), min_cosine_(std::cos(max_view_angle)), sees_(sees) {
    for (std::size_t i = 0; i < views.size(); ++i) {
      const std::optional<Pose> view = rigid_pose(views[i]);
      if (!view) refuse("view " + std::to_string(i) + " is not a rigid transform");
      const Pose T_camera_world = view->inverse();
      axes_.push_back({T_camera_world, T_camera_world.rotation(), views[i].translation()});
    }
  }

  // `outward` is the smoothed conormal of the edge.
  [[nodiscard]] EdgeClass classify(const BoundaryEdge& edge, const Eigen::Vector3d& outward) const {
    const std::size_t view = last_view_of(edge);
    const Eigen::Vector3d c = axes_[view].R_camera_world * outward;
    const std::array<double, 4> toward{-c.x(), c.x(), -c.y(), c.y()};
    const auto largest = std::max_element(toward.begin(), toward.end());
    return {static_cast<BoundaryClass>(largest - toward.begin()), static_cast<std::uint32_t>(view)};
  }

 private:
  [[nodiscard]] std::size_t last_view_of(const BoundaryEdge& edge) const {
    std::size_t facing = axes_.size();  // the last view at under 90°
    for (std::size_t i = axes_.size(); i-- > 0;) {
      const double cosine = edge.normal.dot((axes_[i].eye - edge.middle).normalized());
      if (!(cosine > 0)) continue;
      if (facing == axes_.size()) facing = i;
      if (cosine > min_cosine_ && in_image(axes_[i], edge.middle) &&
          (!sees_ || sees_(i, edge.middle))) {
        return i;
      }
    }
    return std::min(facing, axes_.size() - 1);
  }

  [[nodiscard]] bool in_image(const ViewAxes& view, const Eigen::Vector3d& p_world) const {
    const Eigen::Vector3d p = view.T_camera_world * p_world;
    const double range = p.norm();
    if (!(range >= sensor_.min_range && range <= sensor_.max_range)) return false;
    return sensor_.camera.sees(p);
  }

  const Sensor& sensor_;
  double min_cosine_;
  const std::function<bool(std::size_t, const Eigen::Vector3d&)>& sees_;
  std::vector<ViewAxes> axes_;
};

// Length-weighted sum of the conormals of the edges whose middles lie within window / 2 along the
// loop, to smooth jagged borders. The window is at most a quarter of the loop, because conormals
// cancel around the whole loop.
std::vector<Eigen::Vector3d> smoothed_conormals(std::span<const BoundaryEdge> edges, double length,
                                                double window) {
  const std::size_t n = edges.size();
  const double reach = 0.5 * std::min(window, 0.25 * length);
  // Repeats the loop three times, so that windows in the middle copy do not reach an end.
  std::vector<double> middles;
  std::vector<Eigen::Vector3d> sums{Eigen::Vector3d::Zero()};
  double travelled = 0;
  for (std::size_t i = 0; i < 3 * n; ++i) {
    const BoundaryEdge& edge = edges[i % n];
    middles.push_back(travelled + 0.5 * edge.length);
    travelled += edge.length;
    sums.push_back(sums.back() + edge.length * edge.outward);
  }
  std::vector<Eigen::Vector3d> smoothed;
  std::size_t first = 0;
  std::size_t end = 0;
  for (std::size_t i = n; i < 2 * n; ++i) {
    while (middles[first] < middles[i] - reach) ++first;
    while (end < middles.size() && middles[end] <= middles[i] + reach) ++end;
    // A window of one edge is exact.
    smoothed.push_back(end == first + 1 ? edges[i % n].outward : sums[end] - sums[first]);
  }
  return smoothed;
}

// Consecutive edges of one class.
struct Segment {
  BoundaryClass boundary_class;
  std::size_t first;  // edge of the loop
  double length;      // [m]
  std::size_t previous, next;
  bool alive = true;
};

// The loop's edges as a ring of segments with different classes.
std::vector<Segment> segments_of(std::span<const EdgeClass> classes,
                                 std::span<const BoundaryEdge> edges) {
  const std::size_t n = classes.size();
  std::size_t start = 0;
  while (start < n &&
         classes[start].boundary_class == classes[(start + n - 1) % n].boundary_class) {
    ++start;
  }
  if (start == n) start = 0;
  std::vector<Segment> segments;
  for (std::size_t k = 0; k < n; ++k) {
    const std::size_t i = (start + k) % n;
    if (segments.empty() || segments.back().boundary_class != classes[i].boundary_class) {
      segments.push_back({classes[i].boundary_class, i, 0.0, segments.size(), segments.size()});
    }
    segments.back().length += edges[i].length;
  }
  for (std::size_t s = 0; s < segments.size(); ++s) {
    segments[s].previous = (s + segments.size() - 1) % segments.size();
    segments[s].next = (s + 1) % segments.size();
  }
  return segments;
}

// Repeatedly joins the shortest segment under min_length with the longer of its neighbours. Ties go
// to the first segment, and to the previous neighbour.
void join_short(std::vector<Segment>& segments, double min_length) {
  std::set<std::pair<double, std::size_t>> by_length;
  for (std::size_t s = 0; s < segments.size(); ++s) by_length.emplace(segments[s].length, s);
  // `after` follows `before` and becomes a part of it.
  const auto join = [&](std::size_t before, std::size_t after) {
    by_length.erase({segments[before].length, before});
    by_length.erase({segments[after].length, after});
    segments[before].length += segments[after].length;
    segments[before].next = segments[after].next;
    segments[segments[after].next].previous = before;
    segments[after].alive = false;
    by_length.emplace(segments[before].length, before);
  };
  while (by_length.size() > 1 && by_length.begin()->first < min_length) {
    const std::size_t s = by_length.begin()->second;
    const std::size_t before = segments[s].previous;
    const std::size_t after = segments[s].next;
    const bool to_next = segments[after].length > segments[before].length;
    segments[s].boundary_class = segments[to_next ? after : before].boundary_class;
    // The joined segment can have the same class as its other neighbour.
    if (before != after && segments[after].boundary_class == segments[s].boundary_class) {
      join(s, after);
    }
    if (segments[before].boundary_class == segments[s].boundary_class) join(before, s);
  }
}

BoundaryRun make_run(const BoundaryLoop& loop, std::uint32_t loop_index, const Segment& segment,
                     std::size_t edge_count, std::span<const EdgeClass> classes) {
  const std::size_t n = loop.vertices.size();
  BoundaryRun run;
  run.boundary_class = segment.boundary_class;
  run.loop = loop_index;
  run.closed = edge_count == n;
  run.length = segment.length;
  std::map<std::uint32_t, std::size_t> votes;
  for (std::size_t k = 0; k < edge_count; ++k) {
    const std::size_t i = (segment.first + k) % n;
    run.vertices.push_back(loop.vertices[i]);
    run.triangles.push_back(loop.triangles[i]);
    ++votes[classes[i].view];
  }
  if (!run.closed) run.vertices.push_back(loop.vertices[(segment.first + edge_count) % n]);
  // Ties go to the later view.
  std::size_t most = 0;
  for (const auto& [view, count] : votes) {
    if (count >= most) {
      most = count;
      run.view = view;
    }
  }
  return run;
}

void check_config(const BoundaryConfig& config) {
  const auto check = [](const char* bounds, double value, bool valid) {
    if (!valid) refuse(std::string("boundary: ") + bounds + ", not " + short_text(value));
  };
  check("max_view_angle must be positive and at most pi/2 rad", config.max_view_angle,
        config.max_view_angle > 0 && config.max_view_angle <= std::numbers::pi / 2);
  check("min_run_length must be at least 0 and finite", config.min_run_length,
        config.min_run_length >= 0 && std::isfinite(config.min_run_length));
  check("min_loop_length must be at least 0 and finite", config.min_loop_length,
        config.min_loop_length >= 0 && std::isfinite(config.min_loop_length));
}

}  // namespace

std::vector<BoundaryRun> boundary_runs(
    const SurfaceMesh& surface, std::span<const BoundaryLoop> loops, std::span<const Pose> views,
    const Sensor& sensor, const BoundaryConfig& config,
    const std::function<bool(std::size_t view, const Eigen::Vector3d& point)>& sees) {
  check_config(config);
  sensor.validate();
  if (views.empty()) refuse("boundary: at least one view is required");
  const EdgeClassifier classifier(views, sensor, config.max_view_angle, sees);

  std::vector<BoundaryRun> runs;
  for (std::size_t l = 0; l < loops.size(); ++l) {
    const BoundaryLoop& loop = loops[l];
    const std::vector<BoundaryEdge> edges =
        detail::boundary_edges(surface, loop.vertices, loop.triangles, true);
    double length = 0;
    for (const BoundaryEdge& edge : edges) length += edge.length;
    if (edges.empty() || length < config.min_loop_length) continue;

    std::vector<EdgeClass> classes;
    const std::vector<Eigen::Vector3d> conormals =
        smoothed_conormals(edges, length, config.min_run_length);
    for (std::size_t i = 0; i < edges.size(); ++i) {
      classes.push_back(classifier.classify(edges[i], conormals[i]));
    }
    std::vector<Segment> segments = segments_of(classes, edges);
    join_short(segments, config.min_run_length);
    for (const Segment& segment : segments) {
      if (!segment.alive) continue;
      const std::size_t end = segments[segment.next].first;
      const std::size_t n = edges.size();
      const std::size_t count = end == segment.first ? n : (end + n - segment.first) % n;
      runs.push_back(make_run(loop, static_cast<std::uint32_t>(l), segment, count, classes));
    }
  }
  return runs;
}

}  // namespace viewgain
