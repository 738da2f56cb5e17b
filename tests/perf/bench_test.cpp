// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0

// viewgain-bench runs with tiny settings, keeps its JSON's keys, and the methods agree. No times.
#include <gtest/gtest.h>
#include <sys/wait.h>

#include <array>
#include <cstdio>
#include <nlohmann/json.hpp>
#include <set>
#include <string>

namespace {

using Json = nlohmann::json;

struct Result {
  int exit_code = -1;
  std::string out;
};

Result run(const std::string& arguments) {
  Result result;
  const std::string command = std::string(VIEWGAIN_BENCH) + " " + arguments + " 2>/dev/null";
  FILE* pipe = popen(command.c_str(), "r");
  if (pipe == nullptr) return result;
  std::array<char, 4096> buffer;
  for (std::size_t n = 0; (n = fread(buffer.data(), 1, buffer.size(), pipe)) > 0;) {
    result.out.append(buffer.data(), n);
  }
  const int status = pclose(pipe);
  if (WIFEXITED(status)) result.exit_code = WEXITSTATUS(status);
  return result;
}

TEST(Bench, AllWaysToTraceAgree) {
  const Result result = run("trace --json --voxels 48 --poses 4 --repetitions 1 --threads 2");
  ASSERT_EQ(result.exit_code, 0) << result.out;
  const Json json = Json::parse(result.out);
  EXPECT_EQ(json["scene"], "camel-48");
  EXPECT_EQ(json["threads"], 2);
  EXPECT_EQ(json["rays_per_pose"], 25344);
  EXPECT_TRUE(json["isa"].is_string());
  EXPECT_EQ(json["agree"], true);
  std::set<std::string> names;
  for (const Json& method : json["methods"]) {
    const auto name = method["name"].get<std::string>();
    names.insert(name);
    EXPECT_GT(method["rays_per_second"].get<double>(), 0) << name;
    EXPECT_LE(method["p05"], method["p95"]) << name;
    EXPECT_GE(json["agreement"][name].get<double>(), 0.9999) << name;
    EXPECT_EQ(json["wrong"][name], 0) << name;
  }
  for (const char* name : {"viewgain_gain", "viewgain_trace", "viewgain_floor", "embree_quads",
                           "openvdb_dda", "octomap_cast_ray"}) {
    EXPECT_EQ(names.count(name), 1U) << name;
  }
  for (const char* ratio : {"viewgain_gain/embree_quads", "viewgain_gain/octomap_cast_ray",
                            "viewgain_trace/embree_quads", "viewgain_gain/viewgain_trace"}) {
    EXPECT_TRUE(json["ratios"][ratio].is_number()) << ratio;
  }
}

TEST(Bench, OctomapAndOursMakeTheSameMap) {
  const Result result = run("integrate --json --voxels 64 --repetitions 1 --threads 2");
  ASSERT_EQ(result.exit_code, 0) << result.out;
  const Json json = Json::parse(result.out);
  EXPECT_EQ(json["agree"], true);
  EXPECT_EQ(json["agreement"].size(), 2U);
  for (const Json& comparison : json["agreement"]) {
    EXPECT_EQ(comparison["voxels"], 64 * 64 * 64);
    EXPECT_GE(comparison["equal"].get<double>(), 0.999);
    EXPECT_EQ(comparison["unexplained"], 0);
  }
  EXPECT_TRUE(json["ratios"]["octomap/viewgain_lines"].is_number());
  EXPECT_TRUE(json["ratios"]["octomap/viewgain_cones"].is_number());
}

TEST(Bench, BadInputEndsWithTwo) {
  EXPECT_EQ(run("").exit_code, 2);
  EXPECT_EQ(run("trace --poses 0").exit_code, 2);
  EXPECT_EQ(run("trace --mesh /nonexistent.off --repetitions 1").exit_code, 2);
  EXPECT_EQ(run("--help").exit_code, 0);
}

}  // namespace
