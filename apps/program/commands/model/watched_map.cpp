// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "program/commands/model/watched_map.hpp"

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdint>
#include <exception>
#include <memory>
#include <system_error>
#include <utility>

#include "program/cli/flags/gain_names.hpp"
#include "program/cli/flags/scene_sources.hpp"
#include "program/cli/flags/stop_rules.hpp"
#include "program/cli/values.hpp"
#include "program/commands/file_format.hpp"
#include "viewgain/core/error.hpp"
#include "viewgain/formats/frames.hpp"
#include "viewgain/formats/map_file.hpp"
#include "viewgain/formats/reach_toml.hpp"
#include "viewgain/planner/stop_settings.hpp"
#include "viewgain/raycast/suspect_frames.hpp"
#include "viewgain/support/file_bytes.hpp"

namespace viewgain::app {
namespace {

namespace fs = std::filesystem;

ViewPlanner planner_of(const Sensor& sensor, const ScorerConfig& map, const PlannerConfig& config,
                       const fs::path& state, const std::optional<SavedFrames>& saved,
                       const ExecConfig& exec) {
  if (saved && saved->sensor && !is_same_sensor(*saved->sensor, sensor)) {
    refuse(state.string() + ": the map was made with the sensor " + saved->sensor->name + ", not " +
           sensor.name + "; choose another folder");
  }
  return saved ? ViewPlanner::load(state, sensor, map, config, exec)
               : ViewPlanner(ViewScorer(sensor, map, exec), config);
}

// The folder may be empty, because masks arrive with the frames.
MaskFolder mask_folder(const char* flag, const fs::path& folder, const fs::path& frames,
                       std::optional<std::uint8_t> least_confidence = {}) {
  std::error_code ignored;
  if (fs::equivalent(folder, frames, ignored)) {
    refuse(
        std::string(flag) + " " + folder.string() +
        ": this is the folder of the depth images; masks must be in another folder, because they "
        "have the same names");
  }
  return MaskFolder(folder, least_confidence);
}

std::set<std::string> images_in(const fs::path& folder) {
  std::set<std::string> names;
  std::error_code ignored;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder, ignored)) {
    std::string name = entry.path().filename().string();
    if (name.ends_with(".depth.png")) names.insert(std::move(name));
  }
  return names;
}

}  // namespace

ScorerConfig map_config_of(const ModelOptions& options) {
  ScorerConfig config = scorer_config(options.frames, options.proposal);
  if (options.frames.workspace.empty()) {
    refuse("--watch requires --workspace x0,y0,z0,x1,y1,z1, because future frames are unknown");
  }
  config.workspace = parse_box("--workspace", options.frames.workspace);
  config.gain.model = parse_gain_model(options.proposal.gain);
  return config;
}

PlannerConfig planner_config_of(const ModelOptions& options) {
  PlannerConfig config;
  if (!options.proposal.reach.empty()) config.reach = read_reach_toml(options.proposal.reach);
  config.max_views = options.max_views;
  const StopLimits stop = stop_limits(options.stop);
  if (stop.coverage)
    refuse("--stop coverage cannot be used with model, because it requires the mesh of the object");
  config.idle_views = stop.idle;
  config.broken_promises = stop.promises;
  config.stop_gain = stop.gain;
  config.stop_area = stop.area;
  PlanningConfig rules;
  set_stop_rules(rules, parse_gain_model(options.proposal.gain), Criterion::log_diagonal,
                 config.stop_gain, config.stop_area);
  config.ahead = parse_plan(options.proposal.plan);
  return config;
}

FrameWatch watch_of(const FrameFolderOptions& options, const std::optional<SavedFrames>& saved) {
  if (options.depth_scale) check_positive("--depth-scale", *options.depth_scale);
  FrameWatchConfig config;
  config.sensor = options.sensor;
  config.depth_scale = options.depth_scale;
  config.out_of_range = out_of_range_of(options);
  if (!options.mask.empty()) {
    config.masks.push_back(mask_folder("--mask", options.mask, options.folder));
  }
  if (!options.confidence.empty()) {
    const Confidence confidence = parse_confidence(options.confidence);
    config.masks.push_back(
        mask_folder("--confidence", confidence.folder, options.folder, confidence.least));
  }
  if (saved) config.taken = saved->frames;
  return {options.folder, std::move(config)};
}

FolderLock::FolderLock(const fs::path& folder) : folder_(folder) {
  std::error_code code;
  is_made_ = fs::create_directories(folder, code);
  if (!code) lock_ = ::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (lock_ < 0) {
    const std::string why = code ? code.message() : std::generic_category().message(errno);
    throw Error(ErrorCode::io,
                folder.string() + ": the folder cannot be created or opened: " + why);
  }
  if (::flock(lock_, LOCK_EX | LOCK_NB) == 0 || errno != EWOULDBLOCK) return;
  ::close(lock_);
  refuse(folder.string() + ": another process is writing to this folder");
}

FolderLock::~FolderLock() {
  std::error_code ignored;
  if (is_made_) fs::remove(folder_, ignored);
  ::close(lock_);
}

