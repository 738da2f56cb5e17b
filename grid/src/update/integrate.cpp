// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include "viewgain/grid/integrate.hpp"

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <memory>
#include <string>

#include "map/grid_layout.hpp"
#include "map/map_notes.hpp"
#include "map_update.hpp"
#include "readings.hpp"
#include "viewgain/core/error.hpp"
#include "viewgain/core/pose.hpp"
#include "viewgain/support/block_lattice.hpp"
#include "viewgain/support/shared_rays.hpp"
#include "viewgain/support/thread_pool.hpp"

namespace viewgain::detail {

/// The support plane in a camera frame: points p with normal · p = offset.
struct CameraPlane {
  Eigen::Vector3d normal;  ///< unit, up in the world
  double offset = 0;       ///< [m]; negative if the camera is above the plane

  /// The plane world z = `height` [m].
  CameraPlane(double height, const Pose& T_world_camera)
      : normal(T_world_camera.rotation().row(2).transpose()),
        offset(height - T_world_camera.translation().z()) {}
};

/// One sensor's pixels: their rays and the data of the current frame, camera frame.
class FramePixels : public Readings {
 public:
  /// Removes the lens distortion of every pixel once.
  explicit FramePixels(const Sensor& sensor);

  /// Pose uncertainty of the next frames in addition to the sensor's.
  void set_pose_sigma(const PoseSigma& sigma);

  /// Classifies the frame's pixels and computes data that depends only on the readings. cosθ =
  /// amplitude · range² if the frame has unsaturated amplitudes, otherwise cos_incidence(). With
  /// `tapered` false crossings keep their weight up to the reading. Readings of the frame's known
  /// depth, and those below `plane` or less than 3 σ above it, are on_known. Readings that are
  /// certain, by their noise, to cross the first `certain_range` [m] at full weight get neither
  /// taper nor sigmas, unless there is a plane. The frame must have the camera's size.
  void load(const DepthFrame& frame, bool tapered, double certain_range, ThreadPool& pool,
            const std::optional<CameraPlane>& plane = {});

  /// Cosine of the angle between a reading's ray and the normal of its 3×3 neighbourhood: the cross
  /// product of the sums, over rows and columns, of differences across the pixel (one-sided at the
  /// pixel itself if there is no such pair). Ignores neighbours that are not readings, or whose
  /// depth differs by more than a surface at the least cosine of the noise models explains. 1
  /// without a normal.
  [[nodiscard]] double cos_incidence(int u, int v) const;

 private:
  /// Place of a pixel in depths().
  [[nodiscard]] std::ptrdiff_t bordered(int u, int v) const {
    return std::ptrdiff_t{v + kDepthBorder} * (row_length_ + 2 * kDepthBorder) + u + kDepthBorder;
  }

