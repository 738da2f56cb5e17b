// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <memory>
#include <span>
#include <vector>

#include "viewgain/core/export.hpp"
#include "viewgain/core/planning.hpp"
#include "viewgain/planner_mesh/surface_model.hpp"
#include "viewgain/planner_mesh/truth.hpp"
#include "viewgain/raycast/simulated_sensor.hpp"
#include "viewgain/raycast/surface_scene.hpp"

namespace viewgain {

/// The object as nobody knows it who has yet to model it.
struct VIEWGAIN_EXPORT KnownObject {
  std::shared_ptr<const SurfaceScene> mesh;  ///< the object
  std::shared_ptr<const Truth> truth;        ///< how much of it is covered
  SimulationConfig simulation{};             ///< of its surroundings; noise is left out
};

/// The choice of one who knows the object: an upper reference for planners, and no planner. Looks
/// one view ahead, so that a sequence of views may still be better.
///
/// Thread safety: one call at a time. Deterministic, for any number of threads. Members that throw
/// say so.
class VIEWGAIN_EXPORT OracleChoice {
 public:
  /// Candidates that are simulated.
  static constexpr std::size_t kSimulated = 8;

  /// The model must outlive it. Throws Error(invalid_argument) without a mesh or truth.
  OracleChoice(const SurfaceModel& model, const Sensor& sensor, const KnownObject& object,
               const ExecConfig& exec);

  /// Of the candidates, whose order matters for ties only, the 8 that see most samples of the mesh
  /// that the surface does not cover yet, unoccluded and at under 72°, are simulated without noise,
  /// one frame each into a copy of the map; the index of the one after which the map's points cover
  /// most samples. Ties go to the lower index, in the ranking too. There must be a candidate, which
  /// is not checked; throws as covered_after(). Takes some seconds for a thousand candidates.
  [[nodiscard]] std::size_t next(std::span<const Candidate> candidates) const;

  /// How many of the samples that the surface does not cover yet each candidate sees, in their
  /// order. Costs up to two rays a sample and candidate.
  [[nodiscard]] std::vector<std::size_t> uncovered_in_view(
      std::span<const Candidate> candidates) const;
  /// How many samples the map's points cover after a frame from there. Throws as
  /// SimulatedSensor::acquire(). Costs a simulated frame and a copy of the map.
  [[nodiscard]] std::size_t covered_after(const Pose& T_world_camera) const;

 private:
  const SurfaceModel& model_;
  Sensor sensor_;
  KnownObject object_;
  ExecConfig exec_;
  SimulatedSensor camera_;
};

}  // namespace viewgain
