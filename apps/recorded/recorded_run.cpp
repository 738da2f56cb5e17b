// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "recorded_run.hpp"

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "aligned_frames.hpp"
#include "command_line/config_file.hpp"
#include "command_line/interrupt.hpp"
#include "command_line/progress.hpp"
#include "frame_map.hpp"
#include "loop/registration_json.hpp"
#include "loop/run_setup.hpp"
#include "options/json_text.hpp"
#include "options/next_views.hpp"
#include "options/pose_sigmas.hpp"
#include "options/values.hpp"
#include "pictures/view_picture.hpp"
#include "proposal/view_proposal.hpp"
#include "report/page.hpp"
#include "report/run_page.hpp"
#include "viewgain/core/atomic_file.hpp"
#include "viewgain/core/error.hpp"
#include "viewgain/core/pose_io.hpp"
#include "viewgain/core/stopwatch.hpp"
#include "viewgain/formats/map_file.hpp"
#include "viewgain/formats/run_folder.hpp"
#include "viewgain/formats/sensor_toml.hpp"
#include "viewgain/planner_mesh/mesh_area.hpp"
#include "viewgain/planner_mesh/surface_files.hpp"
#include "viewgain/version.hpp"

namespace viewgain::app {
namespace {

using nlohmann::ordered_json;

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

ProposalOptions proposal_options(const ReconstructOptions& options, const CLI::App& app) {
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

struct Totals {
  IntegrationReport readings{};
  std::size_t flying_pixels = 0;
  StageSeconds seconds{};

  void add(const MapUpdate& update) {
    readings.readings += update.counts.readings;
    readings.readings_inside += update.counts.readings_inside;
    readings.plane_readings += update.counts.plane_readings;
    readings.out_of_range += update.counts.out_of_range;
    readings.invalid += update.counts.invalid;
    flying_pixels += update.flying_pixels;
    for (const auto& [stage, value] : update.seconds) seconds[stage] += value;
  }
};

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
  Recording(const ReconstructOptions& options, const CLI::App& app)
      : options_(options),
        proposal_(proposal_options(options, app)),
        exec_{options.common.threads} {
    check(proposal_);
    const FrameMapOptions frames = frame_options(options);
    map_.emplace(frames, proposal_, options.common.quiet, exec_);
    if (const auto sigmas = registration_prior(options, {})) {
      const Stopwatch watch;
      registrations_ = align_folder(*map_, frames, proposal_, *sigmas, options.common.quiet, exec_);
      sigmas_ = {sigmas->sigma_translation, sigmas->sigma_rotation};
      totals_.seconds["register"] = watch.seconds();
    }
    page_.emplace(std::filesystem::path(options.mesh).filename().string() + ", " + sensor().name,
                  sensor(), options.criterion, nullptr);
  }

  // The frames, until all are in or `stop` is asked for.
  void add_frames(RunFolder& folder, const std::stop_token& stop) {
    const std::set<std::size_t> shown = shown_frames(map_->folder().size());
    Progress progress("frame", options_.common.quiet);
    for (std::size_t i = 0; i < map_->folder().size() && !stop.stop_requested(); ++i) {
      add_frame(i);
      if (options_.save_maps == "on") {
        save_vdb(map_->model().grid(), folder.map(i), noting_sensor(sensor()));
      }
      const bool last = i + 1 == map_->folder().size();
      if (draws() && shown.count(i) > 0 && !last) {
        Moment moment(*map_, proposal_, exec_);
        draw(folder, moment, records_.back(), {});
      }
      progress.update(i + 1, map_->folder().size());
    }
    map_->require_readings();
  }

  // Surface, next views, report; what run.json holds.
  ordered_json finish(RunFolder& folder) {
    Stopwatch watch;
    Moment moment(*map_, proposal_, exec_);
    totals_.seconds["surface"] += watch.seconds();
    ViewRecord& last = records_.back();
    watch = {};
    last.proposal = moment.generation.generate(last.T_world_camera);
    totals_.seconds["candidates"] = watch.seconds();
    watch = {};
    next_ = best_views(moment.evaluator, last.proposal, options_.top);
    totals_.seconds["score"] = watch.seconds();
    if (!next_.views.empty()) last.decision = Decision{next_.views.front().index};
    if (draws()) draw(folder, moment, last, moment.generation.estimated());

    save_vdb(moment.model.grid(), folder.file("map.vdb"), noted_frames());
    write_surfaces(moment.model, folder.file("surface.ply"), folder.file("points.ply"));
    write_tum(folder.file("views.txt"), moment.model.grid().views());
    write_tum(folder.file("next.txt"), poses_of(next_));
    const ordered_json run = json(moment.model);
    write_file_atomically(folder.file("run.json"), json_text(run));
    if (options_.report == "on") {
      write_report(folder.file("report.html"), page_->json(run, nullptr));
    }
    return run;
  }

  [[nodiscard]] const NextViews& next() const { return next_; }
  [[nodiscard]] const Sensor& sensor() const { return map_->model().sensor(); }

 private:
  [[nodiscard]] bool is_aligned() const { return !registrations_.empty(); }
  [[nodiscard]] bool is_refused(std::size_t index) const {
    return is_aligned() && registrations_[index].status == RegistrationStatus::refused;
  }

  [[nodiscard]] bool draws() const { return options_.pictures == "on" || options_.report == "on"; }

  void add_frame(std::size_t index) {
    ViewRecord record;
    record.index = index;
    record.T_world_camera =
        is_aligned() ? registrations_[index].T_world_camera : map_->folder().T_world_camera(index);
    MapUpdate update;
    if (!is_refused(index)) {
      const Stopwatch watch;
      update = map_->add(index, record.T_world_camera);
      totals_.add(update);
      double known = 0;
      for (const auto& [stage, value] : update.seconds) known += value;
      totals_.seconds["read"] += watch.seconds() - known;
    }
    record.progress = map_->model().progress();
    record.realised_gain = record.progress.entropy_removed;
    if (!records_.empty()) {
      const ViewRecord& before = records_.back();
      record.realised_gain -= before.progress.entropy_removed;
      record.travelled =
          before.travelled +
          (record.T_world_camera.translation() - before.T_world_camera.translation()).norm();
    }
    new_areas_.push_back(update.new_area);
    record.seconds = update.seconds;
    records_.push_back(std::move(record));
  }

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
    if (record.decision) {
      parts.chosen = record.proposal.candidates[record.decision->candidate].T_world_camera;
    }
    const RgbImage picture = view_picture(parts, exec_);
    if (options_.pictures == "on") write_png(folder.view(record.index, ".png"), picture);
    if (options_.report == "on") {
      page_->add_view(record, moment.model, moment.generation, estimated, moment.evaluator,
                      picture);
    }
    totals_.seconds["pictures"] += watch.seconds();
  }

