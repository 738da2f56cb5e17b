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

/// Poses that the command line asked for.
struct PoseSource {
  std::vector<Pose> poses;          ///< T_world_camera
  std::size_t orthonormalized = 0;  ///< of a file: how many rotations were mended
  std::vector<double> costs{};      ///< of each, in the gain's unit; empty: none

  /// The gain of a pose less its cost.
  [[nodiscard]] double worth(std::size_t i, double gain) const {
    return costs.empty() ? gain : gain - costs.at(i);
  }
};

/// --poses and --center.
struct PoseOptions {
  std::string poses;   ///< a file, TUM or .npy, or a set as sphere:N,RADIUS
  std::string center;  ///< x,y,z that a set looks at; empty: the origin
};

/// Does a value of --poses name a set, and not a file?
[[nodiscard]] bool is_set_of_poses(const std::string& value);

/// The flags of PoseOptions, the same in every subcommand that is given one set of poses.
void add_pose_options(App& app, PoseOptions& options);

/// What is subtracted from gains, in their unit.
struct CostOptions {
  std::string file;      ///< --costs: one number a pose
  double per_metre = 0;  ///< --cost-per-metre of the way
  std::string from;      ///< --from x,y,z: where ways begin; empty: at the last pose known

  [[nodiscard]] bool none() const { return file.empty() && per_metre == 0; }
};

/// `has_way`: there is one whatever ways cost. Throws Error(invalid_argument), naming the flag.
void check(const CostOptions& options, bool has_way = false);

/// Of a map; nothing: it has none.
[[nodiscard]] std::optional<Pose> last_view(const BeliefGrid& grid);

/// Where ways begin, of which only the centre counts: at --from, else at `last_pose`. Throws
/// Error(invalid_argument) where ways cost and there is neither.
[[nodiscard]] std::optional<Pose> begin_of_ways(const CostOptions& options,
                                                const std::optional<Pose>& last_pose);

inline constexpr const char* kCostPerMetreHelp =
    "cost per metre from the camera's current position to a view, in the gain's unit; subtracted "
    "from the view's gain";
/// The flags of CostOptions; `of`: whose costs a file has.
void add_cost_options(App& app, CostOptions& options, const std::string& of);

/// Of a file with one number a line, blank lines and comments aside. Throws Error that names the
/// file, and the line or how many `poses` there are.
[[nodiscard]] std::vector<double> read_costs(const std::string& file, std::size_t poses);

/// `seed`: of the shell. Throws Error(invalid_argument), naming the flag, or what load_poses
/// throws.
[[nodiscard]] PoseSource make_poses(const PoseOptions& options, std::uint64_t seed);

/// Those of a file of --poses. Throws as make_poses().
[[nodiscard]] std::vector<Pose> poses_in(const std::string& file);

}  // namespace viewgain::app
