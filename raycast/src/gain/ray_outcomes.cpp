// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include "viewgain/raycast/ray_outcomes.hpp"

#include <Eigen/Core>
#include <cstddef>
#include <vector>

#include "gain_evaluator_impl.hpp"

namespace viewgain {
namespace {

using detail::ViewTracer;

// What each ray of a view meets within the frame's limits.
std::vector<RayHit::Kind> met(const detail::ViewDriver& driver, const detail::PoseFrame& frame,
                              detail::ViewSweep& sweep) {
  const ViewTracer& tracer = driver.tracer();
  std::vector<RayHit::Kind> kinds(tracer.table().ray_count(), RayHit::Kind::none);
  tracer.prepare(frame, sweep, ViewTracer::Asked::everywhere);
  tracer.trace<ViewTracer::Asked::everywhere>(
      frame, sweep, [&](std::size_t number, const detail::RayTile& tile) {
        detail::for_each_lane(tile.hit | tile.blocked, [&](int lane) {
          if (tile.range[lane] > frame.max_range) return;  // an obstacle that is too far
          RayHit::Kind& kind = kinds[tracer.table().ray_index(number, lane)];
          if ((tile.blocked >> lane & 1U) != 0) {
            kind = RayHit::Kind::obstacle;
          } else if (driver.scene().occupied_leaf(tile.primitive[lane], tile.offset[lane])) {
            kind = RayHit::Kind::occupied;
          } else {
            kind = RayHit::Kind::unknown;
          }
        });
      });
  return kinds;
}

}  // namespace

RayOutcomes GainEvaluator::outcomes(const Pose& T_world_camera) const {
  const detail::ViewDriver& driver = impl_->driver;
  ViewGain opened;
  const auto frame = driver.open(T_world_camera, opened, detail::ViewDriver::From::anywhere);
  RayOutcomes counts;
  if (!frame) return counts;
  detail::ViewDriver::Lease lease(driver);
  detail::ViewSweep& sweep = lease.workspace().sweep;
  const std::vector<RayHit::Kind> hits = met(driver, *frame, sweep);
  detail::PoseFrame before = *frame;
  before.min_range = 0;
  before.max_range = frame->min_range;
  const std::vector<RayHit::Kind> near = met(driver, before, sweep);

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
  const auto ends_in_workspace = [&](const Eigen::Vector3d& ray) {
    const Eigen::Vector3f p = origin + R * ray.normalized().cast<float>() * end;
    const Index3& dims = snapshot.dims;
    return p.minCoeff() >= 0 && p.x() < static_cast<float>(dims.x) &&
           p.y() < static_cast<float>(dims.y) && p.z() < static_cast<float>(dims.z);
  };
  for (std::size_t i = 0; i < hits.size(); ++i) {
    ++counts.rays;
    if (near[i] == RayHit::Kind::occupied || near[i] == RayHit::Kind::obstacle) {
      ++counts.too_near;
    } else if (hits[i] == RayHit::Kind::unknown) {
      ++counts.unknown;
    } else if (hits[i] == RayHit::Kind::occupied) {
      ++counts.known_surface;
    } else if (hits[i] == RayHit::Kind::obstacle) {
      ++counts.obstacle;
    } else {
      const Eigen::Vector3d ray = ray_of(i);
      if (!ray.allFinite()) {
        --counts.rays;  // the lens has none there
      } else if (ends_in_workspace(ray)) {
        ++counts.out_of_range;
      } else {
        ++counts.out_of_map;
      }
    }
  }
  return counts;
}

}  // namespace viewgain
