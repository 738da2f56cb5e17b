/* SPDX-FileCopyrightText: 2026 The viewgain authors
   SPDX-License-Identifier: Apache-2.0 */
#ifndef VIEWGAIN_VIEWGAIN_H
#define VIEWGAIN_VIEWGAIN_H

/* viewgain for C99 and for all languages that call C. The functions are in the same library as the
   C++ interface, and their gains are bit-identical to those of C++.

   Units are metres, radians and nats. A pose is 16 doubles, a row-major 4x4 matrix T_world_camera
   (camera to world); T_world_grid, T_flange_camera and T_reported have the same form. The camera's
   axes are x right, y down, z forward. A pose is valid only if all numbers are finite, the last row
   is 0 0 0 1 to within 1e-3, and the rotation is orthonormal to within 1e-3. Points and directions
   (center, eye, target, up, origin) and corners of boxes (min, max, box_min, box_max) are 3 doubles
   x, y, z. Images (depth, amplitude, labels) are row-major. Dense arrays of voxels (states, labels)
   are [x][y][z] with z fastest; states are 0 unknown, 1 free, 2 occupied.

   Cost: that of the corresponding C++ function, plus a copy of the arrays. Functions that set up a
   struct take constant time.

   Every function that can fail returns a status. If the status is not VG_OK, vg_last_error() gives
   the reason and names the value. In this case, output handles are null, and other outputs are
   unspecified unless the comment of the function states otherwise. Pointers must not be null unless
   "null" is mentioned; an array of length 0 may be null.

   Structs that a function takes begin with struct_size. First call the struct's _init function with
   the size of the struct (sizeof). It sets struct_size and the defaults. Then change fields. A
   constant or number that stands alone in a field's comment is its default. If a size differs from
   the library's, as with another version of the header, the result is VG_INVALID_ARGUMENT with a
   message that states both sizes. The size argument next to an array of vg_view_gain or
   vg_contribution works the same way.

   Release handles with the release function of their type, in any order: an object made from a
   handle stays valid after that handle is released. Releasing null has no effect. A handle must not
   be used or released again after its release.

   Thread safety: scenes, evaluators, checkers and range calibrations may be used from many threads
   at once. While a function changes a grid, no other function may use that grid. An integrator
   allows one call at a time.

   Fork: evaluators work in a child process, which starts its own threads. A child that does not
   exec must end with _exit(), after fflush(NULL) if it wrote anything. exit() or a return from main
   can wait forever, because Debian's OpenVDB loads log4cplus, whose exit handler waits for threads
   that a child does not have. The same holds for C++. */

#include "viewgain/c/base.h"
#include "viewgain/c/gain.h"
#include "viewgain/c/map.h"
#include "viewgain/c/scorer.h"

#endif
