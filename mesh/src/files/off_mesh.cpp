// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <utility>

#include "mesh_builder.hpp"
#include "word_reader.hpp"

namespace viewgain::detail {
namespace {

constexpr double kMostOffRows = std::numeric_limits<std::uint32_t>::max();

class OffReader {
 public:
  OffReader(std::string_view bytes, const std::string& name)
      : lines_(name, bytes), words_(lines_), mesh_(name) {}

  TriangleMesh read(MeshRepairs& repairs) {
    read_keyword();
    read_counts();
    read_rows();
    return std::move(mesh_).finish(repairs);
  }

 private:
  // [ST][C][N]OFF, in many files directly followed by the first count. The keyword may be missing.
  void read_keyword() {
    if (!words_.more()) lines_.fail("the file is empty");
    std::string_view word = words_.peek();
    if (word.find_first_not_of("0123456789") == std::string_view::npos) return;
    const auto takes = [&word](std::string_view part) {
      const bool is_there = word.starts_with(part);
      if (is_there) word.remove_prefix(part.size());
      return is_there;
    };
    for (bool more = true; more;) {
      more = false;
      for (const auto& [flag, numbers] :
           {std::pair<const char*, std::size_t>{"ST", 2}, {"C", 4}, {"N", 3}}) {
        if (!takes(flag)) continue;
        vertex_numbers_ += numbers;
        more = true;
      }
    }
    if (word.starts_with("4OFF") || word.starts_with("nOFF") || word.starts_with("4nOFF")) {
      lines_.fail("vertices must have 3 coordinates");
    }
    if (!takes("OFF") && !takes("off")) {
      lines_.fail("the file is not an OFF file; it must begin with \"OFF\"");
    }
    (void)words_.next();
    if (!word.empty()) {
      glued_ = lines_.number_of(word);
    } else if (words_.more_here() && words_.peek() == "BINARY") {
      lines_.fail("binary OFF is not supported; write text");
    }
  }

  double read_count() {
    const double count = glued_ ? *glued_ : words_.whole_number();
    glued_.reset();
    if (count >= 0 && count <= kMostOffRows && count == std::floor(count)) return count;
    lines_.fail("the counts of vertices and faces must be whole numbers up to 2^32");
  }

  // The count of edges, which is not needed, is missing in some files.
  void read_counts() {
    vertices_ = read_count();
    const std::size_t line = words_.line();
    faces_ = read_count();
    if (words_.more_here()) {
      (void)words_.number();
    } else if (words_.line() != line && words_.more()) {
      LineReader one_each = lines_;
      if (words_before_comment(one_each) == 1) (void)words_.number();
    }
  }

  // Whether exactly this many lines follow.
  [[nodiscard]] bool has_lines(double wanted) const {
    if (words_.more_here()) return false;
    LineReader ahead = lines_;
    double count = 0;
    while (count <= wanted && ahead.next()) count += words_before_comment(ahead) > 0 ? 1 : 0;
    return count == wanted;
  }

  void read_rows() {
    const bool has_rows = has_lines(vertices_ + faces_);
    for (double i = 0; i < vertices_; ++i) {
      std::array<double, 3> p{};
      for (double& x : p) {
        if (has_rows && &x != p.data() && !words_.more_here()) {
          lines_.fail("a vertex has fewer than 3 coordinates");
        }
        x = words_.finite_number();
      }
      mesh_.add_vertex(p, words_.line());
      if (has_rows) {
        end_row(9);  // a normal, a colour, two texture coordinates
      } else {
        for (std::size_t k = 3; k < vertex_numbers_; ++k) (void)words_.number();
      }
    }
    const bool has_face_rows = has_rows || has_lines(faces_);
    for (double i = 0; i < faces_; ++i) {
      const double corners = words_.whole_number();
      if (!(corners >= 0)) lines_.fail("a face has a negative number of corners");
      for (double k = 0; k < corners; ++k) {
        if (has_face_rows && !words_.more_here()) lines_.fail("a face has too few corners");
        mesh_.add_corner(words_.whole_number(), words_.line());
      }
      mesh_.end_face(words_.line());
      if (has_face_rows) end_row(4);  // a colour
    }
    if (words_.more()) lines_.fail("the file continues after its last face");
  }

  void end_row(std::size_t most) {
    for (; words_.more_here(); --most) {
      if (most == 0) lines_.fail("the line has too many numbers");
      (void)words_.number();
    }
  }

  LineReader lines_;
  WordReader words_;
  MeshBuilder mesh_;
  std::size_t vertex_numbers_ = 3;
  std::optional<double> glued_;
  double vertices_ = 0, faces_ = 0;
};

}  // namespace

TriangleMesh off_mesh(std::string_view bytes, const std::string& name, MeshRepairs& repairs) {
  return OffReader(bytes, name).read(repairs);
}

}  // namespace viewgain::detail
