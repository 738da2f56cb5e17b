// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include <pybind11/stl.h>

#include <Eigen/Core>
#include <array>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "arrays.hpp"
#include "classes.hpp"
#include "depth_images.hpp"
#include "evaluator.hpp"
#include "gil.hpp"
#include "given.hpp"
#include "pose_arrays.hpp"
#include "shared_grid.hpp"
#include "suspicions.hpp"
#include "viewgain/core/sensor.hpp"
#include "viewgain/formats/cloud_io.hpp"
#include "viewgain/grid/hazard_calibration.hpp"
#include "viewgain/grid/integrate.hpp"

namespace viewgain::python {
namespace {

// Common parts of the docstrings of both integrators: parameters of the constructors.
constexpr const char* kIntegratorSettings =
    R"(occupancy : {"probabilistic", "literal"}
    How a frame changes states. A reading (one measured depth) hits one voxel, and its ray crosses
    the voxels before it. "probabilistic": the log-odds of each voxel change once per frame.
    "literal": crossed voxels become free, and hit voxels occupied.
support_plane : float, optional
    Height z of the table under the object, world frame [m]. Readings of the table mark free space,
    but hit no voxel.
coarsest : int
    0 to 3: voxels are merged into cells of up to 2**coarsest voxels per edge, about as wide as a
    pixel on the surface. Closer views refine the cells.
fine : array_like, (n, 2, 3), optional
    Boxes in the grid frame [m] in which voxels are not merged.
finest : int
    Outside the boxes of ``fine``, cells have at least 2**finest voxels per edge. At most
    ``coarsest``.
num_threads : int
    0: all hardware threads. Does not affect the map.)";

// Notes for the methods.
constexpr const char* kIntegratorNotes = R"(

Notes
-----
Concurrent calls wait for each other. The GIL is released during integration. Maps are bit-identical
for any number of threads.)";

// Result and exceptions of integrate().
constexpr const char* kIntegrateReturns =
    R"(Returns
-------
IntegrationReport
    Counts of pixels or points: readings, plane_readings, out_of_range, invalid, readings_inside.
    Counts of voxels: voxels_hit, voxels_crossed.

Raises
------
ValueError
    Also if depths seem to be in millimetres, because all depths, or 19 of 20 different ones, are
    beyond 10 times max_range. The grid then does not change.)";

IntegrationConfig::Occupancy parse_occupancy(const std::string& name) {
  if (name == "probabilistic") return IntegrationConfig::Occupancy::probabilistic;
  if (name == "literal") return IntegrationConfig::Occupancy::literal;
  throw py::value_error("occupancy is \"" + name + "\"; valid values: probabilistic, literal");
}

py::object to_python(const IntegrationReport& r) {
  return named("IntegrationReport", r.readings, r.plane_readings, r.out_of_range, r.invalid,
               r.readings_inside, r.voxels_hit, r.voxels_crossed);
}

// Python's integrators; one call at a time.
template <typename Integrator>
struct SharedIntegrator {
  Sensor sensor;
  Integrator integrator;
  std::mutex mutex{};

  template <typename Config>
  SharedIntegrator(const Sensor& of, const Config& config, int num_threads)
      : sensor(of), integrator(of, config, ExecConfig{num_threads}) {}

  // Calls f(BeliefGrid&, Integrator&) without the GIL. Call it with the GIL.
  template <typename F>
  auto write(SharedGrid& grid, const F& f) {
    return grid.write([&](BeliefGrid& g) {
      const std::lock_guard lock(mutex);
      return f(g, integrator);
    });
  }
};

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
  const Cloud cloud = cloud_in_world(self.sensor, points_sensor, pose);
  return to_python(self.write(*grid, [&](BeliefGrid& g, CloudIntegrator& integrator) {
    return integrator.integrate(g, cloud, pose);
  }));
}

py::object to_python(const std::optional<Box>& box) {
  if (!box) return py::none();
  return to_array_3<double>({box->min, box->max});
}

py::object bounds(const Given<Sensor>& of, const py::object& points_sensor,
                  const py::object& T_world_sensor, std::optional<double> support_plane) {
  const Pose pose = one_pose(T_world_sensor, "T_world_sensor");
  const Sensor& sensor = *of;
  const Cloud cloud = cloud_in_world(sensor, points_sensor, pose);
  return to_python(
      outside_gil([&] { return reading_bounds(sensor, cloud, pose, {}, support_plane); }));
}

py::object load(const py::object& path) {
  const std::string file = readable_file(path);
  const PointCloud cloud = outside_gil([&] { return load_cloud(file); });
  const py::object viewpoint =
      cloud.viewpoint ? py::object(to_array(*cloud.viewpoint)) : py::none();
  return named("Cloud", to_array_3(cloud.points), viewpoint);
}

}  // namespace

