// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <functional>
#include <set>
#include <utility>

#include "program/cli/values.hpp"
#include "program/commands/study/results.hpp"
#include "viewgain/support/text.hpp"

namespace viewgain::app {
namespace {

using Rows = std::vector<const ResultRow*>;
using Figure = std::function<double(const ResultRow&)>;

std::string fixed(double value, int digits) {
  return std::isfinite(value) ? formatted("%.*f", digits, value) : "-";
}

std::vector<double> figures(const Rows& rows, const Figure& figure) {
  std::vector<double> values;
  for (const ResultRow* row : rows) values.push_back(figure(*row));
  return values;
}

Figure views_to(std::size_t goal) {
  return [goal](const ResultRow& row) { return row.counted_views_to(goal); };
}

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

// "| a | b |", and below the head of a table its line.
std::string line_of(const std::vector<std::string>& cells) {
  std::string text = "|";
  for (const std::string& cell : cells) text.append(" ").append(cell).append(" |");
  return text + "\n";
}
std::string head_of(const std::vector<std::string>& cells) {
  std::string text = line_of(cells) + "|";
  for (std::size_t i = 0; i < cells.size(); ++i) text += "---|";
  return text + "\n";
}

std::string mean_cell(const Rows& rows, const Figure& figure, int digits) {
  return fixed(mean_of(figures(rows, figure)).mean, digits);
}

// Whose runs belong together.
std::vector<std::size_t> objects_of(const Rows& rows) {
  std::vector<std::size_t> objects;
  for (const ResultRow* row : rows) objects.push_back(row->run->object);
  return objects;
}

// With its 95 % interval.
std::string interval_cell(const Rows& rows, const Figure& figure, int digits) {
  const std::vector<double> values = figures(rows, figure);
  const double interval = interval_of(values, objects_of(rows));
  return mean_cell(rows, figure, digits) +
         (std::isnan(interval) ? "" : " ± " + fixed(interval, digits));
}

std::size_t count_of_never(const Rows& rows, std::size_t goal) {
  return static_cast<std::size_t>(std::count_if(
      rows.begin(), rows.end(), [&](const ResultRow* row) { return !row->views_to[goal]; }));
}

Figure metres_to(std::size_t goal) {
  return [goal](const ResultRow& row) { return row.metres_to[goal]; };
}

// Mean / median / runs that never got there, which are beyond all others and make of the mean a
// lower bound without an interval, and the way until then.
std::string counts(const Rows& rows, std::size_t goal) {
  const std::size_t never = count_of_never(rows, goal);
  if (never == rows.size()) return "-";
  std::vector<double> views;
  for (const ResultRow* row : rows) {
    views.push_back(row->views_to[goal] ? row->counted_views_to(goal) : HUGE_VAL);
  }
  const double median = median_of(std::move(views));
  return (never > 0 ? "≥ " + mean_cell(rows, views_to(goal), 2)
                    : interval_cell(rows, views_to(goal), 2)) +
         " / " + (median == HUGE_VAL ? "never" : fixed(median, 1)) + " / " + std::to_string(never) +
         "; " + mean_cell(rows, metres_to(goal), 2) + " m";
}

std::string means(const Group& group) {
  std::string text =
      head_of({"policy", "to 80 % ↓", "to 90 % ↓", "to 95 % ↓", "AUC ↑", "in the end ↑",
               "RMS [mm] ↓", "consistency →1", "way [m] ↓", "decisions", "s a view", "time [s] ↓"});
  for (std::size_t policy = 0; policy < group.spec.policies.size(); ++policy) {
    const Rows rows = group.of(policy);
    std::vector<std::string> cells{group.spec.policies[policy].name};
    for (std::size_t goal = 0; goal < kGoals.size(); ++goal) cells.push_back(counts(rows, goal));
    cells.push_back(interval_cell(rows, &ResultRow::auc, 3));
    const auto in_the_end = [](const ResultRow& row) { return 100 * row.coverage_visible; };
    cells.push_back(interval_cell(rows, in_the_end, 1) + " %");
    cells.push_back(interval_cell(rows, rms_mm, 2));
    cells.push_back(interval_cell(rows, &ResultRow::consistency, 2));
    cells.push_back(interval_cell(rows, &ResultRow::travelled, 1));
    const auto decisions = [](const ResultRow& row) { return static_cast<double>(row.decisions); };
    cells.push_back(mean_cell(rows, decisions, 1));
    cells.push_back(mean_cell(rows, &ResultRow::deciding_seconds, 2));
    cells.push_back(mean_cell(rows, &ResultRow::seconds, 1));
    text += line_of(cells);
  }
  return text;
}

Figure metres_if_there(std::size_t goal) {
  return [goal](const ResultRow& row) {
    return row.views_to[goal] ? row.metres_to[goal] : std::nan("");
  };
}

std::string probability(double p) { return p < 0.001 ? "<0.001" : fixed(p, 3); }

// Mean difference ± standard error (wins-ties-losses; p of both tests); both lists run by run.
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
  const MeanWithError mean = mean_of(differences, objects_of(of));
  if (mean.count == 0) return "-";
  return fixed(mean.mean, digits) + " ± " + fixed(mean.error, digits) + " (" +
         std::to_string(count[0]) + "-" + std::to_string(count[1]) + "-" +
         std::to_string(count[2]) + "; " + probability(sign_test(differences)) + ", " +
         probability(signed_rank_test(differences)) + ")";
}

std::string pairs(const Group& group) {
  const StudySpec& spec = group.spec;
  if (spec.policies.size() < 2) return "";
  const Rows against = group.of(spec.against);
  std::string text =
      "\nPaired with " + spec.policies[spec.against].name +
      ": mean difference ± standard error (wins-ties-losses; p of the sign test, of "
      "Wilcoxon's signed-rank test; of " +
      std::to_string(against.size()) + " pairs p cannot be below " +
      probability(std::min(1.0, std::ldexp(2.0, -static_cast<int>(against.size())))) +
      "). The way to 95 % is of pairs that both got there\n\n" +
      head_of({"policy", "to 80 % ↓", "to 90 % ↓", "to 95 % ↓", "way to 95 % [m] ↓", "AUC ↑",
               "RMS [mm] ↓"});
  for (std::size_t policy = 0; policy < spec.policies.size(); ++policy) {
    if (policy == spec.against) continue;
    const Rows of = group.of(policy);
    std::vector<std::string> cells{spec.policies[policy].name};
    for (std::size_t goal = 0; goal < kGoals.size(); ++goal) {
      const bool is_reached =
          count_of_never(of, goal) + count_of_never(against, goal) < of.size() + against.size();
      cells.push_back(is_reached ? difference(of, against, views_to(goal), 2, false) : "-");
    }
    cells.push_back(difference(of, against, metres_if_there(kGoals.size() - 1), 2, false));
    cells.push_back(difference(of, against, &ResultRow::auc, 3, true));
    cells.push_back(difference(of, against, rms_mm, 2, false));
    text += line_of(cells);
  }
  return text;
}

std::string by_object(const Group& group) {
  const StudySpec& spec = group.spec;
  if (spec.objects.size() < 2) return "";
  std::vector<std::string> names{"policy"};
  for (const StudyObject& object : spec.objects) names.push_back(object.name);
  std::string text = "\nAUC and way [m] by object\n\n" + head_of(names);
  for (std::size_t policy = 0; policy < spec.policies.size(); ++policy) {
    std::vector<std::string> cells{spec.policies[policy].name};
    for (std::size_t object = 0; object < spec.objects.size(); ++object) {
      Rows rows = group.of(policy);
      std::erase_if(rows, [&](const ResultRow* row) { return row->run->object != object; });
      cells.push_back(mean_cell(rows, &ResultRow::auc, 3) + "; " +
                      mean_cell(rows, &ResultRow::travelled, 1));
    }
    text += line_of(cells);
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
  const std::string never = std::to_string(spec.max_views + 1);
  std::string text =
      std::to_string(rows.size()) + " runs: " + joined(objects) + "; " +
      std::to_string(seeds.size()) + " seeds; " + std::to_string(spec.max_views) +
      " views.\n\n- ↓ less is better, ↑ more is.\n"
      "- Views to a share of the visible surface (within " +
      short_text(1e3 * spec.tolerance) +
      " mm): mean / median / runs that never got there. These count as " + never +
      " in means, also of differences; a mean with such runs is at least (≥) that. Then the mean "
      "way "
      "until there, of such runs the whole.\n"
      "- decisions: views that were decided on anew, not taken as a plan said. s a view: "
      "candidates "
      "and choice.\n"
      "- AUC: mean coverage over the views. In the end: coverage by the last view. RMS: error of "
      "the "
      "surface that is there, lower too where hard places are not. Consistency: the points' "
      "squared errors by their own sigmas, 1 if these are honest, above if too small.\n"
      "- A - where no run got there, or nothing can be said.\n"
      "- ± of a policy's mean: its 95 % interval (Student's t) for other seeds on the same "
      "objects; "
      "fewer than about 5 seeds make it wide.\n- ± of a difference: " +
      (objects.size() > 1
           ? "standard errors by object, for runs on one object are not independent" +
                 std::string(objects.size() == 2 ? " (of two: no more than how alike these are)"
                                                 : "") +
                 "; p is of these objects, by runs.\n"
           : "standard errors over the runs on the one object, which say nothing of others.\n");
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
    text += "\n\n" + means(group) + pairs(group) + by_object(group);
  }
  return text;
}

}  // namespace viewgain::app
