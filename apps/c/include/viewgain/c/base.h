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
/* Marks what the shared library shows. */
#define VG_API
#endif

#ifdef __cplusplus
extern "C" {
#endif

/* Grows when something is removed or changes, a struct's size too; new functions leave it as it is.
 */
#define VG_ABI_VERSION 2
VG_API int32_t vg_abi_version(void); /* of the library */
VG_API const char* vg_version(void); /* "major.minor.patch" of the library */

/* What a call came to: VG_OK or an error of those below. */
typedef int32_t vg_status;
/* What a call came to. */
enum {
  VG_OK = 0,
  VG_INVALID_ARGUMENT = 1, /* a value outside its documented range, or a null pointer */
  VG_IO = 2,               /* a file cannot be opened, read or written */
  VG_FORMAT = 3,           /* a file's contents are not what they should be */
  VG_CAPACITY = 4,         /* more voxels or primitives than the data structures can hold */
  VG_BACKEND = 5,          /* Embree or OpenVDB reported a failure */
  VG_OUT_OF_MEMORY = 6,
  VG_STOPPED = 7, /* the caller's vg_watch asked to stop */
  VG_INTERNAL = 8 /* anything else: a defect of the library */
};

/* Why the last call of this thread that did not return VG_OK did not; "" if there was none. Valid
   until the thread's next such call; cut off after 1,023 bytes. */
VG_API const char* vg_last_error(void);

/* Follows and ends a long call. The function is called before each pose and once all are done, from
   whichever thread, never two at once. If it returns nonzero while there is work left the call ends
   soon, with VG_STOPPED. It must not throw or jump out. */
typedef struct vg_watch {
  size_t struct_size; /* as _init() sets it */
  /* done of total poses: scored (vg_evaluate and its like), in need of no more work (vg_best,
     vg_race), chosen (vg_best_set). */
  int32_t (*poll)(size_t done, size_t total, void* user);
  void* user; /* may be null */
} vg_watch;
VG_API void vg_watch_init(vg_watch* watch, size_t struct_size); /* the defaults */

#ifdef __cplusplus
}
#endif
#endif
