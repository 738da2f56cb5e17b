// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0

// `model --watch` beside a program that writes frames, quickly, slowly and wrongly.

#include <sys/wait.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <chrono>
#include <csignal>
#include <filesystem>
#include <fstream>
#include <numeric>
#include <optional>
#include <random>
#include <set>
#include <sstream>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "apps/planner/planner_set_up.hpp"
#include "apps/program_runner.hpp"
#include "core/temporary_folder.hpp"
#include "support/pose_file_text.hpp"
#include "viewgain/core/pose_io.hpp"
#include "viewgain/formats/frames.hpp"
#include "viewgain/formats/map_file.hpp"
#include "viewgain/formats/png.hpp"
#include "viewgain/support/json.hpp"

namespace viewgain {
namespace {

using namespace std::chrono_literals;
using test::matrix_text;

constexpr std::size_t kGood = 30;
constexpr double kVoxel = 0.025;  // [m]

// Files that are replaced while they are read are whole at any time.
class Reader {
 public:
  explicit Reader(fs::path folder) : folder_(std::move(folder)), thread_([this] { read(); }) {}
  ~Reader() { stop(); }
  Reader(const Reader&) = delete;
  Reader& operator=(const Reader&) = delete;
  void stop() {
    is_over_ = true;
    if (thread_.joinable()) thread_.join();
  }
  std::string fault{};
  std::size_t reads = 0;  // of both files

 private:
  void read() {
    while (!is_over_) {
      const std::string poses = test::read_all(folder_ / "next.txt");
      const std::string text = test::read_all(folder_ / "next.json");
      std::this_thread::sleep_for(1ms);
      if (poses.empty() || text.empty()) continue;  // not there yet
      ++reads;
      std::istringstream lines(poses);
      std::size_t numbers = 0;
      for (std::string line; std::getline(lines, line);) {
        if (line.starts_with("#")) continue;
        std::istringstream words(line);
        for (double number = 0; words >> number;) ++numbers;
      }
      if (numbers % 8 != 0 || !poses.ends_with('\n')) fault = "next.txt: " + poses;
      const json read = app::parse_or_null(text);
      if (read.is_null() || !read.contains("next")) fault = "next.json: " + text;
    }
  }

  fs::path folder_;
  std::atomic<bool> is_over_{false};
  std::thread thread_;
};

class Watch : public test::ProgramTest {
 protected:
  Watch() {
    write_cube();
    write_small_sensor();
    // 30 views of a cube of 0.2 m; they come into "live" as a recorder writes them.
    run_well({"simulate", "cube.off", "--poses", "orbit:30,0.6,27", "--sensor", "small.toml",
              "--size", "0.2", "--place", "center", "--out", "whole"});
    const FrameSequence frames = open_frames(dir / "whole");
    for (std::size_t i = 0; i < kGood; ++i) {
      images.push_back(test::read_all(frames.images[i]));
      poses.push_back(matrix_text(frames.poses[i]));
    }
    write("live/sensor.toml", read("small.toml"));
    write("live/depth-scale.txt", "1e-4\n");
  }

  static std::string name(std::size_t number) {
    std::string digits = std::to_string(number);
    return "live/frame-" + std::string(6 - digits.size(), '0') + digits;
  }

  void put(std::size_t number) const {
    write(name(number) + ".depth.png", images[number]);
    write(name(number) + ".pose.txt", poses[number]);
  }

  // A folder of one frame, and nothing made of it.
  void begin_with_one_frame() const {
    fs::remove_all(dir / "live");
    fs::remove_all(dir / "plan");
    write("live/sensor.toml", read("small.toml"));
    write("live/depth-scale.txt", "1e-4\n");
    put(0);
    write("live/done", "");
  }

  // Of next.json.
  static Pose best_of(const json& next) {
    Pose best;
    for (std::size_t k = 0; k < 12; ++k) {
      best.m[k] = next["next"][0]["T_world_camera"][k / 4][k % 4].get<double>();
    }
    return best;
  }

  static Strings watch(const Strings& more = {}) {
    return test::joined(
        {"model", "live", "--watch", "--voxel", "0.025", "--workspace",
         "-0.2,-0.2,-0.2,0.2,0.2,0.2", "--jump-edge-filter", "off", "--out", "plan", "--quiet"},
        more);
  }

  static int end_of(pid_t child) {
    int status = 0;
    EXPECT_EQ(::waitpid(child, &status, 0), child);
    return status;
  }

