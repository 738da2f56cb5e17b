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

/// What a run has decided, kept in its folder from view to view, so that one that was ended goes on
/// without deciding again: to map and surface the same poses lead again.
class Checkpoint {
 public:
  /// `head`: all that the run's bytes depend on. With `resume` goes on with the folder's last
  /// checkpoint, if there is one. Throws Error, naming its file: format for what is none or of a
  /// newer program, invalid_argument for that of another run, io.
  Checkpoint(RunFolder& folder, const Json& head, bool resume);

  /// After view `index`, where it is known.
  [[nodiscard]] std::optional<DecisionMaking::Decision> decision(std::size_t index) const;

  /// To be called once a view, in order, with the hash of the map after it. Writes what was decided
  /// where that is new. Throws Error(io), and Error(invalid_argument) where the run that was ended
  /// had another map then.
  void add_view(const ViewRecord& record, const std::string& map_hash);

 private:
  RunFolder& folder_;
  std::string file_;  // that it goes on with
  Json json_;
};

/// Known decisions, then another's.
class ResumedDecision : public DecisionMaking {
 public:
  /// Keeps all by reference. `remembers`: the other must be asked each time, as its next decision
  /// depends on it.
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
