// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "program/cli/flags/next_views.hpp"
#include "program/cli/flags/set_up_warnings.hpp"
#include "program/cli/interrupt.hpp"
#include "program/cli/progress.hpp"
#include "program/cli/values.hpp"
#include "program/commands/file_format.hpp"
#include "program/commands/frames/frame_map.hpp"
#include "program/commands/frames/frame_tally.hpp"
#include "program/commands/frames/mask_use.hpp"
#include "program/commands/map_json.hpp"
#include "program/commands/model/model_options.hpp"
#include "program/commands/model/recorded_views.hpp"
#include "program/commands/proposal/view_proposal.hpp"
#include "program/commands/reconstruct/checkpoint.hpp"
#include "program/commands/reconstruct/run_outputs.hpp"
#include "show/report/page.hpp"
#include "show/report/run_page.hpp"
#include "viewgain/core/pose_io.hpp"
#include "viewgain/formats/map_file.hpp"
#include "viewgain/formats/sensor_toml.hpp"
#include "viewgain/formats/staged_folder.hpp"
#include "viewgain/planner/align_frames.hpp"
#include "viewgain/planner_mesh/surface_model.hpp"
#include "viewgain/raycast/suspect_set_up.hpp"
#include "viewgain/support/atomic_file.hpp"
#include "viewgain/support/file_bytes.hpp"
#include "viewgain/support/hash64.hpp"
#include "viewgain/support/json.hpp"
#include "viewgain/support/stopwatch.hpp"

namespace viewgain::app {
namespace {

// Number of states of the map that are drawn, evenly spaced and including the last. Each needs a
// new surface.
constexpr std::size_t kMaxShown = 6;

using Options = ModelOptions;

// Frames after which the state of the map is drawn.
std::set<std::size_t> shown_frames(std::size_t count) {
  std::set<std::size_t> shown;
  const std::size_t most = std::min(count, kMaxShown);
  for (std::size_t k = 1; k <= most; ++k) shown.insert(k * count / most - 1);
  return shown;
}

// Surface and next views of the current map.
struct Moment {
  SurfaceModel model;
  CandidateGeneration generation;
  GainEvaluator evaluator;

  Moment(const FrameMap& map, const ProposalOptions& proposal, const ExecConfig& exec)
      : model(model_of(map.scorer().grid().clone(), map.scorer().sensor(), proposal,
                       map.config().obstacles, exec)),
        generation(model,
                   generation_config(proposal, map.scorer().sensor(), model.grid(),
                                     map.folder().name(), map.tried()),
                   exec),
        evaluator(evaluator_of(proposal, model, map.scorer().sensor(), exec)) {}
};

// Aligns all frames of the folder with each other, before any is in the map. Results are by frame
// index, without frames that cannot be read; after a stop, those so far.
std::map<std::size_t, FrameRegistration> align_folder(const FrameMap& map, const PoseSigma& sigma,
                                                      bool quiet, const ExecConfig& exec,
                                                      const std::stop_token& stop) {
  FrameAlignment alignment(map.scorer().sensor(), map.config(), exec);
  Progress progress("alignment of frame", quiet);
  const FrameFolder& folder = map.folder();
  std::vector<std::size_t> aligned;
  for (std::size_t i = 0; i < folder.size() && !stop.stop_requested(); ++i) {
    const FrameReading reading = folder.load(i);
    progress.update(i + 1, folder.size());
    if (reading.fault.verdict != FrameVerdict::used) continue;
    alignment.add(reading.frame, folder.T_world_camera(i), sigma);
    aligned.push_back(i);
  }
  std::map<std::size_t, FrameRegistration> registrations;
  for (std::size_t k = 0; k < aligned.size(); ++k) {
    registrations.emplace(aligned[k], alignment.registrations()[k]);
  }
  return registrations;
}

class Recording {
 public:
  Recording(const Options& options, const App& app, const std::stop_token& stop)
      : options_(options),
        app_(app),
        proposal_(options.proposal),
        exec_(exec_of(options.common)),
        beside_(beside_json(options.outputs)) {
    check(proposal_);
    sigma_ = registration_sigma(options.registration);
    check_contradiction(options.frames.folder, sigma_.has_value());
    map_.emplace(options.frames, proposal_, options.common.quiet, exec_);
    if (const auto stated = stated_sigma(options.registration)) {
      warn(suspect_pose_sigma(*stated, sensor().working_distance, grid().voxel_size()),
           "--register");
    }
    if (sigma_) {
      const Stopwatch watch;
      auto aligned = align_folder(*map_, *sigma_, options.common.quiet, exec_, stop);
      if (!aligned.empty()) aligned_until_ = aligned.rbegin()->first + 1;
      views_.emplace(*map_, std::move(aligned), options.frames.folder.on_contradiction);
      views_->add_seconds("register", watch.seconds());
    } else {
      views_.emplace(*map_);
    }
    const std::filesystem::path folder = map_->folder().name();
    page_.emplace(folder.filename().string() + ", " + sensor().name, sensor(), "log_diagonal",
                  nullptr);
  }

