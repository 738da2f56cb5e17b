// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: GPL-3.0-or-later

// One thread means one thread: counts the threads that the parts of the loop begin. Ours are
// std::threads, begun in the C++ library; what Embree's TBB keeps for itself is not counted.
#include <dlfcn.h>
#include <gtest/gtest.h>
#include <pthread.h>

#include <atomic>
#include <cstring>
#include <memory>

#include "apps/planner/planner_scene.hpp"
#include "viewgain/planner_mesh/candidate_generation.hpp"
#include "viewgain/planner_mesh/policies.hpp"
#include "viewgain/planner_mesh/truth.hpp"

namespace {

std::atomic<int> begun = 0;

}  // namespace

// Stands before the C library's for the whole process.
extern "C" int pthread_create(pthread_t* thread, const pthread_attr_t* attributes,
                              void* (*function)(void*), void* argument) noexcept {
  using Create = int (*)(pthread_t*, const pthread_attr_t*, void* (*)(void*), void*);
  static const auto next = reinterpret_cast<Create>(dlsym(RTLD_NEXT, "pthread_create"));
  Dl_info caller{};
  if (dladdr(__builtin_return_address(0), &caller) != 0 && caller.dli_fname != nullptr &&
      std::strstr(caller.dli_fname, "libstdc++") != nullptr) {
    ++begun;
  }
  return next(thread, attributes, function, argument);
}

namespace viewgain {
namespace {

// Begun while a view goes into the model, candidates are proposed and one is chosen.
int threads_begun(int num_threads) {
  const Sensor sensor = test::half_sr4000();
  const auto mesh = std::make_shared<const SurfaceScene>(test::cube_mesh(0.1), ExecConfig{1});
  const SimulatedSensor camera(mesh, sensor, {}, ExecConfig{1});
  const Pose view = look_at({0.4, 0.1, 0.3}, {0, 0, 0});
  const Measurements measurements{view, {camera.acquire(view, 0)}};

  const int before = begun;
  const ExecConfig exec{num_threads};
  VisibilityConfig visibility;
  visibility.distance = 0.4;
  visibility.start = view;
  const auto truth = std::make_shared<const Truth>(mesh, sensor, visibility, exec);
  SurfaceModel model(sensor, test::model_config(sensor, 0.15, 0.005), truth, exec);
  (void)model.update(measurements);
  GenerationConfig config = default_generation(sensor, 0.005);
  config.boundary.classes_by_sight = true;
  CandidateGeneration generation(model, config, exec);
  const Proposal proposal = generation.generate(view);
  EXPECT_FALSE(proposal.candidates.empty());
  PolicyDecision decision(model, generation, sensor, {}, exec);
  EXPECT_TRUE(decision.decide(view, proposal.candidates).has_value());
  return begun - before;
}

TEST(Threads, OneIsTheCallersOwn) { EXPECT_EQ(threads_begun(1), 0); }

TEST(Threads, ThreeAreMore) { EXPECT_GT(threads_begun(3), 0); }

}  // namespace
}  // namespace viewgain
