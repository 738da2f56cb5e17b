/* SPDX-FileCopyrightText: 2026 The viewgain authors
   SPDX-License-Identifier: Apache-2.0 */

/* gain.cpp in C99. */
#include <stdio.h>
#include <viewgain/viewgain.h>

int main(void) {
  static uint8_t labels[8 * 8 * 8]; /* [x][y][z], the lowest layer unknown, the rest free */
  const int32_t dims[3] = {8, 8, 8};
  const double origin[3] = {-0.2, -0.2, -0.2}, eye[3] = {0.013, 0.007, 0.6}, target[3] = {0, 0, 0};
  vg_sensor sensor;
  vg_grid* grid = NULL;
  vg_scene* scene = NULL;
  vg_evaluator* evaluator = NULL;
  double T_world_camera[16], gain;
  size_t i;
  for (i = 0; i < sizeof labels; ++i) labels[i] = i % 8 > 0;
  vg_sensor_init(&sensor, sizeof sensor);
  if (vg_sensor_preset("sr4000", &sensor) || vg_look_at(eye, target, NULL, T_world_camera) ||
      vg_grid_from_labels(labels, dims, origin, 0.05, 0.025, &grid) ||
      vg_scene_build(grid, NULL, &scene) || vg_evaluator_create(scene, &sensor, NULL, &evaluator) ||
      vg_evaluate(evaluator, T_world_camera, 1, &gain, NULL)) {
    fprintf(stderr, "%s\n", vg_last_error());
  } else {
    printf("%.17g\n", gain);
  }
  vg_evaluator_release(evaluator);
  vg_scene_release(scene);
  vg_grid_release(grid);
  return 0;
}