  [[nodiscard]] VdbWriteConfig noted_frames() const {
    std::set<std::string> frames;
    for (const ViewRecord& record : records_) {
      if (is_refused(record.index)) continue;
      frames.insert(frame_identity(map_->folder().frames(), record.index));
    }
    return noting_sensor(map_->folder().sensor(), noting_frames(frames));
  }

  [[nodiscard]] ordered_json settings() const {
    const FrameSequence& frames = map_->folder().frames();
    const BeliefGrid& grid = map_->model().grid();
    ordered_json settings{{"frames", options_.mesh},
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
                          {"register", options_.register_frames == "on"},
                          {"pose_sigma", nullptr},
                          {"generator", proposal_.generator},
                          {"gain", proposal_.gain},
                          {"reach", nullptr},
                          {"obstacles", options_.obstacles},
                          {"top", options_.top}};
    if (is_aligned()) settings["pose_sigma"] = pose_sigmas_json(sigmas_);
    if (!options_.mask.empty()) settings["mask"] = options_.mask;
    if (!options_.confidence.empty()) {
      settings["confidence"] = options_.confidence;
      settings["least_confidence"] = options_.least_confidence;
    }
    if (!options_.reach.empty()) settings["reach"] = options_.reach;
    if (proposal_.support_plane) settings["support_plane"] = *proposal_.support_plane;
    return settings;
  }

