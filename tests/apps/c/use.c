/* SPDX-FileCopyrightText: 2026 The viewgain authors
   SPDX-License-Identifier: Apache-2.0 */

/* What the functions do when they are used as they should be. */
#include <math.h>
#include <stdlib.h>

#include "check.h"

enum { POSES = 60 };

static double poses[16 * POSES];
static const double kCenter[3] = {0, 0, -0.1};

/* Ends a call once `user`, a count of calls, has come down to 0. */
static int32_t stop_after(size_t done, size_t total, void* user) {
  int* left = (int*)user;
  return done <= total && (*left)-- <= 0;
}

/* Of an empty map: a wall in a free box, once and once more. */
static void check_update_box(vg_grid* map) {
  const int32_t first[3] = {2, 3, 4}, dims[3] = {3, 2, 5}, outside[3] = {MAP_EDGE - 2, 0, 0};
  uint8_t labels[30];
  uint64_t changed = 0;
  vg_grid_info info;
  memset(labels, 1, sizeof labels);
  memset(labels, 2, 10);
  vg_grid_info_init(&info, sizeof info);
  CHECK_OK(vg_grid_update_box(map, first, dims, labels, &changed));
  CHECK_OK(vg_grid_get_info(map, &info));
  CHECK(changed == 30 && info.occupied == 10 && info.free == 20);
  labels[0] = 0;
  CHECK_OK(vg_grid_update_box(map, first, dims, labels, &changed));
  CHECK(changed == 1);
  CHECK_OK(vg_grid_update_box(map, first, dims, labels, NULL));
  labels[7] = 3;
  CHECK(vg_grid_update_box(map, first, dims, labels, NULL) == VG_INVALID_ARGUMENT);
  CHECK(vg_grid_update_box(map, outside, dims, labels, NULL) == VG_INVALID_ARGUMENT);
}

