// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0

// Programs that were compiled with an older header run with this library.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "first_header.hpp"
#include "status.hpp"
#include "viewgain/viewgain.h"

namespace {

using namespace viewgain::c_api;

// Today's struct begins as the first one and may be told from it by its size.
template <typename First, typename Today>
void expect_grown_or_same(const char* name) {
  const auto& known = Sizes<Today>::known;
  EXPECT_EQ(known.front(), sizeof(First)) << name;
  EXPECT_EQ(known.back(), sizeof(Today)) << name;
  EXPECT_TRUE(std::is_sorted(known.begin(), known.end(), std::less_equal<>())) << name;
  EXPECT_EQ(alignof(First), alignof(Today)) << name;
}

int fields = 0;

#define SAME(type, field)                                                                  \
  ++fields;                                                                                \
  EXPECT_EQ(offsetof(first::type, field), offsetof(::type, field)) << #type "." << #field; \
  EXPECT_EQ(sizeof(first::type::field), sizeof(::type::field)) << #type "." << #field

TEST(CApiSizes, StructsBeginAsInTheFirstHeader) {
  expect_grown_or_same<first::vg_watch, ::vg_watch>("vg_watch");
  expect_grown_or_same<first::vg_sensor, ::vg_sensor>("vg_sensor");
  expect_grown_or_same<first::vg_grid_config, ::vg_grid_config>("vg_grid_config");
  expect_grown_or_same<first::vg_grid_info, ::vg_grid_info>("vg_grid_info");
  expect_grown_or_same<first::vg_integrator_config, ::vg_integrator_config>("vg_integrator_config");
  expect_grown_or_same<first::vg_integration_report, ::vg_integration_report>("report");
  expect_grown_or_same<first::vg_scene_config, ::vg_scene_config>("vg_scene_config");
  expect_grown_or_same<first::vg_evaluator_config, ::vg_evaluator_config>("vg_evaluator_config");
  expect_grown_or_same<first::vg_evaluator_info, ::vg_evaluator_info>("vg_evaluator_info");
  expect_grown_or_same<first::vg_view_gain, ::vg_view_gain>("vg_view_gain");
  expect_grown_or_same<first::vg_contribution, ::vg_contribution>("vg_contribution");
  expect_grown_or_same<first::vg_feasibility_config, ::vg_feasibility_config>("feasibility");
  EXPECT_EQ(sizeof(first::vg_weight_region), sizeof(::vg_weight_region));

  fields = 0;
  SAME(vg_watch, poll);
  SAME(vg_watch, user);
  SAME(vg_sensor, width);
  SAME(vg_sensor, cy);
  SAME(vg_sensor, distortion);
  SAME(vg_sensor, max_range);
  SAME(vg_sensor, working_distance);
  SAME(vg_sensor, noise_model);
  SAME(vg_sensor, noise);
  SAME(vg_grid_config, voxel_size);
  SAME(vg_grid_config, box_max);
  SAME(vg_grid_config, T_world_grid);
  SAME(vg_grid_config, prior_sigma);
  SAME(vg_grid_info, dims);
  SAME(vg_grid_info, prior_sigma);
  SAME(vg_grid_info, T_world_grid);
  SAME(vg_grid_info, occupied);
  SAME(vg_grid_info, views);
  SAME(vg_grid_info, bytes);
  SAME(vg_grid_info, entropy_removed);
  SAME(vg_integrator_config, carve);
  SAME(vg_integrator_config, occupancy);
  SAME(vg_integrator_config, num_threads);
  SAME(vg_integrator_config, support_plane);
  SAME(vg_integration_report, readings);
  SAME(vg_integration_report, invalid);
  SAME(vg_integration_report, voxels_crossed);
  SAME(vg_scene_config, num_threads);
  SAME(vg_scene_config, boxes);
  SAME(vg_scene_config, box_count);
  SAME(vg_scene_config, vertices);
  SAME(vg_scene_config, triangles);
  SAME(vg_scene_config, triangle_count);
  SAME(vg_weight_region, weight);
  SAME(vg_evaluator_config, criterion);
  SAME(vg_evaluator_config, pixel_stride);
  SAME(vg_evaluator_config, num_threads);
  SAME(vg_evaluator_config, prior_sigma);
  SAME(vg_evaluator_config, max_range);
  SAME(vg_evaluator_config, weights);
  SAME(vg_evaluator_config, weight_count);
  SAME(vg_evaluator_info, image_height);
  SAME(vg_evaluator_info, rays_per_pose);
  SAME(vg_evaluator_info, num_threads);
  SAME(vg_evaluator_info, prior_sigma);
  SAME(vg_view_gain, posterior_entropy);
  SAME(vg_view_gain, occupied_voxels);
  SAME(vg_view_gain, status);
  SAME(vg_contribution, voxel);
  SAME(vg_contribution, rays);
  SAME(vg_contribution, gain);
  SAME(vg_feasibility_config, body_size);
  SAME(vg_feasibility_config, has_flange);
  SAME(vg_feasibility_config, T_flange_camera);
  SAME(vg_feasibility_config, support_plane);
  SAME(vg_feasibility_config, taken_angle);
  SAME(vg_feasibility_config, sensor);
  SAME(vg_feasibility_config, max_near_share);
  SAME(vg_feasibility_config, reachable);
  SAME(vg_feasibility_config, user);
  EXPECT_EQ(fields, 60);
}

// A struct of the first header as a program of its time has it, with what lies behind it.
template <typename First, typename Today>
struct Old {
  First value{};
  std::array<unsigned char, 64> behind{};

