// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "viewgain/core/exec_config.hpp"
#include "viewgain/core/export.hpp"
#include "viewgain/core/planning.hpp"
#include "viewgain/planner/align_frames.hpp"
#include "viewgain/planner/map_model.hpp"
#include "viewgain/planner/register_frame.hpp"
#include "viewgain/planner_mesh/surface_model.hpp"

namespace viewgain {

/// UPDATEREPRESENTATIONS for poses that are a little wrong: each view's first frame is aligned with
/// those of all views so far, which moves these, too, and the model is made anew from the poses
/// that come of it. A view that is refused stays out of the model, for as long as it is. The first
/// view's pose holds.
///
/// Keeps all frames. Thread safety: one call at a time. Cost of a view: what the alignment takes,
/// and an update for every view so far.
class VIEWGAIN_EXPORT RegisteredModel : public RepresentationUpdate {
 public:
  /// `model` must be empty, made by `map`, and is kept by reference. `sigma`: by how
  /// much each reported pose may be off. Throws Error(invalid_argument) as FrameAlignment.
  RegisteredModel(SurfaceModel& model, const MapModelConfig& map, const PoseSigma& sigma,
                  const ExecConfig& exec = {});

  /// Stages as SurfaceModel::update() and register. Throws as FrameAlignment::add() and
  /// SurfaceModel::rebuild().
  ModelProgress update(const Measurements& measurements) override;

  /// One a view, what became of it, as known now.
  [[nodiscard]] const std::vector<FrameRegistration>& registrations() const {
    return alignment_.registrations();
  }

 private:
  SurfaceModel& model_;
  PoseSigma sigma_;
  FrameAlignment alignment_;
  std::vector<Measurements> views_;  ///< as reported
};

}  // namespace viewgain