static void sensors_and_grids(const char* folder) {
  vg_sensor sensor;
  vg_grid_config config;
  vg_grid_info info;
  vg_grid *grid = test_map(), *copy = NULL, *loaded = NULL, *empty = NULL;
  uint8_t* states = malloc(MAP_VOXELS);
  char path[1024], hash[17], loaded_hash[17];
  double sigma = 0, center[3];
  const double points[2][3] = {{-0.19, 0.19, -0.0875}, {1, 0, 0}};
  int32_t voxels[2][3];
  float log_odds[2] = {2, 2};
  const double nowhere[3] = {-INFINITY, -INFINITY, -INFINITY};
  const double everywhere[3] = {INFINITY, INFINITY, INFINITY};
  uint64_t forgotten = 0;
  uint8_t scales[2];
  size_t found = 0;

  vg_sensor_init(&sensor, sizeof sensor);
  CHECK(sensor.struct_size == sizeof sensor && sensor.width == 0);
  CHECK_OK(vg_sensor_preset("kinect_v1", &sensor));
  CHECK(sensor.width == 640 && sensor.fx == 585 && sensor.noise_model == VG_NOISE_STRUCTURED_LIGHT);
  CHECK_OK(vg_sensor_preset("sr4000", &sensor));
  CHECK(sensor.width == 176 && sensor.noise[0] == 4e-3 && sensor.max_range == 5);
  CHECK_OK(vg_default_prior_sigma(0.1, &sensor, &sigma));
  CHECK(sigma == 0.05);

  vg_grid_info_init(&info, sizeof info);
  CHECK_OK(vg_grid_get_info(grid, &info));
  CHECK(info.dims[0] == MAP_EDGE && info.dims[2] == MAP_EDGE && info.min_index[1] == 0);
  CHECK(info.unknown == 4 * MAP_EDGE * MAP_EDGE);
  CHECK(info.unknown + info.free + info.occupied == MAP_VOXELS && info.occupied > 0);
  CHECK(info.T_world_grid[3] == -0.2 && info.T_world_grid[15] == 1 && info.voxel_size == 0.025);
  CHECK_OK(vg_grid_states(grid, states, MAP_VOXELS));
  CHECK(states[3] == 0 && states[4] == 2 && states[5] == 1);
  CHECK_OK(vg_grid_index_of(grid, points[0], 2, voxels[0]));
  CHECK(voxels[0][0] == 0 && voxels[0][1] == 15 && voxels[0][2] == 4);
  CHECK(voxels[1][0] == VG_NO_VOXEL && voxels[1][1] == VG_NO_VOXEL && voxels[1][2] == VG_NO_VOXEL);
  CHECK_OK(vg_grid_center(grid, voxels[0], 1, center));
  CHECK(fabs(center[0] + 0.1875) < 1e-12 && fabs(center[2] + 0.0875) < 1e-12);
  CHECK_OK(vg_grid_index_of(grid, NULL, 0, NULL));
  CHECK_OK(vg_grid_occupied(grid, NULL, NULL, 0, &found));
  CHECK_OK(vg_grid_get_info(grid, &info));
  CHECK(found == info.occupied && found > 50);
  CHECK_OK(vg_grid_clone(grid, &copy));
  CHECK_OK(vg_grid_set(copy, voxels[0], log_odds, 1));
  CHECK_OK(vg_grid_states(copy, states, MAP_VOXELS));
  CHECK(states[15 * MAP_EDGE + 4] == 2);
  CHECK_OK(vg_grid_occupied(copy, voxels[0], log_odds, 2, &found));
  CHECK(voxels[0][2] == 4 && voxels[1][2] == 4 && log_odds[1] > 0.8F);
  CHECK_OK(vg_grid_scale(copy, voxels[0], 2, scales));
  CHECK(scales[0] == 0 && scales[1] == 0);
  CHECK_OK(vg_grid_resample(copy, nowhere, everywhere, 1, &forgotten));
  CHECK_OK(vg_grid_scale(copy, voxels[0], 2, scales));
  CHECK(forgotten > 0 && scales[0] <= 1);
  CHECK_OK(vg_grid_resample(copy, nowhere, everywhere, 0, NULL));
  CHECK_OK(vg_grid_forget(copy, nowhere, everywhere, &forgotten));
  CHECK_OK(vg_grid_get_info(copy, &info));
  CHECK(forgotten > 50 && info.unknown == MAP_VOXELS && info.occupied == 0);
  CHECK_OK(vg_grid_forget(copy, nowhere, everywhere, NULL));
  check_update_box(copy);
  vg_grid_release(copy);

  CHECK_OK(vg_grid_hash(grid, hash));
  CHECK(strlen(hash) == 16);
  CHECK_OK(vg_grid_clone(grid, &copy));
  sprintf(path, "%.1000s/map.vdb", folder);
  CHECK_OK(vg_grid_save(copy, path));
  vg_grid_release(copy);
  CHECK_OK(vg_grid_load(path, &loaded));
  CHECK_OK(vg_grid_hash(loaded, loaded_hash));
  CHECK(strcmp(hash, loaded_hash) == 0);

  vg_grid_config_init(&config, sizeof config);
  CHECK(config.T_world_grid[0] == 1 && config.T_world_grid[1] == 0);
  config.voxel_size = 0.1;
  config.prior_sigma = 0.05;
  config.box_min[0] = config.box_min[1] = config.box_min[2] = -0.2;
  config.box_max[0] = config.box_max[1] = config.box_max[2] = 0.2;
  CHECK_OK(vg_grid_create(&config, &empty));
  CHECK_OK(vg_grid_get_info(empty, &info));
  CHECK(info.unknown == 64 && info.min_index[0] == -2);
  vg_grid_release(grid);
  vg_grid_release(empty);
  vg_grid_release(loaded);
  vg_grid_release(NULL);
  free(states);
}

