// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include <pybind11/stl.h>

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "arrays.hpp"
#include "batch_call.hpp"
#include "bindings.hpp"
#include "classes.hpp"
#include "gil.hpp"
#include "map/depth_images.hpp"
#include "map/integration.hpp"
#include "map/shared_grid.hpp"
#include "named.hpp"
#include "planner.hpp"
#include "scene.hpp"
#include "viewgain/planner/view_planner.hpp"

namespace viewgain::python {
namespace {

std::unique_ptr<Planner> make(Sensor sensor, double voxel_size, const py::object& workspace,
                              const py::object& T_world_grid, std::optional<double> prior_sigma,
                              std::optional<double> support_plane, const py::object& boxes,
                              const py::iterable& meshes, const std::string& gain,
                              const std::string& criterion, std::optional<double> object_size,
                              const ReachRegion* reach, const py::object& body_size,
                              double clearance, bool jump_edges, bool check_feasibility,
                              std::size_t max_views, std::size_t idle_views,
                              std::optional<double> stop_gain, std::optional<double> stop_area,
                              const py::object& state, int num_threads) {
  PlannerConfig config;
  config.grid.voxel_size = voxel_size;
  config.grid.workspace = box(workspace, "workspace");
  config.grid.T_world_grid = optional_pose(T_world_grid, "T_world_grid").value_or(Pose());
  config.grid.prior_sigma = prior_sigma.value_or(0);
  if (prior_sigma && !(*prior_sigma > 0)) {
    throw py::value_error("prior_sigma must be positive");
  }
  config.support_plane = support_plane;
  config.obstacles = obstacles_of(boxes, meshes);
  if (!jump_edges) config.jump_edges.reset();
  config.hazard.object_size = object_size;
  config.gain.model = parse_gain_model(gain);
  config.gain.criterion = parse_criterion(criterion);
  if (reach != nullptr) config.reach = *reach;
  if (!body_size.is_none()) {
    const Eigen::Vector3d size = vector3(body_size, "body_size");
    sensor.body_size = {size.x(), size.y(), size.z()};
  }
  config.clearance = clearance;
  config.check_feasibility = check_feasibility;
  config.max_views = max_views;
  config.idle_views = idle_views;
  config.stop_gain = stop_gain;
  config.stop_area = stop_area;
  const ExecConfig exec{num_threads};
  if (state.is_none()) {
    return std::make_unique<Planner>(sensor, ViewPlanner(sensor, config, exec));
  }
  const std::string file = file_path(state);
  require_file(file);
  const auto loaded = [&] {
    const WithoutGil without_gil;
    return ViewPlanner::load(file, sensor, config, exec);
  };
  return std::make_unique<Planner>(sensor, loaded());
}

py::object add(Planner& self, const py::object& depth, const py::object& T_world_camera,
               const py::object& amplitude) {
  const DepthFrame frame = depth_frame(self.sensor(), depth, amplitude);
  const Pose pose = one_pose(T_world_camera, "T_world_camera");
  const AddedView added = self.run([&](ViewPlanner& planner) { return planner.add(frame, pose); });
  const IntegrationReport& counts = added.update.counts;
  return named("AddedView", counts.readings, counts.plane_readings, counts.out_of_range,
               counts.invalid, counts.readings_inside, counts.voxels_hit, counts.voxels_crossed,
               added.view, added.entropy_removed, added.update.new_area,
               added.progress.entropy_removed, added.progress.surface_area,
               added.progress.unknown_voxels);
}

py::object register_frame(Planner& self, const py::object& depth, const py::object& T_world_camera,
                          double sigma_translation, double sigma_rotation,
                          const py::object& amplitude) {
  const DepthFrame frame = depth_frame(self.sensor(), depth, amplitude);
  const PosePrior prior{one_pose(T_world_camera, "T_world_camera"), sigma_translation,
                        sigma_rotation};
  const FrameRegistration found =
      self.run([&](ViewPlanner& planner) { return planner.register_frame(frame, prior); });
  py::array_t<double> covariance(Shape{6, 6}, found.covariance.data());
  return named("FrameRegistration", std::string(registration_status_name(found.status)),
               found.reason, to_array(found.T_world_camera), covariance, found.translation,
               found.rotation, found.residual_before, found.residual_after, found.readings,
               found.pairs, found.overlap, found.contradiction, found.smallest_information,
               found.free_directions.size());
}

py::object propose(Planner& self) {
  const Proposal proposal = self.run([](ViewPlanner& planner) { return planner.propose(); });
  std::vector<Pose> poses;
  py::list generators;
  for (const Candidate& candidate : proposal.candidates) {
    poses.push_back(candidate.T_world_camera);
    generators.append(candidate.generator);
  }
  return named("Proposal", to_array(poses, {static_cast<py::ssize_t>(poses.size())}), generators,
               proposal.dropped);
}

py::object rank(Planner& self, std::size_t k, const py::object& poses, const py::object& costs,
                double cost_per_metre, bool exact, Control* control) {
  RankConfig config;
  config.cost_per_metre = cost_per_metre;
  config.exact = exact;
  std::vector<double> own_costs;
  if (!costs.is_none()) {
    const Doubles given = doubles(costs, "costs", {-1});
    own_costs.assign(given.data(), given.data() + given.size());
    if (own_costs.empty()) throw py::value_error("costs is empty: one a pose is needed");
    config.costs = own_costs;
  }
  std::vector<Pose> asked;
  if (!poses.is_none()) asked = pose_batch(poses, "poses", false).poses;
  Ranking ranking;
  self.use([&](ViewPlanner& planner) {
    run_batch(control, [&](const BatchControl& watched) {
      ranking = poses.is_none() ? planner.rank(k, config, watched)
                                : planner.rank(asked, k, config, watched);
    });
  });
  const auto count = static_cast<py::ssize_t>(ranking.views.size());
  py::array_t<std::int64_t> index(count);
  py::array_t<double> gain(count), area(count), worth(count);
  std::vector<Pose> ranked;
  for (py::ssize_t i = 0; i < count; ++i) {
    const RankedView& view = ranking.views[static_cast<std::size_t>(i)];
    ranked.push_back(view.T_world_camera);
    index.mutable_at(i) = static_cast<std::int64_t>(view.index);
    gain.mutable_at(i) = view.gain.gain;
    area.mutable_at(i) = view.gain.area;
    worth.mutable_at(i) = view.worth;
  }
  return named("Ranking", index, to_array(ranked, {count}), gain, area, worth, ranking.complete);
}

}  // namespace

void bind_planner(py::module_& module) {
  const PlannerConfig defaults;
  auto type = bound_class<Planner>(module, "ViewPlanner", kPlannerDoc);
  refuse_pickling(type);
  type.def(py::init(&make), py::arg("sensor"), py::kw_only(), py::arg("voxel_size"),
           py::arg("workspace"), py::arg("T_world_grid") = py::none(),
           py::arg("prior_sigma") = py::none(), py::arg("support_plane") = py::none(),
           py::arg("boxes") = py::none(), py::arg("meshes") = py::tuple(),
           py::arg("gain") = gain_model_name(defaults.gain.model),
           py::arg("criterion") = criterion_name(defaults.gain.criterion),
           py::arg("object_size") = py::none(), py::arg("reach") = py::none(),
           py::arg("body_size") = py::none(), py::arg("clearance") = defaults.clearance,
           py::arg("jump_edges") = true, py::arg("check_feasibility") = true,
           py::arg("max_views") = defaults.max_views, py::arg("idle_views") = defaults.idle_views,
           py::arg("stop_gain") = py::none(), py::arg("stop_area") = py::none(),
           py::arg("state") = py::none(), py::arg("num_threads") = 0)
      .def_static(
          "load",
          [](const py::object& path, const py::args& args, const py::kwargs& settings) {
            return py::type::of<Planner>()(*args, **settings, py::arg("state") = path);
          },
          py::arg("path"), R"(A planner that goes on where ``save`` was called, bit for bit.

Parameters
----------
path : path-like
sensor, **settings
    Those of the constructor, as before, which is not looked at but for the map's layout; candidates
    are added and proposed anew, too.

Returns
-------
ViewPlanner)")
      .def(
          "save",
          [](Planner& self, const py::object& path) {
            const std::string file = file_path(path);
            require_writable(file);
            self.run([&](ViewPlanner& planner) { planner.save(file); });
          },
          py::arg("path"), R"(Writes the whole state, a map with notes, whole or not at all.

Left out are the settings, poses, generators and the last proposal. ``BeliefGrid.load`` and the program read the map.

Parameters
----------
path : path-like

Raises
------
OSError)")
      .def(
          "add_poses",
          [](Planner& self, const py::object& T_world_camera, const std::string& name) {
            PoseSet set{name, pose_list(T_world_camera, "T_world_camera")};
            self.use([&](ViewPlanner& planner) { planner.add_poses(std::move(set)); });
          },
          py::arg("T_world_camera"), py::arg("name") = "poses",
          R"(Candidates that are proposed from now on.

Parameters
----------
T_world_camera : array_like, (n, 4, 4)
name : str
    The generator that ``propose`` names.)")
      .def(
          "add_generator",
          [](Planner& self, const py::object& generator, const std::string& name) {
            if (PyCallable_Check(generator.ptr()) == 0) {
              throw py::type_error("generator must be callable");
            }
            self.use([&](ViewPlanner& planner) {
              planner.add_generation(
                  std::make_shared<PythonGeneration>(generator, name, planner.map()));
            });
          },
          py::arg("generator"), py::arg("name") = "generator",
          R"(Candidates that are made anew for each proposal.

Parameters
----------
generator : callable
    Given the map, a BeliefGrid of its own with the views so far, returns poses (n, 4, 4). What it
    raises passes through. It must not call the planner, nor refer to it: the two would never be
    released.
name : str)")
      .def("add", &add, py::arg("depth"), py::arg("T_world_camera"), py::kw_only(),
           py::arg("amplitude") = py::none(),
           R"(Puts a frame into the map; the last proposal is void.

Parameters
----------
depth : array_like, (height, width), floating point
    Along the optical axis [m]; 0, NaN or masked: nothing known, inf: nothing up to max_range.
T_world_camera : array_like, (4, 4)
amplitude : array_like, (height, width), optional
    [1/m**2]

Returns
-------
AddedView
    The counts of ``FrameIntegrator.integrate``; view (from 0); entropy_removed [nat] and new_area
    [m**2] by this view, total_entropy_removed and total_area so far, unknown_voxels that are left.
    new_area is area across the rays, as the expected area is: surface that is seen obliquely is
    larger. It is NaN by gain "paper".

Raises
------
ValueError
    A shape, a dtype, or a pose that is not rigid. Nothing has changed then.)")
      .def("register_frame", &register_frame, py::arg("depth"), py::arg("T_world_camera"),
           py::kw_only(), py::arg("sigma_translation") = PosePrior{}.sigma_translation,
           py::arg("sigma_rotation") = PosePrior{}.sigma_rotation,
           py::arg("amplitude") = py::none(),
           R"(Where the camera was, by what the frame shows of the map so far. Changes nothing.

Minimises the distances of the frame's readings from the map's points along the surface's normals,
by Gauss and Newton, with the reported pose as prior. Put a frame that is "registered" in at the pose
that was found, one with "too_little_overlap" as reported, and leave out one that is "refused": it
contradicts the map, or would move by more than five sigmas. Some 100 to 300 ms a frame.

Parameters
----------
depth : array_like, (height, width), floating point
    As for ``add``.
T_world_camera : array_like, (4, 4)
    As it is reported.
sigma_translation : float
    How far each coordinate of the camera's centre may be off, 1 sigma [m].
sigma_rotation : float
    The same of each component of its rotation [rad].
amplitude : array_like, (height, width), optional
    [1/m**2]

Returns
-------
FrameRegistration

Raises
------
ValueError
    A shape, a dtype, a pose that is not rigid, a sigma that is not positive.)")
      .def("propose", &propose, R"(The candidates that are possible now.

Returns
-------
Proposal
    T_world_camera (n, 4, 4), generator (list of str, one a candidate), dropped (reason -> how many;
    the names of ``INFEASIBILITY_NAMES``, and "missed": it was commanded and not reached).)")
      .def("rank", &rank, py::arg("k") = 1, py::kw_only(), py::arg("poses") = py::none(),
           py::arg("costs") = py::none(), py::arg("cost_per_metre") = 0.0, py::arg("exact") = false,
           py::arg("control") = py::none(),
           R"(The k best candidates of the last proposal, or of any poses.

Parameters
----------
k : int
poses : array_like, (n, 4, 4), optional
    Instead of the proposal; nobody looks whether they are possible. Bad ones are last, with NaN.
    Says nothing to ``should_stop``.
costs : array_like, (n,), optional
    Subtracted from the gains, in their unit.
cost_per_metre : float
    Of the way from the last view, likewise. The combined gain of new surface goes with 1 / voxel**2,
    and so should this.
exact : bool
    Score all in full. Else, but by gain "paper", in two stages: see ``GainEvaluator.race``.
control : BatchControl, optional

Returns
-------
Ranking
    Arrays, best first: index (into the candidates or poses), T_world_camera, gain [nat; by gain
    "surface" m**2], area [m**2] (NaN by gain "paper"), worth (the gain less the cost; 0 or less: the
    way costs more than the view brings); and complete, False if a stop was requested.

Raises
------
ValueError
    There is no proposal since the last view, or costs are not one a pose.)")
      .def(
          "tried",
          [](Planner& self, const py::object& T_world_camera, bool reached) {
            const Pose pose = one_pose(T_world_camera, "T_world_camera");
            self.use([&](ViewPlanner& planner) { planner.tried(pose, reached); });
          },
          py::arg("T_world_camera"), py::arg("reached"),
          R"(A pose was commanded: it is not proposed again, and goes out of the proposal as it stands.

Parameters
----------
T_world_camera : array_like, (4, 4)
reached : bool
    Whether the camera got there.)")
      .def(
          "should_stop",
          [](Planner& self) -> py::object {
            return self.use([](ViewPlanner& planner) -> py::object {
              const auto reason = planner.should_stop();
              return reason ? py::object(py::str(std::string(stop_reason_name(*reason))))
                            : py::object(py::none());
            });
          },
          R"(Why to end, if there is a reason.

Returns
-------
str or None
    After ``add`` max_views or idle; after ``propose`` no_candidates or unreachable; after ``rank`` of
    the proposal gain or area.)")
      .def_property_readonly(
          "grid",
          [](Planner& self) {
            return self.run([](ViewPlanner& planner) {
              return std::make_shared<SharedGrid>(planner.grid().clone());
            });
          },
          "BeliefGrid: a copy of the map as it is")
      .def_property_readonly(
          "seconds",
          [](Planner& self) {
            return self.use([](ViewPlanner& planner) { return planner.seconds(); });
          },
          "dict: what the steps since the last add took, it included [s]: integrate, snapshot, "
          "candidates, score")
      .def("__repr__", [](const Planner& self) { return self.text(); });
}

}  // namespace viewgain::python
