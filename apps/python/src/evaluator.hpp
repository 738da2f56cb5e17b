// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "arrays.hpp"
#include "gil.hpp"
#include "pose_arrays.hpp"
#include "viewgain/core/sensor.hpp"
#include "viewgain/raycast/gain_evaluator.hpp"
#include "viewgain/raycast/view_measure.hpp"
#include "viewgain/raycast/voxel_scene.hpp"

namespace viewgain::python {

/// Python's VoxelScene. A wrapper, because pybind11 cannot hold pointers to const.
struct Scene {
  std::shared_ptr<const VoxelScene> scene;
};

/// Obstacles from (n, 2, 3) boxes or None, and pairs (vertices, triangles).
[[nodiscard]] Obstacles obstacles_of(const py::object& boxes, const py::iterable& meshes);

/// Needs the GIL.
[[nodiscard]] inline py::object named_outcomes(const GainEvaluator::RayOutcomes& of) {
  return named("RayOutcomes", of.rays, of.unknown, of.known_surface, of.obstacle, of.too_near,
               of.out_of_range, of.out_of_map);
}

/// Python's GainEvaluator.
struct Evaluator {
  py::object scene;  ///< the VoxelScene that it was made with
  Sensor sensor;
  std::string criterion;
  int pixel_stride = 1;
  GainEvaluator evaluator;

  [[nodiscard]] int width() const { return (sensor.camera.width - 1) / pixel_stride + 1; }
  [[nodiscard]] int height() const { return (sensor.camera.height - 1) / pixel_stride + 1; }
};

/// Settings from a GainEvaluator's keywords. Throws ValueError for incompatible ones.
[[nodiscard]] GainConfig gain_config(const std::string& gain, const std::string& criterion,
                                     int pixel_stride, std::optional<double> prior_sigma,
                                     std::optional<double> min_range,
                                     std::optional<double> max_range, const py::iterable& weights,
                                     std::optional<double> refinement_weight,
                                     bool posterior_entropy);

/// A BestViews of results.py. Needs the GIL.
[[nodiscard]] py::object named_views(const BestViews& best);

/// Adds functions for single views: trace, depth, contributions and custom gains.
void bind_views(py::module_& module, py::class_<Evaluator>& evaluator);

/// Data of a ray for a custom gain.
struct OwnHitRow {
  std::array<std::int32_t, 3> voxel;
  std::uint8_t state;
  std::uint32_t readings;
  std::array<float, 6> information;
  std::int64_t ray;
  double range;
  std::array<double, 3> direction;
};

/// A Python callable as a gain; takes the GIL for each view. Throws TypeError if it is not
/// callable.
class PythonMeasure : public ViewMeasure {
 public:
  explicit PythonMeasure(const py::object& callable) : call_(checked(callable)) {}

  double measure(const Pose& T_world_camera,
                 std::span<const ViewMeasure::Hit> hits) const override {
    return with_gil([&] { return asked(T_world_camera, hits); });
  }

 private:
  static py::object checked(const py::object& callable) {
    if (PyCallable_Check(callable.ptr()) == 0) throw py::type_error("measure must be callable");
    return callable;
  }
  double asked(const Pose& T_world_camera, std::span<const ViewMeasure::Hit> hits) const {
    py::array_t<OwnHitRow> rows(static_cast<py::ssize_t>(hits.size()));
    std::transform(hits.begin(), hits.end(), rows.mutable_data(), [](const ViewMeasure::Hit& hit) {
      OwnHitRow row{{hit.voxel.x, hit.voxel.y, hit.voxel.z},
                    static_cast<std::uint8_t>(hit.state),
                    0,
                    {},
                    static_cast<std::int64_t>(hit.ray),
                    hit.range,
                    hit.direction};
      if (hit.belief != nullptr) {
        row.readings = hit.belief->hits;
        row.information = hit.belief->information;
      }
      return row;
    });
    return number(call_(to_array(T_world_camera), rows), "the result of measure");
  }

  PythonCall call_;
};

/// The measure of a keyword that may be None.
[[nodiscard]] inline std::optional<PythonMeasure> measure_or_none(const py::object& measure) {
  if (measure.is_none()) return std::nullopt;
  return std::optional<PythonMeasure>(std::in_place, measure);
}

/// Costs of a keyword, empty for None. Throws ValueError for an empty array.
[[nodiscard]] inline std::vector<double> costs_or_none(const py::object& costs) {
  if (costs.is_none()) return {};
  const Doubles given = doubles(costs, "costs", {-1});
  if (given.size() == 0) throw py::value_error("costs is empty; one cost per pose is required");
  return {given.data(), given.data() + given.size()};
}

}  // namespace viewgain::python
