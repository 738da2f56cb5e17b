// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0

// Chooses a set of views greedily on a constant map.
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <memory>
#include <optional>
#include <unordered_map>

#include "choose/surface_set.hpp"
#include "choose/way_pricing.hpp"
#include "gain/gain_evaluator_impl.hpp"
#include "gain/sampled_views.hpp"
#include "viewgain/core/criterion.hpp"
#include "viewgain/raycast/view_tour.hpp"

namespace viewgain {
namespace {

using detail::ViewDriver;

using Overlay = std::unordered_map<std::uint64_t, SymmetricMatrix3>;

// A gain of an earlier round is an upper bound, except that sums in different orders are rounded
// differently.
constexpr double kRounding = 1 + 1e-9;
// Number of poses that lazy evaluation scores together, independent of the number of threads.
constexpr std::size_t kLazyBatch = 8;
constexpr double kNoStop = -std::numeric_limits<double>::infinity();

double log_of_diagonal(const SymmetricMatrix3& sigma) {
  return std::log(sigma.xx) + std::log(sigma.yy) + std::log(sigma.zz);
}

// Marginal gain of a view, from the information that its rays add to each voxel.
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

// Adds the information of a view's rays in each voxel to that of the chosen views.
struct ChosenConsumer : detail::GainConsumer {
  Overlay& chosen;

  void finish(ViewGain&) {
    accumulator.visit([&](std::uint64_t key, const std::optional<detail::VoxelSum>&,
                          const detail::VoxelSum& sum,
                          double) { chosen[key] += detail::matrix_of(sum); });
  }
};

// Counterpart of SurfaceSet for the paper's gain.
class PaperSet {
 public:
  explicit PaperSet(const ViewDriver& driver) : driver_(driver) {}

