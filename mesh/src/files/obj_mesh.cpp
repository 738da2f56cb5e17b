// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "mesh_builder.hpp"
#include "word_reader.hpp"

namespace viewgain::detail {
namespace {

// Statements that a mesh does not need: other elements, names, materials, and curves.
constexpr std::array<std::string_view, 34> kSkippedInObj{
    "vt",   "vn",       "vp",       "l",          "p",         "g",      "s",
    "o",    "mg",       "usemtl",   "usemap",     "mtllib",    "maplib", "bevel",
    "lod",  "c_interp", "d_interp", "shadow_obj", "trace_obj", "cstype", "deg",
    "bmat", "step",     "curv",     "curv2",      "parm",      "trim",   "hole",
    "scrv", "sp",       "end",      "con",        "ctech",     "stech"};

class ObjReader {
 public:
  ObjReader(std::string_view bytes, const std::string& name) : lines_(name, bytes), mesh_(name) {}

  TriangleMesh read(MeshRepairs& repairs) {
    while (next_statement()) {
      const std::string_view keyword = words_[0];
      if (keyword == "v") {
        add_vertex();
      } else if (keyword == "f") {
        add_face();
      } else if (keyword == "surf") {
        lines_.fail("free-form surfaces are not supported");
      } else if (keyword == "call" || keyword == "csh") {
        lines_.fail("statements that include other files or run commands are not supported");
      } else if (std::find(kSkippedInObj.begin(), kSkippedInObj.end(), keyword) ==
                 kSkippedInObj.end()) {
        lines_.fail("the keyword " + quoted(keyword) + " is not a known OBJ statement");
      }
    }
    return std::move(mesh_).finish(repairs);
  }

 private:
  // Reads the words up to a line that does not end in a backslash; false at the end.
  bool next_statement() {
    words_.clear();
    for (bool goes_on = false, is_glued = false; goes_on || words_.empty();) {
      const char* const begin = lines_.rest().data();
      if (!lines_.next()) {
        if (goes_on) lines_.fail("the file ends after a backslash");
        return false;
      }
      const auto& words = lines_.words();
      if (is_glued && !words.empty() && words[0].data() == begin) {
        lines_.fail("a backslash must end its line");
      }
      const auto count = static_cast<std::ptrdiff_t>(words_before_comment(lines_));
      words_.insert(words_.end(), words.begin(), words.begin() + count);
      goes_on = count > 0 && words_.back().ends_with('\\');
      if (!goes_on) continue;
      words_.back().remove_suffix(1);
      is_glued = !words_.back().empty();
      if (!is_glued) words_.pop_back();
    }
    return true;
  }

  void add_vertex() {
    std::array<double, 7> numbers{};
    const std::size_t count = words_.size() - 1;
    if (count < 3 || count == 5 || count > numbers.size()) {
      lines_.fail("expected 3 coordinates, and optionally a weight and a colour; found " +
                  std::to_string(count) + " numbers");
    }
    for (std::size_t i = 0; i < count; ++i) numbers[i] = lines_.number_of(words_[i + 1]);
    // Seven numbers are x y z w r g b or x y z r g b a. The weight or alpha of 1 shows which.
    const bool has_weight = count == 4 || (count == 7 && numbers[6] != 1);
    if (has_weight && numbers[3] != 1) {
      lines_.fail("the fourth number of a vertex is a weight; only the weight 1 is supported");
    }
    mesh_.add_vertex({numbers[0], numbers[1], numbers[2]}, lines_.line());
  }

  // Corners are "v", "v/vt", "v//vn" or "v/vt/vn", counted from 1, or from -1 backward.
  void add_face() {
    for (std::size_t i = 1; i < words_.size(); ++i) {
      std::string_view rest = words_[i];
      for (int part = 0; part == 0 || !rest.empty(); ++part) {
        const std::size_t end = std::min(rest.find('/'), rest.size());
        const std::string_view word = rest.substr(0, end);
        rest.remove_prefix(std::min(end + 1, rest.size()));
        const double index = part > 0 && word.empty() ? 1 : lines_.number_of(word);
        if (index != std::floor(index) || part > 2) {
          lines_.fail(quoted(words_[i]) + " is not a corner of a face");
        }
        if (part > 0) continue;
        if (index == 0) lines_.fail("index 0 is out of range; indices start at 1");
        const double before = index < 0 ? static_cast<double>(mesh_.vertices()) : -1;
        mesh_.add_corner(before + index, lines_.line());
      }
    }
    mesh_.end_face(lines_.line());
  }

  LineReader lines_;
  MeshBuilder mesh_;
  std::vector<std::string_view> words_;
};

}  // namespace

TriangleMesh obj_mesh(std::string_view bytes, const std::string& name, MeshRepairs& repairs) {
  std::string copy;
  return ObjReader(with_one_line_end(bytes, copy), name).read(repairs);
}

}  // namespace viewgain::detail