  PoseSigma own_pose_sigma_;
  std::shared_ptr<const std::vector<Eigen::Vector3d>> table_;
};

namespace {

constexpr std::size_t kRowChunk = 8;
constexpr double kNoDepth = std::numeric_limits<double>::quiet_NaN();

/// An amplitude that is NaN or negative counts as the darkest: least information.
double cos_from_amplitude(double amplitude, double range) {
  return amplitude > 0 ? std::min(1.0, amplitude * range * range) : 0.0;
}

}  // namespace

FramePixels::FramePixels(const Sensor& sensor)
    : Readings(sensor), own_pose_sigma_(sensor.pose_sigma) {
  row_length_ = sensor_.camera.width;
  table_ = shared_rays(sensor_.camera);
  rays_ = *table_;
  norms_.reserve(rays_.size());
  for (const Eigen::Vector3d& ray : rays_) norms_.push_back(ray.norm());
  resize(rays_.size());
  depths_.assign(static_cast<std::size_t>(row_length_ + 2 * kDepthBorder) *
                     static_cast<std::size_t>(sensor_.camera.height + 2 * kDepthBorder),
                 kNoDepth);
}

void FramePixels::set_pose_sigma(const PoseSigma& sigma) {
  sensor_.pose_sigma = {std::hypot(own_pose_sigma_.translation, sigma.translation),
                        std::hypot(own_pose_sigma_.rotation, sigma.rotation)};
}

void FramePixels::load(const DepthFrame& frame, bool tapered, double certain_range,
                       ThreadPool& pool, const std::optional<CameraPlane>& plane) {
  const auto width = static_cast<std::size_t>(sensor_.camera.width);
  const auto height = static_cast<std::size_t>(sensor_.camera.height);

  pool.for_each_chunk(height, kRowChunk, [&](std::size_t begin, std::size_t end) {
    for (std::size_t v = begin; v < end; ++v) {
      double* const depths = &depths_[static_cast<std::size_t>(bordered(0, static_cast<int>(v)))];
      for (std::size_t u = 0; u < width; ++u) {
        const std::size_t i = v * width + u;
        const double depth = frame.depth[i];
        // The range is NaN where the lens model has no ray.
        const PixelKind kind = sort_by_range(i, depth > 0 ? depth * norms_[i] : kNoDepth);
        points_[i] = kind == PixelKind::reading ? Eigen::Vector3d(rays_[i] * depth)
                                                : Eigen::Vector3d(Eigen::Vector3d::Zero());
        depths[u] = kind == PixelKind::reading ? depth : kNoDepth;
      }
    }
  });

  pool.for_each_chunk(height, kRowChunk, [&](std::size_t begin, std::size_t end) {
    for (std::size_t v = begin; v < end; ++v) {
      for (std::size_t u = 0; u < width; ++u) {
        const std::size_t i = v * width + u;
        if (kinds_[i] != PixelKind::reading) continue;
        const double range = reach_taper_[2 * i];
        if (range > certain_range && !plane) {
          // The largest sigma, whatever the surface's slope.
          const double taper = tapered ? kTaperSigmas * sensor_.sigmas(range, 0.0).axial : 0.0;
          if (range - taper > certain_range) {
            if (frame.shows_known(i)) kinds_[i] = PixelKind::on_known;
            continue;
          }
        }
        const double cosine =
            frame.amplitude.empty() || frame.amplitude[i] == DepthFrame::kSaturated
                ? cos_incidence(static_cast<int>(u), static_cast<int>(v))
                : cos_from_amplitude(frame.amplitude[i], range);
        sigmas_[i] = sensor_.sigmas(range, cosine);
        if (tapered) reach_taper_[2 * i + 1] = kTaperSigmas * sigmas_[i].axial;
        if (frame.shows_known(i)) {
          kinds_[i] = PixelKind::on_known;
          continue;
        }
        if (!plane) continue;
        const double up = plane->normal.dot(points_[i]);
        if (is_of_plane(up - plane->offset, up / range, sigmas_[i])) {
          kinds_[i] = PixelKind::on_known;
        }
      }
    }
  });
  if (!plane && frame.known_depth.empty()) return;
  for (std::size_t i = 0; i < kinds_.size(); ++i) {
    if (kinds_[i] != PixelKind::on_known) continue;
    depths_[static_cast<std::size_t>(
        bordered(static_cast<int>(i % width), static_cast<int>(i / width)))] = kNoDepth;
  }
}

double FramePixels::cos_incidence(int u, int v) const {
  const PinholeCamera& camera = sensor_.camera;
  const Eigen::Vector3d* points =
      points_.data() + static_cast<std::ptrdiff_t>(v) * camera.width + u;
  const double* depths = depths_.data() + bordered(u, v);
  const auto at = [&](int i, int j) -> const Eigen::Vector3d& {
    return points[static_cast<std::ptrdiff_t>(j) * camera.width + i];
  };
  const Eigen::Vector3d& center = at(0, 0);
  // Depth per pixel of the steepest surface in the noise models.
  static const double kMaxSlope =
      std::sqrt(1.0 - kMinCosIncidence * kMinCosIncidence) / kMinCosIncidence;
  const double max_step = kMaxSlope * center.z() / std::min(camera.fx, camera.fy);

  bool ok[3][3];
  for (int j = -1; j <= 1; ++j) {
    for (int i = -1; i <= 1; ++i) {
      const double depth = depths[std::ptrdiff_t{j} * (camera.width + 2 * kDepthBorder) + i];
      const double pixels = std::abs(i) + std::abs(j);
      ok[j + 1][i + 1] = std::abs(depth - center.z()) <= pixels * max_step;  // false for NaN
    }
  }
  Eigen::Vector3d du = Eigen::Vector3d::Zero(), dv = Eigen::Vector3d::Zero();
  bool has_du = false, has_dv = false;
  for (int n = -1; n <= 1; ++n) {
    if (ok[n + 1][0] && ok[n + 1][2]) du += at(1, n) - at(-1, n), has_du = true;
    if (ok[0][n + 1] && ok[2][n + 1]) dv += at(n, 1) - at(n, -1), has_dv = true;
  }
  if (!has_du) {
    if (ok[1][2]) du = at(1, 0) - center, has_du = true;
    if (!has_du && ok[1][0]) du = center - at(-1, 0), has_du = true;
  }
  if (!has_dv) {
    if (ok[2][1]) dv = at(0, 1) - center, has_dv = true;
    if (!has_dv && ok[0][1]) dv = center - at(0, -1), has_dv = true;
  }
  if (!has_du || !has_dv) return 1.0;
  const Eigen::Vector3d normal = du.cross(dv);
  const double length = normal.norm();
  if (!(length > 0)) return 1.0;
  return std::min(1.0, std::abs(normal.dot(center)) / (length * center.norm()));
}

}  // namespace viewgain::detail

