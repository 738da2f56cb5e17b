// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "viewgain/planner_mesh/boundary_order.hpp"

#include <cmath>
#include <tuple>

namespace viewgain {
namespace {

// How far each patch is from the middle of its run, in patches.
std::vector<double> distances_from_the_middle(const EstimatedViews& estimated) {
  const std::vector<std::uint32_t>& run_of_patch = estimated.run_of_patch;
  std::vector<double> distances(run_of_patch.size());
  for (std::size_t first = 0; first < run_of_patch.size();) {
    std::size_t end = first;
    while (end < run_of_patch.size() && run_of_patch[end] == run_of_patch[first]) ++end;
    const double middle = 0.5 * static_cast<double>(first + end - 1);
    for (; first < end; ++first) distances[first] = std::abs(static_cast<double>(first) - middle);
  }
  return distances;
}

}  // namespace

std::vector<bool> BoundaryOrder::tried_runs(const EstimatedViews& estimated) const {
  std::vector<bool> tried(estimated.runs.size());
  for (std::size_t patch = 0; patch < estimated.patches.size(); ++patch) {
    const std::uint32_t run = estimated.run_of_patch[patch];
    for (const Try& before : tried_) {
      if (before.boundary_class == estimated.runs[run].boundary_class &&
          (before.place - estimated.patches[patch].origin).norm() <= same_place_) {
        tried[run] = true;
      }
    }
  }
  return tried;
}

std::optional<std::size_t> BoundaryOrder::next(std::span<const Candidate> candidates,
                                               const EstimatedViews& estimated) {
  const std::vector<bool> tried = tried_runs(estimated);
  const std::vector<double> off_middle = distances_from_the_middle(estimated);
  const auto proposed = [&](std::size_t i) -> const BoundaryCandidate& {
    return estimated.candidates[candidates[i].number.value()];
  };
  const auto rank = [&](const BoundaryCandidate& c) {
    return std::tuple(c.boundary_class, -estimated.runs[c.run].length, c.run, off_middle[c.patch],
                      c.patch);
  };
  std::optional<std::size_t> first;
  for (std::size_t i = 0; i < candidates.size(); ++i) {
    if (!candidates[i].boundary_class) continue;  // a pose of the reachable list
    if (!proposed(i).nominal || tried[proposed(i).run]) continue;
    if (!first || rank(proposed(i)) < rank(proposed(*first))) first = i;
  }
  if (first) {
    const BoundaryCandidate& c = proposed(*first);
    tried_.push_back({c.boundary_class, estimated.patches[c.patch].origin});
  }
  return first;
}

}  // namespace viewgain