  // When the state was written last.
  [[nodiscard]] fs::file_time_type state_time() const {
    std::error_code ignored;
    return fs::last_write_time(dir / "plan/state.vdb", ignored);
  }

  // Until next.json says so many frames.
  [[nodiscard]] bool wait_for(std::size_t frames) const {
    for (int tries = 0; tries < 2000; ++tries) {
      const json next = app::parse_or_null(read("plan/next.json"));
      if (!next.is_null() && next["frames"] == frames) return true;
      std::this_thread::sleep_for(5ms);
    }
    return false;
  }

  // The frames of the state, each once, in the order of its views, by another way: put into a
  // planner of the test's own.
  void expect_each_once(std::size_t count) const {
    const BeliefGrid map = load_map(dir / "plan/state.vdb");
    const FrameSequence frames = open_frames(dir / "whole");
    ASSERT_EQ(map.views().size(), count);
    test::PlannerSetUp config;
    config.map.voxel_size = kVoxel;
    config.map.workspace = {{-0.2, -0.2, -0.2}, {0.2, 0.2, 0.2}};
    config.map.jump_edges.reset();
    ViewPlanner planner = config.make(frames.sensor, {1});
    std::set<std::string> identities;
    for (const Pose& view : map.views()) {
      const auto is_from_there = [&](const Pose& pose) {
        return pose.translation() == view.translation();
      };
      const auto at = std::find_if(frames.poses.begin(), frames.poses.end(), is_from_there);
      ASSERT_NE(at, frames.poses.end());
      const auto i = static_cast<std::size_t>(at - frames.poses.begin());
      (void)planner.add(load_frame(frames, i), *at);
      EXPECT_TRUE(identities.insert(frame_identity(frames, i)).second) << i;
    }
    EXPECT_EQ(identities.size(), count);
    EXPECT_EQ(map.notes().frames, identities);
    EXPECT_EQ(map.content_hash(), planner.scorer().grid().content_hash());
  }

  Strings images, poses;  // the files' bytes
};

// Writes the files of all frames, in an order and at times of its own.
class Recorder {
 public:
  Recorder(fs::path live, const Strings& images, const Strings& poses, std::uint64_t seed)
      : live_(std::move(live)), random_(seed), thread_([=, this] { record(images, poses); }) {}
  ~Recorder() { thread_.join(); }
  Recorder(const Recorder&) = delete;
  Recorder& operator=(const Recorder&) = delete;
  std::atomic<bool> is_done{false};

 private:
  int random(int most) { return static_cast<int>(random_() % static_cast<unsigned>(most + 1)); }

