// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0

// Views that are good together, chosen greedily on a frozen map.
#include <algorithm>
#include <cmath>
#include <unordered_map>

#include "choose/surface_set.hpp"
#include "gain/batch_loop.hpp"
#include "gain/gain_evaluator_impl.hpp"
#include "viewgain/core/criterion.hpp"

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

// The same by the paper's gain as SurfaceSet by the others.
class PaperSet {
 public:
  explicit PaperSet(const ViewDriver& driver) : driver_(driver) {}

  // Is a pose scored anew only while its earlier gain could win?
  [[nodiscard]] bool is_lazy() const {
    return driver_.settings().criterion == Criterion::log_determinant;
  }
  // Before any is chosen what a view adds is the first round's result.
  static constexpr bool kBoundIsFirst = true;
  [[nodiscard]] ViewGain bound(std::size_t i, const Pose& T_world_camera,
                               ViewDriver::Lease& lease) const {
    return after(i, T_world_camera, lease);
  }
  [[nodiscard]] ViewGain after(std::size_t /*i*/, const Pose& T_world_camera,
                               ViewDriver::Lease& lease) const {
    return driver_.view(T_world_camera, lease,
                        AfterOthersConsumer{{lease.accumulator()}, driver_.settings(), chosen_});
  }
  void choose(std::size_t /*i*/, const Pose& T_world_camera, ViewDriver::Lease& lease) {
    driver_.view(T_world_camera, lease, ChosenConsumer{{lease.accumulator()}, chosen_});
  }

 private:
  const ViewDriver& driver_;
  Overlay chosen_;
};

template <typename Chosen>
ViewSet choose_greedily(const ViewDriver& driver, Chosen& chosen,
                        std::span<const Pose> T_world_camera, std::size_t k,
                        const BatchControl& control) {
  const std::size_t count = T_world_camera.size();
  k = std::min(k, count);
  ViewSet set;
  if (k == 0) return set;
  if (control.progress) control.progress(0, k);
  const bool lazy = chosen.is_lazy();
  std::vector<ViewGain> gains(count);     // marginal, as of round[i]
  std::vector<std::size_t> round(count);  // 0: never scored
  std::vector<std::size_t> open(count);   // poses that may be chosen
  std::vector<std::size_t> stale;
  for (std::size_t i = 0; i < count; ++i) open[i] = i;
  const auto score_by = [&](std::span<const std::size_t> indices, std::size_t now, auto&& gain) {
    set.complete = detail::for_each(driver, indices.size(), control,
                                    [&](std::size_t j, ViewDriver::Lease& lease) {
                                      const std::size_t i = indices[j];
                                      gains[i] = gain(i, lease);
                                      round[i] = now;
                                    });
    set.evaluations += indices.size();
    return set.complete;
  };
  const auto score = [&](std::span<const std::size_t> indices, std::size_t now) {
    return score_by(indices, now, [&](std::size_t i, ViewDriver::Lease& lease) {
      return chosen.after(i, T_world_camera[i], lease);
    });
  };
  const auto better = [&](std::size_t a, std::size_t b) {
    return gains[a].gain != gains[b].gain ? gains[a].gain > gains[b].gain : a < b;
  };

  for (std::size_t now = 1; now <= k && !open.empty(); ++now) {
    if (now == 1) {
      const auto bound = [&](std::size_t i, ViewDriver::Lease& lease) {
        return chosen.bound(i, T_world_camera[i], lease);
      };
      if (!score_by(open, Chosen::kBoundIsFirst ? 1 : 0, bound)) return set;
      std::erase_if(open, [&](std::size_t i) { return std::isnan(gains[i].gain); });
      if (open.empty()) break;
    } else if (!lazy) {
      if (!score(open, now)) return set;
    }
    if (lazy) {
      // Earlier gains bound those of now: score from the largest on until one of now beats the
      // rest.
      std::sort(open.begin(), open.end(), better);
      double largest = -1;
      for (std::size_t begin = 0;
           begin < open.size() && gains[open[begin]].gain * kRounding >= largest;) {
        const std::size_t end = std::min(begin + kLazyBatch, open.size());
        stale.assign(open.begin() + static_cast<std::ptrdiff_t>(begin),
                     open.begin() + static_cast<std::ptrdiff_t>(end));
        std::erase_if(stale, [&](std::size_t i) { return round[i] == now; });
        if (!score(stale, now)) return set;
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

    ViewDriver::Lease lease(driver);
    chosen.choose(index, T_world_camera[index], lease);
  }
  return set;
}

}  // namespace

ViewSet GainEvaluator::best_set(std::span<const Pose> T_world_camera, std::size_t k,
                                const BatchControl& control) const {
  const ViewDriver& driver = impl_->driver;
  if (driver.surface() == nullptr) {
    PaperSet chosen(driver);
    ViewSet set = choose_greedily(driver, chosen, T_world_camera, k, control);
    set.gain_by_best_alone = set.gain;
    return set;
  }
  detail::SurfaceSet chosen(driver, T_world_camera.size());
  ViewSet set = choose_greedily(driver, chosen, T_world_camera, k, control);
  set.gain_by_best_alone = chosen.by_best_alone();
  return set;
}

}  // namespace viewgain
