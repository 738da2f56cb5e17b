// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include "viewgain/support/columns/score_job.hpp"

#include <algorithm>
#include <nlohmann/json.hpp>

#include "viewgain/formats/sensor_toml.hpp"
#include "viewgain/support/columns/mapped_poses.hpp"
#include "viewgain/support/hash64.hpp"
#include "viewgain/version.hpp"

namespace viewgain {
namespace {

using Json = nlohmann::ordered_json;

std::string settings_text(const ScoreSettings& settings) {
  const GainConfig& config = settings.config;
  Json json{{"gain", settings.gain},
            {"criterion", criterion_name(config.criterion)},
            {"stride", config.pixel_stride}};
  const auto add = [&](const char* key, const std::optional<double>& value) {
    if (value) json[key] = *value;
  };
  if (config.model == GainModel::combined) add("refinement_weight", config.refinement_weight);
  add("support_plane", settings.support_plane);
  add("prior_sigma", config.prior_sigma);
  add("min_range", config.min_range);
  add("max_range", config.max_range);
  for (const GainConfig::WeightRegion& region : config.weights) {
    json["weight"].push_back({region.box.min, region.box.max, region.weight});
  }
  for (const auto& [flag, values] : settings.further) json[flag] = values;
  return json.dump();
}

// A line of # must stay one.
std::string on_a_line(std::string text) {
  std::replace_if(
      text.begin(), text.end(), [](char c) { return c == '\n' || c == '\r'; }, ' ');
  return text;
}

}  // namespace

PartHead head_of_job(const std::string& map, const Sensor& sensor, const ScoreSettings& settings,
                     std::string_view isa, std::uint64_t poses, const std::string& poses_hash) {
  PartHead head;
  head.version = VIEWGAIN_VERSION;
  head.map = map;
  head.sensor = on_a_line(sensor.name) + " " + hash_of(sensor_toml(sensor));
  head.settings = settings_text(settings);
  head.isa = isa;
  head.poses = poses;
  head.poses_hash = poses_hash;
  return head;
}

std::vector<Column> gain_columns(GainModel model) {
  std::vector<Column> columns;
  for (const char* name :
       {"index", "gain", "exploration", "refinement", "posterior_entropy", "rays", "hits",
        "unknown_voxels", "occupied_voxels", "status", "area", "refinement_saturated"}) {
    columns.push_back(column_of(name));
  }
  if (model == GainModel::paper) columns.resize(columns.size() - 2);
  return columns;
}

std::vector<Column> with_pose_columns(std::vector<Column> columns) {
  for (const char* name : kPoseColumns) columns.push_back({name, ColumnType::real});
  return columns;
}

}  // namespace viewgain
