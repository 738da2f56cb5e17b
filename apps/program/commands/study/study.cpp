// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <set>
#include <string>
#include <system_error>
#include <thread>
#include <tuple>
#include <vector>

#include "program/cli/interrupt.hpp"
#include "program/cli/values.hpp"
#include "program/commands/commands.hpp"
#include "program/commands/study/results.hpp"
#include "program/commands/study/runs.hpp"
#include "program/commands/study/spec.hpp"
#include "program/commands/study/study_run.hpp"
#include "viewgain/core/error.hpp"
#include "viewgain/support/atomic_file.hpp"
#include "viewgain/support/stopwatch.hpp"

namespace viewgain::app {
namespace {

struct Options {
  CommonOptions common;
  std::string spec;
  std::string out;
  std::size_t jobs = 0;
  std::string plots = "on";
};

// A wrong name is known before hours of work.
void check_runs(const StudySpec& spec, const std::string& file) {
  std::set<std::size_t> policies;
  std::set<std::tuple<std::size_t, std::string, double, std::optional<double>>> scenes;
  for (const StudyRun& run : spec.runs) {
    const bool has_new_policy = policies.insert(run.policy).second;
    const bool has_new_scene = scenes.insert({run.object, run.sensor, run.voxel, run.size}).second;
    if (!has_new_policy && !has_new_scene) continue;
    try {
      check_run(spec, run);
    } catch (const Error& error) {
      throw Error(error.code(), file + ": " + error.what());
    }
  }
}

std::string time_text(double seconds) {
  const auto whole = static_cast<long>(std::ceil(seconds));
  if (whole < 120) return std::to_string(whole) + " s";
  if (whole < 7200) return std::to_string((whole + 59) / 60) + " min";
  return std::to_string((whole + 3599) / 3600) + " h";
}

void print_progress(const StudySpec& spec, const StudyProgress& progress, double seconds) {
  const std::size_t total = spec.runs.size();
  if (progress.run == nullptr) {
    if (progress.done > 0) {
      std::fprintf(stderr, "%zu of %zu runs are there\n", progress.done, total);
    }
    return;
  }
  const double left =
      seconds / static_cast<double>(progress.made) * static_cast<double>(total - progress.done);
  std::fprintf(stderr, "run %zu of %zu: %s, %.1f s; %s left\n", progress.done, total,
               name_of(spec, *progress.run).c_str(), progress.seconds, time_text(left).c_str());
}

// A study's folder has runs/; another one that holds more than the spec is somebody else's.
void check_folder(const std::filesystem::path& dir, const std::filesystem::path& spec) {
  std::error_code ignored;
  const std::filesystem::directory_iterator entries(dir, ignored);  // none if it is not there
  const bool is_new = std::all_of(begin(entries), end(entries), [&](const auto& entry) {
    return std::filesystem::equivalent(entry.path(), spec, ignored);
  });
  // Looked for last: another worker of the same study may begin at this moment.
  if (is_new || std::filesystem::is_directory(dir / "runs", ignored)) return;
  refuse("--out " + dir.string() + ": has files, but no runs/ of a study; name a new folder");
}

ResultRow row_in(const StudyFolder& folder, const StudySpec& spec, const StudyRun& run) {
  const Json json = folder.read(run);
  try {
    return row_of(run, json, spec.max_views);
  } catch (const Json::exception& error) {
    throw Error(ErrorCode::format, folder.file(run, "run.json").string() + ": " + error.what() +
                                       "; a run whose folder is removed is made again");
  }
}

void warn_of_tolerance(const StudySpec& spec) {
  double voxel = 0;
  for (const StudyRun& run : spec.runs) voxel = std::max(voxel, run.voxel);
  if (voxel <= spec.tolerance) return;
  std::fprintf(stderr,
               "viewgain: warning: coverage is counted to %g mm, finer than voxels of %g mm "
               "(tolerance = %g in the spec)\n",
               1e3 * spec.tolerance, 1e3 * voxel, voxel);
}

void study(const Options& options) {
  const StudySpec spec = read_study_spec(options.spec);
  check_runs(spec, options.spec);
  const std::filesystem::path dir = options.out;
  check_folder(dir, options.spec);
  warn_of_tolerance(spec);
  const StudyFolder folder(dir);
  const std::size_t threads = options.common.threads > 0
                                  ? static_cast<std::size_t>(options.common.threads)
                                  : std::max(1U, std::thread::hardware_concurrency());
  const std::size_t jobs = options.jobs > 0 ? options.jobs : threads;
  const auto threads_per_run = static_cast<int>(std::max<std::size_t>(1, threads / jobs));
  const InterruptGuard interrupt;
  const Stopwatch watch;
  const bool complete = make_runs(spec, folder, jobs, threads_per_run, interrupt.token(),
                                  [&](const StudyProgress& progress) {
                                    if (!options.common.quiet)
                                      print_progress(spec, progress, watch.seconds());
                                  });
  if (!complete) {
    throw Stopped{"stopped; the same call goes on with what is in " + options.out};
  }

  std::vector<ResultRow> rows;
  for (const StudyRun& run : spec.runs) rows.push_back(row_in(folder, spec, run));
  const Json json = results_json(spec, rows);
  const std::string table = results_markdown(spec, rows);
  std::error_code ignored;
  std::filesystem::remove(dir / "coverage.png", ignored);  // it may be of another spec
  write_file_atomically(dir / "results.csv", results_csv(spec, rows));
  write_file_atomically(dir / "table.md", table);
  write_file_atomically(dir / "plots.py", plots_script());
  write_file_atomically(dir / "results.json", json_text(json));
  const bool is_drawn = options.plots == "on" && draw_plots(dir / "plots.py");
  if (options.plots == "on" && !is_drawn) {
    std::fprintf(stderr, "viewgain: no plots: \"python3 %s\" draws them where matplotlib is\n",
                 (dir / "plots.py").c_str());
  }
  if (options.common.json) {
    print_json(json);
  } else {
    std::printf("%s\nleft in %s: results.csv, results.json, table.md, plots.py%s, runs/\n",
                table.c_str(), options.out.c_str(), is_drawn ? ", coverage.png" : "");
  }
}

}  // namespace

Command add_study(App& program) {
  auto options = std::make_shared<Options>();
  App* app = program.add_subcommand(
      "study",
      "Compares policies and gains: a run of `reconstruct` for every object, policy, seed, sensor, "
      "voxel and size of a spec, in one table; stopped and called again it goes on.");
  app->add_option("SPEC", options->spec, "TOML file that says what to compare")->required();
  app->add_option("--out", options->out, "folder for results; several machines may share it")
      ->required();
  app->add_option("--jobs", options->jobs, "runs at once; default: as many as threads")
      ->check(counted(1, 1000));
  add_switch(*app, "--plots", options->plots, "draw plots, where python3 has matplotlib");
  add_common_options(*app, options->common);
  add_help(*app, kLoopGroup, "study spec.toml --out study");
  return {app, [options] { study(*options); }};
}

}  // namespace viewgain::app
