// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "program/commands/reconstruct/run.hpp"

#include <utility>

namespace viewgain::app {
namespace {

PolicyConfig with_object(PolicyConfig policy, const RunSetup& setup,
                         const std::shared_ptr<const Truth>& truth) {
  policy.object = {setup.stage.scene, truth, setup.simulation};
  return policy;
}

}  // namespace

Run::Run(RunSetup setup, std::size_t frames_per_view, const ExecConfig& exec)
    : setup_(std::move(setup)),
      truth_(std::make_shared<const Truth>(setup_.stage.scene, setup_.sensor, setup_.visibility,
                                           exec)),
      acquisition_(SimulatedSensor(setup_.stage.scene, setup_.sensor, setup_.simulation, exec),
                   frames_per_view, setup_.planning.stop),
      reported_(acquisition_, setup_.pose_noise, setup_.simulation.seed),
      model_(setup_.sensor, setup_.model, truth_, exec),
      generation_(model_, setup_.generation, exec),
      decision_(model_, generation_, setup_.sensor, with_object(setup_.policy, setup_, truth_),
                exec) {
  if (!setup_.registration) return;
  registered_.emplace(model_, setup_.model.map, *setup_.registration, exec);
}

PlanningResult Run::go(const std::function<void(const ViewRecord&)>& observer) {
  RepresentationUpdate& representation =
      registered_ ? static_cast<RepresentationUpdate&>(*registered_) : model_;
  return active_view_planning(setup_.start, reported_, representation, generation_, decision_,
                              setup_.planning, observer);
}

}  // namespace viewgain::app
