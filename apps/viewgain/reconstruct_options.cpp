// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "reconstruct_options.hpp"

#include <cmath>

#include "formats/sensor_toml.hpp"
#include "formats/values.hpp"
#include "sensing_flags.hpp"
#include "viewgain/core/error.hpp"

namespace viewgain::app {
namespace {

constexpr std::size_t kMaxCount = 1'000'000;

}  // namespace

void add_options(CLI::App& app, ReconstructOptions& o) {
  const CLI::Range count(std::size_t{1}, kMaxCount, "count");
  o.sensing.noise = "on";
  app.add_option("MESH", o.mesh, "OFF, OBJ, STL or PLY; scaled and centred")->required();
  app.add_option("--sensor", o.sensor, kSensorHelp)->required();
  app.add_option("--voxel", o.voxel, "voxel size [m]")->required();
  app.add_option("--size", o.size, "longest side of the object [m]")->capture_default_str();
  app.add_option("--workspace", o.workspace,
                 "x0,y0,z0,x1,y1,z1 [m]; default: a cube of size * 0.4/0.35 around the object");
  app.add_option("--up", o.up, "axis of the mesh file that points up")
      ->check(CLI::IsMember({"x", "y", "z"}))
      ->capture_default_str();
  app.add_option("--start", o.start,
                 "first camera pose tx,ty,tz,qx,qy,qz,qw [m]; default: 27 deg "
                 "above the object at an azimuth that depends on the seed");
  app.add_option("--distance", o.distance,
                 "of the start and of poses round the object from its centre [m]; default: the "
                 "object fills the view, at least the sensor's working distance");
  app.add_option("--policy", o.policy,
                 "gain, kriegel (left, right, top, bottom), sequence (turntable of 8, then top), "
                 "random, frontier (most unknown voxels in view)")
      ->capture_default_str();
  app.add_option("--generator", o.generator,
                 "where candidates come from: boundary, sphere, dome, rings, shell, sequence, or "
                 "several with commas; default: boundary (random: sphere, sequence: sequence)");
  app.add_option("--sphere-poses", o.sphere_poses,
                 "poses of the sphere, dome or shell (default 500); rings: 48, 80, 288 or 864 "
                 "(default 48)")
      ->check(count);
  app.add_option("--criterion", o.criterion, "log_diagonal, log_determinant [nat] or trace [m^2]")
      ->capture_default_str();
  app.add_option("--max-views", o.max_views, "view budget")->check(count)->capture_default_str();
  app.add_option("--stop-gain", o.stop_gain,
                 "stop when the best view gains less per touched voxel [nat, m^2]; default: 1.2 "
                 "(trace: 0.01 of the first view's)");
  app.add_option("--stop-idle", o.stop_idle,
                 "stop after so many views in a row that change entropy and unknown voxels by "
                 "less than 0.1 %; 0: never")
      ->check(CLI::Range(std::size_t{0}, kMaxCount, "count"))
      ->capture_default_str();
  app.add_option("--stop-coverage", o.stop_coverage,
                 "stop at this coverage of the visible surface, 0..1");
  app.add_option("--travel-cost", o.travel_cost, "rank by gain - L * distance [nat/m]")
      ->capture_default_str();
  app.add_option("--travel-speed", o.travel_speed,
                 "rank by gain / (1 s + distance / speed) instead [m/s]");
  app.add_option("--reach", o.reach, "TOML file: boxes, shells, half-spaces, poses in reach");
  add_sensing_options(app, o.sensing);
  app.add_option("--frames-per-view", o.frames_per_view, "frames from each pose")
      ->check(CLI::Range(std::size_t{1}, std::size_t{1000}, "count"))
      ->capture_default_str();
  app.add_option("--jump-edge-filter", o.jump_edge_filter, "angle of the filter [deg], or off")
      ->capture_default_str();
  app.add_flag("--no-refine", o.no_refine, "the first reading of a voxel wins");
  app.add_flag("--save-maps", o.save_maps, "keep maps/NN.vdb after each view");
  app.add_flag("--no-pictures", o.no_pictures, "do not draw views/NN.png");
  app.add_option("--out", o.out, "folder to write")->required();
  add_common_options(app, o.common);
}

void check(const ReconstructOptions& options) {
  if (!(options.voxel > 0) || !std::isfinite(options.voxel)) {
    throw Error(ErrorCode::invalid_argument,
                "--voxel " + short_text(options.voxel) + " must be positive and finite");
  }
  if (options.travel_cost > 0 && options.travel_speed) {
    throw Error(ErrorCode::invalid_argument,
                "--travel-cost and --travel-speed are two rankings; give one");
  }
  if (options.stop_gain && !(*options.stop_gain >= 0 && std::isfinite(*options.stop_gain))) {
    throw Error(ErrorCode::invalid_argument,
                "--stop-gain " + short_text(*options.stop_gain) + " must be at least 0 and finite");
  }
  const double travel[] = {options.travel_cost, options.travel_speed.value_or(1.0)};
  if (!(travel[0] >= 0 && std::isfinite(travel[0]) && travel[1] > 0 && std::isfinite(travel[1]))) {
    throw Error(ErrorCode::invalid_argument,
                "--travel-cost must be at least 0 and --travel-speed positive, both finite");
  }
  if (options.distance && !(*options.distance > 0 && std::isfinite(*options.distance))) {
    throw Error(ErrorCode::invalid_argument,
                "--distance " + short_text(*options.distance) + " must be positive and finite");
  }
  if (options.sensing.support_plane && !std::isfinite(*options.sensing.support_plane)) {
    throw Error(ErrorCode::invalid_argument, "--support-plane must be finite");
  }
  if (options.stop_coverage && !(*options.stop_coverage >= 0 && *options.stop_coverage <= 1)) {
    throw Error(ErrorCode::invalid_argument,
                "--stop-coverage " + short_text(*options.stop_coverage) + " must be in 0..1");
  }
  if (options.frames_per_view < 1) {
    throw Error(ErrorCode::invalid_argument, "--frames-per-view must be at least 1");
  }
}

}  // namespace viewgain::app
