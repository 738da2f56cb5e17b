// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "program/cli/app.hpp"
#include "viewgain/core/pose.hpp"
#include "viewgain/grid/belief_grid.hpp"

namespace viewgain::app {

/// Poses given on the command line.
struct PoseSource {
  std::vector<Pose> poses;          ///< T_world_camera
  std::size_t orthonormalized = 0;  ///< number of repaired rotations of a file
  std::vector<double> costs{};      ///< cost of each pose, in the gain's unit; empty: none

  /// The gain of a pose minus its cost.
  [[nodiscard]] double worth(std::size_t i, double gain) const {
    return costs.empty() ? gain : gain - costs.at(i);
  }
};

/// --poses and --center.
struct PoseOptions {
  std::string poses;   ///< a file (TUM or .npy), or a set such as sphere:N,RADIUS
  std::string center;  ///< point x,y,z that a set looks at; empty: the origin
};

/// Whether a value of --poses names a set instead of a file.
[[nodiscard]] bool is_set_of_poses(const std::string& value);

/// Adds the flags of PoseOptions, which are the same in every subcommand that takes one set of
/// poses.
void add_pose_options(App& app, PoseOptions& options);

/// Costs that are subtracted from gains, in their unit.
struct CostOptions {
  std::string file;      ///< --costs: one number per pose
  double per_metre = 0;  ///< --cost-per-metre of path
  std::string from;      ///< --from x,y,z: start of paths; empty: the last known pose

  [[nodiscard]] bool none() const { return file.empty() && per_metre == 0; }
};

/// `has_way`: paths matter even if they cost nothing. Throws Error(invalid_argument), naming the
/// flag.
void check(const CostOptions& options, bool has_way = false);

/// The last view of a map, if any.
[[nodiscard]] std::optional<Pose> last_view(const BeliefGrid& grid);

/// Start of paths, of which only the centre counts: --from, else `last_pose`. Throws
/// Error(invalid_argument) if paths have a cost and both are missing.
[[nodiscard]] std::optional<Pose> begin_of_ways(const CostOptions& options,
                                                const std::optional<Pose>& last_pose);

inline constexpr const char* kCostPerMetreHelp =
    "cost per metre from the camera's current position to a view, in the gain's unit; subtracted "
    "from the view's gain";
/// Adds the flags of CostOptions; `of`: what the costs of a file are for.
void add_cost_options(App& app, CostOptions& options, const std::string& of);

/// Reads a file with one number per line; skips blank lines and comments. Throws Error that names
/// the file, and the line or the number of `poses`.
[[nodiscard]] std::vector<double> read_costs(const std::string& file, std::size_t poses);

/// `seed` is used for a shell. Throws Error(invalid_argument), naming the flag. Also throws
/// whatever load_poses() throws.
[[nodiscard]] PoseSource make_poses(const PoseOptions& options, std::uint64_t seed);

/// Poses of a file of --poses. Throws like make_poses().
[[nodiscard]] std::vector<Pose> poses_in(const std::string& file);

}  // namespace viewgain::app
