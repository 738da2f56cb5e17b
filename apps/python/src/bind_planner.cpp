// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include <pybind11/stl.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "arrays.hpp"
#include "batch_call.hpp"
#include "classes.hpp"
#include "consistency.hpp"
#include "evaluator.hpp"
#include "gil.hpp"
#include "given.hpp"
#include "map/depth_images.hpp"
#include "map/shared_grid.hpp"
#include "planner_class.hpp"
#include "planner_docs.hpp"
#include "pose_arrays.hpp"
#include "suspicions.hpp"
#include "viewgain/formats/frames.hpp"
#include "viewgain/planner/view_planner.hpp"

namespace viewgain::python {
namespace {

std::unique_ptr<Planner> make(const Given<Sensor>& of, double voxel_size,
                              const py::object& workspace, const py::object& T_world_grid,
                              std::optional<double> prior_sigma,
                              std::optional<double> support_plane, const py::object& boxes,
                              const py::iterable& meshes, const std::string& gain,
                              const std::string& criterion, std::optional<double> object_size,
                              const GivenOrNone<ReachRegion>& reach, const py::object& body_size,
                              double clearance, bool jump_edges, bool check_feasibility,
                              std::size_t max_views, std::size_t idle_views,
                              std::size_t broken_promises, std::size_t plan, std::size_t take,
                              std::optional<double> stop_gain, std::optional<double> stop_area,
                              int coarsest, const py::object& fine, int finest,
                              const py::object& state, const std::string& tracer, int num_threads) {
  Sensor sensor = *of;
  ScorerConfig map;
  map.voxel_size = voxel_size;
  map.workspace = box(workspace, "workspace");
  map.T_world_grid = optional_pose(T_world_grid, "T_world_grid").value_or(Pose());
  map.prior_sigma = prior_sigma;
  map.obstacles = obstacles_of(boxes, meshes);
  map.support_plane = support_plane;
  if (!jump_edges) map.jump_edges.reset();
  map.coarsest = coarsest;
  map.fine = optional_boxes(fine, "fine");
  map.finest = finest;
  map.hazard.object_size = object_size;
  map.gain.model = parse_gain_model(gain);
  map.gain.criterion = parse_criterion(criterion);
  map.clearance = clearance;
  PlannerConfig config;
  if (reach.value != nullptr) config.reach = *reach.value;
  if (!body_size.is_none()) {
    const Eigen::Vector3d size = vector3(body_size, "body_size");
    sensor.body_size = {size.x(), size.y(), size.z()};
  }
  config.check_feasibility = check_feasibility;
  config.max_views = max_views;
  config.idle_views = idle_views;
  config.broken_promises = broken_promises;
  config.ahead.plan = plan;
  config.ahead.take = take;
  config.stop_gain = stop_gain;
  config.stop_area = stop_area;
  const ExecConfig exec{num_threads, parse_tracer(tracer)};
  const std::string file = state.is_none() ? "" : readable_file(state);
  ViewPlanner planner = outside_gil([&] {
    return file.empty() ? ViewPlanner(ViewScorer(sensor, map, exec), config)
                        : ViewPlanner::load(file, sensor, map, config, exec);
  });
  warn(suspicions_of_set_up(planner.scorer(), config.reach));
  return std::make_unique<Planner>(sensor, std::move(planner));
}

// A pose that may be invalid, and is then NaN; only the shape is checked.
Pose loose_pose(const py::object& T_world_camera) {
  return one_pose(T_world_camera, "T_world_camera", false);
}

py::object to_python(const AddedView& added) {
  const IntegrationReport& counts = added.update.counts;
  return named("AddedView", counts.readings, counts.plane_readings, counts.out_of_range,
               counts.invalid, counts.readings_inside, counts.voxels_hit, counts.voxels_crossed,
               added.view, added.entropy_removed, added.update.new_area,
               added.progress.entropy_removed, added.progress.surface_area,
               added.progress.unknown_voxels,
               std::string(frame_verdict_name(added.update.verdict)));
}

// Result of add(), and suspected faults of the frame or its pose.
struct Judged {
  AddedView added{};
  Suspicion suspicion{};
};

Judged judged(ViewPlanner& planner, const Sensor& sensor, const DepthFrame& frame,
              const Pose& T_world_camera, const PoseSigma& pose_sigma = {}) {
  Judged result{planner.add(frame, T_world_camera, pose_sigma)};
  const MapUpdate& update = result.added.update;
  if (update.verdict == FrameVerdict::used || update.verdict == FrameVerdict::carved ||
      update.verdict == FrameVerdict::outside) {
    result.suspicion =
        suspicion_of_frame(sensor, frame, T_world_camera, planner.scorer().grid(), update.counts);
  }
  return result;
}

py::object to_python(const Judged& judged) {
  warn(judged.suspicion);
  return to_python(judged.added);
}

py::object add(Planner& self, const py::object& depth, const py::object& T_world_camera,
               const std::array<double, 2>& pose_sigma, const py::object& amplitude) {
  const DepthFrame frame = depth_frame(self.sensor(), depth, amplitude);
  const Pose pose = loose_pose(T_world_camera);
  const PoseSigma sigma{pose_sigma[0], pose_sigma[1]};
  return to_python(self.run(
      [&](ViewPlanner& planner) { return judged(planner, self.sensor(), frame, pose, sigma); }));
}

py::object add_frame(Planner& self, const Given<FrameSequence>& frames, py::ssize_t index) {
  const auto i = frame_index(frames->images.size(), index);
  return to_python(self.run([&](ViewPlanner& planner) {
    const FrameReading read = read_frame(*frames, i);
    const Pose& T_world_camera = frames->poses.at(i);
    return read.fault.verdict == FrameVerdict::used
               ? judged(planner, self.sensor(), read.frame, T_world_camera)
               : Judged{planner.drop(read.fault.verdict, T_world_camera)};
  }));
}

py::object drop(Planner& self, const std::string& verdict, const py::object& T_world_camera) {
  const auto& names = kFrameVerdictNames;
  const auto found = std::find(names.begin(), names.end(), verdict);
  if (found == names.end()) {
    throw py::value_error("verdict is \"" + verdict + "\", which is not a verdict");
  }
  std::optional<Pose> pose;
  if (!T_world_camera.is_none()) pose = loose_pose(T_world_camera);
  return to_python(self.run([&](ViewPlanner& planner) {
    return planner.drop(static_cast<FrameVerdict>(found - names.begin()), pose);
  }));
}

py::object register_frame(Planner& self, const py::object& depth, const py::object& T_world_camera,
                          double sigma_translation, double sigma_rotation,
                          const py::object& amplitude) {
  const DepthFrame frame = depth_frame(self.sensor(), depth, amplitude);
  const Pose T_reported = one_pose(T_world_camera, "T_world_camera");
  const FrameRegistration found = self.run([&](ViewPlanner& planner) {
    return planner.register_frame(frame, T_reported, {sigma_translation, sigma_rotation});
  });
  py::array_t<double> covariance(Shape{6, 6}, found.covariance.data());
  return named("FrameRegistration", std::string(registration_status_name(found.status)),
               found.reason, to_array(found.T_world_camera), covariance, found.translation,
               found.rotation, found.residual_before, found.residual_after, found.readings,
               found.pairs, found.overlap, found.contradiction, found.smallest_information,
               found.free_directions.size(),
               py::make_tuple(found.pose_sigma().translation, found.pose_sigma().rotation));
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

Suspicion suspicion_on_map(Planner& self, std::span<const Pose> poses) {
  return self.run([&](ViewPlanner& planner) {
    return suspicion_of_poses(planner.scorer().scene(), self.sensor(), poses);
  });
}

py::object rank(Planner& self, std::size_t k, const py::object& poses, const py::object& costs,
                double cost_per_metre, const py::object& current_pose, bool together, bool exact,
                const py::object& measure, const GivenOrNone<Control>& control) {
  const std::optional<PythonMeasure> own = measure_or_none(measure);
  RankConfig config;
  if (own) config.measure = &*own;
  config.cost_per_metre = cost_per_metre;
  config.current_pose = optional_pose(current_pose, "current_pose");
  config.together = together;
  config.exact = exact;
  const std::vector<double> own_costs = costs_or_none(costs);
  config.costs = own_costs;
  std::vector<Pose> asked;
  if (!poses.is_none()) {
    asked = pose_batch(poses, "poses", false).poses;
    warn(suspicion_on_map(self, asked));
  }
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
  return named("Ranking", index, gain, worth, ranking.complete, area, to_array(ranked, {count}));
}

}  // namespace

void bind_planner(py::module_& module) {
  const PlannerConfig defaults;
  const ScorerConfig map_defaults;
  auto type = bound_class<Planner>(module, "ViewPlanner", kPlannerDoc);
  refuse_pickling(type);
  type.def(py::init(&make), "sensor"_a, py::kw_only(), "voxel_size"_a, "workspace"_a,
           "T_world_grid"_a = py::none(), "prior_sigma"_a = py::none(),
           "support_plane"_a = py::none(), "boxes"_a = py::none(), "meshes"_a = py::tuple(),
           "gain"_a = gain_model_name(map_defaults.gain.model),
           "criterion"_a = criterion_name(map_defaults.gain.criterion),
           "object_size"_a = py::none(), "reach"_a = py::none(), "body_size"_a = py::none(),
           "clearance"_a = map_defaults.clearance, "jump_edges"_a = true,
           "check_feasibility"_a = true, "max_views"_a = defaults.max_views,
           "idle_views"_a = defaults.idle_views, "broken_promises"_a = defaults.broken_promises,
           "plan"_a = defaults.ahead.plan, "take"_a = defaults.ahead.take,
           "stop_gain"_a = py::none(), "stop_area"_a = py::none(), "coarsest"_a = 0,
           "fine"_a = py::none(), "finest"_a = 0, "state"_a = py::none(), "tracer"_a = "automatic",
           "num_threads"_a = 0)
      .def_static(
          "load",
          [](const py::object& path, const py::args& args, const py::kwargs& settings) {
            return py::type::of<Planner>()(*args, **settings, "state"_a = path);
          },
          "path"_a, kLoadDoc)
      .def(
          "save",
          [](Planner& self, const py::object& path) {
            const std::string file = writable_file(path);
            self.run([&](ViewPlanner& planner) { planner.save(file); });
          },
          "path"_a, kSaveDoc)
      .def(
          "add_poses",
          [](Planner& self, const py::object& T_world_camera, const std::string& name) {
            PoseSet set{name, pose_list(T_world_camera, "T_world_camera")};
            warn(suspicion_on_map(self, set.poses));
            self.use([&](ViewPlanner& planner) { planner.add_poses(std::move(set)); });
          },
          "T_world_camera"_a, "name"_a = "poses", kAddPosesDoc)
      .def(
          "add_generator",
          [](Planner& self, const py::object& generator, const std::string& name) {
            if (PyCallable_Check(generator.ptr()) == 0) {
              throw py::type_error("generator must be callable");
            }
            self.use([&](ViewPlanner& planner) {
              planner.add_generation(
                  std::make_shared<PythonGeneration>(generator, name, planner.scorer()));
            });
          },
          "generator"_a, "name"_a = "generator", kAddGeneratorDoc)
      .def("add", &add, "depth"_a, "T_world_camera"_a, py::kw_only(),
           "pose_sigma"_a = std::array<double, 2>{0, 0}, "amplitude"_a = py::none(), kAddDoc)
      .def("add_frame", &add_frame, "frames"_a, "index"_a, kAddFrameDoc)
      .def("drop", &drop, "verdict"_a, "T_world_camera"_a = py::none(), kDropDoc)
      .def_property_readonly(
          "frames",
          [](Planner& self) {
            return self.use([](ViewPlanner& planner) {
              std::map<std::string, std::size_t> counts;
              for (const auto& [verdict, count] : planner.frames()) {
                counts[std::string(frame_verdict_name(verdict))] = count;
              }
              return counts;
            });
          },
          "dict: number of frames so far by verdict; verdicts without frames are missing")
      .def(
          "consistency",
          [](Planner& self) {
            return to_python(
                self.run([](ViewPlanner& planner) { return planner.scorer().consistency(); }));
          },
          kConsistencyDoc)
      .def("register_frame", &register_frame, "depth"_a, "T_world_camera"_a, py::kw_only(),
           "sigma_translation"_a = kUsualPoseSigma.translation,
           "sigma_rotation"_a = kUsualPoseSigma.rotation, "amplitude"_a = py::none(),
           kRegisterFrameDoc)
      .def("propose", &propose, kProposeDoc)
      .def("rank", &rank, "k"_a = 1, py::kw_only(), "poses"_a = py::none(), "costs"_a = py::none(),
           "cost_per_metre"_a = 0.0, "current_pose"_a = py::none(), "together"_a = false,
           "exact"_a = false, "measure"_a = py::none(), "control"_a = py::none(), kRankDoc)
      .def(
          "outcomes",
          [](Planner& self, const py::object& T_world_camera) {
            const Pose pose = one_pose(T_world_camera, "T_world_camera");
            return named_outcomes(self.run([&](ViewPlanner& planner) {
              return planner.scorer().evaluator()->outcomes(pose);
            }));
          },
          "T_world_camera"_a,
          R"(Where the rays of a pose end on the current map, to explain its gain.

Cost: two traces of the pose.

Parameters
----------
T_world_camera : array_like, (4, 4)

Returns
-------
RayOutcomes)")
      .def(
          "tried",
          [](Planner& self, const py::object& T_world_camera, bool reached) {
            const Pose pose = one_pose(T_world_camera, "T_world_camera");
            self.use([&](ViewPlanner& planner) { planner.tried(pose, reached); });
          },
          "T_world_camera"_a, "reached"_a, kTriedDoc)
      .def(
          "should_stop",
          [](Planner& self) -> py::object {
            return self.use([](ViewPlanner& planner) -> py::object {
              const auto reason = planner.should_stop();
              return reason ? py::object(py::str(std::string(stop_reason_name(*reason))))
                            : py::object(py::none());
            });
          },
          kShouldStopDoc)
      .def_property_readonly(
          "grid",
          [](Planner& self) {
            return self.run([](ViewPlanner& planner) {
              return std::make_shared<SharedGrid>(planner.scorer().grid().clone());
            });
          },
          "BeliefGrid: a copy of the map; changes to it do not affect the planner")
      .def_property_readonly(
          "seconds",
          [](Planner& self) {
            return self.use([](ViewPlanner& planner) { return planner.seconds(); });
          },
          "dict: seconds per step since the last add, including it: integrate, snapshot, "
          "candidates, score")
      .def("__repr__", [](const Planner& self) { return self.text(); });
}

}  // namespace viewgain::python
