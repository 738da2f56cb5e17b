// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "program/commands/reconstruct/run_options.hpp"

#include <algorithm>

#include "program/cli/flags/gain_names.hpp"
#include "program/cli/flags/scene_sources.hpp"
#include "program/cli/flags/stop_rules.hpp"
#include "program/cli/help.hpp"
#include "program/cli/values.hpp"
#include "viewgain/planner_mesh/policies.hpp"

namespace viewgain::app {
namespace {

constexpr std::size_t kMaxCount = 1'000'000;

}  // namespace

void add_output_options(App& app, RunOutputs& outputs) {
  begin_group(app, "Output");
  add_switch(app, "--save-maps", outputs.save_maps,
             "keep maps/NN.vdb after each view; reconstruct also the candidates for the next one, "
             "maps/NN.txt");
  add_switch(app, "--pictures", outputs.pictures, "draw views/NN.png");
  app.add_option("--report", outputs.report,
                 "off; on: write report.html (one file, for a browser); or the folder of another "
                 "run, to overlay its curves");
  app.add_flag("--resume", outputs.resume,
               "resume this call if it was interrupted (kill, signal, full disk)");
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
  begin_group(app, "Views");
  app.add_option("--from", o.from,
                 "tx,ty,tz,qx,qy,qz,qw of the camera in the world [m], where the run begins; "
                 "default: 27 deg above the object at an azimuth that depends on the seed");
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
  app.add_option("--hazard", o.hazard, kHazardHelp);
  begin_group(app, "Gain");
  app.add_option(
         "--criterion", o.criterion,
         "of the map's entropy and the paper's gain: log_diagonal, log_determinant [nat] or trace "
         "[m^2], which the combined gain does not go with")
      ->check(one_of(criterion_names(), "criterion"));
  begin_group(app, "When to stop");
  app.add_option("--max-views", o.max_views, "view budget")->check(counted(1, kMaxCount));
  add_stop_option(app, o.stop);
  app.add_option(
      "--tolerance", o.tolerance,
      "a point of the mesh counts as covered where the surface is within this of it [m]; default: "
      "0.005, or a voxel where that is larger");
  begin_group(app, "Views");
  app.add_option("--cost-per-metre", o.cost_per_metre,
                 "rank by gain - L * distance [nat/m, surface: m^2/m]");
  add_plan_option(app, o.plan);
  begin_group(app, "What is in the way");
  app.add_option("--reach", o.reach, "TOML file: boxes, shells, half-spaces, poses in reach");
  app.add_option("--obstacle", o.obstacles,
                 std::string(kObstacleHelp) + "; the object's box has its centre at the origin")
      ->allow_extra_args(false);
  app.add_option("--body", o.body, kBodyHelp);
  add_sensing_options(app, o.sensing);
  add_registration_option(app, o.registration);
  begin_group(app, "Map");
  app.add_option("--frames-per-view", o.frames_per_view, "frames from each pose")
      ->check(counted(1, 1000));
  app.add_option("--jump-edge-filter", o.jump_edge_filter, kJumpEdgeHelp);
  add_scale_options(app, o.scales);
  add_output_options(app, o.outputs);
  most_need(app, {"--sensor", "--voxel", "--size", "--up", "--out", "--max-views", "--policy",
                  "--gain", "--report"});
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
  if (options.tolerance) check_positive("--tolerance", *options.tolerance);
  check_at_least_0("--cost-per-metre", options.cost_per_metre);
  if (parse_plan(options.plan).is_on() &&
      (parse_policy(options.policy) != Policy::gain || is_registered_gain(options.gain))) {
    refuse("--plan goes with --policy gain by the gains paper, surface and combined");
  }
  if (options.distance) check_positive("--distance", *options.distance);
  if (options.sensing.support_plane) {
    check_finite("--support-plane", *options.sensing.support_plane);
  }
  (void)stop_limits(options.stop);
}

}  // namespace viewgain::app
