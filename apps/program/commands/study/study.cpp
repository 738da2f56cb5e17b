// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstddef>
#include <cstdio>
#include <exception>
#include <filesystem>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <set>
#include <stop_token>
#include <string>
#include <system_error>
#include <thread>
#include <tuple>
#include <utility>
#include <vector>

#include "program/cli/interrupt.hpp"
#include "program/cli/values.hpp"
#include "program/commands/commands.hpp"
#include "program/commands/study/claims.hpp"
#include "program/commands/study/results.hpp"
#include "program/commands/study/spec.hpp"
#include "program/commands/study/study_run.hpp"
#include "viewgain/core/error.hpp"
#include "viewgain/core/pose_io.hpp"
#include "viewgain/support/atomic_file.hpp"
#include "viewgain/support/file_bytes.hpp"
#include "viewgain/support/json.hpp"
#include "viewgain/support/stopwatch.hpp"

namespace viewgain::app {
namespace {

namespace fs = std::filesystem;

struct Options {
  CommonOptions common;
  std::string spec;
  std::string out;
  std::optional<std::size_t> jobs;
  std::string plots = "on";
};

void make_folder(const fs::path& folder) {
  std::error_code failed;
  fs::create_directories(folder, failed);
  if (failed) throw Error(ErrorCode::io, folder.string() + ": " + failed.message());
}

// How far a study is.
struct StudyProgress {
  std::size_t done = 0;           // runs that are there, whoever made them
  std::size_t made = 0;           // of these by this call
  const StudyRun* run = nullptr;  // the one just made; null at the start
  double seconds = 0;             // that it took
};

// The runs of a study in a folder: DIR/runs/HASH/run.json and, where the spec asks for them,
// candidates.txt; run.json last, so that a run that is there is whole.
class StudyFolder {
 public:
  // Makes the folders that are missing. Throws Error(io).
  explicit StudyFolder(const fs::path& dir) : dir_(dir) { make_folder(runs()); }

  [[nodiscard]] fs::path runs() const { return dir_ / "runs"; }
  [[nodiscard]] fs::path file(const StudyRun& run, const char* name) const {
    return runs() / run.hash / name;
  }
  [[nodiscard]] bool has(const StudyRun& run) const {
    std::error_code ignored;
    return fs::exists(file(run, "run.json"), ignored);
  }
  // run.json. Throws Error(format) that names the file if it is not that of this run.
  [[nodiscard]] Json read(const StudyRun& run) const {
    const fs::path path = file(run, "run.json");
    Json json = parse_or_null(folder_file_bytes(path));
    if (!json.is_object() || !json.contains("configuration") ||
        json["configuration"] != run.configuration) {
      throw Error(ErrorCode::format,
                  path.string() + ": is not of the run that its folder stands for");
    }
    return json;
  }
  void write(const StudyRun& run, const StudyResult& result) const {
    make_folder(runs() / run.hash);
    if (!result.candidates.empty()) {
      write_tum(file(run, "candidates.txt"), result.candidates, result.candidate_views);
    }
    write_file_atomically(file(run, "run.json"), json_text(result.run));
  }

 private:
  fs::path dir_;
};

// Deals out the runs that are not there and that nobody else works on.
class Workers {
 public:
  Workers(const StudySpec& spec, const StudyFolder& folder, ExecConfig exec, std::stop_token stop,
          const std::function<void(const StudyProgress&)>& on_progress)
      : spec_(spec),
        folder_(folder),
        exec_(exec),
        stop_(std::move(stop)),
        on_progress_(on_progress),
        claims_(folder.runs()),
        is_there_(spec.runs.size(), false),
        is_under_way_(spec.runs.size(), false) {
    look();
    on_progress_(progress_);
  }

  // One worker's life.
  void work() noexcept {
    try {
      while (true) {
        const std::optional<std::size_t> next = take();
        if (next) {
          make(*next);
        } else if (is_over()) {
          return;
        } else {  // others are at the rest
          std::this_thread::sleep_for(std::chrono::milliseconds(200));
        }
      }
    } catch (...) {
      const std::lock_guard lock(mutex_);
      if (!failure_) failure_ = std::current_exception();
      ours_.request_stop();
    }
  }

  // Ends them after what they are at.
  void stop() { ours_.request_stop(); }

  // Whether all runs are there; throws what a worker has thrown.
  bool end() {
    if (failure_) std::rethrow_exception(failure_);
    look();
    if (progress_.done < is_there_.size()) return false;
    for (const StudyRun& run : spec_.runs) claims_.clear_abandoned(run.hash);
    return true;
  }

 private:
  void look() {
    for (std::size_t i = 0; i < is_there_.size(); ++i) {
      if (!is_there_[i] && folder_.has(spec_.runs[i])) count(i);
    }
  }

  // Once a run, whoever sees it first: its maker or another worker that looks.
  void count(std::size_t i) {
    if (is_there_[i]) return;
    is_there_[i] = true;
    ++progress_.done;
  }

  bool is_over() {
    const std::lock_guard lock(mutex_);
    if (stop_.stop_requested() || ours_.stop_requested()) return true;
    look();
    return progress_.done == is_there_.size();
  }

