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

/// The .vdb file of rates in a value of --hazard; empty if there is none.
[[nodiscard]] std::string hazard_file_of(const std::string& value);

/// The longest side of the object [m] in a value such as "size=0.3,5", if any. Throws
/// Error(invalid_argument).
[[nodiscard]] std::optional<double> object_size_of(const std::string& hazard);

/// The hazard of a map's unknown space according to --hazard: empty for the default model, a
/// constant rate [1/m], or a .vdb file of rates (load_hazard_vdb()). Throws Error(invalid_argument)
/// for other text. Also throws whatever load_hazard_vdb() throws.
[[nodiscard]] HazardConfig hazard_source(const std::string& text, const BeliefGrid& grid);

/// Adds --hazard, whose value hazard_source() reads.
void add_hazard_option(App& app, std::string& text);

/// The placement of a mesh by --size [m], --place center and --up.
[[nodiscard]] MeshPlacement placement_of(std::optional<double> size, const std::string& place,
                                         const std::string& up);

/// Whether a value of --obstacle is a mesh file instead of the numbers of a box.
[[nodiscard]] bool is_obstacle_file(const std::string& value);

/// The obstacles of --obstacle: each value is a mesh file (OFF, OBJ, STL, PLY) or a box
/// x0,y0,z0,x1,y1,z1, world frame [m]. Throws Error(invalid_argument), naming the flag, for an
/// invalid box. Also throws whatever read_mesh() throws.
[[nodiscard]] Obstacles obstacles_of(const std::vector<std::string>& values);

inline constexpr const char* kObstacleHelp =
    "obstacle, which blocks rays and has no gain: mesh file or box x0,y0,z0,x1,y1,z1, world "
    "frame [m]; may be repeated";

// Warnings about input that is valid but rarely intended: one line on the error output.

/// Voxels so large that there are only a few.
void warn_of_few_voxels(const BeliefGrid& grid);
/// Faces of a mesh file that cross themselves or have no area.
void warn_of_repairs(const std::string& file, const MeshRepairs& repairs);
/// A file of poses most of which do not see the map (suspect_poses()).
void warn_of_poses(const std::string& file, const std::vector<Pose>& poses,
                   const std::shared_ptr<const VoxelScene>& scene, const Sensor& sensor);

/// A map and the sensor whose views are scored on it.
struct SensedMap {
  BeliefGrid grid;
  Sensor sensor;
};

/// The map, and the sensor of `sensor_flag` (--sensor) or, if empty, the sensor that measured the
/// map. Warns on stderr if both exist and differ. Throws Error(invalid_argument) if both are
/// missing. Also throws whatever load_map() and load_sensor() throw.
[[nodiscard]] SensedMap load_sensed_map(const std::string& path, const std::string& sensor_flag,
                                        const ExecConfig& exec);

/// Sensor::scale_sigma of the map's sensor; 0 if the sensor is unknown.
[[nodiscard]] double scale_sigma_of(const BeliefGrid& grid);

/// Whether the two sensors measure alike. Housing and mounting do not matter.
[[nodiscard]] bool is_same_sensor(const Sensor& a, const Sensor& b);

/// Warns on stderr, and returns true, if another sensor than `sensor` measured the map.
bool warn_of_other_sensor(const std::string& path, const BeliefGrid& grid, const Sensor& sensor);

/// Throws Error(invalid_argument) with `path` if the whole map is unknown. Cost: a pass over the
/// map's blocks.
void require_known(const BeliefGrid& grid, const std::string& path);

}  // namespace viewgain::app
