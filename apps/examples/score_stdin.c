/* Scores camera poses as they come: score_stdin MAP.vdb [SENSOR] < poses
   A pose is 12 numbers, T_world_camera row by row without its last row. Prints the expected gain of
   each in nats, a line a pose; nan: a bad pose. */
#include <stdio.h>
#include <viewgain/viewgain.h>

/* 1, or 0 at the end; -1 for anything that is no pose. */
static int read_pose(double pose[16]) {
  int i;
  for (i = 0; i < 12; ++i) {
    if (scanf("%lf", &pose[i]) != 1) return i == 0 && feof(stdin) ? 0 : -1;
  }
  return 1;
}

int main(int argc, char** argv) {
  vg_grid* grid = NULL;
  vg_scene* scene = NULL;
  vg_evaluator* evaluator = NULL;
  vg_sensor sensor;
  double gain, pose[16] = {0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 1};
  int found = -1;

  if (argc != 2 && argc != 3) {
    fprintf(stderr, "usage: score_stdin MAP.vdb [SENSOR] < poses\n");
    return 2;
  }
  vg_sensor_init(&sensor, sizeof sensor);
  if (vg_sensor_preset(argc == 3 ? argv[2] : "sr4000", &sensor) != VG_OK ||
      vg_grid_load(argv[1], &grid) != VG_OK || vg_scene_build(grid, NULL, &scene) != VG_OK ||
      vg_evaluator_create(scene, &sensor, NULL, &evaluator) != VG_OK) {
    fprintf(stderr, "score_stdin: %s\n", vg_last_error());
  } else {
    while ((found = read_pose(pose)) == 1 &&
           vg_evaluate(evaluator, pose, 1, &gain, NULL) == VG_OK) {
      printf("%.17g\n", gain);
      fflush(stdout);
    }
    if (found != 0) fprintf(stderr, "score_stdin: a pose is 12 numbers\n");
  }
  vg_evaluator_release(evaluator);
  vg_scene_release(scene);
  vg_grid_release(grid);
  return found == 0 ? 0 : 2;
}
