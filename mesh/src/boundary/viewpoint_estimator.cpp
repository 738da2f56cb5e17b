// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "viewgain/mesh/viewpoint_estimator.hpp"

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <initializer_list>
#include <limits>
#include <string>
#include <utility>

#include "boundary_edges.hpp"
#include "region_grower.hpp"
#include "surface/surface_access.hpp"
#include "viewgain/core/camera.hpp"
#include "viewgain/core/error.hpp"
#include "viewgain/support/text.hpp"

namespace viewgain::detail {

// Where the next view of a patch should look.
struct ViewTarget {
  Eigen::Vector3d point;   ///< world [m]
  Eigen::Vector3d normal;  ///< outward
  Eigen::Vector3d across;  ///< tangent, away from the boundary
};

namespace {

// Position along `direction` (unit) of the straight line across the image that has the fraction
// `share` of the image behind it. In units of the focal length, from the optical axis, without
// distortion.
double line_for_share(const PinholeCamera& camera, const Eigen::Vector2d& direction, double share) {
  // The position of a random image point along the direction is the sum of two independent uniform
  // numbers.
  const double x = std::abs(direction.x()) * camera.width / (2.0 * camera.fx);
  const double y = std::abs(direction.y()) * camera.height / (2.0 * camera.fy);
  const double wide = std::max(x, y);
  const double narrow = std::min(x, y);
  const double lower_share = std::min(share, 1.0 - share);
  double line = wide * (2.0 * lower_share - 1.0);
  if (lower_share < narrow / (2.0 * wide)) {
    line = std::sqrt(8.0 * wide * narrow * lower_share) - wide - narrow;
  }
  const Eigen::Vector2d center((0.5 * (camera.width - 1) - camera.cx) / camera.fx,
                               (0.5 * (camera.height - 1) - camera.cy) / camera.fy);
  return (share <= 0.5 ? line : -line) + center.dot(direction);
}

// The position is searched in steps, then by bisection to 2^-40 of a step.
constexpr int kSteps = 64;
constexpr int kBisections = 40;

ViewTarget target_at(const QuadraticPatch& patch, double u) {
  ViewTarget target;
  target.point = patch.point(u, 0.0);
  target.normal = patch.normal(u, 0.0);
  const Eigen::Vector3d outward = patch.axes.col(0);
  target.across = (outward - target.normal * target.normal.dot(outward)).normalized();
  return target;
}

// How much farther out than wanted the boundary appears in a view of this target. Positive while
// more than the overlap is known.
double excess(const ViewTarget& target, const Eigen::Vector3d& boundary,
              const PinholeCamera& camera, double distance, double overlap,
              const Eigen::Vector3d& up) {
  const Pose T_world_camera = look_at(target.point + distance * target.normal, target.point, up);
  const Eigen::Matrix3d R_camera_world = T_world_camera.rotation().transpose();
  const Eigen::Vector2d across = (R_camera_world * target.across).head<2>().normalized();
  const Eigen::Vector3d p = R_camera_world * (boundary - T_world_camera.translation());
  return across.dot(p.head<2>()) / p.z() - line_for_share(camera, across, overlap);
}

}  // namespace

// Moves outward along u until known surface fills the fraction `overlap` of the image of a camera
// that looks straight at the patch from `distance` [m]. Ends earlier at the depth of the patch or a
// turn of max_turn [rad].
ViewTarget next_view_target(const QuadraticPatch& patch, const PinholeCamera& camera,
                            double distance, double overlap, double max_turn,
                            const Eigen::Vector3d& up) {
  const ViewTarget boundary = target_at(patch, 0.0);
  const auto excess_at = [&](const ViewTarget& target) {
    return excess(target, boundary.point, camera, distance, overlap, up);
  };
  // A small overlap requires moving outward, a large one inward.
  const double sign = excess_at(boundary) > 0 ? 1.0 : -1.0;
  const double min_cosine = std::cos(max_turn);
  const auto may_go_to = [&](double u) {
    const ViewTarget target = target_at(patch, u);
    return target.normal.dot(boundary.normal) >= min_cosine && sign * excess_at(target) >= 0;
  };

  const double step = sign * patch.depth / kSteps;
  int steps = 0;
  while (steps < kSteps && may_go_to((steps + 1) * step)) ++steps;
  double good = steps * step;
  if (steps < kSteps) {
    double bad = (steps + 1) * step;
    for (int i = 0; i < kBisections; ++i) {
      const double middle = 0.5 * (good + bad);
      (may_go_to(middle) ? good : bad) = middle;
    }
  }
  return target_at(patch, good);
}

// All variants of a view of this target, in the order of EstimatorConfig.
void append_variants(const ViewTarget& target, double working_distance,
                     const EstimatorConfig& config, const BoundaryCandidate& prototype,
                     std::vector<BoundaryCandidate>& candidates) {
  const Eigen::Vector3d along = target.normal.cross(target.across);
  for (std::size_t d = 0; d < config.distances.size(); ++d) {
    const double distance = config.distances[d] * working_distance;
    for (const double tilt : config.tilts) {
      // Turning the normal about `along` moves it towards `across`; turning it about `across` moves
      // it against `along`.
      const std::array<Eigen::Vector3d, 2> sideways{target.across, -along};
      for (std::size_t axis = 0; axis < (tilt == 0 ? 1U : 2U); ++axis) {
        const Eigen::Vector3d direction =
            (std::cos(tilt) * target.normal + std::sin(tilt) * sideways[axis]).normalized();
        const Pose level = look_at(target.point + distance * direction, target.point, config.up);
        for (const double roll : config.rolls) {
          BoundaryCandidate candidate = prototype;
          const Eigen::AngleAxisd turn(roll, Eigen::Vector3d::UnitZ());
          candidate.T_world_camera = {level.rotation() * turn.toRotationMatrix(),
                                      level.translation()};
          candidate.target = target.point;
          candidate.distance = distance;
          candidate.tilt = tilt;
          candidate.roll = roll;
          candidate.nominal = d == 0 && tilt == 0 && roll == 0;
          candidates.push_back(candidate);
        }
      }
    }
  }
}

}  // namespace viewgain::detail

