// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include <pybind11/stl.h>

#include <array>
#include <cstdint>
#include <memory>
#include <mutex>
#include <optional>
#include <shared_mutex>
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
#include "pose_arrays.hpp"
#include "scorer_docs.hpp"
#include "suspicions.hpp"
#include "viewgain/formats/map_file.hpp"
#include "viewgain/raycast/view_scorer.hpp"

namespace viewgain::python {
namespace {

/// Python's ViewScorer. Many threads may read its map, or one may change it; gains need no lock.
class Scorer {
 public:
  Scorer(ViewScorer scorer, py::dict settings)
      : scorer_(std::move(scorer)), settings_(std::move(settings)) {}

  [[nodiscard]] const ViewScorer& get() const noexcept { return scorer_; }
  /// The keywords of its constructor, without those of the map.
  [[nodiscard]] const py::dict& settings() const noexcept { return settings_; }

  /// Calls f without the GIL; f must not touch Python.
  template <typename F>
  auto read(const F& f) const {
    const WithoutGil without_gil;  // before the lock, to avoid a deadlock
    const std::shared_lock lock(mutex_);
    return f(scorer_);
  }
  template <typename F>
  auto write(const F& f) {
    const WithoutGil without_gil;
    const std::unique_lock lock(mutex_);
    return f(scorer_);
  }

