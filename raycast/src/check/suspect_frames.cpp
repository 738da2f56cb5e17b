// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include "viewgain/raycast/suspect_frames.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <optional>
#include <string_view>
#include <utility>
#include <vector>

#include "check/frame_meetings.hpp"
#include "check/suspicion.hpp"
#include "viewgain/core/error.hpp"
#include "viewgain/raycast/gain_evaluator.hpp"
#include "viewgain/raycast/suspect_set_up.hpp"
#include "viewgain/support/text.hpp"

namespace viewgain {
namespace {

using detail::FrameMeetings, detail::kFocalLength, detail::kScale, detail::Meetings,
    detail::Convention, detail::percent;

constexpr double kOffCentre = 0.12;  // of the image's side
constexpr double kEdges = 0.015;     // fraction of readings of correct frames, at edges of surfaces
constexpr double kAlike = 0.1;  // conventions that fit nearly as well as the best are named too

Suspicion suspect_camera(const PinholeCamera& camera, const std::vector<Eigen::Vector3d>& rays) {
  const auto lost = std::count_if(rays.begin(), rays.end(),
                                  [](const Eigen::Vector3d& ray) { return !ray.allFinite(); });
  if (const double share = static_cast<double>(lost) / static_cast<double>(rays.size());
      share > 0.5) {
    return {"distortion", "the lens distortion cannot be inverted for " + percent(share) +
                              " of the pixels. Do k1 k2 p1 p2 k3 belong to this camera?"};
  }
  if (std::max(camera.fx, camera.fy) > 1.1 * std::min(camera.fx, camera.fy)) {
    return {"focal_lengths",
            "fx is " + short_text(camera.fx) + " px and fy is " + short_text(camera.fy) +
                " px; they differ by more than 10 %. Are the intrinsics in the right order?"};
  }
  if (camera.width == 1 || camera.height == 1) return {};  // a line has no middle
  const double u = camera.cx / (camera.width - 1), v = camera.cy / (camera.height - 1);
  if (std::abs(u - 0.5) < kOffCentre && std::abs(v - 0.5) < kOffCentre) return {};
  return {"principal_point", "the principal point is far from the middle of the image, at " +
                                 percent(u) + " of its width and " + percent(v) +
                                 " of its height. Are the intrinsics those of another resolution?"};
}

// Fraction of the pixels with a depth that are within the sensor's range if depths are multiplied
// by `factor`.
double share_in_range(const Sensor& sensor, std::span<const DepthFrame> frames, double factor) {
  constexpr std::size_t kPixels = 10'000;  // per frame; more are not needed
  std::size_t in_range = 0, all = 0;
  for (const DepthFrame& frame : frames) {
    const std::size_t step = frame.depth.size() / kPixels + 1;
    for (std::size_t i = 0; i < frame.depth.size(); i += step) {
      const float z = frame.depth[i];
      if (!(z > 0) || !std::isfinite(z)) continue;
      ++all;
      const double range = static_cast<double>(z) * factor;
      in_range += range >= sensor.min_range && range <= sensor.max_range ? 1 : 0;
    }
  }
  return all == 0 ? 0 : static_cast<double>(in_range) / static_cast<double>(all);
}

// A convention is impossible if fewer readings would be in range or few would have a counterpart.
// Correct frames contradict each other in up to 7 % of their overlap, at edges.
bool is_possible(const Meetings& other, const Meetings& as_said) {
  return 20 * other.points >= 19 * as_said.points && other.has_overlap() &&
         other.share_past() <= 0.15;
}

// Whether many more readings have a counterpart, or frames contradict each other less and lie
// closer.
bool is_better(const Meetings& other, const Meetings& as_said) {
  if (!is_possible(other, as_said)) return false;
  if (4 * as_said.met < other.met) return true;
  return as_said.share_past() > kEdges && other.share_past() < 0.6 * as_said.share_past() &&
         other.share_close() > as_said.share_close();
}

// Under the right convention, frames fit nearly as well as correct frames do.
bool is_proof(const Meetings& other, const Meetings& as_said) {
  return other.share_past() < 0.05 && other.share_past() < 0.3 * as_said.share_past() &&
         other.share_close() > 0.8;
}

bool looks_right(const Meetings& met) {
  return met.has_overlap() && met.share_past() <= kEdges && met.share_close() > 0.5;
}

struct Fit {
  Convention reading;
  double agreement = 0;  // of the readings, in any unit
  Meetings met{};
};

// The best fits: those within `slack` of the best one.
std::vector<Fit> best_of(std::vector<Fit> fits, double slack) {
  std::stable_sort(fits.begin(), fits.end(),
                   [](const Fit& a, const Fit& b) { return a.agreement > b.agreement; });
  const double least = fits.empty() ? 0 : (1 - slack) * fits[0].agreement;
  std::erase_if(fits, [least](const Fit& fit) { return fit.agreement < least; });
  return fits;
}

std::vector<Fit> fits_by_meetings(const FrameMeetings& meeting, const Meetings& as_said,
                                  const std::vector<Convention>& readings) {
  std::vector<Fit> fits;
  for (const Convention& reading : readings) {
    if (reading.kind == kFocalLength) continue;
    const Meetings other = meeting.under(reading);
    if (is_better(other, as_said) && (!reading.needs_proof() || is_proof(other, as_said))) {
      fits.push_back({reading, static_cast<double>(other.close), other});
    }
  }
  return best_of(std::move(fits), kAlike);
}

// The focal length that brings most pairs close together. Pairs are compared one by one, because an
// error of 10 % moves readings by less than the contradictions at edges.
std::optional<Fit> fit_by_focal_length(const FrameMeetings& meeting, const Meetings& as_said) {
  constexpr double kMostBetter = 0.65;  // an error of 3 % gives up to 0.6
  constexpr double kSlightly = 0.15;    // others are tried if these are better, or frames disagree
  constexpr double kMuch = 0.015;       // more than noise
  Fit best;
  best.met = as_said;
  std::vector<Convention> readings = detail::other_readings();
  std::erase_if(readings, [](const Convention& reading) { return reading.kind != kFocalLength; });
  const auto keep_best = [&](bool slightly) {
    for (const Convention& reading : readings) {
      if ((std::abs(reading.focal_factor - 1) < kSlightly) != slightly) continue;
      const Meetings other = meeting.under(reading);
      if (!is_possible(other, as_said) || !(other.share_close() > best.met.share_close())) continue;
      best = {reading, 0, other};
    }
  };
  keep_best(true);
  const auto is_much_better = [&] {
    return best.met.share_close() > as_said.share_close() + kMuch;
  };
  if (is_much_better() || !looks_right(as_said)) keep_best(false);
  if (!is_much_better()) return std::nullopt;
  const std::optional<double> better = meeting.share_better(best.reading);
  if (better ? *better < kMostBetter : !is_better(best.met, as_said)) return std::nullopt;
  return best;
}

// Tries a scale and a focal length separately, if fewer readings then lie in other frames' free
// space. For views around an object a wrong convention can look like a wrong focal length. Both are
// then named, the commoner mistake first.
std::vector<Fit> fits_of(const FrameMeetings& meeting, const Meetings& as_said) {
  const auto is_clearly_less = [](double a, double b) { return a < 0.5 * b && b > 0.015; };
  std::vector<Fit> fits;
  if (!as_said.has_overlap() || as_said.share_past() > kEdges) {
    fits = fits_by_meetings(meeting, as_said, detail::other_readings());
  }
  const std::optional<Fit> focal = fit_by_focal_length(meeting, as_said);
  if (!focal) return fits;
  const bool is_scale = !fits.empty() && fits[0].reading.kind == kScale;
  if (is_scale) {
    const double past = focal->met.share_past(), of_scale = fits[0].met.share_past();
    if (!is_possible(focal->met, fits[0].met) || is_clearly_less(of_scale, past)) return fits;
    if (is_clearly_less(past, of_scale)) fits.clear();
  }
  fits.insert(is_scale ? fits.begin() : fits.end(), *focal);
  return fits;
}

// "A, or if B"
std::string words_of(const std::vector<Fit>& fits) {
  std::string text;
  for (const Fit& fit : fits) text += (text.empty() ? "" : ", or ") + fit.reading.what;
  return text;
}

// Several scales can bring the depths into range. If frames overlap, their agreement selects the
// scale.
Suspicion suspect_range(const Sensor& sensor, std::span<const DepthFrame> frames,
                        const FrameMeetings& meeting) {
  const double now = share_in_range(sensor, frames, 1);
  if (now > 0.1) return {};
  std::vector<Fit> fits;
  for (const Convention& reading : detail::other_readings()) {
    const double share = share_in_range(sensor, frames, reading.depth_factor);
    if (share > 0.8) fits.push_back({reading, share});
  }
  fits = best_of(std::move(fits), 0.01);
  if (fits.empty()) return {};
  const std::string text =
      percent(1 - now) + " of the depths are out of the sensor's range. Perhaps ";
  const std::string then = "; the share would then be " + percent(1 - fits[0].agreement);
  std::vector<Convention> scales;
  for (const Fit& fit : fits) scales.push_back(fit.reading);
  if (auto met = fits_by_meetings(meeting, {}, scales); !met.empty()) fits = std::move(met);
  return {kScale, text + words_of(fits) + then};
}

// Checks for readings below the table, where nothing is visible.
Suspicion suspect_plane(std::span<const DepthFrame> frames, const FrameMeetings& meeting,
                        double plane) {
  constexpr double kUnder = 0.05;  // more than noise [m]
  const std::vector<Eigen::Vector3d>& rays = meeting.rays();
  std::size_t under = 0, all = 0;
  for (std::size_t k = 0; k < frames.size(); ++k) {
    for (std::size_t i = 0; i < rays.size(); ++i) {
      const double z = static_cast<double>(frames[k].depth[i]);
      if (!(z > 0 && std::isfinite(z) && rays[i].allFinite())) continue;
      ++all;
      under += (meeting.pose(k) * (z * rays[i])).z() < plane - kUnder ? 1 : 0;
    }
  }
  if (10 * under <= all) return {};
  const double share = static_cast<double>(under) / static_cast<double>(all);
  return {"support_plane", percent(share) + " of the points lie more than " + short_text(kUnder) +
                               " m below the support plane, whose height is " + short_text(plane) +
                               " m. Are its height and the poses right?"};
}

// Detects depths along the ray by readings for which that makes a difference.
Suspicion suspect_along_ray(const FrameMeetings& meeting, const Meetings& as_said,
                            const std::vector<Fit>& fits) {
  if (!as_said.has_overlap() || as_said.share_past() >= 0.15) return {};
  const std::optional<double> along_ray = meeting.share_better({.is_along_ray = true});
  if (!along_ray || *along_ray < 0.45) return {};
  const Meetings by_ray = meeting.under({.is_along_ray = true});
  // With inexact poses, any convention improves nearly half of the pairs.
  if (!(by_ray.share_close() > as_said.share_close())) return {};
  const bool fits_best = std::all_of(fits.begin(), fits.end(), [&](const Fit& fit) {
    return by_ray.close > fit.met.close && by_ray.share_close() > fit.met.share_close();
  });
  if (!fits_best) return {};
  return {"depth_along_ray", "perhaps depths are measured along the ray, not along z: then " +
                                 percent(*along_ray) +
                                 " of the affected depths would fit the other frames better"};
}

// The mistake under which the frames fit each other.
Suspicion suspect_convention(const FrameMeetings& meeting, const Meetings& as_said,
                             bool has_copies) {
  std::vector<Fit> fits = fits_of(meeting, as_said);
  if (has_copies) {
    std::erase_if(fits, [](const Fit& fit) { return fit.reading.needs_proof(); });
  }
  if (Suspicion ray = suspect_along_ray(meeting, as_said, fits); !ray.kind.empty()) return ray;
  if (fits.empty()) return {};
  const Meetings& best = fits[0].met;
  const std::string perhaps = ". Perhaps " + words_of(fits), then = "; the share would then be ";
  if (fits[0].reading.kind == kFocalLength) {
    return {kFocalLength, percent(as_said.share_close()) +
                              " of the points that several frames see lie close to where the other "
                              "frames see them" +
                              perhaps + then + percent(best.share_close())};
  }
  const bool is_apart = as_said.met + as_said.seen_past < detail::kLeastMeetings;
  if (is_apart) {
    return {fits[0].reading.kind, "frames from different places see no common surface" + perhaps +
                                      "; they would then see common surface"};
  }
  return {fits[0].reading.kind, percent(as_said.share_past()) +
                                    " of the points that several frames see lie in space that "
                                    "another frame saw as free" +
                                    perhaps + then + percent(best.share_past())};
}

}  // namespace

Suspicion detail::suspicion_of(const Sensor& sensor, std::span<const DepthFrame> frames,
                               const FrameMeetings& meeting, std::optional<double> support_plane,
                               const Suspicion& contradiction) {
  for (const Suspicion& unit : suspect_sensor(sensor)) {
    if (explains_frames(unit)) return unit;
  }
  if (Suspicion camera = suspect_camera(sensor.camera, meeting.rays()); !camera.kind.empty())
    return camera;
  if (Suspicion range = suspect_range(sensor, frames, meeting); !range.kind.empty()) return range;
  const bool has_copies = contradiction.kind == "same_image";
  // If some images are copies, shifted poses or rotated images can fit slightly better by chance.
  if (Suspicion known = suspect_convention(meeting, meeting.under({}), has_copies);
      !known.kind.empty()) {
    return known;
  }
  if (!contradiction.kind.empty() || !support_plane) return contradiction;
  return suspect_plane(frames, meeting, *support_plane);
}

Suspicion suspect_frames(const Sensor& sensor, std::span<const DepthFrame> frames,
                         std::span<const Pose> T_world_camera) {
  if (frames.size() != T_world_camera.size()) refuse("one pose per frame is required");
  for (const DepthFrame& frame : frames) check_frame_size(frame, sensor.camera);
  std::vector<std::size_t> places(frames.size());
  std::iota(places.begin(), places.end(), std::size_t{0});
  const JumpEdgeFilter filter(sensor.camera, {}, {.num_threads = 1});
  const FrameMeetings meeting(sensor, filter, frames, T_world_camera, std::move(places));
  return detail::suspicion_of(sensor, frames, meeting, {}, {});
}

Suspicion suspect_poses(const std::shared_ptr<const VoxelScene>& scene, const Sensor& sensor,
                        std::span<const Pose> T_world_camera) {
  constexpr std::size_t kPoses = 100, kRays = 400;
  std::vector<Pose> poses;
  const std::size_t step = (T_world_camera.size() + kPoses - 1) / kPoses;
  for (std::size_t i = 0; i < T_world_camera.size(); i += step) poses.push_back(T_world_camera[i]);
  const double pixels = static_cast<double>(sensor.camera.width) * sensor.camera.height;
  const auto stride = static_cast<int>(std::max(1.0, std::sqrt(pixels / kRays)));
  const GainEvaluator evaluator(scene, sensor, {.model = GainModel::paper, .pixel_stride = stride});
  const auto share_seeing = [&](const Convention& reading) {
    std::size_t seeing = 0;
    for (const Pose& pose : poses) {
      const Pose& meant = reading.pose == nullptr ? pose : reading.pose(pose);
      seeing += evaluator.evaluate(meant).hits > 0 ? 1 : 0;
    }
    return static_cast<double>(seeing) / static_cast<double>(poses.size());
  };
  if (poses.empty()) return {};
  const double now = share_seeing({});
  if (now >= 0.5) return {};
  // Poses a few metres away are not in millimetres.
  const bool is_far = poses[0].translation().norm() > 10 * sensor.max_range;
  const std::string text = percent(1 - now) + " of the poses see no voxel of the map";
  std::vector<Fit> fits;
  for (const Convention& reading : detail::other_readings()) {
    if (reading.pose == nullptr ||
        (!is_far && std::string_view(reading.kind) == "pose_millimetres"))
      continue;
    if (const double share = share_seeing(reading); share > 0.8) fits.push_back({reading, share});
  }
  fits = best_of(std::move(fits), kAlike);
  if (fits.empty()) return {"no_voxel", text};
  return {fits[0].reading.kind, text + ". Perhaps " + words_of(fits) +
                                    "; the share would then be " + percent(1 - fits[0].agreement)};
}

}  // namespace viewgain
