// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0

// The hazard that the surface and the combined gain need, and the classic gains against the
// paper's.
#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>

#include "bars.hpp"
#include "measure.hpp"
#include "support/camel_scene.hpp"
#include "viewgain/core/generators.hpp"
#include "viewgain/grid/hazard.hpp"
#include "viewgain/literature/classic_gains.hpp"
#include "viewgain/raycast/gain_evaluator.hpp"

namespace viewgain::bench {
namespace {

constexpr std::size_t kChecked = 16;  // poses whose gains are compared with those of one thread

/// The hazard field of camel-N after one more frame [ms].
double hazard_ms(int voxels, const BarsOptions& options) {
  const std::vector<test::CamelView> views = test::camel_views(4, options.mesh);
  const GridSnapshot snapshot = test::camel_grid(voxels, views).snapshot();
  std::vector<double> seconds;
  for (int repetition = -1; repetition < options.repetitions; ++repetition) {
    const double value = seconds_of([&] { (void)HazardField(snapshot); });
    if (repetition >= 0) seconds.push_back(value);  // -1: to warm up
  }
  return 1e3 * median(seconds);
}

/// Camel-N that remembers the views it was made from, for occlusion distances.
BeliefGrid camel_with_views(const BarsOptions& options) {
  const std::vector<test::CamelView> views = test::camel_views(3, options.mesh);
  BeliefGrid grid = test::camel_grid(options.voxels, views);
  if (grid.views().empty()) {
    for (const test::CamelView& view : views) grid.append_view(view.T_world_camera);
  }
  return grid;
}

/// Some poses have the gains that one thread finds, and no gain is zero everywhere.
bool are_as_alone(const std::shared_ptr<const ClassicMap>& map, const Sensor& sensor,
                  const ClassicConfig& config, std::span<const Pose> poses,
                  std::span<const double> gains) {
  const std::size_t count = std::min(kChecked, poses.size()), n = config.gains.size();
  const std::vector<double> alone =
      ClassicGainEvaluator(map, sensor, config, {.num_threads = 1}).evaluate(poses.first(count));
  std::vector<double> most(n, 0.0);
  for (std::size_t i = 0; i < alone.size(); ++i) {
    if (std::bit_cast<std::uint64_t>(alone[i]) != std::bit_cast<std::uint64_t>(gains[i])) {
      return false;
    }
    most[i % n] = std::max(most[i % n], alone[i]);
  }
  return *std::min_element(most.begin(), most.end()) > 0;
}

}  // namespace

std::vector<Figure> hazard_figures(const BarsOptions& options) {
  return {Figure{"hazard_ms_128", hazard_ms(options.voxels, options)},
          Figure{"hazard_ms_512", hazard_ms(options.large_voxels, options)}};
}

std::vector<Figure> classic_figures(const BarsOptions& options) {
  const Sensor sensor = sensor_preset("sr4000");
  const BeliefGrid grid = camel_with_views(options);
  const auto scene = VoxelScene::build(grid);
  const auto map = ClassicMap::build(scene, grid, Acquisition{sensor});
  const std::vector<Pose> poses = sphere_poses(static_cast<std::size_t>(options.poses), 0.6);
  ClassicConfig config;
  for (const std::string& name : classic_gain_names()) {
    config.gains.push_back(parse_classic_gain(name));
  }
  const ExecConfig exec{.num_threads = options.num_threads};
  const GainEvaluator paper(scene, sensor, {.model = GainModel::paper}, exec);
  const ClassicGainEvaluator classic(map, sensor, config, exec);
  std::vector<double> paper_seconds, classic_seconds, gains;
  for (int repetition = -1; repetition < options.repetitions; ++repetition) {
    const double of_paper = seconds_of([&] { (void)paper.evaluate(poses); });
    const double of_classic = seconds_of([&] { gains = classic.evaluate(poses); });
    if (repetition < 0) continue;  // to warm up
    paper_seconds.push_back(of_paper);
    classic_seconds.push_back(of_classic);
  }
  const bool same = are_as_alone(map, sensor, config, poses, gains);
  return {Figure{"classic_over_paper", median(classic_seconds) / median(paper_seconds), same,
                 same ? "" : "gains differ"}};
}

}  // namespace viewgain::bench
