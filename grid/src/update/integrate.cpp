// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include "viewgain/grid/integrate.hpp"

#include <optional>
#include <utility>

#include "frame_pixels.hpp"
#include "input_checks.hpp"
#include "map/grid_layout.hpp"
#include "map_update.hpp"

namespace viewgain {
namespace {

using namespace detail;

std::optional<CameraPlane> plane_seen_from(const Pose& T_world_camera,
                                           std::optional<double> height) {
  if (!height) return std::nullopt;
  return CameraPlane(*height, T_world_camera);
}

}  // namespace

struct FrameIntegrator::Impl {
  IntegrationConfig config;
  MapUpdate update;
  FramePixels pixels;
};

FrameIntegrator::FrameIntegrator(const Sensor& sensor, const IntegrationConfig& config,
                                 const ExecConfig& exec)
    : impl_(std::make_unique<Impl>(Impl{config, MapUpdate(config, exec), FramePixels(sensor)})) {
  check_plane(config.support_plane);
}
FrameIntegrator::~FrameIntegrator() = default;
FrameIntegrator::FrameIntegrator(FrameIntegrator&&) noexcept = default;
FrameIntegrator& FrameIntegrator::operator=(FrameIntegrator&&) noexcept = default;

IntegrationReport FrameIntegrator::integrate(BeliefGrid& grid, const DepthFrame& frame,
                                             const Pose& T_world_camera_in,
                                             const PoseSigma& pose_sigma) {
  Impl& m = *impl_;
  check_frame_size(frame, m.pixels.sensor().camera);
  check_pose_sigma(pose_sigma);
  const Pose T_world_camera = rigid_view(T_world_camera_in);
  const Pose T_camera_grid = T_world_camera.inverse() * grid.T_world_grid();
  const Pose T_grid_camera = grid.T_world_grid().inverse() * T_world_camera;
  const ConeCamera camera(m.pixels.sensor().camera, T_camera_grid);
  m.pixels.set_pose_sigma(pose_sigma);
  m.pixels.load(frame, m.config.occupancy != IntegrationConfig::Occupancy::literal, m.update.pool(),
                plane_seen_from(T_world_camera, m.config.support_plane));
  return m.update.run(grid, {m.pixels, T_grid_camera, T_world_camera},
                      m.config.carve == IntegrationConfig::Carve::cones ? &camera : nullptr);
}

std::optional<Box> reading_bounds(const Sensor& sensor, const DepthFrame& frame,
                                  const Pose& T_world_camera, const Pose& T_world_grid,
                                  std::optional<double> support_plane) {
  FramePixels pixels(sensor);
  check_frame_size(frame, sensor.camera);
  check_plane(support_plane);
  const Pose T_grid_camera = T_world_grid.inverse() * rigid_view(T_world_camera);
  ThreadPool caller_alone(1);
  pixels.load(frame, false, caller_alone,
              plane_seen_from(rigid_view(T_world_camera), support_plane));
  return bounds_of(pixels, T_grid_camera);
}

}  // namespace viewgain
