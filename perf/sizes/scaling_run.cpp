// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include "scaling_run.hpp"

#include <algorithm>
#include <cstring>
#include <memory>

#include "measure.hpp"
#include "support/camel_scene.hpp"
#include "viewgain/core/error.hpp"
#include "viewgain/core/generators.hpp"

namespace viewgain::bench {
namespace {

/// Enough that a tie or two do not look like disagreement.
constexpr int kCheckedRays = 4 * kFullRays;

/// A case while it runs.
struct Runner {
  ScalingCase result;
  std::vector<Pose> poses;
  std::unique_ptr<GainEvaluator> evaluator;
  std::vector<ViewGain> gains;

  void run() { evaluator->evaluate(poses, gains); }
};

bool have_same_bits(const std::vector<ViewGain>& a, const std::vector<ViewGain>& b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(), [](const auto& x, const auto& y) {
    return std::memcmp(&x.gain, &y.gain, sizeof x.gain) == 0 && x.hits == y.hits;
  });
}

void add_cases(const ScalingPlan& plan, int voxels, std::vector<Runner>& runners) {
  const BeliefGrid grid = test::camel_grid(voxels, plan.mesh);
  const auto scene = VoxelScene::build(grid);
  const oracle::DenseMap map(grid);
  for (const int rays : plan.rays) {
    const RayPattern pattern = ray_pattern(rays);
    const auto count =
        static_cast<std::size_t>(static_cast<std::int64_t>(plan.poses) * kFullRays / rays);
    const std::vector<Pose> poses = sphere_poses(count, 0.6);
    std::vector<Pose> checked;
    const auto wanted = static_cast<std::size_t>(kCheckedRays / rays);
    for (std::size_t i = 0; i < std::min(wanted, count); ++i) {
      checked.push_back(poses[i * count / std::min(wanted, count)]);
    }
    Agreement agreement;
    for (const int threads : plan.threads) {
      Runner runner;
      runner.evaluator = std::make_unique<GainEvaluator>(scene, pattern.sensor, pattern.config,
                                                         ExecConfig{threads, plan.tracer});
      if (threads == plan.threads.front()) {
        agreement =
            compare_with_oracle(map, pattern.sensor, pattern.config, *runner.evaluator, checked);
      }
      runner.result.voxels = voxels;
      runner.result.rays_per_pose = rays;
      runner.result.num_threads = threads;
      runner.result.poses = count;
      runner.result.isa = scene->isa();
      runner.result.agreement = agreement;
      runner.poses = poses;
      runner.gains.resize(count);
      runners.push_back(std::move(runner));
    }
  }
}

}  // namespace

RayPattern ray_pattern(int rays_per_pose) {
  RayPattern pattern{sensor_preset("sr4000"), {.model = GainModel::paper}};
  PinholeCamera& camera = pattern.sensor.camera;
  if (rays_per_pose == kHalfRays) pattern.config.pixel_stride = 2;
  if (rays_per_pose == kFewRays) {
    const double x = 38.0 / camera.width, y = 25.0 / camera.height;
    camera.fx *= x, camera.fy *= y;
    camera.cx = (camera.cx + 0.5) * x - 0.5, camera.cy = (camera.cy + 0.5) * y - 0.5;
    camera.width = 38, camera.height = 25;
  }
  const auto rays = [&](int pixels) {
    return (pixels + pattern.config.pixel_stride - 1) / pattern.config.pixel_stride;
  };
  if (rays(camera.width) * rays(camera.height) != rays_per_pose) {
    throw Error(ErrorCode::invalid_argument,
                std::to_string(rays_per_pose) + " rays per pose: must be 950, 6336 or 25344");
  }
  return pattern;
}

std::vector<int> thread_counts(int most) {
  std::vector<int> counts;
  for (int n = 1; n <= most; n += n < 8 ? 1 : n) counts.push_back(n);
  if (counts.back() != most) counts.push_back(most);
  return counts;
}

double ScalingCase::poses_per_second(double share_of_times) const {
  return static_cast<double>(poses) / quantile(seconds, share_of_times);
}

std::vector<ScalingCase> run_scaling_cases(const ScalingPlan& plan) {
  std::vector<Runner> runners;
  for (const int voxels : plan.voxels) add_cases(plan, voxels, runners);
  for (int repetition = -1; repetition < plan.repetitions; ++repetition) {
    for (Runner& runner : runners) {
      const double seconds = seconds_of([&] { runner.run(); });
      if (repetition >= 0) runner.result.seconds.push_back(seconds);  // -1: to warm up
    }
  }
  std::vector<ScalingCase> results;
  for (std::size_t i = 0; i < runners.size(); ++i) {
    const std::size_t first = i / plan.threads.size() * plan.threads.size();
    runners[i].result.same_bits = have_same_bits(runners[i].gains, runners[first].gains);
    results.push_back(runners[i].result);
  }
  return results;
}

}  // namespace viewgain::bench
