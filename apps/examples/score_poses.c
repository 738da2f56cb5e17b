/* The best three of 2,000 views round the origin, from C99: what score_poses.cpp does. */
#include <math.h>
#include <stdio.h>
#include <viewgain/viewgain.h>

enum { kPoses = 2000, kBest = 3 };

static double poses[kPoses * 16]; /* T_world_camera, rows [m] */

int main(int argc, char** argv) {
  const double radius = 0.6, center[3] = {0, 0, 0};
  vg_sensor sensor;
  vg_scorer* scorer = NULL;
  size_t best[kBest], found = 0, i;
  double gains[kBest];
  int status = 2;

  vg_sensor_init(&sensor, sizeof sensor);
  if (vg_sensor_preset("sr4000", &sensor) == VG_OK &&
      vg_scorer_load(argc > 1 ? argv[1] : "map.vdb", &sensor, NULL, &scorer) == VG_OK &&
      vg_sphere_poses(kPoses, radius, center, poses) == VG_OK &&
      vg_scorer_best(scorer, poses, kPoses, kBest, NULL, INFINITY, best, gains, &found, NULL) ==
          VG_OK) {
    status = 0; /* on all cores */
  } else {
    fprintf(stderr, "%s\n", vg_last_error());
  }
  for (i = 0; i < found; ++i) printf("pose %zu: %.1f nat\n", best[i], gains[i]);
  vg_scorer_release(scorer);
  return status;
}
