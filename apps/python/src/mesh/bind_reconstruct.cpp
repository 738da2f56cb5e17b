// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <pybind11/stl.h>

#include <memory>
#include <optional>
#include <string>
#include <utility>

#include "arrays.hpp"
#include "batch_call.hpp"
#include "classes.hpp"
#include "gil.hpp"
#include "given.hpp"
#include "map/depth_images.hpp"
#include "map/shared_grid.hpp"
#include "pose_arrays.hpp"
#include "viewgain/core/planning.hpp"
#include "viewgain/planner_mesh/candidate_generation.hpp"
#include "viewgain/planner_mesh/policies.hpp"
#include "viewgain/planner_mesh/surface_model.hpp"

namespace viewgain::python {
namespace {

/// Result for Python.
struct Reconstruction {
  std::string reason;
  py::list views;
  std::shared_ptr<SharedGrid> grid;
  SurfaceMesh surface;
};

void check_signals() {
  if (PyErr_CheckSignals() != 0) throw py::error_already_set();
}

// DATAACQUISITION by a Python function.
class PythonAcquisition : public DataAcquisition {
 public:
  PythonAcquisition(py::object callback, const Sensor& sensor)
      : callback_(std::move(callback)), sensor_(sensor) {}

  Measurements acquire(const Pose& T_world_camera, std::size_t) override {
    return with_gil([&] { return asked(T_world_camera); });
  }

 private:
  Measurements asked(const Pose& T_world_camera) {
    check_signals();
    const py::object answer = call_python(callback_, to_array(T_world_camera));
    Measurements measurements{T_world_camera, {}};
    if (!py::isinstance<py::tuple>(answer)) {
      measurements.frames.push_back(depth_frame(sensor_, answer, py::none()));
      return measurements;
    }
    const auto parts = py::reinterpret_borrow<py::tuple>(answer);
    if (parts.size() != 2 && parts.size() != 3) {
      throw py::value_error(
          "acquire must return depth, (depth, amplitude) or (depth, T_world_camera, amplitude), "
          "not a tuple of " +
          std::to_string(parts.size()));
    }
    if (parts.size() == 3) measurements.T_world_camera = one_pose(parts[1], "T_world_camera");
    measurements.frames.push_back(depth_frame(sensor_, parts[0], parts[parts.size() - 1]));
    return measurements;
  }

