// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "program/commands/reconstruct/run_options.hpp"

#include <algorithm>

#include "program/cli/flags/gain_names.hpp"
#include "program/cli/flags/scene_sources.hpp"
#include "program/cli/values.hpp"
#include "viewgain/literature/classic_gains.hpp"
#include "viewgain/planner_mesh/policies.hpp"

namespace viewgain::app {
namespace {

constexpr std::size_t kMaxCount = 1'000'000;

}  // namespace

void add_output_options(App& app, RunOutputs& outputs) {
  add_switch(app, "--save-maps", outputs.save_maps, "keep maps/NN.vdb after each view");
  add_switch(app, "--pictures", outputs.pictures, "draw views/NN.png");
  add_switch(app, "--report", outputs.report,
             "write report.html: the run to look at in a browser, in one file");
  app.add_option("--beside", outputs.beside,
                 "folder of another run, whose curves are drawn over this one's; with a report");
  app.add_flag("--resume", outputs.resume,
               "go on where the same call was ended, if it was: by a kill, a signal, a full disk");
  app.add_option("--out", outputs.out, "folder to write")->required();
}

void add_options(App& app, ReconstructOptions& o) {
  o.sensing.noise = "on";
  app.add_option("MESH", o.mesh, "OFF, OBJ, STL or PLY, centred")->required();
  app.add_option("--sensor", o.sensor, kSensorHelp.c_str())->required();
  app.add_option("--voxel", o.voxel, "voxel size [m]")->required();
  app.add_option("--size", o.size,
                 "scale the object so that its longest side is this [m]; default: the file's own "
                 "size, in metres");
  app.add_option(
      "--workspace", o.workspace,
      "x0,y0,z0,x1,y1,z1 [m]; default: a cube of the longest side * 0.4/0.35 around the object");
  app.add_option("--up", o.up, "axis of the mesh file that points up")
      ->check(one_of({"x", "y", "z"}, "axis"));
  app.add_option("--start", o.start,
                 "first camera pose tx,ty,tz,qx,qy,qz,qw [m]; default: 27 deg "
                 "above the object at an azimuth that depends on the seed");
  app.add_option("--distance", o.distance,
                 "of the start and of poses round the object from its centre [m]; default: the "
                 "object fills the view, at least the sensor's working distance, and a shell fills "
                 "the shells or boxes of --reach");
  app.add_option("--policy", o.policy,
                 "gain, kriegel (left, right, top, bottom), sequence (turntable of 8, then top), "
                 "random, frontier (most unknown voxels in view), fibonacci (evenly round the "
                 "object), oracle (knows the mesh: an upper reference)")
      ->check(one_of(policy_names(), "policy"));
  app.add_option("--generator", o.generator,
                 "where candidates come from: boundary, sphere, dome, rings, shell, sequence, or "
                 "several with commas; default: boundary (random and fibonacci: sphere, sequence: "
                 "sequence)")
      ->check(several_of(generator_names(), "generator"));
  app.add_option("--poses", o.poses,
                 "TUM or .npy file of poses of your own that --policy sequence takes after the "
                 "start, in their order; default: the turntable");
  app.add_option("--count", o.count,
                 "poses of the sphere, dome or shell (default 500; sphere of --policy fibonacci: "
                 "--max-views); rings: 48, 80, 288 or 864 (default 48)")
      ->check(counted(1, kMaxCount));
  app.add_option(
         "--gain", o.gain,
         "of --policy gain: paper (entropy removed), surface (new surface to be expected) or "
         "combined (default); or a gain of the literature")
      ->check(one_of(all_gain_names(), "gain"));
  app.add_option("--overlap", o.overlap, kOverlapHelp);
  app.add_option("--region-depth", o.region_depth, kRegionDepthHelp);
  app.add_option("--object-size", o.object_size, kObjectSizeHelp);
  app.add_option("--hazard", o.hazard, kHazardHelp);
  app.add_option(
         "--criterion", o.criterion,
         "of the map's entropy and the paper's gain: log_diagonal, log_determinant [nat] or trace "
         "[m^2], which the combined gain does not go with")
      ->check(one_of(criterion_names(), "criterion"));
  app.add_option("--max-views", o.max_views, "view budget")->check(counted(1, kMaxCount));
  app.add_option("--stop-gain", o.stop_gain,
                 "of the paper's gain: stop when the best view gains less per touched voxel [nat, "
                 "m^2]; default: 1.2 (trace: 0.01 of the first view's)");
  app.add_option(
      "--stop-area", o.stop_area,
      "of --gain surface and combined: stop when the best candidate promises less than this "
      "share of the surface so far as new surface, on the mean of three decisions; 0: never; "
      "default: 0.004");
  app.add_option("--stop-idle", o.stop_idle,
                 "stop after so many views in a row that change entropy and unknown voxels by "
                 "less than 0.1 %; 0: never")
      ->check(counted(0, kMaxCount));
  app.add_option("--stop-promises", o.stop_promises, kStopPromisesHelp)
      ->check(counted(0, kMaxCount));
  app.add_option("--stop-coverage", o.stop_coverage,
                 "stop at this coverage of the visible surface, 0..1");
  app.add_option(
      "--tolerance", o.tolerance,
      "a point of the mesh counts as covered where the surface is within this of it [m]; default: "
      "0.005, or a voxel where that is larger");
  app.add_option("--cost-per-metre", o.cost_per_metre,
                 "rank by gain - L * distance [nat/m, surface: m^2/m]");
  add_plan_options(app, o.plan);
  app.add_option("--reach", o.reach, "TOML file: boxes, shells, half-spaces, poses in reach");
  app.add_option("--obstacle", o.obstacles,
                 std::string(kObstacleHelp) + "; the object's box has its centre at the origin")
      ->allow_extra_args(false);
  app.add_option("--body", o.body, kBodyHelp);
  add_sensing_options(app, o.sensing);
  add_switch(app, "--register", o.registration.is_on,
             "align the frames with one another and make the map from the poses that come of it");
  app.add_option(
      "--pose-sigma", o.registration.pose_sigma,
      "SIGMA_M,SIGMA_DEG by which reported poses may be off, of --register; default: those "
      "of --pose-noise, else 0.005,0.5");
  app.add_option("--frames-per-view", o.frames_per_view, "frames from each pose")
      ->check(counted(1, 1000));
  app.add_option("--jump-edge-filter", o.jump_edge_filter, kJumpEdgeHelp);
  add_switch(app, "--refine", o.refine, "readings of a voxel refine it; off: the first one wins");
  add_scale_options(app, o.scales);
  add_output_options(app, o.outputs);
  add_trace_option(app, o.common);
  add_common_options(app, o.common);
  add_help(app, kLoopGroup,
           "reconstruct mesh.off --size 0.35 --sensor sr4000 --voxel 0.005 --max-views 4 "
           "--pictures off --out run");
}

void check(const ReconstructOptions& options) {
  check_positive("--voxel", options.voxel);
  if (options.size) check_positive("--size", *options.size);
  if (!options.gain.empty() && parse_policy(options.policy) != Policy::gain) {
    refuse("--gain " + options.gain + " goes with --policy gain, not " + options.policy);
  }
  if (!options.poses.empty() &&
      (parse_policy(options.policy) != Policy::sequence || !options.generator.empty())) {
    refuse("--poses goes with --policy sequence, without --generator");
  }
  const std::vector<std::string>& classic = classic_gain_names();
  const bool is_classic = std::find(classic.begin(), classic.end(), options.gain) != classic.end();
  if (options.tolerance) check_positive("--tolerance", *options.tolerance);
  check_at_least_0("--cost-per-metre", options.cost_per_metre);
  check(options.plan);
  if (options.plan.plan > 1 && (parse_policy(options.policy) != Policy::gain || is_classic)) {
    refuse("--plan goes with --policy gain by the gains paper, surface and combined");
  }
  if (options.distance) check_positive("--distance", *options.distance);
  if (options.sensing.support_plane) {
    check_finite("--support-plane", *options.sensing.support_plane);
  }
  check_inside_0_1("--overlap", options.overlap);
  check_positive("--region-depth", options.region_depth);
  if (options.stop_coverage && !(*options.stop_coverage >= 0 && *options.stop_coverage <= 1)) {
    refuse("--stop-coverage " + short_text(*options.stop_coverage) + " must be in 0..1");
  }
}

}  // namespace viewgain::app
