// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0

// The protocols of other systems (perf/peers): what is counted, against brute force, and the
// programs on tiny data of the same layout.
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <map>
#include <nlohmann/json.hpp>
#include <set>
#include <string>
#include <vector>

#include "peers/peer_map.hpp"
#include "peers/point_coverage.hpp"
#include "peers/published_object.hpp"
#include "peers/voxel_truth.hpp"
#include "viewgain/core/generators.hpp"
#include "viewgain/core/mix64.hpp"
#include "viewgain/core/triangle_mesh.hpp"

namespace viewgain::bench {
namespace {

using Json = nlohmann::json;
using Voxel = std::array<int, 3>;

struct Result {
  int exit_code = -1;
  std::string out;
};

/// What a command prints on both streams, or on stdout alone.
Result run(const std::string& command, const char* streams = " 2>/dev/null") {
  Result result;
  FILE* pipe = popen(std::string(command).append(streams).c_str(), "r");
  if (pipe == nullptr) return result;
  std::array<char, 4096> buffer;
  for (std::size_t n = 0; (n = fread(buffer.data(), 1, buffer.size(), pipe)) > 0;) {
    result.out.append(buffer.data(), n);
  }
  const int status = pclose(pipe);
  if (WIFEXITED(status)) result.exit_code = WEXITSTATUS(status);
  return result;
}

Result bench(const std::string& arguments, const char* streams = " 2>/dev/null") {
  return run(std::string(VIEWGAIN_BENCH).append(" ").append(arguments), streams);
}

double number(std::uint64_t i, double low, double high) {
  return low + (high - low) * unit_number(mix64(i));
}

Eigen::Vector3d point_in(std::uint64_t i, double half) {
  return {number(3 * i, -half, half), number(3 * i + 1, -half, half),
          number(3 * i + 2, -half, half)};
}

Voxel voxel_of(const Eigen::Vector3d& p, double size) {
  return {static_cast<int>(std::floor(p.x() / size)), static_cast<int>(std::floor(p.y() / size)),
          static_cast<int>(std::floor(p.z() / size))};
}

TEST(Peers, CountIsThatOfADenseMap) {
  const Eigen::Vector3d center(0.003, -0.002, 0.001);
  constexpr double kSize = 0.05;
  PeerMap map(center, kSize);
  std::map<Voxel, double> log_odds;
  for (int scan = 0; scan < 4; ++scan) {
    const Eigen::Vector3d eye =
        0.21 * Eigen::Vector3d(std::cos(1.3 * scan), std::sin(1.3 * scan), 0.37).normalized();
    std::vector<octomap::point3d> hits;
    std::set<Voxel> hit, crossed;
    for (std::uint64_t i = 0; i < 120; ++i) {
      const Eigen::Vector3d p = point_in(1000 * static_cast<std::uint64_t>(scan) + i, 0.06);
      hits.emplace_back(static_cast<float>(p.x()), static_cast<float>(p.y()),
                        static_cast<float>(p.z()));
      hit.insert(voxel_of(p, PeerMap::kVoxel));
      constexpr int kSteps = 20'000;
      for (int step = 0; step < kSteps; ++step) {
        crossed.insert(voxel_of(eye + (p - eye) * step / kSteps, PeerMap::kVoxel));
      }
    }
    for (const Voxel& voxel : crossed) {
      if (hit.count(voxel) == 0) log_odds[voxel] += std::log(0.4 / 0.6);
    }
    for (const Voxel& voxel : hit) log_odds[voxel] += std::log(0.7 / 0.3);
    for (auto& [voxel, value] : log_odds) {
      value = std::clamp(value, std::log(0.1192 / 0.8808), std::log(0.971 / 0.029));
    }
    std::size_t expected = 0;
    for (const auto& [voxel, value] : log_odds) {
      const Eigen::Vector3d middle =
          PeerMap::kVoxel * (Eigen::Vector3d(voxel[0], voxel[1], voxel[2]).array() + 0.5);
      const bool inside = (middle - center).cwiseAbs().maxCoeff() <= kSize;
      if (inside && 1 / (1 + std::exp(-value)) > PeerMap::kOccupiedAbove) ++expected;
    }
    map.insert(hits, eye);
    EXPECT_EQ(map.occupied(), expected) << "scan " << scan;
    EXPECT_GT(expected, 0U);
  }
}

TEST(Peers, CompleteModelIsTheVoxelsWithAPoint) {
  std::vector<Eigen::Vector3d> points;
  std::set<Voxel> voxels;
  for (std::uint64_t i = 0; i < 500; ++i) {
    points.push_back(point_in(i, 0.04));
    voxels.insert(voxel_of(points.back(), 0.01));
  }
  EXPECT_EQ(PeerMap::voxels_of(points), voxels.size());
}

TEST(Peers, PointsAreCoveredWithinTheRadius) {
  std::vector<Eigen::Vector3d> points;
  for (std::uint64_t i = 0; i < 800; ++i) points.push_back(point_in(i, 0.02));
  PointCoverage coverage(points);
  std::vector<std::uint8_t> covered(points.size(), 0);
  double before = 0;
  for (std::uint64_t batch = 0; batch < 3; ++batch) {
    std::vector<octomap::point3d> readings;
    for (std::uint64_t i = 0; i < 100; ++i) {
      const Eigen::Vector3d p = point_in(5000 + 100 * batch + i, 0.02);
      readings.emplace_back(static_cast<float>(p.x()), static_cast<float>(p.y()),
                            static_cast<float>(p.z()));
      for (std::size_t k = 0; k < points.size(); ++k) {
        const Eigen::Vector3d read =
            Eigen::Vector3f(readings.back().x(), readings.back().y(), readings.back().z())
                .cast<double>();
        if ((read - points[k]).norm() <= kCoveredWithin) covered[k] = 1;
      }
    }
    coverage.add(readings);
    const auto count = std::count(covered.begin(), covered.end(), 1);
    EXPECT_DOUBLE_EQ(coverage.share(), static_cast<double>(count) / 800.0);
    EXPECT_GT(coverage.share(), before);
    before = coverage.share();
  }
  EXPECT_LT(before, 1);
}

TEST(Peers, TheLensIsTheirPolynomialWithinHalfAPixel) {
  const Sensor sensor = peer_sensor(0.25, 0.6);
  EXPECT_LT(peer_lens_error(sensor), 0.5);
  Sensor plain = sensor;
  plain.camera.distortion = {};
  EXPECT_GT(peer_lens_error(plain), 3);
}

TEST(Peers, CameraSeesTheNearSideOfAWall) {
  std::vector<Eigen::Vector3d> points;  // two walls, 1 cm apart
  for (int i = -20; i <= 20; ++i) {
    for (int k = -20; k <= 20; ++k) {
      points.emplace_back(0.001, 0.002 * i + 0.001, 0.002 * k + 0.001);
      points.emplace_back(0.011, 0.002 * i + 0.001, 0.002 * k + 0.001);
    }
  }
  const VoxelTruth truth(points, peer_sensor(0.25, 0.6));
  ThreadPool one(1), two(2);
  const Pose pose = look_at({-0.251, 0.001, 0.001}, {0, 0.001, 0.001});
  const VoxelFrame frame = truth.acquire(pose, one);
  EXPECT_EQ(frame.voxels.size(), 41U * 41U);
  for (const auto& voxel : frame.voxels) EXPECT_NEAR(truth.center_of(voxel).x(), 0.001, 1e-6);
  int readings = 0;
  for (const float depth : frame.depth.depth) {
    if (depth == DepthFrame::kInvalid) continue;
    EXPECT_NEAR(depth, 0.252, 1e-5);
    ++readings;
  }
  // 8.2 cm at 0.252 m: 199 pixels a side.
  EXPECT_NEAR(readings, 199 * 199, 2000);
  const VoxelFrame again = truth.acquire(pose, two);
  EXPECT_EQ(again.depth, frame.depth);
  EXPECT_EQ(again.voxels, frame.voxels);
}

/// A folder with a box of 30 x 24 x 20 mm as OFF, gone at the end.
class PeerPrograms : public ::testing::Test {
 protected:
  PeerPrograms()
      : folder_(std::filesystem::temp_directory_path() /
                std::string("viewgain-peers-").append(std::to_string(getpid()))) {
    std::filesystem::create_directories(folder_);
    std::ofstream file(mesh());
    file << "OFF\n8 12 0\n";
    for (int i = 0; i < 8; ++i) {
      file << ((i & 1) != 0 ? 15 : -15) << ' ' << ((i & 2) != 0 ? 12 : -12) << ' '
           << ((i & 4) != 0 ? 10 : -10) << '\n';
    }
    for (const auto& t : kBoxTriangles) file << "3 " << t[0] << ' ' << t[1] << ' ' << t[2] << '\n';
  }
  ~PeerPrograms() override { std::filesystem::remove_all(folder_); }