  py::object callback_;
  const Sensor& sensor_;
};

// One iteration of the loop.
py::object to_python(const ViewRecord& record) {
  const bool of_boundary = record.chosen_as && record.chosen_as->boundary_class;
  return named_in("viewgain.mesh.results", "ViewRecord", record.index,
                  to_array(record.T_world_camera),
                  record.chosen_as ? record.chosen_as->generator : "start",
                  of_boundary ? boundary_class_name(*record.chosen_as->boundary_class) : "",
                  record.predicted_gain, record.realised_gain, record.progress.entropy_removed,
                  record.progress.unknown_voxels, record.predicted_area, record.progress.new_area,
                  record.progress.surface_area, record.travelled, record.proposal.candidates.size(),
                  record.proposal.dropped);
}

// Whether a policy uses boundary candidates by default.
bool is_of_boundaries(Policy policy) {
  return policy != Policy::sequence && policy != Policy::random;
}

GenerationConfig generation_config(const Sensor& sensor, double voxel_size, bool boundary,
                                   const py::object& candidates, const ReachRegion* reach,
                                   Policy policy) {
  GenerationConfig config = default_generation(sensor, voxel_size);
  config.at_boundaries = boundary;
  config.boundary.classes_by_sight = policy == Policy::kriegel;
  if (!candidates.is_none()) {
    config.sets.push_back({"candidates", pose_list(candidates, "candidates")});
  }
  if (reach != nullptr) config.feasibility.reach = *reach;
  return config;
}

Reconstruction reconstruct(
    const py::object& acquire, const Given<Sensor>& of, const py::object& start, double voxel_size,
    const py::object& workspace, const std::string& criterion, const std::string& policy,
    const std::string& gain, std::optional<bool> boundary, const py::object& candidates,
    const ReachRegion* reach, std::optional<double> support_plane, bool jump_edges,
    std::size_t max_views, std::optional<double> stop_gain, std::optional<double> stop_area,
    std::size_t idle_views, std::size_t broken_promises, const py::object& observer,
    const GivenOrNone<Control>& control, const std::string& tracer, int num_threads) {
  if (PyCallable_Check(acquire.ptr()) == 0) throw py::type_error("acquire must be callable");
  if (!observer.is_none() && PyCallable_Check(observer.ptr()) == 0) {
    throw py::type_error("observer must be callable");
  }
  const Sensor& sensor = *of;
  const ExecConfig exec{num_threads, parse_tracer(tracer)};
  const Pose x_0 = one_pose(start, "start");
  SurfaceModelConfig model_config;
  ScorerConfig& map_config = model_config.map;
  map_config.voxel_size = voxel_size;
  map_config.workspace = box(workspace, "workspace");
  map_config.support_plane = support_plane;
  if (!jump_edges) map_config.jump_edges.reset();
  map_config.gain.criterion = parse_criterion(criterion);
  PolicyConfig policy_config;
  policy_config.policy = parse_policy(policy);
  if (policy_config.policy == Policy::fibonacci) {
    throw py::value_error(
        "policy \"fibonacci\" is a set of poses; give them as candidates of policy \"sequence\"");
  }
  const GenerationConfig generation_settings = generation_config(
      sensor, voxel_size, boundary.value_or(is_of_boundaries(policy_config.policy)), candidates,
      reach, policy_config.policy);
  if (!generation_settings.at_boundaries && candidates.is_none()) {
    throw py::value_error("policy \"" + policy + "\" requires candidates or boundary=True");
  }
  policy_config.criterion = map_config.gain.criterion;
  policy_config.model = parse_gain_model(gain);
  PlanningConfig planning;
  planning.max_views = max_views;
  set_stop_rules(planning, policy_config, stop_gain, stop_area);
  planning.idle_views = idle_views;
  planning.broken_promises = broken_promises;
  if (control.value != nullptr) planning.stop = control.value->stop.get_token();

  PythonAcquisition acquisition(acquire, sensor);
  SurfaceModel model(sensor, model_config, nullptr, exec);
  CandidateGeneration generation(model, generation_settings, exec);
  PolicyDecision decision(model, generation, sensor, policy_config, exec);
  Reconstruction result;
  const auto watch = [&](const ViewRecord& record) {
    with_gil([&] {
      check_signals();
      const py::object view = to_python(record);
      result.views.append(view);
      if (!observer.is_none()) call_python(observer, view);
    });
  };
  {
    // Runs on this thread, so that camera drivers and plots are called on their own thread.
    const WithoutGil without_gil;
    const PlanningResult end =
        active_view_planning(x_0, acquisition, model, generation, decision, planning, watch);
    result.reason = stop_reason_name(end.reason);
    result.grid = std::make_shared<SharedGrid>(model.grid().clone());
    result.surface = model.surface();
  }
  return result;
}

}  // namespace

void bind_reconstruct(py::module_& module) {
  auto type = bound_class<Reconstruction>(
      module, "Reconstruction",
      R"(Result of ``reconstruct``: views, stop reason, surface and map.)");
  refuse_pickling(type);
  type.def_readonly("reason", &Reconstruction::reason,
                    "str: stop reason: gain, area, cost, no_candidates, unreachable, idle, "
                    "promises, max_views, interrupted")
      .def_readonly("views", &Reconstruction::views, "list of ViewRecord: one per view")
      .def_readonly("grid", &Reconstruction::grid, "viewgain.BeliefGrid: the map")
      .def_readonly("surface", &Reconstruction::surface, "Surface: surface of the whole map")
      .def("__repr__", [](const Reconstruction& r) {
        return "<Reconstruction " + std::to_string(r.views.size()) + " views, ended by " +
               r.reason + ", " + std::to_string(r.surface.triangles.size()) + " triangles>";
      });

  const PlanningConfig defaults;
  module.def("reconstruct", &reconstruct, "acquire"_a, "sensor"_a, "start"_a, py::kw_only(),
             "voxel_size"_a, "workspace"_a, "criterion"_a = "log_diagonal", "policy"_a = "gain",
             "gain"_a = gain_model_name(kDefaultGain), "boundary"_a = py::none(),
             "candidates"_a = py::none(), "reach"_a = py::none(), "support_plane"_a = py::none(),
             "jump_edges"_a = true, "max_views"_a = defaults.max_views, "stop_gain"_a = py::none(),
             "stop_area"_a = py::none(), "idle_views"_a = defaults.idle_views,
             "broken_promises"_a = defaults.broken_promises, "observer"_a = py::none(),
             "control"_a = py::none(), "tracer"_a = "automatic", "num_threads"_a = 0,
             R"(The whole loop: measure, update map and surface, propose views, rank them, repeat.

Algorithm 1 of the paper (Foix et al. 2012) with your camera or simulator. Your functions run on the
calling thread. The GIL is released in between.

Parameters
----------
acquire : callable
    Takes T_world_camera (4, 4) of the next view, moves the camera there and returns a frame. The
    frame is depth, or (depth, amplitude) like a ``SimulatedFrame``, or (depth, T_world_camera,
    amplitude) like a ``Frame``, with the pose that the camera reached. depth has the shape (height,
    width), floating point, along the optical axis [m]. 0, NaN or masked: no measured depth. inf:
    free up to max_range. amplitude may be None. Exceptions end the loop and pass through.
sensor : viewgain.Sensor
start : array_like, (4, 4)
    T_world_camera of the first view, which must measure surface in the workspace.
voxel_size : float
    [m]
workspace : array_like, (2, 3)
    Lowest and highest corner of the mapped space, world frame [m].
criterion : {"log_diagonal", "log_determinant", "trace"}
policy : {"gain", "kriegel", "random", "frontier", "sequence"}
    How to choose the next view. "gain": by gain. "kriegel": open boundaries in the order left,
    right, top, bottom (Kriegel et al. 2011). "random": at random. "frontier": by the number of
    unknown voxels in view. "sequence": the candidates in order.
gain : {"combined", "surface", "paper"}
    Gain of policy "gain". "combined": expected new surface, and refinement of known surface [nat].
    "surface": expected new surface [m**2]. "paper": entropy removed [nat].
boundary : bool, optional
    Whether to propose views at open boundaries of the surface and where more surface is expected,
    in addition to candidates. Default: True, except for the policies "sequence" and "random".
candidates : array_like, (n, 4, 4), optional
    T_world_camera of poses to propose after every view; required if boundary is False.
reach : viewgain.ReachRegion, optional
    Reachable camera poses.
support_plane : float, optional
    Height z of the table, world frame [m].
jump_edges : bool
    Remove flying pixels.
max_views : int
stop_gain : float, optional
    With gain "paper": stop when the best candidate's gain, divided by the number of voxels in which
    its rays end, is below this [nat; m**2 with "trace"]. Default: 1.2; with "trace", 0.01 of the
    value of the first decision.
stop_area : float, optional
    With gain "surface" and "combined": stop when the largest expected new surface of a candidate,
    divided by the surface area so far and averaged over three decisions, is below this; 0: never.
    Default: that of the program's ``reconstruct``.
idle_views : int
    Stop after this many consecutive views that changed almost nothing; 0: never.
broken_promises : int
    With policy "gain": stop after this many consecutive views that showed less than a fifth of the
    predicted new surface, or with gain "paper", removed less than a fifth of the predicted entropy;
    0: never.
observer : callable, optional
    Called with the ViewRecord of each view when the next view has been chosen.
control : viewgain.BatchControl, optional
    Its stop() ends the loop with the reason "interrupted". Its progress function is not called.
tracer : {"automatic", "embree", "sweep"}
    Tracer, as in ``viewgain.GainEvaluator``. Does not affect the result.
num_threads : int
    0: all hardware threads. Does not affect the result.

Returns
-------
Reconstruction
    Its views are of the class ``ViewRecord``.)");
}

}  // namespace viewgain::python
