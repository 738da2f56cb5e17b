// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include <Eigen/Core>
#include <cmath>
#include <limits>
#include <string>

#include "input_checks.hpp"
#include "map/grid_layout.hpp"
#include "map_update.hpp"
#include "viewgain/core/error.hpp"
#include "viewgain/grid/integrate_cloud.hpp"

namespace viewgain {
namespace {

using namespace detail;

constexpr std::size_t kPointChunk = 4096;

/// A cloud's points in the world.
class CloudPoints : public Readings {
 public:
  explicit CloudPoints(const Sensor& sensor) : Readings(sensor) {}

  void load(std::span<const std::array<double, 3>> points, const Eigen::Vector3d& origin,
            bool tapered, std::optional<double> support_plane, ThreadPool& pool) {
    if (points.size() > std::numeric_limits<std::uint32_t>::max()) {
      throw Error(ErrorCode::capacity,
                  "cloud of " + std::to_string(points.size()) + " points, the most is 4294967295");
    }
    origin_ = origin;
    rays_.resize(points.size());
    norms_.resize(points.size());
    resize(points.size());
    pool.for_each_chunk(points.size(), kPointChunk, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) {
        points_[i] = Eigen::Vector3d(points[i][0], points[i][1], points[i][2]);
        rays_[i] = points_[i] - origin;
        norms_[i] = rays_[i].stableNorm();
        const bool is_ray = std::isfinite(norms_[i]) && norms_[i] > 0;
        const PixelKind kind =
            sort_by_range(i, is_ray ? norms_[i] : std::numeric_limits<double>::quiet_NaN());
        if (kind != PixelKind::reading) continue;
        sigmas_[i] = sensor_.sigmas(norms_[i]);
        if (tapered) reach_taper_[2 * i + 1] = kTaperSigmas * sigmas_[i].axial;
        if (support_plane &&
            is_of_plane(points_[i].z() - *support_plane, rays_[i].z() / norms_[i], sigmas_[i])) {
          kinds_[i] = PixelKind::on_known;
        }
      }
    });
  }
};

}  // namespace

struct CloudIntegrator::Impl {
  IntegrationConfig config;
  MapUpdate update;
  CloudPoints points;
};

CloudIntegrator::CloudIntegrator(const Sensor& sensor, const IntegrationConfig& config,
                                 const ExecConfig& exec)
    : impl_(std::make_unique<Impl>(Impl{config, MapUpdate(config, exec), CloudPoints(sensor)})) {
  check_plane(config.support_plane);
}
CloudIntegrator::~CloudIntegrator() = default;
CloudIntegrator::CloudIntegrator(CloudIntegrator&&) noexcept = default;
CloudIntegrator& CloudIntegrator::operator=(CloudIntegrator&&) noexcept = default;

IntegrationReport CloudIntegrator::integrate(BeliefGrid& grid,
                                             std::span<const std::array<double, 3>> points,
                                             const Pose& T_world_sensor) {
  Impl& m = *impl_;
  const Pose view = rigid_view(T_world_sensor);
  m.points.load(points, view.translation(),
                m.config.occupancy != IntegrationConfig::Occupancy::literal, m.config.support_plane,
                m.update.pool());
  const Pose T_grid_world = grid.T_world_grid().inverse();
  return m.update.run(grid, {m.points, T_grid_world, view}, nullptr);
}

std::optional<Box> reading_bounds(const Sensor& sensor,
                                  std::span<const std::array<double, 3>> points,
                                  const Pose& T_world_sensor, const Pose& T_world_grid,
                                  std::optional<double> support_plane) {
  check_plane(support_plane);
  CloudPoints cloud(sensor);
  ThreadPool caller_alone(1);
  cloud.load(points, rigid_view(T_world_sensor).translation(), false, support_plane, caller_alone);
  return bounds_of(cloud, T_world_grid.inverse());
}

}  // namespace viewgain
