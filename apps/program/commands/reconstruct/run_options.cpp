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
             "write maps/NN.vdb after each view; reconstruct: also the candidates for the next "
             "view, maps/NN.txt");
  add_switch(app, "--pictures", outputs.pictures, "draw views/NN.png");
  app.add_option("--report", outputs.report,
                 "on: write report.html, one file for a browser; or the folder of another run "
                 "whose curves to overlay; off");
  app.add_flag("--resume", outputs.resume,
               "resume this call after an interruption (kill, signal, full disk)");
  app.add_option("--out", outputs.out, "folder to write")->required();
}

void add_options(App& app, ReconstructOptions& o) {
  o.sensing.noise = "on";
  app.add_option("MESH", o.mesh, "OFF, OBJ, STL or PLY file; the mesh is centred at the origin")
      ->required();
  app.add_option("--sensor", o.sensor, kSensorHelp.c_str())->required();
  app.add_option("--voxel", o.voxel, "voxel size [m]")->required();
  app.add_option("--size", o.size,
                 "scale the object to this longest side [m] (default: the file's size, in metres)");
  app.add_option("--workspace", o.workspace,
                 "x0,y0,z0,x1,y1,z1 [m] (default: a cube of 0.4/0.35 times the longest side around "
                 "the object)");
  app.add_option("--up", o.up, "axis of the mesh file that points up")
      ->check(one_of({"x", "y", "z"}, "axis"));
  begin_group(app, "Views");
  app.add_option("--from", o.from,
                 "tx,ty,tz,qx,qy,qz,qw: start pose of the camera in the world [m] (default: 27 deg "
                 "above the object, at an azimuth that depends on the seed)");
  app.add_option("--distance", o.distance,
                 "distance from the object's centre for the start and the sets of poses [m] "
                 "(default: see below)");
  app.add_option("--policy", o.policy, "how to choose views (see below)")
      ->check(one_of(policy_names(), "policy"));
  app.add_option("--generator", o.generator,
                 "sources of candidates, comma-separated (see below) (default: boundary; random "
                 "and fibonacci: sphere; sequence: sequence)")
      ->check(several_of(generator_names(), "generator"));
  explain_values(app,
                 "Policies of --policy:\n"
                 "  gain       the view with the highest expected gain\n"
                 "  kriegel    boundary views: left, right, top, bottom\n"
                 "  sequence   turntable of 8 views, then top; or --poses\n"
                 "  random     a random view\n"
                 "  frontier   the view with the most unknown voxels in it\n"
                 "  fibonacci  evenly around the object\n"
                 "  oracle     knows the mesh: an upper reference\n");
  explain_values(app,
                 "Sources of candidates for --generator:\n"
                 "  boundary  in front of open surface boundaries\n"
                 "  sphere, dome, rings, shell, sequence  sets of poses around the object, which\n"
                 "            fills the view, at the sensor's working distance or more; a shell\n"
                 "            fills the shells or boxes of --reach\n");
  app.add_option("--poses", o.poses,
                 "TUM or .npy file of poses that --policy sequence takes in order after the start "
                 "(default: the turntable)");
  app.add_option("--count", o.count,
                 "number of poses of sphere, dome or shell (default: 500; sphere with --policy "
                 "fibonacci: --max-views); rings: 48, 80, 288 or 864 (default: 48)")
      ->check(counted(1, kMaxCount));
  app.add_option("--gain", o.gain,
                 "gain for --policy gain: paper (entropy removed), surface (expected new surface), "
                 "combined or a gain of the literature (default: combined)")
      ->check(one_of(all_gain_names(), "gain"));
  add_hazard_option(app, o.hazard);
  begin_group(app, "Gain");
  app.add_option("--criterion", o.criterion,
                 "criterion of entropy and of the paper gain: log_diagonal, log_determinant [nat] "
                 "or trace [m^2], which cannot be used with --gain combined")
      ->check(one_of(criterion_names(), "criterion"));
  begin_group(app, "Stopping");
  app.add_option("--max-views", o.max_views, "view budget")->check(counted(1, kMaxCount));
  add_stop_option(app, o.stop);
  app.add_option("--tolerance", o.tolerance,
                 "distance within which the surface covers a point of the mesh [m] (default: "
                 "the larger of 0.005 and a voxel)");
  begin_group(app, "Views");
  app.add_option("--cost-per-metre", o.cost_per_metre,
                 "L: rank by gain - L * distance [nat/m; with --gain surface m^2/m]");
  add_plan_option(app, o.plan);
  begin_group(app, "Obstacles");
  app.add_option("--reach", o.reach, "TOML file of reachable boxes, shells, half-spaces and poses");
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
