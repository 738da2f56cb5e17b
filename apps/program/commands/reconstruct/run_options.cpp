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
  add_switch(
      app, "--save-maps", outputs.save_maps,
      "write maps/NN.vdb after each view; reconstruct also writes the candidates maps/NN.txt");
  add_switch(app, "--pictures", outputs.pictures, "draw each view as views/NN.png");
  app.add_option(
      "--report", outputs.report,
      "on: write report.html; RUN: also show the curves of the run in folder RUN; off: no report");
  app.add_flag("--resume", outputs.resume, "continue this call after an interruption");
  app.add_option("--out", outputs.out, "folder to write")->required();
}

void add_options(App& app, ReconstructOptions& o) {
  o.sensing.noise = "on";
  app.add_option("MESH", o.mesh, "OFF, OBJ, STL or PLY file; the mesh is centred at the origin")
      ->required();
  app.add_option("--sensor", o.sensor, kSensorHelp.c_str())->required();
  app.add_option("--voxel", o.voxel, "voxel size [m]")->required();
  app.add_option("--size", o.size,
                 "length of the mesh's longest side after scaling [m] (default: no scaling)");
  app.add_option("--workspace", o.workspace,
                 "x0,y0,z0,x1,y1,z1: box to map [m] (default: a cube around the object, 8/7 of its "
                 "longest side)");
  app.add_option("--up", o.up, "axis of the mesh file that points up")
      ->check(one_of({"x", "y", "z"}, "axis"));
  begin_group(app, "Views");
  app.add_option("--from", o.from,
                 "tx,ty,tz,qx,qy,qz,qw: start pose [m] (default: 27 deg above the object; --seed "
                 "sets the azimuth)");
  app.add_option("--distance", o.distance,
                 "distance of start pose and sets of poses from the object's centre [m] "
                 "(default: see below)");
  app.add_option("--policy", o.policy, "rule that chooses views (see below)")
      ->check(one_of(policy_names(), "policy"));
  app.add_option("--generator", o.generator,
                 "sources of candidates, separated by commas; see below (default: boundary; sphere "
                 "for --policy random and fibonacci)")
      ->check(several_of(generator_names(), "generator"));
  explain_values(app,
                 "Views that --policy chooses:\n"
                 "  gain       highest expected gain\n"
                 "  kriegel    open edges of the surface: left, right, top, then bottom\n"
                 "  sequence   8 views of a turntable, then one from above; or those of --poses\n"
                 "  random     random views\n"
                 "  frontier   most unknown voxels in view\n"
                 "  fibonacci  evenly around the object\n"
                 "  oracle     most new coverage; it knows the mesh\n");
  explain_values(
      app,
      "Sources of candidates for --generator:\n"
      "  boundary  in front of open edges of the surface\n"
      "  sphere, dome, rings, shell, sequence  sets of poses around the object; default\n"
      "            --distance: the working distance, or more for large objects.\n"
      "            With --reach, shell fills the shells or boxes of the reach file\n");
  app.add_option("--poses", o.poses,
                 "TUM or .npy file of poses that --policy sequence takes after the start pose "
                 "(default: a turntable)");
  app.add_option("--count", o.count,
                 "number of poses for sphere, dome or shell (default: 500; --policy fibonacci: "
                 "--max-views), or for rings (48, 80, 288 or 864; default: 48)")
      ->check(counted(1, kMaxCount));
  app.add_option("--gain", o.gain,
                 "gain for --policy gain: paper (entropy removed), surface (new surface), combined "
                 "or a gain of the literature (default: combined)")
      ->check(one_of(all_gain_names(), "gain"));
  add_hazard_option(app, o.hazard);
  begin_group(app, "Gain");
  app.add_option("--criterion", o.criterion,
                 "criterion for entropy and the gain paper: log_diagonal, log_determinant [nat] or "
                 "trace [m^2], which cannot be used with --gain combined")
      ->check(one_of(criterion_names(), "criterion"));
  begin_group(app, "Stopping");
  app.add_option("--max-views", o.max_views, "maximum number of views")
      ->check(counted(1, kMaxCount));
  add_stop_option(app, o.stop);
  app.add_option("--tolerance", o.tolerance,
                 "largest distance from surface to mesh that counts as covered [m] (default: the "
                 "larger of 0.005 and a voxel)");
  begin_group(app, "Views");
  app.add_option("--cost-per-metre", o.cost_per_metre,
                 "L: rank by gain - L * distance [nat/m; m^2/m for --gain surface]");
  add_plan_option(app, o.plan);
  begin_group(app, "Obstacles");
  app.add_option("--reach", o.reach,
                 "TOML file of poses that the robot can reach (default: no limit)");
  app.add_option("--obstacle", o.obstacles, kObstacleHelp)->allow_extra_args(false);
  app.add_option("--body", o.body, kBodyHelp);
  add_sensing_options(app, o.sensing);
  add_registration_option(app, o.registration);
  begin_group(app, "Map");
  app.add_option("--frames-per-view", o.frames_per_view, "number of frames from each pose")
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
    refuse("--gain " + options.gain + " requires --policy gain, not " + options.policy);
  }
  if (!options.poses.empty() &&
      (parse_policy(options.policy) != Policy::sequence || !options.generator.empty())) {
    refuse("--poses requires --policy sequence and cannot be used with --generator");
  }
  if (options.tolerance) check_positive("--tolerance", *options.tolerance);
  check_at_least_0("--cost-per-metre", options.cost_per_metre);
  if (parse_plan(options.plan).is_on() &&
      (parse_policy(options.policy) != Policy::gain || is_registered_gain(options.gain))) {
    refuse("--plan requires --policy gain with --gain paper, surface or combined");
  }
  if (options.distance) check_positive("--distance", *options.distance);
  if (options.sensing.support_plane) {
    check_finite("--support-plane", *options.sensing.support_plane);
  }
  (void)stop_limits(options.stop);
}

}  // namespace viewgain::app
