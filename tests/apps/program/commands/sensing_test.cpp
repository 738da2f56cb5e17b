// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0

// What disturbs the simulated time-of-flight camera, and what integrate does about it.

#include <Eigen/Geometry>
#include <filesystem>
#include <numbers>
#include <string>
#include <vector>

#include "apps/program_runner.hpp"
#include "viewgain/core/generators.hpp"
#include "viewgain/core/pose_io.hpp"
#include "viewgain/formats/frames.hpp"
#include "viewgain/grid/vdb_io.hpp"
#include "viewgain/support/json.hpp"
#include "viewgain/support/text.hpp"

namespace viewgain {
namespace {

class Sensing : public test::ProgramTest {
 protected:
  Sensing() {
    write_cube();
    write_small_sensor();
    std::string tof = read("small.toml");
    tof.replace(tof.find("model"), std::string::npos,
                "model = \"shot\"\nreference_sigma = 0.004\nreference_range = 1.3\n"
                "reference_integration_time = 0.0085\nintegration_time = 0.001\n");
    write("tof.toml", tof);
  }

  json simulate(const std::string& out, const Strings& more = {},
                const std::string& sensor = "tof.toml") const {
    return json::parse(run_well(
        test::joined({"simulate", "cube.off", "--poses", "orbit:2,0.6,27,0,46", "--sensor", sensor,
                      "--size", "0.3", "--place", "center", "--out", out, "--json"},
                     more)));
  }

  json integrate(const std::string& frames, const Strings& more = {}) const {
    return json::parse(run_well(test::joined(
        {"integrate", frames, "--voxel", "0.02", "--workspace", "-0.2,-0.2,-0.2,0.2,0.2,0.2",
         "--jump-edge-filter", "off", "--out", "map.vdb", "--json"},
        more)));
  }

  [[nodiscard]] std::vector<DepthFrame> load(const std::string& name) const {
    const auto frames = open_frames(dir / name, "", std::nullopt);
    std::vector<DepthFrame> result;
    for (std::size_t i = 0; i < frames.images.size(); ++i) {
      result.push_back(load_frame(frames, i));
    }
    return result;
  }