  Old() { behind.fill(0xA5); }
  [[nodiscard]] Today* get() { return reinterpret_cast<Today*>(&value); }
  [[nodiscard]] bool is_whole() const {
    return std::all_of(behind.begin(), behind.end(), [](unsigned char c) { return c == 0xA5; });
  }
};

TEST(CApiSizes, AProgramOfTheFirstHeaderGetsTheSame) {
  Old<first::vg_sensor, ::vg_sensor> sensor;
  vg_sensor_init(sensor.get(), sizeof sensor.value);
  ASSERT_EQ(vg_sensor_preset("laser_line", sensor.get()), VG_OK) << vg_last_error();
  EXPECT_GT(sensor.value.fx, 0);

  Old<first::vg_grid_config, ::vg_grid_config> layout;
  vg_grid_config_init(layout.get(), sizeof layout.value);
  EXPECT_EQ(layout.value.T_world_grid[15], 1);
  layout.value.voxel_size = 0.05;
  layout.value.prior_sigma = 0.02;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    layout.value.box_min[axis] = -0.4;
    layout.value.box_max[axis] = 0.4;
  }
  vg_grid* grid = nullptr;
  ASSERT_EQ(vg_grid_create(layout.get(), &grid), VG_OK) << vg_last_error();

  Old<first::vg_integrator_config, ::vg_integrator_config> how;
  vg_integrator_config_init(how.get(), sizeof how.value);
  EXPECT_TRUE(std::isnan(how.value.support_plane));
  vg_integrator* integrator = nullptr;
  ASSERT_EQ(vg_integrator_create(sensor.get(), how.get(), &integrator), VG_OK) << vg_last_error();
  const std::vector<float> depth(static_cast<std::size_t>(sensor.value.width * sensor.value.height),
                                 0.5F);
  std::array<double, 16> pose{};
  const std::array<double, 3> eye{0, -0.6, 0}, target{};
  ASSERT_EQ(vg_look_at(eye.data(), target.data(), nullptr, pose.data()), VG_OK);
  Old<first::vg_integration_report, ::vg_integration_report> report;
  vg_integration_report_init(report.get(), sizeof report.value);
  ASSERT_EQ(vg_integrate(integrator, grid, depth.data(), nullptr, pose.data(), report.get()), VG_OK)
      << vg_last_error();
  EXPECT_GT(report.value.readings, 0U);

  Old<first::vg_grid_info, ::vg_grid_info> info;
  vg_grid_info_init(info.get(), sizeof info.value);
  ASSERT_EQ(vg_grid_get_info(grid, info.get()), VG_OK) << vg_last_error();
  EXPECT_EQ(info.value.dims[0], 16);
  EXPECT_EQ(info.value.views, 1U);

  Old<first::vg_scene_config, ::vg_scene_config> obstacles;
  vg_scene_config_init(obstacles.get(), sizeof obstacles.value);
  vg_scene* scene = nullptr;
  ASSERT_EQ(vg_scene_build(grid, obstacles.get(), &scene), VG_OK) << vg_last_error();
  Old<first::vg_evaluator_config, ::vg_evaluator_config> settings;
  vg_evaluator_config_init(settings.get(), sizeof settings.value);
  EXPECT_EQ(settings.value.pixel_stride, 1);
  vg_evaluator *evaluator = nullptr, *plain = nullptr;
  ASSERT_EQ(vg_evaluator_create(scene, sensor.get(), settings.get(), &evaluator), VG_OK);
  ASSERT_EQ(vg_evaluator_create(scene, sensor.get(), nullptr, &plain), VG_OK);
  Old<first::vg_evaluator_info, ::vg_evaluator_info> size;
  vg_evaluator_info_init(size.get(), sizeof size.value);
  ASSERT_EQ(vg_evaluator_get_info(evaluator, size.get()), VG_OK) << vg_last_error();
  EXPECT_EQ(size.value.rays_per_pose, depth.size());

  constexpr std::size_t count = 5;
  std::vector<double> poses(16 * count), gains(count);
  ASSERT_EQ(vg_sphere_poses(count, 0.8, target.data(), poses.data()), VG_OK);
  ASSERT_EQ(vg_evaluate(plain, poses.data(), count, gains.data(), nullptr), VG_OK);
  Old<first::vg_watch, ::vg_watch> watch;
  vg_watch_init(watch.get(), sizeof watch.value);
  std::size_t told = 0;
  watch.value.user = &told;
  watch.value.poll = [](std::size_t, std::size_t total, void* user) {
    *static_cast<std::size_t*>(user) = total;
    return std::int32_t{0};
  };
  Old<std::array<first::vg_view_gain, count>, ::vg_view_gain> views;
  ASSERT_EQ(vg_evaluate_views(evaluator, poses.data(), count, views.get(),
                              sizeof(first::vg_view_gain), watch.get()),
            VG_OK)
      << vg_last_error();
  EXPECT_EQ(told, count);
  for (std::size_t i = 0; i < count; ++i) EXPECT_EQ(views.value[i].gain, gains[i]) << i;
  EXPECT_GT(*std::max_element(gains.begin(), gains.end()), 0);

