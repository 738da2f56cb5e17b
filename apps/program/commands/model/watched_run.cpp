// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <chrono>
#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <limits>
#include <optional>
#include <set>
#include <stop_token>
#include <string>
#include <system_error>
#include <thread>
#include <utility>
#include <vector>

#include "program/cli/flags/frame_folder.hpp"
#include "program/cli/flags/next_views.hpp"
#include "program/cli/flags/scene_sources.hpp"
#include "program/cli/flags/set_up_warnings.hpp"
#include "program/cli/interrupt.hpp"
#include "program/cli/values.hpp"
#include "program/commands/file_format.hpp"
#include "program/commands/frames/frame_tally.hpp"
#include "program/commands/frames/mask_use.hpp"
#include "program/commands/model/model_options.hpp"
#include "program/commands/model/watched_map.hpp"
#include "viewgain/core/error.hpp"
#include "viewgain/core/planning.hpp"
#include "viewgain/core/pose_io.hpp"
#include "viewgain/formats/frame_watch.hpp"
#include "viewgain/formats/sensor_toml.hpp"
#include "viewgain/formats/staged_folder.hpp"
#include "viewgain/planner_mesh/surface_model.hpp"
#include "viewgain/support/atomic_file.hpp"
#include "viewgain/support/stopwatch.hpp"

namespace viewgain::app {
namespace {

namespace fs = std::filesystem;

constexpr std::chrono::milliseconds kPause{100};  // between looks at the folder
// While frames wait, shortest time between proposals, and between writes of all files [s].
constexpr double kLeastInterval = 0.5;
constexpr std::size_t kTurns = 10;  // per run of the loop, which keeps a record per turn

// Refuses a folder with files that this kind of run did not write.
void check_folder(const fs::path& out, bool goes_on) {
  std::error_code ignored;
  for (const fs::path& name : run_files(out)) {
    const bool is_own = goes_on && name != "map.vdb" && name != "run.json";
    if (!is_own && fs::exists(out / name, ignored)) {
      refuse((out / name).string() + ": --watch did not write this file; choose another folder");
    }
  }
}

// Acquisition and update of Algorithm 1 for a robot that moves the camera and writes frames to a
// folder. Frames go into the map; the next views go into the files.
class Watching final : private DataAcquisition, private RepresentationUpdate {
 public:
  explicit Watching(const ModelOptions& options)
      : options_(options),
        folder_(options.frames.folder),
        proposal_(options.proposal),
        map_config_(map_config_of(options)),
        planner_config_(planner_config_of(options)),
        frames_(folder_.folder),
        out_(options.outputs.out),
        views_(frames_) {
    check(proposal_);
    check_contradiction(folder_, registration_sigma(options.registration).has_value());
    if (!folder_.sensor.empty()) (void)load_sensor(folder_.sensor);
    (void)with_body(Sensor{}, proposal_);
    std::error_code ignored;
    if (!fs::is_directory(frames_, ignored)) {
      throw Error(ErrorCode::io, frames_.string() + ": no such folder");
    }
    lock_.emplace(out_);
    saved_ = saved_frames(out_ / "state.vdb", exec_of(options.common));
    if (saved_) {
      views_.recall(out_ / "next.json", saved_->frames);
      say("resuming with " + std::to_string(saved_->frames.size()) + " frames from " +
          (out_ / "state.vdb").string());
    }
    check_folder(out_, saved_.has_value());
    watch_.emplace(watch_of(folder_, saved_));
  }

  // Runs until a signal arrives or all is done. The stop reason is the planner's; it is written,
  // but does not end the run. The loop's own stopping rules are off, because they would skip the
  // proposal.
  void run(std::stop_token stop) {
    stop_ = std::move(stop);
    while (wait()) {
      end_ = std::stop_source();
      const PlanningConfig rules{.max_views = std::numeric_limits<std::size_t>::max(),
                                 .idle_views = 0,
                                 .broken_promises = 0,
                                 .stop = end_.get_token()};
      (void)active_view_planning({}, *this, *this, *map_, *map_, rules,
                                 [this](const ViewRecord&) { write(); });
    }
    if (!map_) return;
    warn_of_masks(true);
    warn_of_contradictions(true);
    write_new_counts();
    if (is_done_ && !map_->grid().views().empty()) write_model();
  }

