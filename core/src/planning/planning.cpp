// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include "viewgain/core/planning.hpp"

#include <utility>

#include "viewgain/core/error.hpp"
#include "viewgain/support/stop_rules.hpp"
#include "viewgain/support/stopwatch.hpp"

namespace viewgain {
namespace {

// Runs a step of the loop, and adds its duration to its stage.
template <typename Step>
auto timed(ViewRecord& record, const char* stage, Step&& step) {
  const Stopwatch watch;
  auto result = step();
  record.seconds[stage] = watch.seconds();
  return result;
}

class Planner {
 public:
  Planner(DataAcquisition& acquisition, RepresentationUpdate& representation,
          ViewpointGeneration& generation, DecisionMaking& decision, const PlanningConfig& config)
      : acquisition_(acquisition),
        representation_(representation),
        generation_(generation),
        decision_(decision),
        config_(config),
        rules_(config) {}

  // Steps 1 and 2: measure, and put the measurements into the model. A stop does not separate them,
  // because measurements always go into the model.
  void take_view(const Pose& T_world_camera, ViewRecord& record, const ViewRecord* before) {
    const Measurements measurements = timed(
        record, "acquire", [&] { return acquisition_.acquire(T_world_camera, record.index); });
    record.T_world_camera = measurements.T_world_camera;
    record.progress = timed(record, "update", [&] { return representation_.update(measurements); });
    if (!record.progress.seconds.empty()) {
      record.seconds.erase("update");
      record.seconds.insert(record.progress.seconds.begin(), record.progress.seconds.end());
    }
    record.realised_gain = record.progress.entropy_removed;
    if (before == nullptr) return;
    record.realised_gain -= before->progress.entropy_removed;
    record.travelled =
        before->travelled +
        (record.T_world_camera.translation() - before->T_world_camera.translation()).norm();
  }

  // Steps 3 and 4: candidates, and the choice among them, unless a rule ends the run.
  std::optional<StopReason> plan_next(ViewRecord& record) {
    const std::optional<StopReason> enough = rules_.after_view(record.progress);
    if (interrupted()) return StopReason::interrupted;
    if (enough) return enough;

    record.proposal =
        timed(record, "candidates", [&] { return generation_.generate(record.T_world_camera); });
    if (interrupted()) return StopReason::interrupted;
    const std::vector<Candidate>& candidates = record.proposal.candidates;
    if (candidates.empty()) return nowhere_to_go(record.proposal);
    const std::optional<DecisionMaking::Decision> decision =
        timed(record, "score", [&] { return decision_.decide(record.T_world_camera, candidates); });
    if (decision && decision->candidate >= candidates.size()) {
      refuse("planning: decide() returned the candidate " + std::to_string(decision->candidate) +
             "; it must be less than the number of candidates, " +
             std::to_string(candidates.size()));
    }
    record.decision = decision;
    if (interrupted()) return StopReason::interrupted;
    return rules_.after_decision(decision, record.proposal, record.progress.surface_area);
  }

 private:
  [[nodiscard]] bool interrupted() const { return config_.stop.stop_requested(); }

  DataAcquisition& acquisition_;
  RepresentationUpdate& representation_;
  ViewpointGeneration& generation_;
  DecisionMaking& decision_;
  const PlanningConfig& config_;
  StopRules rules_;
};

}  // namespace

std::string_view stop_reason_name(StopReason reason) {
  switch (reason) {
    case StopReason::gain:
      return "gain";
    case StopReason::area:
      return "area";
    case StopReason::cost:
      return "cost";
    case StopReason::no_candidates:
      return "no_candidates";
    case StopReason::unreachable:
      return "unreachable";
    case StopReason::idle:
      return "idle";
    case StopReason::promises:
      return "promises";
    case StopReason::max_views:
      return "max_views";
    case StopReason::coverage:
      return "coverage";
    case StopReason::interrupted:
      break;
  }
  return "interrupted";
}

PlanningResult active_view_planning(const Pose& x_0, DataAcquisition& acquisition,
                                    RepresentationUpdate& representation,
                                    ViewpointGeneration& generation, DecisionMaking& decision,
                                    const PlanningConfig& config,
                                    const std::function<void(const ViewRecord&)>& observer) {
  Planner planner(acquisition, representation, generation, decision, config);
  PlanningResult result;
  Pose next = x_0;
  std::optional<Candidate> chosen;
  DecisionMaking::Decision choice{};  // that led to the current view; none for x_0
  for (;;) {
    ViewRecord record;
    record.index = result.views.size();
    record.chosen_as = std::move(chosen);
    record.predicted_gain = choice.gain;
    record.predicted_area = choice.area;
    const ViewRecord* before = result.views.empty() ? nullptr : &result.views.back();
    planner.take_view(next, record, before);
    const std::optional<StopReason> reason = planner.plan_next(record);
    const ViewRecord& done = result.views.emplace_back(std::move(record));
    if (observer) observer(done);
    if (reason) {
      result.reason = *reason;
      return result;
    }
    choice = *done.decision;
    chosen = done.proposal.candidates[choice.candidate];
    next = chosen->T_world_camera;
  }
}

}  // namespace viewgain
