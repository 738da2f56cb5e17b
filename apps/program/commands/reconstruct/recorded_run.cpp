// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "program/commands/reconstruct/recorded_run.hpp"

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "program/cli/config_file.hpp"
#include "program/cli/flags/next_views.hpp"
#include "program/cli/flags/pose_sigmas.hpp"
#include "program/cli/interrupt.hpp"
#include "program/cli/json.hpp"
#include "program/cli/json_text.hpp"
#include "program/cli/progress.hpp"
#include "program/cli/values.hpp"
#include "program/commands/frames/aligned_frames.hpp"
#include "program/commands/frames/frame_map.hpp"
#include "program/commands/proposal/view_proposal.hpp"
#include "program/commands/reconstruct/recorded_views.hpp"
#include "program/commands/reconstruct/registration_json.hpp"
#include "program/commands/reconstruct/run_setup.hpp"
#include "show/pictures/view_picture.hpp"
#include "show/report/page.hpp"
#include "show/report/run_page.hpp"
#include "viewgain/core/error.hpp"
#include "viewgain/core/pose_io.hpp"
#include "viewgain/formats/map_file.hpp"
#include "viewgain/formats/run_folder.hpp"
#include "viewgain/formats/sensor_toml.hpp"
#include "viewgain/planner_mesh/surface_files.hpp"
#include "viewgain/support/atomic_file.hpp"
#include "viewgain/support/stopwatch.hpp"
#include "viewgain/version.hpp"

namespace viewgain::app {
namespace {

// Of a recording so many moments are drawn, evenly, the last among them: each is a surface anew.
constexpr std::size_t kMaxShown = 6;

// Flags that choose views, simulate or know the object.
constexpr std::array kFlagsOfMeshes{
    "--size",          "--up",          "--start",        "--policy",    "--semantics",
    "--criterion",     "--max-views",   "--stop-gain",    "--stop-area", "--stop-idle",
    "--stop-coverage", "--travel-cost", "--travel-speed", "--noise",     "--flying-pixels",
    "--background",    "--wiggling",    "--pose-noise",   "--calibrate", "--frames-per-view"};

FrameMapOptions frame_options(const ReconstructOptions& options) {
  FrameMapOptions frames;
  frames.folder = {options.mesh, options.sensor,     options.depth_scale,
                   options.mask, options.confidence, options.least_confidence};
  frames.voxel = options.voxel;
  frames.workspace = options.workspace;
  frames.jump_edge_filter = options.jump_edge_filter;
  frames.refine = options.refine == "on";
  return frames;
}

ProposalOptions proposal_options(const ReconstructOptions& options, const App& app) {
  ProposalOptions proposal;
  if (!options.generator.empty()) proposal.generator = options.generator;
  check_one_of("--generator", proposal.generator, generator_names(), "generator");
  proposal.count = options.count;
  proposal.distance = options.distance;
  proposal.reach = options.reach;
  proposal.body = options.body;
  proposal.support_plane = options.sensing.support_plane;
  proposal.obstacles = options.obstacles;
  if (app.count("--overlap") > 0) proposal.overlap = options.overlap;
  if (app.count("--region-depth") > 0) proposal.region_depth = options.region_depth;
  proposal.gain = options.gain.empty() ? "combined" : options.gain;
  check_one_of("--gain", proposal.gain, gain_model_names(), "gain");
  proposal.object_size = options.object_size;
  proposal.hazard = options.hazard;
  proposal.seed = options.sensing.seed;
  return proposal;
}

// At which frames the state of the map is drawn.
std::set<std::size_t> shown_frames(std::size_t count) {
  std::set<std::size_t> shown;
  const std::size_t most = std::min(count, kMaxShown);
  for (std::size_t k = 1; k <= most; ++k) shown.insert(k * count / most - 1);
  return shown;
}

// The surface and the next views of the map as it is now.
struct Moment {
  SurfaceModel model;
  CandidateGeneration generation;
  GainEvaluator evaluator;

