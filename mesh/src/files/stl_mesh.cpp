// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <bit>
#include <cctype>
#include <cstdint>
#include <string>
#include <unordered_map>
#include <utility>

#include "mesh_builder.hpp"
#include "viewgain/core/error.hpp"
#include "viewgain/support/hash64.hpp"
#include "viewgain/support/ply_file.hpp"
#include "word_reader.hpp"

namespace viewgain::detail {
namespace {

constexpr std::size_t kStlHeader = 80, kStlBody = 84, kStlTriangle = 50;  // [bytes]

// `lower` is in lower case; files use any case.
bool is_stl_word(std::string_view word, std::string_view lower) {
  return std::equal(word.begin(), word.end(), lower.begin(), lower.end(), [](char a, char b) {
    return std::tolower(static_cast<unsigned char>(a)) == b;
  });
}

// A mesh whose points are repeated in every triangle.
class StlMesh {
 public:
  explicit StlMesh(const std::string& name) : mesh_(name) {}

  void add_corner(const std::array<double, 3>& p, std::size_t line) {
    const auto [found, is_new] = places_.try_emplace(p, mesh_.vertices());
    if (is_new) mesh_.add_vertex(p, line);
    mesh_.add_corner(static_cast<double>(found->second), line);
  }
  void end_face(std::size_t line) { mesh_.end_face(line); }
  TriangleMesh finish(MeshRepairs& repairs) && { return std::move(mesh_).finish(repairs); }

 private:
  struct Hash {
    std::size_t operator()(const std::array<double, 3>& p) const {
      std::uint64_t hash = 0;
      // Adding 0 turns -0 into +0, which is equal.
      for (const double x : p) hash = mix64(hash + kMixStep + std::bit_cast<std::uint64_t>(x + 0));
      return hash;
    }
  };
  std::unordered_map<std::array<double, 3>, std::size_t, Hash> places_;
  MeshBuilder mesh_;
};

class StlText {
 public:
  StlText(std::string_view bytes, const std::string& name)
      : lines_(name, bytes), words_(lines_), mesh_(name) {}

  TriangleMesh read(MeshRepairs& repairs) {
    while (words_.more()) {
      if (is_next("facet")) {
        read_facet();
      } else if (is_next("solid")) {
        skip_name();
      } else if (is_end("solid")) {
        // Some files have the next solid in the same line.
        while (words_.more_here() && !is_facet() && !is_stl_word(words_.peek(), "solid")) {
          (void)words_.next();
        }
      } else {
        fail_at("facet");
      }
    }
    return std::move(mesh_).finish(repairs);
  }

 private:
  [[noreturn]] void fail_at(const std::string& expected) {
    lines_.fail("found " + quoted(words_.peek()) + ", not \"" + expected + "\"");
  }
  // Takes the word if it is the next one.
  bool is_next(std::string_view word) {
    if (!is_stl_word(words_.peek(), word)) return false;
    (void)words_.next();
    return true;
  }
  // "endloop" or, in some files, "end loop".
  bool is_end(const std::string& what) {
    return is_next("end" + what) || (is_next("end") && (is_next(what) || (fail_at(what), false)));
  }
  // Whether a facet begins here. A name may contain the word.
  bool is_facet() {
    const std::string_view second = words_.second_here();
    return is_stl_word(words_.peek(), "facet") &&
           (is_stl_word(second, "normal") || is_stl_word(second, "outer"));
  }
  // A name has any words; in some files the whole solid is in one line.
  void skip_name() {
    while (words_.more_here() && !is_facet()) (void)words_.next();
  }

  void read_facet() {
    if (is_next("normal")) {
      while (!is_stl_word(words_.peek(), "outer")) (void)words_.number();
    }
    if (!is_next("outer") || !is_next("loop")) fail_at("outer loop");
    std::size_t corners = 0;
    for (; !is_end("loop"); ++corners) {
      if (!is_next("vertex")) fail_at("vertex");
      std::array<double, 3> p{};
      for (double& x : p) x = words_.finite_number();
      mesh_.add_corner(p, words_.line());
    }
    if (corners < 3) lines_.fail("a facet has fewer than 3 vertices");
    mesh_.end_face(words_.line());
    if (!is_end("facet")) fail_at("endfacet");
  }

  LineReader lines_;
  WordReader words_;
  StlMesh mesh_;
};

TriangleMesh binary_stl_mesh(std::string_view bytes, std::uint64_t count, const std::string& name,
                             MeshRepairs& repairs) {
  StlMesh mesh(name);
  for (std::uint64_t t = 0; t < count; ++t) {
    const char* at = bytes.data() + kStlBody + t * kStlTriangle + 12;  // after the normal
    for (int corner = 0; corner < 3; ++corner) {
      std::array<double, 3> p{};
      for (double& x : p) x = decode(at, {}), at += 4;
      mesh.add_corner(p, 0);
    }
    mesh.end_face(0);
  }
  return std::move(mesh).finish(repairs);
}

// Both kinds of files can begin with "solid". No text has the size that its bytes 80 to 83 would
// state.
bool is_stl_text(std::string_view bytes, std::uint64_t promised, bool has_nul) {
  if (bytes.size() == kStlBody + kStlTriangle * promised) return false;
  const auto skip_to = [&bytes](std::size_t place) {
    bytes.remove_prefix(std::min(place, bytes.size()));
  };
  skip_to(bytes.find_first_not_of(" \t\r\n"));
  while (bytes.starts_with('#')) {
    skip_to(bytes.find_first_of("\r\n"));
    skip_to(bytes.find_first_not_of(" \t\r\n"));
  }
  const bool has_word =
      is_stl_word(bytes.substr(0, 5), "solid") || is_stl_word(bytes.substr(0, 5), "facet");
  return has_word && !has_nul;
}

}  // namespace

TriangleMesh stl_mesh(std::string_view bytes, const std::string& name, MeshRepairs& repairs) {
  std::uint64_t promised = 0;
  if (bytes.size() >= kStlBody) {
    constexpr ScalarType kCount{ScalarType::Kind::unsigned_integer, 4};
    promised = static_cast<std::uint64_t>(decode(bytes.data() + kStlHeader, kCount));
  }
  const bool has_nul = bytes.find('\0') != std::string_view::npos;
  if (is_stl_text(bytes, promised, has_nul)) {
    std::string copy;
    return StlText(with_one_line_end(bytes, copy), name).read(repairs);
  }
  const auto fail = [&](const std::string& what) {
    throw Error(ErrorCode::format, name + ": " + what);
  };
  if (bytes.size() < kStlBody)
    fail(
        "the file is not an STL file: it does not begin with \"solid\", and it is too short for a "
        "binary STL file");
  // Fewer bytes than a triangle's may follow.
  const std::uint64_t held = (bytes.size() - kStlBody) / kStlTriangle;
  if (promised != held && !has_nul)
    fail(
        "the file is not an STL file: it does not begin with \"solid\", and it is not a binary STL "
        "file");
  if (promised != held) {
    fail("the header declares " + std::to_string(promised) + " triangles, but the file holds " +
         std::to_string(held));
  }
  return binary_stl_mesh(bytes, promised, name, repairs);
}

}  // namespace viewgain::detail
