// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "program/commands/study/runs.hpp"

#include <chrono>
#include <exception>
#include <mutex>
#include <optional>
#include <system_error>
#include <thread>
#include <utility>

#include "program/cli/json_text.hpp"
#include "program/commands/study/claims.hpp"
#include "viewgain/core/error.hpp"
#include "viewgain/core/pose_io.hpp"
#include "viewgain/support/atomic_file.hpp"
#include "viewgain/support/file_bytes.hpp"
#include "viewgain/support/stopwatch.hpp"

namespace viewgain::app {
namespace {

namespace fs = std::filesystem;

void make_folder(const fs::path& folder) {
  std::error_code failed;
  fs::create_directories(folder, failed);
  if (failed) throw Error(ErrorCode::io, folder.string() + ": " + failed.message());
}

// Deals out the runs that are not there and that nobody else works on.
class Workers {
 public:
  Workers(const StudySpec& spec, const StudyFolder& folder, int threads, std::stop_token stop,
          const std::function<void(const StudyProgress&)>& on_progress)
      : spec_(spec),
        folder_(folder),
        threads_(threads),
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
    const std::optional<StudyResult> result = make_run(spec_, run, threads_, either.get_token());
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
  const int threads_;
  const std::stop_token stop_;
  const std::function<void(const StudyProgress&)>& on_progress_;
  Claims claims_;
  std::mutex mutex_;
  std::vector<bool> is_there_, is_under_way_;
  StudyProgress progress_;
  std::exception_ptr failure_;
  std::stop_source ours_;  // when one has failed
};

}  // namespace

StudyFolder::StudyFolder(const fs::path& dir) : dir_(dir) { make_folder(runs()); }

fs::path StudyFolder::file(const StudyRun& run, const char* name) const {
  return runs() / run.hash / name;
}

bool StudyFolder::has(const StudyRun& run) const {
  std::error_code ignored;
  return fs::exists(file(run, "run.json"), ignored);
}

Json StudyFolder::read(const StudyRun& run) const {
  const fs::path path = file(run, "run.json");
  Json json = parse_or_null(file_bytes(path));
  if (!json.is_object() || !json.contains("configuration") ||
      json["configuration"] != run.configuration) {
    throw Error(ErrorCode::format,
                path.string() + ": is not of the run that its folder stands for");
  }
  return json;
}

void StudyFolder::write(const StudyRun& run, const StudyResult& result) const {
  make_folder(runs() / run.hash);
  if (!result.candidates.empty()) {
    write_tum(file(run, "candidates.txt"), result.candidates, result.candidate_views);
  }
  write_file_atomically(file(run, "run.json"), json_text(result.run));
}

bool make_runs(const StudySpec& spec, const StudyFolder& folder, std::size_t jobs, int threads,
               const std::stop_token& stop,
               const std::function<void(const StudyProgress&)>& on_progress) {
  Workers workers(spec, folder, threads, stop, on_progress);
  {
    std::vector<std::jthread> team;
    for (std::size_t i = 1; i < jobs; ++i) team.emplace_back([&] { workers.work(); });
    workers.work();
  }
  return workers.end();
}

}  // namespace viewgain::app