  Moment(const FrameMap& map, const ProposalOptions& proposal, const ExecConfig& exec)
      : model(model_of(map.model().grid().clone(), map.model().sensor(), proposal, exec)),
        generation(
            model, map.model().sensor(),
            generation_config(proposal, map.model().sensor(), model.grid(), map.folder().name()),
            exec),
        evaluator(evaluator_of(proposal, model, map.model().sensor(), exec)) {}
};

class Recording {
 public:
  Recording(const ReconstructOptions& options, const App& app)
      : options_(options),
        proposal_(proposal_options(options, app)),
        exec_{options.common.threads} {
    check(proposal_);
    const FrameMapOptions frames = frame_options(options);
    map_.emplace(frames, proposal_, options.common.quiet, exec_);
    sigmas_ = registration_prior(options.registration);
    if (sigmas_) {
      const Stopwatch watch;
      views_.emplace(*map_, align_folder(*map_, *sigmas_, options.common.quiet, exec_));
      views_->add_seconds("register", watch.seconds());
    } else {
      views_.emplace(*map_);
    }
    page_.emplace(std::filesystem::path(options.mesh).filename().string() + ", " + sensor().name,
                  sensor(), options.criterion, nullptr);
  }

  // The frames, until all are in or `stop` is asked for.
  void add_frames(RunFolder& folder, const std::stop_token& stop) {
    const std::set<std::size_t> shown = shown_frames(map_->folder().size());
    Progress progress("frame", options_.common.quiet);
    for (std::size_t i = 0; i < map_->folder().size() && !stop.stop_requested(); ++i) {
      views_->add(i);
      if (options_.save_maps == "on") {
        save_vdb(map_->model().grid(), folder.map(i), noting_sensor(sensor()));
      }
      const bool last = i + 1 == map_->folder().size();
      if (draws() && shown.count(i) > 0 && !last) {
        Moment moment(*map_, proposal_, exec_);
        draw(folder, moment, views_->last(), {});
      }
      progress.update(i + 1, map_->folder().size());
    }
    map_->require_readings();
  }

  // Surface, next views, report; what run.json holds.
  Json finish(RunFolder& folder) {
    Stopwatch watch;
    Moment moment(*map_, proposal_, exec_);
    views_->add_seconds("surface", watch.seconds());
    ViewRecord& last = views_->last();
    watch = {};
    last.proposal = moment.generation.generate(last.T_world_camera);
    views_->add_seconds("candidates", watch.seconds());
    watch = {};
    next_ = best_views(moment.evaluator, last.proposal, options_.top);
    views_->add_seconds("score", watch.seconds());
    if (!next_.views.empty()) last.decision = Decision{next_.views.front().index};
    if (draws()) draw(folder, moment, last, moment.generation.estimated());

    save_vdb(moment.model.grid(), folder.file("map.vdb"),
             noting_sensor(map_->folder().sensor(), noting_frames(views_->identities())));
    write_surfaces(moment.model, folder.file("surface.ply"), folder.file("points.ply"));
    write_tum(folder.file("views.txt"), moment.model.grid().views());
    write_tum(folder.file("next.txt"), poses_of(next_));
    Json run{{"settings", settings()},
             {"versions", {{"viewgain", VIEWGAIN_VERSION}, {"compiler", __VERSION__}}}};
    run.update(views_->json(moment.model, next_));
    write_file_atomically(folder.file("run.json"), json_text(run));
    if (options_.report == "on") {
      write_report(folder.file("report.html"), page_->json(run, nullptr));
    }
    return run;
  }

  [[nodiscard]] const NextViews& next() const { return next_; }
  [[nodiscard]] const Sensor& sensor() const { return map_->model().sensor(); }

 private:
  [[nodiscard]] bool draws() const { return options_.pictures == "on" || options_.report == "on"; }

  void draw(RunFolder& folder, const Moment& moment, const ViewRecord& record,
            const EstimatedViews& estimated) {
    const Stopwatch watch;
    ViewPicture parts{moment.model.surface(),
                      estimated,
                      record.proposal.candidates,
                      record.T_world_camera,
                      std::nullopt,
                      moment.evaluator,
                      sensor()};
    std::vector<VoxelContribution> contributions;
    if (record.decision) {
      parts.chosen = record.proposal.candidates[record.decision->candidate].T_world_camera;
      contributions = moment.evaluator.contributions(*parts.chosen);
      parts.contributions = &contributions;
    }
    const RgbImage picture = view_picture(parts, exec_);
    if (options_.pictures == "on") write_png(folder.view(record.index, ".png"), picture);
    if (options_.report == "on") {
      page_->add_view(record, moment.model, moment.generation, estimated, moment.evaluator,
                      std::move(contributions), picture);
    }
    views_->add_seconds("pictures", watch.seconds());
  }

