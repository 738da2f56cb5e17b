// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0

// What the program puts into a report; tests/apps/show/report tries the page in a browser.
#include <string>

#include "apps/program_runner.hpp"
#include "program/cli/json.hpp"

namespace viewgain {
namespace {

class Reports : public test::ProgramTest {
 protected:
  Reports() {
    write_cube();
    write_half_sensor();
  }
  [[nodiscard]] test::ProgramResult reconstruct(const std::string& report) const {
    return run({"reconstruct", "cube.off", "--size", "0.3", "--sensor", "tof.toml", "--voxel",
                "0.01", "--out", "run", "--max-views", "3", "--pictures", "off", "--report",
                report});
  }
  // What the page holds.
  [[nodiscard]] json data(const std::string& name) const {
    const std::string page = read(name);
    const std::string begin = "<script type=\"application/json\" id=\"data\">";
    const std::size_t from = page.find(begin) + begin.size();
    return json::parse(page.substr(from, page.find("</script>", from) - from));
  }
};

TEST_F(Reports, HoldTheRunAndTheRanking) {
  const test::ProgramResult result = reconstruct("on");
  if (result.err.find("npm was missing") != std::string::npos) {
    EXPECT_EQ(result.exit_code, 2);
    GTEST_SKIP() << "built without npm";
  }
  ASSERT_EQ(result.exit_code, 0) << result.err;
  const json page = data("run/report.html"), run_json = json::parse(read("run/run.json"));
  EXPECT_EQ(page.at("kind"), "reconstruct");
  EXPECT_TRUE(page.at("title").get<std::string>().starts_with("cube.off, "));
  EXPECT_EQ(page.at("settings"), run_json.at("settings"));
  EXPECT_EQ(page.at("truth").at("vertices").at("rows"), 8);
  ASSERT_EQ(page.at("views").size(), 3U);
  std::size_t chosen = 0;
  for (std::size_t i = 0; i < 3; ++i) {
    const json& view = page.at("views").at(i);
    EXPECT_EQ(view.at("figures"), run_json.at("per_view").at(i));
    const json& mesh = view.at("surface");
    EXPECT_EQ(mesh.at("sigma").at("rows"), mesh.at("vertices").at("rows"));
    EXPECT_EQ(mesh.at("error").at("rows"), mesh.at("vertices").at("rows"));
    const json& candidates = view.at("candidates");
    const std::size_t all = candidates.at("poses").at("rows");
    for (const char* list : {"class", "generator", "reason"}) {
      EXPECT_EQ(candidates.at(list).size(), all) << list;
    }
    if (i + 1 < 3) {
      // As many as the next view says it was chosen from, and were dropped.
      const json& next = run_json.at("per_view").at(i + 1);
      std::size_t dropped = 0;
      for (const auto& [reason, count] : next.at("dropped").items()) {
        dropped += count.get<std::size_t>();
      }
      EXPECT_EQ(all, next.at("candidates").get<std::size_t>() + dropped);
    }
    EXPECT_FALSE(view.at("picture").get<std::string>().empty());
    if (view.at("chosen").is_null()) continue;
    EXPECT_GT(view.at("bundle").at("kind").at("rows"), 0);
    EXPECT_GT(view.at("expected").at("value").at("rows"), 0);
    ++chosen;
  }
  EXPECT_EQ(chosen, 2U);

  run_well({"score", "run/map.vdb", "--sphere", "30,0.6", "--gain", "combined", "--report",
            "score.html", "--out", "scores.csv"});
  const json score = data("score.html");
  EXPECT_EQ(score.at("kind"), "score");
  EXPECT_EQ(score.at("score").at("rows").size(), 30U);
  EXPECT_EQ(score.at("score").at("shown").size(), 10U);
  EXPECT_EQ(score.at("score").at("columns").at(2), "area");
  // Best first.
  for (std::size_t i = 1; i < 30; ++i) {
    EXPECT_GE(score.at("score").at("rows").at(i - 1).at(1),
              score.at("score").at("rows").at(i).at(1));
  }

  // A later run in the folder takes the report of the one before with it.
  ASSERT_EQ(reconstruct("off").exit_code, 0);
  EXPECT_FALSE(std::filesystem::exists(dir / "run" / "report.html"));
}

}  // namespace
}  // namespace viewgain
