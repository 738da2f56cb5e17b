/* SPDX-FileCopyrightText: 2026 The viewgain authors
   SPDX-License-Identifier: Apache-2.0 */

/* Wrong use: each has its status and a message that names the value. */
#include <math.h>

#include "check.h"

static void of_sensors(void) {
  vg_sensor sensor, bad;
  double sigma;
  CHECK_REFUSED(vg_sensor_preset(NULL, &sensor), "name is null");
  CHECK_REFUSED(vg_sensor_preset("sr4000", NULL), "vg_sensor is null");
  vg_sensor_init(&sensor, 24); /* as if of a version that is not this one */
  CHECK_REFUSED(vg_sensor_preset("sr4000", &sensor), "is 24 bytes");
  vg_sensor_init(&sensor, sizeof sensor);
  CHECK_REFUSED(vg_sensor_preset("sr4001", &sensor), "sr4001");
  CHECK_OK(vg_sensor_preset("sr4000", &sensor));
  CHECK_REFUSED(vg_default_prior_sigma(0.1, NULL, &sigma), "vg_sensor is null");
  CHECK_REFUSED(vg_default_prior_sigma(0.1, &sensor, NULL), "sigma is null");
  CHECK_REFUSED(vg_default_prior_sigma(NAN, &sensor, &sigma), "nan");
  bad = sensor;
  bad.noise_model = 9;
  CHECK_REFUSED(vg_default_prior_sigma(0.1, &bad, &sigma), "noise_model is 9");
  bad = sensor;
  bad.noise_model = VG_NOISE_QUADRATIC;
  CHECK_REFUSED(vg_default_prior_sigma(0.1, &bad, &sigma), "noise[3] is 0.001");
  bad = sensor;
  bad.fx = -3;
  CHECK_REFUSED(vg_default_prior_sigma(0.1, &bad, &sigma), "fx");
  vg_sensor_init(NULL, sizeof sensor);
  vg_sensor_init(&bad, 0);
  CHECK(bad.fx == -3);
  vg_sensor_init(&bad, sizeof bad + 8); /* of another header: zeros and its size */
  CHECK(bad.fx == 0 && bad.struct_size == sizeof bad + 8);
  CHECK_REFUSED(vg_sensor_preset("sr4000", &bad), ", but in viewgain ");
}

