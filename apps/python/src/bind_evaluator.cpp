// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include <pybind11/stl.h>

#include <algorithm>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include "arrays.hpp"
#include "batch_call.hpp"
#include "classes.hpp"
#include "evaluator.hpp"
#include "evaluator_docs.hpp"
#include "gil.hpp"
#include "given.hpp"
#include "pose_arrays.hpp"
#include "suspicions.hpp"
#include "viewgain/raycast/view_tour.hpp"

namespace viewgain::python {

namespace {

// So few poses finish before Ctrl-C could matter, and a thread would cost more than they do.
constexpr std::size_t kFewPoses = 8;

py::array_t<std::int64_t> index_array(const std::vector<std::size_t>& indices) {
  py::array_t<std::int64_t> array(static_cast<py::ssize_t>(indices.size()));
  std::transform(indices.begin(), indices.end(), array.mutable_data(),
                 [](std::size_t i) { return static_cast<std::int64_t>(i); });
  return array;
}

std::unique_ptr<Evaluator> held(const Scene& scene, const Sensor& sensor,
                                const std::string& criterion, int pixel_stride,
                                GainEvaluator evaluator) {
  return std::unique_ptr<Evaluator>(
      new Evaluator{py::cast(scene, py::return_value_policy::reference), sensor, criterion,
                    pixel_stride, std::move(evaluator)});
}

}  // namespace

py::object named_views(const BestViews& best) {
  return named("BestViews", index_array(best.indices), to_array_1d<ViewGain>(best.gains),
               to_array_1d<double>(best.worth), best.complete, best.estimated,
               index_array(best.scored_indices), to_array_1d<ViewGain>(best.scored_gains));
}

GainConfig gain_config(const std::string& gain, const std::string& criterion, int pixel_stride,
                       std::optional<double> prior_sigma, std::optional<double> min_range,
                       std::optional<double> max_range, const py::iterable& weights,
                       std::optional<double> refinement_weight, bool posterior_entropy) {
  GainConfig config;
  config.model = parse_gain_model(gain);
  if (config.model != GainModel::combined && refinement_weight) {
    throw py::value_error("refinement_weight requires gain \"combined\"");
  }
  config.refinement_weight = refinement_weight.value_or(config.refinement_weight);
  config.posterior_entropy = posterior_entropy;
  config.criterion = parse_criterion(criterion);
  config.pixel_stride = pixel_stride;
  config.prior_sigma = prior_sigma;
  config.min_range = min_range;
  config.max_range = max_range;
  for (const py::handle entry : weights) {
    if (!py::isinstance<py::sequence>(entry) || py::len(entry) != 2) {
      throw py::value_error("each entry of weights must be a pair (box, weight)");
    }
    const auto pair = py::reinterpret_borrow<py::sequence>(entry);
    const py::object region = pair[0], weight = pair[1];
    config.weights.push_back({box(region, "weights' box"), number(weight, "weights' weight")});
  }
  return config;
}

namespace {

std::unique_ptr<Evaluator> make_evaluator(
    const Given<Scene>& given, const Given<Sensor>& of, const std::string& gain,
    const std::string& criterion, int pixel_stride, std::optional<double> prior_sigma,
    std::optional<double> min_range, std::optional<double> max_range, const py::iterable& weights,
    std::optional<double> refinement_weight, bool posterior_entropy, const std::string& tracer,
    int num_threads) {
  const Scene& scene = *given;
  const Sensor& sensor = *of;
  const GainConfig config = gain_config(gain, criterion, pixel_stride, prior_sigma, min_range,
                                        max_range, weights, refinement_weight, posterior_entropy);
  const ExecConfig exec{num_threads, parse_tracer(tracer)};
  warn(suspect_sensor(sensor, scene.scene->snapshot().voxel_size));
  return held(scene, sensor, criterion, pixel_stride,
              outside_gil([&] { return GainEvaluator(scene.scene, sensor, config, exec); }));
}

std::unique_ptr<Evaluator> with_scene(const Evaluator& self, const Given<Scene>& given) {
  const Scene& scene = *given;
  return held(scene, self.sensor, self.criterion, self.pixel_stride,
              outside_gil([&] { return self.evaluator.with_scene(scene.scene); }));
}

// Converts the poses, and warns if they do not look at the map.
PoseBatch batch_of(const Evaluator& self, const py::object& T_world_camera, bool strict = false) {
  PoseBatch batch = pose_batch(T_world_camera, "T_world_camera", strict);
  const auto& scene = self.scene.cast<const Scene&>().scene;
  warn(outside_gil([&] { return suspicion_of_poses(scene, self.sensor, batch.poses); }));
  return batch;
}

void score(const Evaluator& self, std::span<const Pose> poses, std::span<ViewGain> results,
           Control* control) {
  if (poses.size() > kFewPoses || control != nullptr) {
    run_batch(control,
              [&](const BatchControl& batch) { self.evaluator.evaluate(poses, results, batch); });
    return;
  }
  const WithoutGil without_gil;
  self.evaluator.evaluate(poses, results);
}

py::object evaluate(const Evaluator& self, const py::object& T_world_camera, bool strict,
                    const GivenOrNone<Control>& control) {
  const PoseBatch batch = batch_of(self, T_world_camera, strict);
  py::array_t<double> gains(batch.shape);
  std::vector<ViewGain> results(batch.poses.size());
  score(self, batch.poses, results, control);
  std::transform(results.begin(), results.end(), gains.mutable_data(),
                 [](const ViewGain& view) { return view.gain; });
  return scalar_or_array(gains);
}

py::object evaluate_detailed(const Evaluator& self, const py::object& T_world_camera, bool strict,
                             const GivenOrNone<Control>& control) {
  const PoseBatch batch = batch_of(self, T_world_camera, strict);
  py::array_t<ViewGain> views(batch.shape);
  score(self, batch.poses, {views.mutable_data(), batch.poses.size()}, control);
  return scalar_or_array(views);
}

// Costs and custom gain for best() and race().
struct Worth {
  std::vector<double> costs;
  std::optional<PythonMeasure> measure;

