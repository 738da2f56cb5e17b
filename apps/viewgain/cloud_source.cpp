// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include <Eigen/Core>

#include "formats/sensor_toml.hpp"
#include "formats/values.hpp"
#include "reading_source.hpp"
#include "viewgain/core/error.hpp"
#include "viewgain/core/pose_io.hpp"
#include "viewgain/grid/cloud_io.hpp"
#include "viewgain/grid/integrate_cloud.hpp"

namespace viewgain::app {
namespace {

Sensor sensor_of(const IntegrateOptions& options) {
  if (options.sensor.empty()) {
    throw Error(ErrorCode::invalid_argument, "--sensor is needed with --cloud");
  }
  return load_sensor(options.sensor);
}

class CloudSource : public ReadingSource {
 public:
  explicit CloudSource(const IntegrateOptions& options)
      : files_(options.clouds),
        sensor_(sensor_of(options)),
        support_plane_(options.support_plane),
        integrator_(sensor_, {options.occupancy_rule(), options.support_plane},
                    {options.common.threads}) {
    if (options.poses.empty()) {
      if (options.origin == "viewpoint") return;
      const std::vector<double> at = parse_numbers("--origin", options.origin, 3, 3);
      origin_ = Pose(Eigen::Matrix3d::Identity(), Eigen::Vector3d(at[0], at[1], at[2]));
      return;
    }
    poses_ = read_tum(options.poses);
    if (poses_.poses.size() != files_.size()) {
      throw Error(ErrorCode::invalid_argument,
                  options.poses + ": has " + std::to_string(poses_.poses.size()) + " poses for " +
                      std::to_string(files_.size()) + " clouds");
    }
  }

  [[nodiscard]] const Sensor& sensor() const override { return sensor_; }
  [[nodiscard]] std::size_t size() const override { return files_.size(); }
  [[nodiscard]] std::size_t orthonormalized() const override { return poses_.orthonormalized; }

  void load(std::size_t index) override {
    cloud_ = load_cloud(files_[index]);
    if (!poses_.poses.empty()) {
      T_world_sensor_ = poses_.poses[index];
      for (auto& point : cloud_.points) {
        const Eigen::Vector3d p = T_world_sensor_ * Eigen::Vector3d(point[0], point[1], point[2]);
        point = {p.x(), p.y(), p.z()};
      }
    } else if (origin_) {
      T_world_sensor_ = *origin_;
    } else if (cloud_.viewpoint) {
      T_world_sensor_ = *cloud_.viewpoint;
    } else {
      throw Error(ErrorCode::invalid_argument,
                  files_[index] + ": has no VIEWPOINT, so --origin or --poses is needed");
    }
  }
  [[nodiscard]] std::optional<Box> bounds() const override {
    return reading_bounds(sensor_, cloud_.points, T_world_sensor_, {}, support_plane_);
  }
  IntegrationReport integrate(BeliefGrid& grid) override {
    return integrator_.integrate(grid, cloud_.points, T_world_sensor_);
  }

 private:
  std::vector<std::string> files_;
  Sensor sensor_;
  std::optional<double> support_plane_;
  CloudIntegrator integrator_;
  PoseList poses_;              // empty: the points are in the world
  std::optional<Pose> origin_;  // of all clouds; nothing: each has its own
  PointCloud cloud_;            // in the world
  Pose T_world_sensor_;
};

}  // namespace

std::unique_ptr<ReadingSource> open_cloud_source(const IntegrateOptions& options) {
  return std::make_unique<CloudSource>(options);
}

}  // namespace viewgain::app
