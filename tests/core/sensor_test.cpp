// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include "viewgain/core/sensor.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include "expect_error.hpp"

namespace viewgain {
namespace {

using test::expect_error;

TEST(SensorPresets, AreAllValid) {
  EXPECT_EQ(sensor_preset_names(), (std::vector<std::string>{"sr4000", "azure_kinect_nfov",
                                                             "kinect_v1", "d435", "laser_line"}));
  int cases = 0;
  for (const std::string& name : sensor_preset_names()) {
    const Sensor sensor = sensor_preset(name);
    EXPECT_NO_THROW(sensor.validate()) << name;
    EXPECT_EQ(sensor.name, name);
    EXPECT_FALSE(sensor.camera.has_distortion());
    EXPECT_FALSE(sensor.T_flange_camera.has_value());
    ++cases;
  }
  EXPECT_EQ(cases, 5);
  EXPECT_NO_THROW(Sensor{}.validate());
  EXPECT_EQ(Sensor{}.name, "sr4000");
  expect_error(ErrorCode::invalid_argument,
               "unknown sensor 'sr3000'; valid values: sr4000, azure_kinect_nfov, kinect_v1, d435, "
               "laser_line",
               [] { (void)sensor_preset("sr3000"); });
}

TEST(SensorPresets, MakersHousingsDiffer) {
  EXPECT_FALSE(sensor_preset("sr4000").body_size);  // what FeasibilityConfig::Body has
  EXPECT_EQ(sensor_preset("d435").body_size, (std::array<double, 3>{0.090, 0.025, 0.025}));
  for (const double wrong : {0.0, -0.1, std::nan("")}) {
    Sensor sensor = sensor_preset("d435");
    sensor.body_size = {0.1, wrong, 0.1};
    EXPECT_THROW(sensor.validate(), Error);
  }
}

TEST(SensorPresets, ATableOfRangesHasToLeaveRanges) {
  Sensor sensor = sensor_preset("sr4000");
  EXPECT_TRUE(sensor.range_calibration.table.empty());
  sensor.range_calibration.table = {{0.5, 0.01}, {1.0, -0.02}};
  EXPECT_NO_THROW(sensor.validate());
  const auto refused = [&](std::vector<std::array<double, 2>> table, const char* part) {
    sensor.range_calibration.table = std::move(table);
    expect_error(ErrorCode::invalid_argument, part, [&] { sensor.validate(); });
  };
  refused({{1.0, 0.0}, {0.5, 0.0}}, "must increase");
  refused({{0.0, -0.1}}, "not a valid range");
  refused({{-1.0, -2.0}}, "not a valid range");
  refused({{0.5, 0.0}, {1.0, 1.0}}, "not a valid range");
  refused({{0.5, std::nan("")}}, "finite");
}

TEST(SensorPresets, AzureKinectMeetsItsMakersBoundAtTheFarEnd) {
  const Sensor s = sensor_preset("azure_kinect_nfov");
  EXPECT_EQ(s.camera, (PinholeCamera{640, 576, 417.0, 452.1, 319.5, 287.5, {}}));
  EXPECT_EQ(s.min_range, 0.5);
  EXPECT_EQ(s.max_range, 3.86);
  EXPECT_EQ(s.working_distance, 1.0);
  EXPECT_NEAR(s.sigmas(3.86).axial, 17e-3, 0.01e-3);
  EXPECT_NEAR(s.sigmas(1.0).axial, 2.074e-3, 1e-15);
  EXPECT_NEAR(s.sigmas(1.0).lateral, 1 / 417.0, 1e-15);
}

TEST(Sensor, ValidateNamesTheField) {
  constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
  int cases = 0;
  const auto expect_bad = [&cases](const char* field, const auto& spoil) {
    Sensor sensor = sensor_preset("sr4000");
    spoil(sensor);
    expect_error(ErrorCode::invalid_argument, field, [&] { sensor.validate(); });
    ++cases;
  };
  expect_bad("width", [](Sensor& s) { s.camera.width = 0; });
  expect_bad("min_range", [](Sensor& s) { s.min_range = -0.1; });
  expect_bad("min_range", [](Sensor& s) { s.min_range = kNan; });
  expect_bad("max_range", [](Sensor& s) { s.max_range = 0.2; });
  expect_bad("max_range", [](Sensor& s) { s.max_range = std::numeric_limits<double>::infinity(); });
  expect_bad("working_distance", [](Sensor& s) { s.working_distance = 0.1; });
  expect_bad("working_distance", [](Sensor& s) { s.working_distance = 6; });
  expect_bad("working_distance", [](Sensor& s) { s.working_distance = kNan; });
  expect_bad("integration_time", [](Sensor& s) { s.noise = ShotNoise{.integration_time = 0}; });
  expect_bad("modulation_frequency",
             [](Sensor& s) { s.noise = ShotNoise{.modulation_frequency = -1}; });
  expect_bad("modulation_frequency",
             [](Sensor& s) { s.noise = ShotNoise{.modulation_frequency = kNan}; });
  expect_bad("min_amplitude", [](Sensor& s) { s.noise = ShotNoise{.min_amplitude = -0.1}; });
  expect_bad("grazing", [](Sensor& s) { s.noise = StructuredLightNoise{.grazing = -1}; });
  expect_bad("baseline", [](Sensor& s) { s.noise = StereoNoise{.baseline = kNan}; });
  expect_bad("focal", [](Sensor& s) { s.noise = StereoNoise{.focal = -1}; });
  // Small values keep their digits.
  expect_bad("not -1e-09", [](Sensor& s) { s.min_range = -1e-9; });
  expect_bad("offset", [](Sensor& s) { s.noise = QuadraticNoise{.offset = -1e-3}; });
  expect_bad("sigma_lateral", [](Sensor& s) { s.noise = ConstantNoise{.sigma_lateral = 0}; });
  expect_bad("T_flange_camera", [](Sensor& s) {
    s.T_flange_camera = Pose(2 * Eigen::Matrix3d::Identity(), Eigen::Vector3d::Zero());
  });
  expect_bad("pose_sigma", [](Sensor& s) { s.pose_sigma.translation = -0.001; });
  expect_bad("pose_sigma", [](Sensor& s) { s.pose_sigma.rotation = kNan; });
  expect_bad("scale_sigma", [](Sensor& s) { s.scale_sigma = -0.001; });
  expect_bad("scale_sigma", [](Sensor& s) { s.scale_sigma = kNan; });
  EXPECT_EQ(cases, 23);
  Sensor touching = sensor_preset("sr4000");
  touching.noise = ShotNoise{.modulation_frequency = 0, .min_amplitude = 0};
  touching.min_range = 0;
  touching.T_flange_camera = look_at({0, 0, 1}, {0, 0, 0});
  EXPECT_NO_THROW(touching.validate());
}

// What only adds to a sigma may be 0, as long as no reading within the ranges is exact.
TEST(Sensor, ASigmaMayLackAPartThatOthersMakeUpFor) {
  const auto expect = [](bool is_valid, const NoiseModel& noise, double min_range = 0.2) {
    Sensor sensor = sensor_preset("sr4000");
    sensor.min_range = min_range;
    sensor.working_distance = 0.7;
    sensor.noise = noise;
    if (!is_valid)
      return expect_error(ErrorCode::invalid_argument, "the standard deviation along the ray is 0",
                          [&] { sensor.validate(); });
    EXPECT_NO_THROW(sensor.validate());
    for (const double t : {min_range, 0.45, 0.7, sensor.max_range}) {
      EXPECT_GT(sensor.noise_sigmas(t).axial, 0) << t;
    }
  };
  expect(true, QuadraticNoise{.offset = 0});
  expect(true, QuadraticNoise{.offset = 0}, 0.0);  // as at kMinNoiseRange
  expect(true, QuadraticNoise{.offset = 0, .quadratic = 0, .linear = 0.005});
  expect(true, QuadraticNoise{.offset = 1e-3, .quadratic = 0});
  expect(false, QuadraticNoise{.offset = 0, .quadratic = 0});
  expect(true, StructuredLightNoise{.offset = 0, .vertex = 0});
  expect(true, StructuredLightNoise{.offset = 0, .vertex = 0.4}, 0.41);
  expect(false, StructuredLightNoise{.offset = 0, .vertex = 0.4});  // exact at its vertex
  expect(false, StructuredLightNoise{.offset = 0, .quadratic = 0});
  expect(true, StructuredLightNoise{.quadratic = 0, .grazing = 0, .lateral_grazing_px = 0});
}

// Against C + J Σ Jᵀ with J = [I, -[p]x], p the reading's place.
TEST(Sensor, SigmasOfAReadingHaveThePosesError) {
  Sensor sensor = sensor_preset("sr4000");
  EXPECT_EQ(sensor.sigmas(0.7, 0.5).axial, sensor.noise_sigmas(0.7, 0.5).axial);
  EXPECT_EQ(sensor.sigmas(0.7, 0.5).lateral, sensor.noise_sigmas(0.7, 0.5).lateral);
  for (const PoseSigma& pose : {PoseSigma{0.005, 0}, PoseSigma{0, 0.01}, PoseSigma{0.01, 0.0175}}) {
    sensor.pose_sigma = pose;
    for (const Eigen::Vector3d& p : {Eigen::Vector3d(0, 0, 0.4), Eigen::Vector3d(0.3, -0.2, 1.1),
                                     Eigen::Vector3d(-1, 0.5, 3)}) {
      const auto covariance = [&p](const MeasurementSigmas& s) -> Eigen::Matrix3d {
        const Eigen::Vector3d d = p.normalized();
        const Eigen::Matrix3d along = d * d.transpose();
        return s.axial * s.axial * along +
               s.lateral * s.lateral * (Eigen::Matrix3d::Identity() - along);
      };
      Eigen::Matrix3d cross;
      cross << 0, -p.z(), p.y(), p.z(), 0, -p.x(), -p.y(), p.x(), 0;
      Eigen::Matrix<double, 3, 6> J;
      J << Eigen::Matrix3d::Identity(), -cross;
      Eigen::Matrix<double, 6, 1> variances;
      variances << Eigen::Vector3d::Constant(pose.translation * pose.translation),
          Eigen::Vector3d::Constant(pose.rotation * pose.rotation);
      const Eigen::Matrix3d expected = covariance(sensor.noise_sigmas(p.norm(), 0.8)) +
                                       J * variances.asDiagonal() * J.transpose();
      EXPECT_LT((covariance(sensor.sigmas(p.norm(), 0.8)) - expected).norm(),
                1e-12 * expected.norm());
    }
  }
}

TEST(Sensor, DefaultPriorIsNeverSurerThanTwoReadings) {
  const Sensor s = sensor_preset("sr4000");
  EXPECT_EQ(default_prior_sigma(3.125e-3, s), 2 * s.sigmas(0.4).axial);
  EXPECT_EQ(default_prior_sigma(0.02, s), 0.01);
  for (const double voxel_size : {0.0, -0.01, std::nan(""), HUGE_VAL}) {
    EXPECT_THROW(static_cast<void>(default_prior_sigma(voxel_size, s)), Error) << voxel_size;
  }
}

}  // namespace
}  // namespace viewgain
