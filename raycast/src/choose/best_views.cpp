// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0

// The best views of a batch, exactly, by upper bounds.
#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <numeric>

#include "gain/gain_evaluator_impl.hpp"
#include "viewgain/core/error.hpp"

namespace viewgain {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
// Bounds are sums in another order than the gains (DESIGN.md section 6).
constexpr double kBoundSlack = 1 + 1e-5;
// Poses that are scored against the same gain to beat, whatever the number of threads: few at
// first, when every score may raise it.
constexpr std::size_t kFirstRound = 8, kLastRound = 64;
// A look at the bound of a view that is being traced costs a sum over the voxels touched.
constexpr std::size_t kRowsBetweenLooks = 2;
// Poses of a sample, the size of a batch, in samples, that makes one worth while, and about what a
// pose's bound costs as a share of its score.
constexpr std::size_t kSample = 16, kWorthASample = 8;
constexpr double kBoundCost = 0.35;

}  // namespace

const detail::ViewBounds& GainEvaluator::Impl::bounds() const {
  std::call_once(bounds_once, [this] {
    bounds_made.emplace(data, settings, tracer.table(), camera, pixel_stride, min_range, max_range);
  });
  return *bounds_made;
}

bool GainEvaluator::Impl::bound(const Pose& T_world_camera, std::span<double> from,
                                Lease& lease) const {
  const auto frame = tracer.frame_of(T_world_camera);
  if (!frame || frame->sees_nothing || is_in_occupied(*frame)) return false;
  return bounds().bound(*frame, lease.get().bounding, from);
}

GainEvaluator::Impl::Attempt GainEvaluator::Impl::evaluate_above(const Pose& T_world_camera,
                                                                 std::span<const double> from,
                                                                 double gain_to_beat,
                                                                 double gain_per_bound,
                                                                 Lease& lease) const {
  Attempt attempt;
  auto& [accumulator, bins, bounding, view_hits] = lease.get();
  const auto frame = tracer.frame_of(T_world_camera);
  if (!from.empty()) tracer.sort(*frame, bins);
  if (from.empty() || !bins.valid()) {
    attempt.result = evaluate(T_world_camera, lease);
    if (attempt.result.status == ViewStatus::ok && !frame->sees_nothing) attempt.rays = ray_count;
    return attempt;
  }
  const detail::TileTable& table = tracer.table();
  const std::size_t row_count = bounds().row_count();
  const std::size_t columns = table.tile_count / row_count;
  accumulator.begin();
  detail::RayTile tile;
  std::size_t next_look = 1;
  for (std::size_t row = 0; row < row_count; ++row) {
    const double left = from[row], done = from[0] - left;
    if (row >= next_look && gain_per_bound * done + left < gain_to_beat) {
      const double gained = accumulator.upper_bound();
      if ((gained + left) * kBoundSlack < gain_to_beat) {
        attempt.abandoned = true;
        return attempt;
      }
      if (done > 0) gain_per_bound = gained / done;
      next_look = row + kRowsBetweenLooks;
    }
    for (std::size_t column = 0; column < columns; ++column) {
      const std::size_t number = row * columns + column;
      if (bins.boxes_of(number).empty()) continue;
      tracer.trace_tile(*frame, number, bins, tile);
      accumulator.add(tile);
      attempt.rays += static_cast<std::uint64_t>(std::popcount(table.valid[number]));
    }
  }
  attempt.result.rays = ray_count;
  accumulator.finish(attempt.result);
  attempt.result.status = ViewStatus::ok;
  return attempt;
}

