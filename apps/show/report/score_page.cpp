// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include "show/report/score_page.hpp"

#include <cmath>

#include "show/pictures/map_picture.hpp"
#include "show/report/page.hpp"
#include "show/report/view_parts.hpp"

namespace viewgain::app {
namespace {

using Eigen::Vector3d;
constexpr std::size_t kShownCubes = 100'000;  // a file is not to grow large

Json map_json(const GridSnapshot& snapshot) {
  const LatticeCubes cubes = occupied_cubes(snapshot, kShownCubes);
  std::vector<Vector3d> centers;
  for (const Index3& at : cubes.at) {
    centers.push_back(snapshot.T_world_grid *
                      Vector3d(cubes.side * (Vector3d(at.x, at.y, at.z).array() + 0.5)));
  }
  return {{"centers", point_block(centers)}, {"size", cubes.side}};
}

Json shown_json(const GainEvaluator& evaluator, const Pose& T_world_camera, const Json& unit) {
  const std::vector<VoxelContribution> voxels = evaluator.contributions(T_world_camera);
  Json json = contributions_json(evaluator.scene().snapshot(), voxels, unit);
  std::vector<std::uint8_t> states;
  for (const VoxelContribution& voxel : voxels) {
    states.push_back(voxel.state == VoxelState::unknown ? 1 : 2);
  }
  json["state"] = byte_block(states);
  return json;
}

}  // namespace

Json ScorePage::json() const {
  Json page = page_head("score", title, evaluator, sensor, criterion);
  page["settings"] = settings;
  page["summary"] = summary;
  page["truth"] = nullptr;
  Json contributions = Json::array();
  for (const std::size_t i : shown) {
    contributions.push_back(
        {{"candidate", i},
         {"bundle", bundle_json(evaluator, sensor, poses[i])},
         {"contributions", shown_json(evaluator, poses[i], page["gain_unit"])}});
  }
  ShownCandidates candidates{{poses.begin(), poses.end()}, gains, areas, exact, {}, {}, {}};
  candidates.generators.resize(poses.size());
  candidates.classes.resize(poses.size());
  for (const double gain : gains)
    candidates.reasons.emplace_back(std::isnan(gain) ? "not scored" : "");
  page["score"] = {{"map", map_json(evaluator.scene().snapshot())},
                   {"candidates", to_json(candidates)},
                   {"columns", columns},
                   {"rows", rows},
                   {"shown", contributions}};
  return page;
}

}  // namespace viewgain::app
