// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>

#include "viewgain/core/exec_config.hpp"
#include "viewgain/core/export.hpp"
#include "viewgain/grid/belief_grid.hpp"
#include "viewgain/grid/hazard.hpp"

namespace viewgain {

/// What goes into the file besides the map.
struct VIEWGAIN_EXPORT VdbWriteConfig {
  /// Adds covariance_diagonal, covariance_offdiagonal and mean_offset, for viewers.
  bool with_covariance = false;
  /// In place of the map's own, for a writer with more to say than the map.
  std::optional<MapNotes> notes{};
};

/// Writes the map as a plain OpenVDB file (active = known; apps/docs/reference/formats.md has the
/// layout), of types that OpenVDB's Python module reads. Atomic: a temporary file beside it is
/// renamed. The map's notes are in the file's metadata, as note_<name>. Throws Error(io), and
/// Error(invalid_argument) for a name that does not end in .vdb (not of pipes and devices) and as
/// BeliefGrid::set_notes(). If memory runs out (std::bad_alloc), the file that was there stays.
/// Cost: grows with the leaves and beliefs of the map.
VIEWGAIN_EXPORT void save_vdb(const BeliefGrid& grid, const std::filesystem::path& path,
                              const VdbWriteConfig& config = {});

/// Reads a file that save_vdb wrote, or another program in the same layout; exact: the loaded map
/// has the saved one's content_hash() and notes. Throws Error(io) if it cannot be opened and
/// Error(format), naming the file and what is missing or out of bounds, if it is truncated, of
/// another version of the layout or no viewgain map; Error(capacity) if tiles hold more than 2^27
/// occupied voxels, or the file is over 16 GiB or does not fit into memory. Cost: grows with the
/// leaves and beliefs of the map, shared by the threads; the file is read once.
[[nodiscard]] VIEWGAIN_EXPORT BeliefGrid load_vdb(const std::filesystem::path& path,
                                                  const ExecConfig& exec = {});

/// Rates of the unknown for HazardConfig::volume, from a .vdb file of any program, say a prior of
/// the object's shape: the grid of floats [1/m] named "hazard", or the only one. Its transform may
/// be any linear one to the world [m]; each voxel of the map has the value at its centre, of the
/// file's nearest voxel. Where the file has no active voxels its background holds. Throws as
/// load_vdb(), and Error(format) for a rate that is negative or not finite, a file with several
/// grids of floats of other names, or a transform that is not linear; and Error(invalid_argument)
/// if active voxels are 50 times as large or as small as the map's, or all outside of it. 4 bytes,
/// and some 50 ns, per voxel of the map in the box of active ones.
[[nodiscard]] VIEWGAIN_EXPORT HazardConfig::Volume load_hazard_vdb(
    const std::filesystem::path& path, const BeliefGrid& grid);

/// Writes rates of voxels of the map's lattice as such a file; load_hazard_vdb() reads the same.
/// Atomic; names as in save_vdb(). Throws Error(invalid_argument) as HazardConfig::validate() and
/// for another name, Error(io).
/// Cost: a pass over the rates.
VIEWGAIN_EXPORT void save_hazard_vdb(const HazardConfig::Volume& volume, const BeliefGrid& grid,
                                     const std::filesystem::path& path);

}  // namespace viewgain
