// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include "calibration/wall_calibration.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include "calibration/wall_fit.hpp"
#include "calibration/wall_frame.hpp"
#include "viewgain/core/error.hpp"
#include "viewgain/core/noise.hpp"
#include "viewgain/support/text.hpp"

namespace viewgain {
namespace {

using detail::InversePlane;
using detail::make_wall_frame;
using detail::WallFit;
using detail::WallFrame;

constexpr double kSameDistance = 1e-3;  // [m]
constexpr double kFew = 0.005;          // of the blocks at either end are too few to tell a curve

// Blocks of a frame in one step of the range.
struct Step {
  double weight = 0, before = 0, after = 0;  // sums
  double readings = 0;
};

// Sums over steps, weighted by readings.
struct Squares {
  double readings = 0, before = 0, after = 0, noise = 0;

  void add(const Step& step, double noise_scale) {
    readings += step.readings;
    before += step.readings * std::pow(step.before / step.weight, 2);
    after += step.readings * std::pow(step.after / step.weight, 2);
    noise += step.readings * noise_scale * noise_scale / step.weight;
  }
  void add(const Squares& other) {
    readings += other.readings;
    before += other.before;
    after += other.after;
    noise += other.noise;
  }
  [[nodiscard]] double rms(double sum) const { return std::sqrt(sum / readings); }
};

// What the other frames foretell of a frame.
Squares squares_of(const WallFit& fit, const WallFrame& frame, std::size_t f) {
  std::map<int, Step> steps;
  for (const WallFit::Foretold& block : fit.foretold(f)) {
    Step& step = steps[fit.basis().piece(block.true_range)];
    const double weight = fit.weight(f, block.block);
    step.weight += weight;
    step.before += weight * block.before;
    step.after += weight * block.after;
    step.readings += static_cast<double>(frame.blocks[block.block].readings);
  }
  Squares sum;
  for (const auto& [piece, step] : steps) sum.add(step, fit.noise_scale());
  return sum;
}

// Of all that is on the wall, within the frame alone.
double rms_on_wall(const WallFit& fit, const WallFrame& frame, std::size_t f) {
  double sum = 0, weights = 0;
  for (std::size_t b = 0; b < frame.blocks.size(); ++b) {
    const double off = frame.blocks[b].range - detail::range_to(fit.plane(f), frame.blocks[b].ray);
    if (fit.weight(f, b) == 0) continue;
    sum += static_cast<double>(frame.blocks[b].readings) * off * off;
    weights += static_cast<double>(frame.blocks[b].readings);
  }
  return weights > 0 ? std::sqrt(sum / weights) : 0.0;
}

double to_micrometre(double metres) { return std::round(metres * 1e6) / 1e6; }

RangeCalibration table_of(const WallFit& fit, double nearest, double farthest) {
  RangeCalibration calibration;
  const int steps = fit.basis().pieces();
  for (int i = 0; i <= steps; ++i) {
    const double range = nearest + (farthest - nearest) * i / steps;
    const double error = fit.error(range);
    calibration.table.push_back({to_micrometre(range + error), to_micrometre(error)});
  }
  calibration.validate();
  return calibration;
}

void check_enough(const std::vector<WallFrame>& frames) {
  const auto refuse = [](const std::string& what) {
    throw Error(ErrorCode::invalid_argument,
                "a calibration needs frames of a wall at two distances, " + what);
  };
  if (frames.size() < 2) refuse("not " + std::to_string(frames.size()) + " in all");
  const auto distance = [](const WallFrame& frame) { return 1 / frame.plane.z(); };
  const bool is_one = std::all_of(frames.begin(), frames.end(), [&](const WallFrame& frame) {
    return !frame.tilt_is_known &&
           std::abs(distance(frame) - distance(frames.front())) < kSameDistance;
  });
  if (is_one) refuse("all are at " + short_text(distance(frames.front())) + " m");
}

}  // namespace

struct WallCalibration::Impl {
  Sensor sensor;
  std::vector<Eigen::Vector3d> rays;
  std::vector<WallFrame> frames;
};

WallCalibration::WallCalibration(const Sensor& sensor) {
  sensor.validate();
  impl_ = std::make_unique<Impl>(Impl{sensor, sensor.camera.ray_table(), {}});
}
WallCalibration::~WallCalibration() = default;
WallCalibration::WallCalibration(WallCalibration&&) noexcept = default;
WallCalibration& WallCalibration::operator=(WallCalibration&&) noexcept = default;

void WallCalibration::add(const DepthFrame& frame, double distance, std::string name) {
  check_frame_size(frame, impl_->sensor.camera);
  if (!(distance > 0) || !std::isfinite(distance)) {
    throw Error(
        ErrorCode::invalid_argument,
        name + ": the wall's distance " + short_text(distance) + " m must be positive and finite");
  }
  impl_->frames.push_back(
      make_wall_frame(impl_->sensor, impl_->rays, frame, {}, distance, std::move(name)));
}

void WallCalibration::add(const DepthFrame& frame, const Eigen::Vector3d& normal_camera,
                          double offset, std::string name) {
  check_frame_size(frame, impl_->sensor.camera);
  const InversePlane plane = normal_camera / offset;
  if (!plane.allFinite() || plane.isZero(0)) {
    throw Error(ErrorCode::invalid_argument,
                name + ": the wall is no plane, or the camera is in it");
  }
  impl_->frames.push_back(
      make_wall_frame(impl_->sensor, impl_->rays, frame, plane, 1 / plane.z(), std::move(name)));
}

WallCalibrationResult WallCalibration::solve() const {
  const std::vector<WallFrame>& frames = impl_->frames;
  check_enough(frames);
  WallFit fit(frames, std::min(impl_->sensor.max_range, unambiguous_range(impl_->sensor.noise)));
  fit.run();

  WallCalibrationResult result;
  std::vector<double> seen;  // true ranges [m]
  Squares all;
  for (std::size_t f = 0; f < frames.size(); ++f) {
    const WallFrame& frame = frames[f];
    const InversePlane& plane = fit.plane(f);
    WallFrameFigures figures;
    figures.name = frame.name;
    figures.distance = 1 / plane.z();
    figures.tilt = std::acos(std::min(1.0, std::abs(plane.z()) / plane.norm()));
    figures.border = frame.border;
    figures.sparse = frame.sparse;
    figures.limits = frame.limits;
    for (std::size_t b = 0; b < frame.blocks.size(); ++b) {
      const bool is_used = fit.weight(f, b) > 0;
      (is_used ? figures.used : figures.off_wall) += frame.blocks[b].readings;
      if (is_used) seen.push_back(detail::range_to(plane, frame.blocks[b].ray));
    }
    if (figures.used <= figures.off_wall) {
      throw Error(ErrorCode::invalid_argument,
                  frame.name +
                      ": most of its readings do not fit to the other frames'; is its wall " +
                      "where it is said to be?");
    }
    const Squares own = squares_of(fit, frame, f);
    figures.rms_before = rms_on_wall(fit, frame, f);
    if (own.readings > 0) {
      figures.rms_before = own.rms(own.before);
      figures.rms_after = own.rms(own.after);
    }
    all.add(own);
    result.frames.push_back(std::move(figures));
  }
  std::sort(seen.begin(), seen.end());
  const auto few = static_cast<std::size_t>(kFew * static_cast<double>(seen.size()));
  seen = {seen.begin() + static_cast<std::ptrdiff_t>(few),
          seen.end() - static_cast<std::ptrdiff_t>(few)};
  result.nearest = seen.front();
  result.farthest = seen.back();
  for (std::size_t i = 1; i < seen.size(); ++i) {
    result.widest_gap = std::max(result.widest_gap, seen[i] - seen[i - 1]);
  }
  if (all.readings > 0) {
    result.rms_before = all.rms(all.before);
    result.rms_after = all.rms(all.after);
    result.rms_noise = all.rms(all.noise);
  }
  result.calibration = table_of(fit, result.nearest, result.farthest);
  return result;
}

}  // namespace viewgain
