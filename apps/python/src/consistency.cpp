// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include "consistency.hpp"

#include <pybind11/stl.h>

#include <array>
#include <limits>
#include <memory>
#include <optional>
#include <vector>

#include "classes.hpp"
#include "gil.hpp"
#include "given.hpp"
#include "map/depth_images.hpp"
#include "map/shared_grid.hpp"

namespace viewgain::python {
namespace {

// A check and the sensor that its images are of.
struct Check {
  Sensor sensor;
  FrameCheck check;
};

void look(Check& self, const Given<SharedGrid>& before, const py::object& depth,
          const py::object& T_world_camera, const std::array<double, 2>& pose_sigma) {
  const DepthFrame frame = depth_frame(self.sensor, depth, py::none());
  const Pose pose = one_pose(T_world_camera, "T_world_camera");
  (*before).read([&](const BeliefGrid& grid) {
    self.check.look(grid, frame, pose, PoseSigma{pose_sigma[0], pose_sigma[1]});
    self.check.see(frame, pose);
    return 0;
  });
}

}  // namespace

py::object to_python(const FrameConsistency& found) {
  std::vector<double> in_free, seen_past, displacements;
  for (const FrameContradiction& frame : found.frames) {
    in_free.push_back(frame.share_in_free());
    seen_past.push_back(frame.share_seen_past());
    displacements.push_back(frame.compared > 0 ? frame.displacement
                                               : std::numeric_limits<double>::quiet_NaN());
  }
  py::object suspicion = py::none();
  if (!found.suspicion.kind.empty()) {
    suspicion = named("Suspicion", found.suspicion.kind, found.suspicion.what);
  }
  return named("FrameConsistency", found.share_in_free, found.share_seen_past,
               py::tuple(py::cast(found.contradicting)), suspicion, to_array_1d<double>(in_free),
               to_array_1d<double>(seen_past), found.displacement, found.expected,
               to_array_1d<double>(displacements));
}

void bind_frame_check(py::module_& module) {
  auto type = bound_class<Check>(
      module, "FrameCheck",
      R"(Holds frames against one another while a ``FrameIntegrator`` puts them into a map.

``ViewPlanner`` does so by itself (``ViewPlanner.consistency``). Thread safety: one call at a time.

Parameters
----------
sensor : Sensor
support_plane : float, optional
    Height z of the table [m]; None: no table.)");
  refuse_pickling(type);
  type.def("__repr__", [](const Check& self) { return "<FrameCheck of " + self.sensor.name + ">"; })
      .def(py::init([](const Given<Sensor>& sensor, std::optional<double> support_plane) {
             return Check{*sensor, FrameCheck(*sensor, support_plane)};
           }),
           "sensor"_a, py::kw_only(), "support_plane"_a = py::none())
      .def("look", &look, "before"_a, "depth"_a, "T_world_camera"_a, py::kw_only(),
           "pose_sigma"_a = std::array<double, 2>{0, 0},
           R"(Takes a frame that is about to be integrated.

Cost: 0.5 ms for 176x144 pixels.

Parameters
----------
before : BeliefGrid
    The map without the frame.
depth : array_like, (height, width), floating point
    Along the optical axis [m]; 0, NaN or masked: nothing known, inf: nothing up to max_range.
    Flying pixels contradict other frames: leave them out.
T_world_camera : array_like, (4, 4)
pose_sigma : array_like, (2,), optional
    Standard deviations of the pose beside the sensor's own pose_sigma [m], [rad].)")
      .def(
          "result",
          [](const Check& self, const Given<SharedGrid>& after) {
            return to_python(
                (*after).read([&](const BeliefGrid& grid) { return self.check.result(grid); }));
          },
          "after"_a, R"(What the frames so far come to.

Cost: 50 ms for a dozen frames, 0.5 s where they do not fit.

Parameters
----------
after : BeliefGrid
    The map with all frames.

Returns
-------
FrameConsistency)");
}

}  // namespace viewgain::python