  // Adds the frames until all are integrated or a stop is requested. Frames that are aligned by
  // then are kept.
  void add_frames(RunFolder& folder, const std::stop_token& stop) {
    const std::set<std::size_t> shown = shown_frames(map_->folder().size());
    Progress progress("frame", options_.common.quiet);
    for (std::size_t i = 0; i < map_->folder().size(); ++i) {
      if (stop.stop_requested() && i >= aligned_until_) break;
      views_->add(i);
      if (options_.outputs.saves_maps()) {
        save_vdb(map_->scorer().grid(), folder.map(i));
      }
      const bool last = i + 1 == map_->folder().size();
      if (options_.outputs.draws() && shown.count(i) > 0 && !last && !views_->empty()) {
        show(folder, Moment(*map_, proposal_, exec_));
      }
      progress.update(i + 1, map_->folder().size());
    }
    if (views_->empty() && stop.stop_requested()) {
      refuse(map_->folder().name() +
             ": the call was interrupted before the map had any frame; repeat it");
    }
    map_->require_frames();
  }

  // Makes surface, next views and report. Returns the contents of run.json.
  Json finish(RunFolder& folder) {
    Stopwatch watch;
    Moment moment(*map_, proposal_, exec_);
    views_->add_seconds("surface", watch.seconds());
    warn_of_views(proposal_, map_->config().obstacles, moment.model, sensor());
    ViewRecord& last = views_->last();
    watch = {};
    last.proposal = moment.generation.generate(last.T_world_camera);
    views_->add_seconds("candidates", watch.seconds());
    watch = {};
    next_ = best_views(moment.evaluator, last.proposal, proposal_, map_->last_pose(), options_.top,
                       options_.common.quiet);
    views_->add_seconds("score", watch.seconds());
    if (!next_.views.empty()) last.decision = DecisionMaking::Decision{next_.views.front().index};
    show(folder, moment);

    save_vdb(moment.model.grid(), folder.file("map.vdb"));
    write_surfaces(moment.model, folder.file("surface.ply"), folder.file("points.ply"));
    write_tum(folder.file("views.txt"), moment.model.grid().views());
    write_tum(folder.file("next.txt"), poses_of(next_));
    Json run = run_head(settings());
    run.update(views_->json(moment.model, next_));
    write_file_atomically(folder.file("run.json"), json_text(run));
    Json next{{"format", kRunFormat}, {"frames", run["frames"]}};
    next.update(app::to_json(next_));
    write_file_atomically(folder.file("next.json"), json_text(next));
    if (options_.outputs.with_report()) {
      write_report(folder.file("report.html"), page_->json(run, nullptr, beside_));
    }
    return run;
  }

  // Everything that affects the run's results: settings, flags, program, and the bytes of frames
  // and masks.
  [[nodiscard]] Json head() const {
    Json head = checkpoint_head(settings(), app_);
    const FrameSequence& frames = map_->folder().frames();
    for (std::size_t i = 0; i < frames.poses.size(); ++i) {
      head["frames"].push_back(identity_or_none(frames, i));
      for (const MaskFolder& masks : map_->folder().masks()) {
        head["masks"].push_back(hash_of(masks.file_of(frames.images[i])));
      }
    }
    return head;
  }
  // A frame that cannot be read is counted later. If it becomes readable, the run is a different
  // one.
  [[nodiscard]] static std::string identity_or_none(const FrameSequence& frames, std::size_t i) {
    try {
      return frame_identity(frames, i);
    } catch (const Error&) {
      return "unreadable " + frames.images[i].filename().string();
    }
  }
  // Null if there is no such file.
  [[nodiscard]] static Json hash_of(const std::filesystem::path& file) {
    std::error_code ignored;
    if (!std::filesystem::is_regular_file(file, ignored)) return nullptr;
    Hash64 hash;
    hash.add_bytes(folder_file_bytes(file));
    return hash.hex();
  }
  [[nodiscard]] const NextViews& next() const { return next_; }
  [[nodiscard]] const FrameCounts& counts() const { return map_->counts(); }
  [[nodiscard]] const Sensor& sensor() const { return map_->scorer().sensor(); }
  [[nodiscard]] const BeliefGrid& grid() const { return map_->scorer().grid(); }

 private:
  void show(RunFolder& folder, const Moment& moment) {
    const StageSeconds seconds = show_step(
        options_.outputs, folder, *page_,
        {views_->last(), moment.model, moment.generation, moment.evaluator, sensor()}, exec_);
    for (const auto& [stage, value] : seconds) views_->add_seconds(stage, value);
  }

