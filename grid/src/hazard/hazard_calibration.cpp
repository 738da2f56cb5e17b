// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include "viewgain/grid/hazard_calibration.hpp"

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>
#include <utility>
#include <vector>

#include "viewgain/core/error.hpp"
#include "viewgain/support/shared_rays.hpp"
#include "viewgain/support/state_reader.hpp"
#include "viewgain/support/text.hpp"
#include "viewgain/support/thread_pool.hpp"

namespace viewgain {
namespace {

constexpr double kPixels = 800;       // number of followed pixels
constexpr double kLeftOut = 3;        // before a reading [σ_ax]
constexpr double kEnough = 10;        // expected meetings of a frame with full weight
constexpr double kLeastEvents = 0.1;  // minimum to count at all
constexpr std::size_t kRowChunk = 4;

struct Sums {
  std::array<double, HazardCounters::kClasses> expected{}, met{};

  void add(const Sums& other) {
    for (std::size_t k = 0; k < expected.size(); ++k) {
      expected[k] += other.expected[k];
      met[k] += other.met[k];
    }
  }
};

// Interval of a ray inside a box: [begin, end), empty if it misses it.
struct Stretch {
  double begin, end;
};

Stretch clipped(const Box& box, const Eigen::Vector3d& origin, const Eigen::Vector3d& direction,
                Stretch stretch) {
  for (std::size_t a = 0; a < 3; ++a) {
    const auto axis = static_cast<Eigen::Index>(a);
    const double low = (box.min[a] - origin[axis]) / direction[axis];
    const double high = (box.max[a] - origin[axis]) / direction[axis];
    if (std::isnan(low) || std::isnan(high)) return {0, 0};  // along a face
    stretch.begin = std::max(stretch.begin, std::min(low, high));
    stretch.end = std::min(stretch.end, std::max(low, high));
  }
  return stretch;
}

// Whether the map's update assigns the reading to known surface, as associate() does: then noise
// moved it, and it is not a meeting.
bool is_of_known_surface(StateReader& map, double size, const Eigen::Vector3d& p_grid,
                         const Eigen::Vector3d& direction, double range, double sigma) {
  if (sigma < 0.5 * size) return false;
  const auto is_occupied = [&](double t) {
    return map.state(voxel_of((p_grid + t * direction) / size)) == VoxelState::occupied;
  };
  const double reach = std::min(3 * sigma, 8 * size);
  for (double t = 0.5 * size; t < reach; t += 0.5 * size) {
    if (is_occupied(t) || (t < range && is_occupied(-t))) return true;
  }
  return false;
}

// Expected and actual meetings of a frame's rays with the surface in unknown voxels.
class Meetings {
 public:
  Meetings(const BeliefGrid& grid, const HazardProbe& hazard, const Eigen::Vector3d& eye)
      : map_(grid),
        voxel_size_(grid.voxel_size()),
        hazard_(hazard),
        decay_length_(hazard.model().decay_length),
        eye_(eye),
        workspace_(grid.workspace()),
        // Half a hazard cell: finer steps give the same result.
        step_(0.5 * std::ldexp(grid.voxel_size(), hazard.cell_shift())) {}

  // A ray is free from `begin` to `end`, in metres.
  void pass(const Eigen::Vector3d& direction, double begin, double end) {
    const Stretch seen = clipped(workspace_, eye_, direction, {begin, end});
    for (double t = seen.begin + 0.5 * step_; t < seen.end; t += step_) {
      const Index3 voxel = voxel_of((eye_ + t * direction) / voxel_size_);
      if (map_.state(voxel) != VoxelState::unknown) continue;
      const HazardProbe::At at = hazard_.at(voxel);
      sums_.expected[class_at(at)] += at.start_rate * step_;
    }
  }
  // It meets the surface.
  void meet(const Eigen::Vector3d& direction, double range, double sigma) {
    const Eigen::Vector3d p = eye_ + range * direction;
    if (!workspace_.contains(p.x(), p.y(), p.z())) return;
    const Index3 voxel = voxel_of(p / voxel_size_);
    if (map_.state(voxel) != VoxelState::unknown) return;
    if (is_of_known_surface(map_, voxel_size_, p, direction, range, sigma)) return;
    sums_.met[class_at(hazard_.at(voxel))] += 1;
  }
  /// The counts since the last call.
  [[nodiscard]] Sums take() { return std::exchange(sums_, {}); }

 private:
  [[nodiscard]] std::size_t class_at(const HazardProbe::At& at) const {
    return HazardCounters::class_of(at.distance / decay_length_);
  }

