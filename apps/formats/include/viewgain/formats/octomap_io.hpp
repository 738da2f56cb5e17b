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

/// What an octree does not say about a map.
struct VIEWGAIN_EXPORT OctomapConfig {
  /// Part of the tree to take, in the tree's frame [m], grown to whole voxels; default: the box of
  /// its known voxels. What the tree does not cover is unknown.
  std::optional<Box> workspace{};
  std::optional<double> prior_sigma{};  ///< [m]; default: voxel / 2, no sensor being known
  /// Log-odds from which a voxel of a `.ot` is occupied; 0 is OctoMap's default, probability 0.5.
  float occupied_from = 0;
};

/// Reads OctoMap's `.ot` (trees of the type OcTree or ColorOcTree, colours left out) or `.bt`;
/// which of them it is stands in the file's first line. Needs no OctoMap library.
///
/// The lattices are the same: the voxel with OctoMap's key k is [k - 32768, k - 32767) times the
/// resolution. Occupied, free and unknown are kept. A `.ot`'s log-odds are rounded to steps of 0.05
/// and clamped to [-2, 3.5], on their side of `occupied_from`: an occupied voxel has at least 0.05,
/// a free one at most 0. A `.bt` says only which is likelier: 3.5 where occupied, -2 where free, as
/// in OctoMap's own reader. Voxels have no beliefs (as in BeliefGrid::from_states), the map no
/// views. A pruned leaf costs a tile where it is free, a block per 8³ voxels where it is occupied.
/// Pruned leaves of more than 2^27 occupied voxels in the workspace are refused: a file of a
/// hundred bytes can ask for all of the memory with them.
///
/// Throws Error(io) if the file cannot be read; Error(format), naming the file and the line or the
/// byte, if it is cut, has another count of nodes than it says, a value that is no number, or no
/// known voxel and no workspace is given; Error(capacity), naming the file, for what is too large;
/// Error(invalid_argument) as BeliefGrid.
[[nodiscard]] VIEWGAIN_EXPORT BeliefGrid load_octomap(const std::filesystem::path& path,
                                                      const OctomapConfig& config = {});
/// The same of a file's contents; `name` stands for the file in messages.
[[nodiscard]] VIEWGAIN_EXPORT BeliefGrid grid_from_octomap_bytes(
    std::string_view bytes, const OctomapConfig& config = {}, const std::string& name = "octree");

/// The resolution of a file's contents [m], or of the first part of them, from its header alone;
/// `name` stands for the file in messages. Throws Error(format) as load_octomap.
[[nodiscard]] VIEWGAIN_EXPORT double octomap_resolution_of_bytes(
    std::string_view bytes, const std::string& name = "octree");

/// Writes a `.ot` that OctoMap and load_octomap read, pruned: states and log-odds, in the world's
/// frame where octomap_keeps_frame(grid), else in the grid's. A tree has no place for beliefs,
/// prior, T_world_grid and views. A free voxel's log-odds of 0 is written as -0.001, since OctoMap
/// calls 0 occupied; read back it is 0 again. Atomic: a temporary file is renamed. Throws
/// Error(io), Error(invalid_argument) for a name that does not end in .ot, Error(capacity) if a
/// known voxel's index is not in [-32768, 32768). Cost: O(nodes of the tree).
VIEWGAIN_EXPORT void save_octomap(const BeliefGrid& grid, const std::filesystem::path& path);
/// The same as the contents of that file.
[[nodiscard]] VIEWGAIN_EXPORT std::string octomap_bytes(const BeliefGrid& grid);

/// Whether a tree's voxels would lie in the world where the grid's do: T_world_grid is the
/// identity, or (to 1e-6 voxel) moves the workspace by whole voxels and not out of a tree's space.
/// Otherwise the frame is lost, and the tree is to be moved by T_world_grid. Never throws; takes
/// constant time.
[[nodiscard]] VIEWGAIN_EXPORT bool octomap_keeps_frame(const BeliefGrid& grid);

}  // namespace viewgain
