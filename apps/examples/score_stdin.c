/* Scores camera poses from stdin: score_stdin MAP.vdb [SENSOR] < poses
   A line is a pose, T_world_camera row by row, 12 or 16 numbers; empty lines and lines that begin
   with # are passed over. Prints the expected gain of each in nats, a line a pose; nan: a bad pose.
 */
#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <viewgain/viewgain.h>

enum { LINE_LENGTH = 4096 };

/* Reads the numbers of a line, at most 17; returns how many, or -1 if there is anything else. */
static int numbers_of(const char* line, double numbers[17]) {
  int count = 0;
  while (count < 17) {
    char* end;
    line += strspn(line, " \t\r\n,");
    if (*line == '\0') return count;
    numbers[count++] = strtod(line, &end);
    if (end == line || (*end != '\0' && strchr(" \t\r\n,", *end) == NULL)) return -1;
    line = end;
  }
  return count;
}

/* Reads all poses; 0 if a line is not one, which is then on stderr. */
static int read_poses(double** poses, size_t* count) {
  char line[LINE_LENGTH];
  size_t room = 0, number = 0;
  while (fgets(line, sizeof line, stdin) != NULL) {
    double pose[17] = {0};
    const size_t start = strspn(line, " \t\r\n");
    int found;
    ++number;
    if (strlen(line) + 1 == sizeof line) {
      fprintf(stderr, "score_stdin: line %zu is longer than %d characters\n", number,
              LINE_LENGTH - 2);
      return 0;
    }
    if (line[start] == '\0' || line[start] == '#') continue;
    found = numbers_of(line, pose);
    if (found == 12) pose[15] = 1;
    if (found != 12 && found != 16) {
      fprintf(stderr, "score_stdin: line %zu is not 12 or 16 numbers: %s\n", number,
              strtok(line, "\r\n"));
      return 0;
    }
    if (*count == room) {
      double* more = realloc(*poses, 16 * sizeof **poses * (room = 2 * room + 64));
      if (more == NULL) {
        fprintf(stderr, "score_stdin: out of memory\n");
        return 0;
      }
      *poses = more;
    }
    memcpy(*poses + 16 * (*count)++, pose, 16 * sizeof *pose);
  }
  if (ferror(stdin)) {
    fprintf(stderr, "score_stdin: stdin: %s\n", strerror(errno));
    return 0;
  }
  return 1;
}

int main(int argc, char** argv) {
  vg_grid* grid = NULL;
  vg_scene* scene = NULL;
  vg_evaluator* evaluator = NULL;
  vg_sensor sensor;
  double *poses = NULL, *gains = NULL;
  size_t count = 0, i;
  int done = 0;

  if (argc != 2 && argc != 3) {
    fprintf(stderr, "usage: score_stdin MAP.vdb [SENSOR] < poses\n");
    return 2;
  }
  vg_sensor_init(&sensor, sizeof sensor);
  if (vg_sensor_preset(argc == 3 ? argv[2] : "sr4000", &sensor) != VG_OK ||
      vg_grid_load(argv[1], &grid) != VG_OK || vg_scene_build(grid, NULL, &scene) != VG_OK ||
      vg_evaluator_create(scene, &sensor, NULL, &evaluator) != VG_OK) {
    fprintf(stderr, "score_stdin: %s\n", vg_last_error());
  } else if (read_poses(&poses, &count)) {
    gains = malloc((count + 1) * sizeof *gains);
    if (gains == NULL) {
      fprintf(stderr, "score_stdin: out of memory\n");
    } else if (vg_evaluate(evaluator, poses, count, gains, NULL) != VG_OK) {
      fprintf(stderr, "score_stdin: %s\n", vg_last_error());
    } else {
      for (i = 0; i < count; ++i) printf("%.17g\n", gains[i]);
      done = fflush(stdout) == 0;
    }
  }
  free(gains);
  free(poses);
  vg_evaluator_release(evaluator);
  vg_scene_release(scene);
  vg_grid_release(grid);
  return done ? 0 : 2;
}
