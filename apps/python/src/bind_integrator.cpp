// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include <pybind11/stl.h>

#include <memory>
#include <mutex>
#include <optional>
#include <string>

#include "arrays.hpp"
#include "bindings.hpp"
#include "depth_images.hpp"
#include "integration.hpp"
#include "pickling.hpp"
#include "shared_grid.hpp"
#include "viewgain/core/sensor.hpp"
#include "viewgain/grid/integrate.hpp"

namespace viewgain::python {
namespace {

// Python's FrameIntegrator; one call at a time.
struct SharedIntegrator {
  Sensor sensor;
  FrameIntegrator integrator;
  std::mutex mutex;
};

IntegrationConfig config_of(const std::string& carve, const std::string& occupancy,
                            std::optional<double> support_plane) {
  IntegrationConfig config;
  if (carve == "lines") {
    config.carve = Carve::lines;
  } else if (carve != "cones") {
    throw py::value_error("carve is \"" + carve + "\"; valid are cones lines");
  }
  config.occupancy = parse_occupancy(occupancy);
  config.support_plane = support_plane;
  return config;
}

py::dict integrate(SharedIntegrator& self, SharedGrid& grid, const py::object& depth,
                   const py::object& T_world_camera, const py::object& amplitude) {
  const DepthFrame frame = depth_frame(self.sensor, depth, amplitude);
  const Pose pose = one_pose(T_world_camera, "T_world_camera");
  const IntegrationReport report = grid.write([&](BeliefGrid& g) {
    const std::lock_guard lock(self.mutex);
    return self.integrator.integrate(g, frame, pose);
  });
  return dict_of(report);
}

}  // namespace

void bind_integrator(py::module_& module) {
  py::class_<SharedIntegrator> type(module, "FrameIntegrator",
                                    R"(Puts depth frames of one sensor into a belief grid.

Parameters
----------
sensor : Sensor
carve : {"cones", "lines"}
    What counts as crossed by a pixel: voxels whose centre lies in its pyramid, or on its ray.
occupancy : {"probabilistic", "literal"}
    Log-odds once a voxel a frame, or crossed -> free and hit -> occupied.
support_plane : float, optional
    Height z [m] of the table that the object stands on; its readings carve but do not hit.
num_threads : int
    0: all hardware threads. Never changes the map.)");
  refuse_pickling(type);
  type.def(py::init([](const Sensor& sensor, const std::string& carve, const std::string& occupancy,
                       std::optional<double> support_plane, int num_threads) {
             const IntegrationConfig config = config_of(carve, occupancy, support_plane);
             return std::unique_ptr<SharedIntegrator>(new SharedIntegrator{
                 sensor, FrameIntegrator(sensor, config, ExecConfig{num_threads}), {}});
           }),
           py::arg("sensor"), py::kw_only(), py::arg("carve") = "cones",
           py::arg("occupancy") = "probabilistic", py::arg("support_plane") = py::none(),
           py::arg("num_threads") = 0)
      .def("integrate", &integrate, py::arg("grid"), py::arg("depth"), py::arg("T_world_camera"),
           py::kw_only(), py::arg("amplitude") = py::none(), R"(Updates the grid by one frame.

Parameters
----------
grid : BeliefGrid
depth : array_like, (height, width)
    Along the optical axis (z, not range) [m]. 0, negative or NaN: says nothing; inf: nothing up to
    the sensor's max_range.
T_world_camera : array_like, (4, 4)
    Rotations that are off by up to 1e-3 are orthonormalised.
amplitude : array_like, (height, width), optional
    cos / range**2 [1/m**2], from which the angle of incidence is taken; else from the depth.

Returns
-------
dict
    Counts: readings, plane_readings, out_of_range, invalid, readings_inside (pixels), voxels_hit,
    voxels_crossed.

Raises
------
ValueError
    Names the shape, or what is wrong with the pose; the grid is unchanged then.)")
      .def("__repr__", [](const SharedIntegrator& self) {
        return "<FrameIntegrator of " + self.sensor.name + ", " +
               std::to_string(self.sensor.camera.width) + "x" +
               std::to_string(self.sensor.camera.height) + " px>";
      });

  module.def(
      "reading_bounds",
      [](const Sensor& sensor, const py::object& depth, const py::object& T_world_camera,
         std::optional<double> support_plane) -> py::object {
        const std::optional<Box> bounds =
            reading_bounds(sensor, depth_frame(sensor, depth, py::none()),
                           one_pose(T_world_camera, "T_world_camera"), {}, support_plane);
        if (!bounds) return py::none();
        return to_array_3<double>({bounds->min, bounds->max});
      },
      py::arg("sensor"), py::arg("depth"), py::arg("T_world_camera"), py::kw_only(),
      py::arg("support_plane") = py::none(),
      R"(The box that holds every reading of a depth frame, for choosing a workspace.

Returns
-------
ndarray, (2, 3), or None
    Lowest and highest corner, world frame [m]; None if the frame has no reading.)");
}

}  // namespace viewgain::python
