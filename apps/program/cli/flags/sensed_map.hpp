// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "viewgain/core/sensor.hpp"
#include "viewgain/formats/map_file.hpp"

namespace viewgain::app {

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

/// Do readings of both say the same? Housing and mounting change none.
[[nodiscard]] bool is_same_sensor(const Sensor& a, const Sensor& b);

/// Warns on stderr, and returns true, if a map's readings come from another sensor than `sensor`.
bool warn_of_other_sensor(const std::string& path, const MapOfSensor& map, const Sensor& sensor);

/// Throws Error(invalid_argument) if all of the map is unknown: nothing can be said by it. `path`
/// names it. Costs a pass over the map's blocks.
void require_known(const BeliefGrid& grid, const std::string& path);

}  // namespace viewgain::app
