// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0

// Views that are good together, chosen greedily on a frozen map.
#include <algorithm>
#include <cmath>
#include <string>
#include <unordered_map>

#include "gain/batch_loop.hpp"
#include "gain/gain_evaluator_impl.hpp"
#include "viewgain/core/criterion.hpp"
#include "viewgain/core/error.hpp"

namespace viewgain {
namespace {

using detail::ViewDriver;

using Overlay = std::unordered_map<std::uint64_t, SymmetricMatrix3>;

// Gains are sums in two different orders; a gain of an earlier round is a bound but for that.
constexpr double kRounding = 1 + 1e-9;
// Poses that are scored anew together in lazy evaluation, whatever the number of threads.
constexpr std::size_t kLazyBatch = 8;

double log_of_diagonal(const SymmetricMatrix3& sigma) {
  return std::log(sigma.xx) + std::log(sigma.yy) + std::log(sigma.zz);
}

// The gain of a view after others have been chosen, by what their rays bring to each voxel.
struct AfterOthersConsumer : detail::GainConsumer {
  const detail::GainSettings& settings;
  const Overlay& chosen;

  void finish(ViewGain& result) {
    GainConsumer::finish(result);
    if (chosen.empty() || result.hits == 0) return;
    result.exploration = result.refinement = 0;
    if (settings.posterior_entropy) result.posterior_entropy = 0;
    accumulator.visit([&](std::uint64_t key, const std::optional<detail::VoxelSum>& known,
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
      if (!settings.posterior_entropy) return;
      result.posterior_entropy += log_of_diagonal((held + added).inverse());
    });
    result.gain = result.exploration + result.refinement;
  }
};

// Adds what a view's rays bring to each voxel to what those chosen bring.
struct ChosenConsumer : detail::GainConsumer {
  Overlay& chosen;

  void finish(ViewGain&) {
    accumulator.visit([&](std::uint64_t key, const std::optional<detail::VoxelSum>&,
                          const detail::VoxelSum& sum,
                          double) { chosen[key] += detail::matrix_of(sum); });
  }
};

}  // namespace

ViewSet GainEvaluator::best_set(std::span<const Pose> T_world_camera, std::size_t k,
                                const BatchControl& control) const {
  if (impl_->driver.surface() != nullptr) {
    throw Error(ErrorCode::invalid_argument,
                "sets of views are chosen by the gain paper, not by " +
                    std::string(gain_model_name(impl_->driver.core()->config.model)));
  }
  const std::size_t count = T_world_camera.size();
  k = std::min(k, count);
  ViewSet set;
  if (k == 0) return set;
  if (control.progress) control.progress(0, k);
  const ViewDriver& driver = impl_->driver;
  const bool lazy = driver.settings().criterion == Criterion::log_determinant;

  Overlay chosen;
  std::vector<ViewGain> gains(count);     // marginal, as of round[i]
  std::vector<std::size_t> round(count);  // 0: never scored
  std::vector<std::size_t> open(count);   // poses that may be chosen
  for (std::size_t i = 0; i < count; ++i) open[i] = i;
  const auto score = [&](std::span<const std::size_t> indices, std::size_t now) {
    set.complete = detail::for_each(
        driver, indices.size(), control, [&](std::size_t j, ViewDriver::Lease& lease) {
          const std::size_t i = indices[j];
          gains[i] =
              driver.view(T_world_camera[i], lease,
                          AfterOthersConsumer{{lease.accumulator()}, driver.settings(), chosen});
          round[i] = now;
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

    ViewDriver::Lease lease(driver);
    driver.view(T_world_camera[index], lease, ChosenConsumer{{lease.accumulator()}, chosen});
  }
  return set;
}

}  // namespace viewgain
