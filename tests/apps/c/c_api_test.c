/* SPDX-FileCopyrightText: 2026 The viewgain authors
   SPDX-License-Identifier: Apache-2.0 */

/* The C interface from C99, every function of it: c_api_test FOLDER, which it may write to. */
#include <stdlib.h>

#include "check.h"

tally checked;

vg_grid* test_map(void) {
  static uint8_t labels[MAP_VOXELS];
  const int32_t dims[3] = {MAP_EDGE, MAP_EDGE, MAP_EDGE};
  const double origin[3] = {-0.2, -0.2, -0.2};
  vg_grid* grid = NULL;
  int i;
  for (i = 0; i < MAP_VOXELS; ++i) {
    const int z = i % MAP_EDGE;
    labels[i] = (uint8_t)(z < 4 ? 0 : z == 4 && i / MAP_EDGE % 3 == 0 ? 2 : 1);
  }
  CHECK_OK(vg_grid_from_labels(labels, dims, origin, 0.025, 0.01, &grid));
  return grid;
}

int main(int argc, char** argv) {
  if (argc != 2) {
    fprintf(stderr, "usage: c_api_test FOLDER\n");
    return 2;
  }
  CHECK(vg_abi_version() == VG_ABI_VERSION);
  CHECK(strchr(vg_version(), '.') != NULL);
  CHECK(strcmp(vg_last_error(), "") == 0);
  use_everything(argv[1]);
  misuse_everything(argv[1]);
  printf("%d checks, %d failures\n", checked.checks, checked.failures);
  return checked.failures == 0 && checked.checks >= 150 ? EXIT_SUCCESS : EXIT_FAILURE;
}
