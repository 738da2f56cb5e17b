// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "program/commands/frames/frame_tally.hpp"

#include <charconv>
#include <cstdio>
#include <utility>

#include "program/cli/values.hpp"
#include "program/commands/frames/mask_use.hpp"
#include "viewgain/raycast/suspect_frames.hpp"

namespace viewgain::app {

Json frames_json(const FrameCounts& counts) {
  const std::size_t carved = count_of(counts, FrameVerdict::carved);
  return {{"frames", count_of(counts, FrameVerdict::used) + carved},
          {"carved", carved},
          {"bad", bad_frames(counts)}};
}

std::string frames_text(std::size_t carved, const std::map<std::string, std::size_t>& bad) {
  std::string text;
  if (carved > 0) text = with_commas(carved) + " frames show only free space";
  if (bad.empty()) return text;
  return text + (text.empty() ? "left out: " : "; left out: ") + counts_text(bad);
}

std::string frames_text(const FrameCounts& counts) {
  return frames_text(count_of(counts, FrameVerdict::carved), bad_frames(counts));
}

std::string refused_text(const FrameCounts& counts) {
  constexpr std::size_t kFew = 3;
  const std::size_t refused = count_of(counts, FrameVerdict::contradicts);
  const std::size_t taken =
      count_of(counts, FrameVerdict::used) + count_of(counts, FrameVerdict::carved);
  if (refused < kFew || refused <= 2 * taken) return {};
  return with_commas(refused) + " of " + with_commas(refused + taken) +
         " frames contradict the other frames and were left out (--register on). The number of "
         "frames in "
         "the map is " +
         with_commas(taken) +
         ". Registration corrects only small errors. Are the poses those of the camera? Do they "
         "match the images in time? Are the intrinsics right?";
}

namespace {

std::vector<std::size_t> numbers_of(const std::vector<std::size_t>& frames,
                                    const std::vector<std::size_t>& numbers) {
  std::vector<std::size_t> all;
  for (const std::size_t frame : frames) {
    all.push_back(frame < numbers.size() ? numbers[frame] : frame);
  }
  return all;
}

}  // namespace

std::size_t number_of(const std::filesystem::path& image, std::size_t place) {
  const std::string name = image.filename().string();
  const std::size_t first = name.find_first_of("0123456789");
  std::size_t number = 0;
  const char* end = name.data() + name.size();
  if (first == std::string::npos ||
      std::from_chars(name.data() + first, end, number).ec != std::errc()) {
    return place;
  }
  return number;
}

Json to_json(const FrameConsistency& found, const std::vector<std::size_t>& numbers) {
  Json json{{"share_in_free", found.share_in_free},
            {"share_seen_past", found.share_seen_past},
            {"displacement", found.displacement},
            {"expected", found.expected},
            {"kind", nullptr},
            {"what", nullptr},
            {"frames", numbers_of(found.contradicting, numbers)},
            {"per_frame", Json::array()}};
  if (!found.suspicion.kind.empty()) {
    json["kind"] = found.suspicion.kind;
    json["what"] = found.suspicion.what;
  }
  for (std::size_t i = 0; i < found.frames.size(); ++i) {
    const FrameContradiction& frame = found.frames[i];
    Json one{{"frame", numbers_of({i}, numbers)[0]},
             {"in_free", frame.share_in_free()},
             {"seen_past", frame.share_seen_past()},
             {"displacement", nullptr},
             {"expected", nullptr},
             {"same_image_as", nullptr}};
    if (frame.compared > 0) {
      one["displacement"] = frame.displacement;
      one["expected"] = frame.expected;
    }
    if (frame.same_image_as) one["same_image_as"] = numbers_of({*frame.same_image_as}, numbers)[0];
    json["per_frame"].push_back(std::move(one));
  }
  return json;
}

std::string text_of(const FrameConsistency& found, const std::vector<std::size_t>& numbers) {
  std::string text = found.suspicion.what;
  if (text.empty() || found.contradicting.empty()) return text;
  const bool is_one = found.contradicting.size() == 1;
  return text + (text.ends_with('?') ? " See frame" : ". See frame") + (is_one ? " " : "s ") +
         ranges_text(numbers_of(found.contradicting, numbers));
}

std::string suspicion_of(const FrameFolder& folder) {
  constexpr std::size_t kFrames = 12;
  std::vector<DepthFrame> frames;
  std::vector<Pose> poses;
  const std::size_t step = std::max<std::size_t>(1, folder.size() / kFrames);
  for (std::size_t i = 0; i < folder.size() && frames.size() < kFrames; i += step) {
    FrameReading reading = folder.load(i);
    if (reading.fault.verdict != FrameVerdict::used) continue;
    frames.push_back(std::move(reading.frame));
    poses.push_back(folder.T_world_camera(i));
  }
  return suspect_frames(folder.sensor(), frames, poses).what;
}

void warn_if_out_of_range(const std::string& cloud, const IntegrationReport& sum) {
  if (sum.readings > 0 || sum.out_of_range == 0) return;
  std::fprintf(stderr,
               "viewgain: warning: %s: none of the %s points is in the sensor's range. Are they in "
               "metres?\n",
               cloud.c_str(), with_commas(sum.out_of_range).c_str());
}

void FrameTally::add(const std::filesystem::path& image, const FrameFault& fault) {
  const bool is_first = counts_[fault.verdict]++ == 0;
  if (is_in_map(fault.verdict)) numbers_.push_back(number_of(image, count_));
  ++count_;
  if (!is_first || is_in_map(fault.verdict)) return;
  faults_.push_back((fault.what.empty() ? image.string() : fault.what) + " (" +
                    std::string(frame_verdict_name(fault.verdict)) + ")");
}

void FrameTally::add(const IntegrationReport& counts) {
  readings_ += counts.readings;
  sees_plane_ = sees_plane_ || counts.plane_readings > 0;
}

void FrameTally::name_left_out() const {
  if (quiet_) return;
  for (const std::string& fault : faults_) {
    std::fprintf(stderr, "viewgain: %s; the frame is left out\n", fault.c_str());
  }
}

std::string FrameTally::none_inside(const FrameFolder& folder) const {
  return "none of the " + with_commas(readings_) +
         " measured points lies in the workspace; the depth scale is " +
         short_text(folder.frames().depth_scale) +
         " m per unit of the depth images (--depth-scale)";
}

std::string FrameTally::suspicion_of(const FrameConsistency& found) const {
  std::string what = text_of(found, numbers_);
  return what.empty() ? refused_text(counts_) : what;
}

void FrameTally::warn_of_contradictions(const FrameFolder& folder,
                                        const FrameConsistency& found) const {
  const std::string what = suspicion_of(found);
  if (what.empty()) return;
  if (folder.refuses_contradictions()) refuse(folder.name() + ": " + what);
  std::fprintf(stderr, "viewgain: warning: %s: %s\n", folder.name().c_str(), what.c_str());
}

void FrameTally::require_any(const FrameFolder& folder, const BeliefGrid& map,
                             const FrameConsistency& found) const {
  if (blames_masks(folder, map)) return;
  const std::string suspicion = suspicion_of(found);
  if (counts_.empty() || is_in_map(counts_.begin()->first)) {
    name_left_out();
    const bool has_surface = sees_plane_ || map.statistics().occupied > 0;
    const std::size_t used = count_of(counts_, FrameVerdict::used);
    const bool is_outside = used == 0 && readings_ > 0;
    std::string warning = is_outside ? none_inside(folder) : "";
    if (!has_surface) {
      constexpr const char* kWords =
          "no voxel is occupied. Does the workspace contain the object, and are the poses camera "
          "to world?";
      warning += (warning.empty() ? "" : "; ") + std::string(kWords);
    } else if (warning.empty() && suspicion.empty() &&
               count_of(counts_, FrameVerdict::carved) > used) {
      warning = frames_text(counts_) + ". Are scale, poses and workspace right?";
    }
    if (!suspicion.empty()) warning += (warning.empty() ? "" : "; ") + suspicion;
    if (warning.empty()) return;
    if ((is_outside && !suspicion.empty()) ||
        (folder.refuses_contradictions() && !suspicion.empty())) {
      refuse(folder.name() + ": " + warning);
    }
    std::fprintf(stderr, "viewgain: warning: %s: %s\n", folder.name().c_str(), warning.c_str());
    return;
  }
  std::string what =
      folder.name() + ": no frame can be used (" + counts_text(bad_frames(counts_)) + ")";
  if (count_of(counts_, FrameVerdict::outside) > 0) what += "; " + none_inside(folder);
  what += "; " + faults_.front();
  if (!suspicion.empty()) what += "; " + suspicion;
  refuse(what);
}

void refuse_without_readings(const FrameFolder& folder, const FrameTally& bad) {
  if (const std::string why = mask_suspicion(folder); !why.empty())
    refuse(folder.name() + ": " + why);
  std::string what =
      folder.name() + ": no frame has a depth in the sensor's range; the depth scale is " +
      short_text(folder.frames().depth_scale) + " m per unit of the depth images (--depth-scale)";
  const auto reasons = bad_frames(bad.counts());
  if (!reasons.empty()) what += "; left out: " + counts_text(reasons) + "; " + bad.faults().front();
  const std::string suspicion = suspicion_of(folder);
  if (!suspicion.empty()) what += "; " + suspicion;
  refuse(what);
}

}  // namespace viewgain::app
