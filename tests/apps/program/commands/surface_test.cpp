// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0

// `viewgain surface` as a user would run it, on the map of a short run.
#include <string>

#include "apps/program_runner.hpp"
#include "program/cli/json.hpp"

namespace viewgain {
namespace {

class Surface : public test::ProgramTest {
 protected:
  Surface() { make_small_run(); }
};

// The loop's own surface, points and figures come from the same map.
TEST_F(Surface, IsThatOfTheRunThatMadeTheMap) {
  const json result =
      json::parse(run_well({"surface", "run/map.vdb", "--out", "s.ply", "--points", "p.ply",
                            "--truth", "cube.off", "--size", "0.2", "--recenter", "on", "--json"}));
  EXPECT_EQ(read("s.ply"), read("run/surface.ply"));
  EXPECT_EQ(read("p.ply"), read("run/points.ply"));
  EXPECT_GT(result["points"], 500);
  EXPECT_GT(result["triangles"], 500);
  EXPECT_GT(result["median_sigma"].get<double>(), 1e-5);
  const json last = json::parse(read("run/run.json"))["per_view"].back();
  EXPECT_NEAR(result["area"].get<double>(), last["surface_area"].get<double>(), 1e-12);
  for (const char* figure : {"coverage", "coverage_2_5mm", "rms_error", "p95_error",
                             "rms_error_points", "p95_error_points", "consistency",
                             "consistency_median", "consistency_above_9", "outliers"}) {
    EXPECT_NEAR(result["truth"][figure].get<double>(), last[figure].get<double>(), 1e-9) << figure;
  }
  // Two views see part of a cube, and what they see is mostly in the map.
  const double seen = result["truth"]["coverage_seen"];
  EXPECT_GT(seen, result["truth"]["coverage"].get<double>() + 0.1);
  EXPECT_GT(seen, 0.65);
}

TEST_F(Surface, SaysWithoutATruthWhatItMade) {
  const std::string text = run_well({"surface", "run/map.vdb", "--out", "s.ply"});
  EXPECT_NE(text.find("triangles"), std::string::npos);
  EXPECT_NE(text.find("s.ply"), std::string::npos);
  EXPECT_EQ(text.find("truth"), std::string::npos);
  const json points =
      json::parse(run_well({"surface", "run/map.vdb", "--points", "only.ply", "--json"}));
  EXPECT_TRUE(points["out"].is_null());
  EXPECT_TRUE(points["truth"].is_null());
  EXPECT_EQ(read("only.ply"), read("run/points.ply"));
}

TEST_F(Surface, WhatCannotBeMadeIsRefused) {
  run_well({"convert", "run/map.vdb", "tree.ot"});
  const test::Refusals calls{
      {{"run/map.vdb"}, "--out"},
      {{"run/map.vdb", "--out", "s.ply", "--size", "0.2"}, "--truth"},
      {{"run/map.vdb", "--out", "s.ply", "--up", "y"}, "--truth"},
      {{"run/map.vdb", "--out", "s.ply", "--truth", "cube.off", "--size", "0"}, "--size"},
      {{"run/map.vdb", "--out", "s.ply", "--truth", "none.off"}, "none.off"},
      {{"run/map.vdb", "--out", "run/map.vdb"}, "map.vdb"},
      {{"run/map.vdb", "--out", "s.ply", "--points", "s.ply"}, "s.ply"},
      {{"none.vdb", "--out", "s.ply"}, "none.vdb"},
      {{"tree.ot", "--out", "s.ply"}, "tree.ot"}};
  expect_refused_with({"surface"}, calls);
}

}  // namespace
}  // namespace viewgain
