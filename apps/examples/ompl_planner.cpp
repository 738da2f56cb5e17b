// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0

// Where to go for the next view: OMPL's Informed RRT* finds the path with the largest expected gain
// per metre. A view is worth  gain(end of the path) / (length of the path + kViewLength).
//
//   ompl_planner [ITERATIONS]        exit codes: 0, 2 for bad input
#include <ompl/base/OptimizationObjective.h>
#include <ompl/base/spaces/SE3StateSpace.h>
#include <ompl/base/terminationconditions/IterationTerminationCondition.h>
#include <ompl/geometric/PathGeometric.h>
#include <ompl/geometric/planners/rrt/InformedRRTstar.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cstdio>
#include <map>
#include <memory>
#include <mutex>
#include <string_view>
#include <vector>
#include <viewgain/viewgain.hpp>

namespace {

namespace ob = ompl::base;
using Eigen::Vector3d;
using viewgain::Pose;

constexpr double kViewLength = 0.3;  // taking a view costs as much as driving this far [m]
const Vector3d kObject(0, 0, 0.45);  // its middle [m]

// A map as a robot may have it: an object whose front alone has been seen, behind a screen.
viewgain::BeliefGrid make_map() {
  viewgain::BeliefGrid map(
      {.voxel_size = 0.02, .workspace = {{-0.8, -0.8, 0}, {0.8, 0.8, 0.9}}, .prior_sigma = 0.01});
  const viewgain::Belief well_known{.information = {1e8F, 1e8F, 1e8F}, .hits = 500};
  std::vector<viewgain::BeliefGrid::VoxelValue> voxels;
  for (int x = -40; x < 40; ++x) {
    for (int y = -40; y < 40; ++y) {
      for (int z = 0; z < 45; ++z) {
        const bool in_object =
            std::max(std::abs(2 * x + 1), std::abs(2 * y + 1)) < 14 && z > 14 && z < 31;
        const bool in_screen = x == -16 && y < 18;
        if ((in_object && x == -7) || in_screen) {
          voxels.push_back({{x, y, z}, 2.0F, well_known});
        } else if (!in_object) {
          voxels.push_back({{x, y, z}, -1.0F});
        }
      }
    }
  }
  map.set(voxels);
  return map;
}

Vector3d eye_of(const ob::State* state) {
  const auto* s = state->as<ob::SE3StateSpace::StateType>();
  return {s->getX(), s->getY(), s->getZ()};
}

Pose pose_of(const ob::State* state) {
  const auto& q = state->as<ob::SE3StateSpace::StateType>()->rotation();
  return {Eigen::Quaterniond(q.w, q.x, q.y, q.z).normalized().toRotationMatrix(), eye_of(state)};
}

// [m]; turning on the way costs nothing
double distance(const ob::State* a, const ob::State* b) { return (eye_of(b) - eye_of(a)).norm(); }

// Turns the camera to the object from where it is, roll level.
void look_at_object(ob::State* state) {
  const Eigen::Quaterniond q(viewgain::look_at(eye_of(state), kObject).rotation());
  auto& rotation = state->as<ob::SE3StateSpace::StateType>()->rotation();
  rotation.w = q.w(), rotation.x = q.x(), rotation.y = q.y(), rotation.z = q.z();
}

// Of SE(3) the poses that look at the object: most others gain nothing.
class LookingSpace : public ob::SE3StateSpace {
 public:
  struct Sampler : ob::CompoundStateSampler {
    explicit Sampler(const LookingSpace* space) : CompoundStateSampler(space) {
      addSampler(space->getSubspace(0)->allocDefaultStateSampler(), 1);
      addSampler(space->getSubspace(1)->allocDefaultStateSampler(), 1);
    }
    void sampleUniform(ob::State* state) override {
      CompoundStateSampler::sampleUniform(state);
      look_at_object(state);
    }
  };
  ob::StateSamplerPtr allocDefaultStateSampler() const override {
    return std::make_shared<Sampler>(this);
  }
  void interpolate(const ob::State* from, const ob::State* to, double t,
                   ob::State* state) const override {
    SE3StateSpace::interpolate(from, to, t, state);
    look_at_object(state);
  }
};

// What a view is expected to bring [nat], each worked out once; nothing where it would mostly show
// what is too near to be measured (the rays of the gain pass through that). Planners may ask from
// many threads: evaluator and checker are const and safe, the table is behind a mutex.
class ViewValue {
 public:
  ViewValue(const viewgain::GainEvaluator& evaluator,
            const viewgain::FeasibilityChecker& feasibility)
      : evaluator_(evaluator), feasibility_(feasibility) {}
  double operator()(const ob::State* view) const {
    const Pose T_world_camera = pose_of(view);
    {
      const std::scoped_lock lock(mutex_);
      const auto known = values_.find(T_world_camera.m);
      if (known != values_.end()) return known->second;
    }
    const bool is_feasible = feasibility_.check(T_world_camera) == viewgain::Infeasibility::none;
    const double value = is_feasible ? evaluator_.evaluate(T_world_camera).gain : 0;
    const std::scoped_lock lock(mutex_);
    values_.emplace(T_world_camera.m, value);
    return value;
  }

