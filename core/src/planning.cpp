// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include "viewgain/core/planning.hpp"

#include <array>
#include <cmath>
#include <string>
#include <utility>

#include "viewgain/core/error.hpp"
#include "viewgain/core/text.hpp"

namespace viewgain {
namespace {

void check(const PlanningConfig& config) {
  const auto fail = [](const std::string& what) {
    throw Error(ErrorCode::invalid_argument, "planning: " + what);
  };
  const auto check_finite = [&fail](const char* name, double value) {
    if (!std::isfinite(value)) {
      fail(std::string(name) + " must be finite, not " + short_text(value));
    }
  };
  if (config.max_views == 0) fail("max_views is 0");
  check_finite("stop_gain", config.stop_gain);
  check_finite("stop_area", config.stop_area);
  check_finite("idle_fraction", config.idle_fraction);
  if (config.stop_coverage) check_finite("stop_coverage", *config.stop_coverage);
}

// Counts the views in a row that brought nothing.
class IdleRule {
 public:
  explicit IdleRule(const PlanningConfig& config)
      : limit_(config.idle_views), fraction_(config.idle_fraction) {}

  // True if that many views in a row were idle. What was known before the first view is not known
  // here, so that one is never idle.
  bool stops_after(const ModelProgress* before, const ModelProgress& now) {
    idle_ = before != nullptr && brought_nothing(*before, now) ? idle_ + 1 : 0;
    return limit_ > 0 && idle_ >= limit_;
  }

 private:
  [[nodiscard]] bool brought_nothing(const ModelProgress& before, const ModelProgress& now) const {
    const auto unknown = static_cast<double>(before.unknown_voxels);
    return is_nothing(now.entropy_removed - before.entropy_removed, before.entropy_removed) &&
           is_nothing(unknown - static_cast<double>(now.unknown_voxels), unknown);
  }

  // No change at all is nothing even where the total is 0. So is NaN: a run that cannot tell what
  // it gains must end.
  [[nodiscard]] bool is_nothing(double change, double total) const {
    return !(change > 0) || change < fraction_ * total;
  }

  std::size_t limit_;
  double fraction_;
  std::size_t idle_ = 0;
};

class GainRule {
 public:
  explicit GainRule(const PlanningConfig& config)
      : limit_(config.stop_gain), relative_(config.stop_gain_is_relative) {}

  // A policy without a gain per voxel (NaN) never stops for it.
  bool stops_at(double gain_per_voxel) {
    if (std::isnan(gain_per_voxel)) return false;
    // The best view brings nothing from the start: a share of that is no limit.
    if (relative_ && !(gain_per_voxel > 0)) return true;
    if (relative_) limit_ *= gain_per_voxel;
    relative_ = false;
    return gain_per_voxel < limit_;
  }

 private:
  double limit_;
  bool relative_;  ///< the limit is a share of the first gain, which has yet to come
};

// No candidate promises enough new surface, on the mean of some decisions.
class AreaRule {
 public:
  explicit AreaRule(const PlanningConfig& config) : limit_(config.stop_area) {}

  // A decision whose areas are not known (NaN) makes a mean that is not under the limit; so does a
  // model without a surface.
  bool stops_at(double best_area, double surface_area) {
    shares_[count_++ % shares_.size()] = best_area / surface_area;
    if (count_ < shares_.size()) return false;
    double sum = 0;
    for (const double share : shares_) sum += share;
    return limit_ > 0 && sum < limit_ * static_cast<double>(shares_.size());
  }

 private:
  double limit_;
  std::array<double, 3> shares_{};  // of the surface, in the last decisions
  std::size_t count_ = 0;
};

StopReason nowhere_to_go(const Proposal& proposal) {
  const auto found = proposal.dropped.find(std::string(kUnreachable));
  const bool out_of_reach = found != proposal.dropped.end() && found->second > 0;
  return out_of_reach ? StopReason::unreachable : StopReason::no_candidates;
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
        idle_(config),
        gain_(config),
        area_(config) {}

  // Steps 1 and 2: measure, and put the measurements into the model. What was measured is never
  // thrown away, so nothing stops in between.
  void take_view(const Pose& T_world_camera, ViewRecord& record, const ViewRecord* before) {
    const Measurements measurements = acquisition_.acquire(T_world_camera, record.index);
    record.T_world_camera = measurements.T_world_camera;
    record.progress = representation_.update(measurements);
    record.realised_gain = record.progress.entropy_removed;
    if (before == nullptr) return;
    record.realised_gain -= before->progress.entropy_removed;
    record.travelled =
        before->travelled +
        (record.T_world_camera.translation() - before->T_world_camera.translation()).norm();
  }

  // Steps 3 and 4: candidates, and the choice among them, unless a rule ends the run.
  std::optional<StopReason> plan_next(ViewRecord& record, const ViewRecord* before) {
    const bool idle =
        idle_.stops_after(before != nullptr ? &before->progress : nullptr, record.progress);
    if (interrupted()) return StopReason::interrupted;
    const std::optional<double>& coverage = record.progress.coverage;
    if (config_.stop_coverage && coverage && *coverage >= *config_.stop_coverage) {
      return StopReason::coverage;
    }
    if (record.index + 1 >= config_.max_views) return StopReason::max_views;
    if (idle) return StopReason::idle;

    record.proposal = generation_.generate(record.T_world_camera);
    if (interrupted()) return StopReason::interrupted;
    const std::vector<Candidate>& candidates = record.proposal.candidates;
    if (candidates.empty()) return nowhere_to_go(record.proposal);
    const std::optional<Decision> decision = decision_.decide(record.T_world_camera, candidates);
    if (decision && decision->candidate >= candidates.size()) {
      throw Error(ErrorCode::invalid_argument, "planning: the decision is candidate " +
                                                   std::to_string(decision->candidate) + " of " +
                                                   std::to_string(candidates.size()));
    }
    record.decision = decision;
    if (interrupted()) return StopReason::interrupted;
    if (!decision) return nowhere_to_go(record.proposal);
    const bool little_area = area_.stops_at(decision->best_area, record.progress.surface_area);
    if (gain_.stops_at(decision->gain_per_voxel)) return StopReason::gain;
    if (little_area) return StopReason::area;
    return std::nullopt;
  }

 private:
  [[nodiscard]] bool interrupted() const { return config_.stop.stop_requested(); }

  DataAcquisition& acquisition_;
  RepresentationUpdate& representation_;
  ViewpointGeneration& generation_;
  DecisionMaking& decision_;
  const PlanningConfig& config_;
  IdleRule idle_;
  GainRule gain_;
  AreaRule area_;
};

}  // namespace

std::string_view stop_reason_name(StopReason reason) {
  switch (reason) {
    case StopReason::gain:
      return "gain";
    case StopReason::area:
      return "area";
    case StopReason::no_candidates:
      return "no_candidates";
    case StopReason::unreachable:
      return "unreachable";
    case StopReason::idle:
      return "idle";
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
  check(config);
  Planner planner(acquisition, representation, generation, decision, config);
  PlanningResult result;
  Pose next = x_0;
  std::optional<Candidate> chosen;
  Decision choice{};  // of the view at hand; x_0 was not chosen
  for (;;) {
    ViewRecord record;
    record.index = result.views.size();
    record.chosen_as = std::move(chosen);
    record.predicted_gain = choice.gain;
    record.predicted_area = choice.area;
    const ViewRecord* before = result.views.empty() ? nullptr : &result.views.back();
    planner.take_view(next, record, before);
    const std::optional<StopReason> reason = planner.plan_next(record, before);
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
