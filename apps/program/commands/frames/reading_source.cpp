// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include "program/commands/frames/reading_source.hpp"

#include <Eigen/Core>

#include "program/cli/flags/scene_sources.hpp"
#include "program/cli/progress.hpp"
#include "program/cli/values.hpp"
#include "program/commands/frames/frame_map.hpp"
#include "viewgain/core/error.hpp"
#include "viewgain/core/pose.hpp"
#include "viewgain/formats/cloud_io.hpp"
#include "viewgain/formats/pose_files.hpp"
#include "viewgain/formats/sensor_toml.hpp"
#include "viewgain/planner/align_frames.hpp"

namespace viewgain::app {
namespace {

// Settings of the map. No view is scored.
ScorerConfig rules_of(const IntegrateOptions& options) {
  ScorerConfig config;
  options.scales.set(config);
  config.support_plane = options.support_plane;
  config.learn_hazard = options.calibrates_hazard();
  config.measure_new_area = false;
  config.gain.model = GainModel::paper;
  return config;
}

ScorerConfig map_config(const IntegrateOptions& options) {
  ScorerConfig config = rules_of(options);
  config.jump_edges = parse_jump_edge_filter(options.jump_edge_filter);
  config.obstacles = obstacles_of(options.obstacles);
  return config;
}

class FrameSource : public ReadingSource {
 public:
  explicit FrameSource(const IntegrateOptions& options)
      : folder_(options.frames), config_(map_config(options)), exec_{options.common.threads} {
    reported_sigma_ = registration_sigma(options.registration);
    if (reported_sigma_) registration_.emplace(folder_.sensor(), config_, exec_);
  }

  [[nodiscard]] const Sensor& sensor() const override { return folder_.sensor(); }
  [[nodiscard]] std::size_t size() const override { return folder_.size(); }
  [[nodiscard]] std::size_t orthonormalized() const override {
    return folder_.frames().orthonormalized;
  }

  [[nodiscard]] std::string identity(std::size_t index, FrameFault& fault) const override {
    try {
      return frame_identity(folder_.frames(), index);
    } catch (const Error& error) {
      fault = {FrameVerdict::unreadable, error.what()};
      return {};
    }
  }

  FrameFault load(std::size_t index) override {
    loaded_ = folder_.load(index);
    T_world_camera_ = folder_.T_world_camera(index);
    pose_sigma_ = {};
    return loaded_.fault;
  }
  [[nodiscard]] std::filesystem::path file(std::size_t index) const override {
    return folder_.frames().images[index];
  }
  [[nodiscard]] Box seen_workspace(double voxel, bool quiet) override {
    return app::seen_workspace(folder_, config_, voxel, quiet, exec_);
  }
  void start(BeliefGrid grid) override {
    map_.emplace(std::move(grid), folder_.sensor(), config_, exec_);
  }
  [[nodiscard]] const BeliefGrid& grid() const override { return map_->grid(); }
  std::optional<FrameRegistration> register_loaded() override {
    if (!registration_) return std::nullopt;
    FrameRegistration result =
        registration_->register_frame(grid(), loaded_.frame, T_world_camera_, *reported_sigma_);
    T_world_camera_ = result.T_world_camera;
    pose_sigma_ = result.pose_sigma();
    return result;
  }
  MapUpdate integrate() override {
    Measurements measurements{T_world_camera_, {}, pose_sigma_};
    measurements.frames.push_back(std::move(loaded_.frame));
    return map_->add(measurements);
  }
  [[nodiscard]] std::optional<FrameConsistency> consistency() const override {
    return map_->consistency();
  }
  [[nodiscard]] std::uint64_t masked_pixels() const override { return loaded_.masked_pixels; }
  [[nodiscard]] const FrameFolder* folder() const override { return &folder_; }

