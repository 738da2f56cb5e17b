// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>

#include "viewgain/core/planning.hpp"
#include "viewgain/formats/staged_folder.hpp"
#include "viewgain/support/json.hpp"

namespace viewgain::app {

/// The decisions of a run, stored in its folder after each view. A resumed run repeats the poses
/// without deciding again, and gets the same map and surface.
class Checkpoint {
 public:
  /// `head`: everything that affects the run's results. With `resume`, continues from the folder's
  /// last checkpoint, if there is one. Throws Error naming the file: format if it is invalid or
  /// from a newer program, invalid_argument if it belongs to another run, or io.
  Checkpoint(RunFolder& folder, const Json& head, bool resume);

  /// The decision after view `index`, if known.
  [[nodiscard]] std::optional<DecisionMaking::Decision> decision(std::size_t index) const;

  /// Call it once per view, in order, with the hash of the map after the view. Writes a new
  /// decision. Throws Error(io), and Error(invalid_argument) if the interrupted run had another map
  /// at that view.
  void add_view(const ViewRecord& record, const std::string& map_hash);

 private:
  RunFolder& folder_;
  std::string file_;  // file of the resumed checkpoint
  Json json_;
};

/// Returns known decisions first, then those of another decision maker.
class ResumedDecision : public DecisionMaking {
 public:
  /// Keeps references. `remembers`: asks the other each time, because its next decision depends on
  /// the earlier ones.
  ResumedDecision(const Checkpoint& known, DecisionMaking& other, bool remembers)
      : known_(known), other_(other), remembers_(remembers) {}
  std::optional<Decision> decide(const Pose& T_world_camera,
                                 std::span<const Candidate> candidates) override;

 private:
  const Checkpoint& known_;
  DecisionMaking& other_;
  bool remembers_;
  std::size_t view_ = 0;
};

}  // namespace viewgain::app
