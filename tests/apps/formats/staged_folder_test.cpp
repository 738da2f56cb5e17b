// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include "viewgain/formats/staged_folder.hpp"

#include <dirent.h>
#include <dlfcn.h>
#include <sys/stat.h>
#include <unistd.h>

#include <atomic>
#include <chrono>
#include <fstream>
#include <functional>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "apps/program_runner.hpp"
#include "viewgain/core/error.hpp"
#include "viewgain/formats/frames.hpp"
#include "viewgain/formats/recordings.hpp"
#include "viewgain/support/atomic_file.hpp"

namespace {

struct Calls {
  int syncs = 0, listings = 0;
  bool operator==(const Calls&) const = default;
};
std::atomic<int> syncs{0}, listings{0};

}  // namespace

// In the place of the C library's; the disk itself is not waited for.
extern "C" int fsync(int) {
  ++syncs;
  return 0;
}
extern "C" int syncfs(int) noexcept {
  ++syncs;
  return 0;
}
extern "C" DIR* opendir(const char* name) {
  ++listings;
  static const auto real = reinterpret_cast<DIR* (*)(const char*)>(::dlsym(RTLD_NEXT, "opendir"));
  return real(name);
}
extern "C" DIR* fdopendir(int file) {
  ++listings;
  static const auto real = reinterpret_cast<DIR* (*)(int)>(::dlsym(RTLD_NEXT, "fdopendir"));
  return real(file);
}

