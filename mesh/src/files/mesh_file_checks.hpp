// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

namespace viewgain::detail {

/// What is done to a mesh file's bytes before CGAL reads them, which takes for granted what a
/// header says and gives up at lines that it does not know. Each throws Error(format) that begins
/// with `name`.

/// Blanks the header's flags for colours, normals and texture coordinates in an ASCII file: CGAL
/// reads them even where they are not there.
void check_off(std::string& bytes, const std::string& name);

/// Decides between ASCII and binary by the size, and makes that decision plain to CGAL.
void check_stl(std::string& bytes, const std::string& name);

/// Tabs become blanks and lines that draw lines comments, both of which CGAL takes for errors.
/// Refuses index 0, which OBJ does not have and CGAL takes for the next vertex.
void check_obj(std::string& bytes, const std::string& name);

}  // namespace viewgain::detail
