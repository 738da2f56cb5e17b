// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "program/commands/reconstruct/run_outputs.hpp"

#include <cstdio>
#include <filesystem>
#include <system_error>
#include <utility>
#include <vector>

#include "program/cli/config_file.hpp"
#include "program/commands/file_format.hpp"
#include "show/pictures/view_picture.hpp"
#include "viewgain/support/atomic_file.hpp"
#include "viewgain/support/stopwatch.hpp"
#include "viewgain/version.hpp"

namespace viewgain::app {

StageSeconds show_step(const RunOutputs& outputs, const RunFolder& folder, RunPage& page,
                       const ShownStep& step, const ExecConfig& exec) {
  StageSeconds seconds;
  // One that the run has drawn before it was ended is there.
  std::filesystem::path file;
  if (outputs.with_pictures()) file = folder.view(step.record.index, ".png");
  std::error_code ignored;
  if (!outputs.with_report() && std::filesystem::exists(file, ignored)) return seconds;
  Stopwatch watch;
  const Proposal& proposal = step.record.proposal;
  // Without a proposal those that the generation holds are of a surface before.
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

void commit(RunFolder& folder, const Json& run, const App& app) {
  write_file_atomically(folder.file("config.toml"),
                        config_text(app, {"out", "resume", "json", "quiet", "threads"}));
  folder.commit(run.at("stop_reason") == Json("interrupted"));
}

void print_left(const RunOutputs& outputs, const char* files) {
  std::printf("left in %s: %s%s%s%s\n", outputs.out.c_str(), files,
              outputs.with_pictures() ? ", views/" : "", outputs.saves_maps() ? ", maps/" : "",
              outputs.with_report() ? ", report.html" : "");
}

}  // namespace viewgain::app
