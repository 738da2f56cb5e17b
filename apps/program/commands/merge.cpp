// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "program/cli/progress.hpp"
#include "program/cli/values.hpp"
#include "program/commands/commands.hpp"
#include "viewgain/support/columns/parts.hpp"

namespace viewgain::app {
namespace {

constexpr std::size_t kShown = 10;

struct Options {
  CommonOptions common;
  std::vector<std::string> parts;
  std::string out;
  std::optional<std::size_t> top;
};

// The best rows: number and gain.
Json best_json(const Table& best) {
  const std::size_t bytes = row_bytes(best.columns);
  Json list = Json::array();
  for (std::size_t i = 0; i < std::min(best.size(), kShown); ++i) {
    const char* row = best.bytes.data() + i * bytes;
    list.push_back({{"index", value_at<std::int64_t>(row)},
                    {best.columns[1].name, value_at<double>(row + sizeof(std::int64_t))}});
  }
  return list;
}

void print_table(const Options& options, const Merged& merged) {
  const Table& best = merged.best;
  const std::size_t bytes = row_bytes(best.columns);
  std::printf("%4s %10s %12s\n", "rank", "index", best.columns[1].name.c_str());
  for (std::size_t i = 0; i < std::min(best.size(), kShown); ++i) {
    const char* row = best.bytes.data() + i * bytes;
    std::printf("%4zu %10lld %12.6g\n", i + 1, static_cast<long long>(value_at<std::int64_t>(row)),
                value_at<double>(row + sizeof(std::int64_t)));
  }
  std::printf("%zu %s of %s poses, %s rows left in %s\n", options.parts.size(),
              options.parts.size() == 1 ? "part" : "parts", with_commas(merged.head.poses).c_str(),
              with_commas(merged.head.scored).c_str(), options.out.c_str());
}

void merge(const Options& options) {
  const std::vector<std::filesystem::path> parts(options.parts.begin(), options.parts.end());
  Merged merged;
  {
    Progress progress("row", options.common.quiet);
    merged =
        merge_parts(parts, options.out, options.top, kShown,
                    [&](std::size_t done, std::size_t total) { progress.update(done, total); });
  }
  if (!options.common.json) return print_table(options, merged);
  const PartHead& head = merged.head;
  print_json({{"parts", parts.size()},
              {"poses", head.poses},
              {"rows", head.scored},
              {"map", head.map},
              {"sensor", head.sensor},
              {"isa", head.isa},
              {"version", head.version},
              {"best", best_json(merged.best)}});
}

}  // namespace

Command add_merge(App& program) {
  auto options = std::make_shared<Options>();
  App* app = program.add_subcommand(
      "merge",
      "Puts parts that score --shard has left together, or takes the best of them; "
      "refuses parts of different jobs and names what is missing.");
  app->add_option("PART", options->parts, "files of score --shard, CSV or .npy")->required();
  app->add_option("--out", options->out, "CSV file, or .npy, of all rows in order, or of the best")
      ->required();
  app->add_option(
         "--top", options->top,
         "so many of the best alone, best first: ties to the lower row, NaN last; default: "
         "all rows")
      ->check(counted(0, 1'000'000'000));
  add_common_options(*app, options->common);
  add_help(*app, kViewsGroup, "merge part.csv --out best.csv --top 5");
  return {app, [options] { merge(*options); }};
}

}  // namespace viewgain::app