namespace viewgain {
namespace {

using detail::BoundaryEdge;

// A quadric over the boundary's tangent plane approximates a round surface badly beyond this: at
// the border of a cylinder of 30 mm radius the normal is wrong by 2.9° with 45°, and by 8.5° with
// 60°.
constexpr double kMaxRegionTurn = std::numbers::pi / 4;

// Conormals cancel around a whole loop, but not in a third of it.
constexpr std::size_t kMinPiecesOfClosedRun = 3;

[[noreturn]] void refuse(const std::string& bounds, double value) {
  viewgain::refuse("viewpoint estimator: " + bounds + ", not " + short_text(value));
}

template <typename Valid>
void check_list(const std::string& name, const char* bounds, const std::vector<double>& values,
                Valid valid) {
  if (values.empty()) viewgain::refuse("viewpoint estimator: the list " + name + " is empty");
  for (const double value : values) {
    if (!valid(value)) refuse(name + " must be " + bounds, value);
  }
}

void check_config(const EstimatorConfig& config, double working_distance) {
  const auto positive = [](double x) { return std::isfinite(x) && x > 0; };
  const std::initializer_list<std::pair<const char*, double>> lengths{
      {"working_distance", working_distance},
      {"patch_length", config.patch_length},
      {"region_depth", config.region_depth}};
  for (const auto& [name, value] : lengths) {
    if (!positive(value)) refuse(std::string(name) + " must be positive and finite", value);
  }
  if (!(config.overlap > 0 && config.overlap < 1)) {
    refuse("overlap must be between 0 and 1", config.overlap);
  }
  if (!(config.max_turn >= 0 && config.max_turn <= std::numbers::pi)) {
    refuse("max_turn must be in 0..pi rad", config.max_turn);
  }
  check_list("distances", "positive and finite", config.distances, positive);
  check_list("tilts", "between -pi/2 and pi/2 rad", config.tilts,
             [](double x) { return std::abs(x) < std::numbers::pi / 2; });
  check_list("rolls", "finite", config.rolls, [](double x) { return std::isfinite(x); });
  if (!config.up.allFinite() || config.up.isZero(0)) {
    viewgain::refuse("viewpoint estimator: up must be finite and not zero");
  }
}

// A part of a run that gets one patch.
struct Piece {
  Eigen::Vector3d middle = Eigen::Vector3d::Zero();   // [m]
  Eigen::Vector3d outward = Eigen::Vector3d::Zero();  // mean conormal
  Eigen::Vector3d normal = Eigen::Vector3d::Zero();   // mean at the vertices
  std::vector<std::uint32_t> vertices;
};

// Cuts a run into pieces of equal length; an edge belongs to the piece that contains its middle.
std::vector<Piece> cut_run(const SurfaceMesh& surface, const BoundaryRun& run,
                           double patch_length) {
  const std::vector<BoundaryEdge> edges =
      detail::boundary_edges(surface, run.vertices, run.triangles, run.closed);
  double length = 0;
  for (const BoundaryEdge& edge : edges) length += edge.length;
  // Tolerates rounding of lengths that are a multiple. More pieces than edges would leave empty
  // pieces.
  std::size_t count = static_cast<std::size_t>(
      std::clamp(std::ceil(length / patch_length - 1e-6), 1.0, static_cast<double>(edges.size())));
  if (run.closed) count = std::max(count, kMinPiecesOfClosedRun);

  std::vector<Piece> pieces;
  std::size_t current = std::numeric_limits<std::size_t>::max();
  double travelled = 0;
  double piece_length = 0;
  const auto finish = [&] {
    if (!pieces.empty() && piece_length > 0) pieces.back().middle /= piece_length;
    piece_length = 0;
  };
  for (std::size_t i = 0; i < edges.size(); ++i) {
    const double share = length > 0 ? (travelled + 0.5 * edges[i].length) / length : 0.0;
    const std::size_t piece =
        std::min(count - 1, static_cast<std::size_t>(share * static_cast<double>(count)));
    if (piece != current) {
      finish();
      current = piece;
      pieces.emplace_back().vertices.push_back(run.vertices[i]);
    }
    pieces.back().vertices.push_back(run.vertices[(i + 1) % run.vertices.size()]);
    pieces.back().middle += edges[i].length * edges[i].middle;
    pieces.back().outward += edges[i].length * edges[i].outward;
    piece_length += edges[i].length;
    travelled += edges[i].length;
  }
  finish();
  for (Piece& piece : pieces) {
    for (const std::uint32_t v : piece.vertices) piece.normal += detail::normal(surface, v);
  }
  return pieces;
}

// Whether a piece has a defined outward direction: neither its conormals nor its normals cancel.
bool has_frame(const Piece& piece) {
  const Eigen::Vector3d normal = piece.normal.stableNormalized();
  const Eigen::Vector3d outward = piece.outward.stableNormalized();
  return !normal.isZero(0) && outward.cross(normal).norm() > 1e-3;
}

}  // namespace

EstimatedViews estimate_views(
    const SurfaceMesh& surface, std::span<const Pose> views, const Sensor& sensor,
    double working_distance, const EstimatorConfig& config,
    const std::function<bool(std::size_t view, const Eigen::Vector3d& point)>& sees) {
  check_config(config, working_distance);
  EstimatedViews result;
  const std::vector<BoundaryLoop> loops = boundary_loops(surface);
  result.runs = boundary_runs(surface, loops, views, sensor, config.boundary, sees);
  detail::RegionGrower grower(surface);
  std::vector<Eigen::Vector3d> points;
  for (std::size_t r = 0; r < result.runs.size(); ++r) {
    const BoundaryRun& run = result.runs[r];
    for (const Piece& piece : cut_run(surface, run, config.patch_length)) {
      if (!has_frame(piece)) continue;
      std::vector<std::uint32_t> region =
          grower.grow(piece.vertices, config.region_depth, kMaxRegionTurn);
      points.clear();
      for (const std::uint32_t v : region) points.push_back(detail::position(surface, v));
      const QuadraticPatch patch = fit_patch(points, piece.middle, piece.outward, piece.normal);

      BoundaryCandidate prototype;
      prototype.boundary_class = run.boundary_class;
      prototype.run = static_cast<std::uint32_t>(r);
      prototype.patch = static_cast<std::uint32_t>(result.patches.size());
      detail::append_variants(detail::next_view_target(patch, sensor.camera, working_distance,
                                                       config.overlap, config.max_turn, config.up),
                              working_distance, config, prototype, result.candidates);
      result.patches.push_back(patch);
      result.regions.push_back(std::move(region));
      result.run_of_patch.push_back(static_cast<std::uint32_t>(r));
    }
  }
  return result;
}

}  // namespace viewgain
