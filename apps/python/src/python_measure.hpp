// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "arrays.hpp"
#include "gil.hpp"
#include "python_call.hpp"
#include "viewgain/raycast/view_measure.hpp"

namespace viewgain::python {

/// What a gain of the user's own sees of a ray.
struct OwnHitRow {
  std::array<std::int32_t, 3> voxel;
  std::uint8_t state;
  std::uint32_t readings;
  std::array<float, 6> information;
  std::int64_t ray;
  double range;
  std::array<double, 3> direction;
};

/// A Python callable as a gain; takes the GIL for each view. Throws TypeError for what cannot be
/// called.
class PythonMeasure : public ViewMeasure {
 public:
  explicit PythonMeasure(const pybind11::object& callable) : call_(checked(callable)) {}

  double measure(const Pose& T_world_camera,
                 std::span<const ViewMeasure::Hit> hits) const override {
    return with_gil([&] { return asked(T_world_camera, hits); });
  }

 private:
  static pybind11::object checked(const pybind11::object& callable) {
    if (PyCallable_Check(callable.ptr()) == 0)
      throw pybind11::type_error("measure must be callable");
    return callable;
  }
  double asked(const Pose& T_world_camera, std::span<const ViewMeasure::Hit> hits) const {
    pybind11::array_t<OwnHitRow> rows(static_cast<pybind11::ssize_t>(hits.size()));
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
    return number(call_(to_array(T_world_camera), rows), "what measure returns");
  }

  PythonCall call_;
};

/// The measure of a keyword that may be None.
[[nodiscard]] inline std::optional<PythonMeasure> measure_or_none(const pybind11::object& measure) {
  if (measure.is_none()) return std::nullopt;
  return std::optional<PythonMeasure>(std::in_place, measure);
}

/// Costs of a keyword that may be None, then empty. Throws ValueError for none at all.
[[nodiscard]] inline std::vector<double> costs_or_none(const pybind11::object& costs) {
  if (costs.is_none()) return {};
  const Doubles given = doubles(costs, "costs", {-1});
  if (given.size() == 0) throw pybind11::value_error("costs is empty: one a pose is needed");
  return {given.data(), given.data() + given.size()};
}

}  // namespace viewgain::python
