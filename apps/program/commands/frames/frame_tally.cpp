// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "program/commands/frames/frame_tally.hpp"

#include <cmath>
#include <cstdio>
#include <utility>

#include "program/cli/values.hpp"
#include "program/commands/frames/mask_use.hpp"
#include "viewgain/planner/suspect_frames.hpp"

namespace viewgain::app {

Json frames_json(const FrameCounts& counts) {
  const std::size_t carved = count_of(counts, FrameVerdict::carved);
  return {{"frames", count_of(counts, FrameVerdict::used) + carved},
          {"carved", carved},
          {"bad", bad_frames(counts)}};
}

std::string frames_text(std::size_t carved, const std::map<std::string, std::size_t>& bad) {
  std::string text;
  if (carved > 0) text = with_commas(carved) + " frames show free space alone";
  if (bad.empty()) return text;
  return text + (text.empty() ? "left out: " : "; left out: ") + counts_text(bad);
}

std::string frames_text(const FrameCounts& counts) {
  return frames_text(count_of(counts, FrameVerdict::carved), bad_frames(counts));
}

namespace {

// Under a table nothing is seen.
std::string suspect_plane(const Sensor& sensor, const std::vector<DepthFrame>& frames,
                          const std::vector<Pose>& poses, double plane) {
  constexpr double kUnder = 0.05;  // no noise [m]
  const std::vector<Eigen::Vector3d> rays = sensor.camera.ray_table();
  std::size_t under = 0, all = 0;
  for (std::size_t k = 0; k < frames.size(); ++k) {
    for (std::size_t i = 0; i < rays.size(); ++i) {
      const double z = static_cast<double>(frames[k].depth[i]);
      if (!(z > 0 && std::isfinite(z) && rays[i].allFinite())) continue;
      ++all;
      under += (poses[k] * (z * rays[i])).z() < plane - kUnder ? 1 : 0;
    }
  }
  if (10 * under <= all) return {};
  return formatted("%.0f %% of the readings lie more than %g m under the support plane at %g m",
                   100 * static_cast<double>(under) / static_cast<double>(all), kUnder, plane);
}

}  // namespace

std::string suspicion_of(const FrameFolder& folder, const std::optional<double>& support_plane) {
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
  std::string what = suspect_frames(folder.sensor(), frames, poses).what;
  if (what.empty() && support_plane) {
    what = suspect_plane(folder.sensor(), frames, poses, *support_plane);
  }
  return what;
}

void warn_if_out_of_range(const std::string& cloud, const IntegrationReport& sum) {
  if (sum.readings > 0 || sum.out_of_range == 0) return;
  std::fprintf(stderr,
               "viewgain: warning: %s: none of %s points is in the sensor's range: are they in "
               "metres?\n",
               cloud.c_str(), with_commas(sum.out_of_range).c_str());
}

void FrameTally::add(const std::filesystem::path& image, const FrameFault& fault) {
  const bool is_first = counts_[fault.verdict]++ == 0;
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
    std::fprintf(stderr, "viewgain: %s; left out\n", fault.c_str());
  }
}

std::string FrameTally::none_inside(const FrameFolder& folder) const {
  return "none of " + with_commas(readings_) + " readings lies in the workspace at " +
         short_text(folder.frames().depth_scale) +
         " m per unit of the depth images (--depth-scale)";
}

void FrameTally::require_any(const FrameFolder& folder, const BeliefGrid& map,
                             const std::optional<double>& support_plane, bool needs_surface) const {
  if (blames_masks(folder, map, needs_surface)) return;
  const std::string suspicion = suspicion_of(folder, support_plane);
  if (counts_.empty() || is_in_map(counts_.begin()->first)) {
    name_left_out();
    const bool has_surface = sees_plane_ || map.statistics().occupied > 0;
    const std::size_t used = count_of(counts_, FrameVerdict::used);
    const bool is_outside = used == 0 && readings_ > 0;
    std::string warning = is_outside ? none_inside(folder) : "";
    if (!has_surface) {
      constexpr const char* kWords =
          "no voxel is occupied: does the workspace hold the object, are the poses camera to "
          "world?";
      warning += (warning.empty() ? "" : "; ") + std::string(kWords);
    } else if (warning.empty() && suspicion.empty() &&
               count_of(counts_, FrameVerdict::carved) > used) {
      warning = frames_text(counts_) + ": are scale, poses and workspace right?";
    }
    if (!suspicion.empty()) warning += (warning.empty() ? "" : "; ") + suspicion;
    if (warning.empty()) return;
    if ((is_outside && !suspicion.empty()) || (needs_surface && !has_surface)) {
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
  std::string what = folder.name() + ": no frame has a reading at " +
                     short_text(folder.frames().depth_scale) +
                     " m per unit of the depth images (--depth-scale)";
  const auto reasons = bad_frames(bad.counts());
  if (!reasons.empty()) what += "; left out: " + counts_text(reasons) + "; " + bad.faults().front();
  const std::string suspicion = suspicion_of(folder);
  if (!suspicion.empty()) what += "; " + suspicion;
  refuse(what);
}

}  // namespace viewgain::app