  Old<std::array<first::vg_contribution, 3>, ::vg_contribution> parts;
  std::size_t found = 0;
  ASSERT_EQ(vg_contributions(evaluator, poses.data(), parts.get(), sizeof(first::vg_contribution),
                             3, &found),
            VG_OK)
      << vg_last_error();
  ASSERT_GE(found, 3U);
  EXPECT_GE(parts.value[0].gain, parts.value[2].gain);
  EXPECT_GT(parts.value[2].gain, 0);

  Old<first::vg_feasibility_config, ::vg_feasibility_config> body;
  vg_feasibility_config_init(body.get(), sizeof body.value);
  EXPECT_EQ(body.value.body_size[2], 0.076);
  EXPECT_LT(sizeof body.value, sizeof(::vg_feasibility_config));  // which has grown since
  body.value.sensor = &sensor.value;
  vg_feasibility* feasibility = nullptr;
  ASSERT_EQ(vg_feasibility_create(scene, body.get(), &feasibility), VG_OK) << vg_last_error();
  std::array<std::int32_t, count> reasons{};
  ASSERT_EQ(vg_feasibility_check(feasibility, poses.data(), count, nullptr, 0, reasons.data()),
            VG_OK);
  EXPECT_EQ(reasons[0], VG_FEASIBLE);

  EXPECT_TRUE(sensor.is_whole() && layout.is_whole() && how.is_whole() && report.is_whole() &&
              info.is_whole() && obstacles.is_whole() && settings.is_whole() && size.is_whole() &&
              watch.is_whole() && views.is_whole() && parts.is_whole() && body.is_whole());
  vg_feasibility_release(feasibility);
  vg_evaluator_release(plain);
  vg_evaluator_release(evaluator);
  vg_scene_release(scene);
  vg_integrator_release(integrator);
  vg_grid_release(grid);
}

}  // namespace

// A struct that has grown twice.
struct grown {
  std::size_t struct_size;
  double first;
  double second;
  double third;
};

template <>
struct viewgain::c_api::Sizes<grown> {
  static constexpr std::array known{offsetof(grown, second), offsetof(grown, third), sizeof(grown)};
};
template <>
grown viewgain::c_api::defaults() noexcept {
  return {.struct_size = 0, .first = 1, .second = 2, .third = 3};
}

namespace {

TEST(CApiSizes, WhatASmallerStructLacksHasItsDefault) {
  std::size_t cases = 0;
  for (const std::size_t size : Sizes<grown>::known) {
    std::array<double, 4> memory{};
    memory.fill(7);
    auto* own = reinterpret_cast<grown*>(memory.data());
    initialise(own, size);
    for (std::size_t i = 1; i < 4; ++i) {
      EXPECT_EQ(memory[i], 8 * i < size ? static_cast<double>(i) : 7) << i << " of " << size;
      if (8 * i < size) memory[i] = 10 + static_cast<double>(i);
    }
    const grown whole = read_struct(own, "grown");
    EXPECT_EQ(whole.first, 11);
    EXPECT_EQ(whole.second, size > 16 ? 12 : 2);
    EXPECT_EQ(whole.third, size > 24 ? 13 : 3);
    write_struct(own, {.struct_size = 0, .first = 21, .second = 22, .third = 23});
    EXPECT_EQ(own->struct_size, size);
    for (std::size_t i = 1; i < 4; ++i) {
      EXPECT_EQ(memory[i], 8 * i < size ? 20 + static_cast<double>(i) : 7) << i << " of " << size;
    }
    ++cases;
  }
  EXPECT_EQ(cases, 3U);
}

TEST(CApiSizes, UnknownSizesAreRefusedWithBoth) {
  const auto message = [](std::size_t size) -> std::string {
    grown own{};
    own.struct_size = size;
    try {
      require_struct(&own, "grown");
    } catch (const viewgain::Error& error) {
      EXPECT_EQ(error.code(), viewgain::ErrorCode::invalid_argument);
      return error.what();
    }
    return "";
  };
  std::size_t refused = 0;
  for (std::size_t size = 0; size < 100; ++size) {
    if (size == 16 || size == 24 || size == 32) {
      EXPECT_EQ(message(size), "");
      continue;
    }
    EXPECT_NE(message(size).find("is " + std::to_string(size) + " bytes"), std::string::npos);
    EXPECT_NE(message(size).find("knows 16 and 24 and 32"), std::string::npos) << message(size);
    EXPECT_EQ(message(size).find("newer than the library") != std::string::npos, size > 32) << size;
    ++refused;
  }
  EXPECT_EQ(refused, 97U);
}

}  // namespace