  // Whether poses are scored again only while their earlier gain could win.
  [[nodiscard]] bool is_lazy() const {
    return driver_.settings().criterion == Criterion::log_determinant;
  }
  // Before the first choice, the marginal gain is the result of the first round.
  static constexpr bool kBoundIsFirst = true;
  static constexpr double kBoundFactor = 1;
  static constexpr bool kTightens = false;
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

// With `config` the choice ends when no view is worth its cost. If it is null, nothing costs, and k
// views are chosen.
template <typename Chosen>
ViewTour choose_greedily(const ViewDriver& driver, Chosen& chosen,
                         std::span<const Pose> T_world_camera, std::size_t k,
                         const TourConfig* config, const BatchControl& control) {
  const std::size_t count = T_world_camera.size();
  const TourConfig free;
  detail::WayPricing pricing(config != nullptr ? *config : free, count);
  k = std::min(k, count);
  ViewTour made;
  ViewSet& set = made.set;
  if (k == 0) return made;
  if (control.progress) control.progress(0, k);
  const bool lazy = chosen.is_lazy();
  std::vector<ViewGain> gains(count);     // marginal gain in round[i]
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
  // Lowers the bounds of poses of earlier rounds if that is faster than scoring them again.
  const auto tighten = [&](std::span<const std::size_t> indices) {
    if constexpr (Chosen::kTightens) {
      set.complete = detail::for_each(
          driver, indices.size(), control, [&](std::size_t j, ViewDriver::Lease& lease) {
            const std::size_t i = indices[j];
            const double bound = chosen.tighter(T_world_camera[i], lease).gain;
            gains[i].gain = std::min(gains[i].gain, bound * Chosen::kBoundFactor);
          });
      set.evaluations += indices.size();
    }
    return set.complete;
  };
  const auto better = [&](std::size_t a, std::size_t b) {
    const double of_a = pricing.rank(a, gains[a].gain), of_b = pricing.rank(b, gains[b].gain);
    if (of_a != of_b) return of_a > of_b;
    return gains[a].gain != gains[b].gain ? gains[a].gain > gains[b].gain : a < b;
  };
  // Upper bound for a view of an earlier round.
  const auto bound_of = [&](std::size_t i) { return pricing.rank(i, gains[i].gain * kRounding); };
  const auto finished = [&] {
    made.tour = pricing.tour();
    return std::move(made);
  };

  for (std::size_t now = 1; now <= k && !open.empty(); ++now) {
    if (now == 1) {
      const auto bound = [&](std::size_t i, ViewDriver::Lease& lease) {
        return chosen.bound(i, T_world_camera[i], lease);
      };
      if (!score_by(open, Chosen::kBoundIsFirst ? 1 : 0, bound)) return finished();
      std::erase_if(open, [&](std::size_t i) {
        return std::isnan(gains[i].gain) ||
               (config != nullptr && i != config->first && !(gains[i].gain > 0));
      });
      if (config != nullptr) made.alone = gains;
      for (ViewGain& gain : gains) gain.gain *= Chosen::kBoundFactor;
      if (open.empty()) break;
    } else if (!lazy) {
      if (!score(open, now)) return finished();
    }
    if (lazy) {
      // Earlier gains are upper bounds: score from the largest on until a current gain beats the
      // rest.
      std::sort(open.begin(), open.end(), better);
      double largest = kNoStop;
      for (std::size_t begin = 0; begin < open.size() && bound_of(open[begin]) >= largest;) {
        const std::size_t end = std::min(begin + kLazyBatch, open.size());
        stale.assign(open.begin() + static_cast<std::ptrdiff_t>(begin),
                     open.begin() + static_cast<std::ptrdiff_t>(end));
        std::erase_if(stale, [&](std::size_t i) { return round[i] == now; });
        if (now > 1 && !tighten(stale)) return finished();
        std::erase_if(stale, [&](std::size_t i) { return bound_of(i) < largest; });
        if (!score(stale, now)) return finished();
        for (; begin < end; ++begin) {
          const std::size_t i = open[begin];
          if (round[i] == now) largest = std::max(largest, pricing.rank(i, gains[i].gain));
        }
      }
    }
    const auto winner =
        std::min_element(open.begin(), open.end(), [&](std::size_t a, std::size_t b) {
          if ((round[a] == now) != (round[b] == now)) return round[a] == now;
          return better(a, b);
        });
    const std::size_t index = *winner;
    const ViewGain& adds = gains[index];
    const bool is_given = config != nullptr && now == 1 && index == config->first;
    if (config != nullptr && !is_given &&
        (!(adds.gain > 0) || pricing.rank(index, adds.gain) == kNoStop ||
         (now > 1 && (pricing.worth(index, adds.gain) <= 0 || adds.area < config->least_area)))) {
      if (control.progress) control.progress(k, k);
      break;
    }
    made.worth.push_back(pricing.worth(index, adds.gain));
    open.erase(winner);
    set.indices.push_back(index);
    set.marginal.push_back(gains[index]);
    set.gain += gains[index].gain;
    if (control.progress) control.progress(now, k);

    ViewDriver::Lease lease(driver);
    chosen.choose(index, T_world_camera[index], lease);
    pricing.choose(index);
  }
  return finished();
}

ViewTour choose_by(const ViewDriver& driver, std::span<const Pose> T_world_camera, std::size_t k,
                   const TourConfig* config, const BatchControl& control) {
  if (driver.surface() == nullptr) {
    PaperSet chosen(driver);
    ViewTour made = choose_greedily(driver, chosen, T_world_camera, k, config, control);
    made.set.gain_by_best_alone = made.set.gain;
    return made;
  }
  detail::SurfaceSet chosen(driver, T_world_camera.size());
  ViewTour made = choose_greedily(driver, chosen, T_world_camera, k, config, control);
  made.set.gain_by_best_alone = chosen.by_best_alone();
  return made;
}

// Two views are similar if they are nearer than this fraction of the working distance and the
// cosine between their directions is larger. The first, wider limits spread views over all sides of
// the object.
struct Alike {
  double distance, same_way;
};
constexpr std::array kAlike{Alike{0.3, 0.866}, Alike{0.1, 0.966}};
constexpr double kFewRays = 400;

// The poses with the largest estimated gain minus their own cost, without similar ones.
std::vector<std::size_t> promising(const GainEvaluator& evaluator,
                                   std::span<const Pose> T_world_camera, const TourConfig& config,
                                   const BatchControl& control) {
  const std::size_t count = T_world_camera.size();
  std::vector<ApproximateGain> estimates(count);
  const double share = std::min(1.0, kFewRays / static_cast<double>(evaluator.rays_per_pose()));
  evaluator.approximate(T_world_camera, estimates, {.share = share},
                        {.stop = control.stop, .is_cancelled = control.is_cancelled});
  std::vector<double> worth(count);
  std::vector<std::size_t> order;
  for (std::size_t i = 0; i < count; ++i) {
    worth[i] = estimates[i].gain - (config.costs.empty() ? 0 : config.costs[i]);
    if (!std::isnan(worth[i])) order.push_back(i);
  }
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return worth[a] > worth[b]; });
  const double unit = detail::EvaluatorAccess::driver(evaluator).core()->working_distance;
  std::vector<std::size_t> chosen;
  if (config.first) chosen.push_back(*config.first);
  for (const Alike& alike : kAlike) {
    for (const std::size_t i : order) {
      if (chosen.size() == config.max_candidates) break;
      const Pose& pose = T_world_camera[i];
      const bool is_new = std::none_of(chosen.begin(), chosen.end(), [&](std::size_t j) {
        const Pose& other = T_world_camera[j];
        return (pose.translation() - other.translation()).norm() < alike.distance * unit &&
               pose.rotation().col(2).dot(other.rotation().col(2)) > alike.same_way;
      });
      if (is_new) chosen.push_back(i);
    }
  }
  std::sort(chosen.begin(), chosen.end());
  return chosen;
}

}  // namespace

