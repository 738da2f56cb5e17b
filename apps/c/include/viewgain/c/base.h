/* SPDX-FileCopyrightText: 2026 The viewgain authors
   SPDX-License-Identifier: Apache-2.0 */
#ifndef VIEWGAIN_C_BASE_H
#define VIEWGAIN_C_BASE_H

/* Part of viewgain/viewgain.h: versions, status codes, long calls. */

#include <stddef.h>
#include <stdint.h>

#if defined(__GNUC__)
#define VG_API __attribute__((visibility("default")))
#else
/* Exports a symbol from the shared library. */
#define VG_API
#endif

#ifdef __cplusplus
extern "C" {
#endif

/* Increases when a function or struct is removed or changed. New functions do not increase it. */
#define VG_ABI_VERSION 2
VG_API int32_t vg_abi_version(void); /* version of the library */
VG_API const char* vg_version(void); /* "major.minor.patch" of the library */

/* Result of a call: VG_OK or one of the errors below. */
typedef int32_t vg_status;
/* The result of a call. */
enum {
  VG_OK = 0,
  VG_INVALID_ARGUMENT = 1, /* a value outside its documented range, or a null pointer */
  VG_IO = 2,               /* a file cannot be opened, read or written */
  VG_FORMAT = 3,           /* a file's contents are invalid */
  VG_CAPACITY = 4,         /* more voxels or primitives than the data structures support */
  VG_BACKEND = 5,          /* Embree or OpenVDB reported a failure */
  VG_OUT_OF_MEMORY = 6,
  VG_STOPPED = 7, /* the caller's vg_watch requested a stop */
  VG_INTERNAL = 8 /* anything else: a defect of the library */
};

/* Message of the last failed call of this thread; "" if there was none. Valid until the thread's
   next failed call; truncated after 1,023 bytes. */
VG_API const char* vg_last_error(void);

/* Observes and stops a long call. `poll` is called before each pose and once after the last, from
   any thread, but never concurrently. If it returns nonzero while work is left, the call ends soon
   with VG_STOPPED. It must not throw or jump out. */
typedef struct vg_watch {
  size_t struct_size; /* set by _init() */
  /* `done` of `total` poses have been scored (vg_evaluate and similar calls), eliminated or scored
     in full (vg_best, vg_race), or chosen (vg_best_set). */
  int32_t (*poll)(size_t done, size_t total, void* user);
  void* user; /* may be null */
} vg_watch;
VG_API void vg_watch_init(vg_watch* watch, size_t struct_size); /* sets the defaults */

#ifdef __cplusplus
}
#endif
#endif