void bind_cloud(py::module_& module) {
  const std::string doc = std::string(R"(Integrates point clouds of one sensor into a belief grid.

Each point is a reading. It marks the voxels on the line from the sensor's origin as free and hits
the voxel that contains it. Its noise is that of the sensor at this range and frontal incidence. All
points of a call are one frame.

Parameters
----------
sensor : Sensor
    Only its noise, its range limits and, if the lateral noise depends on it, fx are used.
)") + kIntegratorSettings +
                          kIntegratorNotes;
  const std::string integrate_doc = std::string(R"(Integrates one cloud into a grid.

Cost: grows with the points and the voxels on their lines. It is 25 ms for 25,000 points and voxels
of 5 mm on two threads.

Parameters
----------
grid : BeliefGrid
points : array_like, (n, 3)
    Sensor frame [m], with any axes; its origin is that of the sensor. Points that are masked, not
    finite or nearer than min_range are ignored. Points beyond max_range mark free space up to
    max_range.
T_world_sensor : array_like, (4, 4)
    A rotation that is not orthonormal is repaired if its error is at most 1e-3.

)") + kIntegrateReturns;
  auto type = bound_class<Clouds>(module, "CloudIntegrator", doc.c_str());
  refuse_pickling(type);
  type.def(py::init([](const Given<Sensor>& sensor, const std::string& occupancy,
                       std::optional<double> support_plane, int coarsest, const py::object& fine,
                       int finest, int num_threads) {
             IntegrationConfig config{.occupancy = parse_occupancy(occupancy),
                                      .support_plane = support_plane};
             config.coarsest = coarsest;
             config.finest = finest;
             config.fine = optional_boxes(fine, "fine");
             warn(suspect_sensor(*sensor));
             return std::make_unique<Clouds>(*sensor, config, num_threads);
           }),
           "sensor"_a, py::kw_only(), "occupancy"_a = "probabilistic",
           "support_plane"_a = py::none(), "coarsest"_a = 0, "fine"_a = py::none(), "finest"_a = 0,
           "num_threads"_a = 0)
      .def("integrate", &integrate_cloud, "grid"_a, "points"_a, "T_world_sensor"_a,
           integrate_doc.c_str())
      .def("__repr__",
           [](const Clouds& self) { return "<CloudIntegrator of " + self.sensor.name + ">"; });

  module.def("cloud_bounds", &bounds, "sensor"_a, "points"_a, "T_world_sensor"_a, py::kw_only(),
             "support_plane"_a = py::none(),
             R"(The box that contains all readings of a cloud, as ``reading_bounds``.

Runs without the GIL. Cost: 1.5 ms for 25,000 points.

Parameters
----------
sensor : Sensor
points, T_world_sensor
    As ``CloudIntegrator.integrate``.
support_plane : float, optional

Returns
-------
ndarray, (2, 3), float64, or None)");
  module.def("load_cloud", &load, "path"_a,
             R"(Reads the points of a .pcd or .ply file, ASCII or binary.

Runs without the GIL. Cost: linear in the file.

Parameters
----------
path : path-like

Returns
-------
Cloud
    viewpoint is the VIEWPOINT of a .pcd file. Its inverse maps points from the world frame to the
    sensor frame.)");
}

namespace {

/// Adds the calibration of the hazard, which only frames support.
struct Integrator : SharedIntegrator<FrameIntegrator> {
  Integrator(const Sensor& of, const IntegrationConfig& config, int num_threads)
      : SharedIntegrator(of, config, num_threads),
        calibration(of, config.support_plane, {.num_threads = num_threads}) {}
  HazardCalibration calibration;
};

IntegrationConfig config_of(const std::string& carve, const std::string& occupancy,
                            std::optional<double> support_plane) {
  IntegrationConfig config;
  if (carve == "lines") {
    config.carve = IntegrationConfig::Carve::lines;
  } else if (carve != "cones") {
    throw py::value_error("carve is \"" + carve + "\"; valid values: cones, lines");
  }
  config.occupancy = parse_occupancy(occupancy);
  config.support_plane = support_plane;
  return config;
}

py::object integrate(Integrator& self, const Given<SharedGrid>& grid, const py::object& depth,
                     const py::object& T_world_camera, const std::array<double, 2>& pose_sigma,
                     const py::object& amplitude) {
  const DepthFrame frame = depth_frame(self.sensor, depth, amplitude);
  const Pose pose = one_pose(T_world_camera, "T_world_camera");
  IntegrationReport counts;
  const Suspicion suspicion = self.write(*grid, [&](BeliefGrid& g, FrameIntegrator& integrator) {
    counts = integrator.integrate(g, frame, pose, PoseSigma{pose_sigma[0], pose_sigma[1]});
    return suspicion_of_frame(self.sensor, frame, pose, g, counts);
  });
  warn(suspicion);
  return to_python(counts);
}

void calibrate_hazard(const Integrator& self, const Given<SharedGrid>& grid,
                      const Given<Scene>& scene, const py::object& depth,
                      const py::object& T_world_camera) {
  const DepthFrame frame = depth_frame(self.sensor, depth, py::none());
  const Pose pose = one_pose(T_world_camera, "T_world_camera");
  grid->write(
      [&](BeliefGrid& g) { self.calibration.count(g, scene->scene->hazard_probe(), frame, pose); });
}

}  // namespace