namespace viewgain {
namespace {

using namespace detail;

// No voxel that a frame can change is farther from the eye [m]: those of all blocks that the
// workspace touches.
double farthest_voxel(const BeliefGrid& grid, const Eigen::Vector3d& eye) {
  const Index3 low = grid.min_index(), dims = grid.dims();
  const auto at = [&](std::int32_t from, std::int32_t count, double of_eye) {
    const double first = (from - kBlockSize) * grid.voxel_size(),
                 last = (from + count + kBlockSize) * grid.voxel_size();
    return std::max(std::abs(of_eye - first), std::abs(of_eye - last));
  };
  return std::hypot(at(low.x, dims.x, eye.x()), at(low.y, dims.y, eye.y()),
                    at(low.z, dims.z, eye.z()));
}

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
  std::string sensor;  // for the map's notes
};

FrameIntegrator::FrameIntegrator(const Sensor& sensor, const IntegrationConfig& config,
                                 const ExecConfig& exec)
    : impl_(std::make_unique<Impl>(
          Impl{config, MapUpdate(config, exec), FramePixels(sensor), sensor_toml(sensor)})) {
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
  FrameNote note(grid, m.sensor, frame.identity);
  m.pixels.set_pose_sigma(pose_sigma);
  m.pixels.load(frame, m.config.occupancy != IntegrationConfig::Occupancy::literal,
                farthest_voxel(grid, T_grid_camera.translation()), m.update.pool(),
                plane_seen_from(T_world_camera, m.config.support_plane));
  const IntegrationReport report =
      m.update.run(grid, {m.pixels, T_grid_camera, T_world_camera},
                   m.config.carve == IntegrationConfig::Carve::cones ? &camera : nullptr);
  note.put(grid);
  return report;
}

std::optional<Box> reading_bounds(const Sensor& sensor, const DepthFrame& frame,
                                  const Pose& T_world_camera, const Pose& T_world_grid,
                                  std::optional<double> support_plane) {
  FramePixels pixels(sensor);
  check_frame_size(frame, sensor.camera);
  check_plane(support_plane);
  const Pose T_grid_camera = T_world_grid.inverse() * rigid_view(T_world_camera);
  ThreadPool caller_alone(1);
  pixels.load(frame, false, 0, caller_alone,
              plane_seen_from(rigid_view(T_world_camera), support_plane));
  return bounds_of(pixels, T_grid_camera);
}

namespace {

constexpr std::size_t kPointChunk = 4096;

/// A cloud's points in the world.
class CloudPoints : public Readings {
 public:
  explicit CloudPoints(const Sensor& sensor) : Readings(sensor) {}

  void load(std::span<const std::array<double, 3>> points, const Eigen::Vector3d& origin,
            bool tapered, std::optional<double> support_plane, ThreadPool& pool) {
    if (points.size() > std::numeric_limits<std::uint32_t>::max()) {
      throw Error(ErrorCode::capacity, "the cloud has " + std::to_string(points.size()) +
                                           " points; the maximum is 4294967295");
    }
    origin_ = origin;
    lines_.resize(points.size());
    rays_ = lines_;
    norms_.resize(points.size());
    resize(points.size());
    pool.for_each_chunk(points.size(), kPointChunk, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) {
        points_[i] = Eigen::Vector3d(points[i][0], points[i][1], points[i][2]);
        lines_[i] = points_[i] - origin;
        norms_[i] = lines_[i].stableNorm();
        const bool is_ray = std::isfinite(norms_[i]) && norms_[i] > 0;
        const PixelKind kind =
            sort_by_range(i, is_ray ? norms_[i] : std::numeric_limits<double>::quiet_NaN());
        if (kind != PixelKind::reading) continue;
        sigmas_[i] = sensor_.sigmas(norms_[i]);
        if (tapered) reach_taper_[2 * i + 1] = kTaperSigmas * sigmas_[i].axial;
        if (support_plane &&
            is_of_plane(points_[i].z() - *support_plane, lines_[i].z() / norms_[i], sigmas_[i])) {
          kinds_[i] = PixelKind::on_known;
        }
      }
    });
  }

 private:
  std::vector<Eigen::Vector3d> lines_;  // from the origin to the points
};

}  // namespace

struct CloudIntegrator::Impl {
  IntegrationConfig config;
  MapUpdate update;
  CloudPoints points;
  std::string sensor;  // for the map's notes
};

CloudIntegrator::CloudIntegrator(const Sensor& sensor, const IntegrationConfig& config,
                                 const ExecConfig& exec)
    : impl_(std::make_unique<Impl>(
          Impl{config, MapUpdate(config, exec), CloudPoints(sensor), sensor_toml(sensor)})) {
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
  FrameNote note(grid, m.sensor, {});
  const Pose T_grid_world = grid.T_world_grid().inverse();
  const IntegrationReport report = m.update.run(grid, {m.points, T_grid_world, view}, nullptr);
  note.put(grid);
  return report;
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
