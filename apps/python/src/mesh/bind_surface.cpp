// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <pybind11/stl.h>

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "arrays.hpp"
#include "classes.hpp"
#include "gil.hpp"
#include "given.hpp"
#include "map/shared_grid.hpp"
#include "pose_arrays.hpp"
#include "viewgain/formats/ply.hpp"
#include "viewgain/mesh/boundary.hpp"
#include "viewgain/mesh/surface.hpp"
#include "viewgain/mesh/viewpoint_estimator.hpp"
#include "viewgain/planner_mesh/candidate_generation.hpp"
#include "viewgain/planner_mesh/surface_model.hpp"
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
  const EstimatedViews estimated = outside_gil([&] {
    return estimate_views(surface, taken, sensor,
                          working_distance.value_or(sensor.working_distance), config);
  });
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

  module.def("boundary_candidates", &boundary_candidates, "surface"_a, "views"_a, "sensor"_a,
             py::kw_only(), "spacing"_a, "working_distance"_a = py::none(),
             "overlap"_a = py::none(), "distances"_a = py::none(), "tilts"_a = py::none(),
             "rolls"_a = py::none(),
             R"(Candidate views of the space beyond the open boundaries of a surface.

A boundary run is a part of the boundary at which the surface ends on the same image side. A patch
is a quadric that is fitted to the surface at a boundary run and extrapolated; the views look at it.
Runs without the GIL. Cost: grows with the boundary's edges and the views; 3 ms for a surface of
19,000 vertices and 12 views.

Parameters
----------
surface : Surface
views : array_like, (n, 4, 4)
    T_world_camera of the views from which the surface was made, in order; at least one.
sensor : Sensor
spacing : float
    Distance between neighbouring points of the surface [m]: ``grid.pooling_length()`` of the map.
working_distance : float, optional
    Distance from the surface [m]; default: the sensor's.
overlap : float, optional
    Fraction of the image that known surface should fill, in (0, 1).
distances : sequence of float, (n,), optional
    Distances of the camera, as multiples of the working distance.
tilts, rolls : sequence of float, (n,), optional
    Angles [rad]. There is a candidate for each combination of distance, tilt and roll.

Returns
-------
BoundaryCandidates
    Check them with ``FeasibilityChecker``. Fields of reasons: boundary_class (index into
    ``BOUNDARY_CLASS_NAMES``), run (number of the boundary run), run_length (its length [m]), patch
    (number of the patch), target (3: point that the view looks at, world frame [m]), distance (from
    the target [m]), tilt and roll ([rad]), nominal (whether tilt and roll are 0 and the distance is
    the first).)");
}

namespace {

SurfaceMesh surface_of_points(const py::object& positions, const py::object& toward_free,
                              double spacing, unsigned smoothing_neighbors, double max_edge,
                              double join_distance, std::size_t min_component, int num_threads) {
  const auto where = points(positions, "points");
  std::vector<OrientedPoint> oriented(where.size());
  for (std::size_t i = 0; i < where.size(); ++i) oriented[i].position = where[i];
  if (!toward_free.is_none()) {
    const auto hints = points(toward_free, "toward_free");
    if (hints.size() != where.size()) {
      throw py::value_error(
          "toward_free must have one row per point; points: " + std::to_string(where.size()) +
          ", rows: " + std::to_string(hints.size()));
    }
    for (std::size_t i = 0; i < where.size(); ++i) oriented[i].toward_free = hints[i];
  }
  const SurfaceConfig config{spacing, smoothing_neighbors, max_edge, join_distance, min_component};
  const WithoutGil without_gil;
  return reconstruct_surface(oriented, config, ExecConfig{num_threads});
}

SurfaceMesh surface_of_grid(const Given<SharedGrid>& grid, std::uint32_t min_hits,
                            int num_threads) {
  FusedPointsConfig config;
  config.min_hits = min_hits;
  return grid->read([&](const BeliefGrid& g) {
    const ExecConfig exec{num_threads};
    return surface_of(fused_points(g, config, exec), exec);
  });
}

// An optional Python package.
py::module_ other_package(const char* name, const char* wanted_by) {
  try {
    return py::module_::import(name);
  } catch (py::error_already_set& error) {
    if (!error.matches(PyExc_ImportError)) throw;
    py::raise_from(error, PyExc_ImportError,
                   (std::string(wanted_by) + " needs the package " + name +
                    ", which cannot be imported; Surface.save writes a .ply without it")
                       .c_str());
    throw py::error_already_set();
  }
}

py::object to_trimesh(const SurfaceMesh& surface) {
  const py::module_ trimesh = other_package("trimesh", "to_trimesh");
  // Unprocessed, because trimesh would merge vertices and lose their normals.
  return trimesh.attr("Trimesh")(
      "vertices"_a = to_array_3(surface.vertices), "faces"_a = to_array_3(surface.triangles),
      "vertex_normals"_a = to_array_3(surface.normals), "process"_a = false);
}

py::object to_open3d(const SurfaceMesh& surface) {
  const py::module_ open3d = other_package("open3d", "to_open3d");
  const py::object utility = open3d.attr("utility"), vectors = utility.attr("Vector3dVector");
  const py::object triangles = to_array_3(surface.triangles).attr("astype")("int32");
  py::object mesh = open3d.attr("geometry").attr("TriangleMesh")();
  mesh.attr("vertices") = vectors(to_array_3(surface.vertices));
  mesh.attr("vertex_normals") = vectors(to_array_3(surface.normals));
  mesh.attr("triangles") = utility.attr("Vector3iVector")(triangles);
  return mesh;
}

}  // namespace

