// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include "viewgain/raycast/gain_evaluator.hpp"

#include <algorithm>
#include <array>
#include <utility>

#include "batch_loop.hpp"
#include "gain_evaluator_impl.hpp"
#include "viewgain/core/error.hpp"
#include "viewgain/support/nearest_name.hpp"

namespace viewgain {
namespace {

using detail::ViewDriver;

std::shared_ptr<const VoxelScene> checked(std::shared_ptr<const VoxelScene> scene) {
  if (!scene) throw Error(ErrorCode::invalid_argument, "the gain evaluator has no scene");
  return scene;
}

// Where each ray of a view ends.
struct RayHitConsumer {
  const detail::SceneData& scene;
  const detail::TileTable& table;
  std::vector<RayHit> hits{};

  void begin() { hits.resize(table.ray_count()); }
  void add(std::size_t number, const detail::RayTile& tile) {
    detail::for_each_lane(tile.hit | tile.blocked, [&](int lane) {
      RayHit& hit = hits[table.ray_index(number, lane)];
      hit.range = static_cast<double>(tile.range[lane]) * scene.snapshot.voxel_size;
      hit.kind = detail::kind_of_end(scene, tile, lane);
      if (hit.kind == RayHit::Kind::obstacle) return;
      hit.voxel = scene.voxel_index(tile.primitive[lane], tile.offset[lane]);
    });
  }
  void finish(ViewGain&) {}
};

}  // namespace

std::string_view view_status_name(ViewGain::Status status) {
  constexpr std::array<std::string_view, 3> kNames{"ok", "bad_pose", "camera_in_occupied"};
  return kNames[std::min<std::size_t>(static_cast<std::size_t>(status), kNames.size() - 1)];
}

const std::vector<std::string>& gain_model_names() {
  static const std::vector<std::string> names{"paper", "surface", "combined"};
  return names;
}

std::string_view gain_model_name(GainModel model) {
  return gain_model_names().at(static_cast<std::size_t>(model));
}

GainModel parse_gain_model(std::string_view name) {
  return static_cast<GainModel>(place_of_name(name, gain_model_names(), "gain"));
}

GainEvaluator::GainEvaluator(std::shared_ptr<const VoxelScene> scene, const Sensor& sensor,
                             const GainConfig& config, const ExecConfig& exec)
    : impl_(std::make_unique<Impl>(checked(std::move(scene)),
                                   std::make_shared<detail::EvaluatorCore>(sensor, config, exec))) {
}

GainEvaluator::GainEvaluator(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
GainEvaluator::~GainEvaluator() = default;
GainEvaluator::GainEvaluator(GainEvaluator&&) noexcept = default;
GainEvaluator& GainEvaluator::operator=(GainEvaluator&&) noexcept = default;

GainEvaluator GainEvaluator::with_scene(std::shared_ptr<const VoxelScene> scene) const {
  return GainEvaluator(std::make_unique<Impl>(checked(std::move(scene)), impl_->driver.core()));
}

ViewGain GainEvaluator::evaluate(const Pose& T_world_camera) const {
  if (num_threads() > 1 && impl_->driver.surface() == nullptr)
    return detail::evaluate_together(impl_->driver, T_world_camera);
  ViewDriver::Lease lease(impl_->driver);
  return impl_->driver.evaluate(T_world_camera, lease);
}

std::size_t GainEvaluator::evaluate(std::span<const Pose> T_world_camera,
                                    std::span<ViewGain> results,
                                    const BatchControl& control) const {
  detail::check_room(T_world_camera.size(), results.size());
  std::fill(results.begin(), results.end(), ViewGain{});
  return detail::for_each_pose(impl_->driver, results.size(), control,
                               [&](std::size_t i, ViewDriver::Lease& lease) {
                                 results[i] = impl_->driver.evaluate(T_world_camera[i], lease);
                               });
}

std::vector<ViewGain> GainEvaluator::evaluate(std::span<const Pose> T_world_camera) const {
  std::vector<ViewGain> results(T_world_camera.size());
  evaluate(T_world_camera, results);
  return results;
}

std::vector<RayHit> GainEvaluator::trace(const Pose& T_world_camera) const {
  const ViewDriver& driver = impl_->driver;
  ViewDriver::Lease lease(driver);
  RayHitConsumer consumer{driver.scene(), driver.tracer().table()};
  driver.view<detail::ViewTracer::Asked::everywhere>(T_world_camera, lease, consumer,
                                                     ViewDriver::From::anywhere);
  return std::move(consumer.hits);
}

std::size_t GainEvaluator::rays_per_pose() const noexcept {
  return impl_->driver.tracer().table().ray_count();
}
const PinholeCamera& GainEvaluator::camera() const noexcept {
  return impl_->driver.core()->rays->camera;
}
GainModel GainEvaluator::model() const noexcept { return impl_->driver.core()->config.model; }
int GainEvaluator::pixel_stride() const noexcept {
  return impl_->driver.core()->rays->pixel_stride;
}
int GainEvaluator::num_threads() const noexcept { return impl_->driver.core()->pool.num_threads(); }
double GainEvaluator::prior_sigma() const noexcept { return impl_->driver.prior_sigma(); }
const VoxelScene& GainEvaluator::scene() const noexcept { return *impl_->scene; }

}  // namespace viewgain