  // Null if only the poses of --poses are candidates.
  [[nodiscard]] Json generator() const {
    if (!proposal_.generator.empty()) return proposal_.generator;
    return proposal_.poses.empty() ? Json("boundary") : Json();
  }

  [[nodiscard]] Json settings() const {
    const FrameSequence& frames = map_->folder().frames();
    const BeliefGrid& grid = map_->scorer().grid();
    const FrameFolderOptions& folder = options_.frames.folder;
    Json json{
        {"frames", map_->folder().name()},
        {"sensor", sensor_toml(sensor())},
        {"depth_scale", frames.depth_scale},
        {"out_of_range", frames.out_of_range == Sensor::OutOfRange::carve ? "carve" : "invalid"},
        {"mask", or_null(folder.mask)},
        {"confidence", or_null(parse_confidence(folder.confidence).folder)},
        {"least_confidence",
         folder.confidence.empty() ? Json() : Json(parse_confidence(folder.confidence).least)},
        {"voxel", grid.voxel_size()},
        {"workspace", app::to_json(grid.workspace())},
        {"prior_sigma", grid.prior_sigma()},
        {"support_plane", proposal_.support_plane},
        {"jump_edge_filter", options_.frames.jump_edge_filter},
        {"register", sigma_.has_value()},
        {"on_contradiction", sigma_ ? Json(folder.on_contradiction) : Json()},
        {"pose_sigma", sigma_ ? pose_sigma_json(*sigma_) : Json()},
        {"generator", generator()},
        {"poses", or_null(proposal_.poses)},
        {"count", proposal_.count},
        {"distance", proposal_.distance},
        {"center", or_null(proposal_.center)},
        {"seed", proposal_.seed},
        {"gain", proposal_.gain},
        {"hazard", or_null(proposal_.hazard)},
        {"costs", or_null(proposal_.costs.file)},
        {"cost_per_metre", proposal_.costs.per_metre},
        {"from", or_null(proposal_.costs.from)},
        {"reach", or_null(proposal_.reach)},
        {"obstacles", proposal_.obstacles},
        {"top", options_.top},
        {"plan", parse_plan(proposal_.plan).plan},
        {"take", parse_plan(proposal_.plan).take}};
    json.update(options_.frames.scales.settings());
    return json;
  }

  const Options& options_;
  const App& app_;
  const ProposalOptions& proposal_;
  ExecConfig exec_;
  Json beside_;  // another run shown on the page
  std::optional<FrameMap> map_;
  std::optional<RunPage> page_;
  std::optional<PoseSigma> sigma_;  // of the poses, if frames are aligned
  std::size_t aligned_until_ = 0;   // number of aligned frames
  std::optional<RecordedViews> views_;
  NextViews next_;
};

void print(const Options& options, const Json& run, const BeliefGrid& grid,
           const FrameCounts& counts, const NextViews& next) {
  print_map(grid, grid.statistics());
  std::printf("%zu frames, %s measured points, %s of them in the workspace\n",
              run["frames"].get<std::size_t>(),
              with_commas(run["readings"].get<std::uint64_t>()).c_str(),
              with_commas(run["readings_inside"].get<std::uint64_t>()).c_str());
  if (const std::string text = frames_text(counts); !text.empty()) {
    std::printf("%s\n", text.c_str());
  }
  std::printf(
      "%s", masked_text(options.frames.folder, run["masked_pixels"].get<std::uint64_t>()).c_str());
  if (run.contains("registration")) {
    std::printf("%s\n", registration_text(run["registration"]).c_str());
  }
  std::printf("surface %.4g m^2: %s points, %s triangles\n", run["surface_area"].get<double>(),
              with_commas(run["points"].get<std::size_t>()).c_str(),
              with_commas(run["triangles"].get<std::size_t>()).c_str());
  std::printf("next: %s\n%s", summary_of(next).c_str(), text_of(next).c_str());
  if (options.proposal.reach.empty()) std::printf("%s", outside_text(next, grid).c_str());
  std::printf("%.2f s\n", run["seconds"]["total"].get<double>());
  print_left(
      options.outputs,
      "run.json, config.toml, views.txt, next.txt, next.json, map.vdb, surface.ply, points.ply");
}

}  // namespace

void model_recorded_frames(const ModelOptions& options, const App& app) {
  if (options.outputs.with_report()) check_report_page("--report");
  const InterruptGuard interrupt;
  Recording recording(options, app, interrupt.token());
  RunFolder folder(options.outputs.out, options.outputs.resume);
  // Frames are read again, which takes no longer than reading a map. Pictures are kept.
  const Checkpoint checkpoint(folder, recording.head(), options.outputs.resume);
  recording.add_frames(folder, interrupt.token());
  const Json run = recording.finish(folder);
  commit(folder, run, app);
  if (options.common.json) return print_json(run);
  print(options, run, recording.grid(), recording.counts(), recording.next());
}

}  // namespace viewgain::app
