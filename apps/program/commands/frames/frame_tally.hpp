// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <map>
#include <numbers>
#include <optional>
#include <string>
#include <vector>

#include "program/cli/flags/frame_folder.hpp"
#include "viewgain/core/frame_verdict.hpp"
#include "viewgain/formats/frames.hpp"
#include "viewgain/grid/belief_grid.hpp"
#include "viewgain/grid/integrate.hpp"
#include "viewgain/planner/register_frame.hpp"
#include "viewgain/raycast/frame_check.hpp"
#include "viewgain/support/json.hpp"

namespace viewgain::app {

/// frames (in the map), carved (of these, those that showed only free space), bad (the others:
/// reason -> count).
[[nodiscard]] Json frames_json(const FrameCounts& counts);
/// "2 frames show free space alone; left out: 1 lost_pose, 2 outside", or nothing.
[[nodiscard]] std::string frames_text(const FrameCounts& counts);
/// A warning if registration left out more than two thirds of the frames; otherwise empty.
[[nodiscard]] std::string refused_text(const FrameCounts& counts);
[[nodiscard]] std::string frames_text(std::size_t carved,
                                      const std::map<std::string, std::size_t>& bad);

/// What is probably wrong with the frames of the folder (suspect_frames()), or empty. Reads a dozen
/// of them.
[[nodiscard]] std::string suspicion_of(const FrameFolder& folder);

/// 12 for frame-000012.depth.png; without digits its index among the frames.
[[nodiscard]] std::size_t number_of(const std::filesystem::path& image, std::size_t place);
/// share_in_free, share_seen_past, kind and what (null: the frames agree), frames (numbers of those
/// that contradict the others), per_frame. `numbers`: those of the frames in the map.
[[nodiscard]] Json to_json(const FrameConsistency& found, const std::vector<std::size_t>& numbers);
/// The suspicion and the frames concerned, as ranges of their numbers; empty without a suspicion.
[[nodiscard]] std::string text_of(const FrameConsistency& found,
                                  const std::vector<std::size_t>& numbers);

/// Warns if clouds have points but none is in the sensor's range, as with millimetres.
void warn_if_out_of_range(const std::string& cloud, const IntegrationReport& sum);

/// How the frames of a folder were used, and messages about it.
class FrameTally {
 public:
  explicit FrameTally(bool quiet) : quiet_(quiet) {}

  void add(const std::filesystem::path& image, const FrameFault& fault);
  /// Adds the pixel counts of a frame, whether it went into the map or not.
  void add(const IntegrationReport& counts);
  /// Throws Error(invalid_argument) with the reasons if there were frames but none is in the map,
  /// if none has a reading in the workspace and a fault is suspected, or if frames contradict each
  /// other and the folder refuses that. Otherwise names the first frame of each kind that was left
  /// out, unless quiet. Warns of suspicions (`found`), and if no voxel of `map` is occupied and no
  /// frame shows the support plane.
  void require_any(const FrameFolder& folder, const BeliefGrid& map,
                   const FrameConsistency& found) const;
  /// For frames added to an existing map: warns of suspicions, or throws if the folder refuses
  /// contradictions.
  void warn_of_contradictions(const FrameFolder& folder, const FrameConsistency& found) const;

  /// Names the first frame of each kind that was left out, unless quiet.
  void name_left_out() const;
  /// The suspicion about the frames in the map, else about those that were left out.
  [[nodiscard]] std::string suspicion_of(const FrameConsistency& found) const;

  [[nodiscard]] const FrameCounts& counts() const noexcept { return counts_; }
  /// Numbers of the frames in the map, in order, from their names.
  [[nodiscard]] const std::vector<std::size_t>& numbers() const noexcept { return numbers_; }
  /// Fault of the first frame of each kind that was left out.
  [[nodiscard]] const std::vector<std::string>& faults() const noexcept { return faults_; }

 private:
  /// Whether masks explain why frames could not be used (mask_use.hpp). Then warns, or throws like
  /// require_any().
  [[nodiscard]] bool blames_masks(const FrameFolder& folder, const BeliefGrid& map) const;
  [[nodiscard]] std::string none_inside(const FrameFolder& folder) const;

  bool quiet_;
  FrameCounts counts_;
  std::size_t count_ = 0;
  std::vector<std::size_t> numbers_;
  std::vector<std::string> faults_;
  std::uint64_t readings_ = 0;
  bool sees_plane_ = false;
};

/// For frames without any reading for a workspace: throws Error(invalid_argument) with the bad
/// frames and the suspicion.
[[noreturn]] void refuse_without_readings(const FrameFolder& folder, const FrameTally& bad);

/// The keys of `registration` in run.json.
[[nodiscard]] inline Json to_json(const FrameRegistration& registration) {
  return {{"status", registration_status_name(registration.status)},
          {"reason", registration.reason},
          {"pose", to_json(registration.T_world_camera)},
          {"translation", registration.translation},
          {"rotation_deg", registration.rotation * 180 / std::numbers::pi},
          {"residual_before", registration.residual_before},
          {"residual_after", registration.residual_after},
          {"overlap", registration.overlap},
          {"contradiction", registration.contradiction},
          {"smallest_information", registration.smallest_information},
          {"free_directions", registration.free_directions.size()}};
}

/// Number of registrations by status.
[[nodiscard]] inline Json registration_counts(const std::vector<FrameRegistration>& registrations) {
  Json json;
  for (const auto status : {RegistrationStatus::registered, RegistrationStatus::too_little_overlap,
                            RegistrationStatus::refused}) {
    json[registration_status_name(status)] =
        std::count_if(registrations.begin(), registrations.end(),
                      [&](const FrameRegistration& r) { return r.status == status; });
  }
  return json;
}

/// registration_counts() as text.
[[nodiscard]] inline std::string registration_text(const Json& counts) {
  return "registration: " + counts["registered"].dump() + " registered, " +
         counts["too_little_overlap"].dump() + " too_little_overlap, " + counts["refused"].dump() +
         " refused";
}

}  // namespace viewgain::app
