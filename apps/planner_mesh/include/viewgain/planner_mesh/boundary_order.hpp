// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "viewgain/core/export.hpp"
#include "viewgain/core/planning.hpp"
#include "viewgain/mesh/viewpoint_estimator.hpp"

namespace viewgain {

/// The choice of Kriegel et al. (the paper's section 5): through the left boundaries first, then
/// the right, top and bottom ones, and within a class the longest run first, which is ours.
///
/// A run offers one pose: the nominal one of the patch that is nearest to its middle, of those that
/// are feasible. It is tried once: a later run of the same class counts as the same if the origin
/// of one of its patches lies within `same_place` of that of the patch that was tried. Thread
/// safety: one call at a time. Cost: O(candidates + patches · runs tried).
class VIEWGAIN_EXPORT BoundaryOrder {
 public:
  /// `same_place` [m]: half the length of a patch finds a run that was cut anew; it is not checked.
  explicit BoundaryOrder(double same_place) : same_place_(same_place) {}

  /// The index of the candidate to take, in their order, which is tried thereby; nothing if none of
  /// the runs that have not been tried has a feasible nominal pose. Boundary candidates are those
  /// with a class; their numbers must index estimated.candidates.
  [[nodiscard]] std::optional<std::size_t> next(std::span<const Candidate> candidates,
                                                const EstimatedViews& estimated);

 private:
  struct Try {
    BoundaryClass boundary_class;  ///< of the boundary
    Eigen::Vector3d place;         ///< origin of the patch, world [m]
  };
  [[nodiscard]] std::vector<bool> tried_runs(const EstimatedViews& estimated) const;

  double same_place_;
  std::vector<Try> tried_;
};

}  // namespace viewgain