  std::optional<std::size_t> take() {
    const std::lock_guard lock(mutex_);
    if (stop_.stop_requested() || ours_.stop_requested()) return std::nullopt;
    for (std::size_t i = 0; i < is_there_.size(); ++i) {
      if (is_there_[i] || is_under_way_[i]) continue;
      const StudyRun& run = spec_.runs[i];
      if (!folder_.has(run) && !claims_.take(run.hash)) continue;
      if (folder_.has(run)) {  // another one may just have made it
        claims_.give_back(run.hash);
        count(i);
        continue;
      }
      is_under_way_[i] = true;
      return i;
    }
    return std::nullopt;
  }

  void make(std::size_t i) {
    const StudyRun& run = spec_.runs[i];
    const Stopwatch watch;
    std::stop_source either;
    const std::stop_callback by_user(stop_, [&] { either.request_stop(); });
    const std::stop_callback by_failure(ours_.get_token(), [&] { either.request_stop(); });
    const std::optional<StudyResult> result = make_run(spec_, run, exec_, either.get_token());
    if (result) folder_.write(run, *result);
    claims_.give_back(run.hash);
    const std::lock_guard lock(mutex_);
    is_under_way_[i] = false;
    if (!result) return;
    count(i);
    ++progress_.made;
    progress_.run = &run;
    progress_.seconds = watch.seconds();
    on_progress_(progress_);
  }

  const StudySpec& spec_;
  const StudyFolder& folder_;
  const ExecConfig exec_;
  const std::stop_token stop_;
  const std::function<void(const StudyProgress&)>& on_progress_;
  Claims claims_;
  std::mutex mutex_;
  std::vector<bool> is_there_, is_under_way_;
  StudyProgress progress_;
  std::exception_ptr failure_;
  std::stop_source ours_;  // when one has failed
};

// Makes the runs that are not there yet, `jobs` at once, each by `exec`, together with
// whoever else works in the same folder; returns when all are there or a stop is requested.
// Whether all are there. `on_progress` is called at the start and after each run, by one thread at
// a time. Throws the first Error of a run, when those under way have ended.
bool make_runs(const StudySpec& spec, const StudyFolder& folder, std::size_t jobs,
               const ExecConfig& exec, const std::stop_token& stop,
               const std::function<void(const StudyProgress&)>& on_progress) {
  Workers workers(spec, folder, exec, stop, on_progress);
  {
    std::vector<std::jthread> team;
    try {
      for (std::size_t i = 1; i < jobs; ++i) team.emplace_back([&] { workers.work(); });
    } catch (const std::system_error& error) {
      workers.stop();
      throw Error(ErrorCode::capacity,
                  "cannot start " + std::to_string(jobs) + " threads: " + error.what());
    } catch (...) {
      workers.stop();
      throw;
    }
    workers.work();
  }
  return workers.end();
}

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
void check_folder(const fs::path& dir, const fs::path& spec) {
  std::error_code ignored;
  const fs::directory_iterator entries(dir, ignored);  // none if it is not there
  const bool is_new = std::all_of(begin(entries), end(entries), [&](const auto& entry) {
    return fs::equivalent(entry.path(), spec, ignored);
  });
  // Looked for last: another worker of the same study may begin at this moment.
  if (is_new || fs::is_directory(dir / "runs", ignored)) return;
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
  const fs::path dir = options.out;
  check_folder(dir, options.spec);
  warn_of_tolerance(spec);
  const StudyFolder folder(dir);
  const std::size_t threads = options.common.threads > 0
                                  ? static_cast<std::size_t>(options.common.threads)
                                  : std::max(1U, std::thread::hardware_concurrency());
  const std::size_t jobs = options.jobs.value_or(threads);
  ExecConfig exec = exec_of(options.common);
  exec.num_threads = static_cast<int>(std::max<std::size_t>(1, threads / jobs));
  const InterruptGuard interrupt;
  const Stopwatch watch;
  const bool complete =
      make_runs(spec, folder, jobs, exec, interrupt.token(), [&](const StudyProgress& progress) {
        if (!options.common.quiet) print_progress(spec, progress, watch.seconds());
      });
  if (!complete) throw Stopped{"stopped; the same call goes on with what is in " + options.out};

  std::vector<ResultRow> rows;
  for (const StudyRun& run : spec.runs) rows.push_back(row_in(folder, spec, run));
  const Json json = results_json(spec, rows);
  const std::string table = results_markdown(spec, rows);
  std::error_code ignored;
  fs::resize_file(dir / "coverage.png", 0, ignored);  // of another spec perhaps; its mode stays
  write_file_atomically(dir / "results.csv", results_csv(json));
  write_file_atomically(dir / "table.md", table);
  write_file_atomically(dir / "plots.py", plots_script());
  write_file_atomically(dir / "results.json", json_text(json));
  const bool is_drawn = options.plots == "on" && draw_plots(dir / "plots.py");
  if (!is_drawn) fs::remove(dir / "coverage.png", ignored);
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
      "voxel and size of a spec, in one table. If it was stopped, the same call resumes it.");
  app->add_option(
         "SPEC", options->spec,
         "TOML file that says what to compare: lists objects, policies, seeds, sensors and "
         "voxels [m], and max_views; as you like also a list of sizes [m], against, "
         "tolerance [m], kept_candidates and a list of flags")
      ->required();
  app->add_option("--out", options->out, "folder for results; several machines may share it")
      ->required();
  app->add_option("--jobs", options->jobs, "runs at once; default: as many as threads")
      ->check(counted(1, 1000));
  add_switch(*app, "--plots", options->plots, "draw plots, where python3 has matplotlib");
  add_help(*app, kLoopGroup, "study spec.toml --out study");
  return command_of(app, options, study);
}

}  // namespace viewgain::app