static void of_grids(const char* folder) {
  const uint8_t labels[8] = {0, 1, 2, 0, 1, 2, 0, 3};
  const int32_t dims[3] = {2, 2, 2}, flat[3] = {2, 0, 2}, vast[3] = {2, 70000, 2};
  const double origin[3] = {0, 0, 0};
  vg_grid* grid = (vg_grid*)1;
  vg_grid* map = test_map();
  vg_grid_config config;
  vg_grid_info info;
  uint8_t states[8];
  const float log_odds = 1;
  size_t found;
  double point[3];
  char path[1024];
  FILE* file;

  CHECK_REFUSED(vg_grid_from_labels(NULL, dims, origin, 0.1, 0.1, &grid), "labels is null");
  CHECK(grid == NULL);
  CHECK_REFUSED(vg_grid_from_labels(labels, dims, origin, 0.1, 0.1, NULL), "grid is null");
  CHECK_REFUSED(vg_grid_from_labels(labels, flat, origin, 0.1, 0.1, &grid), "2 x 0 x 2");
  CHECK_REFUSED(vg_grid_from_labels(labels, vast, origin, 0.1, 0.1, &grid), "70000");
  CHECK_REFUSED(vg_grid_from_labels(labels, dims, origin, -1, 0.1, &grid), "-1");
  CHECK_REFUSED(vg_grid_from_labels(labels, dims, origin, 0.1, 0.1, &grid), "3");

  CHECK_REFUSED(vg_grid_create(NULL, &grid), "vg_grid_config is null");
  vg_grid_config_init(&config, sizeof config - 8);
  CHECK_REFUSED(vg_grid_create(&config, &grid), "vg_grid_config");
  vg_grid_config_init(&config, sizeof config);
  CHECK_REFUSED(vg_grid_create(&config, &grid), "voxel");
  config.voxel_size = config.prior_sigma = 0.1;
  config.box_max[0] = config.box_max[1] = 1;
  config.box_max[2] = -1;
  CHECK_REFUSED(vg_grid_create(&config, &grid), "workspace");
  config.box_max[2] = 1e5;
  CHECK_FAILS(vg_grid_create(&config, &grid), VG_CAPACITY, "1e+06 voxels along z");
  config.box_max[2] = 1;
  config.T_world_grid[12] = 4;
  CHECK_REFUSED(vg_grid_create(&config, &grid), "4 0 0 1");

  CHECK_REFUSED(vg_grid_load(NULL, &grid), "path is null");
  sprintf(path, "%.1000s/missing.vdb", folder);
  CHECK_FAILS(vg_grid_load(path, &grid), VG_IO, "missing.vdb");
  sprintf(path, "%.1000s/text.vdb", folder);
  file = fopen(path, "w");
  CHECK(file != NULL);
  if (file != NULL) {
    fputs("not a map", file);
    fclose(file);
  }
  CHECK_FAILS(vg_grid_load(path, &grid), VG_FORMAT, "text.vdb");
  CHECK_REFUSED(vg_grid_save(NULL, path), "grid is null");
  CHECK_FAILS(vg_grid_save(map, "/nonexistent/map.vdb"), VG_IO, "/nonexistent/map.vdb");
  CHECK_REFUSED(vg_grid_clone(NULL, &grid), "grid is null");
  CHECK_REFUSED(vg_grid_clone(map, NULL), "copy is null");
  CHECK_REFUSED(vg_grid_get_info(map, NULL), "vg_grid_info is null");
  info.struct_size = 3;
  CHECK_REFUSED(vg_grid_get_info(map, &info), "is 3 bytes");
  CHECK_REFUSED(vg_grid_states(map, states, 8), "8 states");
  CHECK_REFUSED(vg_grid_states(map, NULL, MAP_VOXELS), "states is null");
  CHECK_REFUSED(vg_grid_index_of(map, origin, 1, NULL), "voxels is null");
  CHECK_REFUSED(vg_grid_center(map, dims, 1, NULL), "centers is null");
  CHECK_REFUSED(vg_grid_set(map, dims, NULL, 1), "log_odds is null");
  CHECK_REFUSED(vg_grid_set(map, vast, &log_odds, 1), "workspace");
  CHECK_REFUSED(vg_grid_forget(map, point, NULL, NULL), "max is null");
  CHECK_REFUSED(vg_grid_scale(map, dims, 1, NULL), "scales is null");
  CHECK_REFUSED(vg_grid_resample(map, point, point, 4, NULL), "the scale must be in 0..3, not 4");
  CHECK_REFUSED(vg_grid_update_box(map, dims, dims, NULL, NULL), "labels is null");
  CHECK_REFUSED(vg_grid_update_box(map, vast, dims, states, NULL), "workspace");
  CHECK_REFUSED(vg_grid_occupied(map, NULL, NULL, 1, &found), "voxels is null");
  CHECK_REFUSED(vg_grid_hash(map, NULL), "hash is null");
  vg_grid_release(map);
}