  [[nodiscard]] Json settings() const {
    const FrameSequence& frames = map_->folder().frames();
    const BeliefGrid& grid = map_->model().grid();
    Json settings{{"frames", options_.mesh},
                  {"sensor", sensor_toml(sensor())},
                  {"depth_scale", frames.depth_scale},
                  {"mask", nullptr},
                  {"confidence", nullptr},
                  {"least_confidence", nullptr},
                  {"voxel", grid.voxel_size()},
                  {"workspace", app::to_json(grid.workspace())},
                  {"prior_sigma", grid.prior_sigma()},
                  {"support_plane", nullptr},
                  {"jump_edge_filter", options_.jump_edge_filter},
                  {"refine", options_.refine == "on"},
                  {"register", sigmas_.has_value()},
                  {"pose_sigma", nullptr},
                  {"generator", proposal_.generator},
                  {"gain", proposal_.gain},
                  {"reach", nullptr},
                  {"obstacles", options_.obstacles},
                  {"top", options_.top}};
    if (sigmas_) {
      settings["pose_sigma"] =
          pose_sigmas_json({sigmas_->sigma_translation, sigmas_->sigma_rotation});
    }
    if (!options_.mask.empty()) settings["mask"] = options_.mask;
    if (!options_.confidence.empty()) {
      settings["confidence"] = options_.confidence;
      settings["least_confidence"] = options_.least_confidence;
    }
    if (!options_.reach.empty()) settings["reach"] = options_.reach;
    if (proposal_.support_plane) settings["support_plane"] = *proposal_.support_plane;
    return settings;
  }

  const ReconstructOptions& options_;
  ProposalOptions proposal_;
  ExecConfig exec_;
  std::optional<FrameMap> map_;
  std::optional<RunPage> page_;
  std::optional<PosePrior> sigmas_;  // of the poses, where frames are aligned
  std::optional<RecordedViews> views_;
  NextViews next_;
};

void print(const ReconstructOptions& options, const Json& run, const NextViews& next) {
  std::printf("%zu frames, %s readings, %s of them in the workspace\n",
              run["views"].get<std::size_t>(),
              with_commas(run["readings"].get<std::uint64_t>()).c_str(),
              with_commas(run["readings_inside"].get<std::uint64_t>()).c_str());
  if (run.contains("registration")) {
    std::printf("%s\n", registration_text(run["registration"]).c_str());
  }
  std::printf("surface %.4g m^2: %s points, %s triangles\n", run["surface_area"].get<double>(),
              with_commas(run["points"].get<std::size_t>()).c_str(),
              with_commas(run["triangles"].get<std::size_t>()).c_str());
  std::printf("next: %s\n%s", summary_of(next).c_str(), text_of(next).c_str());
  std::printf("%.2f s\n", run["seconds"]["total"].get<double>());
  std::printf(
      "left in %s: run.json, config.toml, views.txt, next.txt, map.vdb, surface.ply, "
      "points.ply%s%s%s\n",
      options.out.c_str(), options.pictures == "on" ? ", views/" : "",
      options.save_maps == "on" ? ", maps/" : "", options.report == "on" ? ", report.html" : "");
}

}  // namespace

void reconstruct_frames(const ReconstructOptions& options, const App& app) {
  for (const char* flag : kFlagsOfMeshes) {
    if (app.count(flag) == 0) continue;
    throw Error(ErrorCode::invalid_argument,
                std::string(flag) + " is for a mesh, not for a folder of frames");
  }
  if (options.report == "on") check_report_page("--report");
  const InterruptGuard interrupt;
  Recording recording(options, app);
  RunFolder folder(options.out);
  recording.add_frames(folder, interrupt.token());
  const Json run = recording.finish(folder);
  write_file_atomically(folder.file("config.toml"),
                        config_text(app, {"out", "json", "quiet", "threads"}));
  folder.commit();
  if (options.common.json) return print_json(run);
  print(options, run, recording.next());
}

}  // namespace viewgain::app
