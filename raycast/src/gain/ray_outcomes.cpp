// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include <Eigen/Core>
#include <algorithm>
#include <cstddef>
#include <limits>
#include <vector>

#include "gain_evaluator_impl.hpp"
#include "trace/ordered_walk.hpp"
#include "viewgain/raycast/gain_evaluator.hpp"

namespace viewgain {
namespace {

using detail::ViewTracer;

struct Meeting {
  RayHit::Kind kind = RayHit::Kind::none;
  float range = std::numeric_limits<float>::infinity();  // [voxels]
};

// What each ray of a view meets within the frame's limits, the support plane aside.
std::vector<Meeting> met(const detail::ViewDriver& driver, const detail::PoseFrame& frame,
                         detail::ViewSweep& sweep) {
  const ViewTracer& tracer = driver.tracer();
  std::vector<Meeting> meetings(tracer.table().ray_count());
  tracer.prepare(frame, sweep, ViewTracer::Asked::everywhere);
  tracer.trace<ViewTracer::Asked::everywhere>(
      frame, sweep, [&](std::size_t number, const detail::RayTile& tile) {
        detail::for_each_lane(tile.hit | tile.blocked, [&](int lane) {
          if (tile.range[lane] > frame.max_range) return;  // an obstacle that is too far
          auto& [kind, range] = meetings[tracer.table().ray_index(number, lane)];
          range = tile.range[lane];
          kind = detail::kind_of_end(driver.scene(), tile, lane);
        });
      });
  return meetings;
}

// Where a ray comes down on the support plane [voxels]; infinity: nowhere, or not by this gain.
class PlaneRange {
 public:
  PlaneRange(const detail::ViewDriver& driver, const detail::PoseFrame& frame)
      : limits_(detail::walk_limits(driver.scene(), frame)),
        above_(Eigen::Vector3f(limits_.normal.data()).dot(Eigen::Vector3f(frame.origin.data())) -
               limits_.height) {
    ends_rays_ =
        limits_.has_plane && above_ >= 0 && driver.core()->config.model != GainModel::paper;
  }
  [[nodiscard]] float along(const Eigen::Vector3f& direction) const {
    const float down = -Eigen::Vector3f(limits_.normal.data()).dot(direction);
    return ends_rays_ && down > 0 ? above_ / down : std::numeric_limits<float>::infinity();
  }

 private:
  detail::WalkLimits limits_;
  float above_;
  bool ends_rays_ = false;
};

}  // namespace

GainEvaluator::RayOutcomes GainEvaluator::outcomes(const Pose& T_world_camera) const {
  const detail::ViewDriver& driver = impl_->driver;
  ViewGain opened;
  const auto frame = driver.open(T_world_camera, opened, detail::ViewDriver::From::anywhere);
  GainEvaluator::RayOutcomes counts;
  if (!frame) return counts;
  detail::ViewDriver::Lease lease(driver);
  detail::ViewSweep& sweep = lease.workspace().sweep;
  const std::vector<Meeting> hits = met(driver, *frame, sweep);
  const PlaneRange plane(driver, *frame);

  const detail::EvaluatorCore& core = *driver.core();
  const GridSnapshot& snapshot = driver.scene().snapshot;
  const auto columns =
      static_cast<std::size_t>(detail::strided(camera().width, core.rays->pixel_stride));
  const auto ray_of = [&](std::size_t i) {
    const double s = core.rays->pixel_stride;
    return camera().ray(static_cast<double>(i % columns) * s, static_cast<double>(i / columns) * s);
  };
  const Eigen::Matrix<float, 3, 3, Eigen::RowMajor> R(frame->rotation.data());
  const Eigen::Vector3f origin(frame->origin.data());
  const float end = static_cast<float>(core.max_range / snapshot.voxel_size);  // [voxels]
  const auto ends_in_workspace = [&](const Eigen::Vector3f& direction) {
    const Eigen::Vector3f p = origin + direction * end;
    const Index3& dims = snapshot.dims;
    return p.minCoeff() >= 0 && p.x() < static_cast<float>(dims.x) &&
           p.y() < static_cast<float>(dims.y) && p.z() < static_cast<float>(dims.z);
  };
  for (std::size_t i = 0; i < hits.size(); ++i) {
    const Eigen::Vector3d ray = ray_of(i);
    if (!ray.allFinite()) continue;  // the lens has none there
    ++counts.rays;
    const Eigen::Vector3f direction = R * ray.normalized().cast<float>();
    const float on_plane = plane.along(direction);
    // What blocks before min_range is an obstacle or known surface.
    const bool is_blocked = hits[i].kind == RayHit::Kind::obstacle;
    if ((is_blocked && hits[i].range < frame->min_range) || on_plane < frame->min_range) {
      ++counts.too_near;
    } else if (on_plane <= std::min(hits[i].range, end)) {
      ++counts.obstacle;
    } else if (hits[i].kind == RayHit::Kind::unknown) {
      ++counts.unknown;
    } else if (hits[i].kind == RayHit::Kind::occupied) {
      ++counts.known_surface;
    } else if (is_blocked) {
      ++counts.obstacle;
    } else if (ends_in_workspace(direction)) {
      ++counts.out_of_range;
    } else {
      ++counts.out_of_map;
    }
  }
  return counts;
}

}  // namespace viewgain