  [[nodiscard]] bool has_amplitude(const std::string& name) const {
    return std::filesystem::exists(dir / name / "frame-000000.amplitude.png");
  }
};

TEST_F(Sensing, AmplitudeImagesAreWrittenAndUsed) {
  EXPECT_EQ(simulate("frames").at("amplitude"), true);
  EXPECT_TRUE(has_amplitude("frames"));
  const json with = integrate("frames");
  for (const auto& entry : std::filesystem::directory_iterator(dir / "frames")) {
    if (entry.path().string().ends_with(".amplitude.png")) std::filesystem::remove(entry.path());
  }
  EXPECT_FALSE(has_amplitude("frames"));
  const json without = integrate("frames");
  EXPECT_EQ(without.at("readings"), with.at("readings"));
  EXPECT_EQ(without.at("occupied"), with.at("occupied"));
  EXPECT_NE(without.at("hash"), with.at("hash"));  // other covariances

  EXPECT_EQ(simulate("other", {}, "small.toml").at("amplitude"), false);
  EXPECT_FALSE(has_amplitude("other"));
}

TEST_F(Sensing, FlyingPixelsFollowTheNoiseUnlessAsked) {
  EXPECT_EQ(simulate("off").at("flying_pixels"), false);
  EXPECT_EQ(simulate("noisy", {"--noise", "on"}).at("flying_pixels"), true);
  EXPECT_EQ(simulate("noise_alone", {"--noise", "plain"}).at("flying_pixels"), false);
  EXPECT_EQ(simulate("mixed", {"--noise", "flying"}).at("flying_pixels"), true);
  // They need a phase.
  EXPECT_EQ(simulate("kinect", {"--noise", "flying"}, "small.toml").at("flying_pixels"), false);

  EXPECT_NE(load("off"), load("mixed"));
  EXPECT_NE(load("noisy"), load("noise_alone"));
}

TEST_F(Sensing, AMeshInMillimetresIsNamed) {
  write("mm.off", "OFF\n3 1 0\n-100 -100 0\n100 -100 0\n0 100 50\n3 0 1 2\n");
  const test::ProgramResult result = run(
      {"simulate", "mm.off", "--poses", "orbit:1,101,80", "--sensor", "tof.toml", "--out", "far"});
  EXPECT_EQ(result.exit_code, 2) << result.err;  // nothing is in range
  write("near.off", "OFF\n3 1 0\n-100 -100 0\n100 -100 0\n0 100 0\n3 0 1 2\n");
  const std::string said = run({"simulate", "near.off", "--poses", "orbit:1,1,80", "--sensor",
                                "tof.toml", "--out", "near"})
                               .err;
  EXPECT_NE(said.find("near.off is 200 m long"), std::string::npos) << said;
}

TEST_F(Sensing, AMeshUnderTheTableIsToldOf) {
  const auto warns = [this](const char* z) {
    const test::ProgramResult result =
        run({"simulate", "cube.off", "--poses", "orbit:1,0.6,40", "--sensor", "small.toml",
             "--size", "0.2", "--place", std::string("center,0,0,") + z, "--support-plane", "0",
             "--out", "table"});
    EXPECT_EQ(result.exit_code, 0) << result.err;
    return result.err.find("at least half of it is below the support plane, whose height is 0 m") !=
           std::string::npos;
  };
  EXPECT_TRUE(warns("0"));
  EXPECT_TRUE(warns("-0.05"));
  EXPECT_FALSE(warns("0.01"));
  EXPECT_FALSE(warns("0.1"));
}

TEST_F(Sensing, ReadingsFarUnderTheTableAreToldOf) {
  run_well({"simulate", "cube.off", "--poses", "orbit:6,0.6,20", "--sensor", "small.toml", "--size",
            "0.2", "--place", "center", "--background", "0", "--out", "free", "--quiet"});
  const auto warns = [this](const char* z) {
    const test::ProgramResult result =
        run({"integrate", "free", "--voxel", "0.02", "--workspace", "-0.2,-0.2,-0.2,0.2,0.2,0.2",
             "--support-plane", z, "--out", "map.vdb"});
    EXPECT_EQ(result.exit_code, 0) << result.err;
    return result.err.find("below the support plane") != std::string::npos;
  };
  EXPECT_TRUE(warns("0.05"));  // the cube is from -0.1 to 0.1
  EXPECT_TRUE(warns("0"));
  EXPECT_FALSE(warns("-0.06"));  // what is under it is within 5 cm
  EXPECT_FALSE(warns("-0.1"));
}

TEST_F(Sensing, AScaleErrorIsInTheFrames) {
  EXPECT_EQ(simulate("exact").at("scale_error"), 0.0);
  EXPECT_EQ(simulate("off", {"--noise", "scale=0.05"}).at("scale_error"), 0.05);
  EXPECT_NE(load("exact"), load("off"));
  for (const char* bad : {"1", "-1", "nan", "x"}) {
    expect_refused_with({"simulate", "cube.off", "--poses", "orbit:2,0.6,27,0,46", "--sensor",
                         "tof.toml", "--size", "0.3", "--out", "new"},
                        {{{"--noise", std::string("scale=") + bad}, "scale"}});
  }
}

TEST_F(Sensing, CoarseLeavesKeepAllReadings) {
  simulate("frames");
  const auto scales_of = [&](const Strings& more) {
    const json report = json::parse(
        run_well(test::joined({"integrate", "frames", "--voxel", "0.0025", "--workspace",
                               "-0.2,-0.2,-0.2,0.2,0.2,0.2", "--out", "map.vdb", "--json"},
                              more)));
    const BeliefGrid map = load_vdb(dir / "map.vdb");
    std::uint64_t hits = 0, coarse = 0;
    map.for_each_belief([&](Index3 v, const Belief& belief) {
      hits += belief.hits;
      coarse += map.scale(v) > 0 ? 1U : 0U;
    });
    EXPECT_EQ(hits, report.at("readings_inside").get<std::uint64_t>());
    return coarse;
  };
  EXPECT_EQ(scales_of({}), 0U);
  EXPECT_GT(scales_of({"--scales", "2"}), 100U);
  EXPECT_EQ(scales_of({"--scales", "2", "--fine", "-1,-1,-1,1,1,1"}), 0U);
  EXPECT_NE(scales_of({"--scales", "3,3"}), scales_of({"--scales", "3"}));
}

TEST_F(Sensing, BadFlagsAndImagesAreRefused) {
  simulate("frames");
  write("frames/frame-000001.amplitude.png", "no image");
  const auto refused = [&](const Strings& more, const std::string& word) {
    expect_refused_with({"integrate", "frames", "--voxel", "0.02", "--out", "new.vdb"},
                        {{more, word}});
  };
  const auto left_out = run({"integrate", "frames", "--voxel", "0.02", "--out", "left.vdb"});
  EXPECT_EQ(left_out.exit_code, 0);
  EXPECT_NE(left_out.err.find("frame-000001.amplitude.png"), std::string::npos);
  refused({"--jump-edge-filter", "0.5"}, "1..10 degrees");
  refused({"--jump-edge-filter", "11"}, "1..10 degrees");
  refused({"--jump-edge-filter", "on"}, "--jump-edge-filter");
  refused({"--scales", "4"}, "--scales 4");
  refused({"--fine", "0,0,0,1,1,1"}, "--fine requires --scales");
  refused({"--scales", "1,2"}, "--scales 1,2");
  refused({"--scales", "1", "--fine", "0,0,0,0,1,1"}, "--fine");
  refused({"--support-plane", "nan", "--workspace", "-1,-1,-1,1,1,1"}, "support plane");
  refused({"--support-plane", "inf"}, "support plane");
}

// The cube at a place, seen from a pose, is the cube at home, seen from the pose carried back.
TEST_F(Sensing, AMeshIsPlacedInTheWorld) {
  const Pose T_world_mesh(
      Eigen::AngleAxisd(std::numbers::pi / 6, Eigen::Vector3d::UnitZ()).toRotationMatrix(),
      Eigen::Vector3d(1.5, -0.25, 0.75));
  const std::vector<Pose> home = sphere_poses(5, 0.7);
  std::vector<Pose> there;
  for (const Pose& pose : home) there.push_back(T_world_mesh * pose);
  write_tum(dir / "home.txt", home);
  write_tum(dir / "there.txt", there);
  const auto readings = [this](const std::string& poses, const Strings& more) {
    return json::parse(run_well(test::joined(
                           {"simulate", "cube.off", "--poses", poses, "--sensor", "small.toml",
                            "--size", "0.3", "--background", "0", "--out", "placed", "--json"},
                           more)))
        .at("readings")
        .get<double>();
  };
  const double expected = readings("home.txt", {"--place", "center"});
  const Eigen::Quaterniond q(T_world_mesh.rotation());
  const std::string place = "1.5,-0.25,0.75,0,0," + exact_text(q.z()) + "," + exact_text(q.w());
  EXPECT_NEAR(readings("there.txt", {"--place", "center," + place}), expected, 0.002 * expected);
  expect_refused_with(
      {"simulate", "cube.off", "--poses", "there.txt", "--sensor", "small.toml", "--out", "none"},
      {{{"--place", "1,2"}, "--place 1,2"},
       {{"--place", "1,2,3,4,5"}, "--place"},
       {{"--place", "0,0,0,0,0,0,2"}, "norm"},
       {{"--place", "90,0,0"}, "no pose sees the mesh"}});
}

TEST_F(Sensing, MendedMeshesAreReported) {
  // A pyramid whose base is a bow tie, with a face in a line.
  const std::string sides =
      "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 0.5 0.5 1\nv 2 0 0\n"
      "f 1 2 5\nf 2 3 5\nf 3 4 5\nf 4 1 5\n";
  write("tie.obj", sides + "f 1 2 4 3\nf 1 2 6\nf 2 2 6\n");
  write("line.obj", sides + "f 1 2 3 4\nf 1 2 6\n");
  const auto call = [](const std::string& mesh) {
    return Strings{"simulate", mesh,         "--poses", "orbit:2,0.6,27,0,46",
                   "--sensor", "small.toml", "--size",  "0.3",
                   "--place",  "center",     "--out",   "mended",
                   "--json"};
  };
  const auto tie = run(call("tie.obj"));
  EXPECT_EQ(tie.exit_code, 0);
  EXPECT_EQ(tie.err,
            "viewgain: warning: tie.obj: 1 face crosses itself and was split at the crossings; 2 "
            "faces without area were removed\n");
  EXPECT_EQ(json::parse(tie.out).at("mended_faces"), 1);
  EXPECT_EQ(json::parse(tie.out).at("dropped_faces"), 2);
  EXPECT_EQ(json::parse(tie.out).at("triangles"), 6);
  const auto line = run(call("line.obj"));
  EXPECT_EQ(line.err, "viewgain: warning: line.obj: 1 face without area was removed\n");
  EXPECT_EQ(json::parse(line.out).at("mended_faces"), 0);
}

}  // namespace
}  // namespace viewgain
