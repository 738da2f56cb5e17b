/* SPDX-FileCopyrightText: 2026 The viewgain authors
   SPDX-License-Identifier: Apache-2.0 */
#ifndef VIEWGAIN_VIEWGAIN_H
#define VIEWGAIN_VIEWGAIN_H

/* viewgain for C99 and for all languages that call C. Linked from the same library as the C++
   interface; gains are bit-identical.

   Units are metres, radians and nats. A pose is 16 doubles, a row-major 4x4 matrix T_world_camera
   (camera to world); so are T_world_grid, T_flange_camera and T_reported. The camera's axes are x
   right, y down, z forward. The lowest row must be 0 0 0 1 and the rotation orthonormal, both to
   1e-3, and all numbers finite; otherwise the pose is invalid. Points and directions (center, eye,
   target, up, origin) and corners of boxes (min, max, box_min, box_max) are 3 doubles x, y, z.
   Images (depth, amplitude, labels) are row-major. Dense arrays of voxels (states, labels) are
   [x][y][z] with z fastest; states are 0 unknown, 1 free, 2 occupied.

   Cost: as the corresponding function of C++, plus a copy of the arrays; functions that set up a
   struct take constant time.

   Every function that can fail returns a status. If it is not VG_OK, vg_last_error() gives the
   reason and names the value; outputs are then unspecified, except handles, which are null, and
   unless a function states otherwise. Pointers must not be null unless "null" is mentioned; an
   array of length 0 may be null.

   Structs that a function takes begin with struct_size. Call the struct's _init function first,
   with its sizeof: it sets struct_size and the defaults; then change fields. A size that differs
   from the library's, as from another version of the header, is VG_INVALID_ARGUMENT with a message
   that states both. The size argument next to an array of vg_view_gain or vg_contribution works the
   same way.

   Release handles with the function of their type, in any order: objects made from a handle keep
   what they need of it. Releasing null has no effect. A handle must not be used or released again
   after its release.

   Thread safety: scenes, evaluators, checkers and range calibrations may be used from many threads
   at once. Nothing may run on a grid next to a function that changes it. Integrators: one call at a
   time.

   Fork: evaluators work in a child process, which starts its own threads. A child that does not
   exec must end with _exit(), after fflush(NULL) if it wrote anything: exit(), and so a return from
   main, can wait forever. Debian's OpenVDB loads log4cplus, whose exit handler waits for threads
   that a child does not have. The same holds for C++. */

#include "viewgain/c/base.h"
#include "viewgain/c/gain.h"
#include "viewgain/c/map.h"
#include "viewgain/c/scorer.h"

#endif