/* A frame of a wall half a metre away; then a scene brought up to date. */
static void frames(void) {
  vg_sensor sensor;
  vg_grid* grid = test_map();
  vg_integrator_config config;
  vg_integrator* integrator = NULL;
  vg_integration_report report;
  vg_scene *before = NULL, *after = NULL;
  vg_evaluator *old_view = NULL, *new_view = NULL;
  vg_grid_info info;
  float* depth;
  double pose[16], gains[2];
  const double eye[3] = {0, 0, 0.4}, target[3] = {0, 0, 0};
  size_t i, pixels;

  vg_sensor_init(&sensor, sizeof sensor);
  CHECK_OK(vg_sensor_preset("sr4000", &sensor));
  pixels = (size_t)sensor.width * (size_t)sensor.height;
  depth = malloc(pixels * sizeof *depth);
  for (i = 0; i < pixels; ++i) depth[i] = 0.55f;
  depth[0] = 0.0f;
  depth[1] = (float)INFINITY;
  CHECK_OK(vg_look_at(eye, target, NULL, pose));
  CHECK(pose[11] == 0.4 && pose[10] == -1 && pose[15] == 1);

  vg_integrator_config_init(&config, sizeof config);
  config.num_threads = 1;
  CHECK_OK(vg_integrator_create(&sensor, &config, &integrator));
  CHECK_OK(vg_scene_build(grid, NULL, &before));
  vg_integration_report_init(&report, sizeof report);
  CHECK_OK(vg_integrate(integrator, grid, depth, NULL, pose, NULL, &report));
  CHECK(report.readings == pixels - 2 && report.invalid == 1 && report.out_of_range == 1);
  CHECK(report.voxels_hit > 0 && report.voxels_crossed > 0);
  CHECK_OK(vg_integrate(integrator, grid, depth, NULL, pose, NULL, NULL));
  vg_grid_info_init(&info, sizeof info);
  CHECK_OK(vg_grid_get_info(grid, &info));
  CHECK(info.views == 2 && info.entropy_removed > 0);

  CHECK_OK(vg_scene_update(before, grid, 1, &after));
  CHECK_OK(vg_evaluator_create(before, &sensor, NULL, &old_view));
  CHECK_OK(vg_evaluator_create(after, &sensor, NULL, &new_view));
  /* Released in an odd order: what is left goes on. */
  vg_grid_release(grid);
  vg_scene_release(after);
  vg_integrator_release(integrator);
  vg_scene_release(before);
  CHECK_OK(vg_evaluate(old_view, pose, 1, &gains[0], NULL));
  CHECK_OK(vg_evaluate(new_view, pose, 1, &gains[1], NULL));
  CHECK(gains[0] > gains[1] && gains[1] > 0);
  vg_evaluator_release(old_view);
  vg_evaluator_release(new_view);
  free(depth);
}

static void choices(const vg_evaluator* evaluator) {
  double gains[POSES], chosen[5], again[POSES];
  size_t indices[5], others[5], found = 99, i;
  /* From the camera to stop 1, then 0, then 2. */
  const double costs[4][3] = {{0, 9, 2}, {1, 0, 9}, {9, 9, 0}, {9, 3, 9}};
  vg_watch watch;
  int left = 1000;

  CHECK_OK(vg_evaluate(evaluator, poses, POSES, gains, NULL));
  CHECK(isnan(gains[7]) && gains[0] > 0);
  CHECK_OK(vg_best(evaluator, poses, POSES, 5, indices, chosen, &found, NULL));
  CHECK(found == 5 && chosen[0] == gains[indices[0]]);
  for (i = 0; i < POSES; ++i) CHECK(i == 7 || gains[i] <= chosen[0]);
  CHECK_OK(vg_best(evaluator, poses, 3, 5, indices, NULL, &found, NULL));
  CHECK(found == 3);
  CHECK_OK(vg_race(evaluator, poses, POSES, 1, HUGE_VAL, 1, others, chosen, &found, NULL));
  CHECK(found == 1 && chosen[0] == gains[others[0]]);
  CHECK_OK(vg_race(evaluator, poses, POSES, 2, 1e6, 1, others, chosen, &found, NULL));
  CHECK(found == 2 && chosen[0] == gains[others[0]]);
  CHECK_OK(vg_race(evaluator, poses, POSES, 2, 0, 1, others, NULL, &found, NULL));
  CHECK(found == 0);
  CHECK_REFUSED(vg_race(evaluator, poses, POSES, 2, -1, 1, others, NULL, &found, NULL), "deadline");
  CHECK_OK(vg_best_set(evaluator, poses, POSES, 3, others, chosen, &found, NULL));
  CHECK(found == 3 && chosen[0] == gains[others[0]] && others[0] != others[1]);
  CHECK_OK(vg_order_stops(&costs[0][0], 3, others, &chosen[0]));
  CHECK(others[0] == 1 && others[1] == 0 && others[2] == 2 && chosen[0] == 6);
  CHECK_OK(vg_order_stops(NULL, 0, NULL, NULL));
  CHECK_OK(vg_evaluate(evaluator, NULL, 0, NULL, NULL));
  CHECK_OK(vg_best(evaluator, NULL, 0, 0, NULL, NULL, &found, NULL));
  CHECK(found == 0);

  vg_watch_init(&watch, sizeof watch);
  watch.poll = stop_after;
  watch.user = &left;
  CHECK_OK(vg_evaluate(evaluator, poses, POSES, again, &watch));
  CHECK(left == 1000 - POSES - 1);
  for (i = 0; i < POSES; ++i) CHECK(i == 7 ? isnan(again[i]) : again[i] == gains[i]);
  left = 10;
  CHECK_FAILS(vg_evaluate(evaluator, poses, POSES, again, &watch), VG_STOPPED, "of 60 poses");
  for (found = 0, i = 0; i < POSES; ++i) found += isnan(again[i]) ? 0 : 1;
  /* Ten poses; the bad one is among them unless the thread that took it asked last. */
  CHECK(found == 9 || found == 10);
  left = 10;
  CHECK_FAILS(vg_best(evaluator, poses, POSES, 1, indices, NULL, &found, &watch), VG_STOPPED,
              "stopped by poll");
  left = 10;
  CHECK_FAILS(vg_race(evaluator, poses, POSES, 1, HUGE_VAL, 1, indices, NULL, &found, &watch),
              VG_STOPPED, "stopped by poll");
  left = 10;
  CHECK_FAILS(vg_best_set(evaluator, poses, POSES, 2, indices, NULL, &found, &watch), VG_STOPPED,
              "0 of 2");
  CHECK(found == 0);
}

