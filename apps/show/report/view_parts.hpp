// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "viewgain/core/pose.hpp"
#include "viewgain/core/sensor.hpp"
#include "viewgain/raycast/gain_evaluator.hpp"
#include "viewgain/support/json.hpp"

namespace viewgain::app {

// What the pages of runs and of scores both show; README.md, "Data", says each part's keys.

/// The keys that every page has: what it is, the space, the camera.
[[nodiscard]] Json page_head(const std::string& kind, const std::string& title,
                             const GainEvaluator& evaluator, const Sensor& sensor,
                             std::string_view criterion);

/// Twelve numbers, the rows of T_world_camera.
[[nodiscard]] Json pose_rows(const Pose& T_world_camera);

/// Candidates as parallel lists. `gains` may be shorter: the rest have none.
struct ShownCandidates {
  std::vector<Pose> poses;
  std::vector<double> gains, areas;
  std::vector<std::size_t> exact;  ///< whose gain is by all rays; of the others it is estimated
  std::vector<std::string> generators, classes, reasons;  ///< one a pose; an empty text is none
};
[[nodiscard]] Json to_json(const ShownCandidates& candidates);

/// Where the rays of a view end: an evenly spaced sample of those that end in a voxel.
[[nodiscard]] Json bundle_json(const GainEvaluator& evaluator, const Sensor& sensor,
                               const Pose& T_world_camera);

/// What voxels bring to a view: centres, values and the value's unit.
[[nodiscard]] Json contributions_json(const GridSnapshot& snapshot,
                                      const std::vector<VoxelContribution>& voxels,
                                      const Json& unit);

/// Triangles as the page draws them. World [m].
struct ShownMesh {
  std::vector<Eigen::Vector3d> vertices;
  std::vector<std::array<std::uint32_t, 3>> triangles;
  std::vector<double> sigma, error;  ///< one a vertex [m], or none

  void add_vertex(const std::array<double, 3>& p) { vertices.emplace_back(p[0], p[1], p[2]); }
};

/// The mesh with at most `most` vertices: those in a cell of a lattice become one, their mean, and
/// triangles without area go. As it is if it is small enough. For looking at, not for measuring.
[[nodiscard]] ShownMesh thinned(ShownMesh mesh, std::size_t most);

/// A mesh of README.md, "Data".
[[nodiscard]] Json to_json(const ShownMesh& mesh);

}  // namespace viewgain::app
