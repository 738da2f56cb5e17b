// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include "map_notes.hpp"

#include <array>
#include <cstddef>
#include <sstream>
#include <string_view>
#include <utility>

#include "viewgain/core/error.hpp"
#include "viewgain/support/frame_identity.hpp"
#include "viewgain/support/text.hpp"

namespace viewgain::detail {
namespace {

constexpr const char* kSensorNote = "sensor";
constexpr const char* kFramesNote = "frames";  // one identity per line

// Lines of a sensor's description that affect readings, without comments; name, mounting and
// housing do not.
std::string readings_of(const std::string& sensor) {
  constexpr std::array<std::string_view, 4> kOthers{"#", "name =", "T_flange_camera =", "body ="};
  std::string result;
  bool is_kept = true;
  std::istringstream lines(sensor);
  for (std::string line; std::getline(lines, line);) {
    const bool goes_on = line.starts_with(' ') || line.starts_with(']');  // rows of a list
    if (!goes_on) {
      is_kept = true;
      for (const std::string_view other : kOthers) is_kept = is_kept && !line.starts_with(other);
    }
    if (!is_kept) continue;
    constexpr std::string_view kOldName = "pose_sigma =";  // in files of 0.1.0
    if (line.starts_with(kOldName)) line.replace(0, kOldName.size(), "pose_sigma_rad =");
    result += line.substr(0, line.find("  #")) + "\n";
  }
  return result;
}

bool is_same_sensor(const std::string& a, const std::string& b) {
  return a == b || (!a.empty() && !b.empty() && readings_of(a) == readings_of(b));
}

}  // namespace

void check_notes(const MapNotes& notes) {
  for (const std::string& frame : notes.frames) {
    if (!is_identity(frame))
      refuse("the identity of a frame must be 16 hexadecimal digits, a space and a name, not " +
             viewgain::quoted(frame));
  }
  for (const char* name : {kSensorNote, kFramesNote}) {
    if (!notes.others.contains(name)) continue;
    refuse("the note name " + viewgain::quoted(name) +
           " is reserved; set the member of MapNotes instead");
  }
}

std::map<std::string, std::string> texts_of(const MapNotes& notes) {
  check_notes(notes);
  std::map<std::string, std::string> texts = notes.others;
  if (!notes.sensor.empty()) texts[kSensorNote] = notes.sensor;
  if (notes.frames.empty()) return texts;
  std::string& list = texts[kFramesNote];
  for (const std::string& frame : notes.frames) list += frame + "\n";
  return texts;
}

MapNotes notes_of(std::map<std::string, std::string> texts) {
  MapNotes notes;
  if (auto sensor = texts.extract(kSensorNote)) notes.sensor = std::move(sensor.mapped());
  if (const auto frames = texts.extract(kFramesNote)) {
    std::istringstream lines(frames.mapped());
    for (std::string line; std::getline(lines, line);) notes.frames.insert(line);
  }
  notes.others = std::move(texts);
  check_notes(notes);
  return notes;
}

FrameNote::FrameNote(const BeliefGrid& grid, const std::string& sensor,
                     const std::string& identity) {
  check_identity(identity);
  if (!identity.empty()) frame_.insert(identity);
  const std::string& noted = grid.notes().sensor;
  if (is_same_sensor(noted, sensor)) {
    sensor_ = noted;
  } else if (grid.views().empty()) {
    sensor_ = sensor;
  }
}

void FrameNote::put(BeliefGrid& grid) noexcept {
  MapNotes& notes = notes_to_change(grid);
  notes.sensor.swap(sensor_);
  notes.frames.merge(frame_);
}

}  // namespace viewgain::detail
