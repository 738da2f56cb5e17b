// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "next_view.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

namespace viewgain::detail {
namespace {

// The slide is searched in steps, then by bisection: 2^-40 of a step.
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

// How much farther out the boundary appears in a view of this target than it should: positive while
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

double line_for_share(const PinholeCamera& camera, const Eigen::Vector2d& direction, double share) {
  // A point of the image, along the direction, is the sum of two independent uniform numbers.
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

ViewTarget next_view_target(const QuadraticPatch& patch, const PinholeCamera& camera,
                            double distance, double overlap, double max_turn,
                            const Eigen::Vector3d& up) {
  const ViewTarget boundary = target_at(patch, 0.0);
  const auto excess_at = [&](const ViewTarget& target) {
    return excess(target, boundary.point, camera, distance, overlap, up);
  };
  // A small overlap asks to go outward, a large one inward.
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

void append_variants(const ViewTarget& target, double working_distance,
                     const EstimatorConfig& config, const BoundaryCandidate& prototype,
                     std::vector<BoundaryCandidate>& candidates) {
  const Eigen::Vector3d along = target.normal.cross(target.across);
  for (std::size_t d = 0; d < config.distances.size(); ++d) {
    const double distance = config.distances[d] * working_distance;
    for (const double tilt : config.tilts) {
      // Turning the normal about `along` moves it towards `across`, about `across` against `along`.
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
