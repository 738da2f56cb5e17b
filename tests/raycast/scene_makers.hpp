// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gtest/gtest.h>

#include <array>
#include <cstdint>
#include <random>
#include <string>
#include <vector>

#include "core/scoped_variable.hpp"
#include "viewgain/core/sensor.hpp"
#include "viewgain/grid/belief_grid.hpp"
#include "viewgain/raycast/gain_evaluator.hpp"

namespace viewgain::test {

/// Builds with sanitizers look for memory errors; the statistics are the optimised build's.
#ifdef VIEWGAIN_SLOW_BUILD
constexpr bool kSlowBuild = true;
#else
constexpr bool kSlowBuild = false;
#endif

[[nodiscard]] inline GainConfig by_paper(Criterion criterion) {
  return {.model = GainModel::paper, .criterion = criterion};
}
inline const GainConfig kPaper = by_paper(Criterion::log_diagonal);

using Random = std::mt19937_64;

[[nodiscard]] double uniform(Random& random, double low, double high);
[[nodiscard]] int uniform_int(Random& random, int low, int high);  ///< both ends included
[[nodiscard]] Pose random_rigid(Random& random, double reach);  ///< translation within +-reach [m]

/// The ways to trace.
inline constexpr std::array kTracers{ExecConfig::Tracer::sweep, ExecConfig::Tracer::embree};

/// What the random maps look like.
enum class MapFamily {
  salt_and_pepper_01,  ///< 0.1 % of the voxels not free
  salt_and_pepper_1,   ///< 1 %
  salt_and_pepper_30,  ///< 30 %
  tiles_8,             ///< whole leaves unknown between mixed ones
  tiles_128,           ///< whole blocks of 128³ unknown behind a carved corner
  odd_and_far,         ///< no multiple of 8, far off the origin
  rotated,             ///< the same with a random T_world_grid
  mixed_scales,        ///< salt and pepper, leaves resampled to and fro
};

inline constexpr std::array kMapFamilies{MapFamily::salt_and_pepper_01,
                                         MapFamily::salt_and_pepper_1,
                                         MapFamily::salt_and_pepper_30,
                                         MapFamily::tiles_8,
                                         MapFamily::tiles_128,
                                         MapFamily::odd_and_far,
                                         MapFamily::rotated,
                                         MapFamily::mixed_scales};

/// For tests with a family as parameter.
[[nodiscard]] std::string family_name(const testing::TestParamInfo<MapFamily>& info);

/// A map and the part of its workspace where cameras inside it are put (grid frame) [m].
struct RandomMap {
  BeliefGrid grid;
  Box room;
};

/// A map of the family with beliefs at most occupied voxels.
[[nodiscard]] RandomMap random_map(MapFamily family, Random& random);

/// Occupied, with evidence of a few readings.
void set_occupied_with_belief(BeliefGrid& grid, Index3 voxel, Random& random);

/// A small camera (rows and columns no multiple of 4, some with distortion) whose range limits lie
/// inside or outside the map's extent.
[[nodiscard]] Sensor random_sensor(const BeliefGrid& grid, Random& random);

/// Poses in turn inside the room and anywhere near the workspace that look at some point of the
/// workspace, with any roll.
[[nodiscard]] std::vector<Pose> random_poses(const RandomMap& map, std::size_t count,
                                             Random& random);

/// A map of the family, a camera and poses, by a seed.
struct RandomCase {
  RandomMap map;
  Sensor sensor;
  std::vector<Pose> poses;
};
[[nodiscard]] RandomCase random_case(std::uint64_t seed, MapFamily family, std::size_t poses);

/// width x height pixels one focal length apart round the optical axis, so that rays run along axes
/// and exact diagonals; isotropic noise, ranges 0 to 1000 m.
[[nodiscard]] Sensor lattice_sensor(int width, int height);

/// All voxels free but those listed, which are occupied (or unknown); V is a power of two so that
/// coordinates are exact in any precision.
inline constexpr double kExactVoxel = 1.0 / 32.0;  ///< [m]
[[nodiscard]] BeliefGrid sparse_map(Index3 dims, const std::vector<Index3>& non_free,
                                    VoxelState state = VoxelState::occupied);

/// An axis-aligned camera at `origin` [voxels of kExactVoxel] that looks along +-x, y or z (axis
/// 0-2).
[[nodiscard]] Pose axis_pose(const Eigen::Vector3d& origin, int axis, bool positive);

/// Equal in every bit, field by field.
[[nodiscard]] bool same_bits(const ViewGain& a, const ViewGain& b);
[[nodiscard]] bool same_bits(const std::vector<ViewGain>& a, const std::vector<ViewGain>& b);

/// How many of the views gain something.
[[nodiscard]] std::size_t gaining(const std::vector<ViewGain>& views);

/// Some boxes within the workspace.
[[nodiscard]] Obstacles random_boxes(const BeliefGrid& grid, Random& random);

void expect_same_hits(const std::vector<RayHit>& a, const std::vector<RayHit>& b);

}  // namespace viewgain::test
