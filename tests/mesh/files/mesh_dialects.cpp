// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include "mesh/files/mesh_dialects.hpp"

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstring>
#include <sstream>

#include "core/expect_error.hpp"

namespace viewgain::test {
namespace {

// A box of 2 x 3 x 5 with four corners a face, and the same in the plane.
constexpr double kArea = 62, kVolume = 30;
const std::string kVertices = "0 0 0\n2 0 0\n2 3 0\n0 3 0\n0 0 5\n2 0 5\n2 3 5\n0 3 5\n";
const std::string kFaces = "4 0 3 2 1\n4 4 5 6 7\n4 0 1 5 4\n4 1 2 6 5\n4 2 3 7 6\n4 3 0 4 7\n";
const std::string kOff = "OFF\n8 6 0\n" + kVertices + kFaces;
const std::string kXyz = "property float x\nproperty float y\nproperty float z\n";
const std::string kIndices = "property list uchar int vertex_indices\n";

// Each line with something before and behind it.
std::string framed(const std::string& lines, const std::string& before, const std::string& behind) {
  std::string text;
  std::istringstream in(lines);
  for (std::string line; std::getline(in, line);) {
    text.append(before).append(line).append(behind).append("\n");
  }
  return text;
}

template <typename Number>
std::string raw(Number value, bool big_endian = false) {
  std::array<char, sizeof(Number)> bytes{};
  std::memcpy(bytes.data(), &value, sizeof value);
  if (big_endian) std::reverse(bytes.begin(), bytes.end());
  return {bytes.begin(), bytes.end()};
}

// The box's corner i, and its corners face by face.
std::array<double, 3> corner(int i) {
  return {(i % 4 == 1 || i % 4 == 2) ? 2.0 : 0.0, i % 4 >= 2 ? 3.0 : 0.0, i >= 4 ? 5.0 : 0.0};
}
constexpr std::array<std::array<int, 4>, 6> kCorners{
    {{0, 3, 2, 1}, {4, 5, 6, 7}, {0, 1, 5, 4}, {1, 2, 6, 5}, {2, 3, 7, 6}, {3, 0, 4, 7}}};

MeshDialect box(const std::string& file, const std::string& bytes) {
  return {file, bytes, 8, 12, kArea, kVolume, ""};
}
MeshDialect mesh(const std::string& file, const std::string& bytes, std::size_t vertices,
                 std::size_t triangles, double area, double volume = 0) {
  return {file, bytes, vertices, triangles, area, volume, ""};
}
MeshDialect refused(const std::string& file, const std::string& words, const std::string& bytes) {
  return {file, bytes, 0, 0, 0, 0, words};
}

using Rows = std::vector<MeshDialect>;

std::string off_of(const std::string& counts, const std::string& vertices,
                   const std::string& faces) {
  return "OFF\n" + counts + "\n" + vertices + faces;
}

Rows off_rows() {
  const std::string paired = replaced(replaced(kVertices, "0\n2", "0 2"), "5\n2", "5 2");
  const std::string triangle = "0 0 0\n1 0 0\n0 1 0\n";
  return {
      box("plain.off", kOff),
      box("capital_ending.OFF", kOff),
      box("no_end_of_line.off", kOff.substr(0, kOff.size() - 1)),
      box("same_line.off", with(kOff, "OFF\n", "OFF ")),
      box("glued.off", with(kOff, "OFF\n", "OFF")),
      box("glued_colours.off",
          "COFF8 6 0\n" + framed(kVertices, "", " 255 0 0 255") + framed(kFaces, "", " 9 9 9")),
      box("no_edges.off", with(kOff, "8 6 0", "8 6")),
      box("one_count_a_line.off", with(kOff, "8 6 0", "8\n6\n0")),
      box("no_keyword.off", with(kOff, "OFF\n", "")),
      box("blank_lines.off", replaced(with(kOff, "OFF\n", "\n OFF\n\n"), "\n4 ", "\n \n\t\n4 ")),
      box("comments.off", "# a box\n" + framed(with(kOff, "8 6", "# sizes\n8 6"), "", " # why")),
      box("crlf.off", replaced(kOff, "\n", "\r\n")),
      box("cr.off", replaced(kOff, "\n", "\r")),
      box("blanks.off", framed(kOff, "  ", " ")),
      box("mark.off", "\xEF\xBB\xBF" + kOff),
      box("coff.off", "COFF\n8 6 0\n" + framed(kVertices, "", " 0.1 0.2 0.3 1") + kFaces),
      box("some_colours.off",
          "COFF\n8 6 0\n" + replaced(kVertices, "5\n", "5 255 0 0 1\n") + kFaces),
      box("noff.off", "NOFF\n8 6 0\n" + framed(kVertices, "", " nan -nan NaN") + kFaces),
      box("stoff.off", "STOFF\n8 6 0\n" + framed(kVertices, "", " 0.5 0.5") + kFaces),
      box("stcnoff.off", "STCNOFF\n8 6 0\n" + framed(kVertices, "", " 0 0 1 1 1 1 1 0 0") + kFaces),
      box("face_colours.off", off_of("8 6 0", kVertices, framed(kFaces, "", " 0.5 0.5 0.5 1"))),
      box("paired_vertices.off", off_of("8 6 0", paired, kFaces)),
      box("broken_vertices.off", off_of("8 6 0", replaced(kVertices, " ", "\n"), kFaces)),
      box("broken_faces.off", off_of("8 6 0", kVertices, replaced(kFaces, "4 ", "4\n"))),
      box("one_line.off", replaced(kOff, "\n", " ")),
      box("exponents.off", with(with(kOff, "2 3 0", "+2.0 3e0 -0.0"), "2 3 5", ".2E+1 3.0e+00 5.")),
      box("unused_vertices.off", off_of("10 6 0", kVertices + "1e9 0 0\n7 7 7\n", kFaces)),
      mesh("inside_out.off", off_of("8 6 0", replaced(kVertices, "5\n", "-5\n"), kFaces), 8, 12,
           kArea, -kVolume),
      mesh("mixed.off", with(kOff, "4 0 3 2 1", "4 1 2 3 0"), 8, 12, kArea, kVolume),
      mesh("duplicates.off", off_of("6 2 0", triangle + triangle, "3 0 1 2\n3 3 5 4\n"), 6, 2, 1),
      mesh("no_area.off", off_of("3 3 0", triangle, "3 0 1 2\n3 0 0 1\n3 1 1 1\n"), 3, 1, 0.5),
      mesh("edges_and_points.off", off_of("3 3 0", triangle, "3 0 1 2\n2 0 1\n1 2\n"), 3, 1, 0.5),
      refused("no_area_at_all.off", "all faces of the mesh have the area 0",
              off_of("3 2 0", triangle, "3 0 0 1\n3 1 1 1\n")),
      refused("only_edges.off", "no faces", off_of("2 1 0", "0 0 0\n1 0 0\n", "2 0 1\n")),
      refused("no_faces.off", "no faces", off_of("8 0 0", kVertices, "")),
      refused("four.off", "four.off:1: vertices must have 3", with(kOff, "OFF", "4OFF")),
      refused("skel.off", "skel.off:1: the file is not an OFF file", with(kOff, "OFF", "SKEL")),
      refused("png.off", "png.off:1: the file is not an OFF file", "\x89PNG\r\n\x1a\n"),
      refused("empty.off", "the file is empty", ""),
      refused("comment.off", "the file is empty", "# OFF\n"),
      refused("name.off", "name.off:1: 'x' is not a number", with(kOff, "OFF\n", "OFFx\n")),
      refused("negative.off", ":2: the counts", with(kOff, "8 6 0", "8 -6 0")),
      refused("comma.off", ":4: '2,0' is not a number", with(kOff, "2 0 0", "2,0 0 0")),
      refused("nan.off", ":5: the number 'nan' is not finite", with(kOff, "2 3 0", "2 nan 0")),
      refused("far.off", ":5: a coordinate of vertex 2 must be finite and below 1e30",
              with(kOff, "2 3 0", "2 3e30 0")),
      refused("index.off", ":11: face 0 has an index out of range; the file has 8 vertices",
              with(kOff, "4 0 3 2 1", "4 0 3 2 8")),
      refused("large.off", ":11: face 0 has", with(kOff, "4 0 3 2 1", "4 0 3 2 4294967296")),
      refused("corners.off", ":11: a face has too few", with(kOff, "4 0 3 2 1", "4 0 3 2")),
      refused("coordinates.off", ":5: a vertex has fewer than 3", with(kOff, "2 3 0", "2 3")),
      refused("one_face_less.off", "the file continues after its last face",
              with(kOff, "8 6", "8 5")),
      refused("one_face_more.off", ":16: the file ends", with(kOff, "8 6", "8 7")),
      refused("one_vertex_more.off", ":", with(kOff, "8 6", "9 6")),
      refused("binary.off", "binary.off:1: binary OFF is not supported", "OFF BINARY\n"),
  };
}

Rows obj_rows() {
  const std::string v = framed(kVertices, "v ", "");
  const std::string f = "f 1 4 3 2\nf 5 6 7 8\nf 1 2 6 5\nf 2 3 7 6\nf 3 4 8 7\nf 4 1 5 8\n";
  const std::string square = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n";
  const auto change = [&](const std::string& from, const std::string& to) {
    return with(v + f, from, to);
  };
  return {
      box("plain.obj", "# a box\n" + v + f),
      box("faces_first.obj", f + v),
      box("textures.obj", v + "vt 0 0\n" + replaced(f, " 4", " 4/1")),
      box("slashes.obj", v + "vn 0 0 1\n" + replaced(replaced(f, " 1", " 1//1"), " 2", " 2/1/1")),
      box("empty_parts.obj", v + replaced(f, " 3", " 3/")),
      box("negative.obj", v + replaced(replaced(f, " 1", " -8"), " 8", " -1")),
      box("in_groups.obj",
          "mtllib a b.mtl\no box\ng all of it #2\nusemtl red\ns off\n" + v + "s 1\n" + f),
      box("curves.obj",
          v + "vp 0.1\ncstype bspline\ndeg 3\ncurv 0 1 1 2 3 4\nparm u 0 1\nend\n" + f),
      box("faces_continued.obj", v + replaced(f, " 6", " \\\n 6")),
      box("vertices_continued.obj", replaced(v, "v ", "v \\\n") + f),
      box("normal_continued.obj", v + "vn -0.43 -0.90 \\\n -6.946386505895734e-18\n" + f),
      box("continued_twice.obj", v + replaced(f, "f ", "f\\\r\n \\ \r\n ")),
      box("comment_with_backslash.obj", "# c:\\box\\\n" + v + f),
      box("name_continued.obj", "g a \\\n f 1 2 3\n" + v + f),
      box("crlf.obj", replaced(v + f, "\n", "\r\n")),
      box("return_in_comment.obj", v + replaced(f, "f ", "# c\rf ")),
      box("feed_in_comment.obj", "# a box\r" + v + replaced(f, "f ", "# c\nf ")),
      box("returns_and_feeds.obj", replaced(v, "\n", "\r\r\n") + replaced(f, "\n", "\r")),
      box("mark.obj", "\xEF\xBB\xBF" + v + f),
      box("colours.obj", framed(v, "", " 0.5 0.5 0.5") + f),
      box("colours_alpha.obj", framed(v, "", " 0.5 0.5 0.5 1") + f),
      box("comment_behind.obj", framed(v + f, "", " # x")),
      box("exponents.obj", change("v 2 3 5", "v +2e0 3.0E+0 0.5e1")),
      mesh("unused.obj", "v 9 9 9\n" + square + "v 9 9 9\nf 2 3 4 5\n", 4, 2, 1),
      mesh("hexagon.obj",
           "v 2 0 0\nv 1 1 0\nv -1 1 0\nv -2 0 0\nv -1 -1 0\nv 1 -1 0\nf 1 2 3 4 5 6\n", 6, 4, 6),
      // A gate of eight corners, the first of them not where a fan would do.
      mesh(
          "gate.obj",
          "v 0 -.2 0\nv 0 -.1 0\nv 0 -.1 .3\nv 0 .1 .3\nv 0 .1 0\nv 0 .2 0\nv 0 .2 .4\nv 0 -.2 .4\n"
          "f 1 2 3 4 5 6 7 8\n",
          8, 6, 0.1),
      mesh("arrow.obj", "v 0 0 0\nv 2 1 0\nv 0 2 0\nv 1 1 0\nf 1 2 3 4\n", 4, 2, 1),
      // A square with a square hole, joined to its rim by an edge that is gone along twice.
      mesh("hole.obj",
           "v 0 0 0\nv 4 0 0\nv 4 4 0\nv 0 4 0\nv 1 1 0\nv 1 3 0\nv 3 3 0\nv 3 1 0\n"
           "f 1 2 3 4 1 5 6 7 8 5\n",
           8, 8, 12),
      mesh("touching.obj", "v 0 0 0\nv 4 0 0\nv 4 4 0\nv 2 -1e-10 0\nv 0 4 0\nf 1 2 3 4 5\n", 7, 3,
           8),
      mesh("in_a_line.obj", "v 0 0 0\nv 1 0 0\nv 2 0 0\nv 2 2 0\nv 0 2 0\nf 1 2 3 4 5\n", 5, 3, 4),
      mesh("twice.obj", square + "f 1 2 2 3 4\n", 4, 2, 1),
      mesh("no_area.obj", square + "v 2 0 0\nv 3 0 0\nf 1 2 5 6\nf 1 2 3\n", 3, 1, 0.5),
      mesh("two_corners.obj", square + "f 1 2\nf 1 2 3\n", 3, 1, 0.5),
      mesh("crossing.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 1 1.5 0\nf 1 2 3 4\n", 5, 2, 0.6),
      mesh("star.obj", "v 0 5 0\nv 3 -4 0\nv -5 2 0\nv 5 2 0\nv -3 -4 0\nf 1 2 3 4 5\n", 10, 8,
           29.85),
      // More than once round the first corner.
      mesh("wound.obj",
           "v 0 0 0\nv 1 0 0\nv 0 1 0\nv -1 0 0\nv 0 -1 0\nv 2 0 0\nv .2 2 0\n"
           "f 1 2 3 4 5 6 7\n",
           8, 8, 4 + 1.0 / 22),
      // Once round the first corner, which it touches again.
      mesh("once_round.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nv -1 0 0\nv 0 -1 0\nf 1 2 3 4 5 2\n", 5, 4,
           2),
      // Through the middle of its first edge by a corner.
      mesh("spiral.obj",
           "v 0 0 0\nv 4 0 0\nv 0 4 0\nv -3 0 0\nv 0 -3 0\nv 2 0 0\nv 0 2 0\nv -1 0 0\n"
           "f 1 2 3 4 5 6 7 8\n",
           8, 9, 21.5),
      refused("zero.obj", "zero.obj:9: index 0 is out of range", change("f 1 4", "f 0 4")),
      refused("large.obj", "large.obj:9: face 0 has an index out of range; the file has 8 vertices",
              change("f 1 4", "f 9 4")),
      refused("too_far_back.obj", ":9: face 0 has an index out of range",
              change("f 1 4", "f -9 4")),
      refused("parts.obj", ":9: '1/1/1/1' is not a corner", change("f 1 4", "f 1/1/1/1 4")),
      refused("texture.obj", ":9: 'x' is not a number", change("f 1 4", "f 1/x 4")),
      refused("comma.obj", ":2: '2,0' is not a number", change("v 2 0 0", "v 2,0 0,0 0,0")),
      refused("nan.obj", ":2: a coordinate of vertex 1 must be finite", change("v 2 0", "v nan 0")),
      refused("two.obj", ":2: expected 3 coordinates", change("v 2 0 0", "v 2 0")),
      refused("weight.obj", ":2: the fourth number of a vertex is a weight",
              change("v 2 0 0", "v 2 0 0 2")),
      refused("weight_and_colour.obj", ":2: the fourth number of a vertex is a weight",
              change("v 2 0 0", "v 2 0 0 0.5 0.5 0.5 0.7")),
      refused("call.obj", ":15: statements that include other files", v + f + "call other.obj\n"),
      refused("surface.obj", ":15: free-form surfaces", v + f + "surf 0 1 0 1 1 2 3 4\n"),
      refused("unknown.obj", ":9: the keyword 'face' is not a known OBJ statement",
              change("f 1 4", "face 1 4")),
      refused("glued.obj", ":10: a backslash must end", change("f 1 4 3", "f 1 4\\\n3")),
      refused("cut.obj", "ends after a backslash", v + f + "f 1 2 3\\"),
      refused("no_faces.obj", "no faces", v + "l 1 2 3 4\n"),
      refused("png.obj", "png.obj:1: ", "\x89PNG\r\n\x1a\n"),
  };
}

std::string facet(const std::array<int, 4>& face, int second) {
  std::string text = "facet normal 0 0 0\n outer loop\n";
  for (const int k : {0, second, second + 1}) {
    text += "  vertex";
    for (const double x : corner(face.at(static_cast<std::size_t>(k)))) {
      text += ' ' + std::to_string(x);
    }
    text += '\n';
  }
  return text + " endloop\nendfacet\n";
}

std::string facets(std::size_t from, std::size_t to) {
  std::string text;
  for (std::size_t i = from; i < to; ++i)
    text += facet(kCorners.at(i), 1) + facet(kCorners.at(i), 2);
  return text;
}

std::string binary_stl(std::string header, std::uint32_t count) {
  header.resize(80, ' ');
  header += raw(count);
  for (const auto& face : kCorners) {
    for (const int second : {1, 2}) {
      header += std::string(12, '\0');
      for (const int k : {0, second, second + 1}) {
        for (const double x : corner(face.at(static_cast<std::size_t>(k)))) {
          header += raw(static_cast<float>(x));
        }
      }
      header += raw(std::uint16_t{0});
    }
  }
  return header;
}

Rows stl_rows() {
  const std::string good = "solid box\n" + facets(0, 6) + "endsolid box\n";
  const std::string quads = replaced("solid\n" + facet(kCorners[1], 1) + "endsolid\n", " endloop",
                                     "  vertex 0 3 5\n endloop");
  const auto change = [&](const std::string& from, const std::string& to) {
    return with(good, from, to);
  };
  std::string nan = binary_stl("x", 12);
  nan.replace(84 + 12, 4, "\xff\xff\xff\xff");
  return {
      box("plain.stl", good),
      box("blanks.stl", framed(good, " \t ", "  ")),
      box("empty_lines.stl", "\n\n" + good + "\n \n"),
      box("cr.stl", replaced(good, "\n", "\r")),
      box("mark.stl", "\xEF\xBB\xBF" + good),
      box("no_name.stl", replaced(good, " box", "")),
      box("name_of_words.stl", replaced(good, "solid box", "solid a box, 2 x 3 x 5 (v1)")),
      box("named_solid.stl", replaced(good, " box", " solid")),
      box("glued_ends.stl", replaced(replaced(good, "endfacet", "ENDFACET"), "endloop", "EndLoop")),
      box("spaced_ends.stl", replaced(good, "end", "end ")),
      box("no_end.stl", replaced(good, "endsolid box\n", "")),
      box("no_solid.stl", facets(0, 6)),
      box("two_solids.stl",
          "solid a\n" + facets(0, 2) + "endsolid a\n\nsolid b\n" + facets(2, 6) + "endsolid b\n"),
      box("one_line.stl", replaced(good, "\n", " ")),
      box("two_in_a_line.stl", replaced("solid a\n" + facets(0, 2) + "endsolid a\nsolid b\n" +
                                            facets(2, 6) + "endsolid b\n",
                                        "\n", " ")),
      box("facets_behind_the_end.stl",
          replaced("solid a\n" + facets(0, 2) + "endsolid a\n" + facets(2, 6), "\n", " ")),
      box("named_facet.stl", replaced(good, " box", " my facet model")),
      box("named_facet_one_line.stl", replaced(replaced(good, " box", " my facet"), "\n", " ")),
      box("comments.stl", "# by hand\r\n\n  # \n" + good),
      box("return_in_comment.stl", replaced(good, "endfacet\n", "endfacet # c\r")),
      box("nan_normals.stl", replaced(good, "normal 0 0 0", "normal nan -nan NaN")),
      box("no_normals.stl", replaced(good, " normal 0 0 0", "")),
      box("exponents.stl", replaced(good, "2.000000", "+2.0000e+00")),
      mesh("quad.stl", quads, 4, 2, 6, 10),
      box("binary.stl", binary_stl("an exporter", 12)),
      box("binary_solid.stl", binary_stl("solid box", 12)),
      box("binary_and_a_byte.stl", binary_stl("x", 12) + "\n"),
      refused("count_small.stl", "declares 11 triangles, but the file holds 12",
              binary_stl("x", 11)),
      refused("count_large.stl", "declares 13 triangles, but the file holds 12",
              binary_stl("solid", 13)),
      refused("count_all.stl", "declares 4294967295 triangles", binary_stl("x", 4294967295U)),
      refused("cut_binary.stl", "declares 12 triangles, but the file holds 11",
              binary_stl("x", 12).substr(0, 683)),
      refused("no_faces.stl", "no faces", std::string(84, '\0')),
      refused("nan.stl", "a coordinate of vertex 0 must be finite", nan),
      refused("none.stl", "no faces", "solid x\nendsolid x\n"),
      refused("png.stl", "the file is not an STL file", "\x89PNG\r\n\x1a\n"),
      refused("text.stl", "it does not begin with \"solid\", and it is not a binary STL file",
              "box\n" + good),
      refused("inf.stl", ":4: the number 'inf' is not finite", change("0.000000", "inf")),
      refused("comma.stl", ":4: '0,0' is not a number", change("0.000000", "0,0")),
      refused("two_numbers.stl", ":5: 'vertex' is not a number", change("0.000000 ", "")),
      refused("two_vertices.stl", ":6: a facet has fewer than 3",
              "solid x\nfacet\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nendloop\nendfacet\n"),
      refused("unknown.stl", ":9: found 'colour', not \"facet\"",
              change("endfacet\n", "endfacet\ncolour 1 1 1\n")),
      refused("no_loop.stl", ":3: 'loop' is not a number", change(" outer loop", " loop")),
      refused("cut.stl", "the file ends too early", good.substr(0, good.size() - 30)),
  };
}

std::string ply_of(const std::string& format, const std::string& vertex, const std::string& face) {
  return "ply\nformat " + format + " 1.0\ncomment a box\nobj_info by hand\nelement vertex 8\n" +
         vertex + "element face 6\n" + face + "end_header\n";
}

std::string binary_ply(bool is_big, const std::string& line_end = "\n") {
  std::string bytes =
      replaced(ply_of(is_big ? "binary_big_endian" : "binary_little_endian",
                      "property double x\nproperty uchar red\nproperty float y\nproperty float z\n",
                      kIndices),
               "\n", line_end);
  for (int i = 0; i < 8; ++i) {
    const auto p = corner(i);
    bytes += raw(p[0], is_big) + '\n' + raw(static_cast<float>(p[1]), is_big) +
             raw(static_cast<float>(p[2]), is_big);
  }
  for (const auto& face : kCorners) {
    bytes += raw(std::uint8_t{4});
    for (const int i : face) bytes += raw(i, is_big);
  }
  return bytes;
}

// A strip a face, and ones of all six.
std::string strips_ply(bool is_one) {
  std::string rows;
  int numbers = 0;
  for (const auto& face : kCorners) {
    const std::string strip = std::to_string(face[0]) + ' ' + std::to_string(face[1]) + ' ' +
                              std::to_string(face[3]) + ' ' + std::to_string(face[2]);
    rows += is_one ? " " + strip + " -1" : "4 " + strip + "\n";
    numbers += 5;
  }
  return "ply\nformat ascii 1.0\nelement vertex 8\n" + kXyz + "element tristrips " +
         (is_one ? "1\n" : "6\n") + "property list int int vertex_indices\nend_header\n" +
         kVertices + (is_one ? std::to_string(numbers) : "") + rows + (is_one ? "\n" : "");
}

Rows ply_rows() {
  const std::string head = ply_of("ascii", kXyz, kIndices), good = head + kVertices + kFaces;
  const std::string coloured = ply_of("ascii", kXyz + "property uchar red\nproperty uchar green\n",
                                      kIndices + "property list uchar float texcoord\n");
  const auto change = [&](const std::string& from, const std::string& to) {
    return with(good, from, to);
  };
  std::string nan = binary_ply(false);
  nan.replace(nan.find("end_header\n") + 11, 8, 8, '\xff');
  return {
      box("plain.ply", good),
      box("mark.ply", "\xEF\xBB\xBF" + good),
      box("crlf.ply", replaced(good, "\n", "\r\n")),
      box("vertex_index.ply", change("uchar int vertex_indices", "int uint vertex_index")),
      box("types.ply", change("uchar int", "uint16 uint8")),
      box("doubles.ply", replaced(good, "float", "float64")),
      box("plural.ply", with(change("element vertex", "element vertices"), "face 6", "faces 6")),
      box("extra_lists.ply",
          coloured + framed(kVertices, "", " 255 0") + framed(kFaces, "", " 2 0.5 1")),
      // RealSense writes colours on a line of their own.
      box("broken_rows.ply",
          coloured + framed(kVertices, "", " \n255 0") + framed(kFaces, "", "\n2 0.5\n1")),
      box("other_elements.ply",
          with(change("element face",
                      "element edge 1\nproperty int a\nproperty list uchar float "
                      "b\nelement face"),
               "4 0 3 2 1", "7 2 0.5 1.5\n4 0 3 2 1")),
      box("material_behind.ply",
          change("end_header", "element material 1\nproperty int a\nend_header") + "7\n"),
      box("faces_first.ply", "ply\nformat ascii 1.0\nelement face 6\n" + kIndices +
                                 "element vertex 8\n" + kXyz + "end_header\n" + kFaces + kVertices),
      box("nan_normals.ply", with(head, "float z\n", "float z\nproperty float nx\n") +
                                 framed(kVertices, "", " -nan") + kFaces),
      box("little.ply", binary_ply(false)),
      box("big.ply", binary_ply(true)),
      box("binary_crlf.ply", binary_ply(false, "\r\n")),
      box("binary_line_end.ply", binary_ply(false) + "\n"),
      box("strips.ply", strips_ply(false)),
      box("one_strip.ply", strips_ply(true)),
      mesh("joined_strips.ply",
           "ply\nformat ascii 1.0\nelement vertex 5\n" + kXyz +
               "element tristrips 1\nproperty list int int "
               "vertex_index\nelement face 1\n" +
               kIndices +
               "end_header\n0 0 0\n1 0 0\n0 1 0\n1 1 0\n2 0 0\n"
               "6 0 1 2 2 3 3\n3 1 4 3\n",
           5, 2, 1),
      mesh("unused.ply", with(with(good, "vertex 8", "vertex 9"), "4 0 3 2 1", "9 9 9\n4 0 3 2 1"),
           8, 12, kArea, kVolume),
      refused("two_faces.ply", "more than one element 'face'",
              change("end_header", "element face 1\n" + kIndices + "end_header") + "3 0 1 2\n"),
      refused("two_vertices.ply", "more than one element 'vertex'",
              change("end_header", "element vertices 1\n" + kXyz + "end_header") + "0 0 0\n"),
      refused("floats.ply", "whole numbers", change("uchar int", "uchar float")),
      refused("half.ply", ":20: '1.5' is not a whole number", change("4 0 3 2 1", "4 0 3 2 1.5")),
      refused("promise.ply", ":20: a list is longer than the rest of the file",
              change("4 0 3 2 1", "1000000000 0 3 2 1")),
      refused("longer_row.ply",
              ":13: the header declares 3 numbers per element, but this line has 4",
              change("2 0 0", "2 0 0 9")),
      refused("shorter_row.ply",
              ":13: the header declares 3 numbers per element, but they end within line 14",
              change("2 0 0", "2 0")),
      refused("cut.ply", "the file ends before its last", change("4 3 0 4 7\n", "")),
      refused("more_bytes.ply", "the file has 17 bytes after its last element",
              with(binary_ply(true), "face 6", "face 5")),
      refused("index.ply", ":20: face 0 has an index out of range",
              change("4 0 3 2 1", "4 0 3 2 8")),
      refused("nan.ply", ":14: a coordinate of vertex 2 must be finite",
              change("2 3 0", "2 nan 0")),
      refused("binary_nan.ply", "a coordinate of vertex 0 must be finite", nan),
      refused("no_z.ply", "no property 'z'", change("float z", "float w")),
      refused("twice.ply", "the property 'x' is declared twice", change("float y", "float x")),
      refused("quad.ply", "the type 'quad' is unknown", change("float x", "quad x")),
      refused("no_element.ply", ":3: a property precedes",
              change("comment a box", "property int a")),
      refused("no_list.ply", "no list 'vertex_indices'", change("vertex_indices", "corners")),
      refused("points.ply", "no faces",
              "ply\nformat ascii 1.0\nelement vertex 1\n" + kXyz + "end_header\n0 0 0\n"),
      refused("no_vertices.ply", "the element 'vertex' is missing",
              change("element vertex", "element point")),
      refused("png.ply", "is not a PLY file", "\x89PNG\r\n\x1a\n"),
  };
}

Rows other_rows() {
  Rows rows;
  for (const char* file :
       {"a.gltf", "a.glb", "a.dae", "a.fbx", "a.3mf", "a.stp", "a.off.gz", "off"}) {
    rows.push_back(refused(file, "a mesh must have the ending .off, .obj, .stl or .ply", kOff));
  }
  // One format's text under another's name.
  rows.push_back(refused("off.ply", "is not a PLY file", kOff));
  rows.push_back(refused("off.obj", "off.obj:1: ", kOff));
  rows.push_back(
      refused("ply.off", "ply.off:1: the file is not an OFF file", "ply\nformat ascii 1.0\n"));
  rows.push_back(refused("utf16.obj", "utf16.obj:1: ", std::string("\xff\xfev\0 \0000\0", 8)));
  return rows;
}

}  // namespace

std::vector<MeshDialect> mesh_dialects() {
  Rows all;
  for (const Rows& rows : {off_rows(), obj_rows(), stl_rows(), ply_rows(), other_rows()}) {
    all.insert(all.end(), rows.begin(), rows.end());
  }
  return all;
}

}  // namespace viewgain::test