  [[nodiscard]] std::string mesh() const { return (folder_ / "box.off").string(); }
  [[nodiscard]] std::string data() const { return (folder_ / "data").string(); }
  [[nodiscard]] std::filesystem::path models() const { return folder_ / "data" / "3d_models"; }

  void make_data() const {
    const Result made = run(std::string("python3 ")
                                .append(VIEWGAIN_PEERS)
                                .append("/make_stand_in.py ")
                                .append(mesh())
                                .append(" ")
                                .append(data())
                                .append(" --points 4000 --views 30"));
    ASSERT_EQ(made.exit_code, 0) << made.out;
  }

  std::filesystem::path folder_;
};

TEST_F(PeerPrograms, StandInIsByTheirRules) {
  make_data();
  const PublishedObject object = read_published_object(data());
  ASSERT_EQ(object.points.size(), 4000U);
  ASSERT_EQ(object.eyes.size(), 30U);
  Eigen::Vector3d center = Eigen::Vector3d::Zero();
  for (const Eigen::Vector3d& p : object.points) {
    center += p / 4000.0;
    EXPECT_NEAR((p.cwiseAbs() - Eigen::Vector3d(0.015, 0.012, 0.010)).maxCoeff(), 0, 1e-6);
  }
  EXPECT_LT((center - object.center).norm(), 1e-6);
  EXPECT_NEAR(predicted_size(object.points, object.center, 0.95), object.size, 1e-6);
  EXPECT_NEAR(object.eyes[0].x(), object.center.x() - 2.5 * object.size, 1e-6);
  for (std::size_t i = 1; i < object.eyes.size(); ++i) {
    const Eigen::Vector3d offset = object.eyes[i] - object.center;
    EXPECT_GE(offset.cwiseAbs().maxCoeff(), 2 * object.size - 1e-6);
    EXPECT_LE(offset.norm(), 4 * object.size + 1e-6);
  }
}

TEST_F(PeerPrograms, ArmadilloCountsWhatItSays) {
  make_data();
  const Result result = bench(std::string("armadillo --json --threads 2 --views 5 --stride 16 "
                                          "--gain combined --travel 0,0.5 --data ")
                                  .append(data()));
  ASSERT_EQ(result.exit_code, 0) << result.out;
  const Json json = Json::parse(result.out);
  const auto all = static_cast<double>(PeerMap::voxels_of(read_published_object(data()).points));
  EXPECT_EQ(json["voxels"], all);
  EXPECT_NEAR(json["their_log"][4].get<double>(), 0.914, 0.0005);
  ASSERT_EQ(json["runs"].size(), 2U);
  for (const Json& one : json["runs"]) {
    ASSERT_EQ(one["views"].size(), 5U);
    EXPECT_EQ(one["views"][0]["candidate"], 0);
    std::set<std::size_t> taken;
    double covered = 0, travelled = 0;
    for (const Json& view : one["views"]) {
      EXPECT_TRUE(taken.insert(view["candidate"].get<std::size_t>()).second);
      EXPECT_GE(view["covered"].get<double>(), covered);
      EXPECT_GE(view["travelled"].get<double>(), travelled);
      EXPECT_DOUBLE_EQ(view["counted"].get<double>(), view["occupied"].get<double>() / all);
      covered = view["covered"];
      travelled = view["travelled"];
    }
    EXPECT_GT(covered, one["views"][0]["covered"].get<double>());
  }
  EXPECT_GT(json["runs"][0]["views"][4]["covered"].get<double>(), 0.8);
  // A share of the way in the score shortens it.
  EXPECT_LT(json["runs"][1]["views"][4]["travelled"].get<double>(),
            json["runs"][0]["views"][4]["travelled"].get<double>());
}

TEST_F(PeerPrograms, BadDataIsNamed) {
  const std::string call = std::string("armadillo --data ").append(data());
  int cases = 0;
  const auto expect_named = [&](const std::string& name) {
    const Result result = bench(call, " 2>&1");
    EXPECT_EQ(result.exit_code, 2) << result.out;
    EXPECT_NE(result.out.find(name), std::string::npos) << result.out;
    ++cases;
  };
  expect_named("Armadillo.pcd");  // no folder
  make_data();
  std::filesystem::remove(models() / "Armadillo.txt");
  expect_named("Armadillo.txt");
  const auto views = [&](const char* text) { std::ofstream(models() / "Armadillo.txt") << text; };
  views("2\n0 0 0\n0.02\n0.1 0 0\n");  // one position is missing
  expect_named("Armadillo.txt:5");
  views("two\n");
  expect_named("Armadillo.txt:1");
  views("1\n0 0\n0.02\n0.1 0 0\n");
  expect_named("Armadillo.txt:2");
  views("1\n0 0 0\n-0.02\n0.1 0 0\n");
  expect_named("Armadillo.txt:3");
  views("1\n0 0 0\n0.02\n0.1 0 0 7\n");
  expect_named("Armadillo.txt:4");
  std::ofstream(models() / "Armadillo.pcd") << "VERSION 0.7\nFIELDS x y\n";
  expect_named("Armadillo.pcd");
  EXPECT_EQ(cases, 8);
}

TEST_F(PeerPrograms, HemisphereEndsWithAll) {
  const std::filesystem::path views = folder_ / "views.txt";
  std::ofstream(views) << "5\n0.1 0 0.2\n-0.2 0.1 0.1\n0 0.3 0.05\n0 0 0.4\n0.1 -0.4 0.1\n";
  const std::string call =
      std::string(
          "hemisphere --json --threads 2 --size 0.03 --first-views 2 --budget 5 --gain "
          "combined,random --mesh ")
          .append(mesh())
          .append(" --views-file ");
  const Result result = bench(call + views.string());
  ASSERT_EQ(result.exit_code, 0) << result.out;
  const Json json = Json::parse(result.out);
  EXPECT_EQ(json["views"], 5);
  ASSERT_EQ(json["rows"].size(), 4U);  // the box, and all objects together
  for (const Json& row : json["rows"]) {
    EXPECT_EQ(row["runs"], 2);
    ASSERT_EQ(row["coverage"].size(), 5U);
    for (std::size_t i = 1; i < 5; ++i) {
      EXPECT_GE(row["coverage"][i].get<double>(), row["coverage"][i - 1].get<double>());
    }
    EXPECT_NEAR(row["coverage"][4].get<double>(), 1, 1e-12);
    EXPECT_LT(row["coverage"][0].get<double>(), 1);
    EXPECT_LE(row["views_to_theirs"].get<double>(), 5);
  }
  std::ofstream(views) << "2\n0.1 0 0.2\n0 0 0\n";
  const Result bad = bench(call + views.string(), " 2>&1");
  EXPECT_EQ(bad.exit_code, 2);
  EXPECT_NE(bad.out.find("views.txt"), std::string::npos) << bad.out;
}

TEST_F(PeerPrograms, FramesHasARowForEachTurn) {
  const Result result = bench(std::string("frames --json --threads 2 --seeds 1 --views 3 "
                                          "--candidates 12 --voxel 0.02 --degrees 0,40 --mesh ")
                                  .append(mesh()));
  ASSERT_EQ(result.exit_code, 0) << result.out;
  const Json json = Json::parse(result.out);
  ASSERT_EQ(json["rows"].size(), 3U);  // not turned, and about two axes
  for (const Json& row : json["rows"]) {
    EXPECT_EQ(row["runs"], 1);
    for (const char* sensor : {"sr4000", "elongated"}) {
      EXPECT_LE(row[sensor]["rank_correlation"].get<double>(), 1) << sensor;
      EXPECT_GT(row[sensor]["rank_correlation"].get<double>(), 0) << sensor;
      EXPECT_GE(row[sensor]["given_away"].get<double>(), 0) << sensor;
      EXPECT_LT(row[sensor]["given_away"].get<double>(), 1) << sensor;
      EXPECT_GT(row[sensor]["ratio"].get<double>(), 0) << sensor;
    }
    EXPECT_GE(row["views_by_log_diagonal"].get<double>(), 1);
    EXPECT_LE(row["views_by_log_diagonal"].get<double>(), 4);
  }
}

}  // namespace
}  // namespace viewgain::bench
