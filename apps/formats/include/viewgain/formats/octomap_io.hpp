// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>

#include "viewgain/core/box.hpp"
#include "viewgain/core/export.hpp"
#include "viewgain/grid/belief_grid.hpp"

namespace viewgain {

/// Settings that an octree does not contain.
struct VIEWGAIN_EXPORT OctomapConfig {
  /// Part of the tree to convert, in the tree's frame [m], extended to whole voxels; default: the
  /// box of its known voxels. Space that the tree does not cover is unknown.
  std::optional<Box> workspace{};
  std::optional<double> prior_sigma{};  ///< [m]; defaults to voxel / 2, since the sensor is unknown
  /// Log-odds above which a voxel of a `.ot` is occupied; 0, probability 0.5, is OctoMap's default.
  float occupied_from = 0;
};

/// Reads OctoMap's `.ot` (types OcTree and ColorOcTree, ignoring colours) or `.bt`, according to
/// the file's first line. Does not need the OctoMap library. The lattices are the same: OctoMap's
/// key k stands for the interval [k - 32768, k - 32767) times the resolution.
///
/// Keeps the states occupied, free and unknown. Log-odds of a `.ot` are rounded to steps of 0.05
/// and clamped to [-2, 3.5] without changing the state; a `.bt` gives 3.5 and -2. The map has no
/// beliefs (see BeliefGrid::from_states()) and no views. A pruned free leaf needs little memory,
/// but a pruned occupied leaf needs a block per 8³ voxels.
///
/// Throws Error(io) if the file cannot be read; Error(format) with the file and the line or byte if
/// it is truncated, or has a wrong number of nodes or an invalid value. Also throws it if no voxel
/// is known and no workspace is given. Throws Error(capacity) with the file if it is too large or
/// pruned leaves have more than 2^27 occupied voxels. Also throws whatever the constructor of
/// BeliefGrid throws.
[[nodiscard]] VIEWGAIN_EXPORT BeliefGrid load_octomap(const std::filesystem::path& path,
                                                      const OctomapConfig& config = {});
/// As above for a file's contents; `name` is the file name in messages.
[[nodiscard]] VIEWGAIN_EXPORT BeliefGrid grid_from_octomap_bytes(
    std::string_view bytes, const OctomapConfig& config = {}, const std::string& name = "octree");

/// Resolution [m] from the header of a file's contents, which may be incomplete; `name` is the file
/// name in messages. Throws Error(format) like load_octomap().
[[nodiscard]] VIEWGAIN_EXPORT double octomap_resolution_of_bytes(
    std::string_view bytes, const std::string& name = "octree");

/// Writes a pruned `.ot` that OctoMap and load_octomap() read: states and log-odds, in the world
/// frame if octomap_keeps_frame(grid), otherwise in the grid frame. Beliefs, prior, T_world_grid
/// and views are lost. If a free voxel has the log-odds 0, which means occupied in OctoMap, writes
/// -0.001, which is read back as 0. Atomic. Throws Error(io), Error(invalid_argument) for a name
/// that does not end in .ot, Error(capacity) for a known voxel with an index outside [-32768,
/// 32768). Cost: O(nodes of the tree).
VIEWGAIN_EXPORT void save_octomap(const BeliefGrid& grid, const std::filesystem::path& path);
/// As above, returning the contents of the file.
[[nodiscard]] VIEWGAIN_EXPORT std::string octomap_bytes(const BeliefGrid& grid);

/// Whether save_octomap() writes the tree in the world frame. This requires that T_world_grid is
/// the identity or, to 1e-6 voxel, a shift by whole voxels that stays within the range of a tree's
/// keys. Otherwise the tree must be moved by T_world_grid. Never throws; constant time.
[[nodiscard]] VIEWGAIN_EXPORT bool octomap_keeps_frame(const BeliefGrid& grid);

}  // namespace viewgain
