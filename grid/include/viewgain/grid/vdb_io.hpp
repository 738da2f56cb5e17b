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

/// Additional contents of a map file.
struct VIEWGAIN_EXPORT VdbWriteConfig {
  /// Adds the grids covariance_diagonal, covariance_offdiagonal and mean_offset, for viewers.
  bool with_covariance = false;
  /// Notes to write instead of the map's own.
  std::optional<MapNotes> notes{};
};

/// Writes a map as an OpenVDB file, which OpenVDB's Python module can read.
/// apps/docs/reference/formats.md describes the layout. Atomic: writes a temporary file and renames
/// it, so an existing file remains after an error. Throws Error(io) if the file cannot be written,
/// and Error(invalid_argument) if the name of a regular file does not end in .vdb. Also throws
/// std::bad_alloc, and whatever BeliefGrid::set_notes() throws. Cost: linear in leaves and beliefs.
VIEWGAIN_EXPORT void save_vdb(const BeliefGrid& grid, const std::filesystem::path& path,
                              const VdbWriteConfig& config = {});

/// Reads a map that save_vdb(), or another program, wrote in this layout. The map is exactly the
/// saved one, with the same content_hash() and notes. Throws Error(io) if the file cannot be
/// opened. Throws Error(format) if it is truncated, has another layout version or is not a viewgain
/// map. Throws Error(capacity) if it exceeds 16 GiB, the available memory, or 2^27 occupied voxels
/// in OpenVDB's tiles. Cost: linear in leaves and beliefs, shared by the threads.
[[nodiscard]] VIEWGAIN_EXPORT BeliefGrid load_vdb(const std::filesystem::path& path,
                                                  const ExecConfig& exec = {});

/// Reads hazard rates [1/m] for HazardConfig::volume from a .vdb file of any program. Takes the
/// float grid "hazard", or the only float grid. Its transform to the world [m] must be linear. Each
/// voxel of the map gets the value of the nearest voxel in the file, or the background value if
/// that voxel is not active. Throws Error(io) and Error(capacity) as load_vdb() does. Throws
/// Error(format) if a rate is negative or not finite, the float grid is ambiguous, or the transform
/// is not linear. Throws Error(invalid_argument) if the voxel sizes of file and map differ by more
/// than a factor of 50, or no active voxel lies in the map. Cost: 4 bytes and 50 ns per voxel.
[[nodiscard]] VIEWGAIN_EXPORT HazardConfig::Volume load_hazard_vdb(
    const std::filesystem::path& path, const BeliefGrid& grid);

/// Writes hazard rates of the map's voxels. load_hazard_vdb() reads them back exactly. Atomic:
/// renames a temporary file. Throws Error(io) if the file cannot be written, and
/// Error(invalid_argument) if the name of a regular file does not end in .vdb. Also throws whatever
/// HazardConfig::validate() throws. Cost: one pass over the rates.
VIEWGAIN_EXPORT void save_hazard_vdb(const HazardConfig::Volume& volume, const BeliefGrid& grid,
                                     const std::filesystem::path& path);

}  // namespace viewgain