BestViews GainEvaluator::best(std::span<const Pose> T_world_camera, std::size_t k,
                              const BatchControl& control) const {
  const std::size_t count = T_world_camera.size();
  k = std::min(k, count);
  BestViews best;
  if (k == 0) return best;
  if (control.progress) control.progress(0, count);

  // The bounds of each pose's rows of tiles, and of the whole pose; where a sample of the poses
  // says that bounding all would cost more than it saves, of none.
  const std::size_t rows = impl_->bounds().row_count() + 1;
  std::vector<double> from;
  std::vector<double> bounds(count, kInfinity);
  if (impl_->bounds().usable() && k < count) {
    from.resize(rows * count);
    const auto bound = [&](std::size_t i, Impl::Lease& lease) {
      const std::span own(&from[i * rows], rows);
      if (impl_->bound(T_world_camera[i], own, lease)) bounds[i] = own[0];
    };
    bool pays = true;
    if (count >= kWorthASample * kSample) {
      std::vector<double> gains(kSample);
      best.complete = impl_->for_each(kSample, 1, control, [&](std::size_t j, Impl::Lease& lease) {
        const std::size_t i = j * count / kSample;
        bound(i, lease);
        gains[j] = impl_->evaluate(T_world_camera[i], lease).gain;
        if (std::isnan(gains[j])) gains[j] = 0;
      });
      best.rays_traced += kSample * std::uint64_t{impl_->ray_count};
      const double largest = *std::max_element(gains.begin(), gains.end());
      double share = 0;
      for (std::size_t j = 0; j < kSample; ++j) {
        const double b = bounds[j * count / kSample];
        // What is traced before the bound, which falls as it is replaced by gains, is too low.
        if (!(b > largest)) continue;
        share +=
            b < kInfinity ? std::min(1.0, (b - largest) / std::max(b - gains[j], 1e-9 * b)) : 1.0;
      }
      pays = share / static_cast<double>(kSample) + kBoundCost < 1;
    }
    if (pays) {
      best.complete = best.complete && impl_->for_each(count, 8, control, bound);
    } else {
      std::fill(bounds.begin(), bounds.end(), kInfinity);
    }
  }
  std::vector<std::size_t> order(count);
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return bounds[a] > bounds[b]; });

  std::vector<Impl::Attempt> attempts(count);
  std::vector<std::uint8_t> tried(count, 0);
  std::vector<double> leaders;  // the k largest gains so far, largest first
  double bound_sum = 0, gain_sum = 0;
  std::size_t size = kFirstRound;
  for (std::size_t begin = 0; begin < count && best.complete;
       size = std::min(2 * size, kLastRound)) {
    const double to_beat = leaders.size() == k ? leaders.back() : -kInfinity;
    const double gain_per_bound = bound_sum > 0 ? gain_sum / bound_sum : 1.0;
    std::size_t end = begin;
    while (end < count && end - begin < size && !(bounds[order[end]] * kBoundSlack < to_beat))
      ++end;
    if (end == begin) break;  // nor can any later one
    best.complete =
        impl_->for_each(end - begin, 1, control, [&](std::size_t j, Impl::Lease& lease) {
          const std::size_t i = order[begin + j];
          std::span<const double> own;
          if (bounds[i] < kInfinity) own = {&from[i * rows], rows};
          attempts[i] =
              impl_->evaluate_above(T_world_camera[i], own, to_beat, gain_per_bound, lease);
          tried[i] = 1;
        });
    for (; begin < end; ++begin) {
      const std::size_t i = order[begin];
      if (tried[i] == 0 || attempts[i].abandoned || std::isnan(attempts[i].result.gain)) continue;
      const double gain = attempts[i].result.gain;
      if (bounds[i] < kInfinity) bound_sum += bounds[i], gain_sum += gain;
      leaders.insert(std::upper_bound(leaders.begin(), leaders.end(), gain, std::greater<>()),
                     gain);
      if (leaders.size() > k) leaders.pop_back();
    }
    if (control.progress) control.progress(begin, count);
  }

  for (std::size_t i = 0; i < count; ++i) {
    if (tried[i] == 0) continue;
    best.rays_traced += attempts[i].rays;
    if (attempts[i].abandoned) continue;
    best.scored_indices.push_back(i);
    best.scored_gains.push_back(attempts[i].result);
  }
  for (const std::size_t j : best_indices(best.scored_gains, k)) {
    best.indices.push_back(best.scored_indices[j]);
    best.gains.push_back(best.scored_gains[j]);
  }
  if (control.progress && best.complete) control.progress(count, count);
  return best;
}

}  // namespace viewgain
