// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <string>
#include <utility>

#include "classic_map_data.hpp"
#include "classic_rays.hpp"
#include "classic_walk.hpp"
#include "gain/batch_loop.hpp"
#include "gain/idle_list.hpp"
#include "scene/scene_data.hpp"
#include "trace/scene_tracing.hpp"
#include "viewgain/core/error.hpp"
#include "viewgain/support/text.hpp"

namespace viewgain {
namespace detail {
namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

[[noreturn]] void reject(const std::string& what) {
  throw Error(ErrorCode::invalid_argument, what);
}

void check_gains(const std::vector<ClassicGain>& gains) {
  if (gains.empty()) reject("no classic gain is asked for");
  for (std::size_t i = 0; i < gains.size(); ++i) {
    if (std::find(gains.begin(), gains.begin() + static_cast<std::ptrdiff_t>(i), gains[i]) !=
        gains.begin() + static_cast<std::ptrdiff_t>(i)) {
      std::string text("the classic gain ");
      reject(text.append(classic_gain_name(gains[i])).append(" is asked for twice"));
    }
  }
}

const ClassicConfig& checked(const ClassicConfig& config, const Sensor& sensor) {
  sensor.validate();
  check_gains(config.gains);
  if (config.pixel_stride < 1) {
    reject("pixel stride is " + std::to_string(config.pixel_stride) + "; it must be >= 1");
  }
  const double near = config.min_range.value_or(sensor.min_range),
               far = config.max_range.value_or(sensor.max_range);
  if (!(std::isfinite(near) && std::isfinite(far) && near >= 0 && near < far)) {
    reject("ranges are " + short_text(near) + " to " + short_text(far) +
           " m; they must be >= 0, finite and the first below the second");
  }
  const double prior = config.unknown_prior;
  if (!(prior >= 0 && prior <= 1)) {
    reject("the unknown voxels' prior is " + short_text(prior) + "; it must be in 0..1");
  }
  if (config.semantics == GainSemantics::shipped &&
      !(config.free_below >= 0 && config.free_below <= prior && prior <= config.occupied_above &&
        config.occupied_above <= 1)) {
    reject("thresholds " + short_text(config.free_below) + " and " +
           short_text(config.occupied_above) + " must be in 0..1, on both sides of the prior " +
           short_text(prior));
  }
  return config;
}

}  // namespace

/// What the evaluators of one sensor and configuration share, whatever their maps. Thread safe.
struct ClassicCore {
  ClassicConfig config;
  double min_range, max_range;  // [m]
  ClassicRays rays;
  VoxelValues values;
  bool is_distinct;
  ThreadPool pool;
  IdleList<DistinctVoxels> workspaces;

  ClassicCore(const Sensor& sensor, const ClassicConfig& c, const ExecConfig& exec)
      : config(checked(c, sensor)),
        min_range(c.min_range.value_or(sensor.min_range)),
        max_range(c.max_range.value_or(sensor.max_range)),
        rays(sensor.camera, c.pixel_stride),
        values(c),
        is_distinct(std::any_of(c.gains.begin(), c.gains.end(),
                                [](ClassicGain gain) {
                                  return gain == ClassicGain::unknown_count ||
                                         gain == ClassicGain::surface_frontier_count;
                                })),
        pool(exec.num_threads) {}
};

namespace {

// f(x; a): 0 at 0 and 1, 1 at a, two cubics without slope at these.
double area_weight(double x, double a) {
  if (x <= a) return (-2 * x / a + 3) * (x / a) * (x / a);
  return (((-2 * x + 3 * (a + 1)) * x - 6 * a) * x + 3 * a - 1) / std::pow(a - 1, 3);
}

}  // namespace

/// Scores views of one map.
class ClassicDriver {
 public:
  ClassicDriver(std::shared_ptr<const ClassicMap> map, std::shared_ptr<ClassicCore> core)
      : map_(std::move(map)), core_(std::move(core)) {
    if (!map_) reject("the classic gains have no map");
    for (const ClassicGain gain : core_->config.gains) check(gain);
    const VoxelScene& scene = map_->scene();
    const std::optional<double>& plane = scene.surroundings().support_plane;
    has_plane_ = plane.has_value();
    if (!plane) return;
    const Pose T_grid_world = scene.snapshot().T_world_grid.inverse();
    normal_ = T_grid_world.rotation() * Eigen::Vector3d::UnitZ();
    const Index3& base = data().table.base;
    height_ =
        normal_.dot(T_grid_world * Eigen::Vector3d(0, 0, *plane) / scene.snapshot().voxel_size -
                    Eigen::Vector3d(base.x, base.y, base.z));
  }

