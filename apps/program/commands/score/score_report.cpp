// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include "program/commands/score/score_report.hpp"

#include <cmath>
#include <cstdio>
#include <limits>
#include <string_view>

#include "program/cli/flags/gain_names.hpp"
#include "program/cli/values.hpp"
#include "show/report/score_page.hpp"
#include "viewgain/formats/sensor_toml.hpp"
#include "viewgain/support/pose_numbers.hpp"

namespace viewgain::app {
namespace {

// Null if the model does not count such voxels.
Json unknown_voxels(const ViewGain& view, GainModel model) {
  return model == GainModel::paper ? Json(view.unknown_voxels) : Json();
}
Json occupied_voxels(const ViewGain& view, GainModel model) {
  return model != GainModel::surface ? Json(view.occupied_voxels) : Json();
}

Table table_of(const ScoredViews& views, GainModel model) {
  const bool has_area = model != GainModel::paper;
  Table table{{{"index", ColumnType::row}}};
  for (const char* name : {"gain", "exploration", "refinement", "posterior_entropy"}) {
    table.columns.push_back({name, ColumnType::real});
  }
  for (const char* name : {"rays", "hits", "unknown_voxels", "occupied_voxels"}) {
    table.columns.push_back({name, ColumnType::count});
  }
  table.columns.push_back({"status", ColumnType::status});
  if (has_area) table.columns.push_back({"area", ColumnType::real});
  if (has_area) table.columns.push_back({"refinement_saturated", ColumnType::real});
  table.bytes.reserve(views.gains.size() * row_bytes(table.columns));
  for (std::size_t i = 0; i < views.gains.size(); ++i) {
    const ViewGain& r = views.gains[i];
    table.add(static_cast<std::int64_t>(views.indices[i]));
    for (const double value : {r.gain, r.exploration, r.refinement, r.posterior_entropy}) {
      table.add(value);
    }
    for (const std::uint32_t value : {r.rays, r.hits, r.unknown_voxels, r.occupied_voxels}) {
      table.add(value);
    }
    table.add(r.status);
    if (!has_area) continue;
    table.add(r.area);
    table.add(r.refinement_saturated);
  }
  return table;
}

Table table_of(const Estimates& estimates) {
  Table table{{{"index", ColumnType::row},
               {"gain", ColumnType::real},
               {"standard_error", ColumnType::real}}};
  for (std::size_t i = 0; i < estimates.gains.size(); ++i) {
    table.add(static_cast<std::int64_t>(estimates.indices[i]));
    table.add(estimates.gains[i].gain);
    table.add(estimates.gains[i].standard_error);
  }
  return table;
}

Json entries(const ScoredViews& views, const PoseSource& poses, GainModel model) {
  Json list = Json::array();
  for (std::size_t rank = 0; rank < views.indices.size(); ++rank) {
    const ViewGain& r = views.gains[rank];
    list.push_back({{"index", views.indices[rank]},
                    {"gain", r.gain},  // a NaN becomes null
                    {"worth", poses.worth(views.indices[rank], r.gain)},
                    {"exploration", r.exploration},
                    {"refinement", r.refinement},
                    {"posterior_entropy", r.posterior_entropy},
                    {"area", r.area},
                    {"refinement_saturated", r.refinement_saturated},
                    {"rays", r.rays},
                    {"hits", r.hits},
                    {"unknown_voxels", unknown_voxels(r, model)},
                    {"occupied_voxels", occupied_voxels(r, model)},
                    {"status", view_status_name(r.status)},
                    {"T_world_camera", to_json(poses.poses.at(views.indices[rank]))}});
  }
  return list;
}

Json entries(const Estimates& estimates, const PoseSource& poses) {
  Json list = Json::array();
  for (const std::size_t i : estimates.best) {
    list.push_back({{"index", estimates.indices[i]},
                    {"gain", estimates.gains[i].gain},
                    {"worth", poses.worth(estimates.indices[i], estimates.gains[i].gain)},
                    {"standard_error", estimates.gains[i].standard_error},
                    {"T_world_camera", to_json(poses.poses.at(estimates.indices[i]))}});
  }
  return list;
}

// Prints only the columns that the gain has.
void print_rows(const ScoredViews& views, const PoseSource& poses, GainModel model) {
  const bool by_paper = model == GainModel::paper, refines = model == GainModel::combined;
  const bool has_costs = !poses.costs.empty();
  std::printf("%4s %8s %12s", "rank", "index", "gain");
  if (has_costs) std::printf(" %12s", "worth");
  if (by_paper) std::printf(" %12s %12s", "exploration", "refinement");
  if (!by_paper) std::printf(" %12s", "area [m^2]");
  if (refines) std::printf(" %20s", "refinement_saturated");
  std::printf(" %8s", "hits");
  if (by_paper) std::printf(" %9s %9s", "unknown", "occupied");
  std::printf("  %-26s %s\n", "eye x y z [m]", "status");
  for (std::size_t rank = 0; rank < views.indices.size(); ++rank) {
    const std::size_t i = views.indices[rank];
    const ViewGain& r = views.gains[rank];
    const Eigen::Vector3d eye = poses.poses.at(i).translation();
    std::printf("%4zu %8zu %12.6g", rank + 1, i, r.gain);
    if (has_costs) std::printf(" %12.6g", poses.worth(i, r.gain));
    if (by_paper) std::printf(" %12.6g %12.6g", r.exploration, r.refinement);
    if (!by_paper) std::printf(" %12.6g", r.area);
    if (refines) std::printf(" %20.6g", r.refinement_saturated);
    std::printf(" %8u", r.hits);
    if (by_paper) std::printf(" %9u %9u", r.unknown_voxels, r.occupied_voxels);
    std::printf("  %8.3f %8.3f %8.3f %s\n", eye.x(), eye.y(), eye.z(),
                std::string(view_status_name(r.status)).c_str());
  }
}

void print_rows(const Estimates& estimates, const PoseSource& poses) {
  const bool has_costs = !poses.costs.empty();
  std::printf("%4s %8s %12s", "rank", "index", "gain");
  if (has_costs) std::printf(" %12s", "worth");
  std::printf(" %14s\n", "standard error");
  for (std::size_t rank = 0; rank < estimates.best.size(); ++rank) {
    const ApproximateGain& r = estimates.gains[estimates.best[rank]];
    const std::size_t i = estimates.indices[estimates.best[rank]];
    std::printf("%4zu %8zu %12.6g", rank + 1, i, r.gain);
    if (has_costs) std::printf(" %12.6g", poses.worth(i, r.gain));
    std::printf(" %14.3g\n", r.standard_error);
  }
}

// Number of poses with a known gain, from some or all of their rays. A deadline can leave poses
// without one.
std::size_t looked_at(const Scores& scores) {
  return scores.set_gain ? scores.candidates
                         : std::max(scores.estimated, scores.scored.gains.size());
}

}  // namespace

std::optional<std::size_t> Scores::winner() const {
  if (estimates && !estimates->best.empty()) return estimates->indices[estimates->best.front()];
  return best.indices.empty() ? std::nullopt : std::optional(best.indices.front());
}

Table table_of(const Scores& scores, GainModel model) {
  return scores.estimates ? table_of(*scores.estimates) : table_of(scores.scored, model);
}

Table with_poses(const Table& table, const PoseSource& source) {
  const bool has_costs = !source.costs.empty();
  Table whole{table.columns};
  for (const char* name : kPoseColumns) whole.columns.push_back({name, ColumnType::real});
  if (has_costs) whole.columns.insert(whole.columns.begin() + 1, {"worth", ColumnType::real});
  const std::size_t bytes = row_bytes(table.columns), index_bytes = sizeof(std::int64_t);
  whole.bytes.reserve(table.size() * row_bytes(whole.columns));
  for (std::size_t at = 0; at < table.bytes.size(); at += bytes) {
    const std::string_view row = std::string_view(table.bytes).substr(at, bytes);
    const auto index = static_cast<std::size_t>(value_at<std::int64_t>(row.data()));
    whole.bytes.append(row.substr(0, index_bytes));
    if (has_costs) whole.add(source.worth(index, value_at<double>(row.data() + index_bytes)));
    whole.bytes.append(row.substr(index_bytes));
    for (const double number : numbers_of_pose(source.poses.at(index))) whole.add(number);
  }
  return whole;
}

Json ScoreReport::summary() const {
  return {{"poses", source.poses.size()},
          {"dropped", scores.dropped},
          {"poses_estimated", scores.estimated},
          {"poses_scored", scores.scored.gains.size()},
          {"rays_traced", scores.rays_traced},
          {"rays_per_pose", evaluator.rays_per_pose()},
          {"threads", evaluator.num_threads()},
          {"isa", evaluator.scene().isa()},
          {"voxel_size", grid.voxel_size()},
          {"voxels", grid.voxel_count()},
          {"sensor", sensor.name},
          {"gain_model", gain_model_name(model)},
          {"gain_unit", gain_unit(model, parse_criterion(criterion))},
          {"criterion", criterion},
          {"prior_sigma", evaluator.prior_sigma()},
          {"orthonormalized_poses", source.orthonormalized},
          {"seconds", seconds},
          {"poses_per_second", static_cast<double>(looked_at(scores)) / seconds},
          {"rays_per_second", static_cast<double>(scores.rays_traced) / seconds}};
}

void ScoreReport::print_json() const {
  Json json = summary();
  json["best"] =
      scores.estimates ? entries(*scores.estimates, source) : entries(scores.best, source, model);
  if (scores.set_gain) {
    json["set_gain"] = *scores.set_gain;
    json["set_gain_by_best_alone"] = scores.set_gain_by_best_alone;
  }
  app::print_json(json);
}

void ScoreReport::print_table() const {
  std::printf("%s gain, %s, sensor %s, prior sigma %.4g m, gains in %s\n",
              std::string(gain_model_name(model)).c_str(), criterion.c_str(),
              printable(sensor.name).c_str(), evaluator.prior_sigma(),
              std::string(gain_unit(model, parse_criterion(criterion))).c_str());
  print_mended(source.orthonormalized);
  if (!scores.dropped.empty()) {
    std::printf("%zu of %zu poses scored; dropped: %s\n", scores.candidates, source.poses.size(),
                counts_text(scores.dropped).c_str());
  }
  if (scores.estimates) {
    print_rows(*scores.estimates, source);
  } else {
    print_rows(scores.best, source, model);
  }
  if (scores.set_gain) {
    std::printf(
        "gain of the set: %.6g; lower bound, if each voxel counts only for its best view: %.6g\n",
        *scores.set_gain, scores.set_gain_by_best_alone);
  }
  const std::size_t poses = scores.candidates, in_full = scores.scored.gains.size();
  const int threads = evaluator.num_threads();
  std::printf(
      "%s poses in %.3f s: %.0f poses/s, %s rays/s, %s rays per pose, %s voxels, %d %s, %s\n",
      with_commas(poses).c_str(), seconds, static_cast<double>(looked_at(scores)) / seconds,
      with_unit(static_cast<double>(scores.rays_traced) / seconds).c_str(),
      with_commas(evaluator.rays_per_pose()).c_str(), with_commas(grid.voxel_count()).c_str(),
      threads, threads == 1 ? "thread" : "threads", std::string(evaluator.scene().isa()).c_str());
  if (in_full < poses) {
    std::printf("%s poses estimated, %s scored with all rays; %s rays traced\n",
                with_commas(scores.estimated).c_str(), with_commas(in_full).c_str(),
                with_commas(scores.rays_traced).c_str());
  }
}

Json ScoreReport::page(const std::string& title) const {
  constexpr std::size_t kRows = 1000, kShown = 10;
  std::vector<ViewGain> ranked(source.poses.size());
  for (ViewGain& gain : ranked) gain.gain = std::numeric_limits<double>::quiet_NaN();
  const bool in_full = !scores.estimates;
  const ScoredViews& full = scores.scored;
  for (std::size_t k = 0; k < full.indices.size(); ++k) ranked[full.indices[k]] = full.gains[k];
  for (std::size_t k = 0; !in_full && k < scores.estimates->gains.size(); ++k) {
    ranked[scores.estimates->indices[k]].gain = scores.estimates->gains[k].gain;
  }
  const bool by_area = model != GainModel::paper && in_full;
  const bool by_paper = model == GainModel::paper && in_full;
  const bool has_costs = !source.costs.empty();
  std::vector<double> gains, areas;
  std::vector<ViewGain> by_worth = ranked;
  for (std::size_t i = 0; i < ranked.size(); ++i) {
    gains.push_back(ranked[i].gain);
    by_worth[i].gain = source.worth(i, ranked[i].gain);
    if (by_area) areas.push_back(ranked[i].area);
  }
  Json columns{"pose", "gain"}, rows = Json::array();
  if (has_costs) columns.push_back("worth");
  if (by_area) columns.push_back("area");
  if (in_full) columns.push_back("hits");
  if (by_paper) columns.push_back("unknown");
  if (by_paper) columns.push_back("occupied");
  std::vector<std::size_t> shown;
  const std::vector<std::size_t> order =
      scores.set_gain ? full.indices : best_indices(by_worth, kRows);
  for (const std::size_t i : order) {
    const ViewGain& r = ranked[i];
    if (std::isnan(r.gain)) break;
    Json row{i, r.gain};
    if (has_costs) row.push_back(by_worth[i].gain);
    if (by_area) row.push_back(r.area);
    if (in_full) row.push_back(r.hits);
    if (by_paper) row.push_back(r.unknown_voxels);
    if (by_paper) row.push_back(r.occupied_voxels);
    rows.push_back(std::move(row));
    if (shown.size() < kShown) shown.push_back(i);
  }
  const ScorePage page{title,
                       criterion,
                       evaluator,
                       sensor,
                       source.poses,
                       std::move(gains),
                       std::move(areas),
                       full.indices,
                       std::move(columns),
                       std::move(rows),
                       std::move(shown),
                       {{"sensor", sensor_toml(sensor)}},
                       summary()};
  return page.json();
}

}  // namespace viewgain::app
