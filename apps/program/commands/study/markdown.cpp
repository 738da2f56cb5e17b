// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include "program/commands/study/markdown.hpp"

#include <cmath>
#include <cstdio>
#include <functional>
#include <set>
#include <utility>

#include "program/commands/study/statistics.hpp"
#include "viewgain/support/text.hpp"

namespace viewgain::app {
namespace {

using Rows = std::vector<const ResultRow*>;
using Figure = std::function<double(const ResultRow&)>;

std::string fixed(double value, int digits) {
  if (!std::isfinite(value)) return "-";
  std::array<char, 64> text{};
  std::snprintf(text.data(), text.size(), "%.*f", digits, value);
  return text.data();
}

std::vector<double> figures(const Rows& rows, const Figure& figure) {
  std::vector<double> values;
  for (const ResultRow* row : rows) values.push_back(figure(*row));
  return values;
}

Figure views_to(std::size_t goal) {
  return [goal](const ResultRow& row) { return row.counted_views_to(goal); };
}

double auc(const ResultRow& row) { return row.auc; }
double rms_mm(const ResultRow& row) { return 1e3 * row.rms_error; }

// Runs of one sensor, voxel and size: what can be compared.
struct Group {
  const StudySpec& spec;
  Rows rows;

  [[nodiscard]] Rows of(std::size_t policy) const {
    Rows some;
    for (const ResultRow* row : rows) {
      if (row->run->policy == policy) some.push_back(row);
    }
    return some;
  }
};

std::string cell(const MeanWithError& value, int digits) { return fixed(value.mean, digits); }

std::string means(const Group& group) {
  std::string text =
      "| policy | to 80 % | to 90 % | to 95 % | not to 90 % | AUC | in the end | RMS [mm] | "
      "consistency | way [m] | time [s] |\n|---|---|---|---|---|---|---|---|---|---|---|\n";
  for (std::size_t policy = 0; policy < group.spec.policies.size(); ++policy) {
    const Rows rows = group.of(policy);
    std::size_t missed = 0;
    for (const ResultRow* row : rows) missed += row->views_to[1] ? 0 : 1;
    text.append("| ").append(group.spec.policies[policy].name);
    for (std::size_t goal = 0; goal < kGoals.size(); ++goal) {
      text.append(" | ").append(cell(mean_of(figures(rows, views_to(goal))), 2));
    }
    text.append(" | ")
        .append(std::to_string(missed))
        .append(" of ")
        .append(std::to_string(rows.size()));
    text.append(" | ").append(cell(mean_of(figures(rows, auc)), 3));
    const auto in_the_end = [](const ResultRow& row) { return 100 * row.coverage_visible; };
    text.append(" | ").append(cell(mean_of(figures(rows, in_the_end)), 1)).append(" %");
    text.append(" | ").append(cell(mean_of(figures(rows, rms_mm)), 2));
    const auto member = [](double ResultRow::*m) {
      return [m](const ResultRow& row) { return row.*m; };
    };
    text.append(" | ").append(cell(mean_of(figures(rows, member(&ResultRow::consistency))), 2));
    text.append(" | ").append(cell(mean_of(figures(rows, member(&ResultRow::travelled))), 1));
    text.append(" | ")
        .append(cell(mean_of(figures(rows, member(&ResultRow::seconds))), 1))
        .append(" |\n");
  }
  return text;
}

// Mean difference ± standard error (wins-ties-losses); both lists run by run.
std::string difference(const Rows& of, const Rows& against, const Figure& figure, int digits,
                       bool more_is_better) {
  const std::vector<double> a = figures(of, figure), b = figures(against, figure);
  std::vector<double> differences;
  std::array<std::size_t, 3> count{};
  for (std::size_t i = 0; i < a.size(); ++i) {
    const double d = a[i] - b[i];
    differences.push_back(d);
    if (!std::isfinite(d)) continue;
    const double better = more_is_better ? d : -d;
    ++count[better > 0 ? 0 : better < 0 ? 2 : 1];
  }
  const MeanWithError mean = mean_of(differences);
  std::string text = fixed(mean.mean, digits);
  text.append(" ± ").append(fixed(mean.error, digits)).append(" (");
  text.append(std::to_string(count[0])).append("-").append(std::to_string(count[1]));
  return text.append("-").append(std::to_string(count[2])).append(")");
}

std::string pairs(const Group& group) {
  const StudySpec& spec = group.spec;
  if (spec.policies.size() < 2) return "";
  std::string text = "\nPaired with " + spec.policies[spec.against].name +
                     ": mean difference ± standard error (wins-ties-losses)\n\n"
                     "| policy | to 80 % | to 90 % | to 95 % | AUC | RMS [mm] |\n"
                     "|---|---|---|---|---|---|\n";
  const Rows against = group.of(spec.against);
  for (std::size_t policy = 0; policy < spec.policies.size(); ++policy) {
    if (policy == spec.against) continue;
    const Rows of = group.of(policy);
    text.append("| ").append(spec.policies[policy].name);
    for (std::size_t goal = 0; goal < kGoals.size(); ++goal) {
      text.append(" | ").append(difference(of, against, views_to(goal), 2, false));
    }
    text.append(" | ").append(difference(of, against, auc, 3, true));
    text.append(" | ").append(difference(of, against, rms_mm, 2, false)).append(" |\n");
  }
  return text;
}

std::string by_object(const Group& group) {
  const StudySpec& spec = group.spec;
  if (spec.objects.size() < 2) return "";
  std::string text = "\nAUC by object\n\n| policy |", line = "|---|";
  for (const StudyObject& object : spec.objects) {
    text.append(" ").append(object.name).append(" |");
    line += "---|";
  }
  text += "\n" + line + "\n";
  for (std::size_t policy = 0; policy < spec.policies.size(); ++policy) {
    text.append("| ").append(spec.policies[policy].name + " |");
    for (std::size_t object = 0; object < spec.objects.size(); ++object) {
      Rows rows = group.of(policy);
      std::erase_if(rows, [&](const ResultRow* row) { return row->run->object != object; });
      text.append(" ").append(cell(mean_of(figures(rows, auc)), 3)).append(" |");
    }
    text += "\n";
  }
  return text;
}

// "0.81 ± 0.02"
std::string with_error(const std::vector<double>& values) {
  const MeanWithError mean = mean_of(values);
  return mean.count == 0 ? "-" : fixed(mean.mean, 2).append(" ± ").append(fixed(mean.error, 2));
}

// What a run's predictions say after so many views, or after any if `view` is 0.
std::vector<double> prediction_figures(const ResultRow& row, const char* key, std::size_t view) {
  std::vector<double> found;
  for (const auto& entry : row.prediction) {
    if (view != 0 && entry.at("view") != view) continue;
    if (entry.at(key).is_number()) found.push_back(entry.at(key).get<double>());
  }
  return found;
}

std::string prediction(const Group& group) {
  const StudySpec& spec = group.spec;
  if (spec.prediction.views.empty()) return "";
  std::string text =
      "\nWhat scores say of candidates, " + std::to_string(spec.prediction.candidates) +
      " each time: Spearman's rank correlation with the truly new samples after so many views, "
      "the mean of these, that with the entropy truly removed, and the favourite's share of what "
      "the best candidate brings; ± standard errors over runs. Where all scores are equal there is "
      "no figure; the means are over the others\n\n| policy |";
  std::string line = "|---|";
  for (const std::size_t view : spec.prediction.views) {
    text.append(" ").append(std::to_string(view)).append(" |");
    line += "---|";
  }
  text += " all | entropy | favourite |\n" + line + "---|---|---|\n";
  for (std::size_t policy = 0; policy < spec.policies.size(); ++policy) {
    const Rows rows = group.of(policy);
    const auto values = [&](const char* key, std::size_t view) {  // a figure a run; view 0: all
      std::vector<double> found;
      for (const ResultRow* row : rows) {
        // Views of one run are not independent: they count as one.
        found.push_back(mean_of(prediction_figures(*row, key, view)).mean);
      }
      return found;
    };
    if (mean_of(values("spearman_area", 0)).count == 0) continue;
    text.append("| ").append(spec.policies[policy].name);
    for (const std::size_t view : spec.prediction.views) {
      text.append(" | ").append(with_error(values("spearman_area", view)));
    }
    text.append(" | ").append(with_error(values("spearman_area", 0)));
    text.append(" | ").append(with_error(values("spearman_entropy", 0)));
    text.append(" | ").append(with_error(values("top1_share", 0))).append(" |\n");
  }
  return text;
}

std::string joined(const std::vector<std::string>& words) {
  std::string text;
  for (const std::string& word : words) text.append(text.empty() ? "" : ", ").append(word);
  return text;
}

}  // namespace

std::string results_markdown(const StudySpec& spec, const std::vector<ResultRow>& rows) {
  std::vector<std::string> objects;
  for (const StudyObject& object : spec.objects) objects.push_back(object.name);
  std::set<std::uint64_t> seeds;
  for (const StudyRun& run : spec.runs) seeds.insert(run.seed);
  std::string text = std::to_string(rows.size()) + " runs: " + joined(objects) + "; " +
                     std::to_string(seeds.size()) + " seeds; " + std::to_string(spec.max_views) +
                     " views. Views to a share of the visible surface (5 mm), means; a run that "
                     "never gets there counts as " +
                     std::to_string(spec.max_views + 1) +
                     ". AUC: mean coverage over the views. RMS of the surface.\n";
  // The runs come sorted by sensor, voxel and size.
  for (std::size_t first = 0, last = 0; first < rows.size(); first = last) {
    Group group{spec, {}};
    const StudyRun& of = *rows[first].run;
    while (last < rows.size() && rows[last].run->sensor == of.sensor &&
           rows[last].run->voxel == of.voxel && rows[last].run->size == of.size) {
      group.rows.push_back(&rows[last++]);
    }
    text += "\n## " + of.sensor + ", voxels of " + short_text(1e3 * of.voxel) + " mm";
    if (of.size) text += ", objects of " + short_text(*of.size) + " m";
    text += "\n\n" + means(group) + pairs(group) + by_object(group) + prediction(group);
  }
  return text;
}

}  // namespace viewgain::app