  class Lease {
   public:
    explicit Lease(const ClassicDriver& driver)
        : driver_(driver), workspace_(driver.core_->workspaces.take()) {
      if (!workspace_) workspace_ = std::make_unique<DistinctVoxels>();
    }
    ~Lease() { driver_.core_->workspaces.give_back(std::move(workspace_)); }
    Lease(const Lease&) = delete;
    Lease& operator=(const Lease&) = delete;
    [[nodiscard]] DistinctVoxels& distinct() { return *workspace_; }

   private:
    const ClassicDriver& driver_;
    std::unique_ptr<DistinctVoxels> workspace_;
  };

  [[nodiscard]] const std::shared_ptr<const ClassicMap>& map() const { return map_; }
  [[nodiscard]] const std::shared_ptr<ClassicCore>& core() const { return core_; }

  ViewStatus evaluate(const Pose& T_world_camera, DistinctVoxels& distinct,
                      std::span<double> results) const {
    const VoxelScene& scene = map_->scene();
    const auto frame = classic_frame(scene, data().table, T_world_camera);
    if (!frame) return ViewStatus::bad_pose;
    if (is_in_occupied(*frame)) {
      std::fill(results.begin(), results.end(), 0.0);
      return ViewStatus::camera_in_occupied;
    }
    ClassicSums sums;
    if (core_->is_distinct) distinct.begin(data().table);
    if (!frame->sees_nothing) trace(*frame, distinct, sums);
    for (std::size_t i = 0; i < results.size(); ++i) {
      results[i] = value(core_->config.gains[i], sums, distinct);
    }
    return ViewStatus::ok;
  }

 private:
  [[nodiscard]] const ClassicMapData& data() const { return ClassicAccess::data(*map_); }

  void check(ClassicGain gain) const {
    if (!needs_occlusion(gain) || data().occlusion == OcclusionKnown::yes) return;
    std::string text(classic_gain_name(gain));
    text.append(" needs to know what earlier views have left behind surfaces: ");
    reject(text.append(data().occlusion == OcclusionKnown::no_views
                           ? "the map remembers no views"
                           : "the sensor that the map's readings came from is not given"));
  }

  [[nodiscard]] bool is_in_occupied(const ClassicFrame& frame) const {
    const ClassicTable& table = data().table;
    std::array<std::int32_t, 3> voxel{};
    for (std::size_t a = 0; a < 3; ++a) {
      const double v = std::floor(frame.origin[a]);
      if (!(v >= table.offset[a] && v < table.offset[a] + table.size[a])) return false;
      voxel[a] = static_cast<std::int32_t>(v);
    }
    return ClassicTable::is_occupied(table.word(voxel[0], voxel[1], voxel[2]));
  }

  void trace(const ClassicFrame& frame, DistinctVoxels& distinct, ClassicSums& sums) const {
    const VoxelScene& scene = map_->scene();
    const double V = scene.snapshot().voxel_size;
    const ClassicView view{data().table,
                           core_->values,
                           frame.origin,
                           core_->min_range / V,
                           2 * data().occlusion_depth,
                           core_->config.semantics == GainSemantics::shipped,
                           core_->is_distinct};
    const AddTile add_tile = classic_walk(SceneAccess::data(scene).tracing->kernels.isa);
    ClassicTile tile;
    for (std::size_t number = 0; number < core_->rays.tiles().tile_count; ++number) {
      core_->rays.place(scene, data().table, frame, number, core_->max_range / V, tile);
      if (has_plane_) cut_at_plane(frame, tile);
      add_tile(view, tile, sums, distinct);
    }
  }

  // Rays that go down from above the plane end there.
  void cut_at_plane(const ClassicFrame& frame, ClassicTile& tile) const {
    const double above = normal_[0] * frame.origin[0] + normal_[1] * frame.origin[1] +
                         normal_[2] * frame.origin[2] - height_;
    if (above < 0) return;
    for (int lane = 0; lane < kTileRays; ++lane) {
      const double down =
          normal_[0] * tile.dx[lane] + normal_[1] * tile.dy[lane] + normal_[2] * tile.dz[lane];
      if (down < 0) tile.far[lane] = std::min(tile.far[lane], -above / down);
    }
  }

