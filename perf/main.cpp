// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include <CLI/CLI.hpp>
#include <cstdio>
#include <exception>

#include "benches/bars.hpp"
#include "benches/decision_bench.hpp"
#include "benches/integrate_bench.hpp"
#include "benches/trace_bench.hpp"
#include "benches/tracers_bench.hpp"
#include "choose/approximate_bench.hpp"
#include "choose/choose_bench.hpp"
#include "environment.hpp"
#include "model_maps.hpp"
#include "peers/armadillo_bench.hpp"
#include "peers/frames_bench.hpp"
#include "peers/hemisphere_bench.hpp"
#include "peers/view_choice.hpp"
#include "sizes/hall_bench.hpp"
#include "sizes/peak_memory.hpp"
#include "sizes/scaling_bench.hpp"
#include "support/camel_scene.hpp"
#include "viewgain/core/error.hpp"
#include "viewgain/raycast/gain_evaluator.hpp"

namespace {

constexpr int kInternalError = 1;
constexpr int kBadInput = 2;

void add_run(CLI::App& app, int& threads, int& repetitions, std::filesystem::path& mesh,
             bool& json) {
  app.add_option("--threads", threads, "number of threads (0: all)")
      ->check(CLI::Range(0, 1024))
      ->capture_default_str();
  app.add_option("--repetitions", repetitions, "timed runs per method")
      ->check(CLI::Range(1, 1000))
      ->capture_default_str();
  app.add_option("--mesh", mesh, "mesh file of the test object, a camel")->capture_default_str();
  app.add_flag("--json", json, "print JSON");
}

void add_common(CLI::App& app, int& threads, int& voxels, int& repetitions,
                std::filesystem::path& mesh, bool& json) {
  add_run(app, threads, repetitions, mesh, json);
  app.add_option("--voxels", voxels, "number of voxels along each side of the map")
      ->check(CLI::Range(8, 1024))
      ->capture_default_str();
}

int run(int argc, char** argv) {
  CLI::App app(
      "Measures the speed and accuracy of viewgain, also against other libraries on the same "
      "tasks");
  app.require_subcommand(1);

  viewgain::bench::TraceOptions trace;
  trace.mesh = viewgain::test::camel_mesh_path();
  CLI::App* trace_app = app.add_subcommand(
      "trace", "find the first voxel along each ray that is not free, with several methods");
  add_common(*trace_app, trace.num_threads, trace.voxels, trace.repetitions, trace.mesh,
             trace.json);
  trace_app
      ->add_option("--poses", trace.poses, "number of views of an SR4000 camera at full resolution")
      ->check(CLI::Range(1, 1000000))
      ->capture_default_str();

  trace_app
      ->add_option("--without", trace.without, "methods to skip: dense, tree64, openvdb, octomap")
      ->check(CLI::IsMember({"dense", "tree64", "openvdb", "octomap"}))
      ->delimiter(',');

  viewgain::bench::IntegrateOptions integrate;
  integrate.mesh = viewgain::test::camel_mesh_path();
  CLI::App* integrate_app =
      app.add_subcommand("integrate", "integrate one depth frame into a map of the camel");
  add_common(*integrate_app, integrate.num_threads, integrate.voxels, integrate.repetitions,
             integrate.mesh, integrate.json);

  viewgain::bench::DecisionOptions decision;
  decision.mesh = viewgain::test::camel_mesh_path();
  CLI::App* decision_app = app.add_subcommand(
      "decision",
      "time from a new frame to the best next pose, per stage, gain and number of candidates");
  add_run(*decision_app, decision.num_threads, decision.repetitions, decision.mesh, decision.json);
  decision_app
      ->add_option("--maps", decision.maps,
                   "maps to use: camel-N (N voxels along each side), room, hall")
      ->check(CLI::Validator(
          [](const std::string& name) {
            const bool is_camel = name.starts_with("camel-") && name.size() > 6 &&
                                  name.find_first_not_of("0123456789", 6) == std::string::npos;
            return is_camel || name == "room" || name == "hall" ? "" : "unknown map " + name;
          },
          "MAP"))
      ->delimiter(',')
      ->capture_default_str();
  decision_app->add_option("--candidates", decision.candidates, "numbers of candidate views")
      ->check(CLI::Range(1, 1000000))
      ->delimiter(',')
      ->capture_default_str();
  decision_app
      ->add_option("--recording", decision.recording,
                   "folder of frames from which to make the map room")
      ->check(CLI::ExistingDirectory);

  viewgain::bench::ScalingOptions scaling;
  scaling.mesh = viewgain::test::camel_mesh_path();
  CLI::App* scaling_app = app.add_subcommand(
      "scaling", "time of the gain per map size, number of rays per pose and number of threads");
  add_run(*scaling_app, scaling.num_threads, scaling.repetitions, scaling.mesh, scaling.json);
  scaling_app
      ->add_option("--voxels", scaling.voxels, "number of voxels along each side of the maps")
      ->check(CLI::Range(8, 1024))
      ->delimiter(',')
      ->capture_default_str();
  scaling_app->add_option("--poses", scaling.poses, "number of views at full resolution")
      ->check(CLI::Range(1, 1000000))
      ->capture_default_str();

  viewgain::bench::ApproximateOptions approximate;
  approximate.mesh = viewgain::test::camel_mesh_path();
  CLI::App* approximate_app = app.add_subcommand("approximate",
                                                 "accuracy and speed of gains from a part of the "
                                                 "rays, with pixel strides and with approximate()");
  add_common(*approximate_app, approximate.num_threads, approximate.voxels, approximate.repetitions,
             approximate.mesh, approximate.json);
  approximate_app->add_option("--poses", approximate.poses, "number of views")
      ->check(CLI::Range(40, 1000000))
      ->capture_default_str();

  viewgain::bench::ChooseOptions choose;
  CLI::App* choose_app = app.add_subcommand(
      "choose", "compare race() and approximate() with scoring all views, in a room or on objects");
  choose_app->add_option("--threads", choose.num_threads, "number of threads (0: all)")
      ->check(CLI::Range(0, 1024))
      ->capture_default_str();
  choose_app->add_option("--map", choose.map, ".vdb map of a room (default: a simulated room)")
      ->check(CLI::ExistingFile);
  choose_app->add_option("--poses", choose.poses, "number of poses in the room")
      ->check(CLI::Range(1, 1000000))
      ->capture_default_str();
  choose_app
      ->add_option("--subsets", choose.subsets, "number of races, each among 100 of these poses")
      ->check(CLI::Range(1, 1000000))
      ->capture_default_str();
  choose_app
      ->add_option("--maps", choose.maps,
                   "number of maps of objects to use instead of the room; 0: use the room")
      ->check(CLI::Range(0, 200))
      ->capture_default_str();
  choose_app
      ->add_option(
          "--tuned", choose.tuned_maps,
          "number of maps, from the first, that were used for tuning; they are reported separately")
      ->check(CLI::Range(0, 200))
      ->capture_default_str();
  choose_app->add_option("--seed", choose.seed, "seed for poses, subsets, race() and approximate()")
      ->capture_default_str();
  choose_app->add_option("--gain", choose.gain, "gain to rank by: paper, surface or combined")
      ->check(CLI::IsMember(viewgain::gain_model_names()))
      ->capture_default_str();
  choose_app->add_flag("--json", choose.json, "print JSON");

  viewgain::bench::BarsOptions bars;
  bars.mesh = viewgain::test::camel_mesh_path();
  CLI::App* bars_app = app.add_subcommand("bars",
                                          "measure all figures for which a bar (a required value) "
                                          "is set; the exit code is 1 if one misses its bar");
  add_common(*bars_app, bars.num_threads, bars.voxels, bars.repetitions, bars.mesh, bars.json);
  bars_app
      ->add_option("--large-voxels", bars.large_voxels,
                   "number of voxels along each side of the large map")
      ->check(CLI::Range(8, 1024))
      ->capture_default_str();
  bars_app->add_option("--poses", bars.poses, "number of views in the tracing comparison")
      ->check(CLI::Range(1, 1000000))
      ->capture_default_str();
  bars_app->add_option("--maps", bars.maps, "number of maps to search with race")
      ->check(CLI::Range(1, 200))
      ->capture_default_str();
  bars_app->add_option("--candidates", bars.candidates, "number of views per search")
      ->check(CLI::Range(1, 1000000))
      ->capture_default_str();
  std::vector<std::string> groups;
  for (const auto& group : viewgain::bench::bar_groups()) groups.emplace_back(group.name);
  bars_app->add_option("--only", bars.only, "groups to measure (default: all)")
      ->check(CLI::IsMember(groups))
      ->delimiter(',');

  viewgain::bench::MemoryOptions memory;
  memory.mesh = viewgain::test::camel_mesh_path();
  CLI::App* memory_app = app.add_subcommand(
      "memory", "print how much memory a map and its ray casting scene take, as JSON");
  memory_app->add_option("--threads", memory.num_threads, "number of threads (0: all)")
      ->check(CLI::Range(0, 1024))
      ->capture_default_str();
  memory_app->add_option("--voxels", memory.voxels, "number of voxels along each side of the map")
      ->check(CLI::Range(8, 1024))
      ->capture_default_str();
  memory_app->add_option("--views", memory.views, "number of integrated views")
      ->check(CLI::Range(1, 1000))
      ->capture_default_str();
  memory_app->add_option("--mesh", memory.mesh, "mesh file of the test object, a camel")
      ->capture_default_str();

  viewgain::bench::TracersOptions tracers;
  tracers.mesh = viewgain::test::camel_mesh_path();
  CLI::App* tracers_app = app.add_subcommand(
      "tracers", "compare the tracers embree and sweep, per map, gain, image size and call");
  tracers_app->add_option("--threads", tracers.num_threads, "number of threads (0: all)")
      ->check(CLI::Range(0, 1024))
      ->capture_default_str();
  tracers_app->add_option("--repetitions", tracers.repetitions, "timed runs per tracer")
      ->check(CLI::Range(1, 1000))
      ->capture_default_str();
  tracers_app->add_option("--mesh", tracers.mesh, "mesh file of the test object, a camel")
      ->capture_default_str();

  viewgain::bench::HallOptions hall;
  CLI::App* hall_app =
      app.add_subcommand("hall", "memory and speed for a map of a hall, 20 m x 20 m x 3 m");
  hall_app->add_option("--threads", hall.num_threads, "number of threads (0: all)")
      ->check(CLI::Range(0, 1024))
      ->capture_default_str();
  hall_app->add_option("--voxel", hall.voxel, "voxel size [m]")
      ->check(CLI::Range(0.005, 1.0))
      ->capture_default_str();
  hall_app->add_option("--coarsest", hall.coarsest,
                       "largest scale of cells, 0 to 3: cells have up to 2^scale voxels per edge");
  hall_app->add_option("--frames", hall.frames, "number of frames along the aisles")
      ->check(CLI::Range(1, 1000000))
      ->capture_default_str();
  hall_app->add_option("--poses", hall.poses, "number of poses to score at the end")
      ->check(CLI::Range(1, 1000000))
      ->capture_default_str();
  hall_app->add_flag("--json", hall.json, "print JSON");

  viewgain::bench::ArmadilloOptions armadillo;
  CLI::App* armadillo_app = app.add_subcommand(
      "armadillo",
      "number of views until the Armadillo is as complete as in the log of NBV-Simulation");
  armadillo_app->add_option("--threads", armadillo.num_threads, "number of threads (0: all)")
      ->check(CLI::Range(0, 1024))
      ->capture_default_str();
  armadillo_app
      ->add_option(
          "--data", armadillo.data,
          "clone of NBV-Simulation (perf/peers/get_nbv_simulation.sh) or a stand-in for it")
      ->required();
  armadillo_app->add_option("--gain", armadillo.rankers, "how to rank views; one run per ranking")
      ->check(CLI::IsMember(viewgain::bench::ranker_names()))
      ->delimiter(',')
      ->capture_default_str();
  armadillo_app
      ->add_option("--travel", armadillo.travel,
                   "weights of the distance in the score; one run per weight")
      ->check(CLI::Range(0.0, 1.0))
      ->delimiter(',')
      ->capture_default_str();
  armadillo_app->add_option("--views", armadillo.views, "number of views per run")
      ->check(CLI::Range(1, 1000))
      ->capture_default_str();
  armadillo_app->add_option("--voxel", armadillo.voxel, "voxel size of viewgain's map [m]")
      ->check(CLI::PositiveNumber)
      ->capture_default_str();
  armadillo_app
      ->add_option("--stride", armadillo.stride,
                   "use every n-th pixel of every n-th row for scoring")
      ->check(CLI::Range(1, 640))
      ->capture_default_str();
  armadillo_app->add_flag("--json", armadillo.json, "print JSON");

  viewgain::bench::HemisphereOptions hemisphere;
  hemisphere.meshes = viewgain::bench::object_meshes();
  hemisphere.meshes.push_back(hemisphere.meshes.back().parent_path() / "elephant.off");
  CLI::App* hemisphere_app = app.add_subcommand("hemisphere",
                                                "coverage after each view when views are chosen on "
                                                "a hemisphere, with the protocol of MA-SCVP");
  hemisphere_app->add_option("--threads", hemisphere.num_threads, "number of threads (0: all)")
      ->check(CLI::Range(0, 1024))
      ->capture_default_str();
  hemisphere_app->add_option("--mesh", hemisphere.meshes, "mesh files (default: six objects)")
      ->delimiter(',');
  hemisphere_app->add_option(
      "--views-file", hemisphere.views_file,
      "file of positions in the format of view_space.txt of MA-SCVP (default: 32 positions)");
  hemisphere_app->add_option("--gain", hemisphere.rankers, "how to rank views; one run per ranking")
      ->check(CLI::IsMember(viewgain::bench::ranker_names()))
      ->delimiter(',')
      ->capture_default_str();
  hemisphere_app
      ->add_option("--first-views", hemisphere.first_views,
                   "number of first views; one run per first view")
      ->check(CLI::Range(1, 1000))
      ->capture_default_str();
  hemisphere_app->add_option("--budget", hemisphere.budget, "number of views per run")
      ->check(CLI::Range(1, 1000))
      ->capture_default_str();
  hemisphere_app->add_option("--size", hemisphere.size, "longest side of the objects [m]")
      ->check(CLI::Range(0.01, 0.3))
      ->capture_default_str();
  hemisphere_app->add_flag("--json", hemisphere.json, "print JSON");

  viewgain::bench::FramesOptions frames;
  frames.meshes = viewgain::bench::object_meshes();
  CLI::App* frames_app = app.add_subcommand(
      "frames", "compare the criteria log_diagonal and log_determinant on rotated grids");
  frames_app->add_option("--threads", frames.num_threads, "number of threads (0: all)")
      ->check(CLI::Range(0, 1024))
      ->capture_default_str();
  frames_app->add_option("--mesh", frames.meshes, "mesh files (default: five objects)")
      ->delimiter(',');
  frames_app->add_option("--degrees", frames.degrees, "rotations of the grid [deg]")
      ->check(CLI::Range(-180.0, 180.0))
      ->delimiter(',')
      ->capture_default_str();
  frames_app->add_option("--seeds", frames.seeds, "number of runs per object")
      ->check(CLI::Range(1, 1000))
      ->capture_default_str();
  frames_app->add_option("--views", frames.views, "number of views per run")
      ->check(CLI::Range(2, 1000))
      ->capture_default_str();
  frames_app
      ->add_option("--candidates", frames.candidates, "number of candidate views on the sphere")
      ->check(CLI::Range(2, 1000000))
      ->capture_default_str();
  frames_app->add_option("--voxel", frames.voxel, "voxel size [m]")
      ->check(CLI::PositiveNumber)
      ->capture_default_str();
  frames_app->add_flag("--json", frames.json, "print JSON");

  int environment_threads = 0;
  CLI::App* environment_app = app.add_subcommand(
      "environment", "print CPU, instruction set, compiler, versions and commit as JSON");
  environment_app->add_option("--threads", environment_threads, "number of threads (0: all)")
      ->check(CLI::Range(0, 1024))
      ->capture_default_str();

  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? 0 : kBadInput;
  }
  if (trace_app->parsed()) return viewgain::bench::run_trace(trace);
  if (integrate_app->parsed()) return viewgain::bench::run_integrate(integrate);
  if (decision_app->parsed()) return viewgain::bench::run_decision(decision);
  if (scaling_app->parsed()) return viewgain::bench::run_scaling(scaling);
  if (approximate_app->parsed()) return viewgain::bench::run_approximate(approximate);
  if (choose_app->parsed()) return viewgain::bench::run_choose(choose);
  if (bars_app->parsed()) return viewgain::bench::run_bars(bars);
  if (memory_app->parsed()) return viewgain::bench::run_memory(memory);
  if (tracers_app->parsed()) return viewgain::bench::run_tracers(tracers);
  if (hall_app->parsed()) return viewgain::bench::run_hall(hall);
  if (armadillo_app->parsed()) return viewgain::bench::run_armadillo(armadillo);
  if (hemisphere_app->parsed()) return viewgain::bench::run_hemisphere(hemisphere);
  if (frames_app->parsed()) return viewgain::bench::run_frames(frames);
  return viewgain::bench::run_environment(environment_threads);
}

}  // namespace

int main(int argc, char** argv) {
  try {
    return run(argc, argv);
  } catch (const viewgain::Error& error) {
    std::fprintf(stderr, "viewgain-bench: %s\n", error.what());
    return error.code() == viewgain::ErrorCode::backend ? kInternalError : kBadInput;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "viewgain-bench: %s\n", error.what());
    return kInternalError;
  }
}
