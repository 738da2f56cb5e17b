// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "program/commands/reconstruct/run_outputs.hpp"

#include <cmath>
#include <cstdio>
#include <filesystem>
#include <system_error>
#include <utility>

#include "program/cli/config_file.hpp"
#include "program/cli/flags/gain_names.hpp"
#include "program/cli/flags/next_views.hpp"
#include "program/cli/values.hpp"
#include "program/commands/consistency_text.hpp"
#include "program/commands/file_format.hpp"
#include "program/commands/frames/frame_tally.hpp"
#include "show/pictures/view_picture.hpp"
#include "viewgain/core/error.hpp"
#include "viewgain/support/atomic_file.hpp"
#include "viewgain/support/file_bytes.hpp"
#include "viewgain/support/isa.hpp"
#include "viewgain/support/stopwatch.hpp"
#include "viewgain/version.hpp"

namespace viewgain::app {
namespace {

// Values that both a view and the whole run have.
void put_figures(Json& json, const QualityFigures& quality, const ModelProgress& progress) {
  json.update(quality_json(quality, "coverage_visible"));
  json["entropy_removed"] = progress.entropy_removed;
  json["unknown_voxels"] = progress.unknown_voxels;
  json["surface_area"] = progress.surface_area;
}

std::size_t total(const std::map<std::string, std::size_t>& counts) {
  std::size_t sum = 0;
  for (const auto& [reason, count] : counts) sum += count;
  return sum;
}

}  // namespace

StageSeconds show_step(const RunOutputs& outputs, const RunFolder& folder, RunPage& page,
                       const ShownStep& step, const ExecConfig& exec) {
  StageSeconds seconds;
  // A resumed run keeps pictures that already exist.
  std::filesystem::path file;
  if (outputs.with_pictures()) file = folder.view(step.record.index, ".png");
  std::error_code ignored;
  if (!outputs.with_report() && std::filesystem::exists(file, ignored)) return seconds;
  Stopwatch watch;
  const Proposal& proposal = step.record.proposal;
  // Without a proposal, the generation's boundaries are from an earlier surface.
  const bool is_proposed = !proposal.candidates.empty() || !proposal.dropped.empty();
  const EstimatedViews estimated = is_proposed ? step.generation.estimated() : EstimatedViews{};
  std::vector<VoxelContribution> contributions;
  ViewPicture parts{
      step.model.surface(), estimated,      proposal.candidates, step.record.T_world_camera,
      std::nullopt,         step.evaluator, step.sensor,         &contributions};
  if (step.record.decision) {
    parts.chosen = proposal.candidates[step.record.decision->candidate].T_world_camera;
    if (outputs.with_report() || step.evaluator.model() != GainModel::paper) {
      contributions = step.evaluator.contributions(*parts.chosen);
    }
  }
  if (outputs.with_pictures()) {
    write_png(file, view_picture(parts, exec));
    seconds["pictures"] = watch.seconds();
  }
  if (!outputs.with_report()) return seconds;
  watch = {};
  page.add_view(step.record, step.model, step.generation, estimated, step.evaluator,
                std::move(contributions));
  seconds["report"] = watch.seconds();
  return seconds;
}

Json run_head(const Json& settings) {
  return {{"format", kRunFormat},
          {"settings", settings},
          {"versions", {{"viewgain", VIEWGAIN_VERSION}, {"compiler", __VERSION__}}}};
}

Json checkpoint_head(const Json& settings, const App& app) {
  Json head = run_head(settings);
  const CallSettings call = call_settings(app, kSameBytes);
  head["flags"] = call.flags;
  head["files"] = call.files;
  head["isa"] = isa_name(select_isa());
  return head;
}

Json beside_json(const RunOutputs& outputs) {
  const std::string beside = outputs.beside();
  if (beside.empty()) return nullptr;
  const std::filesystem::path file = std::filesystem::path(beside) / "run.json";
  const Json run = Json::parse(folder_file_bytes(file), nullptr, false);
  const bool has_views = run.is_object() && run.contains("settings") && run.contains("per_view") &&
                         run["per_view"].is_array() && !run["per_view"].empty();
  if (!has_views || !run.contains("format") || !run["format"].is_number_unsigned()) {
    throw Error(ErrorCode::format,
                file.string() + ": the file is invalid; --report requires the folder of a run");
  }
  check_format(file.string(), run);
  return {{"name", beside}, {"settings", run["settings"]}, {"per_view", run["per_view"]}};
}

std::string beside_text(const Json& beside, const Json& own) {
  if (beside.is_null()) return {};
  const Json& views = beside["per_view"];
  const auto last = [&](const char* key) {
    const Json value = views.back().is_object() ? views.back().value(key, Json()) : Json();
    return value.is_number() ? value.get<double>() : std::nan("");
  };
  std::string text = beside["name"].get<std::string>() +
                     " for comparison: " + std::to_string(views.size()) + " views";
  if (const double visible = last("coverage_visible"); !std::isnan(visible)) {
    text += formatted(", %.2f %% of the visible surface covered, RMS error %.2f mm", 100 * visible,
                      1e3 * last("rms_error"));
  }
  if (const double way = last("travelled"); !std::isnan(way)) text += formatted(", %.2f m", way);
  std::string others;
  for (const char* key : {"mesh", "size", "sensor", "voxel", "noise", "tolerance"}) {
    const Json& settings = beside["settings"];
    if (!settings.is_object() || settings.value(key, Json()) == own.value(key, Json())) continue;
    others += (others.empty() ? "; other settings: " : ", ") + std::string(key);
  }
  return text + others + "\n";
}

void commit(RunFolder& folder, const Json& run, const App& app) {
  write_file_atomically(folder.file("config.toml"),
                        config_text(app, {"out", "resume", "json", "quiet", "threads"}));
  folder.commit(run.at("stop_reason") == Json("interrupted"));
}

void print_left(const RunOutputs& outputs, const char* files) {
  std::printf("written to %s: %s%s%s%s\n", outputs.out.c_str(), files,
              outputs.with_pictures() ? ", views/" : "", outputs.saves_maps() ? ", maps/" : "",
              outputs.with_report() ? ", report.html" : "");
}

Json quality_json(const QualityFigures& quality, const char* visible) {
  return {{"coverage", quality.coverage},
          {visible, quality.coverage_visible},
          {"coverage_points", quality.coverage_points},
          {"coverage_triangles", quality.coverage_triangles},
          {"coverage_2_5mm", quality.coverage_2_5mm},
          {"rms_error", quality.surface_error.rms},
          {"p95_error", quality.surface_error.p95},
          {"rms_error_points", quality.points_error.rms},
          {"p95_error_points", quality.points_error.p95},
          {"consistency", quality.consistency.mean_clipped},
          {"consistency_median", quality.consistency.median},
          {"consistency_above_9", quality.consistency.above_9},
          {"outliers", quality.consistency.outliers}};
}

RunReport::RunReport(const PolicyConfig& policy, double tolerance)
    : entropy_unit_(gain_unit(GainModel::paper, policy.criterion)), tolerance_(tolerance) {
  gain_unit_ = entropy_unit_;  // a policy without a gain predicts the paper's gain
  if (policy.policy != Policy::gain) return;
  if (!policy.registered.empty()) {
    ranked_by_ = policy.registered;
    gain_unit_ = registered_gains().unit(policy.registered);
  } else {
    ranked_by_ = gain_model_name(policy.model);
    gain_unit_ = gain_unit(policy.model, policy.criterion);
  }
}

void RunReport::add_view(const ViewRecord& record, const QualityFigures& quality,
                         const StageSeconds& seconds) {
  StageSeconds own = seconds;
  for (auto& [stage, value] : own) {
    const auto before = totals_.find(stage);
    if (before != totals_.end()) value -= before->second;
  }
  totals_ = seconds;
  views_.push_back({record, quality, std::move(own)});
}

void RunReport::set_registrations(std::vector<FrameRegistration> registrations) {
  registrations_ = std::move(registrations);
}

std::string RunReport::progress_line() const {
  const Entry& e = views_.back();
  std::string text = formatted(
      "view %2zu  %6.2f %% of the visible surface covered at %g mm, RMS %.2f mm, unknown %s, gain "
      "%.4g %s",
      e.record.index, 100 * e.quality.coverage_visible, 1e3 * tolerance_,
      1e3 * e.quality.surface_error.rms, with_commas(e.record.progress.unknown_voxels).c_str(),
      e.record.realised_gain, entropy_unit_.data());
  text += formatted(", new surface %.3g m^2", e.record.progress.new_area);
  if (!std::isnan(e.record.predicted_area)) {
    text += formatted(" (predicted %.3g)", e.record.predicted_area);
  }
  if (e.record.chosen_as && e.record.chosen_as->boundary_class) {
    text.append("  ").append(boundary_class_name(*e.record.chosen_as->boundary_class));
  }
  const std::size_t candidates = e.record.proposal.candidates.size();
  if (e.record.decision) {
    text += formatted("  next: gain %.4g %s, best of %zu candidates; %zu dropped",
                      e.record.decision->gain, gain_unit_.data(), candidates,
                      total(e.record.proposal.dropped));
  }
  return text;
}

Json RunReport::entry_json(std::size_t index) const {
  const Entry& e = views_[index];
  Json json{{"index", e.record.index}, {"pose", to_json(e.record.T_world_camera)}};
  const bool chosen = e.record.chosen_as.has_value();
  const bool of_boundary = chosen && e.record.chosen_as->boundary_class;
  json["class"] =
      of_boundary ? Json(boundary_class_name(*e.record.chosen_as->boundary_class)) : Json();
  json["generator"] = chosen ? Json(e.record.chosen_as->generator) : Json("start");
  // This view was chosen from the proposal after the previous view.
  const Proposal empty;
  const Proposal& from = index > 0 ? views_[index - 1].record.proposal : empty;
  json["candidates"] = from.candidates.size();
  json["dropped"] = from.dropped;
  json["predicted_gain"] = e.record.predicted_gain;
  json["realised_gain"] = e.record.realised_gain;
  json["predicted_area"] = e.record.predicted_area;
  json["realised_area"] = e.record.progress.new_area;
  json["true_new_area"] =
      e.quality.covered_area - (index > 0 ? views_[index - 1].quality.covered_area : 0.0);
  // Values of the best current view, which the stopping rules use.
  json["next_gain_per_voxel"] =
      e.record.decision ? Json(e.record.decision->gain_per_voxel) : Json();
  json["next_area"] = e.record.decision ? Json(e.record.decision->best_area) : Json();
  put_figures(json, e.quality, e.record.progress);
  json["travelled"] = e.record.travelled;
  if (index < registrations_.size()) json["registration"] = to_json(registrations_[index]);
  json["seconds"] = seconds_json(e.seconds);
  return json;
}

const Proposal& RunReport::last_proposal() const {
  for (auto entry = views_.rbegin(); entry != views_.rend(); ++entry) {
    const Proposal& proposal = entry->record.proposal;
    if (!proposal.candidates.empty() || !proposal.dropped.empty()) return proposal;
  }
  return views_.back().record.proposal;
}

Json RunReport::json(StopReason reason) const {
  const Entry& last = views_.back();
  Json json{{"stop_reason", stop_reason_name(reason)}, {"views", views_.size()}};
  json["gain_model"] = or_null(std::string(ranked_by_));
  put_figures(json, last.quality, last.record.progress);
  json["travelled"] = last.record.travelled;
  const Proposal& proposal = last_proposal();
  json["final_candidates"] = proposal.candidates.size();
  json["final_dropped"] = proposal.dropped;
  if (!registrations_.empty()) json["registration"] = registration_counts(registrations_);
  json["seconds"] = seconds_json(totals_);
  json["per_view"] = Json::array();
  for (std::size_t i = 0; i < views_.size(); ++i) json["per_view"].push_back(entry_json(i));
  return json;
}

std::string RunReport::text(StopReason reason) const {
  const Entry& last = views_.back();
  const QualityFigures& q = last.quality;
  std::string text = formatted("%zu views, stopped: %s\n", views_.size(),
                               std::string(stop_reason_name(reason)).c_str());
  const std::map<std::string, std::size_t>& dropped = last.record.proposal.dropped;
  if (!dropped.empty()) {
    const std::size_t feasible = last.record.proposal.candidates.size();
    const std::string help = help_text(feasible, dropped);
    text += formatted("candidates after the last view: %zu possible; dropped: %s%s%s\n", feasible,
                      counts_text(dropped).c_str(), help.empty() ? "" : "; ", help.c_str());
  }
  text += formatted(
      "coverage within %g mm: %.2f %% of the object, %.2f %% of its visible part (by points %.2f "
      "%%, by triangles %.2f %%); within 2.5 mm: %.2f %% of the object\n",
      1e3 * tolerance_, 100 * q.coverage, 100 * q.coverage_visible, 100 * q.coverage_points,
      100 * q.coverage_triangles, 100 * q.coverage_2_5mm);
  text += formatted(
      "error of the surface: RMS %.2f mm, 95 %% below %.2f mm; of the points: RMS %.2f mm, 95 %% "
      "below %.2f mm\n",
      1e3 * q.surface_error.rms, 1e3 * q.surface_error.p95, 1e3 * q.points_error.rms,
      1e3 * q.points_error.p95);
  text += consistency_text(q.consistency);
  if (!registrations_.empty()) {
    text += registration_text(registration_counts(registrations_)) + "\n";
  }
  text +=
      formatted("entropy removed: %.6g %s; unknown voxels: %s; path length: %.2f m\n",
                last.record.progress.entropy_removed, entropy_unit_.data(),
                with_commas(last.record.progress.unknown_voxels).c_str(), last.record.travelled);
  double sum = 0;
  std::string stages;
  for (const auto& [stage, value] : totals_) {
    sum += value;
    stages += formatted("%s%s %.2f", stages.empty() ? "" : ", ", stage.c_str(), value);
  }
  return text + formatted("%.2f s: %s\n", sum, stages.c_str());
}

}  // namespace viewgain::app