ViewSet GainEvaluator::best_set(std::span<const Pose> T_world_camera, std::size_t k,
                                const BatchControl& control) const {
  return choose_by(impl_->driver, T_world_camera, k, nullptr, control).set;
}

ViewTour plan_tour(const GainEvaluator& evaluator, std::span<const Pose> T_world_camera,
                   const TourConfig& config, const BatchControl& control) {
  const ViewDriver& driver = detail::EvaluatorAccess::driver(evaluator);
  detail::check_tour(config, T_world_camera.size());
  const detail::EvaluatorCore& full = *driver.core();
  const int step = driver.surface() == nullptr ? 1 : detail::step_for_share(full, config.share);
  std::optional<ViewDriver> some;
  if (step > 1) {
    some.emplace(evaluator.scene(),
                 std::make_shared<detail::EvaluatorCore>(full, detail::centred_lattice(full, step),
                                                         full.pool.num_threads()));
  }
  const ViewDriver& by = some ? *some : driver;
  if (T_world_camera.size() <= config.max_candidates) {
    return choose_by(by, T_world_camera, config.max_stops, &config, control);
  }
  const std::vector<std::size_t> looked_at = promising(evaluator, T_world_camera, config, control);
  std::vector<Pose> poses;
  std::vector<double> costs;
  for (const std::size_t i : looked_at) {
    poses.push_back(T_world_camera[i]);
    if (!config.costs.empty()) costs.push_back(config.costs[i]);
  }
  TourConfig own = config;
  own.costs = costs;
  if (config.first) {
    own.first = static_cast<std::size_t>(
        std::lower_bound(looked_at.begin(), looked_at.end(), *config.first) - looked_at.begin());
  }
  if (config.way) {
    own.way = [&](std::size_t from, std::size_t to) {
      return config.way(from == kTourStart ? from : looked_at[from], looked_at[to]);
    };
  }
  ViewTour made = choose_by(by, poses, own.max_stops, &own, control);
  for (std::size_t& i : made.set.indices) i = looked_at[i];
  ViewGain none;
  none.gain = none.area = std::numeric_limits<double>::quiet_NaN();
  std::vector<ViewGain> alone(T_world_camera.size(), none);
  for (std::size_t j = 0; j < made.alone.size(); ++j) alone[looked_at[j]] = made.alone[j];
  made.alone = std::move(alone);
  return made;
}

}  // namespace viewgain
