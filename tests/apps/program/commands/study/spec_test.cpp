// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0

// What a study's spec says, and how results are put together, held against sums by hand.
#include "program/commands/study/spec.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <set>
#include <string>
#include <vector>

#include "apps/program_runner.hpp"
#include "program/commands/study/results.hpp"
#include "viewgain/core/error.hpp"
#include "viewgain/literature/classic_gains.hpp"
#include "viewgain/support/json.hpp"

namespace viewgain {
namespace {

using ordered_json = viewgain::app::Json;

constexpr const char* kSpec = R"(objects = ["cube.off", "more/ball.off"]
policies = ["gain:combined", "frontier", "gain:rear_side_voxel"]
against = "frontier"
seeds = [3, 1]
sensors = ["sr4000", "tof.toml"]
voxels = [0.01, 0.005]
max_views = 5
flags = ["--up=y"]
)";

class StudySpecTest : public test::ProgramTest {
 protected:
  StudySpecTest() {
    register_gains(literature_gains());
    write_cube();
    write_half_sensor();
    write("more/ball.off", read("cube.off"));
  }

  [[nodiscard]] app::StudySpec spec_of(const std::string& text) const {
    write("spec.toml", text);
    return app::read_study_spec(dir / "spec.toml");
  }
  [[nodiscard]] std::string error_of(const std::string& text) const {
    try {
      (void)spec_of(text);
    } catch (const Error& error) {
      return error.what();
    }
    return "";
  }
  static std::string with(const std::string& from, const std::string& to) {
    std::string text = kSpec;
    text.replace(text.find(from), from.size(), to);
    return text;
  }
};

TEST_F(StudySpecTest, ListsAreCrossed) {
  const app::StudySpec spec = spec_of(kSpec);
  EXPECT_EQ(spec.runs.size(), 2U * 3 * 2 * 2 * 2);
  EXPECT_EQ(spec.against, 1U);
  EXPECT_EQ(spec.objects[1].name, "ball");
  EXPECT_EQ(spec.objects[1].mesh, dir / "more/ball.off");
  std::set<std::string> hashes;
  for (const app::StudyRun& run : spec.runs) hashes.insert(run.hash);
  EXPECT_EQ(hashes.size(), spec.runs.size());
  EXPECT_EQ(app::name_of(spec, spec.runs[2]),
            "cube, gain:rear_side_voxel, seed 3, sr4000, voxel 0.01");
  EXPECT_EQ(
      app::reconstruct_words(spec, spec.runs[2]),
      (Strings{"--sensor=sr4000", "--voxel=0.01", "--seed=3", "--max-views=5", "--tolerance=0.01",
               "--policy=gain", "--out=unused", "--gain=rear_side_voxel", "--up=y",
               "--stop=gain=0,area=0,idle=0,promises=0", "--", (dir / "cube.off").string()}));
}

TEST_F(StudySpecTest, CoverageIsNotCountedFinerThanVoxels) {
  EXPECT_EQ(spec_of(kSpec).tolerance, 0.01);  // the largest voxel
  EXPECT_EQ(spec_of(with("[0.01, 0.005]", "[0.002]")).tolerance, 0.005);
  EXPECT_EQ(spec_of(with("max_views", "tolerance = 0.003\nmax_views")).tolerance, 0.003);
}

TEST_F(StudySpecTest, HashesFollowWhatCanChangeAResult) {
  const std::string before = spec_of(kSpec).runs.back().hash;  // ball, tof.toml, 0.005, seed 1
  std::size_t cases = 0;
  for (const auto& [from, to] : std::vector<std::pair<std::string, std::string>>{
           {"max_views = 5", "max_views = 6"},
           {"max_views", "tolerance = 0.02\nmax_views"},
           {"max_views", "kept_candidates = 5\nmax_views"},
           {"--up=y", "--up=x"}}) {
    EXPECT_NE(spec_of(with(from, to)).runs.back().hash, before) << to;
    ++cases;
  }
  for (const char* file : {"more/ball.off", "tof.toml"}) {
    const std::string bytes = read(file);
    write(file, bytes + "# changed\n");
    EXPECT_NE(spec_of(kSpec).runs.back().hash, before) << file;
    write(file, bytes);
    ++cases;
  }
  // A file that a file of the flags names.
  write("reach.toml", "poses = \"poses.txt\"\n");
  write("poses.txt", "1");
  const std::string reach = (dir / "reach.toml").string();
  const std::string with_reach = with("--up=y", "--reach=" + reach);
  const std::string by_poses = spec_of(with_reach).runs.back().hash;
  write("poses.txt", "2");
  EXPECT_NE(spec_of(with_reach).runs.back().hash, by_poses);
  ++cases;
  EXPECT_EQ(cases, 7U);
  // A value that is none is not looked for on the disk.
  const std::string box = with("--up=y", "--body=" + reach), box_before = spec_of(box).runs[0].hash;
  write("reach.toml", "# changed\n");
  EXPECT_EQ(spec_of(box).runs[0].hash, box_before);
  // Neither what it stands beside nor where the files lie.
  EXPECT_EQ(spec_of(with("seeds = [3, 1]", "seeds = [1]")).runs.back().hash, before);
  EXPECT_EQ(spec_of(with("[\"cube.off\", ", "[")).runs.back().hash, before);
}

TEST_F(StudySpecTest, WhatIsWrongIsNamedWithItsLine) {
  struct Case {
    std::string from, to;
    Strings words;
  };
  const std::vector<Case> wrong{
      {"seeds = [3, 1]\n", "", {"\"seeds\" is missing"}},
      {"seeds = [3, 1]", "seeds = []", {"line 4", "seeds", "not empty"}},
      {"seeds = [3, 1]", "seeds = [1, 1]", {"line 4", "twice"}},
      {"seeds = [3, 1]", "seeds = [-1]", {"line 4"}},
      {"seeds = [3, 1]", "seeds = 3", {"line 4", "list"}},
      {"more/ball.off", "ball.off", {"line 1", "ball.off"}},
      {"more/ball.off", "./cube.off", {"line 1", "two objects", "cube"}},
      {"more/ball.off", "more/a\\nb.off", {"line 1", "a table cannot show"}},
      {"\"frontier\", ", "\"gain\", ", {"line 2", "\"gain\"", "gain:NAME"}},
      {"\"frontier\", ", "\"frontier:x\", ", {"line 2", "frontier:x"}},
      {"against = \"frontier\"", "against = \"random\"", {"line 3", "none of the policies"}},
      {"\"tof.toml\"", "\"no.toml\"", {"line 5", "no.toml"}},
      {"\"tof.toml\"", "\"sr400\"", {"line 5", "sr400"}},
      {"voxels = [0.01, 0.005]", "voxels = [0.0]", {"line 6", "positive"}},
      {"max_views = 5", "max_views = 0", {"line 7"}},
      {"--up=y", "--seed=4", {"line 8", "--seed"}},
      {"--up=y", "y", {"line 8", "--up=y"}},
      {"--up=y", "--help", {"line 8", "--help"}},
      {"gain:combined", "gain:combine", {"line 2", "combined"}},
      {"gain:combined", "gain:combined:", {"line 2", "gain:NAME"}},
      {"gain:combined", "tour:3", {"line 2", "tour:3", "tour:K:M"}},
      {"gain:combined", "tour:1:1", {"line 2", "tour:K:M"}},
      {"gain:combined", "tour:3:4", {"line 2", "tour:K:M"}},
      {"gain:combined", "tour:2000:1", {"line 2", "tour:K:M"}},
      {"--up=y", "--plan=3", {"line 8", "--plan"}},
      {"\"frontier\", ", "\"gain:combined\", ", {"line 2", "gain:combined", "twice"}},
      {"\"frontier\", ", "\"unknown_count\", ", {"line 2", "is \"gain:unknown_count\""}},
      {"max_views", "tolerance = 0\nmax_views", {"line 7", "tolerance", "positive"}},
      {"max_views", "kept_candidates = 0\nmax_views", {"line 7", "kept_candidates"}},
      {"max_views", "max_view", {"max_view"}},
  };
  std::filesystem::copy_file(dir / "cube.off", dir / "more/a\nb.off");
  for (const Case& each : wrong) {
    const std::string error = error_of(with(each.from, each.to));
    for (const std::string& word : each.words) {
      EXPECT_NE(error.find(word), std::string::npos) << each.to << ": " << error;
    }
  }
}

// A run of these coverages; the rest of its figures follow from the first.
ordered_json run_json(const std::vector<double>& coverage) {
  ordered_json json{{"stop_reason", "max_views"}, {"views", coverage.size()}};
  json["per_view"] = ordered_json::array();
  for (std::size_t i = 0; i < coverage.size(); ++i) {
    // The third view is as planned with the second.
    json["per_view"].push_back({{"coverage_visible", coverage[i]},
                                {"travelled", 0.5 * static_cast<double>(i)},
                                {"generator", i == 0   ? "start"
                                              : i == 2 ? "plan"
                                                       : "boundary"}});
  }
  json["coverage"] = 0.5 * coverage.back();
  json["rms_error"] = 1e-3 * coverage.front();
  json["consistency"] = ordered_json();
  json["outliers"] = 2;
  json["travelled"] = 1.5;
  json["isa"] = "AVX2";
  json["seconds"] = {{"candidates", 0.75}, {"score", 0.25}, {"total", 4.0}};
  return json;
}

TEST_F(StudySpecTest, ATourPlansByTheDefaultGain) {
  const app::StudySpec spec = spec_of(with("\"frontier\", ", "\"frontier\", \"tour:5:2\", "));
  const app::StudyRun& run = spec.runs[2];
  EXPECT_EQ(spec.policies[run.policy].name, "tour:5:2");
  const Strings words = app::reconstruct_words(spec, run);
  for (const char* word : {"--policy=gain", "--plan=5,2"}) {
    EXPECT_EQ(std::count(words.begin(), words.end(), word), 1) << word;
  }
  const app::ResultRow row = app::row_of(run, run_json({0.5}), spec.max_views);
  EXPECT_NE(app::results_csv(app::results_json(spec, {row})).find("cube,tour:5:2,,3,"),
            std::string::npos);
  EXPECT_NE(spec_of(with("gain:combined", "tour:5:2")).runs[0].hash,
            spec_of(with("gain:combined", "tour:5:3")).runs[0].hash);
}

// Every key, which the help names, and no other.
TEST_F(StudySpecTest, TheHelpHasTheKeys) {
  const std::string help = run_well({"study", "--help"});
  std::string all = kSpec;
  all += "sizes = [0.2]\ntolerance = 0.01\nkept_candidates = 3\n";
  EXPECT_EQ(error_of(all), "");
  std::size_t keys = 0;
  for (std::size_t at = 0; at < all.size(); at = all.find('\n', at) + 1) {
    const std::string key = all.substr(at, all.find(' ', at) - at);
    EXPECT_NE(help.find(key), std::string::npos) << key;
    ++keys;
  }
  EXPECT_EQ(keys, 11U);
  EXPECT_NE(error_of(all + "colour = 1\n").find("colour"), std::string::npos);
}

TEST_F(StudySpecTest, FiguresOfARun) {
  const app::StudySpec spec = spec_of(kSpec);
  // Falls under a goal again: the first time counts. Ends early: keeps its last.
  const app::ResultRow row =
      app::row_of(spec.runs[0], run_json({0.5, 0.85, 0.79, 0.9}), spec.max_views);
  EXPECT_EQ(row.coverage_by_view, (std::vector<double>{0.5, 0.85, 0.79, 0.9, 0.9}));
  EXPECT_EQ(row.views_to[0], 2U);
  EXPECT_EQ(row.views_to[1], 4U);
  EXPECT_FALSE(row.views_to[2]);
  EXPECT_EQ(row.counted_views_to(2), 6);
  EXPECT_DOUBLE_EQ(row.auc, (0.5 + 0.85 + 0.79 + 0.9 + 0.9) / 5);
  EXPECT_TRUE(std::isnan(row.consistency));
  EXPECT_EQ(row.metres_to, (std::array{0.5, 1.5, 1.5}));
  EXPECT_EQ(row.decisions, 2U);
  EXPECT_DOUBLE_EQ(row.deciding_seconds, 1.0 / 3);

  const ordered_json json = app::results_json(spec, {row});
  ASSERT_EQ(json.size(), 1U);
  EXPECT_EQ(json[0]["object"], "cube");
  EXPECT_EQ(json[0]["policy"], "gain");
  EXPECT_EQ(json[0]["gain"], "combined");
  EXPECT_EQ(json[0]["views_to_90"], 4);
  EXPECT_TRUE(json[0]["views_to_95"].is_null());
  EXPECT_EQ(json[0]["metres_to_80"], 0.5);
  const std::string csv = app::results_csv(json);
  EXPECT_NE(csv.find("\ncube,gain,combined,3,sr4000,0.01,,4,2,max_views,2,4,,0.5,1.5,1.5,"),
            std::string::npos)
      << csv;
}

TEST_F(StudySpecTest, TheTableIsThatByHand) {
  const std::string text =
      "objects = [\"cube.off\"]\npolicies = [\"gain:combined\", \"frontier\"]\nagainst = "
      "\"frontier\"\nseeds = [1, 2]\nsensors = [\"sr4000\"]\nvoxels = [0.01]\nmax_views = 2\n";
  const auto table_of = [&](const std::string& spec_text,
                            const std::vector<std::vector<double>>& coverages) {
    const app::StudySpec spec = spec_of(spec_text);
    std::vector<app::ResultRow> rows;
    for (std::size_t i = 0; i < coverages.size(); ++i) {
      rows.push_back(app::row_of(spec.runs[i], run_json(coverages[i]), spec.max_views));
    }
    return app::results_markdown(spec, rows);
  };
  // Seed 1: combined 2 and 2 views to 80 and 90 %, frontier never; seed 2 the same for both.
  const std::string table = table_of(text, {{0.6, 0.9}, {0.4, 0.7}, {0.8, 0.8}, {0.8, 0.8}});
  // Of two values that are d off their mean the interval is 12.706 d.
  for (const char* line :
       {"4 runs: cube; 2 seeds; 2 views.", "(within 10 mm)", "of 2 pairs p cannot be below 0.500",
        "the one object",
        "| gain:combined | 1.50 ± 6.35 / 1.5 / 0; 0.25 m | ≥ 2.50 / never / 1; 0.50 m | - | 0.775 "
        "± "
        "0.318 | 85.0 ± 63.5 % | 0.70 ± 1.27 | - | 1.5 ± 0.0 | 1.0 | 1.00 | 4.0 |",
        "| frontier | ≥ 2.00 / never / 1; 0.25 m | - | - | 0.675 ± 1.588 | 75.0 ± 63.5 % | 0.60 ± "
        "2.54 | - | 1.5 ± 0.0 | 1.0 | 1.00 | 4.0 |",
        "95 % interval (Student's t)",
        "| gain:combined | -0.50 ± 0.50 (1-1-0; 1.000, 1.000) | -0.50 ± 0.50 (1-1-0; 1.000, 1.000) "
        "| - | - | 0.100 ± 0.100 "
        "(1-1-0; 1.000, 1.000) | 0.10 ± 0.10 "
        "(0-1-1; 1.000, 1.000) |"}) {
    EXPECT_NE(table.find(line), std::string::npos) << line << "\n" << table;
  }
  // Differences of 0.1 on one object, of 0.3 on the other: as of two, not of four runs.
  std::string two = text;
  two.replace(two.find("\"cube.off\""), 10, "\"cube.off\", \"more/ball.off\"");
  const std::string clustered = table_of(two, {{0.6, 0.6},
                                               {0.5, 0.5},
                                               {0.6, 0.6},
                                               {0.5, 0.5},  // cube
                                               {0.8, 0.8},
                                               {0.5, 0.5},
                                               {0.8, 0.8},
                                               {0.5, 0.5}});  // ball
  for (const char* line : {"errors by object", "0.200 ± 0.100 (4-0-0; 0.125, 0.125)"}) {
    EXPECT_NE(clustered.find(line), std::string::npos) << line << "\n" << clustered;
  }
}

TEST_F(StudySpecTest, TextsAreQuotedWhereCsvNeedsIt) {
  app::StudySpec spec = spec_of(kSpec);
  const app::ResultRow row = app::row_of(spec.runs[0], run_json({0.5}), spec.max_views);
  for (const auto& [name, csv] : std::vector<std::array<std::string, 2>>{
           {"a b", "\na b,"}, {"a,b", "\n\"a,b\","}, {"a\"b\n", "\n\"a\"\"b\n\","}}) {
    spec.objects[0].name = name;
    EXPECT_NE(app::results_csv(app::results_json(spec, {row})).find(csv), std::string::npos)
        << name;
  }
}

}  // namespace
}  // namespace viewgain
