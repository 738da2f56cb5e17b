// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include <pybind11/stl.h>

#include <algorithm>
#include <cstdint>
#include <string>

#include "arrays.hpp"
#include "pose_arrays.hpp"
#include "viewgain/core/generators.hpp"
#include "viewgain/core/tour.hpp"

namespace viewgain::python {
namespace {

const std::array<double, 3> kOrigin{};

py::array_t<double> pose_array(const std::vector<Pose>& poses) {
  return to_array(poses, {static_cast<py::ssize_t>(poses.size())});
}

py::array_t<double> look_at_all(const py::object& eyes, const py::object& target,
                                const py::object& up) {
  const Doubles eye = items(eyes, "eyes", {3});
  const Doubles goal = doubles(target, "target");
  const py::ssize_t axes = eye.ndim();
  const bool one_target = goal.ndim() == 1 && goal.shape(0) == 3;
  if (!one_target &&
      !(goal.ndim() == axes && std::equal(eye.shape(), eye.shape() + axes, goal.shape()))) {
    throw py::value_error("target must have the shape (3,) or the shape of eyes, " +
                          shape_text(eye) + ", not " + shape_text(goal));
  }
  const Eigen::Vector3d up_vector = vector3(up, "up");
  const auto count = static_cast<std::size_t>(eye.size() / 3);
  std::vector<Pose> poses;
  poses.reserve(count);
  for (std::size_t i = 0; i < count; ++i) {
    const double* e = eye.data() + 3 * i;
    const double* t = goal.data() + (one_target ? 0 : 3 * i);
    poses.push_back(look_at({e[0], e[1], e[2]}, {t[0], t[1], t[2]}, up_vector));
  }
  return to_array(poses, leading_shape(eye, 1));
}

py::tuple order_stops_of(const py::object& costs) {
  std::size_t count = 0;
  const WayCost way = way_table(costs, "costs", count);
  const Tour tour = order_stops(count, way);
  py::array_t<std::int64_t> stops(static_cast<py::ssize_t>(tour.stops.size()));
  std::copy(tour.stops.begin(), tour.stops.end(), stops.mutable_data());
  return py::make_tuple(stops, tour.cost);
}

// Parts of the docstrings that all lattices share.
constexpr const char* kCenter = R"(center : array_like, (3,)
    Centre of the lattice, world frame [m].
)";
constexpr const char* kReturns = R"(
Returns
-------
ndarray, (n, 4, 4), float64
    T_world_camera; count is 1 to 100 million.)";

std::string doc_of(const char* summary, const char* parameters) {
  return std::string(summary) +
         "\n\nHolds the GIL. Cost: about 0.15 µs per pose.\n\nParameters\n----------\n" +
         parameters + kCenter + kReturns;
}

// A function of count, radius and centre.
template <auto poses>
void def_lattice(py::module_& module, const char* name, const char* summary) {
  module.def(
      name,
      [](std::size_t count, double radius, const py::object& center) {
        return pose_array(poses(count, radius, vector3(center, "center")));
      },
      "count"_a, "radius"_a, py::kw_only(), "center"_a = kOrigin,
      doc_of(summary, "count : int\nradius : float\n    [m]\n").c_str());
}

}  // namespace

void bind_generators(py::module_& module) {
  module.def("look_at", &look_at_all, "eyes"_a, "target"_a, "up"_a = std::array<double, 3>{0, 0, 1},
             R"(Poses of cameras that look at a point.

Holds the GIL. Cost: about 0.1 µs per eye.

Parameters
----------
eyes : array_like, (..., 3)
    Camera centres, world frame [m].
target : array_like, (3,) or the shape of eyes
    Point on each optical axis, world frame [m].
up : array_like, (3,)
    Direction in the world frame that points up in the images, as closely as possible; any length.

Returns
-------
ndarray, (..., 4, 4), float64
    T_world_camera.)");
  module.def("order_stops", &order_stops_of, "costs"_a,
             R"(An order of k stops with a cheap path through all of them.

Up to 12 stops, the path is the cheapest. For more stops, it is a local optimum. Deterministic.
Holds the GIL. Cost: about 1 ms for 12 stops.

Parameters
----------
costs : array_like, (k + 1, k)
    Row i and column j have the cost of the path from stop i to stop j, in a unit of your choice
    such as metres or seconds. The last row has the costs from the current pose. Costs are at least
    0; inf means that there is no path. The diagonal is ignored.

Returns
-------
stops : ndarray, (k,), int64
    All stops in order; empty if every order has infinite cost.
cost : float
    Cost of the whole path; inf if no order was found.)");
  def_lattice<sphere_poses>(
      module, "sphere_poses",
      "Fibonacci lattice on a sphere, looking at its centre, with world up as image up.");
  def_lattice<dome_poses>(module, "dome_poses",
                          "Fibonacci lattice on the upper half of a sphere; see ``sphere_poses``.");
  module.def(
      "orbit_poses",
      [](std::size_t count, double radius, double elevation, double start,
         std::optional<double> step, const py::object& center) {
        return pose_array(
            orbit_poses(count, radius, elevation, start, step, vector3(center, "center")));
      },
      "count"_a, "radius"_a, "elevation"_a, py::kw_only(), "start"_a = 0.0, "step"_a = py::none(),
      "center"_a = kOrigin,
      doc_of("Views on a circle of latitude, looking at the centre.",
             R"(count : int
radius : float
    [m]
elevation : float
    [rad]
start : float
    Azimuth of the first pose [rad].
step : float, optional
    Azimuth step [rad]; default: 2 pi / count.
)")
          .c_str());
  module.def(
      "ring_poses",
      [](std::size_t count, double radius, double height, double tilt, double start,
         const py::object& center) {
        return pose_array(
            ring_poses(count, radius, height, tilt, start, vector3(center, "center")));
      },
      "count"_a, "radius"_a, "height"_a, "tilt"_a, py::kw_only(), "start"_a = 0.0,
      "center"_a = kOrigin,
      doc_of("Views on a circle around the vertical axis, looking down towards it.",
             R"(count : int
radius : float
    [m]
height : float
    Height above the centre [m].
tilt : float
    Angle below the horizontal [rad].
start : float
    Azimuth of the first pose [rad].
)")
          .c_str());
  module.def(
      "literature_ring_poses",
      [](std::size_t total, double radius, const py::object& center) {
        return pose_array(literature_ring_poses(total, radius, vector3(center, "center")));
      },
      "total"_a, "radius"_a, py::kw_only(), "center"_a = kOrigin,
      doc_of("The view sets of Isler et al. 2016, scaled to a radius.",
             R"(total : int
    48, 80, 288 or 864; another raises ValueError.
radius : float
    [m]
)")
          .c_str());
  module.def(
      "shell_poses",
      [](std::size_t count, double min_radius, double max_radius, std::uint64_t seed,
         const py::object& center) {
        return pose_array(
            shell_poses(count, min_radius, max_radius, seed, vector3(center, "center")));
      },
      "count"_a, "min_radius"_a, "max_radius"_a, py::kw_only(), "seed"_a = 1, "center"_a = kOrigin,
      doc_of("Random poses in the volume between two spheres, looking at the centre. Uniform.",
             R"(count : int
min_radius, max_radius : float
    [m]
seed : int
    A larger count with the same seed appends poses.
)")
          .c_str());
}

}  // namespace viewgain::python
