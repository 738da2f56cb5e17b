// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include "viewgain/raycast/gain_evaluator.hpp"

#include <algorithm>
#include <array>
#include <utility>

#include "gain_evaluator_impl.hpp"
#include "trace/ray_tile.hpp"
#include "viewgain/core/error.hpp"
#include "viewgain/support/text.hpp"
#include "viewgain/support/view_rays.hpp"

namespace viewgain {
namespace {

using detail::ViewDriver;

std::shared_ptr<const VoxelScene> checked(std::shared_ptr<const VoxelScene> scene) {
  if (!scene) refuse("the scene is null");
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

std::string_view gain_unit(GainModel model, Criterion criterion) noexcept {
  const bool is_area =
      model == GainModel::surface || (model == GainModel::paper && criterion == Criterion::trace);
  return is_area ? "m^2" : "nat";
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
  if (num_threads() > 1 && impl_->driver.may_share_views()) {
    return detail::evaluate_together(impl_->driver, T_world_camera);
  }
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

DepthFrame depth_image(const GainEvaluator& evaluator, const Pose& T_world_camera,
                       std::vector<RayHit::Kind>* labels) {
  const PinholeCamera& camera = evaluator.camera();
  const int stride = evaluator.pixel_stride();
  const std::vector<RayHit> hits = evaluator.trace(T_world_camera);
  if (hits.empty()) {
    refuse("the pose of a depth image deviates from a rigid transform by " +
           short_text(orthonormality_error(T_world_camera)) + "; the tolerance is 1e-3");
  }
  DepthFrame image;
  image.width = detail::strided(camera.width, stride);
  image.height = detail::strided(camera.height, stride);
  image.depth.assign(hits.size(), DepthFrame::kOutOfRange);
  if (labels != nullptr) labels->resize(hits.size());
  for (std::size_t i = 0; i < hits.size(); ++i) {
    if (labels != nullptr) (*labels)[i] = hits[i].kind;
    if (hits[i].kind == RayHit::Kind::none) continue;
    const auto columns = static_cast<std::size_t>(image.width);
    const Eigen::Vector3d ray = camera.ray(static_cast<double>(i % columns) * stride,
                                           static_cast<double>(i / columns) * stride);
    image.depth[i] = static_cast<float>(hits[i].range / ray.norm());
  }
  return image;
}

using namespace detail;

ViewScratch::~ViewScratch() = default;
RayConsumer::~RayConsumer() = default;

std::size_t for_each_view_rays(const GainEvaluator& evaluator, std::span<const Pose> T_world_camera,
                               bool from_occupied, const RayConsumer& consumer,
                               const BatchControl& control) {
  const ViewDriver& driver = EvaluatorAccess::driver(evaluator);
  const ViewDriver::From from =
      from_occupied ? ViewDriver::From::anywhere : ViewDriver::From::outside_occupied;
  return for_each_pose(
      driver, T_world_camera.size(), control, [&](std::size_t i, ViewDriver::Lease& lease) {
        std::unique_ptr<ViewScratch>& scratch = lease.workspace().scratch;
        if (!scratch) scratch = consumer.make_scratch();
        consumer.begin(*scratch);
        ViewGain view;
        if (const auto frame = driver.open(T_world_camera[i], view, from)) {
          const WalkLimits limits = walk_limits(driver.scene(), *frame);
          WalkTask task;
          driver.tracer().place(*frame, lease.workspace().sweep,
                                [&](std::size_t number, const RayTile& rays) {
                                  set_up(driver.tracer().table(), number, *frame, rays, task);
                                  std::fill_n(task.near, kTileRays, 0.0F);
                                  task.lanes = rays.valid;
                                  consumer.add(limits, task, *scratch);
                                });
          view.status = ViewGain::Status::ok;
        }
        consumer.finish(i, view, *scratch);
      });
}

}  // namespace viewgain