static void of_frames(void) {
  vg_sensor sensor;
  vg_integrator_config config;
  vg_integrator* integrator = NULL;
  vg_integration_report report;
  vg_grid* map = test_map();
  vg_grid_info info;
  float depth[640] = {0};
  const double bad_sigma[2] = {0, -1};
  double pose[16] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};

  vg_sensor_init(&sensor, sizeof sensor);
  CHECK_OK(vg_sensor_preset("laser_line", &sensor));
  CHECK_REFUSED(vg_integrator_create(NULL, NULL, &integrator), "vg_sensor is null");
  CHECK_REFUSED(vg_integrator_create(&sensor, NULL, NULL), "integrator is null");
  vg_integrator_config_init(&config, sizeof config);
  config.carve = 2;
  CHECK_REFUSED(vg_integrator_create(&sensor, &config, &integrator), "carve is 2");
  config.carve = VG_CARVE_LINES;
  config.occupancy = -1;
  CHECK_REFUSED(vg_integrator_create(&sensor, &config, &integrator), "occupancy is -1");
  config.occupancy = VG_OCCUPANCY_LITERAL;
  config.num_threads = -4;
  CHECK_REFUSED(vg_integrator_create(&sensor, &config, &integrator), "-4");
  config.num_threads = 1;
  CHECK_OK(vg_integrator_create(&sensor, &config, &integrator));
  CHECK_REFUSED(vg_integrate(NULL, map, depth, NULL, pose, NULL, NULL), "integrator is null");
  CHECK_REFUSED(vg_integrate(integrator, map, depth, NULL, NULL, NULL, NULL),
                "T_world_camera is null");
  report.struct_size = 0;
  CHECK_REFUSED(vg_integrate(integrator, map, depth, NULL, pose, NULL, &report),
                "vg_integration_report");
  CHECK_REFUSED(vg_integrate(integrator, map, depth, NULL, pose, bad_sigma, NULL),
                "pose_sigma must be at least 0 and finite, not -1");
  pose[0] = NAN;
  CHECK_REFUSED(vg_integrate(integrator, map, depth, NULL, pose, NULL, NULL), "pose");
  pose[0] = 1;
  pose[14] = 0.5; /* a matrix column by column */
  CHECK_REFUSED(vg_integrate(integrator, map, depth, NULL, pose, NULL, NULL), "0 0 0.5 1");
  vg_grid_info_init(&info, sizeof info);
  CHECK_OK(vg_grid_get_info(map, &info));
  CHECK(info.views == 0);
  vg_integrator_release(integrator);
  vg_integrator_release(NULL);
  vg_grid_release(map);
}

static void of_scenes(vg_grid* map, vg_scene* scene) {
  vg_scene_config config;
  vg_scene* other = NULL;
  vg_feasibility_config body;
  vg_feasibility *checker = NULL, *following = NULL;
  int32_t reason;
  const double inside_out[6] = {1, 1, 1, 0, 0, 0};
  const double point[3] = {0, 0, 0};
  const uint32_t triangle[3] = {0, 1, 2};

  CHECK_REFUSED(vg_scene_build(NULL, NULL, &other), "grid is null");
  CHECK_REFUSED(vg_scene_build(map, NULL, NULL), "scene is null");
  vg_scene_config_init(&config, sizeof config);
  config.box_count = 1;
  CHECK_REFUSED(vg_scene_build(map, &config, &other), "boxes is null");
  config.boxes = inside_out;
  CHECK_REFUSED(vg_scene_build(map, &config, &other), "box");
  config.box_count = 0;
  config.vertices = point;
  config.vertex_count = 1;
  config.triangles = triangle;
  config.triangle_count = 1;
  CHECK_REFUSED(vg_scene_build(map, &config, &other), "vertex 1, but the mesh has 1 vertices");
  config.struct_size = 0;
  CHECK_REFUSED(vg_scene_build(map, &config, &other), "vg_scene_config");
  CHECK_REFUSED(vg_scene_update(NULL, map, 1, &other), "before is null");
  CHECK_REFUSED(vg_scene_update(scene, NULL, 1, &other), "grid is null");

  CHECK_REFUSED(vg_feasibility_create(NULL, NULL, &checker), "scene is null");
  vg_feasibility_config_init(&body, sizeof body);
  body.clearance = -0.5;
  CHECK_REFUSED(vg_feasibility_create(scene, &body, &checker), "clearance");
  body.clearance = 0;
  body.has_flange = 1;
  body.T_flange_camera[13] = 1;
  CHECK_REFUSED(vg_feasibility_create(scene, &body, &checker), "0 1 0 1");
  CHECK_OK(vg_feasibility_create(scene, NULL, &checker));
  CHECK_REFUSED(vg_feasibility_check(NULL, point, 0, NULL, 0, &reason), "feasibility is null");
  CHECK_REFUSED(vg_feasibility_check(checker, NULL, 1, NULL, 0, &reason), "poses is null");
  CHECK_REFUSED(vg_feasibility_check(checker, NULL, 0, NULL, 2, NULL), "taken is null");
  CHECK_REFUSED(vg_feasibility_with_scene(checker, scene, NULL), "following is null");
  CHECK_OK(vg_feasibility_with_scene(checker, scene, &following));
  vg_feasibility_release(following);
  vg_feasibility_release(checker);
  vg_feasibility_release(NULL);
}

