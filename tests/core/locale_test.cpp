// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <limits>

#include "comma_locale.hpp"
#include "expect_error.hpp"
#include "temporary_folder.hpp"
#include "viewgain/core/pose_io.hpp"
#include "viewgain/core/sensor.hpp"
#include "viewgain/support/text.hpp"

namespace viewgain {
namespace {

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

}  // namespace
}  // namespace viewgain
