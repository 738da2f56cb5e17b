// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0

// Every reader of foreign bytes over good files, all their cuts and thousands of single changes: it
// reads or throws Error, and under sanitizers nothing else happens. What a reader says of which
// damage is tested beside it.

#include <gtest/gtest.h>

#include <cctype>
#include <filesystem>
#include <random>
#include <string>
#include <vector>

#include "mesh/files/mesh_dialects.hpp"
#include "readers/readers.hpp"
#include "viewgain/core/error.hpp"
#include "viewgain/mesh/mesh_io.hpp"
#include "viewgain/support/json.hpp"

namespace viewgain {
namespace test {

void PrintTo(const Reader& reader, std::ostream* out) { *out << reader.name; }

}  // namespace test
namespace {

namespace fs = std::filesystem;
using test::all_readers;
using test::read_all;
using test::Reader;
using test::TemporaryFolder;

constexpr std::size_t kCuts = 400, kChanges = 1500;  // of a file, at most

// One of six kinds of change.
std::string changed(std::string bytes, std::size_t kind, std::mt19937& random) {
  const auto below = [&](std::size_t count) { return random() % count; };
  const std::size_t at = below(bytes.size());
  switch (kind % 6) {
    case 0:
      bytes[at] = static_cast<char>(bytes[at] ^ (1U << below(8)));
      break;
    case 1:
      bytes[at] = static_cast<char>(below(256));
      break;
    case 2:
      bytes.erase(at, 1 + below(4));
      break;
    case 3:
      bytes.insert(at, 1 + below(40), "0919-e.\n \xff"[below(10)]);
      break;
    case 4:  // a number of four bytes, as counts and sizes are
      for (std::size_t k = 0; k < 4 && at + k < bytes.size(); ++k) {
        bytes[at + k] = static_cast<char>(kind % 12 == 4 ? 0xff : below(256));
      }
      break;
    default:
      bytes += bytes.substr(at);
  }
  return bytes;
}

class DamagedBytes : public testing::TestWithParam<Reader> {
 protected:
  // Whether the reader took it; anything but Error ends the test.
  bool is_read() const {
    try {
      GetParam().read(folder_.path());
      return true;
    } catch (const Error& error) {
      EXPECT_FALSE(std::string(error.what()).empty());
      return false;
    }
  }