static void of_evaluators(const vg_scene* scene) {
  vg_sensor sensor;
  vg_evaluator_config config;
  vg_evaluator *evaluator = NULL, *other = NULL;
  vg_evaluator_info info;
  vg_watch watch;
  vg_view_gain view;
  vg_contribution part;
  float depth[640];
  size_t index, found;
  double gain;
  double pose[16] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};

  vg_sensor_init(&sensor, sizeof sensor);
  CHECK_REFUSED(vg_evaluator_create(scene, &sensor, NULL, &evaluator), "width");
  CHECK_OK(vg_sensor_preset("laser_line", &sensor));
  CHECK_REFUSED(vg_evaluator_create(NULL, &sensor, NULL, &evaluator), "scene is null");
  CHECK_REFUSED(vg_evaluator_create(scene, &sensor, NULL, NULL), "evaluator is null");
  vg_evaluator_config_init(&config, sizeof config);
  config.criterion = 3;
  CHECK_REFUSED(vg_evaluator_create(scene, &sensor, &config, &evaluator), "criterion is 3");
  config.criterion = VG_LOG_DETERMINANT;
  config.pixel_stride = 0;
  CHECK_REFUSED(vg_evaluator_create(scene, &sensor, &config, &evaluator),
                "stride must be at least 1, not 0");
  config.pixel_stride = 1;
  config.tracer = 3;
  CHECK_REFUSED(vg_evaluator_create(scene, &sensor, &config, &evaluator), "tracer is 3");
  config.tracer = VG_TRACER_EMBREE;
  config.weight_count = 1;
  CHECK_REFUSED(vg_evaluator_create(scene, &sensor, &config, &evaluator), "weights is null");
  config.weight_count = 0;
  config.prior_sigma = 0;
  CHECK_REFUSED(vg_evaluator_create(scene, &sensor, &config, &evaluator), "prior sigma is 0");
  CHECK(evaluator == NULL);
  CHECK_OK(vg_evaluator_create(scene, &sensor, NULL, &evaluator));

  CHECK_REFUSED(vg_evaluator_with_scene(evaluator, scene, NULL), "following is null");
  CHECK_OK(vg_evaluator_with_scene(evaluator, scene, &other));
  vg_evaluator_release(other);
  CHECK_REFUSED(vg_evaluate(NULL, pose, 1, &gain, NULL), "evaluator is null");
  CHECK_REFUSED(vg_evaluate(evaluator, pose, 1, NULL, NULL), "gains is null");
  CHECK_FAILS(vg_evaluate(evaluator, pose, SIZE_MAX / 4, &gain, NULL), VG_OUT_OF_MEMORY, "count");
  CHECK_FAILS(vg_best(evaluator, pose, SIZE_MAX / 4, 1, &index, NULL, &found, NULL),
              VG_OUT_OF_MEMORY, "count");
  vg_watch_init(&watch, sizeof watch);
  CHECK_REFUSED(vg_evaluate(evaluator, pose, 1, &gain, &watch), "poll");
  watch.struct_size = 1;
  CHECK_REFUSED(vg_evaluate(evaluator, pose, 1, &gain, &watch), "vg_watch");
  CHECK_REFUSED(vg_evaluate_views(evaluator, pose, 1, &view, 8, NULL), "is 8 bytes");
  CHECK_REFUSED(vg_best(evaluator, pose, 1, 1, &index, NULL, NULL, NULL), "found is null");
  CHECK_REFUSED(vg_race(NULL, pose, 1, 1, HUGE_VAL, 1, &index, NULL, &found, NULL),
                "evaluator is null");
  CHECK_REFUSED(vg_best_set(evaluator, NULL, 1, 1, &index, NULL, &found, NULL), "poses is null");
  CHECK_REFUSED(vg_depth_image(evaluator, pose, depth, NULL, 7), "7 pixels");
  CHECK_REFUSED(vg_contributions(evaluator, pose, &part, 1, 1, &found), "vg_contribution");
  info.struct_size = 1;
  CHECK_REFUSED(vg_evaluator_get_info(evaluator, &info), "vg_evaluator_info");

  /* Bad poses: NaN in a batch, an error where there is only the one. */
  pose[5] = 3;
  CHECK_OK(vg_evaluate(evaluator, pose, 1, &gain, NULL));
  CHECK(isnan(gain));
  CHECK_REFUSED(vg_depth_image(evaluator, pose, depth, NULL, 640), "deviates from");
  CHECK_REFUSED(vg_contributions(evaluator, pose, &part, sizeof part, 1, &found), "by 8;");
  pose[5] = 1;
  pose[12] = 1;
  CHECK_OK(vg_evaluate(evaluator, pose, 1, &gain, NULL));
  CHECK(isnan(gain));
  CHECK_REFUSED(vg_depth_image(evaluator, pose, depth, NULL, 640), "1 0 0 1");
  vg_evaluator_release(evaluator);
  vg_evaluator_release(NULL);
}

