// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include "choose/planner_state.hpp"

#include <algorithm>
#include <array>
#include <cstdint>

#include "viewgain/support/text.hpp"

namespace viewgain::detail {
namespace {

constexpr std::uint64_t kVersion = 4;
constexpr std::uint64_t kOldest = 2;  // without last_pose; 3: without first_views
constexpr std::uint64_t kMost = std::uint64_t{1} << 53;
constexpr std::array kReasons{StopReason::gain,          StopReason::area,        StopReason::cost,
                              StopReason::no_candidates, StopReason::unreachable, StopReason::idle,
                              StopReason::promises,      StopReason::max_views};

std::string line_of(std::string_view name, const StopMemory& memory) {
  std::string line(name);
  for (const std::uint64_t count :
       {std::uint64_t{memory.views}, std::uint64_t{memory.idle_views}, memory.unknown_voxels,
        std::uint64_t{memory.decisions}, std::uint64_t{memory.broken_promises}}) {
    line.append(" ").append(std::to_string(count));
  }
  for (const double value :
       {memory.entropy_removed, memory.first_gain_per_voxel, memory.area_shares[0],
        memory.area_shares[1], memory.area_shares[2], memory.promised_area, memory.promised_gain}) {
    line.append(" ").append(short_text(value));
  }
  return line.append("\n");
}

StopMemory memory_of(const LineReader& reader) {
  StopMemory memory;
  memory.views = static_cast<std::size_t>(reader.count(1, kMost));
  memory.idle_views = static_cast<std::size_t>(reader.count(2, kMost));
  memory.unknown_voxels = reader.count(3, kMost);
  memory.decisions = static_cast<std::size_t>(reader.count(4, kMost));
  memory.broken_promises = static_cast<std::size_t>(reader.count(5, kMost));
  memory.entropy_removed = reader.number(6);
  memory.first_gain_per_voxel = reader.number(7);
  for (std::size_t i = 0; i < 3; ++i) memory.area_shares[i] = reader.number(8 + i);
  memory.promised_area = reader.number(11);
  memory.promised_gain = reader.number(12);
  return memory;
}

std::string line_of(std::string_view name, const Pose& pose) {
  std::string line(name);
  for (const double value : pose.m) line.append(" ").append(short_text(value));
  return line.append("\n");
}

Pose pose_of(const LineReader& reader) {
  Pose pose;
  for (std::size_t i = 0; i < pose.m.size(); ++i) pose.m[i] = reader.finite_number(1 + i);
  if (!rigid_pose(pose)) reader.fail("the pose is not a rigid transform");
  return pose;
}

std::string line_of(std::string_view name, std::optional<StopReason> reason) {
  if (!reason) return {};
  return std::string(name).append(" ").append(stop_reason_name(*reason)).append("\n");
}

StopReason reason_of(const LineReader& reader) {
  for (const StopReason reason : kReasons) {
    if (reader.words()[1] == stop_reason_name(reason)) return reason;
  }
  reader.fail(quoted(reader.words()[1]) + " is not a stop reason");
}

FrameVerdict verdict_of(const LineReader& reader) {
  const auto& names = kFrameVerdictNames;
  const auto found = std::find(names.begin(), names.end(), reader.words()[1]);
  if (found == names.end()) reader.fail(quoted(reader.words()[1]) + " is not a verdict");
  return static_cast<FrameVerdict>(found - names.begin());
}

// Keywords of lines and their numbers of words.
struct Entry {
  std::string_view name;
  std::size_t words;
};
constexpr std::array kEntries{
    Entry{"version", 2},       Entry{"seen_area", 2}, Entry{"before_choice", 13},
    Entry{"after_choice", 13}, Entry{"frames", 3},    Entry{"reached", 13},
    Entry{"missed", 13},       Entry{"planned", 13},  Entry{"promised", 13},
    Entry{"first_views", 2},   Entry{"of_view", 2},   Entry{"of_choice", 2},
    Entry{"last_pose", 13}};

}  // namespace

std::string text_of(const PlannerState& state) {
  std::string text;
  text.append("version ").append(std::to_string(kVersion)).append("\n");
  text.append("seen_area ").append(short_text(state.seen_area)).append("\n");
  text += line_of("before_choice", state.before_choice);
  text += line_of("after_choice", state.after_choice);
  for (const auto& [verdict, count] : state.frames) {
    text.append("frames ").append(frame_verdict_name(verdict)).append(" ");
    text.append(std::to_string(count)).append("\n");
  }
  for (const Pose& pose : state.reached) text += line_of("reached", pose);
  for (const Pose& pose : state.missed) text += line_of("missed", pose);
  if (state.first_views > 0) {
    text.append("first_views ").append(std::to_string(state.first_views)).append("\n");
  }
  if (state.last_pose) text += line_of("last_pose", *state.last_pose);
  for (const Pose& pose : state.planned) text += line_of("planned", pose);
  if (state.promised) text += line_of("promised", *state.promised);
  text += line_of("of_view", state.of_view);
  text += line_of("of_choice", state.of_choice);
  return text;
}

PlannerState state_of(const std::string& name, std::string_view text) {
  PlannerState state;
  LineReader reader(name, text);
  std::size_t needed = 0;  // of the first four entries
  while (reader.next()) {
    if (reader.words().empty()) reader.fail("the line is empty");
    const std::string_view key = reader.words()[0];
    std::size_t at = 0;
    while (at < kEntries.size() && kEntries[at].name != key) ++at;
    if (at == kEntries.size()) reader.fail("unknown entry " + quoted(key));
    if (reader.words().size() != kEntries[at].words) {
      reader.fail("the entry " + quoted(key) + " has " + std::to_string(reader.words().size() - 1) +
                  " values, not " + std::to_string(kEntries[at].words - 1));
    }
    if (at < 4 && at != needed++)
      reader.fail("the entry " + quoted(key) + " is in the wrong place");
    if (key == "version") {
      const std::uint64_t version = reader.count(1, kMost);
      if (version >= kOldest && version <= kVersion) continue;
      reader.fail("version " + std::to_string(version) +
                  " of the planner's state is not supported; this library reads versions " +
                  std::to_string(kOldest) + " to " + std::to_string(kVersion));
    } else if (key == "seen_area") {
      state.seen_area = reader.number(1);
    } else if (key == "before_choice") {
      state.before_choice = memory_of(reader);
    } else if (key == "after_choice") {
      state.after_choice = memory_of(reader);
    } else if (key == "frames") {
      state.frames[verdict_of(reader)] = static_cast<std::size_t>(reader.count(2, kMost));
    } else if (key == "reached") {
      state.reached.push_back(pose_of(reader));
    } else if (key == "missed") {
      state.missed.push_back(pose_of(reader));
    } else if (key == "last_pose") {
      state.last_pose = pose_of(reader);
    } else if (key == "first_views") {
      state.first_views = static_cast<std::size_t>(reader.count(1, kMost));
    } else if (key == "planned") {
      state.planned.push_back(pose_of(reader));
    } else if (key == "promised") {
      state.promised = pose_of(reader);
    } else if (key == "of_view") {
      state.of_view = reason_of(reader);
    } else if (key == "of_choice") {
      state.of_choice = reason_of(reader);
    }
  }
  if (needed < 4) reader.fail("the entry " + quoted(kEntries[needed].name) + " is missing");
  return state;
}

}  // namespace viewgain::detail
