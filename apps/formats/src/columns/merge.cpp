// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <queue>
#include <string>
#include <utility>

#include "viewgain/core/error.hpp"
#include "viewgain/support/columns/parts.hpp"

namespace viewgain {
namespace {

namespace fs = std::filesystem;

[[noreturn]] void refuse(const std::string& what) {
  throw Error(ErrorCode::invalid_argument, what);
}

std::string rows_text(const RowRange& rows) { return "rows " + text_of(rows); }

// The best rows so far, the worst of them on top.
class Best {
 public:
  Best(std::size_t most, std::size_t row_bytes) : most_(most), row_bytes_(row_bytes) {}

  void add(const char* row) {
    Entry entry{value_at<double>(row + sizeof(std::int64_t)), value_at<std::int64_t>(row), {}};
    if (heap_.size() >= most_ && (most_ == 0 || !is_better(entry, heap_.top()))) return;
    entry.row.assign(row, row_bytes_);
    heap_.push(std::move(entry));
    if (heap_.size() > most_) heap_.pop();
  }
  // Best first. Empties it.
  std::string take() {
    std::string rows(heap_.size() * row_bytes_, '\0');
    for (std::size_t rank = heap_.size(); rank > 0; heap_.pop()) {
      heap_.top().row.copy(rows.data() + --rank * row_bytes_, row_bytes_);
    }
    return rows;
  }

 private:
  struct Entry {
    double gain;
    std::int64_t number;
    std::string row;
  };
  static bool is_better(const Entry& a, const Entry& b) {
    const bool a_is_number = !std::isnan(a.gain), b_is_number = !std::isnan(b.gain);
    if (a_is_number != b_is_number) return a_is_number;
    if (a_is_number && a.gain != b.gain) return a.gain > b.gain;
    return a.number < b.number;
  }
  struct IsBetter {
    bool operator()(const Entry& a, const Entry& b) const { return is_better(a, b); }
  };
  std::size_t most_, row_bytes_;
  std::priority_queue<Entry, std::vector<Entry>, IsBetter> heap_;
};

struct Part {
  fs::path path;
  RowRange rows;
};

struct Job {
  PartHead head;  // of the whole
  std::vector<Column> columns;
  std::vector<Part> parts;  // by rows
};

Job job_of(const std::vector<fs::path>& paths) {
  if (paths.empty()) refuse("there is no part to merge");
  Job job;
  for (const fs::path& path : paths) {
    const PartReader reader(path);
    const PartHead& head = reader.head();
    const std::string name = path.string(), first = paths.front().string();
    if (head.is_best) refuse(name + ": holds the best only and is no part");
    if (job.parts.empty()) {
      job.head = head;
      job.head.scored = 0;
      job.columns = reader.columns();
    }
    const std::string differs = difference(head, job.head, first);
    if (!differs.empty()) refuse(name + ": " + differs);
    if (reader.columns() != job.columns) {
      std::string mine = csv_columns(reader.columns()), other = csv_columns(job.columns);
      mine.pop_back();
      other.pop_back();
      refuse(name + ": columns " + mine + ", not " + other + " as in " + first);
    }
    job.head.scored += head.scored;
    job.parts.push_back({path, head.rows});
  }
  job.head.rows = {0, job.head.poses};
  std::stable_sort(job.parts.begin(), job.parts.end(), [](const Part& a, const Part& b) {
    return std::pair(a.rows.begin, a.rows.end) < std::pair(b.rows.begin, b.rows.end);
  });
  return job;
}

void check_complete(const Job& job) {
  std::vector<RowRange> missing;
  RowRange before;  // the rows so far
  const Part* last = nullptr;
  for (const Part& part : job.parts) {
    if (part.rows.begin == part.rows.end) continue;  // a shard of fewer poses than shards
    if (part.rows.begin < before.end) {
      refuse(part.path.string() + ": " + rows_text(part.rows) + " overlap " +
             rows_text(last->rows) + " of " + last->path.string());
    }
    if (part.rows.begin > before.end) missing.push_back({before.end, part.rows.begin});
    before.end = part.rows.end;
    last = &part;
  }
  if (before.end < job.head.poses) missing.push_back({before.end, job.head.poses});
  if (missing.empty()) return;
  constexpr std::size_t kNamed = 20;
  std::string text;
  for (std::size_t i = 0; i < std::min(missing.size(), kNamed); ++i) {
    text += (i == 0 ? "" : ", ") + text_of(missing[i]);
  }
  if (missing.size() > kNamed) text += " and " + std::to_string(missing.size() - kNamed) + " more";
  refuse("rows " + text + " of " + std::to_string(job.head.poses) + " are in no part");
}

}  // namespace

Merged merge_parts(const std::vector<fs::path>& paths, const fs::path& out,
                   std::optional<std::size_t> top, std::size_t shown,
                   const std::function<void(std::size_t, std::size_t)>& progress) {
  const Job job = job_of(paths);
  check_complete(job);
  Merged merged{job.head, {job.columns}};
  if (top) {
    merged.head.is_best = true;
    merged.head.scored = std::min<std::uint64_t>(*top, job.head.scored);
  }
  PartWriter writer(out, job.columns, merged.head);
  const std::size_t bytes = row_bytes(job.columns);
  Best best(top.value_or(shown), bytes);
  std::size_t done = 0;
  for (const Part& part : job.parts) {
    PartReader reader(part.path);
    if (!difference(reader.head(), job.head, "").empty() || reader.head().rows != part.rows) {
      refuse(part.path.string() + ": was changed while it was read");
    }
    while (const char* row = reader.next()) {
      best.add(row);
      if (!top) writer.add({row, bytes});
      if (++done % 4096 == 0) progress(done, job.head.scored);
    }
  }
  merged.best.bytes = best.take();
  if (top) writer.add(merged.best.bytes);
  writer.commit();
  return merged;
}

}  // namespace viewgain
