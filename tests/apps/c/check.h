/* SPDX-FileCopyrightText: 2026 The viewgain authors
   SPDX-License-Identifier: Apache-2.0 */
#ifndef VIEWGAIN_TESTS_C_CHECK_H
#define VIEWGAIN_TESTS_C_CHECK_H

#include <stdio.h>
#include <string.h>
#include <viewgain/viewgain.h>

/* Counts checks and failures; prints the latter. */
typedef struct tally {
  int checks, failures;
} tally;
extern tally checked;

#define CHECK(condition)                                              \
  do {                                                                \
    ++checked.checks;                                                 \
    if (!(condition)) {                                               \
      ++checked.failures;                                             \
      fprintf(stderr, "%s:%d: %s\n", __FILE__, __LINE__, #condition); \
    }                                                                 \
  } while (0)

/* The call must end with this status; the message must hold `part`. */
#define CHECK_FAILS(call, expected, part)                                               \
  do {                                                                                  \
    const vg_status status_ = (call);                                                   \
    ++checked.checks;                                                                   \
    if (status_ != (expected) || strstr(vg_last_error(), (part)) == NULL) {             \
      ++checked.failures;                                                               \
      fprintf(stderr, "%s:%d: %s\n  is %d, '%s'\n", __FILE__, __LINE__, #call, status_, \
              vg_last_error());                                                         \
    }                                                                                   \
  } while (0)

#define CHECK_REFUSED(call, part) CHECK_FAILS(call, VG_INVALID_ARGUMENT, part)

#define CHECK_OK(call)                                                                  \
  do {                                                                                  \
    const vg_status status_ = (call);                                                   \
    ++checked.checks;                                                                   \
    if (status_ != VG_OK) {                                                             \
      ++checked.failures;                                                               \
      fprintf(stderr, "%s:%d: %s\n  is %d, '%s'\n", __FILE__, __LINE__, #call, status_, \
              vg_last_error());                                                         \
    }                                                                                   \
  } while (0)

/* What a map of 16^3 voxels of 2.5 cm looks like: a slab of unknown voxels under a slab of occupied
   ones, the rest free. */
enum { MAP_EDGE = 16, MAP_VOXELS = MAP_EDGE * MAP_EDGE * MAP_EDGE };
vg_grid* test_map(void);

/* The parts of the program: right use and wrong. */
void use_everything(const char* folder);
void misuse_everything(const char* folder);

#endif