std::optional<SavedFrames> saved_frames(const fs::path& state, const ExecConfig& exec) {
  std::error_code code;
  if (!fs::exists(state, code)) return std::nullopt;
  const BeliefGrid grid = load_map(state, nullptr, {}, exec);
  const std::set<std::string>& frames = grid.notes().frames;
  if (frames.size() != grid.views().size()) {
    throw Error(ErrorCode::format, state.string() + ": the map has " +
                                       std::to_string(grid.views().size()) + " views, but lists " +
                                       std::to_string(frames.size()) +
                                       " frames. Did another program write the file?");
  }
  return SavedFrames{frames, map_sensor(grid)};
}

std::set<std::string> AskedViews::judged(const std::set<std::string>& identities) const {
  std::set<std::string> names = left_out_;
  names.insert(ignored_.begin(), ignored_.end());
  for (const std::string& identity : identities) {
    names.insert(identity.substr(identity.find(' ') + 1));
  }
  return names;
}

void AskedViews::recall(const fs::path& next_json, const std::set<std::string>& identities) {
  std::error_code ignored;
  if (!fs::exists(next_json, ignored)) return;
  try {
    const Json next = Json::parse(folder_file_bytes(next_json));
    check_format(next_json.string(), next);
    for (const Json& name : next.at("left_out")) left_out_.insert(name.get<std::string>());
    // Otherwise the map has grown since, or is another map.
    if (next.at("asked").get<bool>() && next.at("frames") == identities.size()) {
      for (const Json& view : next.at("next")) {
        Pose pose;
        for (std::size_t k = 0; k < pose.m.size(); ++k) {
          pose.m[k] = view.at("T_world_camera").at(k / 4).at(k % 4).get<double>();
        }
        asked_.push_back(pose);
      }
    }
  } catch (const Json::exception&) {
    asked_.clear();
  } catch (const Error& error) {
    if (error.code() == ErrorCode::format) throw;  // from a newer program
    asked_.clear();
  }
  known_ = judged(identities);
}

void AskedViews::ask(std::vector<Pose> views, const std::set<std::string>& identities) {
  const std::set<std::string> there = images_in(folder_), done = judged(identities);
  // Frames that arrived since an earlier, unanswered request may still be its answer.
  if (asked_.empty()) known_ = there;
  asked_ = std::move(views);
  is_asked_ = std::includes(done.begin(), done.end(), there.begin(), there.end());
}

std::vector<Pose> AskedViews::answered_by(const std::string& name) {
  if (known_.contains(name)) return {};
  return std::exchange(asked_, {});
}

WatchedMap::WatchedMap(const ModelOptions& options, const Sensor& sensor, const ScorerConfig& map,
                       const PlannerConfig& config, const std::optional<SavedFrames>& saved)
    : options_(options),
      state_(fs::path(options.outputs.out) / "state.vdb"),
      planner_(planner_of(sensor, map, config, state_, saved, exec_of(options.common))),
      sigma_(registration_sigma(options.registration)) {
  next_.model = map.gain.model;
}

void WatchedMap::propose_by(const GenerationConfig& config) {
  for (const PoseSet& set : config.sets) planner_.add_poses(set);
  if (!config.at_boundaries) return;
  planner_.add_generation(std::make_shared<BoundaryGeneration>(planner_.scorer(), config.boundary,
                                                               exec_of(options_.common)));
}

std::string WatchedMap::suspicion(bool is_last) {
  if (is_suspected_ || (!is_last && count_ < due_)) return {};
  while (due_ <= count_) due_ *= 2;
  std::string what = text_of(planner_.scorer().consistency(), numbers_);
  if (what.empty()) what = refused_text(frames());
  is_suspected_ = !what.empty();
  return what;
}

std::optional<FrameRegistration> WatchedMap::register_in(const WatchedFrame& frame) const {
  if (!sigma_) return std::nullopt;
  return planner_.register_frame(frame.frame, frame.T_world_camera, *sigma_);
}

AddedView WatchedMap::add(const WatchedFrame& frame,
                          const std::optional<FrameRegistration>& registration) {
  const AddedView added = registration ? planner_.add(frame.frame, registration->T_world_camera,
                                                      registration->pose_sigma())
                                       : planner_.add(frame.frame, frame.T_world_camera);
  if (is_in_map(added.update.verdict)) numbers_.push_back(number_of(frame.image, count_));
  ++count_;
  return added;
}

void WatchedMap::drop(FrameVerdict verdict, const std::optional<Pose>& T_world_camera) {
  (void)planner_.drop(verdict, T_world_camera);
}

void WatchedMap::answer(std::span<const Pose> asked, const std::optional<Pose>& T_world_camera) {
  if (asked.empty()) return;
  if (T_world_camera && is_among(*T_world_camera, asked, ReachRegion::Tolerance{})) return;
  planner_.tried(asked.front(), false);
}

Proposal WatchedMap::generate(const Pose&) {
  const FrameCounts& frames = planner_.frames();
  if (frames.empty() || !is_in_map(frames.begin()->first)) return {};
  proposal_ = &planner_.propose();
  next_ = next_views({}, *proposal_, next_.model);
  return *proposal_;
}

std::optional<DecisionMaking::Decision> WatchedMap::decide(const Pose&,
                                                           std::span<const Candidate>) {
  const RankConfig config{.cost_per_metre = options_.proposal.costs.per_metre, .together = true};
  next_ = next_views(planner_.rank(options_.top, config), *proposal_, next_.model);
  return planner_.decision();
}

void WatchedMap::save() const { planner_.save(state_); }

}  // namespace viewgain::app
