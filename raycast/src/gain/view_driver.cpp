// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include "view_driver.hpp"

#include <array>
#include <cmath>

namespace viewgain::detail {

ViewDriver::ViewDriver(const VoxelScene& scene, std::shared_ptr<EvaluatorCore> core)
    : scene_(SceneAccess::data(scene)),
      core_(std::move(core)),
      prior_sigma_(core_->prior_sigma_in(scene)),
      settings_{core_->config.criterion, 1.0 / (prior_sigma_ * prior_sigma_), core_->sigmas,
                core_->config.weights, core_->config.posterior_entropy},
      tracer_(scene_, core_->rays, core_->min_range, core_->max_range, core_->tracer),
      number_(++core_->drivers) {
  (void)surface();  // an evaluator that exists does not wait for it, nor throw
}

const SurfaceView& ViewDriver::ordered() const {
  std::call_once(surface_once_, [&] { surface_.emplace(scene_, *core_, tracer_, prior_sigma_); });
  return *surface_;
}

void ViewDriver::bind(Workspace& workspace) const {
  workspace.bound_to = 0;  // in case memory runs out
  if (workspace.accumulator) {
    workspace.accumulator->rebind(scene_, settings_);
  } else {
    workspace.accumulator.emplace(scene_, settings_, tracer_.table().ray_count());
  }
  workspace.bound_to = number_;
}

bool ViewDriver::is_in_occupied(const PoseFrame& frame) const {
  const GridSnapshot& snapshot = scene_.snapshot;
  const std::array<std::int32_t, 3> size{snapshot.dims.x, snapshot.dims.y, snapshot.dims.z};
  std::array<std::int32_t, 3> voxel{};
  for (std::size_t i = 0; i < 3; ++i) {
    const float c = std::floor(frame.origin[i]);
    if (!(c >= 0 && c < static_cast<float>(size[i]))) return false;
    voxel[i] = static_cast<std::int32_t>(c);
  }
  const Index3& base = snapshot.min_index;
  const Index3 at{base.x + voxel[0], base.y + voxel[1], base.z + voxel[2]};
  const GridSnapshot::Leaf* leaf = snapshot.find_leaf(at);
  return leaf != nullptr && test_bit(leaf->occupied, block_offset(at));
}

std::optional<PoseFrame> ViewDriver::open(const Pose& T_world_camera, ViewGain& result,
                                          From from) const {
  const auto frame = tracer_.frame_of(T_world_camera);
  if (!frame) return std::nullopt;
  result.rays = core_->ray_count;
  if (from == From::outside_occupied && is_in_occupied(*frame)) {
    const GainModel model = core_->config.model;
    result.gain = 0;
    if (model == GainModel::paper) {
      result.exploration = result.refinement = 0;
      if (core_->config.posterior_entropy) result.posterior_entropy = 0;
    } else {
      result.area = 0;
      if (model == GainModel::combined) result.refinement_saturated = 0;
    }
    result.status = ViewGain::Status::camera_in_occupied;
    return std::nullopt;
  }
  return frame;
}

ViewGain ViewDriver::evaluate(const Pose& T_world_camera, Lease& lease, const float* missed) const {
  const SurfaceView* surface = this->surface();
  if (surface == nullptr) return view(T_world_camera, lease, GainConsumer{lease.accumulator()});
  ViewGain result;
  if (const auto frame = open(T_world_camera, result)) {
    surface->evaluate(*frame, lease.workspace(), result, missed);
    result.status = ViewGain::Status::ok;
  }
  return result;
}

}  // namespace viewgain::detail
