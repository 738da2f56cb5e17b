// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include <pybind11/stl.h>

#include <cmath>
#include <cstdint>
#include <sstream>
#include <string>
#include <vector>

#include "arrays.hpp"
#include "classes.hpp"
#include "evaluator.hpp"
#include "gil.hpp"
#include "given.hpp"
#include "pose_arrays.hpp"
#include "viewgain/core/reach.hpp"
#include "viewgain/raycast/feasibility.hpp"

namespace viewgain::python {
namespace {

// Calls f for each row of an array (n, columns); None has no rows.
template <typename F>
void for_each_row(const py::object& given, const char* name, py::ssize_t columns, const F& f) {
  if (given.is_none()) return;
  const Doubles array = doubles(given, name, {-1, columns});
  for (py::ssize_t i = 0; i < array.shape(0); ++i) f(array.data() + i * columns);
}

ReachRegion region_of(const py::object& boxes, const py::object& shells,
                      const py::object& half_spaces, const py::object& poses, double distance,
                      double angle, const py::object& predicate) {
  ReachRegion region;
  region.boxes = optional_boxes(boxes, "boxes");
  for_each_row(shells, "shells", 5, [&](const double* x) {
    region.shells.push_back({{x[0], x[1], x[2]}, x[3], x[4]});
  });
  for_each_row(half_spaces, "half_spaces", 4, [&](const double* x) {
    region.half_spaces.push_back({{x[0], x[1], x[2]}, x[3]});
  });
  if (!poses.is_none()) region.poses = pose_list(poses, "poses");
  region.tolerance = {distance, angle};
  if (!predicate.is_none()) {
    if (PyCallable_Check(predicate.ptr()) == 0) throw py::type_error("predicate must be callable");
    region.predicate = [call = PythonCall(predicate)](const Pose& T_world_camera) {
      return with_gil([&] {
        const py::object answer = call(to_array(T_world_camera));
        const int truth = PyObject_IsTrue(answer.ptr());
        if (truth < 0) throw py::error_already_set();
        return truth == 1;
      });
    };
  }
  region.validate();
  return region;
}

// Equality by value; regions with a predicate are equal only to themselves.
bool is_same(const ReachRegion& a, const ReachRegion& b) {
  if (&a == &b) return true;
  return !a.predicate && !b.predicate && a.boxes == b.boxes && a.shells == b.shells &&
         a.half_spaces == b.half_spaces && a.poses == b.poses && a.tolerance == b.tolerance;
}

// Keywords of the constructor. Refuses a predicate, because functions cannot always be pickled.
py::dict keywords_of(const py::object& self) {
  const auto& region = self.cast<const ReachRegion&>();
  if (region.predicate) throw py::type_error("a ReachRegion with a predicate cannot be pickled");
  py::list boxes, shells, half_spaces;
  for (const Box& b : region.boxes) boxes.append(py::make_tuple(b.min, b.max));
  for (const ReachRegion::Shell& s : region.shells) {
    shells.append(
        py::make_tuple(s.center.x(), s.center.y(), s.center.z(), s.min_radius, s.max_radius));
  }
  for (const ReachRegion::HalfSpace& h : region.half_spaces) {
    half_spaces.append(py::make_tuple(h.normal.x(), h.normal.y(), h.normal.z(), h.offset));
  }
  const py::array_t<double> poses =
      to_array(region.poses, {static_cast<py::ssize_t>(region.poses.size())});
  return py::dict("boxes"_a = boxes, "shells"_a = shells, "half_spaces"_a = half_spaces,
                  "poses"_a = poses, "distance"_a = region.tolerance.distance,
                  "angle"_a = region.tolerance.angle);
}

}  // namespace

void bind_reach(py::module_& module) {
  const ReachRegion::Tolerance tolerance;
  auto type =
      bound_class<ReachRegion>(module, "ReachRegion",
                               R"(Region of camera poses that a robot can reach, world frame.

Each parameter that is given is a condition, and a reachable pose meets all of them. The camera
centre lies in one of the boxes, in one of the shells and in all half-spaces. The pose is one of
poses, within the tolerance. The predicate returns true.

Parameters
----------
boxes : array_like, (n, 2, 3), optional
    Lowest and highest corners, world frame [m].
shells : array_like, (n, 5), optional
    Spaces between two spheres: centre x y z, smallest and largest radius, world frame [m].
half_spaces : array_like, (n, 4), optional
    Normal x y z and offset [m], world frame. A half-space has the points p with normal . p >=
    offset.
poses : array_like, (n, 4, 4), optional
    T_world_camera.
distance, angle : float
    Tolerance for poses: largest distance between the camera centres [m], and largest rotation
    [rad].
predicate : callable, optional
    Takes T_world_camera (4, 4) and returns a truth value. Its exceptions pass through.

Notes
-----
Regions without a predicate are equal if their values are, and can be pickled. A region with a
predicate only equals itself. Holds the GIL, except for reading and writing files. Cost: about 10 ns
per pose and condition.)");
  pickle_as_call(type, &keywords_of);
  type.def(py::init(&region_of), py::kw_only(), "boxes"_a = py::none(), "shells"_a = py::none(),
           "half_spaces"_a = py::none(), "poses"_a = py::none(), "distance"_a = tolerance.distance,
           "angle"_a = tolerance.angle, "predicate"_a = py::none())
      .def(
          "contains",
          [](const ReachRegion& region, const py::object& T_world_camera) {
            const PoseBatch batch = pose_batch(T_world_camera, "T_world_camera", false);
            py::array_t<bool> inside(batch.shape);
            bool* out = inside.mutable_data();
            for (const Pose& pose : batch.poses) {
              *out++ = std::isfinite(pose.m[0]) && region.contains(pose);
            }
            return scalar_or_array(inside);
          },
          "T_world_camera"_a, R"(Whether poses are reachable. Invalid poses are not.

Parameters
----------
T_world_camera : array_like, (..., 4, 4)

Returns
-------
ndarray, (...), bool
    A single pose gives a scalar.)")
      .def(
          "__eq__", [](const ReachRegion& a, const ReachRegion& b) { return is_same(a, b); },
          py::is_operator())
      .def("__repr__", [](const ReachRegion& r) {
        std::ostringstream text;
        text << "<ReachRegion " << r.boxes.size() << " boxes, " << r.shells.size() << " shells, "
             << r.half_spaces.size() << " half-spaces, " << r.poses.size() << " poses"
             << (r.predicate ? ", predicate" : "") << ">";
        return text.str();
      });
}

namespace {

// Codes of Infeasibility, one per pose.
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
                                              R"(Checks which camera poses are feasible in a scene.

The housing of the sensor (its body) is a box. It must not overlap voxels that are not free,
obstacles or the scene's support plane. The pose must be within reach, and differ from the poses of
views so far. Space outside the workspace counts as free. Arguments after the scene are
keyword-only.

Parameters
----------
scene : VoxelScene
body_size : array_like, (3,), optional
    Width, height and depth of the housing, flange frame [m]; default: the sensor's, or if it has
    none, the SR4000's. The housing is centred on the z axis of the flange frame and extends from z
    = 0 to its depth.
T_flange_camera : array_like, (4, 4), optional
    Pose of the camera in the frame of the robot's flange; default: the sensor's. If it is unknown,
    the camera looks out of the middle of the front face.
clearance : float
    Margin around the body on each side [m].
reach : ReachRegion, optional
sensor : Sensor, optional
    If given, views of this sensor are also checked for surface that is nearer than its min_range.
max_near_share : float
    Largest fraction of rays that may end nearer than min_range, among those that end in the map.
num_threads : int
    Number of threads for arrays of poses; 0: all hardware threads. The predicate of ``reach`` is
    called by one thread at a time.

Notes
-----
Methods may run in many threads at once and release the GIL. Cost: 0.5 to 1 µs per pose. With a
sensor, poses close to the map take 10 to 50 µs for an SR4000.)");
  refuse_pickling(type);
  type.def(py::init([](const Given<Scene>& scene, const py::object& body_size,
                       const py::object& T_flange_camera, double clearance,
                       const GivenOrNone<ReachRegion>& reach, const GivenOrNone<Sensor>& sensor,
                       double max_near_share, int num_threads) {
             FeasibilityConfig config;
             if (sensor.value != nullptr) {
               config.sensor = *sensor.value;
               config.body.size = config.sensor->body_size.value_or(config.body.size);
               config.body.T_flange_camera = config.sensor->T_flange_camera;
             }
             if (!body_size.is_none()) {
               const Eigen::Vector3d size = vector3(body_size, "body_size");
               config.body.size = {size.x(), size.y(), size.z()};
             }
             if (!T_flange_camera.is_none()) {
               config.body.T_flange_camera = optional_pose(T_flange_camera, "T_flange_camera");
             }
             config.clearance = clearance;
             if (reach.value != nullptr) config.reach = *reach.value;
             config.max_near_share = max_near_share;
             return FeasibilityChecker(scene->scene, config, ExecConfig{num_threads});
           }),
           "scene"_a, py::kw_only(), "body_size"_a = py::none(), "T_flange_camera"_a = py::none(),
           "clearance"_a = defaults.clearance, "reach"_a = py::none(), "sensor"_a = py::none(),
           "max_near_share"_a = defaults.max_near_share, "num_threads"_a = 0)
      .def(
          "with_scene",
          [](const FeasibilityChecker& self, const Given<Scene>& scene) {
            const WithoutGil without_gil;
            return self.with_scene(scene->scene);
          },
          "scene"_a, R"(A checker for another scene, for example of a growing map.

This checker does not change. Cost: some microseconds.

Parameters
----------
scene : VoxelScene
    For example from ``VoxelScene.update``.

Returns
-------
FeasibilityChecker)")
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
          "T_world_camera"_a, "taken"_a = py::none(), R"(Whether poses are feasible.

Parameters
----------
T_world_camera : array_like, (..., 4, 4)
taken : array_like, (n, 4, 4), optional
    T_world_camera of the views so far.

Returns
-------
ndarray, (...), bool
    A single pose gives a scalar.)")
      .def(
          "reasons",
          [](const FeasibilityChecker& self, const py::object& T_world_camera,
             const py::object& taken) {
            return scalar_or_array(codes_of(self, T_world_camera, taken));
          },
          "T_world_camera"_a, "taken"_a = py::none(),
          R"(Why poses are not feasible: the first reason that applies.

Parameters
----------
T_world_camera, taken
    As ``feasible``.

Returns
-------
ndarray, (...), uint8
    Indices into ``INFEASIBILITY_NAMES``; 0 is "none". A single pose gives a scalar.)")
      .def("__repr__", [](const FeasibilityChecker& self) {
        return "<FeasibilityChecker of a scene of " +
               std::to_string(self.scene().primitive_count()) + " primitives>";
      });
}

}  // namespace viewgain::python
