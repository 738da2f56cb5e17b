// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <optional>
#include <vector>

#include "viewgain/core/exec_config.hpp"
#include "viewgain/core/export.hpp"
#include "viewgain/core/jump_edge_filter.hpp"
#include "viewgain/core/planning.hpp"
#include "viewgain/planner/align_frames.hpp"
#include "viewgain/planner/map_model.hpp"
#include "viewgain/planner/register_frame.hpp"
#include "viewgain/planner_mesh/surface_model.hpp"
#include "viewgain/raycast/obstacle_view.hpp"

namespace viewgain {

/// UPDATEREPRESENTATIONS for poses that are a little wrong: each view's first frame is aligned with
/// those of all views so far, which moves these, too, and the model is made anew from the poses
/// that come of it. A view that is refused stays out of the model. The first view's pose holds.
///
/// Keeps all frames. A view costs what the alignment takes and an update for every view so far.
class VIEWGAIN_EXPORT RegisteredModel : public RepresentationUpdate {
 public:
  /// `model` must be empty, made by `map`, and is kept by reference. The sigmas are those of each
  /// reported pose, as of PosePrior.
  /// Throws Error(invalid_argument) as FrameAlignment.
  RegisteredModel(SurfaceModel& model, const MapModelConfig& map, double sigma_translation,
                  double sigma_rotation, const ExecConfig& exec = {});

  /// Stages as SurfaceModel::update() and register.
  ModelProgress update(const Measurements& measurements) override;

  /// What was done to each view: of those in the model as it is now, of a refused one when it came.
  [[nodiscard]] std::vector<FrameRegistration> registrations() const;

 private:
  SurfaceModel& model_;
  std::optional<JumpEdgeFilter> filter_;
  ObstacleView obstacles_;
  double sigma_translation_, sigma_rotation_;
  FrameAlignment alignment_;
  std::vector<Measurements> kept_;           ///< at their corrected poses
  std::vector<FrameRegistration> when_new_;  ///< of each view
};

}  // namespace viewgain