void bind_surface(py::module_& module) {
  auto type = bound_class<SurfaceMesh>(
      module, "Surface",
      R"(An open, oriented triangle surface. Made by ``reconstruct_surface``,
``surface_of_grid`` and ``reconstruct``.

Seen from free space, the vertices of a face are in counter-clockwise order. Lengths are in metres,
in the frame of the input points, which is the world frame for a map. Surfaces are equal if their
arrays are.

Notes
-----
Cost: each property is a copy, 30 µs for 20,000 vertices. Only ``save`` releases the GIL.)");
  refuse_pickling(type);
  type.def_property_readonly(
          "vertices", [](const SurfaceMesh& s) { return to_array_3(s.vertices); },
          "ndarray, (n, 3), float64: positions in the frame of the input points [m]")
      .def_property_readonly(
          "normals", [](const SurfaceMesh& s) { return to_array_3(s.normals); },
          "ndarray, (n, 3), float64: unit normals of the vertices, towards free space")
      .def_property_readonly(
          "triangles", [](const SurfaceMesh& s) { return to_array_3(s.triangles); },
          "ndarray, (m, 3), uint32: indices of vertices")
      .def_property_readonly(
          "source", [](const SurfaceMesh& s) { return to_array_1d<std::uint32_t>(s.source); },
          "ndarray, (n,), uint32: index of the input point of each vertex")
      .def(
          "save",
          [](const SurfaceMesh& self, const py::object& path) {
            const std::string file = writable_file(path);
            const WithoutGil without_gil;
            write_ply(file, {self.vertices, self.normals, {}, self.triangles});
          },
          "path"_a,
          R"(Writes vertices, normals and triangles as binary PLY. Atomic.

Parameters
----------
path : path-like
    Must end in .ply.)")
      .def("to_trimesh", &to_trimesh, R"(The surface for trimesh, with its normals.

Returns
-------
trimesh.Trimesh
    A copy [m] with all vertices.)")
      .def("to_open3d", &to_open3d, R"(The surface for Open3D, with its normals.

Returns
-------
open3d.geometry.TriangleMesh
    A copy [m].)")
      .def(
          "__eq__",
          [](const SurfaceMesh& a, const SurfaceMesh& b) {
            return a.vertices == b.vertices && a.normals == b.normals &&
                   a.triangles == b.triangles && a.source == b.source;
          },
          py::is_operator())
      .def("__repr__", [](const SurfaceMesh& s) {
        return "<Surface " + std::to_string(s.vertices.size()) + " vertices, " +
               std::to_string(s.triangles.size()) + " triangles>";
      });

  const SurfaceConfig defaults;
  module.def("reconstruct_surface", &surface_of_points, "points"_a, "toward_free"_a = py::none(),
             py::kw_only(), "spacing"_a, "smoothing_neighbors"_a = defaults.smoothing_neighbors,
             "max_edge"_a = defaults.max_edge, "join_distance"_a = defaults.join_distance,
             "min_component"_a = defaults.min_component, "num_threads"_a = 0,
             R"(The open surface through points. Holes larger than max_edge stay open.

Runs without the GIL. Cost: about 20 µs per point on two threads.

Parameters
----------
points : array_like, (n, 3)
    Points in any frame [m].
toward_free : array_like, (n, 3), optional
    One vector per point towards free space, of any length; zero if unknown.
spacing : float
    Typical distance between neighbouring points [m].
smoothing_neighbors : int
    Number of neighbours in the jet fit that smooths a point; 0: no smoothing.
max_edge, join_distance : float
    max_edge is the longest edge of a triangle. join_distance is the distance within which points
    belong to one component. Both are in units of spacing.
min_component : int
    Omits components with fewer points, as outliers.
num_threads : int
    0: all hardware threads. Does not affect the result.

Returns
-------
Surface
    Empty if there are no points, or only outliers.)");
  module.def("surface_of_grid", &surface_of_grid, "grid"_a, py::kw_only(), "min_hits"_a = 2,
             "num_threads"_a = 0,
             R"(The surface through ``grid.points(min_hits=min_hits)``.

Runs without the GIL. Meanwhile, other threads may read the grid; threads that change it wait. Cost:
0.7 s for 40,000 occupied voxels on two threads.

Parameters
----------
grid : viewgain.BeliefGrid
min_hits : int
    Omits points with fewer readings (measured depths).
num_threads : int
    0: all hardware threads. Does not affect the result.

Returns
-------
Surface
    World frame.)");
}

}  // namespace viewgain::python
