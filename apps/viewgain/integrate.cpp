// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include "viewgain/grid/integrate.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "commands.hpp"
#include "frames_dir.hpp"
#include "sensing.hpp"
#include "terminal.hpp"
#include "values.hpp"
#include "viewgain/core/atomic_file.hpp"
#include "viewgain/core/error.hpp"
#include "viewgain/core/jump_edge_filter.hpp"
#include "viewgain/grid/belief_grid.hpp"
#include "viewgain/grid/vdb_io.hpp"

namespace viewgain::app {
namespace {

struct Options {
  CommonOptions common;
  std::string frames;
  std::optional<double> voxel;
  std::string workspace;
  std::string sensor;
  std::optional<double> depth_scale;
  std::string out_of_range = "carve";
  std::string carve = "cones";
  std::string occupancy = "probabilistic";
  std::string jump_edge_filter = "off";
  bool jump_edge_two_sided = false;
  std::optional<double> support_plane;
  std::optional<double> prior_sigma;
  bool with_covariance = false;
  std::string out;
  std::string map;

  [[nodiscard]] OutOfRangeMeaning meaning() const {
    return out_of_range == "carve" ? OutOfRangeMeaning::carve : OutOfRangeMeaning::invalid;
  }
};

void check_voxel(double voxel) {
  if (!(voxel > 0) || !std::isfinite(voxel)) {
    throw Error(ErrorCode::invalid_argument,
                "--voxel " + short_text(voxel) + ": the voxel size must be positive and finite");
  }
}

std::optional<JumpEdgeFilter> make_filter(const FrameSequence& frames, const Options& options) {
  const auto config = parse_jump_edge_filter(options.jump_edge_filter, options.jump_edge_two_sided);
  if (!config) return std::nullopt;
  return JumpEdgeFilter(frames.sensor.camera, *config);
}

// What the frames see, half a voxel more on each side: a reading on the face of the box would lie
// outside of it.
Box seen_workspace(const FrameSequence& frames, const std::optional<JumpEdgeFilter>& filter,
                   const Options& options, double voxel) {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  Box seen{{kInfinity, kInfinity, kInfinity}, {-kInfinity, -kInfinity, -kInfinity}};
  bool any = false;
  Progress progress("bounds of frame");
  for (std::size_t i = 0; i < frames.images.size(); ++i) {
    DepthFrame frame = load_frame(frames, i, options.meaning());
    if (filter) filter->apply(frame);
    const auto bounds =
        reading_bounds(frames.sensor, frame, frames.poses[i], {}, options.support_plane);
    progress.update(i + 1, frames.images.size());
    if (!bounds) continue;
    any = true;
    for (std::size_t k = 0; k < 3; ++k) {
      seen.min[k] = std::min(seen.min[k], bounds->min[k] - voxel / 2);
      seen.max[k] = std::max(seen.max[k], bounds->max[k] + voxel / 2);
    }
  }
  if (!any) {
    throw Error(ErrorCode::invalid_argument,
                options.frames + ": no frame has a reading, so --workspace is needed");
  }
  return seen;
}

BeliefGrid new_map(const FrameSequence& frames, const std::optional<JumpEdgeFilter>& filter,
                   const Options& options) {
  if (!options.voxel) {
    throw Error(ErrorCode::invalid_argument, "--voxel is needed unless --map is given");
  }
  check_voxel(*options.voxel);
  GridConfig config;
  config.voxel_size = *options.voxel;
  config.prior_sigma =
      options.prior_sigma.value_or(default_prior_sigma(config.voxel_size, frames.sensor));
  config.workspace = options.workspace.empty()
                         ? seen_workspace(frames, filter, options, config.voxel_size)
                         : parse_box("--workspace", options.workspace);
  return BeliefGrid(config);
}

// An existing map keeps its layout and prior; flags that say something else are an error.
BeliefGrid continued_map(const Options& options) {
  BeliefGrid grid = load_vdb(options.map);
  const auto conflict = [&options](const std::string& flag, const std::string& given,
                                   const std::string& stored) {
    throw Error(ErrorCode::invalid_argument,
                flag + " " + given + " conflicts with " + options.map + ", which has " + stored);
  };
  if (options.voxel && *options.voxel != grid.voxel_size()) {
    check_voxel(*options.voxel);
    conflict("--voxel", short_text(*options.voxel), short_text(grid.voxel_size()));
  }
  if (options.prior_sigma && *options.prior_sigma != grid.prior_sigma()) {
    conflict("--prior-sigma", short_text(*options.prior_sigma), short_text(grid.prior_sigma()));
  }
  if (!options.workspace.empty()) {
    const BeliefGrid asked({grid.voxel_size(), parse_box("--workspace", options.workspace),
                            grid.T_world_grid(), grid.prior_sigma()});
    if (asked.min_index() != grid.min_index() || asked.dims() != grid.dims()) {
      conflict("--workspace", options.workspace, describe(grid.workspace()));
    }
  }
  return grid;
}

double median(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  const std::size_t n = values.size();
  return n % 2 == 1 ? values[n / 2] : 0.5 * (values[n / 2 - 1] + values[n / 2]);
}

struct Totals {
  IntegrationReport sum;
  std::uint64_t jump_edge_removed = 0;
  std::vector<double> seconds;  // of each frame's integration, reading the image not counted
};

Totals integrate_frames(const FrameSequence& frames, const std::optional<JumpEdgeFilter>& filter,
                        const Options& options, BeliefGrid& grid) {
  IntegrationConfig config;
  config.carve = options.carve == "cones" ? Carve::cones : Carve::lines;
  config.occupancy =
      options.occupancy == "probabilistic" ? Occupancy::probabilistic : Occupancy::literal;
  config.support_plane = options.support_plane;
  FrameIntegrator integrator(frames.sensor, config, {options.common.threads});
  Totals totals;
  Progress progress("frame");
  for (std::size_t i = 0; i < frames.images.size(); ++i) {
    DepthFrame frame = load_frame(frames, i, options.meaning());
    if (filter) totals.jump_edge_removed += filter->apply(frame);
    const Stopwatch watch;
    const IntegrationReport report = integrator.integrate(grid, frame, frames.poses[i]);
    totals.seconds.push_back(watch.seconds());
    totals.sum.readings += report.readings;
    totals.sum.readings_inside += report.readings_inside;
    totals.sum.plane_readings += report.plane_readings;
    totals.sum.out_of_range += report.out_of_range;
    totals.sum.invalid += report.invalid;
    progress.update(i + 1, frames.images.size());
  }
  return totals;
}

void print_summary(const Options& options, const FrameSequence& frames, const BeliefGrid& grid,
                   const Totals& totals, double seconds) {
  const GridStatistics statistics = grid.statistics();
  const Index3 dims = grid.dims();
  const double frame_seconds = median(totals.seconds);
  if (options.common.json) {
    print_json({{"frames", frames.images.size()},
                {"views", grid.views().size()},
                {"readings", totals.sum.readings},
                {"readings_inside", totals.sum.readings_inside},
                {"plane_readings", totals.sum.plane_readings},
                {"jump_edge_removed", totals.jump_edge_removed},
                {"out_of_range", totals.sum.out_of_range},
                {"invalid", totals.sum.invalid},
                {"orthonormalized_poses", frames.orthonormalized},
                {"sensor", frames.sensor.name},
                {"depth_scale", frames.depth_scale},
                {"voxel_size", grid.voxel_size()},
                {"workspace", to_json(grid.workspace())},
                {"dims", {dims.x, dims.y, dims.z}},
                {"prior_sigma", grid.prior_sigma()},
                {"unknown", statistics.unknown},
                {"free", statistics.free},
                {"occupied", statistics.occupied},
                {"hash", grid.content_hash()},
                {"out", options.out},
                {"seconds", seconds},
                {"seconds_per_frame", frame_seconds}});
    return;
  }
  std::printf("workspace %s m: %d x %d x %d voxels of %g m, prior sigma %g m\n",
              describe(grid.workspace()).c_str(), dims.x, dims.y, dims.z, grid.voxel_size(),
              grid.prior_sigma());
  std::printf(
      "%zu frames (%s), %s readings, %s of them in the workspace; %s out of range, %s invalid\n",
      frames.images.size(), frames.sensor.name.c_str(), with_commas(totals.sum.readings).c_str(),
      with_commas(totals.sum.readings_inside).c_str(), with_commas(totals.sum.out_of_range).c_str(),
      with_commas(totals.sum.invalid).c_str());
  if (options.jump_edge_filter != "off") {
    std::printf("flying pixels removed: %s\n", with_commas(totals.jump_edge_removed).c_str());
  }
  if (options.support_plane) {
    std::printf("readings of the support plane: %s\n",
                with_commas(totals.sum.plane_readings).c_str());
  }
  if (frames.orthonormalized > 0) {
    std::printf("rotations that were off and were orthonormalised: %zu of %zu\n",
                frames.orthonormalized, frames.poses.size());
  }
  const double voxels = static_cast<double>(grid.voxel_count());
  std::printf("voxels: %s unknown (%.1f %%), %s free, %s occupied\n",
              with_commas(statistics.unknown).c_str(),
              100 * static_cast<double>(statistics.unknown) / voxels,
              with_commas(statistics.free).c_str(), with_commas(statistics.occupied).c_str());
  std::printf("%.2f s in all; into the map: %.1f ms a frame (median)\n", seconds,
              1e3 * frame_seconds);
  std::printf("%s: hash %s\n", options.out.c_str(), grid.content_hash().c_str());
}

void integrate(const Options& options) {
  const Stopwatch watch;
  const FrameSequence frames = open_frames(options.frames, options.sensor, options.depth_scale);
  {
    const AtomicFile writable(options.out);
  }  // known now rather than after the work
  const std::optional<JumpEdgeFilter> filter = make_filter(frames, options);
  BeliefGrid grid = options.map.empty() ? new_map(frames, filter, options) : continued_map(options);
  const Totals totals = integrate_frames(frames, filter, options, grid);
  save_vdb(grid, options.out, {options.with_covariance});
  print_summary(options, frames, grid, totals, watch.seconds());
}

}  // namespace

Command add_integrate(CLI::App& program) {
  auto options = std::make_shared<Options>();
  CLI::App* app = program.add_subcommand(
      "integrate",
      "Depth frames into a voxel map. FRAMES_DIR holds what simulate writes, or recorded frames: "
      "frame-NNNNNN.depth.png + frame-NNNNNN.pose.txt (4x4, camera to world, m) + "
      "camera-intrinsics.txt (3x3, overrides the sensor's). Incidence comes from "
      "frame-NNNNNN.amplitude.png (16 bit, cos/range^2 in 1e-3 m^-2) where there is one.");
  app->add_option("FRAMES_DIR", options->frames, "folder of frames")->required();
  app->add_option("--voxel", options->voxel, "voxel size [m]; needed unless --map is given");
  app->add_option("--workspace", options->workspace,
                  "x0,y0,z0,x1,y1,z1 [m], grown to whole voxels; default: what the frames see");
  app->add_option("--sensor", options->sensor,
                  std::string(kSensorHelp) + "; default: FRAMES_DIR/sensor.toml");
  app->add_option(
      "--depth-scale", options->depth_scale,
      "metres a unit of the images; default: 1e-4 where there is a sensor.toml, else 1e-3");
  app->add_option(
         "--out-of-range", options->out_of_range,
         "what 65535 says: carve (nothing up to the maximal range) or invalid (no reading)")
      ->check(CLI::IsMember({"carve", "invalid"}))
      ->capture_default_str();
  app->add_option("--carve", options->carve,
                  "voxels that a pixel crosses: those in its pyramid, or on its ray")
      ->check(CLI::IsMember({"cones", "lines"}))
      ->capture_default_str();
  app->add_option("--occupancy", options->occupancy, "log-odds, or the paper's literal rule")
      ->check(CLI::IsMember({"probabilistic", "literal"}))
      ->capture_default_str();
  app->add_option("--jump-edge-filter", options->jump_edge_filter,
                  "ANGLE_DEG: a reading goes when the edge to a nearer neighbour is within 1..10 "
                  "degrees of its ray (5 is a good value); or off")
      ->capture_default_str();
  app->add_flag("--jump-edge-two-sided", options->jump_edge_two_sided,
                "the filter looks at farther neighbours too");
  app->add_option("--support-plane", options->support_plane,
                  "height z of the table [m]: its readings carve but do not hit; default: none");
  app->add_option("--prior-sigma", options->prior_sigma,
                  "sigma of an unknown voxel [m]; default: max(voxel/2, twice the sensor's axial "
                  "sigma at its working distance)");
  app->add_flag("--with-covariance", options->with_covariance,
                "add covariances and positions to the file, for viewers");
  app->add_option("--out", options->out, "map to write (.vdb)")->required();
  app->add_option("--map", options->map,
                  "map to continue; its voxel size, workspace and prior hold");
  add_common_options(*app, options->common);
  return {app, [options] { integrate(*options); }};
}

}  // namespace viewgain::app
