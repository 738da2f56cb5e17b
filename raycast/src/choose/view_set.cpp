// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0

// Views that are good together, chosen greedily on a frozen map.
#include <algorithm>
#include <cmath>
#include <unordered_map>

#include "gain/gain_evaluator_impl.hpp"

namespace viewgain {
namespace {

using Overlay = std::unordered_map<std::uint64_t, SymmetricMatrix3>;

// Gains are sums in two different orders; a gain of an earlier round is a bound but for that.
constexpr double kRounding = 1 + 1e-9;
// Poses that are scored anew together in lazy evaluation, whatever the number of threads.
constexpr std::size_t kLazyBatch = 8;

double log_of_diagonal(const SymmetricMatrix3& sigma) {
  return std::log(sigma.xx) + std::log(sigma.yy) + std::log(sigma.zz);
}

}  // namespace

ViewGain GainEvaluator::Impl::evaluate_after(
    const Pose& T_world_camera, const std::unordered_map<std::uint64_t, SymmetricMatrix3>& chosen,
    Lease& lease) const {
  ViewGain result = evaluate(T_world_camera, lease);
  if (chosen.empty() || result.status != ViewStatus::ok || result.hits == 0) return result;
  result.exploration = result.refinement = result.posterior_entropy = 0;
  lease.get().accumulator.visit([&](std::uint64_t key, const std::optional<detail::VoxelSum>& known,
                                    const detail::VoxelSum& sum, double weight) {
    SymmetricMatrix3 held{};
    if (known) held = detail::matrix_of(*known);
    const auto before = chosen.find(key);
    if (before != chosen.end()) held += before->second;
    const SymmetricMatrix3 added = detail::matrix_of(sum);
    const double gain =
        weight * entropy_reduction(held + SymmetricMatrix3::identity(settings.prior_information),
                                   added, settings.criterion);
    (known ? result.refinement : result.exploration) += gain;
    result.posterior_entropy += log_of_diagonal((held + added).inverse());
  });
  result.gain = result.exploration + result.refinement;
  return result;
}

ViewSet GainEvaluator::best_set(std::span<const Pose> T_world_camera, std::size_t k,
                                const BatchControl& control) const {
  const std::size_t count = T_world_camera.size();
  k = std::min(k, count);
  ViewSet set;
  if (k == 0) return set;
  if (control.progress) control.progress(0, k);
  const bool lazy = impl_->settings.criterion == Criterion::log_determinant;

  Overlay chosen;
  std::vector<ViewGain> gains(count);     // marginal, as of round[i]
  std::vector<std::size_t> round(count);  // 0: never scored
  std::vector<std::size_t> open(count);   // poses that may be chosen
  for (std::size_t i = 0; i < count; ++i) open[i] = i;
  const auto score = [&](std::span<const std::size_t> indices, std::size_t now) {
    set.complete =
        impl_->for_each(indices.size(), 1, control, [&](std::size_t j, Impl::Lease& lease) {
          gains[indices[j]] = impl_->evaluate_after(T_world_camera[indices[j]], chosen, lease);
          round[indices[j]] = now;
        });
    set.evaluations += indices.size();
    return set.complete;
  };
  const auto better = [&](std::size_t a, std::size_t b) {
    return gains[a].gain != gains[b].gain ? gains[a].gain > gains[b].gain : a < b;
  };

  for (std::size_t now = 1; now <= k && !open.empty(); ++now) {
    if (now == 1 || !lazy) {
      if (!score(open, now)) return set;
      std::erase_if(open, [&](std::size_t i) { return std::isnan(gains[i].gain); });
      if (open.empty()) break;
    } else {
      // Earlier gains bound those of now: score from the largest on until one of now beats the
      // rest.
      std::sort(open.begin(), open.end(), better);
      double largest = -1;
      for (std::size_t begin = 0;
           begin < open.size() && gains[open[begin]].gain * kRounding >= largest;) {
        const std::size_t end = std::min(begin + kLazyBatch, open.size());
        if (!score({open.data() + begin, end - begin}, now)) return set;
        for (; begin < end; ++begin) largest = std::max(largest, gains[open[begin]].gain);
      }
    }
    const auto winner =
        std::min_element(open.begin(), open.end(), [&](std::size_t a, std::size_t b) {
          if ((round[a] == now) != (round[b] == now)) return round[a] == now;
          return better(a, b);
        });
    const std::size_t index = *winner;
    open.erase(winner);
    set.indices.push_back(index);
    set.marginal.push_back(gains[index]);
    set.gain += gains[index].gain;
    if (control.progress) control.progress(now, k);
    if (now == k) break;

    Impl::Lease lease(*impl_);
    if (impl_->evaluate(T_world_camera[index], lease).hits == 0) continue;
    lease.get().accumulator.visit([&](std::uint64_t key, const std::optional<detail::VoxelSum>&,
                                      const detail::VoxelSum& sum,
                                      double) { chosen[key] += detail::matrix_of(sum); });
  }
  return set;
}

}  // namespace viewgain