void bind_integrator(py::module_& module) {
  const std::string doc = std::string(R"(Integrates depth frames of one sensor into a belief grid.

Parameters
----------
sensor : Sensor
carve : {"cones", "lines"}
    Which voxels a pixel crosses, and marks as free. "cones": those whose centre lies in the pixel's
    cone and is nearer than the measured depth. "lines": those on the ray through the pixel's
    centre.
)") + kIntegratorSettings +
                          kIntegratorNotes;
  const std::string integrate_doc = std::string(R"(Integrates one frame into a grid.

Cost: grows with the pixels and the crossed voxels. It is 4 ms for 176x144 pixels and voxels of 5 mm
on two threads.

Parameters
----------
grid : BeliefGrid
depth : array_like, (height, width), floating point
    Along the optical axis (z, not range) [m]. 0, negative, NaN or masked: ignored. inf: free up to
    the sensor's max_range.
T_world_camera : array_like, (4, 4)
    A rotation that is not orthonormal is repaired if its error is at most 1e-3.
pose_sigma : array_like, (2,), optional
    Uncertainty of this pose in addition to the sensor's pose_sigma: standard deviations of
    translation [m] and rotation [rad].
amplitude : array_like, (height, width), floating point, optional
    cos / range**2 [1/m**2], where cos is the cosine of the angle of incidence, which is computed
    from it. Where it is inf (saturated) or not given, the angle is computed from the depths. NaN or
    masked: the most oblique angle.

)") + kIntegrateReturns;
  auto type = bound_class<Integrator>(module, "FrameIntegrator", doc.c_str());
  refuse_pickling(type);
  type.def(py::init([](const Given<Sensor>& sensor, const std::string& carve,
                       const std::string& occupancy, std::optional<double> support_plane,
                       int coarsest, const py::object& fine, int finest, int num_threads) {
             IntegrationConfig config = config_of(carve, occupancy, support_plane);
             config.coarsest = coarsest;
             config.finest = finest;
             config.fine = optional_boxes(fine, "fine");
             warn(suspect_sensor(*sensor));
             return std::make_unique<Integrator>(*sensor, config, num_threads);
           }),
           "sensor"_a, py::kw_only(), "carve"_a = "cones", "occupancy"_a = "probabilistic",
           "support_plane"_a = py::none(), "coarsest"_a = 0, "fine"_a = py::none(), "finest"_a = 0,
           "num_threads"_a = 0)
      .def("integrate", &integrate, "grid"_a, "depth"_a, "T_world_camera"_a, py::kw_only(),
           "pose_sigma"_a = std::array<double, 2>{0, 0}, "amplitude"_a = py::none(),
           integrate_doc.c_str())
      .def("calibrate_hazard", &calibrate_hazard, "grid"_a, "scene"_a, "depth"_a,
           "T_world_camera"_a,
           R"(Counts how often a frame's rays meet the surface in unknown space.

The counts correct the hazard of later scenes of the grid, which gain "surface" and "combined" use.
Call it before the frame is integrated. Has no effect if no surface is known yet, or the scene was
made with ``hazard``. Cost: about 5 ms for 176x144 pixels.

Parameters
----------
grid : BeliefGrid
    The map before the frame is integrated.
scene : VoxelScene
    The scene of the current grid.
depth, T_world_camera
    As ``integrate``.)")
      .def("__repr__", [](const Integrator& self) {
        return "<FrameIntegrator of " + self.sensor.name + ", " +
               std::to_string(self.sensor.camera.width) + "x" +
               std::to_string(self.sensor.camera.height) + " px>";
      });

  module.def(
      "reading_bounds",
      [](const Given<Sensor>& of, const py::object& depth, const py::object& T_world_camera,
         std::optional<double> support_plane) -> py::object {
        return to_python(reading_bounds(*of, depth_frame(*of, depth, py::none()),
                                        one_pose(T_world_camera, "T_world_camera"), {},
                                        support_plane));
      },
      "sensor"_a, "depth"_a, "T_world_camera"_a, py::kw_only(), "support_plane"_a = py::none(),
      R"(The box that contains all readings (measured depths) of a frame, for choosing a workspace.

Holds the GIL. Cost: 2 ms for 176x144 pixels.

Parameters
----------
sensor : Sensor
depth, T_world_camera
    As ``FrameIntegrator.integrate``.
support_plane : float, optional
    Height z of the table, world frame [m]. Readings of the table are ignored.

Returns
-------
ndarray, (2, 3), float64, or None
    Lowest and highest corner, world frame [m]; None if there are no readings.)");
}

}  // namespace viewgain::python