  void print_summary(double seconds) const {
    if (is_done_ && count() == 0) {
      const std::string bad = counts_text(watch_->bad());
      refuse(frames_.string() + ": the file done exists, but no frame is in the map" +
             (bad.empty() ? "" : "; left out: " + bad));
    }
    if (options_.common.json) {
      Json json = counts();
      json["added"] = added_;
      json["masked_pixels"] = masked_pixels_;
      json["orthonormalized_poses"] = watch_->folder() ? watch_->folder()->orthonormalized : 0;
      json["ended_by"] = is_done_ ? "done" : "signal";
      json["hash"] = nullptr;
      json["contradiction"] = nullptr;
      if (map_) {
        json["hash"] = map_->grid().content_hash();
        json["contradiction"] = map_->consistency_json();
      }
      json["out"] = options_.outputs.out;
      json["seconds"] = seconds;
      return print_json(json);
    }
    std::printf("%zu frames in the map, %zu of them new; %zu more are not complete yet\n", count(),
                added_, watch_->waiting());
    if (const std::string text = frames_text(carved(), watch_->bad()); !text.empty()) {
      std::printf("%s\n", text.c_str());
    }
    std::printf("%s", masked_text(folder_, masked_pixels_).c_str());
    if (!map_) return;
    if (const auto reason = map_->should_stop()) {
      std::printf("stop: %s\n", stop_reason_name(*reason).data());
    }
    std::printf("%s: state.vdb (hash %s), next.txt, next.json%s\n", out_.c_str(),
                map_->grid().content_hash().c_str(),
                is_done_ ? ", surface.ply, points.ply, views.txt" : "");
  }

 private:
  // Waits for a frame for the map; false if a signal arrived or all is done.
  bool wait() {
    while (!is_done_ && !stop_.stop_requested()) {
      // Checked before the look, so that frames written before the file are seen.
      std::error_code ignored;
      const bool is_last = fs::exists(frames_ / "done", ignored);
      look();
      if (frame_ || has_news_) return true;
      write_new_counts();
      is_done_ = is_last && watch_->is_settled();
      if (!is_done_) std::this_thread::sleep_for(kPause);
    }
    // Missing files will not arrive any more.
    if (is_done_) leave_out(watch_->give_up());
    return has_news_;
  }

  void look() {
    FolderLook look = watch_->look(std::chrono::steady_clock::now());
    if (!map_ && watch_->folder()) open_map();
    leave_out(look.bad);
    frame_ = std::move(look.frame);
  }

  // run() has waited before the first turn. The frame stays in frame_, with its name and masks.
  Measurements acquire(const Pose&, std::size_t turn) override {
    if (turn > 0 && (turn == kTurns || !wait())) end_.request_stop();
    return {frame_ ? frame_->T_world_camera : Pose(), {}};
  }

  // Also takes all waiting frames before views are proposed.
  ModelProgress update(const Measurements&) override {
    while (frame_) {
      take(*std::exchange(frame_, std::nullopt));
      const bool is_due = !since_written_ || since_written_->seconds() > kLeastInterval;
      if (!is_due && !stop_.stop_requested()) look();
    }
    // Checked before saving, because a later call would continue from the saved state.
    if (has_news_ && folder_.on_contradiction == "error") warn_of_contradictions(true);
    // Saved before views are proposed, which takes longest and can be repeated from the saved
    // state.
    if (has_news_) map_->save();
    return progress_;
  }

  void say(const std::string& text) const {
    if (!options_.common.quiet) std::fprintf(stderr, "viewgain: %s\n", text.c_str());
  }

