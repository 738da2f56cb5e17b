// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "program/commands/reconstruct/run_options.hpp"

#include <algorithm>

#include "program/cli/flags/gain_names.hpp"
#include "program/cli/flags/scene_sources.hpp"
#include "program/cli/flags/sensing.hpp"
#include "program/cli/flags/sensing_flags.hpp"
#include "program/cli/values.hpp"
#include "viewgain/formats/sensor_toml.hpp"
#include "viewgain/literature/classic_gains.hpp"
#include "viewgain/planner_mesh/policies.hpp"

namespace viewgain::app {
namespace {

constexpr std::size_t kMaxCount = 1'000'000;

auto counted(std::size_t least, std::size_t most) {
  return [=](Option& option) { option.range(least, most, "count"); };
}

auto counted_with_default(std::size_t least, std::size_t most) {
  return [=](Option& option) {
    counted(least, most)(option);
    shows_default(option);
  };
}

auto named(const std::vector<std::string>& names, const char* what) {
  return [&names, what](Option& option) {
    option.one_of(names, what);
    shows_default(option);
  };
}

// Each option once, in the order of run.json's settings. `Options` is ReconstructOptions or const.
template <typename Options, typename Visitor>
void describe(Options& o, Visitor& visit) {
  visit.option("mesh", "MESH", o.mesh, "OFF, OBJ, STL or PLY, centred", needed);
  visit.option("sensor", "--sensor", o.sensor, kSensorHelp.c_str(), needed);
  visit.option("voxel", "--voxel", o.voxel, "voxel size [m]", needed);
  visit.option("size", "--size", o.size,
               "scale the object so that its longest side is this [m]; default: the file's own "
               "size, in metres",
               as_it_is);
  visit.option(
      "workspace", "--workspace", o.workspace,
      "x0,y0,z0,x1,y1,z1 [m]; default: a cube of the longest side * 0.4/0.35 around the object",
      as_it_is);
  visit.derived("prior_sigma");
  visit.option("up", "--up", o.up, "axis of the mesh file that points up", [](Option& option) {
    option.capture_default_str()->one_of({"x", "y", "z"}, "axis");
  });
  visit.option("start", "--start", o.start,
               "first camera pose tx,ty,tz,qx,qy,qz,qw [m]; default: 27 deg "
               "above the object at an azimuth that depends on the seed",
               as_it_is);
  visit.option("distance", "--distance", o.distance,
               "of the start and of poses round the object from its centre [m]; default: the "
               "object fills the view, at least the sensor's working distance, and a shell fills "
               "the shells or boxes of --reach",
               as_it_is);
  visit.option("policy", "--policy", o.policy,
               "gain, kriegel (left, right, top, bottom), sequence (turntable of 8, then top), "
               "random, frontier (most unknown voxels in view), fibonacci (evenly round the "
               "object), proximity (most unknown space near known surface on its rays), oracle "
               "(knows the mesh: an upper reference)",
               named(policy_names(), "policy"));
  visit.option("generators", "--generator", o.generator,
               "where candidates come from: boundary, sphere, dome, rings, shell, sequence, or "
               "several with commas; default: boundary (random and fibonacci: sphere, sequence: "
               "sequence)",
               [](Option& option) { option.several_of(generator_names(), "generator"); });
  visit.option("sphere_poses", "--count", o.count,
               "poses of the sphere, dome or shell (default 500; sphere of --policy fibonacci: "
               "--max-views); rings: 48, 80, 288 or 864 (default 48)",
               counted(1, kMaxCount));
  visit.option("gain", "--gain", o.gain,
               "of --policy gain: paper (entropy removed), surface (new surface to be expected) or "
               "combined (default); or a gain of the literature",
               [](Option& option) { option.one_of(all_gain_names(), "gain"); });
  visit.option("semantics", "--semantics", o.semantics,
               "of a gain of the literature: as the papers define it (default) or as the code that "
               "was shipped with them computes it",
               [](Option& option) { option.one_of(gain_semantics_names(), "semantics"); });
  visit.option("overlap", "--overlap", o.overlap, kOverlapHelp, shows_default);
  visit.option("region_depth", "--region-depth", o.region_depth, kRegionDepthHelp, shows_default);
  visit.option("object_size", "--object-size", o.object_size, kObjectSizeHelp, as_it_is);
  visit.option("hazard", "--hazard", o.hazard, kHazardHelp, as_it_is);
  visit.option(
      "criterion", "--criterion", o.criterion,
      "of the map's entropy and the paper's gain: log_diagonal, log_determinant [nat] or trace "
      "[m^2], which the combined gain does not go with",
      named(criterion_names(), "criterion"));
  visit.option("max_views", "--max-views", o.max_views, "view budget",
               counted_with_default(1, kMaxCount));
  visit.option("stop_gain", "--stop-gain", o.stop_gain,
               "of the paper's gain: stop when the best view gains less per touched voxel [nat, "
               "m^2]; default: 1.2 (trace: 0.01 of the first view's)",
               as_it_is);
  visit.derived("stop_gain_is_relative");
  visit.option(
      "stop_area", "--stop-area", o.stop_area,
      "of --gain surface and combined: stop when the best candidate promises less than this "
      "share of the surface so far as new surface, on the mean of three decisions; 0: never; "
      "default: 0.004",
      as_it_is);
  visit.option("stop_idle", "--stop-idle", o.stop_idle,
               "stop after so many views in a row that change entropy and unknown voxels by "
               "less than 0.1 %; 0: never",
               counted_with_default(0, kMaxCount));
  visit.option("stop_promises", "--stop-promises", o.stop_promises, kStopPromisesHelp,
               counted_with_default(0, kMaxCount));
  visit.option("stop_coverage", "--stop-coverage", o.stop_coverage,
               "stop at this coverage of the visible surface, 0..1", as_it_is);
  visit.option("tolerance", "--tolerance", o.tolerance,
               "a point of the mesh counts as covered where the surface is within this of it [m]",
               shows_default);
  visit.option("travel_cost", "--travel-cost", o.travel_cost,
               "rank by gain - L * distance [nat/m, surface: m^2/m]", shows_default);
  // Recorded where it is planned ahead.
  visit.option(nullptr, "--plan", o.plan.plan, kPlanHelp, counted_with_default(1, 1000));
  visit.option(nullptr, "--take", o.plan.take, kTakeHelp, counted(1, 1000));
  visit.option("reach", "--reach", o.reach, "TOML file: boxes, shells, half-spaces, poses in reach",
               as_it_is);
  // Recorded where there are any.
  visit.option(nullptr, "--obstacle", o.obstacles, kObstacleHelp,
               [](Option& option) { option.allow_extra_args(false); });
  // Recorded as a part of the sensor.
  visit.option(nullptr, "--body", o.body, kBodyHelp, as_it_is);
  describe_sensing(o.sensing, visit);
  visit.option("register", "--register", o.registration.is_on,
               "align the frames with one another and make the map from the poses that come of it",
               switched);
  visit.option(
      "pose_sigma", "--pose-sigma", o.registration.pose_sigma,
      "SIGMA_M,SIGMA_DEG by which reported poses may be off, of --register; default: those "
      "of --pose-noise, else 0.005,0.5",
      as_it_is);
  visit.option("frames_per_view", "--frames-per-view", o.frames_per_view, "frames from each pose",
               counted_with_default(1, 1000));
  visit.option("jump_edge_filter", "--jump-edge-filter", o.jump_edge_filter, kJumpEdgeHelp,
               shows_default);
  visit.option("refine", "--refine", o.refine,
               "readings of a voxel refine it; off: the first one wins", switched);
}

}  // namespace

void add_output_options(App& app, RunOutputs& outputs) {
  const OptionDeclaration declaration(app);
  declaration.option(nullptr, "--save-maps", outputs.save_maps, "keep maps/NN.vdb after each view",
                     switched);
  declaration.option(nullptr, "--pictures", outputs.pictures, "draw views/NN.png", switched);
  declaration.option(nullptr, "--report", outputs.report,
                     "write report.html: the run to look at in a browser, in one file", switched);
  app.add_flag("--resume", outputs.resume,
               "go on where the same call was ended, if it was: by a kill, a signal, a full disk");
  declaration.option(nullptr, "--out", outputs.out, "folder to write", needed);
}

void add_options(App& app, ReconstructOptions& o) {
  o.sensing.noise = "on";
  const OptionDeclaration declaration(app);
  describe(o, declaration);
  add_scale_options(app, o.scales);
  add_output_options(app, o.outputs);
  add_trace_option(app, o.common);
  add_common_options(app, o.common);
  add_help(app, kLoopGroup,
           "reconstruct mesh.off --size 0.35 --sensor sr4000 --voxel 0.005 --max-views 4 "
           "--pictures off --out run");
}

Json settings_json(const ReconstructOptions& options, const Json& resolved) {
  OptionRecord record(resolved);
  describe(options, record);
  return record.json();
}

void check(const ReconstructOptions& options) {
  check_positive("--voxel", options.voxel);
  if (options.size) check_positive("--size", *options.size);
  if (!options.gain.empty() && parse_policy(options.policy) != Policy::gain) {
    refuse("--gain " + options.gain + " goes with --policy gain, not " + options.policy);
  }
  const std::vector<std::string>& classic = classic_gain_names();
  const bool is_classic = std::find(classic.begin(), classic.end(), options.gain) != classic.end();
  if (!options.semantics.empty() && !is_classic) {
    refuse("--semantics " + options.semantics + " goes with a gain of the literature (--gain " +
           classic.front() + ", ...)");
  }
  check_positive("--tolerance", options.tolerance);
  check_at_least_0("--travel-cost", options.travel_cost);
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
