// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0

// `viewgain import` on recordings with damaged parts, impossible cameras and poses of several
// bodies.
#include <gtest/gtest.h>
#include <sqlite3.h>

#include <cmath>
#include <limits>
#include <string>

#include "apps/formats/recordings/message_recordings.hpp"

namespace viewgain {
namespace {

using namespace test;

class DamagedRecordings : public MessageRecordings {
 protected:
  static std::string data(const std::string& name) {
    return std::string(VIEWGAIN_DATA) + "/recordings/" + name;
  }
  [[nodiscard]] ProgramResult import_file(const std::string& source) const {
    return run({"import", source, "--sensor", data("frames/sensor.toml"), "--out", "frames"});
  }
};

TEST_F(DamagedRecordings, ChunksAreLeftOutAndWhatNeedsThemIsCounted) {
  for (const std::uint64_t missing : {0U, 7U}) {
    McapText text = good();
    const std::size_t from = text.size();
    text.image("/gray", 100.5, "optical", kWidth, kHeight, "mono8", "short", 7);
    text.image(kTopic, 100.5, "optical", kWidth, kHeight, "16UC1", rows_mm(6), 2 * kWidth);
    text.put_in_chunk(from, missing);
    text.image("/gray", 100.6, "optical", kWidth, kHeight, "mono8", "short", 7);
    const json report = import(text, {}, missing > 0 ? "a damaged chunk is left out" : "");
    EXPECT_EQ(report["frames"], missing > 0 ? kImages : kImages + 1);
    if (missing == 0) continue;
    EXPECT_NE(
        report.dump().find(
            "messages that have no channel record (perhaps a chunk is damaged) are left out: 1"),
        std::string::npos)
        << report;
  }
}

TEST_F(DamagedRecordings, TheSummaryHasTheChannelsOfADamagedChunk) {
  McapText text(Kind::little_cdr);
  const std::size_t from = text.size();
  add_transforms(text, 99, 99.4);
  add_info(text);
  text.image(kTopic, 99.1, "optical", kWidth, kHeight, "16UC1", rows_mm(6), 2 * kWidth);
  text.put_in_chunk(from, 7);
  text.transform("/tf_static", 0, "link", "optical", kStill);
  add_transforms(text);
  add_info(text);
  add_images(text);
  refuse(text, "has no messages");
  const std::string bytes = text.bytes(true, true);
  write("rec.mcap", bytes);
  const ProgramResult result = run(call({"--json"}));
  EXPECT_EQ(json::parse(result.out)["frames"], kImages) << result.err;
  EXPECT_EQ(result.err.find("without their channel"), std::string::npos) << result.err;
  expect_frames(open_frames(dir / "frames"));
  // A summary that is damaged, or said to be elsewhere, is not needed by a good file.
  const std::string good_bytes = good().bytes(true, true);
  const std::size_t place = good_bytes.size() - 28;  // of the summary's, in the footer
  for (std::size_t i = 0; i < 40; ++i) {
    std::string changed = good_bytes;
    if (i < 20) changed[place + i % 8] = static_cast<char>(i * 37);
    if (i >= 20) changed[place - 22 - 9 * i] ^= static_cast<char>(1 + i % 255);
    write("rec.mcap", changed);
    const ProgramResult read = run(call({"--json"}));
    EXPECT_EQ(json::parse(read.out)["frames"], kImages) << i << read.err;
  }
}

TEST_F(DamagedRecordings, MessagesOfUnknownConnectionsAndTopicsAreCounted) {
  fs::copy_file(data("tiny_none.bag"), dir / "some.bag");
  std::string bytes = read("some.bag");
  bytes[bytes.find("op=\7") + 3] = '\x8';
  write("some.bag", bytes);
  std::string said = import_file("some.bag").err;
  EXPECT_NE(said.find("messages that have no connection record"), std::string::npos) << said;

  fs::copy_file(data("arm.db3"), dir / "some.db3");
  sqlite3* db = nullptr;
  ASSERT_EQ(sqlite3_open((dir / "some.db3").c_str(), &db), SQLITE_OK);
  EXPECT_EQ(
      sqlite3_exec(db, "DELETE FROM topics WHERE name LIKE '%image%'", nullptr, nullptr, nullptr),
      SQLITE_OK);
  sqlite3_close(db);
  said = import_file("some.db3").err;
  EXPECT_NE(said.find("messages that belong to topics that the file does not list are left out: "),
            std::string::npos)
      << said;
  // A path that begins with two slashes.
  EXPECT_EQ(import_file("/" + fs::absolute(data("arm.db3")).string()).exit_code, 0);
}

TEST_F(DamagedRecordings, ImpossibleCamerasAreRefusedWithoutASensorToo) {
  constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  const auto refuse_camera = [&](const Camera& camera, const std::string& word) {
    McapText text;
    add_transforms(text);
    add_info(text, camera);
    add_images(text);
    write("rec.mcap", text.bytes());
    expect_refused({"import", "rec.mcap", "--out", "frames"}, word);
    expect_refused({"import", "rec.mcap", "--out", "frames"}, "rec.mcap: the camera");
    EXPECT_FALSE(fs::exists(dir / "frames"));
  };
  refuse_camera({.k = {kNan, 62, 23, 17}}, "is not calibrated");
  refuse_camera({.k = {61, -62, 23, 17}}, "is not calibrated");
  refuse_camera({.k = {kInfinity, 62, 23, 17}}, "fx must be positive and finite");
  refuse_camera({.k = {61, 62, 23, kNan}}, "cy must be finite");
  refuse_camera({.size = {640, 480}, .roi = {4'000'000'000, 4, 36, 48}}, "far outside");
  refuse_camera({.size = {0, 0}, .k = {61, 62, 1e9, 17}}, "far outside the image of 48x36 px");
}

TEST_F(DamagedRecordings, PosesOfSeveralBodiesAreRefused) {
  refuse(good(), "/tf (tf2_msgs/TFMessage) has the transforms of all frames",
         {"--pose-topic", "/tf"});
  McapText text = good();
  for (const std::string body : {"link", "link", "wheel"}) {
    MessageFields odometry = text.fields();
    odometry.header(100, "odom").text(body).doubles(kStill);
    text.add("/odom", "nav_msgs/msg/Odometry", odometry);
  }
  refuse(text, "/odom: the topic has the poses of several bodies, 'link' and 'wheel'",
         {"--pose-topic", "/odom"});
}

TEST_F(DamagedRecordings, ByteOrderIsJudgedByTheFirstImageWithReadings) {
  for (const bool is_wrong : {false, true}) {
    McapText text;
    add_transforms(text);
    add_info(text);
    text.image(kTopic, 100.01, "optical", kWidth, kHeight, "16UC1",
               std::string(std::size_t{2} * kWidth * kHeight, '\0'), 2 * kWidth);
    for (std::size_t i = 0; i < kImages; ++i) {
      text.image(kTopic, image_time(i), "optical", kWidth, kHeight, "16UC1", rows_mm(i, is_wrong),
                 2 * kWidth);
    }
    EXPECT_EQ(import(text, {}, is_wrong ? "Is is_bigendian wrong?" : "")["frames"], kImages + 1);
  }
  // Where no image has readings nothing is said.
  McapText floats;
  add_transforms(floats);
  add_info(floats);
  const float nan = std::nanf("");
  std::string rows;
  for (std::size_t k = 0; k < kWidth * kHeight; ++k) {
    rows.append(reinterpret_cast<const char*>(&nan), sizeof nan);
  }
  floats.image(kTopic, image_time(0), "optical", kWidth, kHeight, "32FC1", rows, 4 * kWidth);
  EXPECT_EQ(import(floats)["frames"], 1);
}

TEST_F(DamagedRecordings, StaticTransformsHaveNoTimes) {
  McapText text;
  text.transform("/tf_static", 0, "base", "optical", kStill);
  add_info(text);
  add_images(text);
  text.image(kTopic, 100.6, "moon", kWidth, kHeight, "16UC1", rows_mm(0), 2 * kWidth);
  const json report = import(text, {}, "1 in unconnected frames");
  EXPECT_NE(report.dump().find("all images have the same pose"), std::string::npos) << report;
  EXPECT_EQ(report["frames"], kImages);
  EXPECT_EQ(report.dump().find("transforms are from"), std::string::npos) << report;
}

}  // namespace
}  // namespace viewgain