  StateReader map_;
  double voxel_size_;  // [m]
  HazardProbe::Reader hazard_;
  double decay_length_;  // [m]
  Eigen::Vector3d eye_;
  Box workspace_;
  double step_;  // [m]
  Sums sums_;
};

// Adds a frame's counts; older ones lose weight.
void add_counts(const Sums& sums, BeliefGrid& grid) {
  const double expected = std::accumulate(sums.expected.begin(), sums.expected.end(), 0.0);
  if (expected < kLeastEvents) return;
  const double weight = HazardCounters::kFrame * std::min(1.0, expected / kEnough) / expected;
  HazardCounters counters = grid.hazard_counters();
  for (std::size_t k = 0; k < HazardCounters::kClasses; ++k) {
    HazardCounters::Class& c = counters.classes[k];
    c.expected =
        c.expected * HazardCounters::kKeptOf10 / 10 + std::llround(sums.expected[k] * weight);
    c.met = c.met * HazardCounters::kKeptOf10 / 10 + std::llround(sums.met[k] * weight);
  }
  grid.set_hazard_counters(counters);
}

}  // namespace

struct HazardCalibration::Impl {
  Sensor sensor;
  std::optional<double> support_plane;
  std::shared_ptr<const std::vector<Eigen::Vector3d>> rays;
  int stride;  // rows and columns of the followed pixels begin at half of it
  ThreadPool pool;

  // `of` is valid.
  Impl(const Sensor& of, std::optional<double> plane, const ExecConfig& exec)
      : sensor(of),
        support_plane(plane),
        rays(shared_rays(of.camera)),
        stride(std::max(1, static_cast<int>(std::lround(
                               std::sqrt(static_cast<double>(rays->size()) / kPixels))))),
        pool(exec.num_threads) {}

  void follow_row(const DepthFrame& frame, const Pose& T_world_camera, const Pose& T_grid_camera,
                  int v, Meetings& meetings) const;
};

void HazardCalibration::Impl::follow_row(const DepthFrame& frame, const Pose& T_world_camera,
                                         const Pose& T_grid_camera, int v,
                                         Meetings& meetings) const {
  const auto sees_plane = [&](const Eigen::Vector3d& p_camera, double range) {
    if (!support_plane) return false;
    const Eigen::Vector3d p = T_world_camera * p_camera;
    const double rise = (p.z() - T_world_camera.translation().z()) / range;
    return is_of_plane(p.z() - *support_plane, rise, sensor.sigmas(range, std::abs(rise)));
  };
  const int width = sensor.camera.width;
  for (int u = stride / 2; u < width; u += stride) {
    const std::size_t i =
        static_cast<std::size_t>(v) * static_cast<std::size_t>(width) + static_cast<std::size_t>(u);
    const Eigen::Vector3d& ray = (*rays)[i];
    const float z = frame.depth[i];
    if (!(z > 0) || !ray.allFinite()) continue;  // skips NaN too
    const double norm = ray.norm();
    const double range = z == DepthFrame::kOutOfRange ? std::numeric_limits<double>::infinity()
                                                      : static_cast<double>(z) * norm;
    if (range < sensor.min_range) continue;
    const bool is_reading = range <= sensor.max_range;
    const double sigma = is_reading ? sensor.sigmas(range).axial : 0;
    const Eigen::Vector3d direction = T_grid_camera.rotation() * ray / norm;
    meetings.pass(direction, sensor.min_range,
                  is_reading ? range - kLeftOut * sigma : sensor.max_range);
    if (is_reading && !frame.shows_known(i) && !sees_plane(static_cast<double>(z) * ray, range)) {
      meetings.meet(direction, range, sigma);
    }
  }
}

HazardCalibration::HazardCalibration(const Sensor& sensor, std::optional<double> support_plane,
                                     const ExecConfig& exec) {
  sensor.validate();
  impl_ = std::make_unique<Impl>(sensor, support_plane, exec);
}
HazardCalibration::~HazardCalibration() = default;
HazardCalibration::HazardCalibration(HazardCalibration&&) noexcept = default;
HazardCalibration& HazardCalibration::operator=(HazardCalibration&&) noexcept = default;

void HazardCalibration::count(BeliefGrid& grid, const HazardProbe& hazard, const DepthFrame& frame,
                              const Pose& T_world_camera) const {
  Impl& m = *impl_;
  check_frame_size(frame, m.sensor.camera);
  const std::optional<Pose> T_rigid = rigid_pose(T_world_camera);
  if (!T_rigid) refuse("the frame's pose is not a rigid transform");
  if (hazard.voxel_size() != grid.voxel_size()) {
    refuse("the hazard field has voxels of " + short_text(hazard.voxel_size()) +
           " m, but the grid has voxels of " + short_text(grid.voxel_size()) + " m");
  }
  if (!hazard.follows_counters() || hazard.near_box().volume() == 0) return;

  const Pose T_grid_camera = grid.T_world_grid().inverse() * *T_rigid;
  const int stride = m.stride, first = stride / 2;
  const int beyond = std::max(0, m.sensor.camera.height - first);
  std::vector<Sums> rows(static_cast<std::size_t>((beyond + stride - 1) / stride));
  m.pool.for_each_chunk(rows.size(), kRowChunk, [&](std::size_t begin, std::size_t end) {
    Meetings meetings(grid, hazard, T_grid_camera.translation());
    for (std::size_t row = begin; row < end; ++row) {
      m.follow_row(frame, *T_rigid, T_grid_camera, first + static_cast<int>(row) * stride,
                   meetings);
      rows[row] = meetings.take();
    }
  });
  Sums sums;  // in the order of the rows, so that the threads make no difference
  for (const Sums& row : rows) sums.add(row);
  add_counts(sums, grid);
}

}  // namespace viewgain
