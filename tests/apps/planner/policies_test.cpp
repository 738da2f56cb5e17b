// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: GPL-3.0-or-later

// What policies choose, against counts by other means.
#include "viewgain/planner_mesh/policies.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <numbers>
#include <set>
#include <vector>

#include "apps/planner/planner_scene.hpp"
#include "core/expect_error.hpp"
#include "viewgain/core/generators.hpp"
#include "viewgain/literature/classic_gains.hpp"
#include "viewgain/planner/pose_sets.hpp"

namespace viewgain {
namespace {

double angle_between(const Pose& a, const Pose& b, const Eigen::Vector3d& center) {
  return std::acos(std::clamp(
      (a.translation() - center).normalized().dot((b.translation() - center).normalized()), -1.0,
      1.0));
}

TEST(Fibonacci, AnyNumberOfTheFirstViewsIsSpreadEvenly) {
  const Eigen::Vector3d center(0.1, -0.2, 0.3);
  int cases = 0;
  for (const std::size_t count : {std::size_t{6}, std::size_t{12}, std::size_t{20}}) {
    PoseSetRequest request{center, 0.5, count, 1, look_at({0.7, 0.1, 0.6}, center), true};
    const std::vector<Pose> poses = make_pose_set("sphere", request).poses;
    ASSERT_EQ(poses.size(), count);
    // The poses of the lattice, in another order.
    std::set<std::size_t> found;
    const std::vector<Pose> lattice = sphere_poses(count, 0.5, center);
    for (const Pose& pose : poses) {
      for (std::size_t i = 0; i < count; ++i) {
        if (lattice[i] == pose) found.insert(i);
      }
    }
    EXPECT_EQ(found.size(), count);
    // A view's share of the sphere would be a square of this edge.
    std::vector<Pose> taken{*request.start};
    for (std::size_t k = 0; k + count / 4 < count; ++k, ++cases) {
      double nearest = std::numbers::pi;
      for (const Pose& pose : taken) {
        nearest = std::min(nearest, angle_between(pose, poses[k], center));
      }
      taken.push_back(poses[k]);
      const double edge = std::sqrt(4 * std::numbers::pi / static_cast<double>(taken.size()));
      EXPECT_GT(nearest, 0.5 * edge) << count << ' ' << k;
    }
  }
  EXPECT_EQ(cases, 5 + 9 + 15);
  EXPECT_EQ(make_pose_set("sphere", {center, 0.5, {}, 1, {}, true}).poses.size(), 500U);
  test::expect_error(ErrorCode::invalid_argument, "20001", [&] {
    (void)make_pose_set("sphere", {center, 0.5, 20'001, 1, {}, true});
  });
}

// A box seen once, and candidates all round it.
struct SeenBox {
  Sensor sensor = test::half_sr4000();
  std::shared_ptr<const SurfaceScene> mesh =
      std::make_shared<const SurfaceScene>(test::cube_mesh(0.08));
  std::shared_ptr<const Truth> truth;
  Pose start = look_at({0.35, 0.2, 0.25}, {0, 0, 0});
  ExecConfig exec{1};
  std::vector<Candidate> candidates;

  SeenBox() {
    VisibilityConfig visibility;
    visibility.distance = 0.4;
    visibility.start = start;
    truth = std::make_shared<const Truth>(mesh, sensor, visibility, exec);
    for (const Pose& pose : sphere_poses(30, 0.42, {0, 0, 0})) {
      candidates.push_back({pose, "sphere", std::nullopt, std::nullopt});
    }
    // Looks past the box, and equals another one.
    candidates.push_back({look_at({0.4, 0, 0}, {0.4, 1, 0}), "off", std::nullopt, std::nullopt});
    candidates.push_back(candidates[7]);
  }
  [[nodiscard]] Measurements view(const Pose& pose) const {
    return {pose, {SimulatedSensor(mesh, sensor, {}, exec).acquire(pose)}};
  }
  [[nodiscard]] std::unique_ptr<SurfaceModel> model_after(const std::vector<Pose>& views) const {
    auto model = std::make_unique<SurfaceModel>(sensor, test::model_config(sensor, 0.12, 0.005),
                                                nullptr, exec);
    for (const Pose& pose : views) (void)model->update(view(pose));
    return model;
  }
  [[nodiscard]] std::optional<DecisionMaking::Decision> choice(const SurfaceModel& model,
                                                               PolicyConfig config,
                                                               int num_threads = 1) const {
    const ExecConfig own{num_threads};
    config.object = {mesh, truth, {}};
    CandidateGeneration generation(model, default_generation(sensor, 0.005), own);
    PolicyDecision decision(model, generation, sensor, config, own);
    return decision.decide(start, candidates);
  }
};

TEST(RegisteredGain, ChoosesTheFirstOfTheBestByItsGain) {
  const SeenBox box;
  const auto model = box.model_after({box.start});
  register_gains(literature_gains());
  PolicyConfig config;
  for (const ClassicGain gain : {ClassicGain::unknown_count, ClassicGain::proximity_count}) {
    config.registered = classic_gain_name(gain);
    const auto map = ClassicMap::build(model->scene(), model->grid(), Acquisition{box.sensor});
    const std::vector<Pose> poses = poses_of(box.candidates);
    const std::vector<double> values =
        ClassicGainEvaluator(map, box.sensor, {.gains = {gain}}).evaluate(poses);
    const auto best = std::max_element(values.begin(), values.end());
    for (const int threads : {1, 3}) {
      const auto decision = box.choice(*model, config, threads);
      ASSERT_TRUE(decision);
      EXPECT_EQ(decision->candidate, static_cast<std::size_t>(best - values.begin()));
      EXPECT_EQ(decision->gain, *best);
      EXPECT_GT(decision->area, 0);
    }
  }
}

TEST(RegisteredGain, OfManyThirtyTwoAreScoredInFull) {
  const SeenBox box;
  const auto model = box.model_after({box.start});
  const std::vector<Pose> poses = sphere_poses(100, 0.4);
  register_gains(literature_gains());
  const RegisteredChoice choice(*model, box.sensor, "occlusion_aware", box.exec);
  const std::vector<double> all = choice.gains(poses, true), some = choice.gains(poses, false);
  std::size_t scored = 0;
  for (std::size_t i = 0; i < poses.size(); ++i) {
    EXPECT_FALSE(std::isnan(all[i]));
    if (std::isnan(some[i])) continue;
    EXPECT_EQ(some[i], all[i]);
    ++scored;
  }
  EXPECT_EQ(scored, RegisteredChoice::kInFull);
  const double best = *std::max_element(all.begin(), all.end());
  EXPECT_GT(std::count(some.begin(), some.end(), best), 0);
}

TEST(RegisteredGain, IsKnownByItsNameOnceItIsRegistered) {
  const SeenBox box;
  const auto model = box.model_after({box.start});
  register_gains(nullptr);
  EXPECT_TRUE(registered_gains().names().empty());
  EXPECT_FALSE(is_registered_gain("unknown_count"));
  PolicyConfig config;
  config.registered = "unknown_count";
  test::expect_error(ErrorCode::invalid_argument, "no gains are registered",
                     [&] { (void)box.choice(*model, config); });
  register_gains(literature_gains());
  EXPECT_TRUE(is_registered_gain("unknown_count"));
  EXPECT_FALSE(is_registered_gain("combined"));
  EXPECT_EQ(registered_gains().unit("unknown_volume"), "m^3");
  config.registered = "unknwn_count";
  test::expect_error(ErrorCode::invalid_argument, "unknown_count",
                     [&] { (void)box.choice(*model, config); });
}

TEST(RegisteredGain, NeitherGainNorAreaEndsARun) {
  PolicyConfig policy;
  policy.registered = "occlusion_aware";
  PlanningConfig planning;
  set_stop_rules(planning, policy, {}, {});
  EXPECT_EQ(planning.stop_area, 0);
  EXPECT_THROW(set_stop_rules(planning, policy, 1.0, {}), Error);
  EXPECT_THROW(set_stop_rules(planning, policy, {}, 0.01), Error);
}

TEST(Oracle, ChoosesWhatABruteForceOverAllCandidatesChooses) {
  const SeenBox box;
  // Without the library's: takes each view for itself and looks for the nearest point.
  const GroundTruth truth(box.mesh->mesh());
  std::vector<std::size_t> covered;
  for (const Candidate& candidate : box.candidates) {
    const auto model = box.model_after({box.start, candidate.T_world_camera});
    std::vector<std::array<double, 3>> points;
    for (const FusedPoint& point : model->points()) points.push_back(point.position);
    const std::vector<double> distances = truth.distances_to(points);
    covered.push_back(static_cast<std::size_t>(
        std::count_if(distances.begin(), distances.end(), [](double d) { return d <= 5e-3; })));
  }
  ASSERT_EQ(covered.size(), 32U);
  const auto best =
      static_cast<std::size_t>(std::max_element(covered.begin(), covered.end()) - covered.begin());

  const auto model = box.model_after({box.start});
  const std::string before = model->grid().content_hash();
  PolicyConfig config;
  config.policy = Policy::oracle;
  for (const int threads : {1, 3}) {
    const auto decision = box.choice(*model, config, threads);
    ASSERT_TRUE(decision);
    EXPECT_EQ(decision->candidate, best);
    EXPECT_GT(decision->area, 0);
    EXPECT_TRUE(std::isnan(decision->gain_per_voxel));
    EXPECT_TRUE(std::isnan(decision->best_area));
  }
  EXPECT_EQ(model->grid().content_hash(), before);
  // Its own simulation comes to the same numbers.
  const OracleChoice oracle(*model, box.sensor, {box.mesh, box.truth, {}}, box.exec);
  EXPECT_EQ(oracle.covered_after(box.candidates[best].T_world_camera), covered[best]);
  EXPECT_EQ(oracle.covered_after(box.candidates[30].T_world_camera), covered[30]);
}

TEST(Oracle, CountsUncoveredSamplesInView) {
  const SeenBox box;
  const auto model = box.model_after({box.start});
  const OracleChoice oracle(*model, box.sensor, {box.mesh, box.truth, {}}, box.exec);
  const std::vector<double> counts = oracle.uncovered_in_view(box.candidates);
  ASSERT_EQ(counts.size(), 32U);
  EXPECT_EQ(counts[30], 0);
  EXPECT_EQ(counts[31], counts[7]);
  // A convex body hides what looks away alone (and some at its edges); without a surface nothing is
  // covered.
  const auto empty = std::make_unique<SurfaceModel>(
      box.sensor, test::model_config(box.sensor, 0.12, 0.005), nullptr, box.exec);
  const OracleChoice from_nothing(*empty, box.sensor, {box.mesh, box.truth, {}}, box.exec);
  const std::vector<double> all = from_nothing.uncovered_in_view(box.candidates);
  for (std::size_t i = 0; i < 30; ++i) {
    const Eigen::Vector3d eye = box.candidates[i].T_world_camera.translation();
    double expected = 0;
    for (const SurfaceSample& sample : box.truth->ground_truth().samples()) {
      const Eigen::Vector3d sight = (eye - sample.position).normalized();
      if (sight.dot(sample.normal) <= std::cos(72 * std::numbers::pi / 180)) continue;
      const double range = (eye - sample.position).norm();
      expected += 1 / (1 + box.sensor.noise_sigmas(range).axial / 0.005);
    }
    EXPECT_NEAR(all[i], expected, 0.02 * expected) << i;
    EXPECT_LE(counts[i], all[i]);
  }
}

TEST(Oracle, NeedsTheObject) {
  const SeenBox box;
  const auto model = box.model_after({box.start});
  CandidateGeneration generation(*model, default_generation(box.sensor, 0.005), box.exec);
  PolicyConfig config;
  config.policy = Policy::oracle;
  test::expect_error(ErrorCode::invalid_argument, "mesh", [&] {
    const PolicyDecision decision(*model, generation, box.sensor, config, box.exec);
  });
}

}  // namespace
}  // namespace viewgain
