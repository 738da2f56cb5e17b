// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include "program/commands/score/score_part.hpp"

#include <filesystem>
#include <optional>
#include <string>
#include <utility>

#include "program/cli/flags/hazard_source.hpp"
#include "program/cli/flags/obstacle_source.hpp"
#include "program/cli/flags/text_hash.hpp"
#include "program/cli/json.hpp"
#include "viewgain/core/error.hpp"
#include "viewgain/formats/reach_toml.hpp"
#include "viewgain/formats/sensor_toml.hpp"
#include "viewgain/support/columns/part_reader.hpp"
#include "viewgain/support/columns/part_writer.hpp"
#include "viewgain/support/file_bytes.hpp"
#include "viewgain/version.hpp"

namespace viewgain::app {
namespace {

std::string hash_of_file(const std::filesystem::path& path) {
  return "file " + hash_of(file_bytes(path));
}

// Flags that were not given stand for the same in all parts and are left out.
Json settings_of(const ScoreOptions& options) {
  Json settings{{"gain", options.gain},
                {"semantics", options.semantics},
                {"criterion", options.criterion},
                {"stride", options.stride},
                {"feasible", options.feasible}};
  const auto add = [&](const char* key, const std::optional<double>& value) {
    if (value) settings[key] = *value;
  };
  add("refinement_weight", options.refinement_weight);
  add("object_size", options.object_size);
  add("support_plane", options.support_plane);
  add("prior_sigma", options.prior_sigma);
  add("min_range", options.min_range);
  add("max_range", options.max_range);
  add("approximate", options.approximate);
  if (options.approximate || options.race) settings["seed"] = options.seed;
  if (options.race) settings["race"] = options.top;
  if (options.set) settings["set"] = *options.set;
  if (!options.body.empty()) settings["body"] = options.body;
  for (const std::string& weight : options.weights) settings["weight"].push_back(weight);
  for (const std::string& obstacle : options.obstacles) {
    settings["obstacle"].push_back(is_obstacle_file(obstacle) ? hash_of_file(obstacle) : obstacle);
  }
  if (!options.hazard.empty()) {
    settings["hazard"] =
        is_hazard_file(options.hazard) ? hash_of_file(options.hazard) : options.hazard;
  }
  if (!options.reach.empty()) {
    settings["reach"] = hash_of_file(options.reach);
    if (const auto poses = reach_poses_file(options.reach)) {
      settings["reach_poses"] = hash_of_file(*poses);
    }
  }
  return settings;
}

// A line of # must stay one.
std::string on_a_line(std::string text) {
  for (char& c : text) {
    if (c == '\n' || c == '\r') c = ' ';
  }
  return text;
}

PartHead head_of(const ScoreOptions& options, const BeliefGrid& grid, const Sensor& sensor,
                 const PoseSource& source, std::string_view isa, std::uint64_t scored) {
  PartHead head;
  head.version = VIEWGAIN_VERSION;
  head.map = grid.content_hash();
  head.sensor = on_a_line(sensor.name) + " " + hash_of(sensor_toml(sensor));
  head.settings = settings_of(options).dump();
  head.isa = isa;
  head.poses = source.total;
  head.poses_hash = source.hash;
  head.rows = source.rows;
  head.scored = scored;
  return head;
}

}  // namespace

RowSelection selection_of(const ScoreOptions& options) {
  RowSelection selection = RowSelection::parse(options.shard, options.rows);
  if (selection.is_all()) return selection;
  const std::string flag = options.shard.empty() ? "--rows" : "--shard";
  for (const auto& [other, is_given] :
       {std::pair("--race", options.race), std::pair("--set", options.set.has_value()),
        std::pair("--picture", !options.picture.empty()),
        std::pair("--report", !options.report.empty())}) {
    if (!is_given) continue;
    throw Error(ErrorCode::invalid_argument,
                flag + " does not go with " + other + ", which is about all poses");
  }
  if (options.out.empty()) {
    throw Error(ErrorCode::invalid_argument, flag + " needs --out FILE for the part");
  }
  return selection;
}

void write_scores(const ScoreOptions& options, const Table& table, const BeliefGrid& grid,
                  const Sensor& sensor, const PoseSource& source, std::string_view isa) {
  const bool is_part = !options.shard.empty() || !options.rows.empty();
  std::optional<PartHead> head;
  if (is_part || is_npy(options.out)) {
    head = head_of(options, grid, sensor, source, isa, table.size());
  }
  write_table(options.out, table, head);
}

}  // namespace viewgain::app
