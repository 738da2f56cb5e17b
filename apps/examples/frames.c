/* A depth frame into a map, and where to look next, from C99. */
#include <math.h>
#include <stdio.h>
#include <viewgain/viewgain.h>

enum { kWidth = 176, kHeight = 144, kPoses = 500 };

static float depth[kWidth * kHeight];
static double poses[kPoses * 16]; /* T_world_camera, rows [m] */

int main(void) {
  const double eye[3] = {0, 0, 0.6}, center[3] = {0, 0, 0}, up[3] = {0, 1, 0};
  double T_world_camera[16], gain = 0;
  size_t best = 0, found = 0, i;
  vg_sensor sensor;
  vg_scorer_config config;
  vg_map_update update;
  vg_scorer* scorer = NULL;

  /* Stands for a real camera: a plate of 40 pixels in front of a floor. */
  for (i = 0; i < kWidth * kHeight; ++i) {
    const int u = (int)(i % kWidth) - kWidth / 2, v = (int)(i / kWidth) - kHeight / 2;
    depth[i] = u * u < 400 && v * v < 400 ? 0.5F : 0.6F;
  }
  vg_sensor_init(&sensor, sizeof sensor);
  vg_scorer_config_init(&config, sizeof config);
  vg_map_update_init(&update, sizeof update);
  config.voxel_size = 0.01;
  if (vg_sensor_preset("sr4000", &sensor) != VG_OK ||
      vg_scorer_create(&sensor, &config, &scorer) != VG_OK ||
      vg_look_at(eye, center, up, T_world_camera) != VG_OK ||
      vg_scorer_add(scorer, depth, NULL, T_world_camera, NULL, &update) != VG_OK ||
      vg_dome_poses(kPoses, 0.6, center, poses) != VG_OK ||
      vg_scorer_best(scorer, poses, kPoses, 1, NULL, INFINITY, &best, &gain, &found, NULL) != VG_OK)
    fprintf(stderr, "frames: %s\n", vg_last_error());
  if (found) printf("%.0f cm2 seen; next pose %zu, %.1f nat\n", 1e4 * update.new_area, best, gain);
  vg_scorer_release(scorer);
  return found ? 0 : 2;
}