  TemporaryFolder folder_;
};

TEST_P(DamagedBytes, AreReadOrRefused) {
  const Reader& reader = GetParam();
  reader.write(folder_);
  ASSERT_TRUE(is_read());
  std::mt19937 random(7);
  const std::size_t cuts = kCuts / reader.one_in, changes = kChanges / reader.one_in;
  for (const std::string& name : reader.damaged) {
    const std::string good = read_all(folder_.path() / name);
    ASSERT_GT(good.size(), 10U) << name;
    std::size_t cases = 0, refused = 0;
    const auto check = [&](const std::string& bytes) {
      folder_.file(name, bytes);
      ++cases;
      refused += is_read() ? 0 : 1;
    };
    const std::size_t step = (good.size() + cuts - 1) / cuts;
    for (std::size_t length = 0; length < good.size(); length += step) {
      check(good.substr(0, length));
    }
    EXPECT_GT(refused, 0U) << name;
    for (std::size_t i = 0; i < changes; ++i) check(changed(good, i, random));
    folder_.file(name, good);
    EXPECT_EQ(cases, (good.size() + step - 1) / step + changes) << name;
    ASSERT_TRUE(is_read()) << name;
  }
}

INSTANTIATE_TEST_SUITE_P(Readers, DamagedBytes, testing::ValuesIn(all_readers()),
                         [](const auto& reader) {
                           std::string name = reader.param.name;
                           for (char& c : name) c = std::isalnum(c) != 0 ? c : '_';
                           return name;
                         });

// The table of mesh dialects, each changed once to three times.
TEST(DamagedMeshes, AreReadOrRefused) {
  constexpr std::size_t kFiles = 20'000;
  const TemporaryFolder folder;
  const std::vector<test::MeshDialect> rows = test::mesh_dialects();
  std::mt19937 random(9);
  std::size_t read = 0, refused = 0;
  for (std::size_t i = 0; read + refused < kFiles; ++i) {
    const test::MeshDialect& row = rows[i % rows.size()];
    std::string bytes = row.bytes;
    for (std::size_t k = i % 3; k < 3 && !bytes.empty(); ++k) {
      bytes = changed(std::move(bytes), random() % 12, random);
    }
    try {
      const TriangleMesh mesh = read_mesh(folder.file(row.file, bytes));
      ASSERT_FALSE(mesh.triangles.empty()) << row.file;
      for (const auto& t : mesh.triangles) {
        for (const std::uint32_t corner : t) ASSERT_LT(corner, mesh.vertices.size()) << row.file;
      }
      ++read;
    } catch (const Error& error) {
      ASSERT_NE(std::string(error.what()).find(row.file + ":"), std::string::npos) << error.what();
      ++refused;
    }
  }
  EXPECT_GT(read, kFiles / 40);
  EXPECT_GT(refused, kFiles / 40);
}

// What the fuzzers came upon.
TEST(FuzzedBytes, AreReadOrRefused) {
  std::size_t read = 0, files = 0;
  for (const Reader& reader : all_readers()) {
    const fs::path inputs = fs::path(VIEWGAIN_FUZZ_CORPUS) / reader.name;
    if (!fs::exists(inputs)) continue;
    const TemporaryFolder folder;
    reader.write(folder);
    for (const auto& entry : fs::directory_iterator(inputs)) {
      ++files;
      try {
        test::read_in_place(reader, folder, read_all(entry.path()));
        ++read;
      } catch (const Error& error) {
        EXPECT_NE(std::string(error.what()).find(folder.path().string()), std::string::npos)
            << entry.path() << ": " << error.what();
      }
    }
  }
  EXPECT_GE(read, 6U);
  EXPECT_GE(files, 8U);
}

// Those of the corpus and some at random; returns how many calls succeeded.
std::size_t fuzzed_calls(const std::string& name, std::size_t (*call)(std::string_view)) {
  std::size_t calls = 0;
  for (const auto& entry : fs::directory_iterator(fs::path(VIEWGAIN_FUZZ_CORPUS) / name)) {
    calls += call(read_all(entry.path()));
  }
  std::mt19937 random(11);
  for (int i = 0; i < 20; ++i) {
    std::string bytes;
    for (int k = 0; k < 300; ++k) bytes += static_cast<char>(random());
    calls += call(bytes);
  }
  return calls;
}

TEST(FuzzedCalls, AreTakenOrRefused) {
  EXPECT_GT(fuzzed_calls("c_calls", test::c_calls), 400U);
  EXPECT_GT(fuzzed_calls("scorer_calls", test::scorer_calls), 400U);
}

TEST(DamagedJson, IsReadOrRefused) {
  const std::string good = R"({"a": [1, -2, 2.5e3, true, null], "b": {"c": "\u00e4 text"}})";
  EXPECT_EQ(app::parse_or_null(app::dumped(app::parse_or_null(good))), app::parse_or_null(good));
  std::size_t refused = 0;
  for (std::size_t length = 0; length < good.size(); ++length) {
    refused += app::parse_or_null(good.substr(0, length)).is_null() ? 1 : 0;
  }
  EXPECT_EQ(refused, good.size());
  EXPECT_TRUE(app::parse_or_null(std::string(100'000, '[')).is_null());
  EXPECT_EQ(app::dumped(app::Json("\xE9")), "\"\uFFFD\"");
}

TEST(DamagedBytes, EveryReaderIsHere) { EXPECT_EQ(all_readers().size(), 26U); }

}  // namespace
}  // namespace viewgain
