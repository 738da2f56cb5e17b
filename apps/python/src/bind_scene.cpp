// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include <pybind11/stl.h>

#include <sstream>
#include <string>

#include "arrays.hpp"
#include "bindings.hpp"
#include "classes.hpp"
#include "map/shared_grid.hpp"
#include "scene.hpp"

namespace viewgain::python {
namespace {

Obstacles obstacles_of(const py::object& boxes, const py::iterable& meshes) {
  Obstacles obstacles;
  obstacles.boxes = optional_boxes(boxes, "boxes");
  for (const py::handle mesh : meshes) {
    if (!py::isinstance<py::sequence>(mesh) || py::len(mesh) != 2) {
      throw py::value_error("each of meshes must be a pair (vertices, triangles)");
    }
    const auto pair = py::reinterpret_borrow<py::sequence>(mesh);
    const py::object vertices = pair[0], triangles = pair[1];
    obstacles.meshes.push_back(triangle_mesh(vertices, triangles));
  }
  return obstacles;
}

}  // namespace

void bind_scene(py::module_& module) {
  auto type = bound_class<Scene>(module, "VoxelScene",
                                 R"(An immutable snapshot of a grid, to be traced.

The grid may change or go afterwards. May be shared by any number of evaluators and threads.

Parameters
----------
grid : BeliefGrid
boxes : array_like, (n, 2, 3), optional
    Known obstacles, which block rays and gain nothing: lowest and highest corners, world frame [m].
meshes : iterable of (vertices, triangles), optional
    The same as triangles: (n, 3) [m] and (m, 3) indices.
num_threads : int
    Of the build; 0: all hardware threads.

Raises
------
ValueError
    A shape, an index out of range, a box inside out.)");
  refuse_pickling(type);
  type.def(py::init([](const SharedGrid& grid, const py::object& boxes, const py::iterable& meshes,
                       int num_threads) {
             const Obstacles obstacles = obstacles_of(boxes, meshes);
             return grid.read([&](const BeliefGrid& g) {
               return Scene{VoxelScene::build(g, obstacles, ExecConfig{num_threads})};
             });
           }),
           py::arg("grid"), py::kw_only(), py::arg("boxes") = py::none(),
           py::arg("meshes") = py::tuple(), py::arg("num_threads") = 0)
      .def(
          "update",
          [](const Scene& self, const SharedGrid& grid, int num_threads) {
            return grid.read([&](const BeliefGrid& g) {
              return Scene{VoxelScene::update(self.scene, g, ExecConfig{num_threads})};
            });
          },
          py::arg("grid"), py::kw_only(), py::arg("num_threads") = 0,
          R"(The scene of what the grid is now, with the same obstacles; this one stays as it is.

What has not changed since is taken over, which is faster than a new scene.

Returns
-------
VoxelScene)")
      .def_property_readonly(
          "isa", [](const Scene& self) { return std::string(self.scene->isa()); },
          "str: the instruction set that traces it")
      .def_property_readonly(
          "primitive_count", [](const Scene& self) { return self.scene->primitive_count(); },
          "int: blocks of voxels that are not free")
      .def_property_readonly(
          "bytes", [](const Scene& self) { return self.scene->bytes(); },
          "int: memory of the scene, without the snapshot and Embree's own")
      .def("__repr__", [](const Scene& self) {
        const VoxelScene& scene = *self.scene;
        const Index3& dims = scene.snapshot().dims;
        std::ostringstream text;
        text << "<VoxelScene " << dims.x << "x" << dims.y << "x" << dims.z << " voxels of "
             << scene.snapshot().voxel_size << " m, " << scene.primitive_count() << " primitives, "
             << scene.isa() << ">";
        return text.str();
      });
}

}  // namespace viewgain::python
