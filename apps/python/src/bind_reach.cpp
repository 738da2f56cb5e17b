// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include <pybind11/stl.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include "arrays.hpp"
#include "bindings.hpp"
#include "classes.hpp"
#include "gil.hpp"
#include "python_call.hpp"
#include "sealed_bytes.hpp"
#include "viewgain/core/reach.hpp"

namespace viewgain::python {
namespace {

ReachRegion region_of(const py::object& boxes, const py::object& shells,
                      const py::object& half_spaces, const py::object& poses, double distance,
                      double angle, const py::object& predicate) {
  ReachRegion region;
  region.boxes = optional_boxes(boxes, "boxes");
  if (!shells.is_none()) {
    const Doubles array = doubles(shells, "shells", {-1, 5});
    const double* x = array.data();
    for (py::ssize_t i = 0; i < array.shape(0); ++i, x += 5) {
      region.shells.push_back({{x[0], x[1], x[2]}, x[3], x[4]});
    }
  }
  if (!half_spaces.is_none()) {
    const Doubles array = doubles(half_spaces, "half_spaces", {-1, 4});
    const double* x = array.data();
    for (py::ssize_t i = 0; i < array.shape(0); ++i, x += 4) {
      region.half_spaces.push_back({{x[0], x[1], x[2]}, x[3]});
    }
  }
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

// By value; a predicate is the same as itself alone.
bool is_same(const ReachRegion& a, const ReachRegion& b) {
  if (&a == &b) return true;
  const auto same_shell = [](const ReachRegion::Shell& s, const ReachRegion::Shell& t) {
    return s.center == t.center && s.min_radius == t.min_radius && s.max_radius == t.max_radius;
  };
  const auto same_half_space = [](const ReachRegion::HalfSpace& s,
                                  const ReachRegion::HalfSpace& t) {
    return s.normal == t.normal && s.offset == t.offset;
  };
  return !a.predicate && !b.predicate && a.boxes == b.boxes && a.poses == b.poses &&
         a.tolerance.distance == b.tolerance.distance && a.tolerance.angle == b.tolerance.angle &&
         std::equal(a.shells.begin(), a.shells.end(), b.shells.begin(), b.shells.end(),
                    same_shell) &&
         std::equal(a.half_spaces.begin(), a.half_spaces.end(), b.half_spaces.begin(),
                    b.half_spaces.end(), same_half_space);
}

// What a pickle is of. A predicate is a function, which bytes cannot hold.
constexpr const char* kKind = "viewgain reach 1\n";

py::bytes bytes_of(const ReachRegion& region) {
  if (region.predicate) {
    throw py::type_error("a ReachRegion with a predicate cannot be pickled or made bytes");
  }
  std::vector<std::array<double, 6>> boxes;
  for (const Box& b : region.boxes) {
    boxes.push_back({b.min[0], b.min[1], b.min[2], b.max[0], b.max[1], b.max[2]});
  }
  std::vector<std::array<double, 5>> shells;
  for (const ReachRegion::Shell& s : region.shells) {
    shells.push_back({s.center.x(), s.center.y(), s.center.z(), s.min_radius, s.max_radius});
  }
  std::vector<std::array<double, 4>> half_spaces;
  for (const ReachRegion::HalfSpace& h : region.half_spaces) {
    half_spaces.push_back({h.normal.x(), h.normal.y(), h.normal.z(), h.offset});
  }
  std::vector<std::array<double, 12>> poses;
  for (const Pose& pose : region.poses) poses.push_back(pose.m);
  SealedWriter writer(kKind);
  writer.add(boxes);
  writer.add(shells);
  writer.add(half_spaces);
  writer.add(poses);
  writer.add(std::vector<double>{region.tolerance.distance, region.tolerance.angle});
  return writer.seal();
}

ReachRegion from_bytes(const py::bytes& data) {
  const auto bytes = data.cast<std::string>();
  SealedReader reader(kKind, bytes, "region");
  ReachRegion region;
  for (const auto& b : reader.next<std::array<double, 6>>()) {
    region.boxes.push_back({{b[0], b[1], b[2]}, {b[3], b[4], b[5]}});
  }
  for (const auto& s : reader.next<std::array<double, 5>>()) {
    region.shells.push_back({{s[0], s[1], s[2]}, s[3], s[4]});
  }
  for (const auto& h : reader.next<std::array<double, 4>>()) {
    region.half_spaces.push_back({{h[0], h[1], h[2]}, h[3]});
  }
  for (const auto& m : reader.next<std::array<double, 12>>()) {
    region.poses.emplace_back();
    region.poses.back().m = m;
  }
  const auto tolerance = reader.next<double>();
  reader.require_end();
  if (tolerance.size() != 2) reader.refuse();
  region.tolerance = {tolerance[0], tolerance[1]};
  region.validate();
  return region;
}

}  // namespace

void bind_reach(py::module_& module) {
  const ReachRegion::Tolerance tolerance;
  auto type = bound_class<ReachRegion>(module, "ReachRegion",
                                       R"(Where a robot can put the camera, world frame.

A pose is reachable if its centre lies in at least one of the boxes (where there are any), in at least
one of the shells (where there are any) and in every half-space, if it is among the poses (where there
are any), and if the predicate says so.

Parameters
----------
boxes : array_like, (n, 2, 3), optional
    Lowest and highest corners, world [m].
shells : array_like, (n, 5), optional
    Centre x y z, smallest and largest radius, world [m].
half_spaces : array_like, (n, 4), optional
    Normal, without a unit, and offset [m], world: normal . p >= offset.
poses : array_like, (n, 4, 4), optional
    T_world_camera.
distance, angle : float
    When two poses are the same one [m], [rad].
predicate : callable, optional
    Given T_world_camera (4, 4), returns a truth value. What it raises passes through.

Raises
------
ValueError
    A shape, a number that is not finite, a box or shell inside out, a zero normal, a bad pose.
TypeError
    predicate cannot be called.

Notes
-----
Regions without a predicate are equal by value and can be pickled; one with a predicate is equal to
itself alone. Holds the GIL, but not for files. Cost: linear in the parts, and in the poses that are asked
about: some 10 ns for each of both.)");
  pickle_as_bytes(type);
  type.def(py::init(&region_of), py::kw_only(), py::arg("boxes") = py::none(),
           py::arg("shells") = py::none(), py::arg("half_spaces") = py::none(),
           py::arg("poses") = py::none(), py::arg("distance") = tolerance.distance,
           py::arg("angle") = tolerance.angle, py::arg("predicate") = py::none())
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
          py::arg("T_world_camera"), R"(Which poses are reachable. A bad pose is not.

Parameters
----------
T_world_camera : array_like, (..., 4, 4)

Returns
-------
ndarray, (...), bool
    A single pose gives a scalar.

Raises
------
ValueError
    Another shape, no real numbers, or masked entries. What the predicate raises passes through.)")
      .def("to_bytes", &bytes_of, R"(The region as bytes, for ``from_bytes`` and pickles.

Returns
-------
bytes
    In this machine's byte order.

Raises
------
TypeError
    The region has a predicate.)")
      .def_static("from_bytes", &from_bytes, py::arg("data"), R"(The region that ``to_bytes`` wrote.

Parameters
----------
data : bytes

Returns
-------
ReachRegion
    Equal to the one that was written.

Raises
------
Error
    They are no region, or damaged.)")
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

}  // namespace viewgain::python
