// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0

#include <png.h>

#include <set>
#include <string>
#include <vector>

#include "apps/program_runner.hpp"
#include "viewgain/core/error.hpp"
#include "viewgain/formats/png.hpp"
#include "viewgain/formats/sensor_toml.hpp"
#include "viewgain/support/json.hpp"

namespace viewgain {
namespace {

// How many colours a picture has.
std::size_t colours(const RgbImage& image) {
  std::set<std::array<std::uint8_t, 3>> found;
  for (std::size_t i = 0; i < image.pixels.size(); i += 3) {
    found.insert({image.pixels[i], image.pixels[i + 1], image.pixels[i + 2]});
  }
  return found.size();
}

class Render : public test::ProgramTest {
 protected:
  Render() {
    write_cube();
    write_half_sensor();
  }
  // A run of two views of the cube.
  void make_run(const std::string& name, const std::vector<std::string>& more = {}) const {
    run_well(
        test::joined({"reconstruct", "cube.off", "--size", "0.3", "--sensor", "tof.toml", "--voxel",
                      "0.01", "--out", name, "--max-views", "2", "--json", "--quiet"},
                     more));
  }
  [[nodiscard]] RgbImage rendered(std::vector<std::string> call) const {
    call.insert(call.begin(), "render");
    call.insert(call.end(), {"--out", "picture.png"});
    run_well(call);
    png_image png{};
    png.version = PNG_IMAGE_VERSION;
    RgbImage image;
    if (png_image_begin_read_from_file(&png, (dir / "picture.png").c_str()) == 0) return image;
    png.format = PNG_FORMAT_RGB;
    image = {static_cast<int>(png.width), static_cast<int>(png.height), {}};
    image.pixels.resize(PNG_IMAGE_SIZE(png));
    (void)png_image_finish_read(&png, nullptr, image.pixels.data(), 0, nullptr);
    return image;
  }
};

TEST_F(Render, EachKindIsAPictureOfTheSizeThatWasAsked) {
  make_run("run");
  const std::vector<std::vector<std::string>> kinds{{"run", "map"},
                                                    {"run/map.vdb", "surface"},
                                                    {"run", "sigma"},
                                                    {"run", "surface", "--viewer", "120,-10,320"}};
  std::vector<RgbImage> pictures;
  for (std::vector<std::string> call : kinds) {
    if (call.back() != "120,-10,320") call.insert(call.end(), {"--viewer", "30,24,320"});
    pictures.push_back(rendered(call));
    EXPECT_EQ(pictures.back().width, 320);
    EXPECT_EQ(pictures.back().height, 240);
    EXPECT_GT(colours(pictures.back()), 50U) << call[2];
    for (std::size_t i = 0; i + 1 < pictures.size(); ++i) {
      EXPECT_NE(pictures[i].pixels, pictures.back().pixels) << i << ", " << call[2];
    }
  }
  EXPECT_EQ(pictures.size(), 4U);
}

TEST_F(Render, SaysWhatItCannotDraw) {
  make_run("run", {"--pictures", "off"});
  const test::Refusals cases{{{"run", "gain"}, "KIND: unknown kind of picture gain"},
                             {{"no-such-run", "map"}, "no-such-run"},
                             {{"cube.off", "map"}, "cube.off"}};
  expect_refused_with({"render", "--out", "picture.png"}, cases);
  expect_refused({"render", "run", "map", "--out", "map.jpg"}, ".png");
  expect_refused({"render", "run", "map", "--out", "run/map.vdb"}, "run/map.vdb");
}

TEST_F(Render, MapsRememberTheirSensor) {
  make_run("run");
  const json info = json::parse(run_well({"info", "run/map.vdb", "--json"}));
  const std::string sensor = info.at("sensor");
  EXPECT_FALSE(sensor.empty());
  // A map of two does not say which.
  run_well({"simulate", "cube.off", "--poses", "orbit:1,0.6,20", "--size", "0.3", "--sensor",
            "d435", "--out", "frames"});
  const test::ProgramResult two =
      run({"integrate", "frames", "--map", "run/map.vdb", "--out", "two.vdb"});
  EXPECT_EQ(two.exit_code, 0);
  EXPECT_NE(two.err.find("--sensor d435 differs: "), std::string::npos) << two.err;
  EXPECT_NE(two.err.find(" in the map, "), std::string::npos) << two.err;
  EXPECT_TRUE(json::parse(run_well({"info", "two.vdb", "--json"})).at("sensor").is_null());

  // A stranger's name writes no line of its own.
  std::string hostile = sensor_toml(sensor_preset("d435"));
  const std::string name = "\"d435\"";
  ASSERT_NE(hostile.find(name), std::string::npos);
  hostile.replace(hostile.find(name), name.size(), "\"d435\\nhash  0\\u001b[31m\"");
  write("hostile.toml", hostile);
  run_well({"integrate", "frames", "--sensor", "hostile.toml", "--voxel", "0.02", "--out",
            "hostile.vdb"});
  const std::string text = run_well({"info", "hostile.vdb"});
  EXPECT_NE(text.find(" d435 hash  0?[31m\n"), std::string::npos) << text;
  EXPECT_EQ(text.find('\x1b'), std::string::npos) << text;

  // It does not go into a tree.
  run_well({"convert", "run/map.vdb", "tree.ot"});
  const test::ProgramResult none = run({"score", "tree.ot", "--poses", "sphere:20,0.6"});
  EXPECT_EQ(none.exit_code, 2);
  EXPECT_NE(none.err.find("--sensor"), std::string::npos) << none.err;
}

// `viewgain surface` as a user would run it, on the map of a short run.

class Surface : public test::ProgramTest {
 protected:
  Surface() { make_small_run(); }
};

TEST_F(Surface, ATruthInMillimetresOrElsewhereIsNamed) {
  write("mm.off", "OFF\n3 1 0\n-100 -100 0\n100 -100 0\n0 100 50\n3 0 1 2\n");
  for (const auto& [more, is_named] : std::vector<std::pair<std::vector<std::string>, bool>>{
           {{"mm.off"}, true}, {{"cube.off", "--size", "0.2", "--place", "center"}, false}}) {
    const std::string said =
        run(test::joined({"surface", "run/map.vdb", "--out", "s.ply", "--truth"}, more)).err;
    EXPECT_EQ(said.find("Is the mesh in metres, and at the place of the object? (--size") !=
                  std::string::npos,
              is_named)
        << said;
  }
}

// The loop's own surface, points and figures come from the same map.
TEST_F(Surface, IsThatOfTheRunThatMadeTheMap) {
  const json result = json::parse(
      run_well({"surface", "run/map.vdb", "--out", "s.ply", "--points", "p.ply", "--truth",
                "cube.off", "--size", "0.2", "--place", "center", "--json"}));
  EXPECT_EQ(read("s.ply"), read("run/surface.ply"));
  EXPECT_EQ(read("p.ply"), read("run/points.ply"));
  const json last = json::parse(read("run/run.json"))["per_view"].back();
  EXPECT_NEAR(result["area"].get<double>(), last["surface_area"].get<double>(), 1e-12);
  EXPECT_GT(result["truth"]["coverage_triangles"], result["truth"]["coverage_seen"]);
  for (const char* figure : {"coverage", "coverage_2_5mm", "rms_error", "p95_error",
                             "rms_error_points", "p95_error_points", "consistency",
                             "consistency_median", "consistency_above_9", "outliers"}) {
    EXPECT_NEAR(result["truth"][figure].get<double>(), last[figure].get<double>(), 1e-9) << figure;
  }
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

// What the program puts into a report; tests/apps/show/report tries the page in a browser.

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
  if (!has_report_page()) {
    EXPECT_EQ(result.exit_code, 2);
    EXPECT_NE(result.err.find("without the report page"), std::string::npos) << result.err;
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
    if (view.at("chosen").is_null()) continue;
    EXPECT_GT(view.at("bundle").at("kind").at("rows"), 0);
    EXPECT_GT(view.at("expected").at("value").at("rows"), 0);
    ++chosen;
  }
  EXPECT_EQ(chosen, 2U);

  run_well({"score", "run/map.vdb", "--poses", "sphere:30,0.6", "--gain", "combined", "--report",
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

  // The run of another folder stands beside it.
  EXPECT_TRUE(page.at("beside").is_null());
  run_well({"reconstruct", "cube.off", "--size", "0.3", "--sensor", "tof.toml", "--voxel", "0.01",
            "--out", "second", "--max-views", "2", "--policy", "random", "--report", "run",
            "--quiet"});
  const std::string text =
      run_well({"reconstruct", "cube.off", "--size", "0.25", "--sensor", "tof.toml", "--voxel",
                "0.01", "--out", "other", "--max-views", "1", "--report", "run", "--quiet"});
  EXPECT_NE(text.find("run for comparison: 3 views, "), std::string::npos) << text;
  EXPECT_NE(text.find("; other settings: size\n"), std::string::npos) << text;
  const json beside = data("second/report.html").at("beside");
  EXPECT_EQ(beside.at("name"), "run");
  EXPECT_EQ(beside.at("settings"), run_json.at("settings"));
  EXPECT_EQ(beside.at("per_view"), run_json.at("per_view"));
  write("none/run.json", "{\"settings\": {}}");
  expect_refused({"reconstruct", "cube.off", "--size", "0.3", "--sensor", "tof.toml", "--voxel",
                  "0.01", "--out", "third", "--report", "none"},
                 "none/run.json: the file is invalid; --report requires the folder of a run");
  json newer = run_json;
  newer["format"] = 2;
  write("none/run.json", newer.dump());
  expect_refused(
      {"reconstruct", "cube.off", "--size", "0.3", "--sensor", "tof.toml", "--voxel", "0.01",
       "--out", "third", "--report", "none"},
      "none/run.json: the file's format, 2, is too new; this program reads formats up to 1");

  // A later run in the folder takes the report of the one before with it.
  ASSERT_EQ(reconstruct("off").exit_code, 0);
  EXPECT_FALSE(std::filesystem::exists(dir / "run" / "report.html"));
}

}  // namespace
}  // namespace viewgain
