// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0

#include "viewgain/core/pose_io.hpp"

#include <gtest/gtest.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <csignal>
#include <fstream>
#include <limits>
#include <string>
#include <thread>

#include "comma_locale.hpp"
#include "expect_error.hpp"
#include "random_values.hpp"
#include "temporary_folder.hpp"
#include "viewgain/core/sensor.hpp"
#include "viewgain/support/file_bytes.hpp"
#include "viewgain/support/text.hpp"

namespace viewgain {
namespace {

using test::expect_error;
using test::RandomValues;
using test::TemporaryFolder;

TEST(Tum, RoundTripIsExactInPositionAndCloseInRotation) {
  const TemporaryFolder folder;
  RandomValues random(1);
  std::vector<Pose> poses;
  for (int i = 0; i < 1000; ++i) {
    poses.emplace_back(random.rotation(), random.magnitude(1e-6, 1e6) * random.vector());
  }
  // Half turns, where the conversion to quaternions changes its formula.
  for (const auto& axis : {Eigen::Vector3d(1, 0, 0), Eigen::Vector3d(0, 1, 0),
                           Eigen::Vector3d(0, 0, 1), Eigen::Vector3d(1, 1, 1)}) {
    poses.emplace_back(
        Eigen::AngleAxisd(3.14159265358979323846, axis.normalized()).toRotationMatrix(),
        Eigen::Vector3d(0, -0.0, 1.0 / 3.0));
  }
  write_tum(folder.path() / "poses.txt", poses);
  const PoseList list = read_tum(folder.path() / "poses.txt");
  ASSERT_EQ(list.poses.size(), 1004U);
  ASSERT_EQ(list.timestamps.size(), 1004U);
  EXPECT_EQ(list.orthonormalized, 0U);
  std::size_t cases = 0;
  for (; cases < poses.size(); ++cases) {
    ASSERT_EQ(list.timestamps[cases], static_cast<double>(cases));
    ASSERT_EQ(list.poses[cases].translation(), poses[cases].translation());
    const Eigen::Matrix3d difference = list.poses[cases].rotation() - poses[cases].rotation();
    ASSERT_LT(difference.lpNorm<Eigen::Infinity>(), 2e-15);
    ASSERT_LT(orthonormality_error(list.poses[cases]), 2e-15);
  }
  EXPECT_EQ(cases, 1004U);
}

TEST(Tum, ALineByItselfIsThatOfTheFile) {
  const TemporaryFolder folder;
  const std::string text = "7 1 2 3 0.5 0.5 0.5 0.5\n8 0 0 0 0 0 -0.707 0.707\n9 nan 0 0 0 0 0 1\n";
  const PoseList list =
      read_tum(folder.file("poses.txt", text.substr(0, text.rfind('\n', text.size() - 2) + 1)));
  ASSERT_EQ(list.poses.size(), 2U);
  LineReader line("poses.txt", text);
  std::size_t cases = 0;
  for (; cases < list.poses.size(); ++cases) {
    ASSERT_TRUE(line.next());
    bool mended = cases == 0;
    EXPECT_EQ(tum_line_pose(line, &mended), list.poses[cases]);
    EXPECT_EQ(mended, cases == 1);
  }
  ASSERT_TRUE(line.next());
  expect_error(ErrorCode::format, "poses.txt:3", [&] { (void)tum_line_pose(line); });
  EXPECT_EQ(cases, 2U);
}

TEST(Tum, ReadsWhatOthersWrite) {
  const TemporaryFolder folder;
  const auto path = folder.file("poses.txt",
                                "# ground truth\r\n"
                                "\r\n"
                                "  \t \n"
                                "1305031102.1758 1.5 -2 +3e-1 0 0 0 1\r\n"
                                "   # indented comment, 1 2 3\n"
                                "\t7\t1 2 3   0.5 0.5 0.5 0.5  \n"
                                "8 0 0 0 0 0 -0.707 0.707");  // no line end, norm 0.9998
  const PoseList list = read_tum(path);
  ASSERT_EQ(list.poses.size(), 3U);
  EXPECT_EQ(list.timestamps, (std::vector<double>{1305031102.1758, 7, 8}));
  EXPECT_EQ(list.poses[0], Pose(Eigen::Matrix3d::Identity(), {1.5, -2, 0.3}));
  // (1+i+j+k)/2 turns x to y, y to z, z to x.
  const Eigen::Vector3d turned = list.poses[1].rotation() * Eigen::Vector3d::UnitX();
  EXPECT_LT((turned - Eigen::Vector3d::UnitY()).norm(), 1e-15);
  EXPECT_LT((list.poses[2] * Eigen::Vector3d::UnitX() + Eigen::Vector3d::UnitY()).norm(), 1e-12);
  EXPECT_EQ(list.orthonormalized, 1U);
}

TEST(Tum, MalformedLinesAreNamed) {
  const TemporaryFolder folder;
  const std::string good = "0 1 2 3 0 0 0 1\n";
  struct Case {
    const char* line;
    const char* message;
  };
  const std::vector<Case> bad{
      {"1 2 3 0 0 0 1", "expected 8 numbers (timestamp tx ty tz qx qy qz qw), found 7"},
      {"0 1 2 3 0 0 0 1 9", "found 9"},
      {"5", "found 1"},
      {"0 1 2 3 0 0 0 one", "'one' is not a number"},
      {"0 1 2 3 0 0 0 1x", "'1x' is not a number"},
      {"0 1,5 2 3 0 0 0 1", "'1,5' is not a number"},
      {"0,1,2,3,0,0,0,1", "is not a number"},
      {"0 0x10 2 3 0 0 0 1", "'0x10' is not a number"},
      {"0 1 2 3 0 0 0 --1", "'--1' is not a number"},
      {"0 + 2 3 0 0 0 1", "'+' is not a number"},
      {"0 +-1 2 3 0 0 0 1", "'+-1' is not a number"},
      {"0 1 2 nan 0 0 0 1", "'nan' is not finite"},
      {"0 1 -inf 3 0 0 0 1", "'-inf' is not finite"},
      {"infinity 1 2 3 0 0 0 1", "'infinity' is not finite"},
      {"0 1e999 2 3 0 0 0 1", "'1e999' is out of range"},
      {"0 1 2 3 0 0 0 0", "the quaternion has norm 0; expected 1"},
      {"0 1 2 3 0 0 0 1.02", "the quaternion has norm 1.02; expected 1"},
      {"0 1 2 3 0.5 0.5 0.5 0.4", "the quaternion has norm 0.95393"},
      {"0 1 2 3 1e200 0 0 1e200", "the quaternion has norm inf; expected 1"},
      {"\x01\x02\xff", "'?\?\?' is not a number"},
      {"aaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaa",
       "'aaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaa...'"},
  };
  for (const Case& c : bad) {
    const auto path = folder.file("bad.txt", "# header\n" + good + "\n" + c.line + "\n" + good);
    expect_error(ErrorCode::format, path.string() + ":4: ", [&] { (void)read_tum(path); });
    expect_error(ErrorCode::format, c.message, [&] { (void)read_tum(path); });
  }
}

TEST(Tum, AByteZeroIsNoNumber) {
  const TemporaryFolder folder;
  const auto path = folder.file("bad.txt", std::string_view("0 1 2 3 0 0 0 1\0\n", 17));
  expect_error(ErrorCode::format, ":1: ", [&] { (void)read_tum(path); });
}

TEST(Tum, FilesWithoutAPose) {
  const TemporaryFolder folder;
  for (const char* contents : {"", "\n\n", "# timestamp tx ty tz qx qy qz qw\n"}) {
    const auto path = folder.file("empty.txt", contents);
    expect_error(ErrorCode::format, path.string() + ": the file contains no pose",
                 [&] { (void)read_tum(path); });
  }
}

TEST(Tum, FilesThatCannotBeReadOrWritten) {
  const TemporaryFolder folder;
  const auto missing = folder.path() / "missing.txt";
  expect_error(ErrorCode::io, missing.string(), [&] { (void)read_tum(missing); });
  expect_error(ErrorCode::io, "No such file", [&] { (void)read_tum(missing); });
  expect_error(ErrorCode::io, "is a directory", [&] { (void)read_tum(folder.path()); });
  const auto nowhere = folder.path() / "no" / "folder.txt";
  const std::vector<Pose> poses(1);
  expect_error(ErrorCode::io, nowhere.string(), [&] { write_tum(nowhere, poses); });
}

TEST(Tum, ABadPoseIsNotWrittenAndLeavesTheOldFile) {
  const TemporaryFolder folder;
  const auto path = folder.file("poses.txt", "old");
  std::vector<Pose> poses(3);
  poses[2].m[0] = 2;
  expect_error(ErrorCode::invalid_argument, "pose 2 is not a rigid transform",
               [&] { write_tum(path, poses); });
  EXPECT_EQ(test::read_all(path), "old");
  EXPECT_EQ(folder.entries(), 1);
}

TEST(Tum, TimestampsComeBackAsTheyWere) {
  const TemporaryFolder folder;
  const auto path = folder.path() / "poses.txt";
  const std::vector<double> timestamps{1305031102.1758, -0.0, 1e-300, 1.0 / 3.0, 1e17};
  const std::vector<Pose> poses(timestamps.size());
  write_tum(path, poses, timestamps);
  EXPECT_EQ(read_tum(path).timestamps, timestamps);
  write_tum(path, read_tum(path).poses, read_tum(path).timestamps);
  EXPECT_EQ(read_tum(path).timestamps, timestamps);
  expect_error(ErrorCode::invalid_argument, "poses: 5, timestamps: 4",
               [&] { write_tum(path, poses, std::span(timestamps).first(4)); });
  const std::vector<double> bad(timestamps.size(), NAN);
  expect_error(ErrorCode::invalid_argument, "timestamp 0 is not finite",
               [&] { write_tum(path, poses, bad); });
}

TEST(Poses, AByteOrderMarkIsSkipped) {
  const TemporaryFolder folder;
  const std::string mark = "\xEF\xBB\xBF";
  EXPECT_EQ(read_tum(folder.file("a.txt", mark + "1 2 3 4 0 0 0 1\n")).timestamps,
            std::vector<double>{1});
  EXPECT_EQ(read_tum(folder.file("b.txt", mark + "# header\n1 2 3 4 0 0 0 1\n")).poses.size(), 1U);
  const auto matrix = folder.file("m.txt", mark + "1 0 0 0.5  0 1 0 1.5  0 0 1 2.5  0 0 0 1");
  EXPECT_EQ(read_pose_matrix(matrix).translation(), Eigen::Vector3d(0.5, 1.5, 2.5));
  // Only at the beginning.
  expect_error(ErrorCode::format, ":2: ", [&] {
    (void)read_tum(folder.file("c.txt", "1 2 3 4 0 0 0 1\n" + mark + "2 2 3"));
  });
}

TEST(PoseMatrix, ReadsAndMends) {
  const TemporaryFolder folder;
  bool mended = true;
  auto path = folder.file("a.txt", "0 -1 0 1.5\n1 0 0 2.5e0\n0 0 1 -3\n0 0 0 1\n");
  const Pose exact = read_pose_matrix(path, &mended);
  EXPECT_FALSE(mended);
  EXPECT_EQ(exact.m, (std::array<double, 12>{0, -1, 0, 1.5, 1, 0, 0, 2.5, 0, 0, 1, -3}));

  path = folder.file("b.txt", "0 -1.001 0 1.5 1 0 0 2.5 0\t0 1 -3\r\n\r\n0 0 0 1");
  const Pose pose = read_pose_matrix(path, &mended);
  EXPECT_TRUE(mended);
  EXPECT_LE(orthonormality_error(pose), 1e-15);
  EXPECT_EQ(pose.translation(), Eigen::Vector3d(1.5, 2.5, -3));
  EXPECT_LT((pose.rotation() - exact.rotation()).norm(), 1e-12);
  EXPECT_EQ(read_pose_matrix(path), pose);
}

TEST(PoseMatrix, RefusesWhatIsNoPose) {
  const TemporaryFolder folder;
  struct Case {
    const char* contents;
    const char* message;
  };
  const std::vector<Case> bad{
      {"", "expected 16 numbers (a 4x4 matrix), found 0"},
      {"1 0 0 0 0 1 0 0 0 0 1 0", "found 12"},
      {"1 0 0 0 0 1 0 0 0 0 1 0 0 0 0 1 0", "found 17"},
      {"1 0 0 0\n0 1 0 0\n0 0 x 0\n0 0 0 1", ":3: 'x' is not a number"},
      {"1 0 0 0\n0 1 0 nan\n0 0 1 0\n0 0 0 1", ":2: the number 'nan' is not finite"},
      {"1 0 0 0\n0 1 0 0\n0 0 1 0\n0 0 0 2", "last row of the matrix must be 0 0 0 1"},
      {"1 0 0 0\n0 1 0 0\n0 0 1 0\n1 0 0 1", "last row of the matrix must be 0 0 0 1"},
      {"1 0 0 0\n0 1 0 0\n0 0 -1 0\n0 0 0 1", "not a rigid transform"},
      {"1 0 0 0\n0 1.02 0 0\n0 0 1 0\n0 0 0 1", "not a rigid transform"},
      {"0 0 0 0\n0 0 0 0\n0 0 0 0\n0 0 0 1", "not a rigid transform"},
  };
  for (const Case& c : bad) {
    const auto path = folder.file("bad.txt", c.contents);
    expect_error(ErrorCode::format, path.string() + ":", [&] { (void)read_pose_matrix(path); });
    expect_error(ErrorCode::format, c.message, [&] { (void)read_pose_matrix(path); });
  }
  expect_error(ErrorCode::io, "missing",
               [&] { (void)read_pose_matrix(folder.path() / "missing"); });
}

TEST(Locale, DoesNotReachPoseFiles) {
  const test::TemporaryFolder folder;
  std::vector<Pose> poses(1500);  // indices with a thousands separator, if one crept in
  for (std::size_t i = 0; i < poses.size(); ++i) poses[i].m[3] = 1234.5 + static_cast<double>(i);
  write_tum(folder.path() / "plain.txt", poses);
  {
    const test::CommaLocale locale;
    write_tum(folder.path() / "comma.txt", poses);
    const PoseList list = read_tum(folder.path() / "plain.txt");
    EXPECT_EQ(list.poses, poses);
    EXPECT_EQ(list.timestamps.back(), 1499.0);
    const auto matrix = folder.file("m.txt", "1 0 0 0.5  0 1 0 1.5  0 0 1 2.5  0 0 0 1");
    EXPECT_EQ(read_pose_matrix(matrix).translation(), Eigen::Vector3d(0.5, 1.5, 2.5));
  }
  EXPECT_EQ(test::read_all(folder.path() / "plain.txt"),
            test::read_all(folder.path() / "comma.txt"));
}

TEST(Locale, DoesNotReachMessages) {
  Sensor sensor = sensor_preset("sr4000");
  sensor.min_range = -1234.5;
  const test::CommaLocale locale;
  test::expect_error(ErrorCode::invalid_argument, "not -1234.5", [&] { sensor.validate(); });
  EXPECT_EQ(short_text(0.1), "0.1");
  EXPECT_EQ(short_text(1.52F), "1.52");
  EXPECT_EQ(short_text(1e-9), "1e-09");
  EXPECT_EQ(short_text(-std::numeric_limits<double>::quiet_NaN()), "nan");
  EXPECT_EQ(short_text(-std::numeric_limits<double>::infinity()), "-inf");
  EXPECT_EQ(exact_text(0.1), "0.10000000000000001");
  EXPECT_EQ(exact_text(1500), "1500");
}

namespace fs = std::filesystem;

std::string some_bytes(std::size_t count) {
  std::string bytes(count, '\0');
  for (std::size_t i = 0; i < count; ++i) bytes[i] = static_cast<char>(i * 2654435761U >> 13U);
  return bytes;
}

TEST(FileBytes, OfFilesOfAnySize) {
  const TemporaryFolder folder;
  for (const std::size_t size :
       {0U, 1U, 15U, 16U, 4096U, 1U << 20U, (1U << 20U) + 1U, 5'000'000U}) {
    const std::string bytes = some_bytes(size);
    const fs::path path = folder.file("file", bytes);
    EXPECT_EQ(file_bytes(path), bytes);
    EXPECT_EQ(file_bytes(path, size), bytes);
    EXPECT_EQ(file_head(path, 100), bytes.substr(0, 100));
    if (size > 0) {
      expect_error(ErrorCode::capacity, path.string() + ": the file has more than",
                   [&] { (void)file_bytes(path, size - 1); });
    }
  }
  EXPECT_FALSE(file_bytes("/proc/self/status").empty());  // has a length of 0
}

TEST(FileBytes, OfAPipeUpToALimit) {
  const TemporaryFolder folder;
  const fs::path pipe = folder.path() / "pipe";
  ASSERT_EQ(::mkfifo(pipe.c_str(), 0600), 0);
  // Nobody has named it: not waited for.
  for (const char* file : {pipe.c_str(), "/dev/zero"}) {
    expect_error(ErrorCode::io, "is not a regular file", [&] { (void)folder_file_bytes(file); });
    expect_error(ErrorCode::io, "is not a regular file", [&] { (void)file_head(file, 3); });
    expect_error(ErrorCode::io, "is not a regular file", [&] { (void)read_pose_matrix(file); });
  }
  const std::string bytes = some_bytes(3'000'000);
  const auto write = [&] { std::ofstream(pipe, std::ios::binary) << bytes; };
  {
    std::thread writer(write);
    EXPECT_EQ(file_bytes(pipe), bytes);
    writer.join();
  }
  // A reader that stops leaves its writer a broken pipe.
  std::signal(SIGPIPE, SIG_IGN);
  std::thread writer(write);
  expect_error(ErrorCode::capacity, "more than 2000000 bytes",
               [&] { (void)file_bytes(pipe, 2'000'000); });
  writer.join();
  std::signal(SIGPIPE, SIG_DFL);
}

// Of a process of its own: what is kept is kept until the end.
TEST(FileBytes, OfAPipeAsOftenAsWanted) {
  std::array<int, 2> pipe{};
  ASSERT_EQ(::pipe(pipe.data()), 0);
  const std::string bytes = some_bytes(4000);
  ASSERT_EQ(::write(pipe[1], bytes.data(), bytes.size()), 4000);
  ::close(pipe[1]);
  const std::string name = std::to_string(pipe[0]);
  const pid_t child = ::fork();
  if (child == 0) {
    keep_bytes_of_pipes();
    for (const char* const folder : {"/dev/fd/", "/proc/self/fd/", "/dev/fd/"}) {
      EXPECT_EQ(file_bytes(folder + name), bytes);
    }
    expect_error(ErrorCode::capacity, name + ": the file has more than 3999 bytes",
                 [&] { (void)file_bytes("/dev/fd/" + name, 3999); });
    ::_exit(testing::Test::HasFailure() ? 1 : 0);
  }
  int status = 0;
  ASSERT_EQ(::waitpid(child, &status, 0), child);
  EXPECT_TRUE(WIFEXITED(status) && WEXITSTATUS(status) == 0);
  EXPECT_EQ(file_bytes("/dev/fd/" + name), "");  // here nobody has asked for it
  ::close(pipe[0]);
}

TEST(FileBytes, RefusesWhatHasNoEndOrIsNoFile) {
  const TemporaryFolder folder;
  const fs::path endless = folder.path() / "poses.txt";
  fs::create_symlink("/dev/zero", endless);
  expect_error(ErrorCode::io, "poses.txt: cannot be read: it is neither a file nor a pipe",
               [&] { (void)file_bytes(endless); });
  expect_error(ErrorCode::io, "not a regular file", [&] { (void)file_head(endless, 10); });
  expect_error(ErrorCode::io, "neither a file nor a pipe", [&] { (void)read_tum(endless); });
  expect_error(ErrorCode::io, "is a directory", [&] { (void)file_bytes(folder.path()); });
  expect_error(ErrorCode::io, "No such file", [&] { (void)file_bytes(folder.path() / "none"); });
  // Larger than any file that is meant, though it takes no room on the disk.
  const fs::path sparse = folder.file("sparse", "");
  fs::resize_file(sparse, std::uintmax_t{1} << 40U);
  expect_error(ErrorCode::capacity, "sparse: the file has more than 17179869184 bytes",
               [&] { (void)file_bytes(sparse); });
}

}  // namespace
}  // namespace viewgain