 private:
  ViewScorer scorer_;
  py::dict settings_;
  mutable std::shared_mutex mutex_;
};

std::unique_ptr<Scorer> make_scorer(
    const Given<Sensor>& of, std::optional<double> voxel_size, const py::object& workspace,
    const py::object& T_world_grid, std::optional<double> prior_sigma,
    std::optional<double> support_plane, const py::object& boxes, const py::iterable& given_meshes,
    const std::string& gain, const std::string& criterion, int pixel_stride,
    const py::iterable& given_weights, std::optional<double> refinement_weight,
    std::optional<double> object_size, const py::object& body_size, double clearance,
    bool jump_edges, int coarsest, const py::object& fine, int finest, const py::object& map,
    const std::string& tracer, int num_threads) {
  const py::tuple meshes(given_meshes), weights(given_weights);  // iterators can be read only once
  Sensor sensor = *of;
  ScorerConfig config;
  config.voxel_size = voxel_size.value_or(config.voxel_size);
  if (!map.is_none() && (voxel_size || !workspace.is_none() || !T_world_grid.is_none())) {
    throw py::value_error(
        "voxel_size, workspace and T_world_grid cannot be used with map, because the map defines "
        "them");
  }
  if (!workspace.is_none()) config.workspace = box(workspace, "workspace");
  config.T_world_grid = optional_pose(T_world_grid, "T_world_grid").value_or(Pose());
  config.prior_sigma = prior_sigma;
  config.support_plane = support_plane;
  config.obstacles = obstacles_of(boxes, meshes);
  if (!jump_edges) config.jump_edges.reset();
  config.coarsest = coarsest;
  config.fine = optional_boxes(fine, "fine");
  config.finest = finest;
  config.hazard.object_size = object_size;
  config.gain =
      gain_config(gain, criterion, pixel_stride, {}, {}, {}, weights, refinement_weight, false);
  config.clearance = clearance;
  if (!body_size.is_none()) {
    const Eigen::Vector3d size = vector3(body_size, "body_size");
    sensor.body_size = {size.x(), size.y(), size.z()};
  }
  const ExecConfig exec{num_threads, parse_tracer(tracer)};
  const SharedGrid* grid =
      py::isinstance<SharedGrid>(map) ? &map.cast<const SharedGrid&>() : nullptr;
  const std::string file = map.is_none() || grid != nullptr ? "" : readable_file(map);
  if (prior_sigma && !map.is_none() && (grid != nullptr || !is_octomap(file))) {
    throw py::value_error("prior_sigma cannot be used with map, because the map defines it");
  }
  std::optional<BeliefGrid> copy;
  if (grid != nullptr) copy = grid->read([](const BeliefGrid& g) { return g.clone(); });
  ViewScorer scorer = outside_gil([&] {
    if (copy) return ViewScorer(std::move(*copy), sensor, config, exec);
    if (file.empty()) return ViewScorer(sensor, config, exec);
    return ViewScorer(load_map(file, &sensor, {.prior_sigma = prior_sigma}, exec), sensor, config,
                      exec);
  });
  warn(suspicions_of_set_up(scorer, {}));
  // Copies, so that later changes of the caller's arrays have no effect.
  const py::object settings = py::module_::import("copy").attr("deepcopy")(
      py::dict("sensor"_a = py::cast(*of), "support_plane"_a = support_plane, "boxes"_a = boxes,
               "meshes"_a = meshes, "gain"_a = gain, "criterion"_a = criterion,
               "pixel_stride"_a = pixel_stride, "weights"_a = weights,
               "refinement_weight"_a = refinement_weight, "object_size"_a = object_size,
               "body_size"_a = body_size, "clearance"_a = clearance, "jump_edges"_a = jump_edges,
               "coarsest"_a = coarsest, "fine"_a = fine, "finest"_a = finest, "tracer"_a = tracer,
               "num_threads"_a = num_threads));
  return std::make_unique<Scorer>(std::move(scorer), settings);
}

py::object to_python(const MapUpdate& update) {
  const IntegrationReport& counts = update.counts;
  return named("MapUpdate", counts.readings, counts.plane_readings, counts.out_of_range,
               counts.invalid, counts.readings_inside, counts.voxels_hit, counts.voxels_crossed,
               update.flying_pixels, update.new_area,
               std::string(frame_verdict_name(update.verdict)));
}

py::object add_to_scorer(Scorer& self, const py::object& depth, const py::object& T_world_camera,
                         const std::array<double, 2>& pose_sigma, const py::object& amplitude) {
  const Sensor& sensor = self.get().sensor();
  const DepthFrame frame = depth_frame(sensor, depth, amplitude);
  const Pose pose = one_pose(T_world_camera, "T_world_camera");
  MapUpdate update;
  const Suspicion suspicion = self.write([&](ViewScorer& scorer) {
    update = scorer.add(frame, pose, {pose_sigma[0], pose_sigma[1]});
    return suspicion_of_frame(sensor, frame, pose, scorer.grid(), update.counts);
  });
  warn(suspicion);
  return to_python(update);
}

std::uint64_t set_labels(Scorer& self, const std::array<std::int32_t, 3>& first,
                         const py::object& labels) {
  const py::array given = any_labels(labels);
  require_states(given);
  const auto states = Labels::ensure(given);
  const Index3 dims{static_cast<std::int32_t>(states.shape(0)),
                    static_cast<std::int32_t>(states.shape(1)),
                    static_cast<std::int32_t>(states.shape(2))};
  const VoxelBox region = VoxelBox::from_dims({first[0], first[1], first[2]}, dims);
  const std::span<const std::uint8_t> span(states.data(), static_cast<std::size_t>(states.size()));
  return self.write([&](ViewScorer& scorer) { return scorer.set(region, span); });
}

py::object evaluator_of(const Scorer& self) {
  const ViewScorer& scorer = self.get();
  Scene scene{scorer.scene()};
  GainEvaluator evaluator = scorer.evaluator()->with_scene(scene.scene);
  const GainConfig& gain = scorer.config().gain;
  return py::cast(std::unique_ptr<Evaluator>(new Evaluator{
      py::cast(std::move(scene)), scorer.sensor(), std::string(criterion_name(gain.criterion)),
      gain.pixel_stride, std::move(evaluator)}));
}

py::object best_of(const Scorer& self, const py::object& T_world_camera, std::size_t k,
                   const py::object& costs, std::optional<double> deadline,
                   const GivenOrNone<Control>& control) {
  const PoseBatch batch = pose_batch(T_world_camera, "T_world_camera", false);
  const ViewScorer& scorer = self.get();
  warn(outside_gil(
      [&] { return suspicion_of_poses(scorer.scene(), scorer.sensor(), batch.poses); }));
  const std::vector<double> own_costs = costs_or_none(costs);
  const BestConfig config{.costs = own_costs, .deadline = deadline.value_or(BestConfig{}.deadline)};
  BestViews result;
  run_batch(control, [&](const BatchControl& watched) {
    result = scorer.best(batch.poses, k, config, watched);
  });
  return named_views(result);
}

}  // namespace

void bind_scorer(py::module_& module) {
  const ScorerConfig defaults;
  auto type = bound_class<Scorer>(module, "ViewScorer", kScorerDoc);
  type.def("__reduce_ex__", [](const py::object& self, int) {
    py::dict keywords = self.cast<const Scorer&>().settings().attr("copy")();
    keywords["map"] = self.attr("grid");
    const py::object partial = py::module_::import("functools").attr("partial");
    return py::make_tuple(partial(py::type::of(self), **keywords), py::tuple());
  });
  type.def(py::init(&make_scorer), "sensor"_a, py::kw_only(), "voxel_size"_a = py::none(),
           "workspace"_a = py::none(), "T_world_grid"_a = py::none(), "prior_sigma"_a = py::none(),
           "support_plane"_a = py::none(), "boxes"_a = py::none(), "meshes"_a = py::tuple(),
           "gain"_a = gain_model_name(defaults.gain.model),
           "criterion"_a = criterion_name(defaults.gain.criterion),
           "pixel_stride"_a = defaults.gain.pixel_stride, "weights"_a = py::tuple(),
           "refinement_weight"_a = py::none(), "object_size"_a = py::none(),
           "body_size"_a = py::none(), "clearance"_a = defaults.clearance, "jump_edges"_a = true,
           "coarsest"_a = defaults.coarsest, "fine"_a = py::none(), "finest"_a = defaults.finest,
           "map"_a = py::none(), "tracer"_a = "automatic", "num_threads"_a = 0)
      .def("add", &add_to_scorer, "depth"_a, "T_world_camera"_a, py::kw_only(),
           "pose_sigma"_a = std::array<double, 2>{0, 0}, "amplitude"_a = py::none(), kScorerAddDoc)
      .def("set", &set_labels, "first"_a, "labels"_a, kScorerSetDoc)
      .def(
          "forget",
          [](Scorer& self, const py::object& region) {
            const Box forgotten = box(region, "region");
            return self.write([&](ViewScorer& scorer) { return scorer.forget(forgotten); });
          },
          "region"_a, kScorerForgetDoc)
      .def(
          "evaluate",
          [](const Scorer& self, const py::object& T_world_camera, const py::object& measure,
             bool strict, const py::object& control) {
            const py::object evaluator = evaluator_of(self);
            return measure.is_none()
                       ? evaluator.attr("evaluate")(T_world_camera, "strict"_a = strict,
                                                    "control"_a = control)
                       : evaluator.attr("evaluate_own")(T_world_camera, measure,
                                                        "control"_a = control);
          },
          "T_world_camera"_a, py::kw_only(), "measure"_a = py::none(), "strict"_a = false,
          "control"_a = py::none(), kScorerEvaluateDoc)
      .def("best", &best_of, "T_world_camera"_a, "k"_a = 1, py::kw_only(), "costs"_a = py::none(),
           "deadline"_a = py::none(), "control"_a = py::none(), kScorerBestDoc)
      .def(
          "consistency",
          [](const Scorer& self) {
            return to_python(
                self.read([](const ViewScorer& scorer) { return scorer.consistency(); }));
          },
          kScorerConsistencyDoc)
      .def_static(
          "load",
          [](const py::object& path, const py::args& args, const py::kwargs& settings) {
            return py::type::of<Scorer>()(*args, **settings, "map"_a = path);
          },
          "path"_a, kScorerLoadDoc)
      .def(
          "save",
          [](const Scorer& self, const py::object& path) {
            const std::string file = writable_file(path);
            self.read([&](const ViewScorer& scorer) { scorer.save(file); });
          },
          "path"_a, kScorerSaveDoc)
      .def_property_readonly(
          "scene", [](const Scorer& self) { return Scene{self.get().scene()}; },
          "VoxelScene: the current scene; later changes of the map do not affect it")
      .def_property_readonly("evaluator", &evaluator_of,
                             "GainEvaluator: evaluator of the current scene; later changes of the "
                             "map do not affect it")
      .def_property_readonly(
          "grid",
          [](const Scorer& self) {
            return self.read([](const ViewScorer& scorer) {
              return std::make_shared<SharedGrid>(scorer.grid().clone());
            });
          },
          "BeliefGrid: a copy of the map")
      .def("__repr__",
           [](const Scorer& self) { return "<ViewScorer of " + self.get().sensor().name + ">"; });
}

}  // namespace viewgain::python