static void looks(const vg_evaluator* evaluator) {
  vg_evaluator_info info;
  vg_view_gain views[POSES];
  vg_contribution* parts;
  float* depth;
  uint8_t* labels;
  size_t pixels, found, i, hits = 0, wrong = 0;
  double sum = 0;

  vg_evaluator_info_init(&info, sizeof info);
  CHECK_OK(vg_evaluator_get_info(evaluator, &info));
  CHECK(info.image_width == 88 && info.image_height == 72 && info.rays_per_pose == 88 * 72);
  CHECK(info.num_threads == 2 && info.prior_sigma == 0.01);
  pixels = (size_t)info.rays_per_pose;
  depth = malloc(pixels * sizeof *depth);
  labels = malloc(pixels);
  parts = malloc(pixels * sizeof *parts);

  CHECK_OK(vg_evaluate_views(evaluator, poses, POSES, views, sizeof views[0], NULL));
  CHECK(views[0].status == VG_VIEW_OK && views[7].status == VG_VIEW_BAD_POSE);
  CHECK(views[0].rays == pixels && views[0].hits > 100 && views[0].unknown_voxels > 0);
  CHECK(views[0].gain == views[0].exploration + views[0].refinement);
  CHECK_OK(vg_depth_image(evaluator, poses, depth, labels, pixels));
  for (i = 0; i < pixels; ++i) {
    if (labels[i] == VG_HIT_UNKNOWN || labels[i] == VG_HIT_OCCUPIED) ++hits;
    if ((labels[i] == VG_HIT_NONE) != (depth[i] > 1e30f)) ++wrong;
  }
  CHECK(hits == views[0].hits && wrong == 0);
  CHECK_OK(vg_depth_image(evaluator, poses, depth, NULL, pixels));

  CHECK_OK(vg_contributions(evaluator, poses, parts, sizeof parts[0], pixels, &found));
  CHECK(found == views[0].unknown_voxels + views[0].occupied_voxels);
  for (hits = 0, i = 0; i < found; ++i) {
    sum += parts[i].gain;
    hits += parts[i].rays;
  }
  CHECK(fabs(sum - views[0].gain) < 1e-9 * sum && hits == views[0].hits);
  CHECK(parts[0].gain >= parts[found - 1].gain && (parts[0].state == 0 || parts[0].state == 2));
  free(depth);
  free(labels);
  free(parts);
}

/* Only the half of space with y >= 0 can be reached. */
static int32_t is_reachable(const double T_world_camera[16], void* user) {
  __atomic_add_fetch((int*)user, 1, __ATOMIC_RELAXED); /* called by several threads */
  return T_world_camera[7] >= 0;
}