  void warn(const std::string& what) const {
    if (!what.empty()) std::fprintf(stderr, "viewgain: warning: %s\n", what.c_str());
  }

  [[nodiscard]] bool has_masks() const {
    return !folder_.mask.empty() || !folder_.confidence.empty();
  }
  void warn_of_masks(bool is_last) {
    if (!has_masks()) return;
    warn(masks_.suspicion(watch_->folder()->sensor, map_->grid(), is_last));
  }

  // If masks explain the frames, there is no other warning.
  void warn_of_contradictions(bool is_last) {
    if (masks_.is_suspected()) return;
    const std::string what = map_->suspicion(is_last);
    if (!what.empty() && folder_.on_contradiction == "error") {
      refuse(frames_.string() + ": " + what);
    }
    warn(what);
  }

  [[nodiscard]] std::size_t carved() const {
    return map_ ? count_of(map_->frames(), FrameVerdict::carved) : 0;
  }

  void leave_out(const std::vector<BadFrame>& frames) {
    for (const BadFrame& bad : frames) {
      say(bad.fault.what + " (" + std::string(frame_verdict_name(bad.fault.verdict)) +
          "); the frame is left out");
      // A frame that was taken is in the map, even if its files have changed.
      if (bad.fault.verdict == FrameVerdict::changed) views_.ignore(bad.name);
      if (!map_ || bad.fault.verdict == FrameVerdict::changed) continue;
      if (!views_.leave_out(bad.name)) continue;  // already counted
      map_->answer(views_.answered_by(bad.name), bad.T_world_camera);
      map_->drop(bad.fault.verdict, bad.T_world_camera);
      has_news_ = true;
    }
  }

  [[nodiscard]] std::size_t count() const { return watch_->taken_count(); }

  void open_map() {
    warn_of_assumptions(folder_.folder, *watch_->folder());
    const Sensor sensor = with_body(watch_->folder()->sensor, proposal_);
    map_config_.prior_sigma = default_prior_sigma(map_config_.voxel_size, sensor);
    const BeliefGrid empty(map_config_.grid());
    if (!saved_) warn_of_few_voxels(empty);
    map_config_.hazard = hazard_source(proposal_.hazard, empty);
    map_.emplace(options_, sensor, map_config_, planner_config_, saved_);
    map_->propose_by(generation_config(proposal_, sensor, map_->grid(), ""));
    // next.json may be missing or older than the saved state, and a waiting frame may be its
    // answer.
    has_news_ = saved_.has_value();
    warn_of_set_up(proposal_, map_config_.obstacles, map_->grid(), sensor, true);
    if (!saved_) return;
    const Proposal proposal = map_->generate({});
    if (!proposal.candidates.empty()) (void)map_->decide({}, proposal.candidates);
    ask(saved_->frames);
  }

  void take(const WatchedFrame& frame) {
    const std::string name = frame.image.filename().string();
    if (has_masks()) masks_.add(*watch_->folder(), frame);
    warn_of_masks(false);
    const std::optional<FrameRegistration> registration = map_->register_in(frame);
    FrameVerdict verdict = FrameVerdict::contradicts;
    std::string why = frame.image.string();
    AddedView added;
    if (registration && leaves_out(*registration, folder_.on_contradiction)) {
      why += ": " + registration->reason;
    } else {
      added = map_->add(frame, registration);
      progress_ = added.progress;
      has_news_ = true;
      verdict = added.update.verdict;
      warn_of_contradictions(false);
    }
    if (!is_in_map(verdict)) {
      watch_->refuse(frame, verdict);
      say(why + " (" + std::string(frame_verdict_name(verdict)) + "); the frame is left out");
      if (!views_.leave_out(name)) return;
      if (verdict == FrameVerdict::contradicts) map_->drop(verdict, frame.T_world_camera);
    } else {
      views_.take(name);
      ++added_;
      masked_pixels_ += frame.masked_pixels;
    }
    map_->answer(views_.answered_by(name), frame.T_world_camera);
    has_news_ = true;
    if (options_.common.quiet || !is_in_map(verdict)) return;
    std::fprintf(stderr, "%s: %.4g m^2 of new surface, %.4g nat of entropy removed\n", name.c_str(),
                 added.update.new_area, added.entropy_removed);
  }