namespace viewgain {
namespace {

class StagedFolderTest : public test::ProgramTest {
 protected:
  static void put(const fs::path& file, const std::string& text) {
    fs::create_directories(file.parent_path());
    std::ofstream(file) << text;
  }
};

TEST_F(StagedFolderTest, NothingShowsUntilAllIsThere) {
  {
    StagedFolder staged(dir / "a/b");
    put(staged.path() / "one.txt", "new");
    EXPECT_FALSE(fs::exists(dir / "a/b"));
    staged.commit({});
  }
  EXPECT_EQ(list("a"), Strings{"b"});
  EXPECT_EQ(read("a/b/one.txt"), "new");
}

TEST_F(StagedFolderTest, OldNamesGoAndForeignOnesStay) {
  write("run/one.txt", "old");
  write("run/maps/00.vdb", "old");
  write("run/maps/01.vdb", "old");
  write("run/views/00.png", "old");
  write("run/mine.txt", "mine");
  {
    StagedFolder staged(dir / "run");
    put(staged.path() / "one.txt", "new");
    put(staged.path() / "maps/00.vdb", "new");
    EXPECT_EQ(read("run/one.txt"), "old");
    staged.commit({"one.txt", "maps/00.vdb", "maps/01.vdb", "views/00.png"});
  }
  EXPECT_EQ(
      contents("run"),
      (std::map<std::string, std::string>{
          {"one.txt", "new"}, {"maps", "a folder"}, {"maps/00.vdb", "new"}, {"mine.txt", "mine"}}));
}

TEST_F(StagedFolderTest, RecordsOfWhatIsThereAreMovedLast) {
  const Strings files{"frame-000000.depth.png",
                      "maps/00.vdb",
                      "map.vdb",
                      "points.ply",
                      "sensor.toml",
                      "surface.ply",
                      "views.txt"};
  const Strings records{"poses.txt", "run.json", "simulated.txt"};
  int cases = 0;
  for (const std::string& blocked : files) {
    const std::string folder = "run" + std::to_string(cases);
    for (const std::string& record : records) write(folder + "/" + record, "old");
    write(folder + "/" + blocked + "/in the way", "");
    StagedFolder staged(dir / folder);
    for (const std::string& name : files) put(staged.path() / name, "new");
    for (const std::string& name : records) put(staged.path() / name, "new");
    EXPECT_THROW(staged.commit({}), Error);
    for (const std::string& record : records) {
      EXPECT_EQ(read(folder + "/" + record), "old") << record << " beside " << blocked;
    }
    ++cases;
  }
  EXPECT_EQ(cases, 7);
}

TEST_F(StagedFolderTest, AFailureLeavesAnothersResultsInTheParentItMade) {
  auto first = std::make_optional<StagedFolder>(dir / "runs/a");
  {
    StagedFolder second(dir / "runs/b");
    put(second.path() / "one.txt", "new");
    second.commit({});
  }
  first.reset();  // fails: runs/ is its own, but not only its own any more
  EXPECT_EQ(list("runs"), Strings{"b"});
  EXPECT_EQ(read("runs/b/one.txt"), "new");
  { const StagedFolder alone(dir / "made/for/this"); }
  EXPECT_FALSE(fs::exists(dir / "made"));
}

// As where a signal ends a program of several threads.
TEST_F(StagedFolderTest, WritersThatGoOnKeepNothingAlive) {
  for (int round = 0; round < 5; ++round) {
    const StagedFolder staged(dir / "made/out");
    for (int i = 0; i < 500; ++i) put(staged.path() / std::to_string(i), "");
    std::atomic<int> ended{0};
    std::vector<std::thread> writers;
    for (int writer = 0; writer < 3; ++writer) {
      writers.emplace_back([&, writer] {
        const std::string name = std::to_string(writer) + '-';
        for (int i = 0; i < 200'000; ++i) {
          if (!std::ofstream(staged.path() / (name + std::to_string(i)))) {
            ++ended;
            return;
          }
        }
      });
    }
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
    remove_staged_folders();
    for (std::thread& writer : writers) writer.join();
    EXPECT_EQ(ended, 3);
    EXPECT_EQ(list("."), Strings{});
  }
}

TEST_F(StagedFolderTest, ALeftoverInUseStays) {
  std::string name;
  {
    const StagedFolder staged(dir / "out");
    name = staged.path().filename().string();
    ASSERT_EQ(name, list(".").front());
    const StagedFolder another(dir / "out");
    EXPECT_TRUE(fs::exists(dir / name));
    EXPECT_EQ(list(".").size(), 2U);
  }
  EXPECT_EQ(list("."), Strings{});
  put(dir / name / "half.txt", "as a killed process has left it");
  put(dir / ".out.tmp-mine/one.txt", "no temporary");
  put(dir / ".other.tmp-1-0/one.txt", "of another folder");
  write(".out.tmp-1-0", "no folder");
  { const StagedFolder next(dir / "out"); }
  EXPECT_EQ(list("."), (Strings{".other.tmp-1-0", ".out.tmp-1-0", ".out.tmp-mine"}));
}

TEST_F(StagedFolderTest, FramesThatNobodySimulatedAreRefused) {
  std::size_t cases = 0;
  for (const char* name :
       {"frame-000000.depth.png", "frame-000000.amplitude.png", "frame-000000.pose.txt",
        "camera-intrinsics.txt", "poses.txt", "sensor.toml", "frames.toml", "simulated.txt"}) {
    const std::string folder = "recording" + std::to_string(cases);
    write(folder + "/" + name, "mine");
    EXPECT_THROW(FramesWriter writer(dir / folder), Error) << name;
    EXPECT_EQ(list(folder), Strings{name});
    ++cases;
  }
  EXPECT_EQ(cases, 8U);

  const Sensor sensor = sensor_preset("laser_line");
  const auto pixels = static_cast<std::size_t>(sensor.camera.width * sensor.camera.height);
  const DepthFrame frame{sensor.camera.width, sensor.camera.height,
                         std::vector<float>(pixels, 1.0F)};
  const auto write_frames = [&](std::size_t count) {
    FramesWriter writer(dir / "frames");
    for (std::size_t i = 0; i < count; ++i) writer.write_frame(i, frame);
    writer.commit(std::vector<Pose>(count), sensor);
  };
  write_frames(3);
  write("frames/mine.txt", "mine");
  write_frames(2);
  EXPECT_EQ(list("frames"),
            (Strings{"frame-000000.depth.png", "frame-000001.depth.png", "frames.toml", "mine.txt",
                     "poses.txt", "sensor.toml", "simulated.txt"}));
  write("frames/frame-000002.depth.png", "mine");
  EXPECT_THROW(write_frames(3), Error);
  EXPECT_EQ(read("frames/frame-000002.depth.png"), "mine");
}

TEST_F(StagedFolderTest, RunsThatNobodyLeftAreRefused) {
  std::size_t cases = 0;
  for (const char* name :
       {"run.json", "views.txt", "map.vdb", "surface.ply", "points.ply", "views/00.png",
        "views/01.amplitude.png", "maps/00.vdb", "maps/00.txt"}) {
    const std::string folder = "foreign" + std::to_string(cases);
    write(folder + "/" + name, "mine");
    EXPECT_THROW(RunFolder run(dir / folder), Error) << name;
    EXPECT_EQ(read(folder + "/" + name), "mine");
    ++cases;
  }
  EXPECT_EQ(cases, 9U);
}

Calls calls_of(const std::function<void()>& work) {
  const Calls before{syncs, listings};
  work();
  return {syncs - before.syncs, listings - before.listings};
}

// However many files there are.
TEST_F(StagedFolderTest, TheDiskIsWaitedForAndTheFolderListedAConstantNumberOfTimes) {
  const Sensor sensor = sensor_preset("laser_line");
  const auto pixels = static_cast<std::size_t>(sensor.camera.width * sensor.camera.height);
  DepthFrame frame{sensor.camera.width, sensor.camera.height, std::vector<float>(pixels, 1.0F)};
  frame.amplitude.assign(pixels, 1.0F);
  const auto simulate = [&](const std::string& folder, std::size_t count) {
    FramesWriter writer(dir / folder);
    for (std::size_t i = 0; i < count; ++i) writer.write_frame(i, frame);
    writer.commit(std::vector<Pose>(count), sensor);
  };
  const auto import = [&](const std::string& folder, std::size_t count) {
    std::string depth, poses;
    for (std::size_t i = 0; i < count; ++i) {
      const std::string image = "frame-" + std::string(6 - std::to_string(i).size(), '0') +
                                std::to_string(i) + ".depth.png";
      depth += std::to_string(i) + " " + image + "\n";
      poses += std::to_string(i) + " 0 0 0 0 0 0 1\n";
    }
    write("many/depth.txt", depth);
    write("many/groundtruth.txt", poses);
    ImportConfig config;
    config.camera = sensor.camera;
    (void)import_recording(dir / "many", dir / folder, config);
  };
  const auto run = [&](const std::string& folder, std::size_t count) {
    RunFolder results(dir / folder);
    write_file_atomically(results.file("run.json"), "{\"map_hash\": 0}");
    for (std::size_t i = 0; i < count; ++i)
      write_file_atomically(results.view(i, ".png"), "picture");
    for (std::size_t i = 0; i < count; ++i) write_file_atomically(results.map(i), "map");
    results.commit();
  };
  simulate("many", 30);  // the images of the recording
  std::size_t cases = 0;
  for (const auto& write : {std::function<void(const std::string&, std::size_t)>(simulate),
                            std::function<void(const std::string&, std::size_t)>(import),
                            std::function<void(const std::string&, std::size_t)>(run)}) {
    const std::string few = "few" + std::to_string(cases), more = "more" + std::to_string(cases);
    // First where nothing is, then over what is there, then fewer than are there.
    for (const std::size_t share : {1U, 1U, 2U}) {
      const Calls of_few = calls_of([&] { write(few, 4 / share); });
      const Calls of_more = calls_of([&] { write(more, 30 / share); });
      EXPECT_GE(of_few.syncs, 2) << cases;
      EXPECT_LE(of_few.syncs, 8) << cases;
      EXPECT_GE(of_few.listings, 1) << cases;
      EXPECT_EQ(of_few.syncs, of_more.syncs) << cases;
      EXPECT_EQ(of_few.listings, of_more.listings) << cases;
    }
    ++cases;
  }
  EXPECT_EQ(cases, 3U);
}

mode_t mode_of(const fs::path& file) {
  struct stat status {};
  EXPECT_EQ(::stat(file.c_str(), &status), 0) << file;
  return status.st_mode & 07777U;
}

TEST_F(StagedFolderTest, FilesThatAreReplacedKeepTheirModes) {
  const mode_t before = ::umask(022);
  for (const char* name : {"run/run.json", "run/maps/00.vdb", "run/mine.txt", "run/views.txt"}) {
    write(name, "old");
  }
  ASSERT_EQ(::chmod((dir / "run").c_str(), 0750), 0);
  ASSERT_EQ(::chmod((dir / "run/run.json").c_str(), 0600), 0);
  ASSERT_EQ(::chmod((dir / "run/maps/00.vdb").c_str(), 0664), 0);
  {
    StagedFolder staged(dir / "run");
    EXPECT_EQ(mode_of(staged.path()), 0700U);  // what will be private is so from the start
    for (const char* name : {"run.json", "maps/00.vdb", "maps/01.vdb", "views.txt"}) {
      fs::create_directories((staged.path() / name).parent_path());
      write_file_atomically(staged.path() / name, "new");
    }
    staged.commit({});
  }
  EXPECT_EQ(read("run/run.json"), "new");
  EXPECT_EQ(mode_of(dir / "run"), 0750U);
  EXPECT_EQ(mode_of(dir / "run/run.json"), 0600U);
  EXPECT_EQ(mode_of(dir / "run/maps/00.vdb"), 0664U);
  EXPECT_EQ(mode_of(dir / "run/maps/01.vdb"), 0644U);
  EXPECT_EQ(mode_of(dir / "run/views.txt"), 0644U);
  {
    StagedFolder staged(dir / "new");
    put(staged.path() / "run.json", "new");
    staged.commit({});
  }
  EXPECT_EQ(mode_of(dir / "new"), 0755U);
  EXPECT_EQ(mode_of(dir / "new/run.json"), 0644U);
  ::umask(before);
}

TEST_F(StagedFolderTest, NamesMayBeAsLongAsTheFileSystemAllows) {
  const auto most = static_cast<std::size_t>(::pathconf(dir.c_str(), _PC_NAME_MAX));
  int cases = 0;
  for (const std::size_t less : {40U, 28U, 27U, 26U, 20U, 1U, 0U}) {
    const std::string name(most - less, 'x');
    for (const char* text : {"new", "anew"}) {
      fs::path hidden;
      {
        StagedFolder killed(dir / name, "run.json");
        put(killed.path() / "run.json", "left");
        killed.keep();
        hidden = killed.path();
      }
      EXPECT_TRUE(fs::exists(hidden / "run.json"));
      {
        StagedFolder staged(dir / name, "run.json");
        EXPECT_EQ(staged.path(), hidden);
        put(staged.path() / "run.json", text);
        staged.commit({});
      }
      EXPECT_EQ(read(name + "/run.json"), text);
      EXPECT_EQ(list(name), Strings{"run.json"});
      ++cases;
    }
    fs::remove_all(dir / name);
    EXPECT_EQ(list("."), Strings{});
  }
  EXPECT_EQ(cases, 14);
  EXPECT_THROW(StagedFolder(dir / std::string(most + 1, 'x')), Error);
}

// As after a power cut: only the record was synced.
TEST_F(StagedFolderTest, WhatIsFromBeforeTheMachineWasStartedIsNotTakenUp) {
  {
    StagedFolder killed(dir / "run", kCheckpoint);
    for (const char* name : {kCheckpoint, "views/00.png", "views/01.png"}) {
      put(killed.path() / name, "left");
    }
    for (const char* name : {kCheckpoint, "views/00.png"}) {
      fs::last_write_time(killed.path() / name,
                          fs::file_time_type::clock::now() - std::chrono::hours(24 * 365 * 20));
    }
    killed.keep();
  }
  const StagedFolder staged(dir / "run", kCheckpoint);
  EXPECT_TRUE(fs::exists(staged.path() / kCheckpoint));
  EXPECT_FALSE(fs::exists(staged.path() / "views/00.png"));
  EXPECT_TRUE(fs::exists(staged.path() / "views/01.png"));
}

}  // namespace
}  // namespace viewgain