  [[nodiscard]] ordered_json json(const SurfaceModel& model) const {
    const ViewRecord& last = records_.back();
    const std::size_t all = map_->folder().size();
    ordered_json run{{"settings", settings()},
                     {"versions", {{"viewgain", VIEWGAIN_VERSION}, {"compiler", __VERSION__}}},
                     {"map_hash", model.grid().content_hash()},
                     {"stop_reason", records_.size() < all ? "interrupted" : "no_frames"},
                     {"views", records_.size()},
                     {"readings", totals_.readings.readings},
                     {"readings_inside", totals_.readings.readings_inside},
                     {"masked_pixels", map_->masked_pixels()},
                     {"flying_pixels", totals_.flying_pixels},
                     {"orthonormalized_poses", map_->folder().frames().orthonormalized},
                     {"entropy_removed", last.progress.entropy_removed},
                     {"unknown_voxels", last.progress.unknown_voxels},
                     {"points", model.points().size()},
                     {"triangles", model.surface().triangles.size()},
                     {"surface_area", mesh_area(model.surface())},
                     {"travelled", last.travelled}};
    if (is_aligned()) run["registration"] = registration_counts(registrations_);
    run.update(app::to_json(next_));
    run["seconds"] = seconds_json(totals_.seconds);
    run["per_view"] = ordered_json::array();
    for (const ViewRecord& record : records_) {
      const std::size_t i = record.index;
      run["per_view"].push_back({{"index", i},
                                 {"frame", map_->folder().frames().images[i].filename().string()},
                                 {"pose", app::to_json(record.T_world_camera)},
                                 {"generator", "recorded"},
                                 {"realised_gain", record.realised_gain},
                                 {"realised_area", new_areas_[i]},
                                 {"entropy_removed", record.progress.entropy_removed},
                                 {"unknown_voxels", record.progress.unknown_voxels},
                                 {"travelled", record.travelled},
                                 {"seconds", seconds_json(record.seconds)}});
      if (!is_aligned()) continue;
      run["per_view"].back()["pose"] = app::to_json(map_->folder().T_world_camera(i));
      run["per_view"].back()["registration"] = app::to_json(registrations_[i]);
    }
    return run;
  }

  static ordered_json seconds_json(const StageSeconds& seconds) {
    ordered_json json = ordered_json::object();
    double total = 0;
    for (const auto& [stage, value] : seconds) {
      json[stage] = value;
      total += value;
    }
    json["total"] = total;
    return json;
  }

  const ReconstructOptions& options_;
  ProposalOptions proposal_;
  ExecConfig exec_;
  std::optional<FrameMap> map_;
  std::optional<RunPage> page_;
  std::vector<ViewRecord> records_;
  std::vector<double> new_areas_;                 // by frame [m²]
  std::vector<FrameRegistration> registrations_;  // by frame; empty: not asked for
  PoseNoise sigmas_;                              // of the poses, where asked for
  Totals totals_;
  NextViews next_;
};

void print(const ReconstructOptions& options, const ordered_json& run, const NextViews& next) {
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

void reconstruct_frames(const ReconstructOptions& options, const CLI::App& app) {
  for (const char* flag : kFlagsOfMeshes) {
    if (app.count(flag) == 0) continue;
    throw Error(ErrorCode::invalid_argument,
                std::string(flag) + " is for a mesh, not for a folder of frames");
  }
  if (!options.pose_sigma.empty() && options.register_frames != "on") {
    throw Error(ErrorCode::invalid_argument,
                "--pose-sigma " + options.pose_sigma + " goes with --register on");
  }
  if (options.report == "on") check_report_page("--report");
  const InterruptGuard interrupt;
  Recording recording(options, app);
  RunFolder folder(options.out);
  recording.add_frames(folder, interrupt.token());
  const ordered_json run = recording.finish(folder);
  write_file_atomically(folder.file("config.toml"),
                        config_text(app, {"out", "json", "quiet", "threads"}));
  folder.commit();
  if (options.common.json) return print_json(run);
  print(options, run, recording.next());
}

}  // namespace viewgain::app
