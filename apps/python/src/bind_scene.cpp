// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include <pybind11/stl.h>

#include <memory>
#include <optional>
#include <sstream>
#include <string>
#include <utility>

#include "arrays.hpp"
#include "classes.hpp"
#include "evaluator.hpp"
#include "gil.hpp"
#include "given.hpp"
#include "map/shared_grid.hpp"
#include "viewgain/grid/vdb_io.hpp"

namespace viewgain::python {

Obstacles obstacles_of(const py::object& boxes, const py::iterable& meshes) {
  Obstacles obstacles;
  obstacles.boxes = optional_boxes(boxes, "boxes");
  for (const py::handle mesh : meshes) {
    if (!py::isinstance<py::sequence>(mesh) || py::len(mesh) != 2) {
      throw py::value_error("each entry of meshes must be a pair (vertices, triangles)");
    }
    const auto pair = py::reinterpret_borrow<py::sequence>(mesh);
    const py::object vertices = pair[0], triangles = pair[1];
    obstacles.meshes.push_back(triangle_mesh(vertices, triangles));
  }
  return obstacles;
}

namespace {

// Hazard from a number (a constant rate), a path of a .vdb file, or an array with one rate per
// voxel.
HazardConfig hazard_of(const SharedGrid& shared, std::optional<double> object_size,
                       const py::object& hazard) {
  HazardConfig config;
  config.object_size = object_size;
  if (hazard.is_none()) return config;
  const BeliefGrid& grid = shared.layout();
  const Index3 dims = grid.dims();
  if (py::isinstance<py::str>(hazard) || py::isinstance<py::bytes>(hazard) ||
      py::hasattr(hazard, "__fspath__")) {
    const std::string file = readable_file(hazard);
    const WithoutGil without_gil;
    config.volume = std::make_shared<const HazardConfig::Volume>(load_hazard_vdb(file, grid));
    return config;
  }
  const Doubles rates = doubles(hazard, "hazard");
  if (rates.ndim() == 0) return constant_hazard(*rates.data(), grid, object_size);
  if (rates.ndim() != 3 || rates.shape(0) != dims.x || rates.shape(1) != dims.y ||
      rates.shape(2) != dims.z) {
    throw py::value_error("hazard must be a number, a path or an array of the grid's shape");
  }
  auto volume = std::make_shared<HazardConfig::Volume>();
  volume->box = VoxelBox::from_dims(grid.min_index(), dims);
  volume->rates.reserve(static_cast<std::size_t>(rates.size()));
  for (py::ssize_t i = 0; i < rates.size(); ++i) {
    volume->rates.push_back(static_cast<float>(rates.data()[i]));
  }
  config.volume = std::move(volume);
  return config;
}

}  // namespace

void bind_scene(py::module_& module) {
  auto type = bound_class<Scene>(module, "VoxelScene",
                                 R"(An immutable scene for ray tracing.

It has the unknown and occupied voxels of a grid, and obstacles. Later changes of the grid do not
affect it. Any number of evaluators and threads may share a scene.

Parameters
----------
grid : BeliefGrid
boxes : array_like, (n, 2, 3), optional
    Known obstacles: lowest and highest corners, world frame [m]. They block rays and have no gain.
meshes : iterable of (vertices, triangles), optional
    Known obstacles as triangle meshes: vertices (n, 3) in the world frame [m], and triangles (m, 3)
    of vertex indices.
support_plane : float, optional
    Height z of an infinite table, world frame [m]. The camera's body must stay above it. With gain
    "surface" and "combined", rays end at it.
object_size : float, optional
    Longest side of the object [m], for gain "surface" and "combined"; default: that of the part
    seen so far.
hazard : float, path or array_like, the grid's shape, optional
    Hazard: the rate at which a ray meets the surface in unknown voxels [1/m], for gain "surface"
    and "combined". A number, an array with one rate per voxel, or a .vdb file whose float grid
    "hazard", or only float grid, has the rates. Default: a model that depends on the location
    relative to known surface.
num_threads : int
    Number of threads; 0: all hardware threads.

Notes
-----
Releases the GIL while it builds the scene. A scene can have at most 2**23 blocks of voxels. Cost:
about 0.2 ms per 1,000 blocks that are not free, and some ms when an evaluator with gain "surface"
or "combined" first uses the scene. ``update`` is several times faster if little has changed.
Properties take constant time.)");
  refuse_pickling(type);
  type.def(py::init([](const Given<SharedGrid>& grid, const py::object& boxes,
                       const py::iterable& meshes, std::optional<double> support_plane,
                       std::optional<double> object_size, const py::object& hazard,
                       int num_threads) {
             const Surroundings surroundings{obstacles_of(boxes, meshes), support_plane};
             const HazardConfig rates = hazard_of(*grid, object_size, hazard);
             return grid->read([&](const BeliefGrid& g) {
               return Scene{VoxelScene::build(g, surroundings, ExecConfig{num_threads}, rates)};
             });
           }),
           "grid"_a, py::kw_only(), "boxes"_a = py::none(), "meshes"_a = py::tuple(),
           "support_plane"_a = py::none(), "object_size"_a = py::none(), "hazard"_a = py::none(),
           "num_threads"_a = 0)
      .def(
          "update",
          [](const Scene& self, const Given<SharedGrid>& grid, int num_threads) {
            return grid->read([&](const BeliefGrid& g) {
              return Scene{VoxelScene::update(self.scene, g, ExecConfig{num_threads})};
            });
          },
          "grid"_a, py::kw_only(), "num_threads"_a = 0,
          R"(The scene of the current grid, with the same surroundings. This scene does not change.

Copies regions of 32**3 voxels that did not change.

Parameters
----------
grid : BeliefGrid
    The grid of the scene, or any other grid.
num_threads : int
    Number of threads; 0: all hardware threads.

Returns
-------
VoxelScene)")
      .def_property_readonly(
          "isa", [](const Scene& self) { return std::string(self.scene->isa()); },
          "str: instruction set with which rays are traced")
      .def_property_readonly(
          "primitive_count", [](const Scene& self) { return self.scene->primitive_count(); },
          "int: number of voxel blocks that are not free")
      .def_property_readonly(
          "bytes", [](const Scene& self) { return self.scene->bytes(); },
          "int: memory of the scene in bytes, without the snapshot and Embree")
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
