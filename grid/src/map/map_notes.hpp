// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <set>
#include <string>

#include "viewgain/grid/belief_grid.hpp"
#include "viewgain/grid/map_notes.hpp"

namespace viewgain::detail {

/// Throws Error(invalid_argument) for an invalid identity, and for another note with the name of
/// the sensor's or the frames' note.
void check_notes(const MapNotes& notes);

/// Conversion to and from a map file's notes, by name. Throws like check_notes().
[[nodiscard]] std::map<std::string, std::string> texts_of(const MapNotes& notes);
[[nodiscard]] MapNotes notes_of(std::map<std::string, std::string> texts);

/// For callers that ensure the rules of set_notes() themselves.
[[nodiscard]] MapNotes& notes_to_change(BeliefGrid& grid) noexcept;

/// A frame's addition to a map's notes, prepared before integration so that nothing can fail
/// afterwards.
class FrameNote {
 public:
  /// `sensor` as in MapNotes. Throws like check_identity().
  FrameNote(const BeliefGrid& grid, const std::string& sensor, const std::string& identity);
  void put(BeliefGrid& grid) noexcept;

 private:
  std::string sensor_;  // of the map after the frame
  std::set<std::string> frame_;
};

}  // namespace viewgain::detail
