// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include "viewgain/support/stop_rules.hpp"

#include <cmath>
#include <string>

#include "viewgain/core/error.hpp"
#include "viewgain/support/text.hpp"

namespace viewgain {
namespace {

void check(const PlanningConfig& config) {
  const auto fail = [](const std::string& what) { refuse("planning: " + what); };
  const auto check_finite = [&fail](const char* name, double value) {
    if (!std::isfinite(value)) {
      fail(std::string(name) + " must be finite, not " + short_text(value));
    }
  };
  if (config.max_views == 0) fail("max_views must be at least 1, not 0");
  check_finite("stop_gain", config.stop_gain);
  check_finite("stop_area", config.stop_area);
  check_finite("idle_fraction", config.idle_fraction);
  if (config.stop_coverage) check_finite("stop_coverage", *config.stop_coverage);
}

// No change counts as nothing even if the total is 0. NaN counts as nothing too, because a run
// whose gain is unknown must end.
bool is_nothing(double change, double total, double fraction) {
  return !(change > 0) || change < fraction * total;
}

}  // namespace

StopReason nowhere_to_go(const Proposal& proposal) {
  const auto found = proposal.dropped.find(std::string(kUnreachable));
  const bool out_of_reach = found != proposal.dropped.end() && found->second > 0;
  return out_of_reach ? StopReason::unreachable : StopReason::no_candidates;
}

StopRules::StopRules(const PlanningConfig& config, const StopMemory& memory)
    : config_(config), memory_(memory) {
  check(config);
}

// The state before the first view is unknown here, so the first view is never idle.
bool StopRules::brought_nothing(const ModelProgress& now) const {
  if (memory_.views == 0) return false;
  const auto unknown = static_cast<double>(memory_.unknown_voxels);
  return is_nothing(now.entropy_removed - memory_.entropy_removed, memory_.entropy_removed,
                    config_.idle_fraction) &&
         is_nothing(unknown - static_cast<double>(now.unknown_voxels), unknown,
                    config_.idle_fraction);
}

// Ignores a view without a prediction or without a measured result.
void StopRules::hold_against_promise(const ModelProgress& now) {
  double promised = memory_.promised_area, came = now.new_area;
  if (std::isnan(promised) || std::isnan(came)) {
    promised = memory_.promised_gain;
    came = now.entropy_removed - memory_.entropy_removed;
  }
  memory_.promised_area = memory_.promised_gain = std::numeric_limits<double>::quiet_NaN();
  if (std::isnan(promised)) return;
  memory_.broken_promises = came < kKeptShare * promised ? memory_.broken_promises + 1 : 0;
}

std::optional<StopReason> StopRules::after_view(const ModelProgress& progress) {
  memory_.idle_views = brought_nothing(progress) ? memory_.idle_views + 1 : 0;
  hold_against_promise(progress);
  memory_.entropy_removed = progress.entropy_removed;
  memory_.unknown_voxels = progress.unknown_voxels;
  ++memory_.views;
  const std::optional<double>& coverage = progress.coverage;
  if (config_.stop_coverage && coverage && *coverage >= *config_.stop_coverage) {
    return StopReason::coverage;
  }
  if (memory_.views >= config_.max_views) return StopReason::max_views;
  if (config_.idle_views > 0 && memory_.idle_views >= config_.idle_views) return StopReason::idle;
  if (config_.broken_promises > 0 && memory_.broken_promises >= config_.broken_promises) {
    return StopReason::promises;
  }
  return std::nullopt;
}

// A policy without a gain per voxel (NaN) is never stopped by this rule.
bool StopRules::stops_for_gain(double gain_per_voxel) {
  if (std::isnan(gain_per_voxel)) return false;
  if (!config_.stop_gain_is_relative) return gain_per_voxel < config_.stop_gain;
  if (std::isnan(memory_.first_gain_per_voxel)) {
    // The best view has no gain at the first decision, so a fraction of it cannot be a limit.
    if (!(gain_per_voxel > 0)) return true;
    memory_.first_gain_per_voxel = gain_per_voxel;
  }
  return gain_per_voxel < config_.stop_gain * memory_.first_gain_per_voxel;
}

// The expected new surface of all candidates is too small, on average over some decisions. With
// unknown areas (NaN), or a model without a surface, the mean is not below the limit.
bool StopRules::stops_for_area(double share) {
  memory_.area_shares[memory_.decisions++ % memory_.area_shares.size()] = share;
  if (memory_.decisions < memory_.area_shares.size()) return false;
  double sum = 0;
  for (const double s : memory_.area_shares) sum += s;
  return config_.stop_area > 0 &&
         sum < config_.stop_area * static_cast<double>(memory_.area_shares.size());
}

std::optional<StopReason> StopRules::after_decision(
    const std::optional<DecisionMaking::Decision>& decision, const Proposal& proposal,
    double surface_area) {
  if (!decision) return nowhere_to_go(proposal);
  // A policy without this rule makes no prediction of the area.
  if (!std::isnan(decision->best_area)) memory_.promised_area = decision->area;
  if (!std::isnan(decision->gain_per_voxel)) memory_.promised_gain = decision->gain;
  const bool little_area = stops_for_area(decision->best_area / surface_area);
  if (stops_for_gain(decision->gain_per_voxel)) return StopReason::gain;
  if (little_area) return StopReason::area;
  if (decision->worth <= 0) return StopReason::cost;
  return std::nullopt;
}

}  // namespace viewgain