static void of_poses(void) {
  const double center[3] = {0, 0, 0};
  double pose[16];
  const double below[2] = {0, -1}; /* the last row is the start's */
  size_t stop = 0;
  CHECK_REFUSED(vg_sphere_poses(1, -1, center, pose), "-1");
  CHECK_REFUSED(vg_sphere_poses(0, 1, center, pose), "0");
  CHECK_REFUSED(vg_sphere_poses(1, 1, NULL, pose), "center is null");
  CHECK_FAILS(vg_dome_poses((size_t)1 << 40, 1, center, pose), VG_CAPACITY, "1099511627776");
  CHECK_REFUSED(vg_look_at(center, center, NULL, pose), "eye");
  CHECK_REFUSED(vg_look_at(NULL, center, NULL, pose), "eye is null");
  CHECK_REFUSED(vg_order_stops(NULL, 1, &stop, NULL), "costs is null");
  CHECK_REFUSED(vg_order_stops(below, 1, &stop, NULL), "from the start to 0 is -1");
}

static void of_range_calibrations(void) {
  vg_sensor sensor;
  const double good[2] = {1, 0.01};
  const double falling[2][2] = {{2, 0}, {1, 0}};
  const struct {
    const double* table;
    size_t rows;
    const char* part;
  } bad[] = {{NULL, 0, "rows must be at least 1, not 0"},
             {good, 0, "rows must be at least 1, not 0"},
             {NULL, 2, "table is null"},
             {falling[0], 2, "must increase, but 1 m follows 2 m"}};
  vg_sensor other;
  float depth[1] = {1};
  vg_range_calibration* calibration;
  size_t i;
  vg_sensor_init(&sensor, sizeof sensor);
  CHECK_OK(vg_sensor_preset("sr4000", &sensor));
  for (i = 0; i < sizeof bad / sizeof bad[0]; ++i) {
    calibration = (vg_range_calibration*)1;
    CHECK_FAILS(vg_range_calibration_create(&sensor, bad[i].table, bad[i].rows, &calibration),
                VG_INVALID_ARGUMENT, bad[i].part);
    CHECK(calibration == NULL);
  }
  CHECK_REFUSED(vg_range_calibration_create(NULL, good, 1, &calibration), "vg_sensor is null");
  CHECK_REFUSED(vg_range_calibration_create(&sensor, good, 1, NULL), "calibration is null");
  other = sensor;
  other.fx = NAN;
  CHECK_REFUSED(vg_range_calibration_create(&other, good, 1, &calibration), "fx");
  other = sensor;
  other.struct_size = 3;
  CHECK_REFUSED(vg_range_calibration_create(&other, good, 1, &calibration), "is 3 bytes");
  CHECK_OK(vg_range_calibration_create(&sensor, good, 1, &calibration));
  CHECK_REFUSED(vg_range_calibration_correct(NULL, depth), "calibration is null");
  CHECK_REFUSED(vg_range_calibration_correct(calibration, NULL), "depth is null");
  CHECK(depth[0] == 1);
  vg_range_calibration_release(calibration);
}

void misuse_everything(const char* folder) {
  vg_grid* map = test_map();
  vg_scene* scene = NULL;
  CHECK_OK(vg_scene_build(map, NULL, &scene));
  of_sensors();
  of_grids(folder);
  of_frames();
  of_scenes(map, scene);
  of_evaluators(scene);
  of_poses();
  of_range_calibrations();
  vg_grid_release(map);
  vg_scene_release(scene);
  vg_scene_release(NULL);
}
