// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include "program/cli/flags/next_views.hpp"

#include <algorithm>
#include <array>

#include "program/cli/flags/gain_names.hpp"
#include "program/cli/help.hpp"
#include "program/cli/values.hpp"

namespace viewgain::app {
namespace {

std::string why(const NextView& view) {
  std::string text = view.generator;
  if (view.boundary_class) text.append(" ").append(boundary_class_name(*view.boundary_class));
  if (view.generator == kGivenPoses) text.append(" ").append(std::to_string(view.number));
  return text;
}

// Where rays end: its name in JSON and in words.
struct Outcome {
  const char* key;
  const char* words;
  std::uint32_t GainEvaluator::RayOutcomes::*count;
};
constexpr std::array kOutcomes{
    Outcome{"unknown", "reach unknown space", &GainEvaluator::RayOutcomes::unknown},
    Outcome{"known_surface", "end on known surface", &GainEvaluator::RayOutcomes::known_surface},
    Outcome{"obstacle", "end on obstacles", &GainEvaluator::RayOutcomes::obstacle},
    Outcome{"too_near", "hit something nearer than min_range",
            &GainEvaluator::RayOutcomes::too_near},
    Outcome{"out_of_range", "see free space up to the range limit",
            &GainEvaluator::RayOutcomes::out_of_range},
    Outcome{"out_of_map", "leave the map", &GainEvaluator::RayOutcomes::out_of_map}};

Json to_json(const std::optional<GainEvaluator::RayOutcomes>& rays) {
  if (!rays) return {};
  Json json{{"rays", rays->rays}};
  for (const Outcome& outcome : kOutcomes) json[outcome.key] = (*rays).*outcome.count;
  return json;
}

// "of 25,344 rays 61 % come to unknown space, 39 % end in known surface"
std::string text_of(const GainEvaluator::RayOutcomes& rays) {
  std::string text = "of " + with_commas(rays.rays) + " rays";
  const char* between = " ";
  for (const Outcome& outcome : kOutcomes) {
    const std::uint32_t count = rays.*outcome.count;
    if (count == 0) continue;
    text += formatted("%s%.3g %% %s", between, 100.0 * count / rays.rays, outcome.words);
    between = ", ";
  }
  return text;
}

void add(const GainEvaluator::RayOutcomes& from, GainEvaluator::RayOutcomes& to) {
  to.rays += from.rays;
  for (const Outcome& outcome : kOutcomes) to.*outcome.count += from.*outcome.count;
}

double total_gain(const NextViews& next) {
  double total = 0;
  for (const NextView& view : next.views) total += view.gain.gain;
  return total;
}

}  // namespace

void add_plan_option(App& app, std::string& text) {
  const std::string reference = explain_values_in(
      "next", app,
      "Planning ahead with --plan K[,M]:\n"
      "  The views of a plan are ordered along a short path of straight lines. The\n"
      "  planner replans after M views, or earlier if no remaining view is both\n"
      "  possible and worth taking. The commands next and model (without --watch)\n"
      "  print the first M views of the plan.\n");
  app.add_option("--plan", text,
                 "K[,M]: plan K views together and replan after M of them (default: M = K; " +
                     reference + "); 1: no plan");
}

PlanAhead parse_plan(const std::string& text) {
  const std::vector<double> n = parse_numbers("--plan", text, 1, 2);
  PlanAhead ahead;
  ahead.plan = parse_count("--plan", n[0]);
  ahead.take = n.size() > 1 ? parse_count("--plan", n[1]) : ahead.plan;
  if (ahead.plan < 1 || ahead.plan > 1000 || ahead.take < 1 || ahead.take > ahead.plan) {
    refuse("--plan " + text + ": expected 1 <= M <= K <= 1000");
  }
  return ahead;
}

NextViews next_views(const Ranking& ranking, const Proposal& proposal, GainModel model) {
  NextViews next{{}, proposal.candidates.size(), proposal.dropped, model};
  for (const RankedView& view : ranking.views) {
    const Candidate& candidate = proposal.candidates[view.index];
    next.views.push_back({view.T_world_camera, view.index, view.gain, view.worth,
                          candidate.generator, candidate.number.value_or(0),
                          candidate.boundary_class});
  }
  return next;
}

void explain(NextViews& next, const Proposal& proposal, const GainEvaluator& evaluator) {
  for (NextView& view : next.views) view.rays = evaluator.outcomes(view.T_world_camera);
  if (!next.views.empty() || proposal.candidates.empty()) return;
  constexpr std::size_t kMost = 32;
  const std::size_t all = proposal.candidates.size(), count = std::min(all, kMost);
  next.no_gain.emplace();
  for (std::size_t i = 0; i < count; ++i) {
    add(evaluator.outcomes(proposal.candidates[i * all / count].T_world_camera), *next.no_gain);
  }
}

Json to_json(const NextViews& next) {
  Json json{{"gain_model", gain_model_name(next.model)},
            {"gain_unit", gain_unit(next.model)},
            {"candidates", next.candidates},
            {"dropped", next.dropped},
            {"next", Json::array()}};
  if (next.no_gain) json["no_gain"] = to_json(next.no_gain);
  if (next.plan_metres) json["plan_metres"] = *next.plan_metres;
  const double total = total_gain(next);
  for (const NextView& view : next.views) {
    const auto& of = view.boundary_class;
    json["next"].push_back({{"gain", view.gain.gain},  // a NaN becomes null
                            {"worth", view.worth},
                            {"share", next.together ? Json(view.gain.gain / total) : Json()},
                            {"area", view.gain.area},
                            {"generator", view.generator},
                            {"number", view.number},
                            {"class", of ? Json(boundary_class_name(*of)) : Json()},
                            {"T_world_camera", to_json(view.T_world_camera)}});
    if (view.rays) json["next"].back()["rays"] = to_json(view.rays);
  }
  return json;
}

std::string help_text(std::size_t candidates, const std::map<std::string, std::size_t>& dropped) {
  std::size_t all = candidates;
  for (const auto& [reason, count] : dropped) all += count;
  // Advice if most candidates are dropped for one reason.
  for (const auto& [reason, what] :
       {std::pair(kUnreachable,
                  "out of reach. Widen --reach, or add candidates with --generator boundary,shell"),
        std::pair(std::string_view("too_near"), "too near. Move them away with --distance")}) {
    const auto found = dropped.find(std::string(reason));
    if (found == dropped.end() || 2 * found->second <= all) continue;
    return with_commas(found->second) + " of " + with_commas(all) + " candidates are " + what;
  }
  return {};
}

std::string summary_of(const NextViews& next) {
  if (next.candidates == 0 && next.dropped.empty())
    return "no candidates: the surface has no open edges, and no more surface is expected";
  const std::string count = with_commas(next.candidates);
  std::string text = next.candidates == 0 ? "no view is possible"
                     : next.views.empty()
                         ? "none of the " + count + " candidate views has a positive gain"
                         : "best of " + count + " views";
  if (!next.dropped.empty()) text += "; dropped: " + counts_text(next.dropped);
  if (const std::string help = help_text(next.candidates, next.dropped); !help.empty()) {
    text += "; " + help;
  }
  if (next.candidates == 0 && next.dropped.contains("collision")) {
    text +=
        " (the camera's housing would touch voxels that are not known to be free; check --body, "
        "and check that --workspace contains the positions of the camera)";
  }
  return text;
}

std::string text_of(const NextViews& next) {
  const char* const unworthy = next.all_worth ? "" : "no other view gains more than it costs\n";
  if (next.no_gain) return "no candidate has a positive gain: " + text_of(*next.no_gain) + "\n";
  if (next.views.empty()) return unworthy;
  const bool has_area = next.model != GainModel::paper;
  const std::string gain = "gain [" + std::string(gain_unit(next.model)) + "]";
  const bool has_cost = std::any_of(next.views.begin(), next.views.end(), [](const NextView& view) {
    return view.worth != view.gain.gain;
  });
  std::string text = formatted("rank %12s  share%s%s  %-26s %-23s why\n", gain.c_str(),
                               has_cost ? "      worth" : "", has_area ? "    area [m^2]" : "",
                               "eye x y z [m]", "looks along x y z");
  const double total = total_gain(next);
  for (std::size_t i = 0; i < next.views.size(); ++i) {
    const NextView& view = next.views[i];
    const Eigen::Vector3d eye = view.T_world_camera.translation();
    const Eigen::Vector3d axis = view.T_world_camera.rotation().col(2);
    text += formatted("%4zu %12.6g %4.0f %%", i + 1, view.gain.gain, 100 * view.gain.gain / total);
    if (has_cost) text += formatted(" %10.4g", view.worth);
    if (has_area) text += formatted(" %13.4g", view.gain.area);
    text += formatted("  %8.3f %8.3f %8.3f %7.3f %7.3f %7.3f  %s\n", eye.x(), eye.y(), eye.z(),
                      axis.x(), axis.y(), axis.z(), why(view).c_str());
    if (view.rays) text.append("     ").append(text_of(*view.rays)).append("\n");
  }
  if (next.views.size() > 1 && next.together) {
    text += has_area ? "gain and area are" : "gain is";
    text += " marginal: the increase over the views above\n";
  }
  if (next.plan_metres)
    text += formatted("length of the path along straight lines: %.3f m\n", *next.plan_metres);
  if (next.views.front().worth <= 0) text += "no view gains more than it costs\n";
  return text + unworthy;
}

std::string outside_text(const NextViews& next, const BeliefGrid& grid) {
  const Box box = grid.workspace();
  const auto outside = std::count_if(next.views.begin(), next.views.end(), [&](const auto& view) {
    const Eigen::Vector3d eye = grid.T_world_grid().inverse() * view.T_world_camera.translation();
    for (int a = 0; a < 3; ++a) {
      const auto k = static_cast<std::size_t>(a);
      if (eye[a] < box.min[k] || eye[a] > box.max[k]) return true;
    }
    return false;
  });
  if (outside == 0) return {};
  return "views outside the workspace, where it is unknown whether space is free: " +
         std::to_string(outside) + " of " + std::to_string(next.views.size()) +
         " (--workspace, --reach)\n";
}

std::vector<Pose> poses_of(const NextViews& next) {
  std::vector<Pose> poses;
  for (const NextView& view : next.views) poses.push_back(view.T_world_camera);
  return poses;
}

}  // namespace viewgain::app
