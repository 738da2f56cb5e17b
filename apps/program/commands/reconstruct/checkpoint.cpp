// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "program/commands/reconstruct/checkpoint.hpp"

#include <utility>

#include "program/cli/values.hpp"
#include "program/commands/file_format.hpp"
#include "viewgain/core/error.hpp"
#include "viewgain/support/file_bytes.hpp"

namespace viewgain::app {
namespace {

using Decision = DecisionMaking::Decision;

constexpr std::pair<const char*, double Decision::*> kFigures[]{
    {"gain", &Decision::gain},
    {"gain_per_voxel", &Decision::gain_per_voxel},
    {"area", &Decision::area},
    {"best_area", &Decision::best_area},
    {"worth", &Decision::worth}};

}  // namespace

Checkpoint::Checkpoint(RunFolder& folder, const Json& head, bool resume)
    : folder_(folder), json_(Json::parse(dumped(head))) {
  json_["decisions"] = Json::array();
  if (resume) file_ = folder.last_checkpoint().string();
  if (!file_.empty()) {
    Json last;
    try {
      last = Json::parse(folder_file_bytes(file_));
      check_format(file_, last);
      for (std::size_t i = 0; i < last.at("decisions").size(); ++i) {
        const Json& decided = last.at("decisions").at(i);
        (void)decided.at("map_hash").get<std::string>();
        json_["decisions"].push_back(decided);
        (void)decision(i);
      }
    } catch (const Json::exception& error) {
      throw Error(ErrorCode::format, file_ + ": the file is not a checkpoint: " + error.what());
    }
    if (json_.dump() != last.dump()) {
      refuse(file_ +
             ": the run has other settings, or another version of the program made it. Without "
             "--resume, a new run starts");
    }
  }
  folder_.write_checkpoint(json_.dump(1) + "\n");
}

std::optional<Decision> Checkpoint::decision(std::size_t index) const {
  const Json& decisions = json_.at("decisions");
  if (index >= decisions.size()) return std::nullopt;
  const Json& json = decisions.at(index);
  Decision decision;
  decision.candidate = json.at("candidate").get_ref<const Json::number_unsigned_t&>();
  for (const auto& [key, figure] : kFigures) {
    if (!json.at(key).is_null()) decision.*figure = json.at(key).get<double>();
  }
  return decision;
}

void Checkpoint::add_view(const ViewRecord& record, const std::string& map_hash) {
  Json& decisions = json_["decisions"];
  if (record.index < decisions.size()) {
    if (decisions[record.index]["map_hash"].get<std::string>() == map_hash) return;
    refuse(file_ + ": the map after view " + std::to_string(record.index) +
           " differs from the saved map. Has a file changed? Without --resume, a new run starts");
  }
  if (!record.decision) return;
  Json json{{"map_hash", map_hash}, {"candidate", record.decision->candidate}};
  for (const auto& [key, figure] : kFigures) json[key] = (*record.decision).*figure;
  decisions.push_back(std::move(json));
  folder_.write_checkpoint(json_.dump(1) + "\n");
  folder_.keep();
}

std::optional<Decision> ResumedDecision::decide(const Pose& T_world_camera,
                                                std::span<const Candidate> candidates) {
  const std::optional<Decision> known = known_.decision(view_++);
  return known && !remembers_ ? known : other_.decide(T_world_camera, candidates);
}

}  // namespace viewgain::app
