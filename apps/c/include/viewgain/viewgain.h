/* SPDX-FileCopyrightText: 2026 The viewgain authors
   SPDX-License-Identifier: Apache-2.0 */
#ifndef VIEWGAIN_VIEWGAIN_H
#define VIEWGAIN_VIEWGAIN_H

/* viewgain for C99 and for whatever calls C. Linked from the same library as the C++ interface,
   whose gains are the same to the last bit.

   Units are metres, radians and nats. A pose is 16 doubles, a 4x4 matrix row by row, T_world_camera
   (camera to world), and so are T_world_grid, T_flange_camera and T_reported; the camera's axes are
   x right, y down, z forward. Its lowest row must be 0 0 0 1 and its rotation orthonormal, both to
   1e-3; else, and if a number is not finite, it is a bad pose. Points and directions (center, eye,
   target, up, origin) and corners of boxes (min, max, box_min, box_max) are 3 doubles, x, y, z.
   Images (depth, amplitude, labels) are row by row. Dense arrays of voxels (states, labels) are
   [x][y][z] with z fastest; states are 0 unknown, 1 free, 2 occupied.

   Cost: functions cost what those of C++ do that they stand for, and a copy of their arrays; those
   that set up a struct take constant time.

   Every function that can fail returns a status. Where it is not VG_OK, vg_last_error() says why
   and names the value; what the function would have filled is then unspecified, but for handles,
   which are null, and where a function says otherwise. No null pointers, except where "null" is
   said; an array of length 0 may be null.

   Structs that a function takes begin with struct_size; call the struct's _init function first,
   with its sizeof, which sets it and the defaults, then change what you like. Another size than the
   library's own, so of another header, is refused by VG_INVALID_ARGUMENT and a message with both.
   The size given with an array of vg_view_gain or vg_contribution counts in the same way.

   Handles are released by the function that bears their name, in any order: what is made from a
   handle keeps what it needs of it. Releasing null does nothing. A handle must not be used, or
   released again, after its release.

   Thread safety: scenes, evaluators, checkers and range calibrations may be used from many threads
   at once. Nothing may run beside a function that changes a grid, on that grid. One call at a time
   on an integrator.

   Fork: evaluators work in the child, which makes threads of its own. A child that does not exec
   must end by _exit(), after fflush(NULL) if it wrote anything: exit(), and so a return from main,
   may wait for ever. Debian's OpenVDB loads log4cplus, whose exit handler waits for threads that a
   child does not have. The same holds for C++. */

#include "viewgain/c/base.h"
#include "viewgain/c/gain.h"
#include "viewgain/c/map.h"
#include "viewgain/c/scorer.h"

#endif
