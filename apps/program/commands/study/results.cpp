// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include "program/commands/study/results.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "program/commands/study/statistics.hpp"
#include "viewgain/planner/rank_views.hpp"
#include "viewgain/support/text.hpp"

namespace viewgain::app {
namespace {

constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

// What is not finite is null in JSON.
double number_of(const Json& value) { return value.is_number() ? value.get<double>() : kNone; }

// The figures of a row that are numbers alike in results.csv and results.json, in their order.
struct RowFigure {
  const char* key;
  double ResultRow::*value;
};
constexpr std::array kFigures{RowFigure{"auc", &ResultRow::auc},
                              RowFigure{"coverage_visible", &ResultRow::coverage_visible},
                              RowFigure{"coverage", &ResultRow::coverage},
                              RowFigure{"rms_error", &ResultRow::rms_error},
                              RowFigure{"consistency", &ResultRow::consistency},
                              RowFigure{"outliers", &ResultRow::outliers},
                              RowFigure{"travelled", &ResultRow::travelled}};
constexpr std::array kViewsTo{"views_to_80", "views_to_90", "views_to_95"},
    kMetresTo{"metres_to_80", "metres_to_90", "metres_to_95"};
static_assert(kViewsTo.size() == kGoals.size() && kMetresTo.size() == kGoals.size());

// Of a run's stages, by view.
double deciding_seconds(const Json& json, std::size_t views) {
  double seconds = 0;
  for (const char* stage : {"candidates", "score"}) {
    if (json.at("seconds").contains(stage)) seconds += number_of(json.at("seconds").at(stage));
  }
  return views > 1 ? seconds / static_cast<double>(views - 1) : kNone;
}

// As CSV has it: with a comma, a quote or a line's end in quotes (RFC 4180).
std::string csv_text(const std::string& text) {
  if (text.find_first_of(",\"\n") == std::string::npos) return text;
  std::string quoted = "\"";
  for (const char c : text) quoted.append(c == '"' ? "\"\"" : std::string(1, c));
  return quoted + "\"";
}

// Which run a line is of.
std::string run_columns(const StudySpec& spec, const StudyRun& run) {
  const StudyPolicy& policy = spec.policies[run.policy];
  std::string columns = csv_text(spec.objects[run.object].name);
  columns.append(",")
      .append(policy.policy)
      .append(",")
      .append(policy.gain)
      .append(",")
      .append(std::to_string(run.seed))
      .append(",");
  columns.append(csv_text(run.sensor)).append(",").append(short_text(run.voxel)).append(",");
  if (run.size) columns.append(short_text(*run.size));
  return columns;
}

}  // namespace

double ResultRow::counted_views_to(std::size_t goal) const {
  return static_cast<double>(views_to[goal].value_or(coverage_by_view.size() + 1));
}

ResultRow row_of(const StudyRun& run, const Json& json, std::size_t max_views) {
  ResultRow row;
  row.run = &run;
  row.views = json.at("views").get<std::size_t>();
  row.stop_reason = json.at("stop_reason").get<std::string>();
  (void)json.at("per_view").at(0);  // there is one
  for (const Json& view : json.at("per_view")) {
    const double coverage = number_of(view.at("coverage_visible"));
    row.coverage_by_view.push_back(std::isnan(coverage) ? 0 : coverage);
    const Json& generator = view.at("generator");
    row.decisions += generator != Json("start") && generator != Json(std::string(kPlanned)) ? 1 : 0;
  }
  row.coverage_by_view.resize(max_views, row.coverage_by_view.back());
  for (std::size_t goal = 0; goal < kGoals.size(); ++goal) {
    for (std::size_t view = row.coverage_by_view.size(); view > 0; --view) {
      if (row.coverage_by_view[view - 1] >= kGoals[goal]) row.views_to[goal] = view;
    }
    const std::size_t last = std::min(row.views_to[goal].value_or(row.views), row.views) - 1;
    row.metres_to[goal] = number_of(json.at("per_view").at(last).at("travelled"));
  }
  row.auc = mean_of(row.coverage_by_view).mean;
  row.coverage_visible = row.coverage_by_view.back();
  row.coverage = number_of(json.at("coverage"));
  row.rms_error = number_of(json.at("rms_error"));
  row.consistency = number_of(json.at("consistency"));
  row.outliers = number_of(json.at("outliers"));
  row.travelled = number_of(json.at("travelled"));
  row.deciding_seconds = deciding_seconds(json, row.views);
  row.seconds = number_of(json.at("seconds").at("total"));
  row.isa = json.at("isa").get<std::string>();
  return row;
}

std::string results_csv(const StudySpec& spec, const std::vector<ResultRow>& rows) {
  std::string csv =
      "object,policy,gain,seed,sensor,voxel,size,views,decisions,stop_reason,views_to_80,"
      "views_to_90,views_to_95,metres_to_80,metres_to_90,metres_to_95,auc,coverage_visible,"
      "coverage,"
      "rms_error,consistency,outliers,travelled,hash,isa,"
      "deciding_seconds,seconds\n";
  for (const ResultRow& row : rows) {
    const StudyRun& run = *row.run;
    csv.append(run_columns(spec, run));
    csv.append(",").append(std::to_string(row.views));
    csv.append(",").append(std::to_string(row.decisions)).append(",").append(row.stop_reason);
    for (const auto& views : row.views_to) {
      csv.append(",").append(views ? std::to_string(*views) : "nan");
    }
    for (const double metres : row.metres_to) csv.append(",").append(exact_text(metres));
    for (const RowFigure& figure : kFigures) csv.append(",").append(exact_text(row.*figure.value));
    csv.append(",").append(run.hash).append(",").append(row.isa);
    csv.append(",").append(exact_text(row.deciding_seconds));
    csv.append(",").append(exact_text(row.seconds)).append("\n");
  }
  return csv;
}

Json results_json(const StudySpec& spec, const std::vector<ResultRow>& rows) {
  Json results = Json::array();
  for (const ResultRow& row : rows) {
    const StudyRun& run = *row.run;
    const StudyPolicy& policy = spec.policies[run.policy];
    Json json{{"object", spec.objects[run.object].name},
              {"policy", policy.policy},
              {"gain", or_null(policy.gain)},
              {"seed", run.seed},
              {"sensor", run.sensor},
              {"voxel", run.voxel},
              {"size", run.size},
              {"views", row.views},
              {"decisions", row.decisions},
              {"stop_reason", row.stop_reason}};
    for (std::size_t goal = 0; goal < kGoals.size(); ++goal) {
      json[kViewsTo[goal]] = row.views_to[goal];
      json[kMetresTo[goal]] = row.metres_to[goal];
    }
    for (const RowFigure& figure : kFigures) json[figure.key] = row.*figure.value;
    json["coverage_by_view"] = row.coverage_by_view;
    json["hash"] = run.hash;
    json["isa"] = row.isa;
    json["deciding_seconds"] = row.deciding_seconds;
    json["seconds"] = row.seconds;
    results.push_back(std::move(json));
  }
  return results;
}

}  // namespace viewgain::app
