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

/// Additional contents of the file.
struct VIEWGAIN_EXPORT VdbWriteConfig {
  /// Adds covariance_diagonal, covariance_offdiagonal and mean_offset, for viewers.
  bool with_covariance = false;
  /// Notes to write instead of the map's, for writers that add notes.
  std::optional<MapNotes> notes{};
};

/// Writes the map as an OpenVDB file with types that OpenVDB's Python module reads. Active voxels
/// are the known ones; apps/docs/reference/formats.md describes the layout. Notes go into the
/// metadata as note_<name>. Atomic: writes a temporary file and renames it. If memory runs out
/// (std::bad_alloc), an existing file remains. Throws Error(io). Throws Error(invalid_argument) if
/// the name of a regular file does not end in .vdb. Also throws whatever BeliefGrid::set_notes()
/// throws. Cost: grows with leaves and beliefs.
VIEWGAIN_EXPORT void save_vdb(const BeliefGrid& grid, const std::filesystem::path& path,
                              const VdbWriteConfig& config = {});

/// Reads a file that save_vdb() or another program wrote in this layout. The map is exactly the
/// saved one, with the same content_hash() and notes. Throws Error(io) if it cannot be opened;
/// Error(format) with the file and the fault if it is truncated, has another layout version or is
/// not a viewgain map; Error(capacity) above 2^27 occupied voxels in tiles, 16 GiB or the available
/// memory. Cost: grows with leaves and beliefs; the threads share the work.
[[nodiscard]] VIEWGAIN_EXPORT BeliefGrid load_vdb(const std::filesystem::path& path,
                                                  const ExecConfig& exec = {});

/// Reads hazard rates for HazardConfig::volume from a .vdb of any program: the float grid [1/m]
/// named "hazard", or the only one, with any linear transform to the world [m]. Each voxel of the
/// map gets the value of the nearest voxel in the file. Where the file has no active voxels, it
/// gets the file's background value. Throws like load_vdb(); Error(format) for a rate that is
/// negative or not finite, several float grids of other names, or a transform that is not linear;
/// Error(invalid_argument) if voxel sizes differ by a factor of 50 or no active voxel lies in the
/// map. Cost: 4 bytes and 50 ns per voxel.
[[nodiscard]] VIEWGAIN_EXPORT HazardConfig::Volume load_hazard_vdb(
    const std::filesystem::path& path, const BeliefGrid& grid);

/// Writes rates of the map's voxels; load_hazard_vdb() reads them back exactly. Atomic. Throws
/// Error(io). Throws Error(invalid_argument) if the name of a regular file does not end in .vdb.
/// Also throws whatever HazardConfig::validate() throws. Cost: one pass over the rates.
VIEWGAIN_EXPORT void save_hazard_vdb(const HazardConfig::Volume& volume, const BeliefGrid& grid,
                                     const std::filesystem::path& path);

}  // namespace viewgain
