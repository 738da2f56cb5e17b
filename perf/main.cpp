// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include <CLI/CLI.hpp>
#include <cstdio>
#include <exception>

#include "honesty_bench.hpp"
#include "integrate_bench.hpp"
#include "iteration_bench.hpp"
#include "support/camel_scene.hpp"
#include "trace_bench.hpp"
#include "viewgain/core/error.hpp"

namespace {

constexpr int kInternalError = 1;
constexpr int kBadInput = 2;

void add_common(CLI::App& app, int& threads, int& voxels, int& repetitions,
                std::filesystem::path& mesh, bool& json) {
  app.add_option("--threads", threads, "threads, 0: all")
      ->check(CLI::Range(0, 1024))
      ->capture_default_str();
  app.add_option("--voxels", voxels, "voxels a side of the workspace")
      ->check(CLI::Range(8, 1024))
      ->capture_default_str();
  app.add_option("--repetitions", repetitions, "timed runs of each method")
      ->check(CLI::Range(1, 1000))
      ->capture_default_str();
  app.add_option("--mesh", mesh, "the camel's mesh file")->capture_default_str();
  app.add_flag("--json", json, "print JSON");
}

int run(int argc, char** argv) {
  CLI::App app("Benchmarks of viewgain and of other libraries doing the same job");
  app.require_subcommand(1);

  viewgain::bench::TraceOptions trace;
  trace.mesh = viewgain::test::camel_mesh_path();
  CLI::App* trace_app = app.add_subcommand(
      "trace", "first voxel that is not free along each ray, of views of the camel's map");
  add_common(*trace_app, trace.num_threads, trace.voxels, trace.repetitions, trace.mesh,
             trace.json);
  trace_app->add_option("--poses", trace.poses, "views, SR4000 at full resolution")
      ->check(CLI::Range(1, 1000000))
      ->capture_default_str();

  viewgain::bench::IntegrateOptions integrate;
  integrate.mesh = viewgain::test::camel_mesh_path();
  CLI::App* integrate_app = app.add_subcommand("integrate", "one depth frame into the camel's map");
  add_common(*integrate_app, integrate.num_threads, integrate.voxels, integrate.repetitions,
             integrate.mesh, integrate.json);

  viewgain::bench::IterationOptions iteration;
  iteration.mesh = viewgain::test::camel_mesh_path();
  CLI::App* iteration_app = app.add_subcommand(
      "iteration", "one turn of the loop after eight views of the camel, by stage");
  add_common(*iteration_app, iteration.num_threads, iteration.voxels, iteration.repetitions,
             iteration.mesh, iteration.json);
  iteration_app->add_option("--candidates", iteration.candidates, "views to score")
      ->check(CLI::Range(1, 1000000))
      ->capture_default_str();

  viewgain::bench::HonestyOptions honesty;
  honesty.mesh = viewgain::test::camel_mesh_path();
  CLI::App* honesty_app = app.add_subcommand(
      "honesty", "consistency of the sigmas and error of the surface as readings accumulate");
  honesty_app->add_option("--threads", honesty.num_threads, "threads, 0: all")
      ->check(CLI::Range(0, 1024))
      ->capture_default_str();
  honesty_app->add_option("--views", honesty.views, "views on the sphere, repeated up to ten times")
      ->check(CLI::Range(1, 1000))
      ->capture_default_str();
  honesty_app->add_option("--mesh", honesty.mesh, "mesh file")->capture_default_str();
  honesty_app->add_flag("--json", honesty.json, "print JSON");

  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? 0 : kBadInput;
  }
  if (trace_app->parsed()) return viewgain::bench::run_trace(trace);
  if (integrate_app->parsed()) return viewgain::bench::run_integrate(integrate);
  if (iteration_app->parsed()) return viewgain::bench::run_iteration(iteration);
  return viewgain::bench::run_honesty(honesty);
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
