// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include <pybind11/stl.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "arrays.hpp"
#include "classes.hpp"
#include "gil.hpp"
#include "given.hpp"
#include "map/depth_images.hpp"
#include "pose_arrays.hpp"
#include "viewgain/core/camera.hpp"
#include "viewgain/raycast/simulated_sensor.hpp"
#include "viewgain/support/text.hpp"

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
    Radius of a diffuse sphere around the world's origin that simulates the room [m]; 0: none.
noise : bool
    Add noise to the amplitudes, and Gaussian noise along the ray, according to the sensor's noise
    model.
lateral_noise : bool
    Shift rays sideways by a Gaussian offset with the lateral sigma of the noise model.
scale_error : float
    Relative error of all ranges: measured ranges are 1 + scale_error times the true ones.
sub_rays : int
    Trace sub_rays**2 rays per pixel; 1 to 16. For sensors with a modulation frequency, their
    returns mix at depth edges. Other sensors use only the centre ray.
seed : int
    Seed of the noise.
support_plane : float, optional
    Height z of an infinite diffuse table [m].
num_threads : int
    0: all hardware threads.

Notes
-----
``acquire`` may run in many threads at once and releases the GIL. Cost of a frame: linear in pixels
and in sub_rays**2. It is 2 ms for 176x144 pixels and one ray per pixel, on two threads. The cost of
the constructor grows with the number of triangles.)");
  refuse_pickling(type);
  type.def(py::init([](const py::object& vertices, const py::object& triangles,
                       const Given<Sensor>& of, double background_radius, bool noise,
                       bool lateral_noise, double scale_error, int sub_rays, std::uint64_t seed,
                       std::optional<double> support_plane, int num_threads) {
             const Sensor& sensor = *of;
             SimulationConfig config;
             config.background_radius = background_radius;
             config.noise = noise;
             config.lateral_noise = lateral_noise;
             config.scale_error = scale_error;
             config.sub_rays = sub_rays;
             config.seed = seed;
             config.support_plane = support_plane;
             const ExecConfig exec{num_threads};
             auto scene =
                 std::make_shared<const SurfaceScene>(triangle_mesh(vertices, triangles), exec);
             return std::unique_ptr<Simulation>(
                 new Simulation{sensor, SimulatedSensor(std::move(scene), sensor, config, exec)});
           }),
           "vertices"_a, "triangles"_a, "sensor"_a, py::kw_only(),
           "background_radius"_a = defaults.background_radius, "noise"_a = defaults.noise,
           "lateral_noise"_a = defaults.lateral_noise, "scale_error"_a = defaults.scale_error,
           "sub_rays"_a = defaults.sub_rays, "seed"_a = defaults.seed,
           "support_plane"_a = py::none(), "num_threads"_a = 0)
      .def(
          "acquire",
          [](const Simulation& self, const py::object& T_world_camera, std::uint64_t frame_index) {
            const Pose pose = one_pose(T_world_camera, "T_world_camera");
            const DepthFrame frame =
                outside_gil([&] { return self.camera.acquire(pose, frame_index); });
            return named("SimulatedFrame", image_array(frame.depth, frame.height, frame.width),
                         image_array(frame.amplitude, frame.height, frame.width));
          },
          "T_world_camera"_a, "frame_index"_a = 0,
          R"(The frame from a pose. The same seed, index and pose give the same frame.

Parameters
----------
T_world_camera : array_like, (4, 4)
frame_index : int
    Selects the noise.

Returns
-------
SimulatedFrame)")
      .def("__repr__", [](const Simulation& self) {
        return "<SimulatedSensor " + self.sensor.name + ", " +
               std::to_string(self.sensor.camera.width) + "x" +
               std::to_string(self.sensor.camera.height) + " px>";
      });
}

namespace {

// Tolerance for matrix entries that must be 0 or 1, for rounding in calibration files [px].
constexpr double kExact = 1e-9;

PinholeCamera camera_of_matrix(const py::object& matrix, int width, int height,
                               const std::array<double, 5>& distortion) {
  const Doubles k = doubles(matrix, "K", {3, 3});
  const double* m = k.data();
  const auto is_off = [](double value, double wanted) {
    return !(std::abs(value - wanted) <= kExact);
  };
  if (is_off(m[6], 0) || is_off(m[7], 0) || is_off(m[8], 1)) {
    throw py::value_error("K must have the last row 0 0 1");
  }
  if (is_off(m[1], 0) || is_off(m[3], 0)) {
    throw py::value_error("K has skew: K[0, 1] is " + short_text(m[1]) + " and K[1, 0] is " +
                          short_text(m[3]) + "; rectify the images first");
  }
  const PinholeCamera camera{width, height, m[0], m[4], m[2], m[5], distortion};
  camera.validate();
  return camera;
}

py::array_t<double> matrix_of(const PinholeCamera& camera) {
  const std::array<double, 9> m{camera.fx, 0, camera.cx, 0, camera.fy, camera.cy, 0, 0, 1};
  return py::array_t<double>(Shape{3, 3}, m.data());
}

}  // namespace

