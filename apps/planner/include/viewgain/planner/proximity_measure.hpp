// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>

#include "viewgain/core/export.hpp"
#include "viewgain/core/sensor.hpp"
#include "viewgain/grid/hazard.hpp"
#include "viewgain/raycast/view_measure.hpp"

namespace viewgain {

/// How much unknown space near known surface a view's rays pass: the sum over rays of all unknown
/// voxels before the ray's end of max(0, 1 - d / D), d the distance of the voxel's hazard cell from
/// the surface seen so far, D the hazard's cut (5 decay lengths). 0 while no surface is known. Cost
/// of measure(): O(runs); of the constructor constant time.
class VIEWGAIN_EXPORT ProximityMeasure : public RunMeasure {
 public:
  /// The field, that of the evaluator's scene, must outlive it.
  explicit ProximityMeasure(const HazardField& hazard);

  /// That sum, without a unit.
  [[nodiscard]] double measure(const Pose& T_world_camera,
                               std::span<const RunMeasure::Run> runs) const override;

 private:
  const HazardField& hazard_;
  double cut_;  // D [m]
};

/// The pixel stride at which a view of the sensor has about 400 rays, which rank views nearly as
/// well as all. Checks nothing.
[[nodiscard]] VIEWGAIN_EXPORT int coarse_stride(const PinholeCamera& camera);

}  // namespace viewgain
