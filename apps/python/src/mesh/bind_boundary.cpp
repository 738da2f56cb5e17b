// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <pybind11/stl.h>

#include <array>
#include <cmath>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "arrays.hpp"
#include "gil.hpp"
#include "given.hpp"
#include "mesh/bindings.hpp"
#include "named.hpp"
#include "viewgain/mesh/boundary.hpp"
#include "viewgain/mesh/surface.hpp"
#include "viewgain/mesh/viewpoint_estimator.hpp"
#include "viewgain/planner_mesh/candidate_generation.hpp"
#include "viewgain/support/text.hpp"

namespace viewgain::python {

/// Why a boundary candidate exists.
struct ReasonRow {
  std::uint8_t boundary_class;
  std::uint32_t run;
  double run_length;
  std::uint32_t patch;
  std::array<double, 3> target;
  double distance, tilt, roll;
  bool nominal;
};

namespace {

py::object boundary_candidates(const Given<SurfaceMesh>& given, const py::object& views,
                               const Given<Sensor>& of, double spacing,
                               std::optional<double> working_distance,
                               std::optional<double> overlap,
                               const std::optional<std::vector<double>>& distances,
                               const std::optional<std::vector<double>>& tilts,
                               const std::optional<std::vector<double>>& rolls) {
  const SurfaceMesh& surface = *given;
  const Sensor& sensor = *of;
  if (!(spacing > 0 && std::isfinite(spacing))) {
    throw py::value_error("the spacing must be positive and finite, not " + short_text(spacing));
  }
  const std::vector<Pose> taken = pose_list(views, "views");
  EstimatorConfig config = default_estimator(spacing);
  if (overlap) config.overlap = *overlap;
  if (distances) config.distances = *distances;
  if (tilts) config.tilts = *tilts;
  if (rolls) config.rolls = *rolls;
  EstimatedViews estimated;
  {
    const WithoutGil without_gil;
    estimated = estimate_views(surface, taken, sensor,
                               working_distance.value_or(sensor.working_distance), config);
  }
  std::vector<Pose> poses;
  std::vector<ReasonRow> reasons;
  for (const BoundaryCandidate& c : estimated.candidates) {
    poses.push_back(c.T_world_camera);
    reasons.push_back({static_cast<std::uint8_t>(c.boundary_class),
                       c.run,
                       estimated.runs[c.run].length,
                       c.patch,
                       {c.target.x(), c.target.y(), c.target.z()},
                       c.distance,
                       c.tilt,
                       c.roll,
                       c.nominal});
  }
  return named_in("viewgain.mesh.results", "BoundaryCandidates",
                  to_array(poses, {static_cast<py::ssize_t>(poses.size())}),
                  to_array_1d<ReasonRow>(reasons));
}

}  // namespace

void bind_boundary(py::module_& module) {
  PYBIND11_NUMPY_DTYPE(ReasonRow, boundary_class, run, run_length, patch, target, distance, tilt,
                       roll, nominal);
  py::list classes;
  for (const BoundaryClass c :
       {BoundaryClass::left, BoundaryClass::right, BoundaryClass::top, BoundaryClass::bottom}) {
    classes.append(std::string(boundary_class_name(c)));
  }
  module.attr("BOUNDARY_CLASS_NAMES") = py::tuple(classes);

  module.def("boundary_candidates", &boundary_candidates, py::arg("surface"), py::arg("views"),
             py::arg("sensor"), py::kw_only(), py::arg("spacing"),
             py::arg("working_distance") = py::none(), py::arg("overlap") = py::none(),
             py::arg("distances") = py::none(), py::arg("tilts") = py::none(),
             py::arg("rolls") = py::none(),
             R"(Views that look past the open boundaries of a surface, and why.

Runs without the GIL. Cost: grows with the boundary's edges and the views, 3 ms for a surface of 19,000
vertices that 12 views saw.

Parameters
----------
surface : Surface
views : array_like, (n, 4, 4)
    T_world_camera of the views that saw it, in order; at least one.
sensor : Sensor
spacing : float
    How far apart its points are [m]: ``grid.pooling_length()`` of the map.
working_distance : float, optional
    From the surface [m]; the sensor's unless given.
overlap : float, optional
    Share of the next view that shows known surface, in (0, 1).
distances : sequence of float, (n,), optional
    Multiples of the working distance.
tilts, rolls : sequence of float, (n,), optional
    [rad]; all combinations are tried.

Returns
-------
BoundaryCandidates
    A named tuple of the two.
T_world_camera : ndarray, (n, 4, 4), float64
    What stands in their way is for ``FeasibilityChecker`` to say.
reasons : ndarray, (n,), structured
    boundary_class (index into ``BOUNDARY_CLASS_NAMES``), run (of boundary edges), run_length [m],
    patch, target (the extrapolated point looked at, 3, world [m]), distance from it [m], tilt, roll [rad],
    nominal (neither tilted nor rolled, at the first distance).

Raises
------
ValueError
    A shape, a bad pose, no view, an overlap outside (0, 1), an empty list, a length that is not
    positive.
TypeError
    It is no surface, or no sensor.)");
}

}  // namespace viewgain::python
