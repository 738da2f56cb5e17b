// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include <pybind11/stl.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <optional>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include "arrays.hpp"
#include "bindings.hpp"
#include "classes.hpp"
#include "gil.hpp"
#include "given.hpp"
#include "python_call.hpp"
#include "scene.hpp"
#include "viewgain/core/reach.hpp"
#include "viewgain/raycast/feasibility.hpp"

namespace viewgain::python {
namespace {

// Codes of Infeasibility, one a pose.
py::array_t<std::uint8_t> codes_of(const FeasibilityChecker& self, const py::object& T_world_camera,
                                   const py::object& taken) {
  const PoseBatch batch = pose_batch(T_world_camera, "T_world_camera", false);
  const std::vector<Pose> before =
      taken.is_none() ? std::vector<Pose>{} : pose_list(taken, "taken");
  py::array_t<std::uint8_t> codes(batch.shape);
  std::uint8_t* out = codes.mutable_data();
  const WithoutGil without_gil;
  for (const Infeasibility reason : self.check(batch.poses, before)) {
    *out++ = static_cast<std::uint8_t>(reason);
  }
  return codes;
}

}  // namespace

void bind_feasibility(py::module_& module) {
  py::list names;
  for (int i = 0; i <= static_cast<int>(Infeasibility::too_near); ++i) {
    names.append(std::string(infeasibility_name(static_cast<Infeasibility>(i))));
  }
  module.attr("INFEASIBILITY_NAMES") = py::tuple(names);

  const FeasibilityConfig defaults;
  auto type = bound_class<FeasibilityChecker>(module, "FeasibilityChecker",
                                              R"(Says which camera poses are possible in a scene.

The sensor's housing, a box, must not overlap voxels that are not free, obstacles or the scene's support plane;
the pose must be reachable and not taken already. Outside the workspace nothing is known to block.

Parameters
----------
scene : VoxelScene
body_size : array_like, (3,)
    Width, height, depth of the housing, flange frame [m]. It is centred on the flange's z axis and reaches from
    z = 0 to its depth; without T_flange_camera the camera is the middle of its front face.
T_flange_camera : array_like, (4, 4), optional
    Where the camera is mounted on the flange.
clearance : float
    The body is grown by this on each side [m].
reach : ReachRegion, optional
sensor : Sensor, optional
    Views much of whose image would show what is nearer than the sensor's min_range are too near.
max_near_share : float
    How much: share of the rays that end in the map.
num_threads : int
    For arrays of poses; 0: all hardware threads. They ask the predicate of ``reach`` one at a time.

Raises
------
ValueError
    A shape, a body without extent, a number out of its bounds.
TypeError
    It is no scene, region or sensor.

Notes
-----
Methods may run in many threads at once and leave the GIL while they work. Cost: linear in the poses,
0.5 to 1 µs each; with a sensor 10 to 50 µs where much is near and it has the SR4000's 400 rays.)");
  refuse_pickling(type);
  type.def(py::init([](const Given<Scene>& scene, const py::object& body_size,
                       const py::object& T_flange_camera, double clearance,
                       const GivenOrNone<ReachRegion>& reach, const GivenOrNone<Sensor>& sensor,
                       double max_near_share, int num_threads) {
             FeasibilityConfig config;
             const Eigen::Vector3d size = vector3(body_size, "body_size");
             config.body.size = {size.x(), size.y(), size.z()};
             config.body.T_flange_camera = optional_pose(T_flange_camera, "T_flange_camera");
             config.clearance = clearance;
             if (reach.value != nullptr) config.reach = *reach.value;
             if (sensor.value != nullptr) config.sensor = *sensor.value;
             config.max_near_share = max_near_share;
             return FeasibilityChecker(scene->scene, config, ExecConfig{num_threads});
           }),
           py::arg("scene"), py::kw_only(), py::arg("body_size") = defaults.body.size,
           py::arg("T_flange_camera") = py::none(), py::arg("clearance") = defaults.clearance,
           py::arg("reach") = py::none(), py::arg("sensor") = py::none(),
           py::arg("max_near_share") = defaults.max_near_share, py::arg("num_threads") = 0)
      .def(
          "with_scene",
          [](const FeasibilityChecker& self, const Given<Scene>& scene) {
            const WithoutGil without_gil;
            return self.with_scene(scene->scene);
          },
          py::arg("scene"), R"(The same checker of another scene, for following a map as it grows.

This one stays as it is. Cost: some microseconds.

Parameters
----------
scene : VoxelScene
    Such as ``VoxelScene.update`` returns.

Returns
-------
FeasibilityChecker

Raises
------
TypeError
    It is no scene.)")
      .def(
          "feasible",
          [](const FeasibilityChecker& self, const py::object& T_world_camera,
             const py::object& taken) {
            const py::array_t<std::uint8_t> codes = codes_of(self, T_world_camera, taken);
            py::array_t<bool> good(Shape(codes.shape(), codes.shape() + codes.ndim()));
            for (py::ssize_t i = 0; i < codes.size(); ++i) {
              good.mutable_data()[i] = codes.data()[i] == 0;
            }
            return scalar_or_array(good);
          },
          py::arg("T_world_camera"), py::arg("taken") = py::none(), R"(Which poses are possible.

Parameters
----------
T_world_camera : array_like, (..., 4, 4)
taken : array_like, (n, 4, 4), optional
    T_world_camera of the views so far.

Returns
-------
ndarray, (...), bool
    A single pose gives a scalar.

Raises
------
ValueError
    Another shape or masked entries, or a bad pose among those taken. What the predicate of ``reach``
    raises passes through.)")
      .def(
          "reasons",
          [](const FeasibilityChecker& self, const py::object& T_world_camera,
             const py::object& taken) {
            return scalar_or_array(codes_of(self, T_world_camera, taken));
          },
          py::arg("T_world_camera"), py::arg("taken") = py::none(),
          R"(Why poses are not possible: the first reason that applies.

Parameters
----------
T_world_camera : array_like, (..., 4, 4)
taken : array_like, (n, 4, 4), optional
    T_world_camera of the views so far.

Returns
-------
ndarray, (...), uint8
    Indices into ``INFEASIBILITY_NAMES``; 0 is "none". A single pose gives a scalar.

Raises
------
ValueError
    Another shape or masked entries, or a bad pose among those taken, as ``feasible``.)")
      .def("__repr__", [](const FeasibilityChecker& self) {
        return "<FeasibilityChecker of a scene of " +
               std::to_string(self.scene().primitive_count()) + " primitives>";
      });
}

}  // namespace viewgain::python
