// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0

// Chooses a set of views greedily on a constant map.
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <memory>
#include <numeric>
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

// A greedy choice of up to k views. If `config` is given, the choice ends when no view is worth its
// cost. If it is null, views cost nothing.
template <typename Chosen>
class GreedyChoice {
 public:
  GreedyChoice(const ViewDriver& driver, Chosen& chosen, std::span<const Pose> T_world_camera,
               std::size_t k, const TourConfig* config, const BatchControl& control)
      : driver_(driver),
        chosen_(chosen),
        poses_(T_world_camera),
        k_(std::min(k, poses_.size())),
        config_(config),
        control_(control),
        pricing_(config != nullptr ? *config : free_, poses_.size()),
        gains_(poses_.size()),
        scored_(poses_.size()),
        open_(poses_.size()) {
    std::iota(open_.begin(), open_.end(), std::size_t{0});
  }

  ViewTour run() {
    if (k_ == 0) return std::move(made_);
    if (control_.progress) control_.progress(0, k_);
    for (round_ = 1; round_ <= k_ && !open_.empty(); ++round_) {
      if (!update_gains() || open_.empty()) break;
      const auto winner =
          std::min_element(open_.begin(), open_.end(), [&](std::size_t a, std::size_t b) {
            if ((scored_[a] == round_) != (scored_[b] == round_)) return scored_[a] == round_;
            return is_better(a, b);
          });
      const std::size_t index = *winner;
      if (!is_worth_it(index)) {
        if (control_.progress) control_.progress(k_, k_);
        break;
      }
      open_.erase(winner);
      take(index);
    }
    made_.tour = pricing_.tour();
    return std::move(made_);
  }

 private:
  template <typename Gain>
  bool score_by(std::span<const std::size_t> indices, std::size_t round, const Gain& gain) {
    made_.set.complete = detail::for_each(driver_, indices.size(), control_,
                                          [&](std::size_t j, ViewDriver::Lease& lease) {
                                            const std::size_t i = indices[j];
                                            gains_[i] = gain(i, lease);
                                            scored_[i] = round;
                                          });
    made_.set.evaluations += indices.size();
    return made_.set.complete;
  }
  bool score(std::span<const std::size_t> indices) {
    return score_by(indices, round_, [&](std::size_t i, ViewDriver::Lease& lease) {
      return chosen_.after(i, poses_[i], lease);
    });
  }
  // Lowers the bounds of poses of earlier rounds if that is faster than scoring them again.
  bool tighten(std::span<const std::size_t> indices) {
    if constexpr (Chosen::kTightens) {
      made_.set.complete = detail::for_each(
          driver_, indices.size(), control_, [&](std::size_t j, ViewDriver::Lease& lease) {
            const std::size_t i = indices[j];
            const double bound = chosen_.tighter(poses_[i], lease).gain;
            gains_[i].gain = std::min(gains_[i].gain, bound * Chosen::kBoundFactor);
          });
      made_.set.evaluations += indices.size();
    }
    return made_.set.complete;
  }

  [[nodiscard]] bool is_better(std::size_t a, std::size_t b) const {
    const double of_a = pricing_.rank(a, gains_[a].gain), of_b = pricing_.rank(b, gains_[b].gain);
    if (of_a != of_b) return of_a > of_b;
    return gains_[a].gain != gains_[b].gain ? gains_[a].gain > gains_[b].gain : a < b;
  }
  // Upper bound for a view of an earlier round.
  [[nodiscard]] double bound_of(std::size_t i) const {
    return pricing_.rank(i, gains_[i].gain * kRounding);
  }

  // Finds the largest gain of the round. False: stopped.
  bool update_gains() {
    const bool is_lazy = chosen_.is_lazy();
    if (round_ == 1) {
      if (!score_first()) return false;
    } else if (!is_lazy && !score(open_)) {
      return false;
    }
    return !is_lazy || score_lazily();
  }

  bool score_first() {
    const auto bound = [&](std::size_t i, ViewDriver::Lease& lease) {
      return chosen_.bound(i, poses_[i], lease);
    };
    if (!score_by(open_, Chosen::kBoundIsFirst ? 1 : 0, bound)) return false;
    std::erase_if(open_, [&](std::size_t i) {
      return std::isnan(gains_[i].gain) ||
             (config_ != nullptr && i != config_->first && !(gains_[i].gain > 0));
    });
    if (config_ != nullptr) made_.alone = gains_;
    for (ViewGain& gain : gains_) gain.gain *= Chosen::kBoundFactor;
    return true;
  }

  // Earlier gains are upper bounds: scores from the largest on until a current gain beats the rest.
  bool score_lazily() {
    std::sort(open_.begin(), open_.end(),
              [&](std::size_t a, std::size_t b) { return is_better(a, b); });
    double largest = kNoStop;
    for (std::size_t begin = 0; begin < open_.size() && bound_of(open_[begin]) >= largest;) {
      const std::size_t end = std::min(begin + kLazyBatch, open_.size());
      stale_.assign(open_.begin() + static_cast<std::ptrdiff_t>(begin),
                    open_.begin() + static_cast<std::ptrdiff_t>(end));
      std::erase_if(stale_, [&](std::size_t i) { return scored_[i] == round_; });
      if (round_ > 1 && !tighten(stale_)) return false;
      std::erase_if(stale_, [&](std::size_t i) { return bound_of(i) < largest; });
      if (!score(stale_)) return false;
      for (; begin < end; ++begin) {
        const std::size_t i = open_[begin];
        if (scored_[i] == round_) largest = std::max(largest, pricing_.rank(i, gains_[i].gain));
      }
    }
    return true;
  }

  [[nodiscard]] bool is_worth_it(std::size_t index) const {
    const bool is_given = config_ != nullptr && round_ == 1 && index == config_->first;
    if (config_ == nullptr || is_given) return true;
    const ViewGain& adds = gains_[index];
    if (!(adds.gain > 0) || pricing_.rank(index, adds.gain) == kNoStop) return false;
    return round_ == 1 ||
           !(pricing_.worth(index, adds.gain) <= 0 || adds.area < config_->least_area);
  }

  void take(std::size_t index) {
    made_.worth.push_back(pricing_.worth(index, gains_[index].gain));
    ViewSet& set = made_.set;
    set.indices.push_back(index);
    set.marginal.push_back(gains_[index]);
    set.gain += gains_[index].gain;
    if (control_.progress) control_.progress(round_, k_);
    ViewDriver::Lease lease(driver_);
    chosen_.choose(index, poses_[index], lease);
    pricing_.choose(index);
  }

  const ViewDriver& driver_;
  Chosen& chosen_;
  std::span<const Pose> poses_;
  std::size_t k_;
  const TourConfig* config_;
  const BatchControl& control_;
  const TourConfig free_;  // of a choice without costs
  detail::WayPricing pricing_;
  std::vector<ViewGain> gains_;      // marginal gain in the round of scored_
  std::vector<std::size_t> scored_;  // round; 0: never
  std::vector<std::size_t> open_;    // poses that may be chosen
  std::vector<std::size_t> stale_;
  std::size_t round_ = 0;
  ViewTour made_;
};

template <typename Chosen>
ViewTour choose_greedily(const ViewDriver& driver, Chosen& chosen,
                         std::span<const Pose> T_world_camera, std::size_t k,
                         const TourConfig* config, const BatchControl& control) {
  return GreedyChoice<Chosen>(driver, chosen, T_world_camera, k, config, control).run();
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
