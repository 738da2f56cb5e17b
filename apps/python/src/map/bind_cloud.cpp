// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include <pybind11/stl.h>

#include <Eigen/Core>
#include <array>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "arrays.hpp"
#include "bindings.hpp"
#include "classes.hpp"
#include "depth_images.hpp"
#include "gil.hpp"
#include "given.hpp"
#include "integration.hpp"
#include "shared_grid.hpp"
#include "viewgain/core/sensor.hpp"
#include "viewgain/formats/cloud_io.hpp"
#include "viewgain/grid/integrate_cloud.hpp"

namespace viewgain::python {
namespace {

using Cloud = std::vector<std::array<double, 3>>;

using Clouds = SharedIntegrator<CloudIntegrator>;

// The points of a cloud in the world, masked ones NaN.
Cloud cloud_in_world(const Sensor& sensor, const py::object& points_sensor, const Pose& pose) {
  Cloud cloud = points(nan_where_masked(points_sensor), "points");
  const WithoutGil without_gil;
  const Pose T_world_sensor = orthonormalized(pose);
  MetresCheck metres(sensor);
  for (auto& point : cloud) {
    const Eigen::Vector3d p_sensor(point[0], point[1], point[2]);
    metres.add(p_sensor.norm());
    const Eigen::Vector3d p_world = T_world_sensor * p_sensor;
    point = {p_world.x(), p_world.y(), p_world.z()};
  }
  metres.require("points");
  return cloud;
}

py::object integrate_cloud(Clouds& self, const Given<SharedGrid>& grid,
                           const py::object& points_sensor, const py::object& T_world_sensor) {
  const Pose pose = one_pose(T_world_sensor, "T_world_sensor");
  return self.integrate(*grid, cloud_in_world(self.sensor, points_sensor, pose), pose);
}

py::object bounds(const Given<Sensor>& of, const py::object& points_sensor,
                  const py::object& T_world_sensor, std::optional<double> support_plane) {
  const Pose pose = one_pose(T_world_sensor, "T_world_sensor");
  const Sensor& sensor = *of;
  const Cloud cloud = cloud_in_world(sensor, points_sensor, pose);
  std::optional<Box> box;
  {
    const WithoutGil without_gil;
    box = reading_bounds(sensor, cloud, pose, {}, support_plane);
  }
  if (!box) return py::none();
  return to_array_3<double>({box->min, box->max});
}

py::object load(const py::object& path) {
  const std::string file = file_path(path);
  require_file(file);
  PointCloud cloud;
  {
    const WithoutGil without_gil;
    cloud = load_cloud(file);
  }
  const py::object viewpoint =
      cloud.viewpoint ? py::object(to_array(*cloud.viewpoint)) : py::none();
  return named("Cloud", to_array_3(cloud.points), viewpoint);
}

}  // namespace

void bind_cloud(py::module_& module) {
  const std::string doc = std::string(R"(Puts point clouds of one sensor into a belief grid.

Each point is a reading along the line from the sensor's origin: it carves the voxels that the line
passes through and hits the one that holds the point, with the sensor's noise at that range and frontal
incidence. All points of a call count as one frame.

Parameters
----------
sensor : Sensor
    Only its noise, fx (where the noise across the ray is a pixel's footprint) and range limits matter.
)") + kIntegratorSettings +
                          kIntegratorRaises;
  const std::string integrate_doc = std::string(R"(Updates the grid by one cloud.

Cost: grows with the points and with the voxels that their lines cross: 25 ms for 25,000 points and voxels
of 5 mm on two threads.

Parameters
----------
grid : BeliefGrid
points : array_like, (n, 3)
    In the sensor's frame [m]; any axes do, its origin is where the rays start. Points that are masked
    or not finite, or nearer than min_range, say nothing; beyond max_range they carve as far as that.
T_world_sensor : array_like, (4, 4)
    Rotations that are off by up to 1e-3 are orthonormalised.

)") + kIntegrateReturns;
  auto type = bound_class<Clouds>(module, "CloudIntegrator", doc.c_str());
  refuse_pickling(type);
  type.def(py::init([](const Given<Sensor>& sensor, const std::string& occupancy,
                       std::optional<double> support_plane, int num_threads) {
             const IntegrationConfig config{.occupancy = parse_occupancy(occupancy),
                                            .support_plane = support_plane};
             return std::make_unique<Clouds>(*sensor, config, num_threads);
           }),
           py::arg("sensor"), py::kw_only(), py::arg("occupancy") = "probabilistic",
           py::arg("support_plane") = py::none(), py::arg("num_threads") = 0)
      .def("integrate", &integrate_cloud, py::arg("grid"), py::arg("points"),
           py::arg("T_world_sensor"), integrate_doc.c_str())
      .def("__repr__",
           [](const Clouds& self) { return "<CloudIntegrator of " + self.sensor.name + ">"; });

  module.def("cloud_bounds", &bounds, py::arg("sensor"), py::arg("points"),
             py::arg("T_world_sensor"), py::kw_only(), py::arg("support_plane") = py::none(),
             R"(The box that holds every reading of a cloud, for choosing a workspace.

Runs without the GIL. Cost: linear in the points, 1.5 ms for 25,000.

Parameters
----------
sensor : Sensor
points, T_world_sensor
    As ``CloudIntegrator.integrate``.
support_plane : float, optional
    Height z [m] of the table, whose readings do not count.

Returns
-------
ndarray, (2, 3), float64, or None
    Lowest and highest corner, world frame [m]; None if the cloud has no reading.

Raises
------
ValueError
    As ``CloudIntegrator.integrate``.
TypeError
    It is no sensor.)");
  module.def(
      "load_cloud", &load, py::arg("path"),
      R"(Reads the points of a .pcd (ascii, binary, binary_compressed) or .ply (ascii, binary).

Runs without the GIL. Cost: linear in the file.

Parameters
----------
path : path-like

Returns
-------
Cloud
    A named tuple of the two.
points : ndarray, (n, 3), float64
    As they stand in the file, in the file's frame, [m] by custom; NaN where an organised cloud has none.
viewpoint : ndarray, (4, 4), float64, or None
    A PCD's VIEWPOINT: the sensor's pose in that frame. Points of the world become the sensor's by its
    inverse.

Raises
------
FileNotFoundError, OSError
    It cannot be opened.
Error
    It is no cloud or it is damaged; names the file.)");
}

}  // namespace viewgain::python
