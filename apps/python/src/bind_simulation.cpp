// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include <pybind11/stl.h>

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <utility>

#include "arrays.hpp"
#include "bindings.hpp"
#include "classes.hpp"
#include "gil.hpp"
#include "given.hpp"
#include "map/depth_images.hpp"
#include "named.hpp"
#include "viewgain/raycast/simulated_sensor.hpp"

namespace viewgain::python {
namespace {

struct Simulation {
  Sensor sensor;
  SimulatedSensor camera;
};

}  // namespace

void bind_simulation(py::module_& module) {
  const SimulationConfig defaults;
  auto type = bound_class<Simulation>(module, "SimulatedSensor",
                                      R"(A depth camera in front of a triangle mesh.

Parameters
----------
vertices : array_like, (n, 3)
    World frame [m].
triangles : array_like, (m, 3)
    Indices.
sensor : Sensor
background_radius : float
    Of a diffuse sphere round the origin that stands for the room [m]; 0: none.
noise : bool
    Gaussian noise along the ray and of the amplitude, by the sensor's model.
lateral_noise : bool
    Readings are of places beside their rays, by the model's lateral sigma.
sub_rays : int
    A pixel is sub_rays**2 rays, 1 to 16; their returns mix for sensors with a modulation frequency.
seed : int
    Of the noise.
support_plane : float, optional
    Height z of a diffuse table without end [m].
num_threads : int
    0: all hardware threads.

Raises
------
ValueError
    A shape, an index out of range, a setting out of its bounds.
TypeError
    It is no sensor.

Notes
-----
``acquire`` may run in many threads at once and leaves the GIL. Cost: grows with the triangles when it is
made; a frame is linear in pixels and sub_rays**2, 2 ms for 176x144 pixels on two threads.)");
  refuse_pickling(type);
  type.def(py::init([](const py::object& vertices, const py::object& triangles,
                       const Given<Sensor>& of, double background_radius, bool noise,
                       bool lateral_noise, int sub_rays, std::uint64_t seed,
                       std::optional<double> support_plane, int num_threads) {
             const Sensor& sensor = *of;
             SimulationConfig config;
             config.background_radius = background_radius;
             config.noise = noise;
             config.lateral_noise = lateral_noise;
             config.sub_rays = sub_rays;
             config.seed = seed;
             config.support_plane = support_plane;
             const ExecConfig exec{num_threads};
             auto scene =
                 std::make_shared<const SurfaceScene>(triangle_mesh(vertices, triangles), exec);
             return std::unique_ptr<Simulation>(
                 new Simulation{sensor, SimulatedSensor(std::move(scene), sensor, config, exec)});
           }),
           py::arg("vertices"), py::arg("triangles"), py::arg("sensor"), py::kw_only(),
           py::arg("background_radius") = defaults.background_radius,
           py::arg("noise") = defaults.noise, py::arg("lateral_noise") = defaults.lateral_noise,
           py::arg("sub_rays") = defaults.sub_rays, py::arg("seed") = defaults.seed,
           py::arg("support_plane") = py::none(), py::arg("num_threads") = 0)
      .def(
          "acquire",
          [](const Simulation& self, const py::object& T_world_camera, std::uint64_t frame_index) {
            const Pose pose = one_pose(T_world_camera, "T_world_camera");
            DepthFrame frame;
            {
              const WithoutGil without_gil;
              frame = self.camera.acquire(pose, frame_index);
            }
            return named("SimulatedFrame", image_array(frame.depth, frame.height, frame.width),
                         image_array(frame.amplitude, frame.height, frame.width));
          },
          py::arg("T_world_camera"), py::arg("frame_index") = 0,
          R"(The frame seen from a pose. Equal seed, index and pose give equal frames.

Parameters
----------
T_world_camera : array_like, (4, 4)
frame_index : int
    Picks the noise.

Returns
-------
SimulatedFrame
    A named tuple of the two.
depth : ndarray, (height, width), float32
    Along the optical axis [m]; 0: invalid, inf: nothing up to max_range.
amplitude : ndarray, (height, width), float32
    cos / range**2 [1/m**2]; 0 where there is no reading.

Raises
------
ValueError
    Another shape, or a pose that is not rigid by more than 1e-3.)")
      .def("__repr__", [](const Simulation& self) {
        return "<SimulatedSensor " + self.sensor.name + ", " +
               std::to_string(self.sensor.camera.width) + "x" +
               std::to_string(self.sensor.camera.height) + " px>";
      });
}

}  // namespace viewgain::python