  // Asks for the next views of the map with these frames.
  void ask(const std::set<std::string>& frames) {
    const NextViews& next = map_->next();
    views_.ask(poses_of(next), frames);
    if (next.candidates > 0 || !next.dropped.contains("obstacle")) return;
    if (std::exchange(told_of_obstacles_, true)) return;
    warn_of_views_in_obstacles(map_config_.obstacles, map_->grid());
  }

  void write() {
    if (!has_news_) return;
    const NextViews& next = map_->next();
    ask(watch_->taken());
    write_tum(out_ / "next.txt", poses_of(next));
    write_json();
    has_news_ = false;
    since_written_.emplace();
    if (options_.common.quiet) return;
    std::fprintf(stderr, "%zu frames: %zu candidates", count(), next.candidates);
    if (!next.views.empty()) {
      std::fprintf(stderr, ", best gain %.4g", next.views.front().gain.gain);
    }
    const auto reason = map_->should_stop();
    std::fprintf(stderr, "%s%s\n", reason ? "; stop: " : "",
                 reason ? stop_reason_name(*reason).data() : "");
  }

  // Writes the results of all frames.
  void write_model() const {
    const SurfaceModel model = model_of(map_->grid().clone(), map_->sensor(), proposal_,
                                        map_config_.obstacles, exec_of(options_.common));
    write_surfaces(model, out_ / "surface.ply", out_ / "points.ply");
    write_tum(out_ / "views.txt", map_->grid().views());
  }

  [[nodiscard]] Json counts() const {
    Json json{{"frames", count()},
              {"carved", carved()},
              {"waiting", watch_->waiting()},
              {"bad", watch_->bad()},
              {"stop_reason", nullptr}};
    if (map_ && map_->should_stop()) json["stop_reason"] = stop_reason_name(*map_->should_stop());
    return json;
  }

  // Not before the saved state exists, which shows that these files belong to this run.
  void write_new_counts() {
    if (map_ && !has_news_ && since_written_ && said_ != counts()) write_json();
  }

  void write_json() {
    said_ = counts();
    Json json{{"format", kRunFormat}};
    json.update(said_);
    json.update(views_.json());
    json.update(to_json(map_->next()));
    write_file_atomically(out_ / "next.json", json_text(json));
  }

  const ModelOptions& options_;
  const FrameFolderOptions& folder_;
  const ProposalOptions& proposal_;
  ScorerConfig map_config_;
  PlannerConfig planner_config_;
  fs::path frames_, out_;
  AskedViews views_;
  std::optional<FolderLock> lock_;
  std::optional<SavedFrames> saved_;
  std::optional<FrameWatch> watch_;
  std::optional<WatchedMap> map_;      // set when the sensor is known
  std::optional<WatchedFrame> frame_;  // arrived, but not yet in the map
  std::stop_token stop_;               // requested by a signal
  std::stop_source end_;               // ends one run of the loop
  ModelProgress progress_;             // state after the last frame
  bool is_done_ = false;
  MaskWatch masks_;
  std::size_t added_ = 0;            // number of frames added by this call
  std::uint64_t masked_pixels_ = 0;  // of these frames
  bool has_news_ = false;            // whether there are results that are not yet written
  bool told_of_obstacles_ = false;   // whether it warned of obstacles that contain the views
  std::optional<Stopwatch> since_written_;
  Json said_;  // counts(), as written to next.json
};

}  // namespace

void model_arriving_frames(const ModelOptions& options) {
  const Stopwatch watch;
  Watching watching(options);
  const InterruptGuard interrupt;
  watching.run(interrupt.token());
  watching.print_summary(watch.seconds());
}

}  // namespace viewgain::app
