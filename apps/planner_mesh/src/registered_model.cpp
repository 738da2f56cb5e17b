// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "viewgain/planner_mesh/registered_model.hpp"

#include "viewgain/core/error.hpp"
#include "viewgain/support/stopwatch.hpp"

namespace viewgain {

RegisteredModel::RegisteredModel(SurfaceModel& model, const MapModelConfig& map,
                                 const PoseSigma& sigma, const ExecConfig& exec)
    : model_(model), sigma_(sigma), alignment_(model.map().sensor(), map, exec) {}

ModelProgress RegisteredModel::update(const Measurements& measurements) {
  if (measurements.frames.empty()) {
    throw Error(ErrorCode::invalid_argument, "a view without a frame cannot be registered");
  }
  const Stopwatch watch;
  alignment_.add(measurements.frames.front(), measurements.T_world_camera, sigma_);
  views_.push_back(measurements);
  std::vector<Measurements> kept;
  for (std::size_t i = 0; i < views_.size(); ++i) {
    const FrameRegistration& registration = registrations()[i];
    if (registration.status == RegistrationStatus::refused) continue;
    kept.push_back(views_[i]);
    kept.back().T_world_camera = registration.T_world_camera;
    kept.back().pose_sigma = registration.pose_sigma();
  }
  const double seconds = watch.seconds();
  ModelProgress progress = views_.size() == 1 ? model_.update(kept.front()) : model_.rebuild(kept);
  // What the last view brought, not the last that was kept.
  if (registrations().back().status == RegistrationStatus::refused) progress.new_area = 0;
  progress.seconds["register"] = seconds;
  return progress;
}

}  // namespace viewgain
