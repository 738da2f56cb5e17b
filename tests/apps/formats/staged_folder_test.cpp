// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include "viewgain/formats/staged_folder.hpp"

#include <fstream>
#include <optional>
#include <string>
#include <vector>

#include "apps/program_runner.hpp"
#include "viewgain/core/error.hpp"
#include "viewgain/formats/frames.hpp"

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
        "camera-intrinsics.txt", "poses.txt", "sensor.toml", "simulated.txt"}) {
    const std::string folder = "recording" + std::to_string(cases);
    write(folder + "/" + name, "mine");
    EXPECT_THROW(FramesWriter writer(dir / folder), Error) << name;
    EXPECT_EQ(list(folder), Strings{name});
    ++cases;
  }
  EXPECT_EQ(cases, 7U);

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
  EXPECT_EQ(list("frames"), (Strings{"frame-000000.depth.png", "frame-000001.depth.png", "mine.txt",
                                     "poses.txt", "sensor.toml", "simulated.txt"}));
  write("frames/frame-000002.depth.png", "mine");
  EXPECT_THROW(write_frames(3), Error);
  EXPECT_EQ(read("frames/frame-000002.depth.png"), "mine");
}

TEST_F(StagedFolderTest, RunsThatNobodyLeftAreRefused) {
  std::size_t cases = 0;
  for (const char* name : {"run.json", "views.txt", "map.vdb", "surface.ply", "points.ply",
                           "views/00.png", "views/01.amplitude.png", "maps/00.vdb"}) {
    const std::string folder = "foreign" + std::to_string(cases);
    write(folder + "/" + name, "mine");
    EXPECT_THROW(RunFolder run(dir / folder), Error) << name;
    EXPECT_EQ(read(folder + "/" + name), "mine");
    ++cases;
  }
  EXPECT_EQ(cases, 8U);
}

}  // namespace
}  // namespace viewgain
