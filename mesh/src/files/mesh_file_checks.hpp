// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

namespace viewgain::detail {

/// Checks of a mesh file's bytes before CGAL reads them. CGAL trusts what a header says: it
/// allocates what is promised, follows properties of types that it does not handle, and reads
/// colours that are not there. These refuse such files, or rewrite what is of no use here; each
/// throws Error(format) that begins with `name`.

/// Blanks the header's flags for colours, normals and texture coordinates in an ASCII file.
void check_off(std::string& bytes, const std::string& name);

/// Walks the whole file: every count is held against what follows.
void check_ply(const std::string& bytes, const std::string& name);

/// Decides between ASCII and binary by the size, and makes that decision plain to CGAL.
void check_stl(std::string& bytes, const std::string& name);

/// Refuses index 0, which OBJ does not have and CGAL takes for the next vertex.
void check_obj(const std::string& bytes, const std::string& name);

}  // namespace viewgain::detail