 private:
  FrameFolder folder_;
  ScorerConfig config_;
  ExecConfig exec_;
  std::optional<PoseSigma> reported_sigma_;  // set if frames are registered
  std::optional<FrameAlignment> registration_;
  std::optional<ViewScorer> map_;  // set after start()
  FrameReading loaded_;
  Pose T_world_camera_;
  PoseSigma pose_sigma_;  // uncertainty of the loaded pose
};

Sensor sensor_of(const IntegrateOptions& options) {
  if (options.frames.sensor.empty()) refuse("--cloud requires --sensor");
  return load_sensor(options.frames.sensor);
}

class CloudSource : public ReadingSource {
 public:
  explicit CloudSource(const IntegrateOptions& options)
      : files_(options.clouds),
        sensor_(sensor_of(options)),
        support_plane_(options.support_plane),
        integrator_(sensor_, rules_of(options).integration(), {options.common.threads}) {
    if (options.poses.empty()) {
      if (options.origin == "viewpoint") return;
      const std::vector<double> at = parse_numbers("--origin", options.origin, 3, 3);
      origin_.emplace(at[0], at[1], at[2]);
      return;
    }
    poses_ = load_poses(options.poses);
    if (poses_.poses.size() != files_.size()) {
      refuse(options.poses + ": the file must have one pose per cloud; clouds: " +
             std::to_string(files_.size()) + ", poses: " + std::to_string(poses_.poses.size()));
    }
  }

  [[nodiscard]] const Sensor& sensor() const override { return sensor_; }
  [[nodiscard]] std::size_t size() const override { return files_.size(); }
  [[nodiscard]] std::size_t orthonormalized() const override { return poses_.orthonormalized; }

  [[nodiscard]] std::filesystem::path file(std::size_t index) const override {
    return files_[index];
  }
  FrameFault load(std::size_t index) override {
    cloud_ = load_cloud(files_[index]);
    if (!poses_.poses.empty()) {
      T_world_sensor_ = poses_.poses[index];
      for (auto& point : cloud_.points) {
        const Eigen::Vector3d p = T_world_sensor_ * Eigen::Vector3d(point[0], point[1], point[2]);
        point = {p.x(), p.y(), p.z()};
      }
    } else if (origin_) {
      T_world_sensor_ = looking_at_points(*origin_);
    } else if (cloud_.viewpoint) {
      T_world_sensor_ = *cloud_.viewpoint;
    } else {
      refuse(files_[index] + ": the file has no VIEWPOINT; give --origin or --poses");
    }
    return {};
  }
  [[nodiscard]] Box seen_workspace(double voxel, bool quiet) override {
    Progress progress("bounds of cloud", quiet);
    const auto seen = workspace_around(files_.size(), voxel, [&](std::size_t i) {
      (void)load(i);
      progress.update(i + 1, files_.size());
      return reading_bounds(sensor_, cloud_.points, T_world_sensor_, {}, support_plane_);
    });
    if (!seen) refuse("no cloud has a point in the sensor's range");
    return *seen;
  }
  void start(BeliefGrid grid) override { grid_.emplace(std::move(grid)); }
  [[nodiscard]] const BeliefGrid& grid() const override { return *grid_; }
  MapUpdate integrate() override {
    MapUpdate update;
    update.counts = integrator_.integrate(*grid_, cloud_.points, T_world_sensor_);
    if (update.counts.readings_inside == 0) update.verdict = FrameVerdict::carved;
    return update;
  }

 private:
  // For points in the world only the sensor's position is known. The pose looks at their centre, so
  // that the map has a useful view; the integration does not depend on it.
  [[nodiscard]] Pose looking_at_points(const Eigen::Vector3d& origin) const {
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    double count = 0;
    for (const auto& point : cloud_.points) {
      const Eigen::Vector3d p(point[0], point[1], point[2]);
      if (p.allFinite()) sum += p, ++count;
    }
    const bool has_direction = count > 0 && sum / count != origin && origin.allFinite();
    return has_direction ? look_at(origin, sum / count) : Pose(Eigen::Matrix3d::Identity(), origin);
  }

  std::vector<std::string> files_;
  Sensor sensor_;
  std::optional<double> support_plane_;
  CloudIntegrator integrator_;
  std::optional<BeliefGrid> grid_;         // set after start()
  PoseList poses_;                         // empty if the points are in the world frame
  std::optional<Eigen::Vector3d> origin_;  // of all clouds; empty if each has its own
  PointCloud cloud_;                       // world frame
  Pose T_world_sensor_;
};

}  // namespace

std::unique_ptr<ReadingSource> open_reading_source(const IntegrateOptions& options) {
  if (options.clouds.empty()) return std::make_unique<FrameSource>(options);
  return std::make_unique<CloudSource>(options);
}

}  // namespace viewgain::app
