// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "viewgain/planner_mesh/registered_model.hpp"

#include <utility>

#include "viewgain/core/error.hpp"
#include "viewgain/core/stopwatch.hpp"

namespace viewgain {

namespace {

RegistrationConfig config_of(const MapModelConfig& map) {
  RegistrationConfig config;
  config.support_plane = map.integration.support_plane;
  return config;
}

}  // namespace

RegisteredModel::RegisteredModel(SurfaceModel& model, const MapModelConfig& map,
                                 double sigma_translation, double sigma_rotation,
                                 const ExecConfig& exec)
    : model_(model),
      obstacles_(map.obstacles, model.map().sensor(), exec),
      sigma_translation_(sigma_translation),
      sigma_rotation_(sigma_rotation),
      alignment_(model.map().sensor(), model.grid(), config_of(map), exec) {
  if (map.jump_edges) filter_.emplace(model.map().sensor().camera, *map.jump_edges);
}

ModelProgress RegisteredModel::update(const Measurements& measurements) {
  if (measurements.frames.empty()) {
    throw Error(ErrorCode::invalid_argument, "a view without a frame cannot be registered");
  }
  const Stopwatch watch;
  const Pose& T_reported = measurements.T_world_camera;
  DepthFrame frame = measurements.frames.front();
  if (filter_) filter_->apply(frame);
  obstacles_.mark(frame, T_reported);
  when_new_.push_back(alignment_.add(frame, {T_reported, sigma_translation_, sigma_rotation_}));
  if (when_new_.back().status != RegistrationStatus::refused) {
    kept_.push_back(measurements);
    const std::vector<Pose> poses = alignment_.poses();
    for (std::size_t i = 0; i < kept_.size(); ++i) kept_[i].T_world_camera = poses[i];
  }
  const double seconds = watch.seconds();
  ModelProgress progress = kept_.size() == 1 ? model_.update(kept_.front()) : model_.rebuild(kept_);
  progress.seconds["register"] = seconds;
  return progress;
}

std::vector<FrameRegistration> RegisteredModel::registrations() const {
  std::vector<FrameRegistration> all = when_new_;
  const std::vector<FrameRegistration> now = alignment_.registrations();
  auto next = now.begin();
  for (FrameRegistration& registration : all) {
    if (registration.status != RegistrationStatus::refused) registration = *next++;
  }
  return all;
}

}  // namespace viewgain