  void record(const Strings& images, const Strings& poses) {
    std::vector<std::size_t> order(images.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    // Neighbours change places: mostly, but not always, by number.
    for (std::size_t i = 1; i < order.size(); ++i) {
      if (random(2) == 0) std::swap(order[i - 1], order[i]);
    }
    for (const std::size_t i : order) {
      std::this_thread::sleep_for(std::chrono::milliseconds(random(80)));
      std::string digits = std::to_string(i);
      const std::string name = "frame-" + std::string(6 - digits.size(), '0') + digits;
      std::array<std::pair<std::string, std::string>, 2> files{
          {{name + ".depth.png", images[i]}, {name + ".pose.txt", poses[i]}}};
      if (random(1) == 0) std::swap(files[0], files[1]);
      for (const auto& [file, bytes] : files) i % 2 == 0 ? rename(file, bytes) : write(file, bytes);
    }
    is_done = true;
  }

  void rename(const std::string& file, const std::string& bytes) const {
    std::ofstream(live_ / ("." + file), std::ios::binary) << bytes;
    fs::rename(live_ / ("." + file), live_ / file);
  }

  // Part by part, with pauses.
  void write(const std::string& file, const std::string& bytes) {
    std::ofstream out(live_ / file, std::ios::binary);
    const std::size_t parts = 1 + static_cast<std::size_t>(random(6));
    for (std::size_t i = 0; i < parts; ++i) {
      const std::size_t from = bytes.size() * i / parts, to = bytes.size() * (i + 1) / parts;
      out << bytes.substr(from, to - from) << std::flush;
      std::this_thread::sleep_for(std::chrono::milliseconds(random(12)));
    }
  }

  fs::path live_;
  std::mt19937_64 random_;
  std::thread thread_;
};

// 30 good frames and three bad ones, the program killed 0 or 20 times meanwhile.
TEST_F(Watch, TakesEachGoodFrameOnceThroughKills) {
  std::string nan = poses[0];
  nan.replace(0, nan.find(' '), "nan");
  images.push_back(images[3].substr(0, images[3].size() - 20));
  poses.push_back(poses[3]);
  write_png(dir / "odd.png", GrayImage{10, 8, std::vector<std::uint16_t>(80, 6000)});
  images.push_back(read("odd.png"));
  poses.push_back(poses[4]);
  images.push_back(images[5]);
  poses.push_back(nan);
  for (const int kills : {0, 20}) {
    fs::remove_all(dir / "live");
    fs::remove_all(dir / "plan");
    write("live/sensor.toml", read("small.toml"));
    write("live/depth-scale.txt", "1e-4\n");
    std::mt19937_64 random(7);
    Reader reader(dir / "plan");
    int killed = 0;
    {
      const Recorder recorder(dir / "live", images, poses, 5);
      while (killed < kills) {
        const auto before = state_time();
        const pid_t child = start(watch());
        // At any moment, and every other time soon after something was written.
        for (int i = 0; i < 200 && killed % 2 == 1 && state_time() == before; ++i) {
          std::this_thread::sleep_for(5ms);
        }
        std::this_thread::sleep_for(
            std::chrono::milliseconds(random() % (killed % 2 == 1 ? 20 : 140)));
        ASSERT_EQ(::kill(child, SIGKILL), 0);
        const int status = end_of(child);
        ASSERT_TRUE(WIFSIGNALED(status) && WTERMSIG(status) == SIGKILL) << status;
        ++killed;
      }
      const pid_t child = start(watch());
      while (!recorder.is_done) std::this_thread::sleep_for(10ms);
      write("live/done", "");
      const int status = end_of(child);
      EXPECT_TRUE(WIFEXITED(status) && WEXITSTATUS(status) == 0) << status;
    }
    reader.stop();
    EXPECT_EQ(reader.fault, "");
    EXPECT_GT(reader.reads, 10U);
    const json next = json::parse(read("plan/next.json"));
    EXPECT_EQ(next["frames"], kGood);
    EXPECT_EQ(next["waiting"], 0);
    EXPECT_EQ(next["bad"], (json{{"lost_pose", 1}, {"unreadable", 1}, {"wrong_size", 1}}));
    EXPECT_EQ(next["stop_reason"], "max_views");
    EXPECT_EQ(list("plan"), (Strings{"next.json", "next.txt", "points.ply", "state.vdb",
                                     "surface.ply", "views.txt"}));
    expect_each_once(kGood);
  }
}

TEST_F(Watch, SaysWhereToLookNext) {
  const pid_t child = start(watch({"--top", "5"}));
  put(0);
  EXPECT_TRUE(wait_for(1));
  const json first = json::parse(read("plan/next.json"));
  EXPECT_EQ(first["stop_reason"], nullptr);
  EXPECT_EQ(first["gain_model"], "combined");
  ASSERT_EQ(first["next"].size(), 5U);
  EXPECT_GT(first["candidates"], 5);
  double last = 1e300;
  const PoseList listed = read_tum(dir / "plan/next.txt");
  ASSERT_EQ(listed.poses.size(), 5U);
  for (std::size_t i = 0; i < 5; ++i) {
    const json& view = first["next"][i];
    EXPECT_EQ(view["generator"], "boundary");
    EXPECT_TRUE(view["class"].is_string());
    EXPECT_LE(view["gain"], last);
    last = view["gain"];
    for (std::size_t k = 0; k < 3; ++k) {
      EXPECT_EQ(view["T_world_camera"][k][3], listed.poses[i].m[4 * k + 3]);
    }
  }
  put(7);
  EXPECT_TRUE(wait_for(2));
  EXPECT_EQ(::kill(child, SIGTERM), 0);
  const int status = end_of(child);
  EXPECT_TRUE(WIFEXITED(status) && WEXITSTATUS(status) == 0) << status;
  expect_each_once(2);

  // What is there is a map as any other, and it goes on.
  EXPECT_EQ(json::parse(run_well({"info", "plan/state.vdb", "--json"}))["sensor"], "small");
  const std::string before = read("plan/next.json");
  fs::remove(dir / "plan/next.json");
  write("live/done", "");
  const json end = json::parse(run_well(watch({"--json", "--top", "5"})));
  EXPECT_EQ(end["frames"], 2);
  EXPECT_EQ(end["added"], 0);
  EXPECT_EQ(end["ended_by"], "done");
  EXPECT_EQ(end["hash"], load_map(dir / "plan/state.vdb").content_hash());
  EXPECT_EQ(read("plan/next.json"), before);

  // One of a newer program's, and one that is damaged, of which the views are made again.
  json newer = json::parse(before);
  newer["format"] = 2;
  write("plan/next.json", newer.dump());
  expect_refused(watch({}),
                 "next.json: the file's format, 2, is too new; this program reads formats up to 1");
  for (const char* damaged : {"", "{", "{}", "{\"format\": -1}"}) {
    write("plan/next.json", damaged);
    (void)run_well(watch({"--top", "5"}));
    EXPECT_EQ(read("plan/next.json"), before) << damaged;
  }
}

// Frames that come after it was enough: they are taken, and views are proposed after each of them,
// as a planner of the test's own does.
TEST_F(Watch, GoesOnAfterItWasEnough) {
  run_well({"simulate", "cube.off", "--poses", "sphere:40,0.6", "--sensor", "small.toml", "--size",
            "0.2", "--place", "center", "--out", "around"});
  const FrameSequence frames = open_frames(dir / "whole");
  test::PlannerSetUp config;
  config.map.voxel_size = kVoxel;
  config.map.workspace = {{-0.2, -0.2, -0.2}, {0.2, 0.2, 0.2}};
  config.map.jump_edges.reset();
  config.planner.max_views = 3;
  ViewPlanner planner = config.make(frames.sensor, {1});
  planner.add_poses({"poses", read_tum(dir / "around/poses.txt").poses});
  const pid_t child =
      start(watch({"--poses", "around/poses.txt", "--top", "2", "--max-views", "3"}));
  std::optional<Pose> asked;
  constexpr std::size_t kFrames = 13;
  for (std::size_t i = 0; i < kFrames; ++i) {
    put(i);
    ASSERT_TRUE(wait_for(i + 1)) << i;
    (void)planner.add(load_frame(frames, i), frames.poses[i]);
    if (asked) planner.tried(*asked, false);
    const std::size_t count = planner.propose().candidates.size();
    const Ranking best = planner.rank(2, {.together = true});
    const json next = json::parse(read("plan/next.json"));
    EXPECT_EQ(next["candidates"], count) << i;
    ASSERT_EQ(next["next"].size(), best.views.size()) << i;
    for (std::size_t k = 0; k < best.views.size(); ++k) {
      EXPECT_EQ(next["next"][k]["gain"], best.views[k].gain.gain) << i;
    }
    const std::optional<StopReason> reason = planner.should_stop();
    EXPECT_EQ(next["stop_reason"], reason ? json(stop_reason_name(*reason)) : json()) << i;
    EXPECT_EQ(reason == StopReason::max_views, i >= 2) << i;
    asked = best.views.at(0).T_world_camera;
  }
  EXPECT_EQ(::kill(child, SIGTERM), 0);
  EXPECT_EQ(end_of(child), 0);
  expect_each_once(kFrames);
}

TEST_F(Watch, AnEmptyViewBreaksItsPromise) {
  write_png(dir / "dark.png", GrayImage{48, 36, std::vector<std::uint16_t>(48 * 36)});
  for (const char* rule : {"0", "1", "2"}) {
    begin_with_one_frame();
    fs::remove(dir / "live/done");
    const pid_t child = start(watch({"--stop", std::string("promises=") + rule}));
    ASSERT_TRUE(wait_for(1)) << rule;
    const json first = json::parse(read("plan/next.json"));
    EXPECT_EQ(first["stop_reason"], nullptr) << rule;
    write(name(1) + ".depth.png", read("dark.png"));
    write(name(1) + ".pose.txt", matrix_text(best_of(first)));
    write("live/done", "");
    EXPECT_EQ(end_of(child), 0) << rule;
    const json reason = json::parse(read("plan/next.json"))["stop_reason"];
    EXPECT_EQ(reason, *rule == '1' ? json("promises") : json(nullptr)) << rule;
  }
}

// What is wrong with all frames is said, once, though it goes on.
TEST_F(Watch, SaysWhatIsSuspectedOfTheFrames) {
  run_well({"simulate", "cube.off", "--poses", "orbit:13,0.6,40", "--sensor", "sr4000", "--size",
            "0.2", "--place", "center", "--support-plane", "-0.1", "--out", "right"});
  fs::copy(dir / "right", dir / "wrong", fs::copy_options::recursive);
  PoseList given = read_tum(dir / "wrong/poses.txt");
  for (Pose& pose : given.poses) pose = pose.inverse();
  viewgain::write_tum(dir / "wrong/poses.txt", given.poses);
  for (const std::string folder : {"right", "wrong"}) {
    write(folder + "/done", "");
    const std::string said = run({"model", folder, "--watch", "--voxel", "0.01", "--workspace",
                                  "-2,-2,-2,2,2,2", "--out", folder + "_plan", "--quiet"})
                                 .err;
    const std::size_t first = said.find("the poses are world to camera");
    EXPECT_EQ(first != std::string::npos, folder == "wrong") << said;
    EXPECT_EQ(said.find("warning") != std::string::npos, folder == "wrong") << said;
    EXPECT_EQ(said.find("world to camera", first == std::string::npos ? first : first + 25),
              std::string::npos);
  }
}

// A pose that contradicts the map: the map is what it is without that frame.
TEST_F(Watch, WhatContradictsTheMapIsLeftOut) {
  run_well({"simulate", "cube.off", "--poses", "orbit:10,0.6,27", "--sensor", "sr4000", "--size",
            "0.2", "--place", "center", "--out", "moved"});
  FrameSequence frames = open_frames(dir / "moved");
  FramesWriter without(dir / "without");
  std::vector<Pose> others;
  for (std::size_t i = 0; i < 10; ++i) {
    if (i == 7) continue;
    without.write_frame(others.size(), load_frame(frames, i));
    others.push_back(frames.poses[i]);
  }
  without.commit(others, frames.sensor);
  frames.poses[7].m[3] += 0.1;
  viewgain::write_tum(dir / "moved/poses.txt", frames.poses);
  write("moved/done", "");
  const Strings made{"--voxel", "0.01", "--workspace", "-0.2,-0.2,-0.2,0.2,0.2,0.2"};
  std::string said;
  const auto ran = [&](const Strings& call, const Strings& more) {
    const test::ProgramResult result =
        run(test::joined(test::joined(call, {"--register", "on", "--json"}), more));
    EXPECT_EQ(result.exit_code, 0) << result.err;
    said = result.err;
    return json::parse(result.out);
  };
  const Strings map{"--out", "map.vdb"};
  const std::string hash = ran({"integrate", "without"}, test::joined(made, map))["hash"];
  const json result = ran({"model", "moved", "--watch", "--out", "plan"}, made);
  EXPECT_EQ(result["bad"].size(), 1U);
  EXPECT_EQ(result["bad"]["contradicts"], 1);
  EXPECT_EQ(result["frames"], 9);
  EXPECT_EQ(result["hash"], hash);
  const json integrated = ran({"integrate", "moved"}, test::joined(made, map));
  EXPECT_NE(said.find("(contradicts); the frame is left out"), std::string::npos) << said;
  EXPECT_EQ(integrated["registration"]["refused"], 1);
  EXPECT_EQ(integrated["hash"], hash);
  // Fed again it is tried again; the others are skipped.
  const json again = ran({"integrate", "moved", "--map", "map.vdb"}, map);
  EXPECT_EQ(again["skipped"], 9);
  EXPECT_EQ(again["registration"]["refused"], 1);
  EXPECT_EQ(again["hash"], hash);

  std::size_t cases = 0;
  for (const Strings& call : {Strings{"model", "moved", "--watch"}, Strings{"integrate", "moved"},
                              Strings{"model", "moved", "--pictures", "off"}}) {
    const json kept = ran(test::joined(call, {"--out", "kept-" + std::to_string(cases) + ".vdb",
                                              "--on-contradiction", "keep"}),
                          made);
    EXPECT_EQ(kept["bad"].size(), 0U) << call[0];
    EXPECT_EQ(kept["frames"], 10) << call[0];
    ++cases;
  }
  EXPECT_EQ(cases, 3U);
}

// What disks, clocks and other programs do to a folder.
TEST_F(Watch, FaultsOfFilesAndClocks) {
  write_half_sensor();
  run_well({"simulate", "cube.off", "--poses", "orbit:5,0.6,27", "--sensor", "tof.toml", "--size",
            "0.2", "--place", "center", "--out", "taken"});
  const PoseList poses_of_frames = read_tum(dir / "taken/poses.txt");
  fs::create_directories(dir / "odd\nname");
  const fs::path folder = dir / "odd\nname";
  fs::copy_file(dir / "taken/sensor.toml", folder / "sensor.toml");
  // Out of order, and dated back and forth.
  const auto bring = [&](std::size_t frame, std::size_t number, int hours) {
    char name[32];
    std::snprintf(name, sizeof name, "frame-%06zu", number);
    char from[48];
    std::snprintf(from, sizeof from, "taken/frame-%06zu.depth.png", frame);
    const fs::path image = folder / (std::string(name) + ".depth.png");
    fs::copy_file(dir / from, image, fs::copy_options::overwrite_existing);
    fs::last_write_time(image, fs::file_time_type::clock::now() + std::chrono::hours(hours));
    std::ofstream(folder / (std::string(name) + ".pose.txt"))
        << matrix_text(poses_of_frames.poses[frame]);
  };
  bring(0, 7, 0);
  bring(1, 3, 48);
  bring(2, 5, -48);
  bring(3, 900, -1000);
  // One that is cut off, one without a pose, and names that are nobody's.
  const std::string image = read("taken/frame-000004.depth.png");
  bring(4, 1, 0);
  write("odd\nname/frame-000001.depth.png", image.substr(0, image.size() / 2));
  write("odd\nname/frame-000002.depth.png", image);
  write("odd\nname/frame-00\n0004.depth.png", image);
  write("odd\nname/frame-000009.depth.png\n", image);
  write("odd\nname/done", "");
  const auto followed = [&] {
    return json::parse(run({"model", "odd\nname", "--watch", "--voxel", "0.0125", "--workspace",
                            "-0.2,-0.2,-0.2,0.2,0.2,0.2", "--out", "plan", "--json"})
                           .out);
  };
  const json first = followed();
  EXPECT_EQ(first["frames"], 4);
  EXPECT_EQ(first["bad"], (json{{"no_pose", 1}, {"unreadable", 1}}));
  // The same again, dated anew, and the rest of the one that was cut off.
  bring(0, 7, 5);
  bring(4, 1, -5);
  const json last = followed();
  EXPECT_EQ(last["added"], 1);
  EXPECT_EQ(last["frames"], 5);
  EXPECT_EQ(last["bad"], (json{{"no_pose", 1}}));
  EXPECT_EQ(load_vdb(dir / "plan/state.vdb").views().size(), 5U);
}

TEST_F(Watch, RefusesWhatItCannotGoOnWith) {
  put(0);
  write("live/done", "");
  write("mine/next.txt", "notes");
  Strings call = watch();
  *std::find(call.begin(), call.end(), "plan") = "mine";
  expect_refused(call, "mine/next.txt");
  *std::find(call.begin(), call.end(), "mine") = "live";
  expect_refused(call, "FRAMES_DIR");
  call = watch();
  call[1] = "nowhere";
  expect_refused(call, "nowhere");
  write("reach.toml", "poses = \"plan/next.txt\"\n");
  expect_refused(watch({"--reach", "reach.toml"}), "--reach");
  expect_refused(watch({"--resume"}), "--resume");
  expect_refused(watch({"--costs", "mine/next.txt"}), "--costs");
  expect_refused({"model", "live", "--watch", "--voxel", "0.02", "--out", "plan"}, "--workspace");
  expect_refused({"model", "live", "--max-views", "3", "--voxel", "0.02", "--out", "plan"},
                 "--watch");
  expect_refused(watch({"--gain", "paper", "--hazard", "size=0.2"}), "--hazard");
  run_well(watch());
  call = watch();
  *std::find(call.begin(), call.end(), "0.025") = "0.02";
  expect_refused(call, "0.025");
  write("other.toml", read("small.toml") + "\n");
  std::string other = read("small.toml");
  other.replace(other.find("60.0"), 4, "61.0");
  write("other.toml", other);
  expect_refused(watch({"--sensor", "other.toml"}),
                 "plan/state.vdb: the map was made with the sensor small");
  run_well({"integrate", "whole", "--voxel", "0.025", "--out", "map.vdb"});
  fs::copy_file(dir / "map.vdb", dir / "plan/state.vdb", fs::copy_options::overwrite_existing);
  expect_refused(watch(), "plan/state.vdb");
  fs::remove_all(dir / "plan");
  fs::remove(dir / "live/done");
  const pid_t child = start(watch());
  EXPECT_TRUE(wait_for(1));
  expect_refused(watch(), "plan: another process");
  EXPECT_EQ(::kill(child, SIGINT), 0);
  const int status = end_of(child);
  EXPECT_TRUE(WIFEXITED(status) && WEXITSTATUS(status) == 0) << status;
}

}  // namespace
}  // namespace viewgain
