// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <memory>
#include <string>
#include <vector>

#include "viewgain/core/exec_config.hpp"
#include "viewgain/core/planning.hpp"
#include "viewgain/core/sensor.hpp"
#include "viewgain/planner_mesh/candidate_generation.hpp"
#include "viewgain/planner_mesh/surface_model.hpp"
#include "viewgain/planner_mesh/truth.hpp"
#include "viewgain/raycast/gain_evaluator.hpp"
#include "viewgain/raycast/surface_scene.hpp"
#include "viewgain/support/json.hpp"

namespace viewgain::app {

/// Collects what report.html shows of a run, a view at a time. Holds it packed, about 200 kB a view
/// of the camel. Thread safety: one call at a time.
class RunPage {
 public:
  /// `title` is what the page calls the run; `criterion` that of the map's entropy; `truth` null:
  /// it is not known.
  RunPage(std::string title, const Sensor& sensor, std::string criterion,
          std::shared_ptr<const Truth> truth);

  /// To be called once a view, in order. `estimated`: the boundaries of the surface then, none
  /// where no candidates were asked for. `evaluator` is of the model's scene and scores the
  /// candidates; `contributions` are those of the chosen view, if there is one.
  void add_view(const ViewRecord& record, const SurfaceModel& model,
                const CandidateGeneration& generation, const EstimatedViews& estimated,
                const GainEvaluator& evaluator, std::vector<VoxelContribution> contributions);

  /// The page's data. `run` is what run.json holds; there must have been a view. Each view has the
  /// figures of run.json's view of its index. `object` may be null, too, and so may `beside`,
  /// another run that is shown over this one: name, and settings and per_view as run.json has them.
  [[nodiscard]] Json json(const Json& run, const SurfaceScene* object, const Json& beside) const;

 private:
  std::string title_, criterion_;
  Sensor sensor_;
  std::shared_ptr<const Truth> truth_;
  Json head_, views_ = Json::array();
  std::vector<std::size_t> indices_;  ///< of the views
};

}  // namespace viewgain::app