 private:
  const viewgain::GainEvaluator& evaluator_;
  const viewgain::FeasibilityChecker& feasibility_;
  mutable std::mutex mutex_;
  mutable std::map<std::array<double, 12>, double> values_;  // by T_world_camera
};

// Gain per length is no sum over a path, which planners ask for. But a path beats `rate` exactly
// where
//   length + kViewLength - gain / rate < 0
// (Dinkelbach), and that is one: stateCost() is what a view is worth, in metres at that rate, and a
// motion costs its length and the cost of its end less that of its beginning, so that along a path
// all but those of the first and the last view cancel. A motion may cost less than nothing, a cycle
// never does.
class GainPerLength : public ob::OptimizationObjective {
 public:
  // `best_value`: the most that a view is thought to bring [nat], for the heuristic: where even
  // such a view would not make up for the way from the start, Informed RRT* draws no samples.
  GainPerLength(const ob::SpaceInformationPtr& si, const ViewValue& value, double rate,
                double best_value)
      : OptimizationObjective(si), value_(value), rate_(rate) {
    setCostThreshold(ob::Cost(-infiniteCost().value()));  // go on to the last iteration
    setCostToGoHeuristic([this, best_value](const ob::State* state, const ob::Goal*) {
      return ob::Cost(std::min(0.0, -best_value / rate_ - stateCost(state).value()));
    });
  }
  ob::Cost stateCost(const ob::State* view) const override {
    return ob::Cost(-value_(view) / rate_);
  }
  ob::Cost motionCost(const ob::State* from, const ob::State* to) const override {
    return ob::Cost(distance(from, to) + stateCost(to).value() - stateCost(from).value());
  }
  ob::Cost motionCostHeuristic(const ob::State* from, const ob::State* to) const override {
    return motionCost(from, to);  // no way is shorter than the straight one
  }
  bool isSymmetric() const override { return false; }

