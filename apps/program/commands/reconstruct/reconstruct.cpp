// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "program/cli/flags/scene_sources.hpp"
#include "program/cli/flags/set_up_warnings.hpp"
#include "program/cli/interrupt.hpp"
#include "program/cli/progress.hpp"
#include "program/cli/values.hpp"
#include "program/commands/commands.hpp"
#include "program/commands/reconstruct/checkpoint.hpp"
#include "program/commands/reconstruct/run.hpp"
#include "program/commands/reconstruct/run_outputs.hpp"
#include "show/pictures/view_picture.hpp"
#include "show/report/page.hpp"
#include "show/report/run_page.hpp"
#include "viewgain/core/pose_io.hpp"
#include "viewgain/formats/map_file.hpp"
#include "viewgain/formats/staged_folder.hpp"
#include "viewgain/grid/vdb_io.hpp"
#include "viewgain/planner_mesh/surface_model.hpp"
#include "viewgain/support/atomic_file.hpp"
#include "viewgain/support/json.hpp"
#include "viewgain/support/stopwatch.hpp"

namespace viewgain::app {
namespace {

// Evaluator of the policy's gain, else of the paper's.
GainEvaluator step_evaluator(const SurfaceModel& model, const RunSetup& setup,
                             const ExecConfig& exec) {
  GainConfig gain;
  gain.criterion = setup.policy.criterion;
  const bool by_model = setup.policy.policy == Policy::gain && setup.policy.registered.empty();
  gain.model = by_model ? setup.policy.model : GainModel::paper;
  return {model.scene(), setup.sensor, gain, exec};
}

void add_to(StageSeconds& totals, const StageSeconds& seconds) {
  for (const auto& [stage, value] : seconds) totals[stage] += value;
}

// Writes the final results of a run. Returns the contents of run.json.
Json write_results(const RunFolder& folder, const RunSetup& setup, std::uint64_t seed,
                   const SurfaceModel& model, const std::vector<Pose>& views, const Json& report) {
  save_vdb(model.grid(), folder.file("map.vdb"));
  write_surfaces(model, folder.file("surface.ply"), folder.file("points.ply"));
  write_tum(folder.file("views.txt"), views);
  Json run = run_head(setup.settings);
  run["seed"] = seed;
  run["map_hash"] = model.grid().content_hash();
  run.update(report);
  write_file_atomically(folder.file("run.json"), json_text(run));
  return run;
}

// Writes the candidates for the next view; no file if there are none.
void write_candidates(const std::filesystem::path& path, const std::vector<Candidate>& candidates) {
  std::vector<Pose> poses;
  for (const Candidate& candidate : candidates) poses.push_back(candidate.T_world_camera);
  if (!poses.empty()) write_tum(path, poses);
}

std::string run_title(const ReconstructOptions& options, const RunSetup& setup) {
  return std::filesystem::path(options.mesh).filename().string() + ", " + setup.sensor.name;
}

void warn_of_workspace(const Stage& stage) {
  const Box object = bounds_of(stage.scene->mesh());
  double share = 1;  // relative to the object's box
  for (std::size_t a = 0; a < 3; ++a) {
    const double side = object.max[a] - object.min[a];
    const double inside = std::min(object.max[a], stage.workspace.max[a]) -
                          std::max(object.min[a], stage.workspace.min[a]);
    if (side > 0) share *= std::max(0.0, inside / side);
  }
  if (share >= 0.5) return;
  std::fprintf(
      stderr,
      "viewgain: warning: the workspace contains only %.0f %% of the object, whose bounding box is "
      "%s m (--workspace)\n",
      100 * share, describe(object).c_str());
}

void warn_of_set_up(const ReconstructOptions& options, const RunSetup& setup) {
  const bool has_noise = setup.noise.pose != PoseSigma{};
  app::warn_of_set_up(
      {.sensor = setup.sensor,
       .map = BeliefGrid(setup.model.map.grid(), setup.sensor),
       .obstacle_values = &options.obstacles,
       .obstacles = &setup.model.map.obstacles,
       .support_plane = options.sensing.support_plane,
       .reach_file = options.reach,
       .reach = &setup.reach,
       .object_size = object_size_of(options.hazard),
       .pose_sigma = has_noise ? setup.noise.pose : stated_sigma(options.registration)});
}

void reconstruct(const ReconstructOptions& options, const App& app) {
  const RunOutputs& outputs = options.outputs;
  if (outputs.with_report()) check_report_page("--report");
  const Json beside = beside_json(outputs);
  StageSeconds seconds;
  const ExecConfig exec = exec_of(options.common);
  RunSetup setup = set_up(options, exec);
  warn_of_workspace(setup.stage);
  warn_of_set_up(options, setup);
  const InterruptGuard interrupt;
  setup.planning.stop = interrupt.token();
  const Stopwatch watch_of_set_up;
  RunParts parts(setup, options.frames_per_view, exec);
  seconds["quality"] = watch_of_set_up.seconds();
  const SurfaceModel& model = parts.model;

  RunFolder folder(outputs.out, outputs.resume);
  Checkpoint checkpoint(folder, checkpoint_head(setup.settings, app), outputs.resume);
  const PolicyConfig& policy = setup.policy;
  const bool remembers = policy.ahead.is_on() || policy.policy == Policy::kriegel;
  ResumedDecision decision(checkpoint, parts.decision, remembers);
  RunReport report(policy, setup.visibility.tolerance);
  RunPage page(run_title(options, setup), setup.sensor,
               std::string(criterion_name(policy.criterion)), parts.truth);
  std::vector<Pose> views;
  Progress progress("view", options.common.quiet);
  const auto watch = [&](const ViewRecord& record) {
    views.push_back(record.T_world_camera);
    add_to(seconds, record.seconds);
    if (outputs.saves_maps()) {
      save_vdb(model.grid(), folder.map(record.index));
      write_candidates(folder.map(record.index, ".txt"), record.proposal.candidates);
    }
    if (outputs.draws()) {
      const GainEvaluator evaluator = step_evaluator(model, setup, exec);
      add_to(seconds, show_step(outputs, folder, page,
                                {record, model, parts.generation, evaluator, setup.sensor}, exec));
    }
    const DepthFrame& frame = parts.camera.last_frame();
    if (outputs.with_pictures() && !frame.amplitude.empty()) {
      write_amplitude_picture(folder.view(record.index, ".amplitude.png"), frame);
    }
    checkpoint.add_view(record, model.grid().content_hash());
    report.add_view(record, model.quality().back(), seconds);
    progress.wipe();
    if (!options.common.quiet) std::fprintf(stderr, "%s\n", report.progress_line().c_str());
    progress.update(views.size(), options.max_views);
  };
  const PlanningResult result =
      active_view_planning(setup.start, parts.acquisition, parts.representation(), parts.decision,
                           decision, setup.planning, watch);

  progress.wipe();
  const std::vector<FrameRegistration> registrations = parts.registrations();
  for (std::size_t i = 0; i < registrations.size(); ++i) views[i] = registrations[i].T_world_camera;
  report.set_registrations(registrations);
  const Json json = report.json(result.reason);
  const Json run = write_results(folder, setup, options.sensing.seed, model, views, json);
  if (outputs.with_report()) {
    write_report(folder.file("report.html"), page.json(run, setup.stage.scene.get(), beside));
  }
  commit(folder, run, app);
  if (options.common.json) {
    print_json(json);
  } else {
    std::printf("%s%s", report.text(result.reason).c_str(),
                beside_text(beside, run["settings"]).c_str());
    if (setup.visibility.tolerance < options.voxel) {
      std::printf(
          "coverage is measured at %g mm, less than a voxel, so correct surface may count as "
          "missed; increase --tolerance\n",
          1e3 * setup.visibility.tolerance);
    }
    const Eigen::Vector3d& center = setup.stage.center;
    std::printf("the object's box, %.3g m long, is centred at %.3g, %.3g, %.3g m\n",
                setup.stage.size, center.x(), center.y(), center.z());
    print_left(outputs, "run.json, config.toml, views.txt, map.vdb, surface.ply, points.ply");
  }
}

}  // namespace

Command add_reconstruct(App& program) {
  auto options = std::make_shared<ReconstructOptions>();
  App* app = program.add_subcommand(
      "reconstruct",
      "Run the whole loop on a mesh with a simulated camera: take a view, update map and surface, "
      "choose the next view. The run ends when little is left to gain.");
  add_options(*app, *options);
  return command_of(app, options, [app](const auto& given) { reconstruct(given, *app); });
}

}  // namespace viewgain::app