static void feasibility(const vg_grid* grid, const vg_scene* scene) {
  vg_feasibility_config config;
  vg_feasibility *checker = NULL, *under = NULL;
  vg_scene_config table;
  vg_scene* on_table = NULL;
  vg_sensor sensor;
  int32_t reasons[POSES];
  int calls = 0, i, possible = 0, unreachable = 0;

  CHECK_OK(vg_feasibility_create(scene, NULL, &checker));
  CHECK_OK(vg_feasibility_check(checker, poses, POSES, NULL, 0, reasons));
  CHECK(reasons[0] == VG_FEASIBLE && reasons[7] == VG_INFEASIBLE_BAD_POSE);
  CHECK_OK(vg_feasibility_check(checker, poses, 1, poses, 1, reasons));
  CHECK(reasons[0] == VG_INFEASIBLE_TAKEN);
  vg_scene_config_init(&table, sizeof table);
  table.support_plane = 1;
  CHECK_OK(vg_scene_build(grid, &table, &on_table));
  CHECK_OK(vg_feasibility_with_scene(checker, on_table, &under));
  CHECK_OK(vg_feasibility_check(under, poses, 1, NULL, 0, reasons));
  CHECK(reasons[0] == VG_INFEASIBLE_PLANE);
  vg_feasibility_release(under);
  vg_scene_release(on_table);
  vg_feasibility_release(checker);

  vg_sensor_init(&sensor, sizeof sensor);
  CHECK_OK(vg_sensor_preset("sr4000", &sensor));
  vg_feasibility_config_init(&config, sizeof config);
  CHECK(config.body_size[2] == 0.076 && config.taken_distance == 0.01);
  config.sensor = &sensor;
  config.reachable = is_reachable;
  config.user = &calls;
  CHECK_OK(vg_feasibility_create(scene, &config, &checker));
  CHECK_OK(vg_feasibility_check(checker, poses, POSES, NULL, 0, reasons));
  for (i = 0; i < POSES; ++i) {
    if (reasons[i] == VG_FEASIBLE) ++possible;
    if (reasons[i] == VG_INFEASIBLE_UNREACHABLE) ++unreachable;
  }
  CHECK(calls == POSES - 1 && possible > 0 && unreachable > 0);
  vg_feasibility_release(checker);
}

void use_everything(const char* folder) {
  vg_grid* grid = test_map();
  vg_scene_config around;
  vg_scene *scene = NULL, *walled = NULL;
  vg_sensor sensor;
  vg_evaluator_config config;
  vg_evaluator *evaluator = NULL, *blocked = NULL;
  vg_weight_region nothing = {{-1, -1, -1}, {1, 1, 1}, 0};
  const double wall[6] = {-1, -1, 0.25, 1, 1, 0.26};
  const double corners[9] = {-2, -2, -0.4, 2, -2, -0.4, 0, 4, -0.4};
  const uint32_t triangle[3] = {0, 1, 2};
  double from_above = 0, weightless = 1;

  sensors_and_grids(folder);
  frames();

  CHECK_OK(vg_sphere_poses(POSES, 0.7, kCenter, poses));
  CHECK_OK(vg_dome_poses(POSES, 0.7, kCenter, poses));
  poses[7 * 16 + 2] = NAN;
  CHECK_OK(vg_scene_build(grid, NULL, &scene));
  vg_sensor_init(&sensor, sizeof sensor);
  CHECK_OK(vg_sensor_preset("sr4000", &sensor));
  vg_evaluator_config_init(&config, sizeof config);
  CHECK(config.gain == VG_GAIN_COMBINED);
  config.gain = VG_GAIN_PAPER;
  config.pixel_stride = 2;
  config.num_threads = 2;
  CHECK_OK(vg_evaluator_create(scene, &sensor, &config, &evaluator));
  choices(evaluator);
  looks(evaluator);
  feasibility(grid, scene);

  vg_scene_config_init(&around, sizeof around);
  around.boxes = wall;
  around.box_count = 1;
  around.vertices = corners;
  around.vertex_count = 3;
  around.triangles = triangle;
  around.triangle_count = 1;
  CHECK_OK(vg_scene_build(grid, &around, &walled));
  CHECK_OK(vg_evaluator_create(walled, &sensor, NULL, &blocked));
  CHECK_OK(vg_evaluate(blocked, poses, 1, &from_above, NULL));
  CHECK(from_above == 0);
  vg_evaluator_release(blocked);
  config.weights = &nothing;
  config.weight_count = 1;
  config.criterion = VG_TRACE;
  CHECK_OK(vg_evaluator_create(scene, &sensor, &config, &blocked));
  CHECK_OK(vg_evaluate(blocked, poses, 1, &weightless, NULL));
  CHECK(weightless == 0);
  vg_evaluator_release(blocked);
  vg_evaluator_release(evaluator);
  vg_scene_release(walled);
  vg_scene_release(scene);
  vg_grid_release(grid);
}
