// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include "program/commands/study/results.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numbers>
#include <numeric>

#include "viewgain/planner/rank_views.hpp"
#include "viewgain/support/text.hpp"

namespace viewgain::app {
namespace {

constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

// What is not finite is null in JSON.
double number_of(const Json& value) { return value.is_number() ? value.get<double>() : kNone; }

// Of a run's stages, by view.
double deciding_seconds(const Json& json, std::size_t views) {
  double seconds = 0;
  for (const char* stage : {"candidates", "score"}) {
    if (json.at("seconds").contains(stage)) seconds += number_of(json.at("seconds").at(stage));
  }
  return views > 1 ? seconds / static_cast<double>(views - 1) : kNone;
}

// As CSV has it: with a comma, a quote or a line's end in quotes (RFC 4180); null: nothing.
std::string csv_text(const Json& value) {
  if (value.is_null()) return "";
  if (value.is_number_float()) {
    const double number = value.get<double>();
    return std::isfinite(number) ? short_text(number) : "";
  }
  if (!value.is_string()) return value.dump();
  const std::string text = value.get<std::string>();
  if (text.find_first_of(",\"\n") == std::string::npos) return text;
  std::string quoted = "\"";
  for (const char c : text) quoted.append(c == '"' ? "\"\"" : std::string(1, c));
  return quoted + "\"";
}

// Places from 1 on by rising value; equal values share the mean of theirs.
std::vector<double> ranks(std::span<const double> values) {
  std::vector<std::size_t> order(values.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::sort(order.begin(), order.end(),
            [&](std::size_t a, std::size_t b) { return values[a] < values[b]; });
  std::vector<double> places(values.size());
  for (std::size_t first = 0, last = 0; first < order.size(); first = last) {
    while (last < order.size() && !(values[order[first]] < values[order[last]])) ++last;
    const double place = 0.5 * static_cast<double>(first + 1 + last);
    for (std::size_t i = first; i < last; ++i) places[order[i]] = place;
  }
  return places;
}

// Two-sided p of the sum of weights of the positive differences, where either sign is as likely:
// the weights are 1, or twice the places by size, so that those of ties are whole.
double flip_test(std::span<const double> differences, bool by_size) {
  constexpr std::size_t kMostExact = 1'010'000;  // sums, 100 differences by size
  std::vector<double> sizes;
  std::vector<bool> is_positive;
  for (const double d : differences) {
    if (!std::isfinite(d) || d == 0) continue;
    sizes.push_back(std::abs(d));
    is_positive.push_back(d > 0);
  }
  std::vector<std::size_t> weights;
  std::size_t all = 0, sum = 0;
  double squares = 0;
  for (const double place : ranks(sizes)) {
    const std::size_t weight = by_size ? static_cast<std::size_t>(2 * place) : 1;
    if (is_positive[weights.size()]) sum += weight;
    all += weight;
    squares += static_cast<double>(weight * weight);
    weights.push_back(weight);
  }
  if (weights.size() * all > kMostExact) {
    const double off = static_cast<double>(sum) - 0.5 * static_cast<double>(all);
    return std::erfc(std::abs(off) / std::sqrt(0.5 * squares));
  }
  // How probable each sum is, with one difference more at a time.
  std::vector<double> probability(all + 1, 0.0);
  probability[0] = 1;
  for (const std::size_t weight : weights) {
    for (std::size_t s = all + 1; s-- > 0;) {
      probability[s] = 0.5 * (probability[s] + (s >= weight ? probability[s - weight] : 0));
    }
  }
  const auto tail = static_cast<std::ptrdiff_t>(std::min(sum, all - sum)) + 1;
  return std::min(1.0, 2 * std::accumulate(probability.begin(), probability.begin() + tail, 0.0));
}

// What 95 % of Student's t lie within. Its distribution is a finite sum in the angle
// atan(t / sqrt(freedom)) (Abramowitz and Stegun, 26.7.3 and 26.7.4).
double student_t(std::size_t freedom) {
  const bool is_odd = freedom % 2 == 1;
  const auto share_within = [&](double angle) {
    double sum = 0, term = is_odd ? std::cos(angle) : 1;
    for (std::size_t power = is_odd ? 1 : 0; power + 2 <= freedom; power += 2) {
      sum += term;
      term *= static_cast<double>(power + 1) / static_cast<double>(power + 2) *
              std::pow(std::cos(angle), 2);
    }
    sum *= std::sin(angle);
    return is_odd ? 2 / std::numbers::pi * (angle + sum) : sum;
  };
  double low = 0, high = 0.5 * std::numbers::pi;
  for (int i = 0; i < 60; ++i) {
    const double middle = 0.5 * (low + high);
    (share_within(middle) < 0.95 ? low : high) = middle;
  }
  return std::sqrt(static_cast<double>(freedom)) * std::tan(low);
}

}  // namespace

double ResultRow::counted_views_to(std::size_t goal) const {
  return static_cast<double>(views_to[goal].value_or(coverage_by_view.size() + 1));
}

ResultRow row_of(const StudyRun& run, const Json& json, std::size_t max_views) {
  ResultRow row;
  row.run = &run;
  row.views = json.at("views").get_ref<const Json::number_unsigned_t&>();
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

Json results_json(const StudySpec& spec, const std::vector<ResultRow>& rows) {
  Json results = Json::array();
  for (const ResultRow& row : rows) {
    const StudyRun& run = *row.run;
    const StudyPolicy& policy = spec.policies[run.policy];
    results.push_back({{"object", spec.objects[run.object].name},
                       {"policy", policy.policy},
                       {"gain", or_null(policy.gain)},
                       {"seed", run.seed},
                       {"sensor", run.sensor},
                       {"voxel", run.voxel},
                       {"size", run.size},
                       {"views", row.views},
                       {"decisions", row.decisions},
                       {"stop_reason", row.stop_reason},
                       {"views_to_80", row.views_to[0]},
                       {"views_to_90", row.views_to[1]},
                       {"views_to_95", row.views_to[2]},
                       {"metres_to_80", row.metres_to[0]},
                       {"metres_to_90", row.metres_to[1]},
                       {"metres_to_95", row.metres_to[2]},
                       {"auc", row.auc},
                       {"coverage_visible", row.coverage_visible},
                       {"coverage", row.coverage},
                       {"rms_error", row.rms_error},
                       {"consistency", row.consistency},
                       {"outliers", row.outliers},
                       {"travelled", row.travelled},
                       {"coverage_by_view", row.coverage_by_view},
                       {"hash", run.hash},
                       {"isa", row.isa},
                       {"deciding_seconds", row.deciding_seconds},
                       {"seconds", row.seconds}});
  }
  return results;
}

std::string results_csv(const Json& results) {
  std::string csv;
  const auto add_line = [&](const Json& row, bool is_head) {
    const std::size_t begin = csv.size();
    for (const auto& [key, value] : row.items()) {
      if (key == "coverage_by_view") continue;
      csv.append(csv.size() == begin ? "" : ",").append(is_head ? key : csv_text(value));
    }
    csv += "\n";
  };
  add_line(results.at(0), true);
  for (const Json& row : results) add_line(row, false);
  return csv;
}

MeanWithError mean_of(std::span<const double> values, std::span<const std::size_t> clusters) {
  constexpr double kNothing = std::numeric_limits<double>::quiet_NaN();
  MeanWithError result{0, kNothing, 0};
  for (const double value : values) {
    if (std::isfinite(value)) result.mean += value, ++result.count;
  }
  if (result.count == 0) return {kNothing, kNothing, 0};
  const auto n = static_cast<double>(result.count);
  result.mean /= n;
  const bool by_cluster = std::any_of(clusters.begin(), clusters.end(),
                                      [&](std::size_t c) { return c != clusters.front(); });
  std::map<std::size_t, double> sums;  // of deviations
  for (std::size_t i = 0; i < values.size(); ++i) {
    if (std::isfinite(values[i])) sums[by_cluster ? clusters[i] : i] += values[i] - result.mean;
  }
  const auto groups = static_cast<double>(sums.size());
  double squares = 0;
  for (const auto& [cluster, sum] : sums) squares += sum * sum;
  if (groups > 1) result.error = std::sqrt(groups / (groups - 1) * squares) / n;
  return result;
}

double interval_of(std::span<const double> values, std::span<const std::size_t> clusters) {
  std::map<std::size_t, std::vector<double>> groups;
  for (std::size_t i = 0; i < values.size(); ++i) {
    if (std::isfinite(values[i])) groups[clusters[i]].push_back(values[i]);
  }
  double squares = 0;
  std::size_t count = 0;
  for (const auto& [cluster, group] : groups) {
    const double mean = mean_of(group).mean;
    for (const double value : group) squares += (value - mean) * (value - mean);
    count += group.size();
  }
  const std::size_t freedom = count - groups.size();
  if (freedom == 0) return kNone;
  return student_t(freedom) * std::sqrt(squares / static_cast<double>(freedom * count));
}

double median_of(std::vector<double> values) {
  if (values.empty()) return std::numeric_limits<double>::quiet_NaN();
  std::sort(values.begin(), values.end());
  const std::size_t n = values.size();
  return 0.5 * (values[(n - 1) / 2] + values[n / 2]);
}

double sign_test(std::span<const double> differences) { return flip_test(differences, false); }
double signed_rank_test(std::span<const double> differences) {
  return flip_test(differences, true);
}

}  // namespace viewgain::app
