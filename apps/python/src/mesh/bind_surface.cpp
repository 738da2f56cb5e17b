// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <pybind11/stl.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "arrays.hpp"
#include "classes.hpp"
#include "gil.hpp"
#include "given.hpp"
#include "map/shared_grid.hpp"
#include "mesh/bindings.hpp"
#include "sealed_bytes.hpp"
#include "viewgain/formats/ply.hpp"
#include "viewgain/mesh/surface.hpp"
#include "viewgain/planner_mesh/surface_model.hpp"

namespace viewgain::python {

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
      throw py::value_error("toward_free has " + std::to_string(hints.size()) + " rows for " +
                            std::to_string(where.size()) + " points");
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
    return surface_of(fused_points(g, config, exec), pooling_of(g.snapshot()), exec);
  });
}

// What a pickle is of.
constexpr const char* kKind = "viewgain surface 1\n";

py::bytes bytes_of(const SurfaceMesh& surface) {
  SealedWriter writer(kKind);
  writer.add(surface.vertices);
  writer.add(surface.normals);
  writer.add(surface.triangles);
  writer.add(surface.source);
  return writer.seal();
}

SurfaceMesh from_bytes(const py::bytes& data) {
  const auto bytes = data.cast<std::string>();
  SealedReader reader(kKind, bytes, "surface");
  SurfaceMesh surface;
  surface.vertices = reader.next<std::array<double, 3>>();
  surface.normals = reader.next<std::array<double, 3>>();
  surface.triangles = reader.next<std::array<std::uint32_t, 3>>();
  surface.source = reader.next<std::uint32_t>();
  reader.require_end();
  const std::size_t count = surface.vertices.size();
  if (surface.normals.size() != count || surface.source.size() != count) reader.refuse();
  for (const auto& triangle : surface.triangles) {
    if (*std::max_element(triangle.begin(), triangle.end()) >= count) reader.refuse();
  }
  return surface;
}

// A Python package that viewgain can do without.
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
  // As it is: trimesh would merge vertices and lose their normals.
  return trimesh.attr("Trimesh")(py::arg("vertices") = to_array_3(surface.vertices),
                                 py::arg("faces") = to_array_3(surface.triangles),
                                 py::arg("vertex_normals") = to_array_3(surface.normals),
                                 py::arg("process") = false);
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

Faces turn counter-clockwise seen from free space. Lengths are [m], in the frame of the points that
it was made of: the world's, of a map. Surfaces are equal by value and can be pickled.

Notes
-----
Cost: linear in vertices and triangles: each property is a copy, 30 µs for 20,000 vertices. ``save``
leaves the GIL, the rest holds it.)");
  pickle_as_bytes(type);
  type.def_property_readonly(
          "vertices", [](const SurfaceMesh& s) { return to_array_3(s.vertices); },
          "ndarray, (n, 3), float64: in the surface's frame, of a map the world's [m]")
      .def_property_readonly(
          "normals", [](const SurfaceMesh& s) { return to_array_3(s.normals); },
          "ndarray, (n, 3), float64: unit vectors in the surface's frame, of a map the world's; "
          "towards free space")
      .def_property_readonly(
          "triangles", [](const SurfaceMesh& s) { return to_array_3(s.triangles); },
          "ndarray, (m, 3), uint32: indices of vertices")
      .def_property_readonly(
          "source", [](const SurfaceMesh& s) { return to_array_1d<std::uint32_t>(s.source); },
          "ndarray, (n,), uint32: the input point of each vertex")
      .def(
          "save",
          [](const SurfaceMesh& self, const py::object& path) {
            const std::string file = file_path(path);
            require_writable(file);
            const WithoutGil without_gil;
            write_ply(file, {self.vertices, self.normals, {}, self.triangles});
          },
          py::arg("path"),
          R"(Writes vertices, normals and triangles as binary PLY, whole or not at all.

Parameters
----------
path : path-like
    .ply by custom.

Raises
------
OSError
    It cannot be written.)")
      .def("to_bytes", &bytes_of, R"(The surface as bytes, for ``from_bytes`` and pickles.

Returns
-------
bytes
    In this machine's byte order.)")
      .def_static("from_bytes", &from_bytes, py::arg("data"),
                  R"(The surface that ``to_bytes`` wrote.

Parameters
----------
data : bytes

Returns
-------
Surface
    Equal to the one that was written.

Raises
------
Error
    They are no surface, or damaged.)")
      .def("to_trimesh", &to_trimesh, R"(The surface for trimesh, with its normals.

Returns
-------
trimesh.Trimesh
    A copy [m]; no vertex is merged or dropped.

Raises
------
ImportError
    trimesh is not installed.)")
      .def("to_open3d", &to_open3d, R"(The surface for Open3D, with its normals.

Returns
-------
open3d.geometry.TriangleMesh
    A copy [m].

Raises
------
ImportError
    Open3D is not installed.)")
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
  module.def("reconstruct_surface", &surface_of_points, py::arg("points"),
             py::arg("toward_free") = py::none(), py::kw_only(), py::arg("spacing"),
             py::arg("smoothing_neighbors") = defaults.smoothing_neighbors,
             py::arg("max_edge") = defaults.max_edge,
             py::arg("join_distance") = defaults.join_distance,
             py::arg("min_component") = defaults.min_component, py::arg("num_threads") = 0,
             R"(The open surface through points; no hole is filled beyond max_edge.

Runs without the GIL. Cost: grows with the points, some 20 µs each on two threads.

Parameters
----------
points : array_like, (n, 3)
    In any frame, of a map the world's [m].
toward_free : array_like, (n, 3), optional
    On which side of the surface free space lies: a direction each in the points' frame, a hint
    whose length, without a unit, does not matter; zero where not known.
spacing : float
    Typical distance of neighbouring points [m].
smoothing_neighbors : int
    Of the jet fit; 0: no smoothing.
max_edge, join_distance : float
    Longest edge; how near points of one component are [spacings].
min_component : int
    Components of fewer points are dropped.
num_threads : int
    0: all hardware threads. Never changes the result.

Returns
-------
Surface
    Empty for no points, or nothing but outliers.

Raises
------
ValueError
    Another shape, a point that is not finite, a length that is not positive, or not one hint a
    point.)");
  module.def("surface_of_grid", &surface_of_grid, py::arg("grid"), py::kw_only(),
             py::arg("min_hits") = 2, py::arg("num_threads") = 0,
             R"(The surface through ``grid.points(min_hits=min_hits)``.

Runs without the GIL; other threads may read the grid meanwhile, not write it. Cost: grows
with the voxels that were ever hit: 0.7 s for 40,000 occupied ones on two threads.

Parameters
----------
grid : viewgain.BeliefGrid
min_hits : int
    Points of fewer readings are left out.
num_threads : int
    0: all hardware threads. Never changes the result.

Returns
-------
Surface
    World frame.

Raises
------
TypeError
    It is no grid.)");
}

}  // namespace viewgain::python
