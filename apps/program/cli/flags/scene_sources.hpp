// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "program/cli/app.hpp"
#include "viewgain/core/pose.hpp"
#include "viewgain/core/sensor.hpp"
#include "viewgain/formats/map_file.hpp"
#include "viewgain/grid/belief_grid.hpp"
#include "viewgain/grid/hazard.hpp"
#include "viewgain/mesh/mesh_io.hpp"
#include "viewgain/raycast/voxel_scene.hpp"

namespace viewgain::app {

/// The file of rates that a value of --hazard names, by its ending, .vdb; empty: none.
[[nodiscard]] std::string hazard_file_of(const std::string& value);

/// Of "size=0.3,5" the longest side of the object [m]; nothing where there is none. Throws
/// Error(invalid_argument).
[[nodiscard]] std::optional<double> object_size_of(const std::string& hazard);

/// What --hazard says of a map's unknown space: nothing (empty: the
/// default by distance and elevation), a rate [1/m] that is the same everywhere, or a .vdb file of
/// rates (load_hazard_vdb). Throws Error(invalid_argument) for a text that is neither, and as
/// load_hazard_vdb().
[[nodiscard]] HazardConfig hazard_source(const std::string& text, const BeliefGrid& grid);

/// Adds --hazard, whose value hazard_source() reads.
void add_hazard_option(App& app, std::string& text);

/// What --size [m], --place center and --up say of a mesh.
[[nodiscard]] MeshPlacement placement_of(std::optional<double> size, const std::string& place,
                                         const std::string& up);

/// Is a value of --obstacle a mesh file, and not the numbers of a box?
[[nodiscard]] bool is_obstacle_file(const std::string& value);

/// What --obstacle says: each value a mesh file (OFF, OBJ, STL, PLY) or a box x0,y0,z0,x1,y1,z1,
/// in the world's frame [m]. Throws Error(invalid_argument), naming the flag, for a box that is
/// none, and as read_mesh().
[[nodiscard]] Obstacles obstacles_of(const std::vector<std::string>& values);

inline constexpr const char* kObstacleHelp =
    "known obstacle: mesh file or box x0,y0,z0,x1,y1,z1, world frame [m]; blocks rays, has no "
    "gain; may be repeated";

// What is allowed and seldom meant: one line on the error output.

/// Voxels so large that there are hardly any.
void warn_of_few_voxels(const BeliefGrid& grid);
/// Faces of a mesh file that cross themselves or have no area.
void warn_of_repairs(const std::string& file, const MeshRepairs& repairs);
/// Poses of a file of which most see nothing of the map (suspect_poses()).
void warn_of_poses(const std::string& file, const std::vector<Pose>& poses,
                   const std::shared_ptr<const VoxelScene>& scene, const Sensor& sensor);

/// A map and the sensor whose views are to be judged on it.
struct SensedMap {
  BeliefGrid grid;
  Sensor sensor;
};

/// The map, and the sensor of `sensor_flag` (--sensor), or, where that is empty, the one that the
/// map's readings come from. Warns on stderr where both are there and differ. Throws
/// Error(invalid_argument) where there is neither, and as load_map() and load_sensor().
[[nodiscard]] SensedMap load_sensed_map(const std::string& path, const std::string& sensor_flag,
                                        const ExecConfig& exec);

/// Sensor::scale_sigma of the map's sensor; 0 where that is not known.
[[nodiscard]] double scale_sigma_of(const BeliefGrid& grid);

/// Do readings of both say the same? Housing and mounting change none.
[[nodiscard]] bool is_same_sensor(const Sensor& a, const Sensor& b);

/// Warns on stderr, and returns true, if a map's readings come from another sensor than `sensor`.
bool warn_of_other_sensor(const std::string& path, const BeliefGrid& grid, const Sensor& sensor);

/// Throws Error(invalid_argument) if all of the map is unknown: nothing can be said by it. `path`
/// names it. Costs a pass over the map's blocks.
void require_known(const BeliefGrid& grid, const std::string& path);

}  // namespace viewgain::app