  Worth(const py::object& given_costs, const py::object& given_measure)
      : costs(costs_or_none(given_costs)), measure(measure_or_none(given_measure)) {}
  void into(BestConfig& config) const {
    config.costs = costs;
    if (measure) config.measure = &*measure;
  }
};

py::object best(const Evaluator& self, const py::object& T_world_camera, std::size_t k,
                const py::object& costs, const py::object& measure,
                const GivenOrNone<Control>& control) {
  const PoseBatch batch = batch_of(self, T_world_camera);
  const Worth worth(costs, measure);
  BestConfig config;
  worth.into(config);
  BestViews result;
  run_batch(control, [&](const BatchControl& watched) {
    result = self.evaluator.best(batch.poses, k, config, watched);
  });
  return named_views(result);
}

py::object race(const Evaluator& self, const py::object& T_world_camera, std::size_t k,
                const py::object& costs, const py::object& measure, std::optional<double> deadline,
                std::uint64_t seed, const GivenOrNone<Control>& control) {
  const PoseBatch batch = batch_of(self, T_world_camera);
  const Worth worth(costs, measure);
  BestConfig config{.deadline = deadline.value_or(BestConfig{}.deadline), .seed = seed};
  worth.into(config);
  BestViews result;
  run_batch(control, [&](const BatchControl& watched) {
    result = self.evaluator.race(batch.poses, k, config, watched);
  });
  return named_views(result);
}

py::object best_set(const Evaluator& self, const py::object& T_world_camera, std::size_t k,
                    const GivenOrNone<Control>& control) {
  const PoseBatch batch = batch_of(self, T_world_camera);
  ViewSet set;
  run_batch(control, [&](const BatchControl& watched) {
    set = self.evaluator.best_set(batch.poses, k, watched);
  });
  return named("ViewSet", index_array(set.indices), to_array_1d<ViewGain>(set.marginal), set.gain,
               set.complete);
}

// Path costs from a table, or from a Python function for which the start is -1; empty for None.
WayCost way_of(const py::object& way, std::size_t poses) {
  if (way.is_none()) return {};
  if (PyCallable_Check(way.ptr()) == 0) {
    std::size_t count = 0;
    WayCost table = way_table(way, "way", count);
    if (count == poses) return table;
    throw py::value_error("way must have one stop per pose; poses: " + std::to_string(poses) +
                          ", stops: " + std::to_string(count));
  }
  const auto number = [](std::size_t stop) {
    return stop == kTourStart ? std::int64_t{-1} : static_cast<std::int64_t>(stop);
  };
  return [call = PythonCall(way), number](std::size_t from, std::size_t to) {
    return with_gil([&] { return call(number(from), number(to)).cast<double>(); });
  };
}

py::object tour(const Evaluator& self, const py::object& T_world_camera, const py::object& way,
                std::optional<std::size_t> max_stops, std::optional<std::size_t> first,
                double cost_per_way, std::optional<double> budget, bool per_way,
                const py::object& costs, double least_area, const GivenOrNone<Control>& control) {
  const PoseBatch batch = batch_of(self, T_world_camera);
  const std::vector<double> own_costs = costs_or_none(costs);
  const TourConfig config{.max_stops = max_stops.value_or(batch.poses.size()),
                          .first = first,
                          .way = way_of(way, batch.poses.size()),
                          .cost_per_way = cost_per_way,
                          .budget = budget.value_or(TourConfig{}.budget),
                          .per_way = per_way,
                          .costs = own_costs,
                          .least_area = least_area};
  ViewTour made;
  run_batch(control, [&](const BatchControl& watched) {
    made = plan_tour(self.evaluator, batch.poses, config, watched);
  });
  std::vector<std::size_t> indices;
  std::vector<ViewGain> gains;
  std::vector<double> worth;
  for (const std::size_t place : made.tour.stops) {
    indices.push_back(made.set.indices[place]);
    gains.push_back(made.set.marginal[place]);
    worth.push_back(made.worth[place]);
  }
  return named("ViewTour", index_array(indices), to_array_1d<ViewGain>(gains),
               to_array_1d<double>(worth), made.tour.cost);
}

py::object approximate(const Evaluator& self, const py::object& T_world_camera, double share,
                       std::uint64_t seed, const GivenOrNone<Control>& control) {
  const PoseBatch batch = batch_of(self, T_world_camera);
  const ApproximateConfig config{share, seed};
  py::array_t<ApproximateGain> estimates(batch.shape);
  const std::span<ApproximateGain> out(estimates.mutable_data(), batch.poses.size());
  run_batch(control, [&](const BatchControl& watched) {
    self.evaluator.approximate(batch.poses, out, config, watched);
  });
  return scalar_or_array(estimates);
}

void bind_rows() {
  PYBIND11_NUMPY_DTYPE(ViewGain, gain, exploration, refinement, posterior_entropy, rays, hits,
                       unknown_voxels, occupied_voxels, status, area, refinement_saturated);
  PYBIND11_NUMPY_DTYPE(ApproximateGain, gain, standard_error, rays);
}

}  // namespace

void bind_evaluator(py::module_& module) {
  bind_rows();
  module.def(
      "criterion_names", [] { return criterion_names(); },
      "The valid values of ``criterion``.\n\nReturns\n-------\nlist of str");
  module.def(
      "gain_model_names", [] { return gain_model_names(); },
      "The valid values of ``gain``.\n\nReturns\n-------\nlist of str");
  module.attr("DEFAULT_GAIN") = gain_model_name(kDefaultGain);
  py::list statuses;
  for (const ViewGain::Status status :
       {ViewGain::Status::ok, ViewGain::Status::bad_pose, ViewGain::Status::camera_in_occupied}) {
    statuses.append(std::string(view_status_name(status)));
  }
  module.attr("VIEW_STATUS_NAMES") = py::tuple(statuses);

  const BestConfig race_defaults;
  const ApproximateConfig approximate_defaults;
  auto evaluator = bound_class<Evaluator>(module, "GainEvaluator", kEvaluatorDoc);
  refuse_pickling(evaluator);
  evaluator
      .def(py::init(&make_evaluator), "scene"_a, "sensor"_a, py::kw_only(),
           "gain"_a = gain_model_name(kDefaultGain), "criterion"_a = "log_diagonal",
           "pixel_stride"_a = 1, "prior_sigma"_a = py::none(), "min_range"_a = py::none(),
           "max_range"_a = py::none(), "weights"_a = py::tuple(),
           "refinement_weight"_a = py::none(), "posterior_entropy"_a = false,
           "tracer"_a = "automatic", "num_threads"_a = 0)
      .def("with_scene", &with_scene, "scene"_a, kWithSceneDoc)
      .def("evaluate", &evaluate, "T_world_camera"_a, py::kw_only(), "strict"_a = false,
           "control"_a = py::none(), kEvaluateDoc)
      .def("evaluate_detailed", &evaluate_detailed, "T_world_camera"_a, py::kw_only(),
           "strict"_a = false, "control"_a = py::none(), kEvaluateDetailedDoc)
      .def("best", &best, "T_world_camera"_a, "k"_a = 1, py::kw_only(), "costs"_a = py::none(),
           "measure"_a = py::none(), "control"_a = py::none(), kBestDoc)
      .def("race", &race, "T_world_camera"_a, "k"_a = 1, py::kw_only(), "costs"_a = py::none(),
           "measure"_a = py::none(), "deadline"_a = py::none(), "seed"_a = race_defaults.seed,
           "control"_a = py::none(), kRaceDoc)
      .def("best_set", &best_set, "T_world_camera"_a, "k"_a, py::kw_only(),
           "control"_a = py::none(), kBestSetDoc)
      .def("plan_tour", &tour, "T_world_camera"_a, "way"_a = py::none(), py::kw_only(),
           "max_stops"_a = py::none(), "first"_a = py::none(), "cost_per_way"_a = 0.0,
           "budget"_a = py::none(), "per_way"_a = false, "costs"_a = py::none(),
           "least_area"_a = 0.0, "control"_a = py::none(), kPlanTourDoc)
      .def("approximate", &approximate, "T_world_camera"_a, py::kw_only(),
           "share"_a = approximate_defaults.share, "seed"_a = approximate_defaults.seed,
           "control"_a = py::none(), kApproximateDoc)
      .def_property_readonly(
          "rays_per_pose", [](const Evaluator& self) { return self.evaluator.rays_per_pose(); },
          "int: number of rays of a view")
      .def_property_readonly(
          "num_threads", [](const Evaluator& self) { return self.evaluator.num_threads(); },
          "int: number of threads of a batch")
      .def_property_readonly(
          "prior_sigma", [](const Evaluator& self) { return self.evaluator.prior_sigma(); },
          "float: standard deviation of the surface position in an unknown voxel [m]")
      .def_property_readonly(
          "gain",
          [](const Evaluator& self) {
            return std::string(gain_model_name(self.evaluator.model()));
          },
          "str")
      .def_readonly("criterion", &Evaluator::criterion, "str")
      .def_readonly("pixel_stride", &Evaluator::pixel_stride, "int")
      .def_readonly("scene", &Evaluator::scene, "VoxelScene: the scene of the evaluator")
      .def_readonly("sensor", &Evaluator::sensor, "Sensor")
      .def("__repr__", [](const Evaluator& self) {
        std::ostringstream text;
        text << "<GainEvaluator " << gain_model_name(self.evaluator.model()) << " gain, "
             << self.criterion << ", " << self.sensor.name << ", " << self.evaluator.rays_per_pose()
             << " rays per pose, " << self.evaluator.num_threads() << " threads>";
        return text.str();
      });
  bind_views(module, evaluator);
}

}  // namespace viewgain::python