 private:
  const ViewValue& value_;
  double rate_;  // [nat/m]
};

// A path may end with any view.
class AnyView : public ob::Goal {
 public:
  using Goal::Goal;
  bool isSatisfied(const ob::State*) const override { return true; }
};

struct Plan {
  double length = 0;  // [m]
  double gain = 0;    // of the view at its end [nat]
  [[nodiscard]] double rate() const { return gain / (length + kViewLength); }
};

void print(const char* name, const Plan& plan) {
  std::printf("%-14s %6.3f m %8.1f nat %8.1f nat/m\n", name, plan.length, plan.gain, plan.rate());
}

void run(unsigned iterations) {
  ompl::msg::setLogLevel(ompl::msg::LOG_ERROR);
  ompl::RNG::setSeed(1);
  const auto scene = viewgain::VoxelScene::build(make_map());
  const viewgain::Sensor sensor = viewgain::sensor_preset("sr4000");
  const viewgain::GainEvaluator evaluator(scene, sensor, {.pixel_stride = 4});
  const viewgain::FeasibilityChecker can_be(scene, {.clearance = 0.02});  // the sensor's body
  const viewgain::FeasibilityChecker can_see(scene, {.clearance = 0.02, .sensor = sensor});
  const ViewValue value(evaluator, can_see);

  ob::RealVectorBounds bounds(3);
  bounds.low = {-0.7, -0.7, 0.1};
  bounds.high = {0.7, 0.7, 0.8};
  const auto space = std::make_shared<LookingSpace>();
  space->setBounds(bounds);
  const auto si = std::make_shared<ob::SpaceInformation>(space);
  si->setStateValidityChecker([&](const ob::State* state) {
    return si->satisfiesBounds(state) &&
           can_be.check(pose_of(state)) == viewgain::Infeasibility::none;
  });
  si->setStateValidityCheckingResolution(0.01);  // of the extent: 2 cm
  si->setup();

  ob::ScopedState<> start(space);
  start->as<ob::SE3StateSpace::StateType>()->setXYZ(-0.6, -0.5, 0.45);
  look_at_object(start.get());
  const Plan stay{0, value(start.get())};
  print("start", stay);

  // Without a planner: the best of many views, all scored at once, that a straight line leads to.
  std::vector<ob::ScopedState<>> ends(2000, start);
  std::vector<Pose> views;
  const auto sampler = space->allocStateSampler();
  for (auto& end : ends) {
    sampler->sampleUniform(end.get());
    views.push_back(pose_of(end.get()));
  }
  const std::vector<viewgain::ViewGain> gains = evaluator.evaluate(views);  // on all cores
  Plan straight = stay;
  double best_value = 0;
  for (std::size_t i = 0; i < views.size(); ++i) {
    if (can_see.check(views[i]) != viewgain::Infeasibility::none) continue;
    const Plan plan{distance(start.get(), ends[i].get()), gains[i].gain};
    best_value = std::max(best_value, plan.gain);  // of a sample: no bound, but near it
    if (plan.rate() > straight.rate() && si->checkMotion(start.get(), ends[i].get()))
      straight = plan;
  }
  print("straight line", straight);

  // Each round looks for what beats the rate so far; the first that finds nothing is the last.
  Plan best = straight;
  for (bool is_better = true; is_better;) {
    const auto problem = std::make_shared<ob::ProblemDefinition>(si);
    problem->addStartState(start);
    problem->setGoal(std::make_shared<AnyView>(si));
    problem->setOptimizationObjective(
        std::make_shared<GainPerLength>(si, value, best.rate(), best_value));
    ompl::geometric::InformedRRTstar planner(si);
    planner.setProblemDefinition(problem);
    planner.setRange(0.3);
    planner.setKNearest(false);
    planner.solve(ob::IterationTerminationCondition(iterations));
    is_better = false;
    if (problem->hasExactSolution()) {
      auto* path = problem->getSolutionPath()->as<ompl::geometric::PathGeometric>();
      Plan plan{0, value(path->getStates().back())};
      for (unsigned i = 1; i < path->getStateCount(); ++i) {
        plan.length += distance(path->getState(i - 1), path->getState(i));
      }
      is_better = plan.rate() > best.rate();
      if (is_better) best = plan;
    }
  }
  print("planner", best);
}

}  // namespace

int main(int argc, char** argv) {
  const std::string_view text = argc > 1 ? argv[1] : "2000";
  unsigned iterations = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), iterations);
  if (argc > 2 || error != std::errc() || end != text.data() + text.size() || iterations == 0) {
    std::fprintf(stderr, "usage: ompl_planner [ITERATIONS], a whole number above 0\n");
    return 2;
  }
  run(iterations);
  return 0;
}
