// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "program/commands/model/recorded_views.hpp"

#include <utility>

#include "program/commands/frames/frame_tally.hpp"
#include "viewgain/formats/frames.hpp"
#include "viewgain/planner_mesh/mesh_area.hpp"
#include "viewgain/support/stopwatch.hpp"

namespace viewgain::app {
namespace {

double sum_of(const StageSeconds& seconds) {
  double sum = 0;
  for (const auto& [stage, value] : seconds) sum += value;
  return sum;
}

}  // namespace

RecordedViews::RecordedViews(FrameMap& map,
                             std::optional<std::map<std::size_t, FrameRegistration>> registrations,
                             std::string on_contradiction)
    : map_(map),
      registrations_(std::move(registrations)),
      on_contradiction_(std::move(on_contradiction)) {}

const FrameRegistration* RecordedViews::registration(std::size_t index) const {
  if (!registrations_) return nullptr;
  const auto found = registrations_->find(index);
  return found == registrations_->end() ? nullptr : &found->second;
}

bool RecordedViews::is_refused(std::size_t index) const {
  const FrameRegistration* found = registration(index);
  return found != nullptr && leaves_out(*found, on_contradiction_);
}

void RecordedViews::add(std::size_t index) {
  ++asked_;
  const FrameRegistration* registered = registration(index);
  ViewRecord record;
  record.index = index;
  record.T_world_camera =
      registered != nullptr ? registered->T_world_camera : map_.folder().T_world_camera(index);
  MapUpdate update;
  if (is_refused(index)) {
    map_.drop(index, {FrameVerdict::contradicts,
                      map_.folder().frames().images[index].string() + ": " + registered->reason});
  } else {
    const Stopwatch watch;
    update = map_.add(index, record.T_world_camera,
                      registered != nullptr ? registered->pose_sigma() : PoseSigma{});
    readings_ += update.counts;
    jump_edge_removed_ += update.flying_pixels;
    for (const auto& [stage, value] : update.seconds) add_seconds(stage, value);
    add_seconds("read", watch.seconds() - sum_of(update.seconds));
    if (!is_in_map(update.verdict)) return;
  }
  record.progress = map_.scorer().progress();
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

Json RecordedViews::entry_json(std::size_t index) const {
  const ViewRecord& record = records_[index];
  const FrameFolder& folder = map_.folder();
  Json json{{"index", record.index},
            {"frame", folder.frames().images[record.index].filename().string()},
            {"pose", app::to_json(folder.T_world_camera(record.index))},
            {"generator", "recorded"},
            {"realised_gain", record.realised_gain},
            {"realised_area", new_areas_[index]},
            {"entropy_removed", record.progress.entropy_removed},
            {"unknown_voxels", record.progress.unknown_voxels},
            {"travelled", record.travelled},
            {"seconds", seconds_json(record.seconds)}};
  if (const FrameRegistration* found = registration(record.index)) {
    json["registration"] = app::to_json(*found);
  }
  return json;
}

Json RecordedViews::json(const SurfaceModel& model, const NextViews& next) const {
  const ViewRecord& last = records_.back();
  const bool is_whole = asked_ == map_.folder().size();
  Json run{{"map_hash", model.grid().content_hash()},
           {"stop_reason", is_whole ? "no_frames" : "interrupted"},
           {"views", records_.size()},
           {"frames", nullptr},
           {"carved", nullptr},
           {"bad", nullptr},
           {"readings", readings_.readings},
           {"readings_inside", readings_.readings_inside},
           {"masked_pixels", map_.masked_pixels()},
           {"jump_edge_removed", jump_edge_removed_},
           {"orthonormalized_poses", map_.folder().frames().orthonormalized},
           {"entropy_removed", last.progress.entropy_removed},
           {"unknown_voxels", last.progress.unknown_voxels},
           {"points", model.points().size()},
           {"triangles", model.surface().triangles.size()},
           {"surface_area", mesh_area(model.surface())},
           {"travelled", last.travelled}};
  run.update(frames_json(map_.counts()));
  if (registrations_) {
    std::vector<FrameRegistration> all;
    for (const auto& [index, one] : *registrations_) all.push_back(one);
    run["registration"] = registration_counts(all);
  }
  run["contradiction"] = map_.consistency_json();
  run.update(app::to_json(next));
  run["seconds"] = seconds_json(seconds_);
  run["per_view"] = Json::array();
  for (std::size_t i = 0; i < records_.size(); ++i) run["per_view"].push_back(entry_json(i));
  return run;
}

}  // namespace viewgain::app
