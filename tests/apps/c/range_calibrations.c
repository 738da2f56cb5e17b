/* SPDX-FileCopyrightText: 2026 The viewgain authors
   SPDX-License-Identifier: Apache-2.0 */

/* Calibrations of ranges: right use and wrong. c_formats_test.cpp compares with C++. */
#include <math.h>

#include "check.h"

enum { WIDTH = 5, HEIGHT = 3, PIXELS = WIDTH * HEIGHT };

static vg_sensor small_sensor(void) {
  vg_sensor sensor;
  vg_sensor_init(&sensor, sizeof sensor);
  CHECK_OK(vg_sensor_preset("sr4000", &sensor));
  sensor.width = WIDTH;
  sensor.height = HEIGHT;
  sensor.fx = sensor.fy = 4;
  sensor.cx = 2;
  sensor.cy = 1;
  return sensor;
}

static void use(void) {
  const vg_sensor sensor = small_sensor();
  const double table[3][2] = {{0.5, 0.01}, {1, 0.03}, {2, -0.05}};
  float depth[PIXELS];
  vg_range_calibration* calibration = NULL;
  int i;
  for (i = 0; i < PIXELS; ++i) depth[i] = 1;
  depth[0] = 0;
  depth[1] = INFINITY;
  depth[2] = NAN;
  depth[3] = 0.001f;
  CHECK_OK(vg_range_calibration_create(&sensor, table[0], 3, &calibration));
  CHECK(calibration != NULL);
  CHECK_OK(vg_range_calibration_correct(calibration, depth));
  CHECK(depth[0] == 0);
  CHECK(isinf(depth[1]));
  CHECK(isnan(depth[2]));
  CHECK(depth[3] == 0);                        /* no range is left */
  CHECK(fabs(depth[7] - 0.97) < 1e-6);         /* at the principal point */
  CHECK(depth[14] > 0.97f && depth[14] < 1.f); /* farther along its ray: another error */
  CHECK_OK(vg_range_calibration_correct(calibration, depth));
  CHECK(depth[7] < 0.96f); /* again */
  vg_range_calibration_release(calibration);
  vg_range_calibration_release(NULL);
}

static void misuse(void) {
  const vg_sensor sensor = small_sensor();
  const double good[2] = {1, 0.01};
  const double falling[2][2] = {{2, 0}, {1, 0}};
  const struct {
    const double* table;
    size_t rows;
    const char* part;
  } bad[] = {{NULL, 0, "rows is 0"},
             {good, 0, "rows is 0"},
             {NULL, 2, "table is null"},
             {falling[0], 2, "must rise, but 1 m follows 2 m"}};
  vg_sensor other = sensor;
  float depth[PIXELS] = {1};
  vg_range_calibration* calibration;
  size_t i;
  for (i = 0; i < sizeof bad / sizeof bad[0]; ++i) {
    calibration = (vg_range_calibration*)1;
    CHECK_FAILS(vg_range_calibration_create(&sensor, bad[i].table, bad[i].rows, &calibration),
                VG_INVALID_ARGUMENT, bad[i].part);
    CHECK(calibration == NULL);
  }
  CHECK_FAILS(vg_range_calibration_create(NULL, good, 1, &calibration), VG_INVALID_ARGUMENT,
              "vg_sensor is null");
  CHECK_FAILS(vg_range_calibration_create(&sensor, good, 1, NULL), VG_INVALID_ARGUMENT,
              "calibration is null");
  other.fx = NAN;
  CHECK_FAILS(vg_range_calibration_create(&other, good, 1, &calibration), VG_INVALID_ARGUMENT,
              "fx");
  other = sensor;
  other.struct_size = 3;
  CHECK_FAILS(vg_range_calibration_create(&other, good, 1, &calibration), VG_INVALID_ARGUMENT,
              "is 3 bytes");
  CHECK_OK(vg_range_calibration_create(&sensor, good, 1, &calibration));
  CHECK_FAILS(vg_range_calibration_correct(NULL, depth), VG_INVALID_ARGUMENT,
              "calibration is null");
  CHECK_FAILS(vg_range_calibration_correct(calibration, NULL), VG_INVALID_ARGUMENT,
              "depth is null");
  CHECK(depth[0] == 1);
  vg_range_calibration_release(calibration);
}

void range_calibrations(void) {
  use();
  misuse();
}