void bind_camera(py::module_& module) {
  auto type = bound_class<PinholeCamera>(module, "PinholeCamera",
                                         R"(Pinhole camera with OpenCV's distortion model.

The camera frame has x right, y down and z forward. The centre of the first pixel has the pixel
coordinates (0, 0). Immutable. Cameras are equal if their values are.

Parameters
----------
width, height : int
    Size of the image [px], each 1 to 16384; at most 2**24 pixels.
fx, fy : float
    Focal lengths [px].
cx, cy : float
    Principal point [px].
distortion : sequence of float, (5,), optional
    The coefficients k1 k2 p1 p2 k3.)");
  pickle_by_attributes(type, {"width", "height", "fx", "fy", "cx", "cy", "distortion"});
  type.def(py::init([](int width, int height, double fx, double fy, double cx, double cy,
                       const std::array<double, 5>& distortion) {
             const PinholeCamera camera{width, height, fx, fy, cx, cy, distortion};
             camera.validate();
             return camera;
           }),
           "width"_a, "height"_a, py::kw_only(), "fx"_a, "fy"_a, "cx"_a, "cy"_a,
           "distortion"_a = std::array<double, 5>{})
      .def_static("from_matrix", &camera_of_matrix, "K"_a, "width"_a, "height"_a, py::kw_only(),
                  "distortion"_a = std::array<double, 5>{},
                  R"(A camera from its intrinsic matrix, as in OpenCV and ROS.

Parameters
----------
K : array_like, (3, 3)
    Rows fx 0 cx, 0 fy cy, 0 0 1 [px]. Raises ValueError if the 0 and 1 entries differ by more than
    1e-9, for example because of skew.
width, height : int
    [px]
distortion : sequence of float, (5,), optional
    The coefficients k1 k2 p1 p2 k3.

Returns
-------
PinholeCamera)")
      .def_property_readonly("matrix", &matrix_of,
                             "ndarray, (3, 3), float64: rows fx 0 cx, 0 fy cy, 0 0 1 [px], of the "
                             "camera's image")
      .def_readonly("width", &PinholeCamera::width, "int: [px]")
      .def_readonly("height", &PinholeCamera::height, "int: [px]")
      .def_readonly("fx", &PinholeCamera::fx, "float: focal length [px]")
      .def_readonly("fy", &PinholeCamera::fy, "float: focal length [px]")
      .def_readonly("cx", &PinholeCamera::cx, "float: principal point [px]")
      .def_readonly("cy", &PinholeCamera::cy, "float: principal point [px]")
      .def_readonly("distortion", &PinholeCamera::distortion,
                    "list of float, (5,): the coefficients k1 k2 p1 p2 k3")
      .def(
          "rays",
          [](const PinholeCamera& camera) {
            const std::vector<Eigen::Vector3d> table = camera.ray_table();
            py::array_t<double> rays(Shape{camera.height, camera.width, 3});
            double* out = rays.mutable_data();
            for (const Eigen::Vector3d& ray : table) out = std::copy_n(ray.data(), 3, out);
            return rays;
          },
          R"(Directions (x, y, 1) of the rays of all pixels, camera frame.

Cost: about 15 ns per pixel; with distortion 0.3 µs.

Returns
-------
ndarray, (height, width, 3), float64
    A direction times a depth [m] is a point in the camera frame [m]. NaN if the pixel has no ray,
    because the distortion model is not invertible there.)")
      .def(
          "project",
          [](const PinholeCamera& camera, const py::object& points_camera) {
            const Doubles points = items(points_camera, "points", {3});
            Shape shape = leading_shape(points, 1);
            shape.push_back(2);
            py::array_t<double> pixels(shape);
            const double* p = points.data();
            double* out = pixels.mutable_data();
            for (py::ssize_t i = 0; i < points.size() / 3; ++i, p += 3) {
              const Eigen::Vector2d uv = camera.project({p[0], p[1], p[2]});
              *out++ = uv.x();
              *out++ = uv.y();
            }
            return pixels;
          },
          "points"_a, R"(Pixel coordinates of points in the camera frame.

Cost: about 10 ns per point.

Parameters
----------
points : array_like, (..., 3)
    Camera frame [m].

Returns
-------
ndarray, (..., 2), float64
    (u, v) [px]; NaN for points behind the camera.)")
      .def(
          "__eq__", [](const PinholeCamera& a, const PinholeCamera& b) { return a == b; },
          py::is_operator())
      .def("__repr__", [](const PinholeCamera& c) {
        const std::string rest =
            Fields().add("fx", c.fx).add("fy", c.fy).add("cx", c.cx).add("cy", c.cy).in("");
        std::string text = "PinholeCamera(" + std::to_string(c.width) + ", " +
                           std::to_string(c.height) + ", " + rest.substr(1);
        if (!c.has_distortion()) return text;
        text.pop_back();
        return text + ", distortion=" + py::repr(py::cast(c.distortion)).cast<std::string>() + ")";
      });
}

}  // namespace viewgain::python
