// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include <pybind11/stl.h>

#include <memory>
#include <optional>
#include <string>

#include "arrays.hpp"
#include "bindings.hpp"
#include "classes.hpp"
#include "depth_images.hpp"
#include "given.hpp"
#include "integration.hpp"
#include "scene.hpp"
#include "shared_grid.hpp"
#include "viewgain/core/sensor.hpp"
#include "viewgain/grid/hazard_calibration.hpp"
#include "viewgain/grid/integrate.hpp"

namespace viewgain::python {
namespace {

/// Frames can say what the hazard of unknown space is, too.
struct Integrator : SharedIntegrator<FrameIntegrator> {
  Integrator(const Sensor& of, const IntegrationConfig& config, int num_threads)
      : SharedIntegrator(of, config, num_threads), calibration(of, config.support_plane) {}
  HazardCalibration calibration;
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

py::object integrate(Integrator& self, const Given<SharedGrid>& grid, const py::object& depth,
                     const py::object& T_world_camera, const std::array<double, 2>& pose_sigma,
                     const py::object& amplitude) {
  const DepthFrame frame = depth_frame(self.sensor, depth, amplitude);
  return self.integrate(*grid, frame, one_pose(T_world_camera, "T_world_camera"),
                        PoseSigma{pose_sigma[0], pose_sigma[1]});
}

void calibrate_hazard(const Integrator& self, const Given<SharedGrid>& grid,
                      const Given<Scene>& scene, const py::object& depth,
                      const py::object& T_world_camera) {
  const DepthFrame frame = depth_frame(self.sensor, depth, py::none());
  const Pose pose = one_pose(T_world_camera, "T_world_camera");
  grid->write(
      [&](BeliefGrid& g) { self.calibration.count(g, scene->scene->hazard(), frame, pose); });
}

}  // namespace

void bind_integrator(py::module_& module) {
  const std::string doc = std::string(R"(Puts depth frames of one sensor into a belief grid.

Parameters
----------
sensor : Sensor
carve : {"cones", "lines"}
    What counts as crossed by a pixel: voxels whose centre lies in its pyramid, or on its ray.
)") + kIntegratorSettings +
                          kIntegratorRaises;
  const std::string integrate_doc = std::string(R"(Updates the grid by one frame.

Cost: linear in the pixels and grows with the voxels that they carve: 4 ms for 176x144 pixels and voxels
of 5 mm on two threads.

Parameters
----------
grid : BeliefGrid
depth : array_like, (height, width), floating point
    Along the optical axis (z, not range) [m]. 0, negative, NaN or masked: says nothing; inf: nothing
    up to the sensor's max_range.
T_world_camera : array_like, (4, 4)
    Rotations that are off by up to 1e-3 are orthonormalised.
pose_sigma : array_like, (2,), optional
    What this pose may be off beside the sensor's own pose_sigma [m], [rad].
amplitude : array_like, (height, width), floating point, optional
    cos / range**2 [1/m**2], from which the angle of incidence is taken; else from the depth. NaN or
    masked: the least information.

)") + kIntegrateReturns;
  auto type = bound_class<Integrator>(module, "FrameIntegrator", doc.c_str());
  refuse_pickling(type);
  type.def(py::init([](const Given<Sensor>& sensor, const std::string& carve,
                       const std::string& occupancy, std::optional<double> support_plane,
                       int num_threads) {
             return std::make_unique<Integrator>(
                 *sensor, config_of(carve, occupancy, support_plane), num_threads);
           }),
           py::arg("sensor"), py::kw_only(), py::arg("carve") = "cones",
           py::arg("occupancy") = "probabilistic", py::arg("support_plane") = py::none(),
           py::arg("num_threads") = 0)
      .def("integrate", &integrate, py::arg("grid"), py::arg("depth"), py::arg("T_world_camera"),
           py::kw_only(), py::arg("pose_sigma") = std::array<double, 2>{0, 0},
           py::arg("amplitude") = py::none(), integrate_doc.c_str())
      .def("calibrate_hazard", &calibrate_hazard, py::arg("grid"), py::arg("scene"),
           py::arg("depth"), py::arg("T_world_camera"),
           R"(Counts how often a frame meets the surface in unknown space, before it is integrated.

The surface and the combined gain of the grid's later scenes go by what was counted. Nothing happens
while no surface is known, and where the scene's hazard was given. Cost: about 5 ms for 176x144 pixels.

Parameters
----------
grid : BeliefGrid
    Not yet with the frame.
scene : VoxelScene
    Of the grid as it stands.
depth, T_world_camera
    As ``integrate``.

Raises
------
ValueError
    As ``integrate``.
TypeError
    It is no grid, or no scene.)")
      .def("__repr__", [](const Integrator& self) {
        return "<FrameIntegrator of " + self.sensor.name + ", " +
               std::to_string(self.sensor.camera.width) + "x" +
               std::to_string(self.sensor.camera.height) + " px>";
      });

  module.def(
      "reading_bounds",
      [](const Given<Sensor>& of, const py::object& depth, const py::object& T_world_camera,
         std::optional<double> support_plane) -> py::object {
        const Sensor& sensor = *of;
        const std::optional<Box> bounds =
            reading_bounds(sensor, depth_frame(sensor, depth, py::none()),
                           one_pose(T_world_camera, "T_world_camera"), {}, support_plane);
        if (!bounds) return py::none();
        return to_array_3<double>({bounds->min, bounds->max});
      },
      py::arg("sensor"), py::arg("depth"), py::arg("T_world_camera"), py::kw_only(),
      py::arg("support_plane") = py::none(),
      R"(The box that holds every reading of a depth frame, for choosing a workspace.

Holds the GIL. Cost: linear in the pixels, 2 ms for 176x144.

Parameters
----------
sensor : Sensor
depth, T_world_camera
    As ``FrameIntegrator.integrate``.
support_plane : float, optional
    Height z [m] of the table, whose readings do not count.

Returns
-------
ndarray, (2, 3), float64, or None
    Lowest and highest corner, world frame [m]; None if the frame has no reading.

Raises
------
ValueError
    As ``FrameIntegrator.integrate``.
TypeError
    It is no sensor.)");
}

}  // namespace viewgain::python