  [[nodiscard]] double value(ClassicGain gain, const ClassicSums& sums,
                             const DistinctVoxels& distinct) const {
    const double V = map_->scene().snapshot().voxel_size;
    const auto share = [&](std::uint64_t rays) {
      return core_->rays.count() == 0
                 ? 0.0
                 : static_cast<double>(rays) / static_cast<double>(core_->rays.count());
    };
    switch (gain) {
      case ClassicGain::occlusion_aware:
        return sums.occlusion_aware;
      case ClassicGain::unobserved_voxel:
        return sums.unobserved;
      case ClassicGain::average_entropy:
        return sums.voxels > 0 ? sums.entropy / sums.voxels : 0.0;
      case ClassicGain::rear_side_voxel:
        return static_cast<double>(sums.rear_side);
      case ClassicGain::rear_side_entropy:
        return sums.rear_side_entropy;
      case ClassicGain::proximity_count:
        return sums.proximity;
      case ClassicGain::area_factor:
        return area_weight(share(sums.on_surface), 0.2) + area_weight(share(sums.on_hidden), 0.8);
      case ClassicGain::unknown_volume:
        return sums.volume * V * V * V;
      case ClassicGain::unknown_count:
        return static_cast<double>(distinct.count());
      case ClassicGain::surface_frontier_count:
        return static_cast<double>(distinct.frontiers());
    }
    return kNaN;
  }

  std::shared_ptr<const ClassicMap> map_;
  std::shared_ptr<ClassicCore> core_;
  bool has_plane_ = false;
  Eigen::Vector3d normal_ = Eigen::Vector3d::Zero();  // of the support plane, grid frame
  double height_ = 0;                                 // of it along the normal [voxels]
};

}  // namespace detail

struct ClassicGainEvaluator::Impl {
  detail::ClassicDriver driver;
};

ClassicGainEvaluator::ClassicGainEvaluator(std::shared_ptr<const ClassicMap> map,
                                           const Sensor& sensor, const ClassicConfig& config,
                                           const ExecConfig& exec)
    : impl_(std::make_unique<Impl>(
          Impl{{std::move(map), std::make_shared<detail::ClassicCore>(sensor, config, exec)}})) {}
ClassicGainEvaluator::ClassicGainEvaluator(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
ClassicGainEvaluator::~ClassicGainEvaluator() = default;
ClassicGainEvaluator::ClassicGainEvaluator(ClassicGainEvaluator&&) noexcept = default;
ClassicGainEvaluator& ClassicGainEvaluator::operator=(ClassicGainEvaluator&&) noexcept = default;

ClassicGainEvaluator ClassicGainEvaluator::with_map(std::shared_ptr<const ClassicMap> map) const {
  return ClassicGainEvaluator(std::make_unique<Impl>(Impl{{std::move(map), impl_->driver.core()}}));
}

std::size_t ClassicGainEvaluator::evaluate(std::span<const Pose> T_world_camera,
                                           std::span<double> results,
                                           std::span<ViewStatus> statuses,
                                           const BatchControl& control) const {
  const std::size_t gains = config().gains.size();
  if (results.size() != T_world_camera.size() * gains) {
    throw Error(ErrorCode::invalid_argument, std::to_string(T_world_camera.size()) + " poses of " +
                                                 std::to_string(gains) + " gains but room for " +
                                                 std::to_string(results.size()) + " results");
  }
  if (!statuses.empty()) detail::check_room(T_world_camera.size(), statuses.size());
  std::fill(results.begin(), results.end(), detail::kNaN);
  std::fill(statuses.begin(), statuses.end(), ViewStatus::bad_pose);
  return detail::for_each_pose(impl_->driver, T_world_camera.size(), control,
                               [&](std::size_t i, detail::ClassicDriver::Lease& lease) {
                                 const ViewStatus status =
                                     impl_->driver.evaluate(T_world_camera[i], lease.distinct(),
                                                            results.subspan(i * gains, gains));
                                 if (!statuses.empty()) statuses[i] = status;
                               });
}

std::vector<double> ClassicGainEvaluator::evaluate(std::span<const Pose> T_world_camera) const {
  std::vector<double> results(T_world_camera.size() * config().gains.size());
  evaluate(T_world_camera, results);
  return results;
}

const ClassicConfig& ClassicGainEvaluator::config() const noexcept {
  return impl_->driver.core()->config;
}
const ClassicMap& ClassicGainEvaluator::map() const noexcept { return *impl_->driver.map(); }
std::size_t ClassicGainEvaluator::rays_per_pose() const noexcept {
  return impl_->driver.core()->rays.tiles().ray_count();
}
int ClassicGainEvaluator::num_threads() const noexcept {
  return impl_->driver.core()->pool.num_threads();
}

}  // namespace viewgain
