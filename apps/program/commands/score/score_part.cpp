// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include "program/commands/score/score_part.hpp"

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <utility>

#include "program/cli/flags/scene_sources.hpp"
#include "program/cli/values.hpp"
#include "viewgain/formats/reach_toml.hpp"
#include "viewgain/support/columns/mapped_poses.hpp"
#include "viewgain/support/columns/parts.hpp"
#include "viewgain/support/columns/score_job.hpp"
#include "viewgain/support/file_bytes.hpp"
#include "viewgain/support/hash64.hpp"
#include "viewgain/support/text.hpp"

namespace viewgain::app {
namespace {

std::string hash_of_file(const std::filesystem::path& path) {
  return "file " + hash_of(file_bytes(path));
}

ScoreSettings settings_of(const ScoreOptions& options, const GainConfig& config) {
  ScoreSettings settings{config, options.gain, options.support_plane};
  auto& further = settings.further;
  if (options.semantics != "paper") further["semantics"] = {options.semantics};
  if (options.feasible != "off") further["feasible"] = {options.feasible};
  if (options.object_size) further["object_size"] = {exact_text(*options.object_size)};
  if (options.approximate) further["approximate"] = {exact_text(*options.approximate)};
  if (options.approximate || options.race) further["seed"] = {std::to_string(options.seed)};
  if (options.race) further["race"] = {std::to_string(options.top)};
  if (options.deadline) further["deadline"] = {exact_text(*options.deadline)};
  if (options.set) further["set"] = {std::to_string(*options.set)};
  if (!options.body.empty()) further["body"] = {options.body};
  if (options.costs.per_metre > 0) {
    further["cost_per_metre"] = {exact_text(options.costs.per_metre)};
  }
  if (!options.costs.file.empty()) further["costs"] = {hash_of_file(options.costs.file)};
  for (const std::string& obstacle : options.obstacles) {
    further["obstacle"].push_back(is_obstacle_file(obstacle) ? hash_of_file(obstacle) : obstacle);
  }
  if (!options.hazard.empty()) {
    further["hazard"] = {is_hazard_file(options.hazard) ? hash_of_file(options.hazard)
                                                        : options.hazard};
  }
  if (!options.reach.empty()) {
    further["reach"] = {hash_of_file(options.reach)};
    if (const auto poses = reach_poses_file(options.reach)) {
      further["reach_poses"] = {hash_of_file(*poses)};
    }
  }
  return settings;
}

Table whole_rows(const Table& table, const PoseSource& source) {
  const bool has_costs = !source.costs.empty();
  Table whole{with_pose_columns(table.columns)};
  if (has_costs) whole.columns.insert(whole.columns.begin() + 1, {"worth", ColumnType::real});
  const std::size_t bytes = row_bytes(table.columns), index_bytes = sizeof(std::int64_t);
  whole.bytes.reserve(table.size() * row_bytes(whole.columns));
  for (std::size_t at = 0; at < table.bytes.size(); at += bytes) {
    const std::string_view row = std::string_view(table.bytes).substr(at, bytes);
    const auto index = static_cast<std::size_t>(value_at<std::int64_t>(row.data()));
    whole.bytes.append(row.substr(0, index_bytes));
    if (has_costs) whole.add(source.worth(index, value_at<double>(row.data() + index_bytes)));
    whole.bytes.append(row.substr(index_bytes));
    for (const double number : row_of_pose(source.at(index))) whole.add(number);
  }
  return whole;
}

}  // namespace

Shard shard_of(const ScoreOptions& options) {
  if (options.shard.empty()) return {};
  for (const auto& [other, is_given] :
       {std::pair("--race", options.race), std::pair("--set", options.set.has_value()),
        std::pair("--picture", !options.picture.empty()),
        std::pair("--report", !options.report.empty())}) {
    if (!is_given) continue;
    refuse(std::string("--shard does not go with ") + other + ", which is about all poses");
  }
  if (options.out.empty()) refuse("--shard needs --out FILE for the part");
  return parse_shard(options.shard);
}

void write_scores(const ScoreOptions& options, const GainConfig& config, const Table& table,
                  const BeliefGrid& grid, const Sensor& sensor, const PoseSource& source,
                  std::string_view isa) {
  std::optional<PartHead> head;
  if (!options.shard.empty() || is_npy(options.out)) {
    head = head_of_job(grid.content_hash(), sensor, settings_of(options, config), isa, source.total,
                       source.hash);
    head->rows = source.rows;
    head->scored = table.size();
  }
  write_table(options.out, whole_rows(table, source), head);
}

}  // namespace viewgain::app
