// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include "tracers_bench.hpp"

#include <array>
#include <cstdio>
#include <ctime>
#include <memory>
#include <string>
#include <vector>

#include "measure.hpp"
#include "support/camel_scene.hpp"
#include "support/room_scene.hpp"
#include "viewgain/core/generators.hpp"
#include "viewgain/raycast/gain_evaluator.hpp"
#include "viewgain/raycast/simulated_sensor.hpp"

namespace viewgain::bench {
namespace {

constexpr std::size_t kPoses = 200;
constexpr double kLeastSeconds = 0.02;  // of a timed run

// Views of a map.
struct Views {
  std::string name;
  std::shared_ptr<const VoxelScene> scene;
  std::vector<Pose> poses;
};

// What an image is.
struct Image {
  const char* name;
  int pixel_stride;
  int edge;  // of a square image instead of the sensor's [px]; 0: the sensor's
};
constexpr std::array kImages{Image{"176 x 144", 1, 0}, Image{"44 x 36", 4, 0},
                             Image{"22 x 18", 8, 0}, Image{"8 x 8", 1, 8}};

// Of the process [s]: what else runs on the machine does not count.
double cpu_seconds() {
  std::timespec now{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}
template <typename Call>
double cpu_seconds_of(const Call& call) {
  const double begin = cpu_seconds();
  call();
  return cpu_seconds() - begin;
}

// 40 m × 40 m × 5 m at 2 cm, of which three frames have seen a little.
BeliefGrid sparse_hall(const ExecConfig& exec) {
  TriangleMesh mesh;
  test::add_box(mesh, {{-19, -19, 0}, {19, 19, 4}});
  for (int i = -4; i <= 4; ++i) test::add_box(mesh, {{4.0 * i, 3, 0}, {4.0 * i + 0.6, 3.6, 1.5}});
  const Sensor sensor = sensor_preset("kinect_v1");
  const SimulatedSensor camera(std::make_shared<const SurfaceScene>(mesh, exec), sensor, {}, exec);
  BeliefGrid grid({.voxel_size = 0.02, .workspace = {{-20, -20, -0.5}, {20, 20, 4.5}}}, sensor);
  FrameIntegrator integrator(sensor, {}, exec);
  for (const double x : {-8.0, 0.0, 8.0}) {
    const Pose pose = look_at({x, 0, 1.4}, {x + 1, 3, 1});
    integrator.integrate(grid, camera.acquire(pose, 1), pose);
  }
  return grid;
}

Sensor sensor_of(const Image& image) {
  Sensor sensor = sensor_preset("sr4000");
  if (image.edge > 0) {
    const double f = sensor.camera.fx * image.edge / sensor.camera.width;
    sensor.camera = {.width = image.edge,
                     .height = image.edge,
                     .fx = f,
                     .fy = f,
                     .cx = 0.5 * image.edge,
                     .cy = 0.5 * image.edge};
  }
  return sensor;
}

// One evaluator by each tracer, and how long its calls take.
class Pair {
 public:
  Pair(const Views& views, const Image& image, GainModel model, bool is_batch, int num_threads)
      : views_(views), is_batch_(is_batch) {
    for (const ExecConfig::Tracer tracer :
         {ExecConfig::Tracer::sweep, ExecConfig::Tracer::embree}) {
      evaluators_.emplace_back(views.scene, sensor_of(image),
                               GainConfig{.model = model, .pixel_stride = image.pixel_stride},
                               ExecConfig{num_threads, tracer});
    }
  }

  [[nodiscard]] bool agrees() const {
    const auto a = evaluators_[0].evaluate(views_.poses), b = evaluators_[1].evaluate(views_.poses);
    for (std::size_t i = 0; i < a.size(); ++i) {
      if (a[i].gain != b[i].gain || a[i].hits != b[i].hits) return false;
    }
    return true;
  }

  // Views a second by each tracer, alternately; ratios are of neighbours in time.
  void measure(int repetitions) {
    std::array<int, 2> calls{};
    for (std::size_t k = 0; k < 2; ++k) {
      const double once = cpu_seconds_of([&] { run(k); });
      calls[k] = 1 + static_cast<int>(kLeastSeconds / once);
    }
    for (int i = 0; i < repetitions; ++i) {
      std::array<double, 2> rate{};
      for (std::size_t turn = 0; turn < 2; ++turn) {
        const std::size_t k = (turn + static_cast<std::size_t>(i)) % 2;
        const double seconds = cpu_seconds_of([&] {
          for (int call = 0; call < calls[k]; ++call) run(k);
        });
        rate[k] = calls[k] * static_cast<double>(views_.poses.size()) / seconds;
        rates[k].push_back(rate[k]);
      }
      ratios.push_back(rate[1] / rate[0]);
    }
  }

  std::array<std::vector<double>, 2> rates;
  std::vector<double> ratios;  // embree / sweep

 private:
  void run(std::size_t k) {
    if (is_batch_) {
      results_.resize(views_.poses.size());
      evaluators_[k].evaluate(views_.poses, results_);
      return;
    }
    for (const Pose& pose : views_.poses) (void)evaluators_[k].evaluate(pose);
  }

  const Views& views_;
  bool is_batch_;
  std::vector<GainEvaluator> evaluators_;
  std::vector<ViewGain> results_;
};

}  // namespace

int run_tracers(const TracersOptions& options) {
  const ExecConfig exec{options.num_threads};
  const auto camel = VoxelScene::build(test::camel_grid(128, options.mesh), {}, exec);
  const auto room = VoxelScene::build(test::room_grid(0.02, sensor_preset("kinect_v1"), 8, exec));
  const auto hall = VoxelScene::build(sparse_hall(exec));
  const std::vector<Views> all{
      {"camel-128, sphere", camel, sphere_poses(kPoses, 0.6)},
      {"camel-128, random", camel, test::poses_in(camel->snapshot(), kPoses, 3)},
      {"room, random", room, test::poses_in(room->snapshot(), kPoses, 3)},
      {"hall, random", hall, test::poses_in(hall->snapshot(), kPoses, 3)}};
  for (const Views& views : all) {
    std::printf("%s: %zu primitives\n", views.name.c_str(), views.scene->primitive_count());
  }
  bool agree = true;
  std::printf("\n| views | gain | pixels | call | sweep [1/s] | embree [1/s] | embree / sweep |\n");
  std::printf("|---|---|---|---|---|---|---|\n");
  for (const Views& views : all) {
    for (const GainModel model : {GainModel::paper, GainModel::combined}) {
      for (const Image& image : kImages) {
        for (const bool is_batch : {true, false}) {
          if (!is_batch && model != GainModel::paper) continue;
          Pair pair(views, image, model, is_batch, options.num_threads);
          agree = agree && pair.agrees();
          pair.measure(options.repetitions);
          std::printf("| %s | %s | %s | %s | %.0f | %.0f | %.2f (%.2f-%.2f) |\n",
                      views.name.c_str(), std::string(gain_model_name(model)).c_str(), image.name,
                      is_batch ? "batch" : "single", median(pair.rates[0]), median(pair.rates[1]),
                      median(pair.ratios), quantile(pair.ratios, 0.1), quantile(pair.ratios, 0.9));
          std::fflush(stdout);
        }
      }
    }
  }
  std::printf("%s, %s, %d thread(s), %d repetitions: gains %s\n", cpu_name().c_str(),
              std::string(camel->isa()).c_str(), options.num_threads, options.repetitions,
              agree ? "agree in all bits" : "DIFFER");
  return agree ? 0 : 1;
}

}  // namespace viewgain::bench
