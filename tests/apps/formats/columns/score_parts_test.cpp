// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0

// `score --shard`, poses and gains in columns: parts put together are the whole.
#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <limits>
#include <sstream>
#include <string>
#include <vector>

#include "apps/program_runner.hpp"
#include "core/expect_error.hpp"
#include "viewgain/core/generators.hpp"
#include "viewgain/core/pose_io.hpp"
#include "viewgain/grid/vdb_io.hpp"
#include "viewgain/support/columns/mapped_poses.hpp"
#include "viewgain/support/columns/npy_header.hpp"
#include "viewgain/support/mix64.hpp"
#include "viewgain/support/text.hpp"

namespace viewgain {
namespace {

class ScoreParts : public test::ProgramTest {
 protected:
  ScoreParts() {
    write_small_sensor();
    BeliefGrid grid{{0.02, {{-0.2, -0.2, -0.2}, {0.2, 0.2, 0.2}}, {}, 0.02}};
    for (int x = -10; x < 10; ++x) {
      for (int y = -10; y < 10; ++y) {
        for (int z = 0; z < 10; ++z) grid.set({x, y, z}, -0.1F * static_cast<float>(1 + (x & 7)));
      }
    }
    for (int x = -3; x < 3; ++x) {
      for (int y = -3; y < 3; ++y) grid.set({x, y, 4}, 0.85F);
    }
    save_vdb(grid, dir / "map.vdb");
    // Above the table only, so that half of the poses are dropped.
    write("reach.toml", "[[box]]\nmin = [-1, -1, 0]\nmax = [1, 1, 1]\n");
  }

  [[nodiscard]] static Strings arguments(const Strings& more) {
    return test::joined({"score", "map.vdb", "--sensor", "small.toml", "--sphere", "40,0.45"},
                        more);
  }
  void score(const Strings& more) const { (void)run_well(arguments(more)); }
  // Without lines of #.
  [[nodiscard]] std::string rows_of(const std::string& name) const {
    std::istringstream in(read(name));
    std::string rows;
    for (std::string line; std::getline(in, line);) {
      if (!line.starts_with('#')) rows += line + "\n";
    }
    return rows;
  }

  // A .npy file: its type and shape as numpy writes them, and numbers.
  void write_npy(const std::string& name, const std::string& type, const std::string& shape,
                 const std::vector<double>& numbers) const {
    std::string header =
        "{'descr': " + type + ", 'fortran_order': False, 'shape': " + shape + ", }\n";
    std::string bytes("\x93NUMPY\x01\0", 8);
    bytes += static_cast<char>(header.size());
    bytes += '\0';
    bytes += header;
    for (const double number : numbers) {
      const auto bits = std::bit_cast<std::uint64_t>(number);
      for (unsigned i = 0; i < 64; i += 8) bytes += static_cast<char>(bits >> i & 255U);
    }
    write(name, bytes);
  }
  void write_matrices(const std::string& name, const std::vector<Pose>& poses) const {
    std::vector<double> numbers;
    for (const Pose& pose : poses) {
      numbers.insert(numbers.end(), pose.m.begin(), pose.m.end());
      numbers.insert(numbers.end(), {0, 0, 0, 1});
    }
    write_npy(name, "'<f8'", "(" + std::to_string(poses.size()) + ", 4, 4)", numbers);
  }
};

TEST_F(ScoreParts, TogetherAreTheWholeForEveryGain) {
  std::size_t cases = 0;
  for (const Strings& flags : std::vector<Strings>{{},
                                                   {"--gain", "surface"},
                                                   {"--gain", "combined"},
                                                   {"--gain", "unknown_count,rear_side_voxel"},
                                                   {"--approximate", "0.3"},
                                                   {"--reach", "reach.toml"}}) {
    score(test::joined(flags, {"--out", "plain.csv"}));
    for (const std::string ending : {".csv", ".npy"}) {
      score(test::joined(flags, {"--shard", "0/1", "--out", "whole" + ending}));
      // Of 50 shards some have no pose.
      const std::vector<int> counts = flags.empty() ? std::vector{1, 3, 50} : std::vector{3};
      for (const int shards : counts) {
        Strings merge{"merge", "--out", "merged" + ending};
        for (int i = shards - 1; i >= 0; --i) {
          const std::string part = "part" + std::to_string(i) + ending;
          score(test::joined(flags, {"--shard", std::to_string(i) + "/" + std::to_string(shards),
                                     "--threads", std::to_string(1 + i % 2), "--out", part}));
          merge.push_back(part);
        }
        (void)run_well(merge);
        EXPECT_EQ(read("merged" + ending), read("whole" + ending)) << shards << ending;
        ++cases;
      }
    }
    EXPECT_EQ(rows_of("merged.csv"), read("plain.csv"));
    // From columns to text and back nothing is lost.
    (void)run_well({"merge", "whole.npy", "--out", "again.csv"});
    EXPECT_EQ(read("again.csv"), read("whole.csv"));
    (void)run_well({"merge", "whole.csv", "--out", "again.npy"});
    EXPECT_EQ(read("again.npy"), read("whole.npy"));
  }
  EXPECT_EQ(cases, 16U);
}

TEST_F(ScoreParts, PosesInColumnsAreThoseOfText) {
  const std::vector<Pose> poses = sphere_poses(40, 0.45);
  write_tum(dir / "poses.txt", poses);
  std::vector<double> columns;
  std::istringstream tum(read("poses.txt"));
  std::string line;
  std::getline(tum, line);
  for (double value = 0; tum >> value;) columns.push_back(value);
  write_matrices("matrices.npy", poses);
  write_npy("columns.npy",
            "[('name', '<U2'), ('tx', '<f8'), ('ty', '<f8'), ('tz', '<f8'), ('qx', '<f8'), "
            "('qy', '<f8'), ('qz', '<f8'), ('qw', '<f8')]",
            "(40,)", columns);
  const Strings head{"score", "map.vdb", "--sensor", "small.toml"};
  const auto rows = [&](const Strings& more) {
    (void)run_well(test::joined(test::joined(head, more), {"--shard", "1/3", "--out", "part.csv"}));
    return rows_of("part.csv");
  };
  const std::string sphere = rows({"--sphere", "40,0.45"});
  EXPECT_EQ(rows({"--poses", "matrices.npy"}), sphere);
  const std::string text = rows({"--poses", "poses.txt"});
  EXPECT_EQ(rows({"--poses", "columns.npy"}), text);
  EXPECT_EQ(text.size() > 13U * 50U, true);
}

TEST_F(ScoreParts, OneOtherPoseMakesAnotherJob) {
  std::vector<Pose> poses = sphere_poses(9001, 0.45);
  for (const std::string shard : {"0/2", "1/2"}) {
    write_tum(dir / "poses.txt", poses);
    write_matrices("poses.npy", poses);
    for (const std::string name : {"poses.txt", "poses.npy"}) {
      (void)run_well({"score", "map.vdb", "--sensor", "small.toml", "--stride", "100", "--poses",
                      name, "--shard", shard, "--out", name + shard.substr(0, 1) + ".csv"});
    }
    poses[4321].m[3] += 1e-6;
  }
  for (const std::string name : {"poses.txt", "poses.npy"}) {
    expect_refused({"merge", name + "0.csv", name + "1.csv", "--out", "all.csv"}, "poses 9001");
  }
}

TEST_F(ScoreParts, BadColumnsOfPosesAreNamed) {
  std::vector<double> identity{1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};
  write_npy("good.npy", "'<f8'", "(1, 4, 4)", identity);
  write("none.npy", "index,gain\n");
  write("byte.npy", read("good.npy").substr(0, read("good.npy").size() - 1));
  write_npy("short.npy", "'<f8'", "(2, 4, 4)", identity);
  write_npy("empty.npy", "'<f8'", "(0, 4, 4)", {});
  write_npy("float.npy", "'<f4'", "(2, 4, 4)", identity);
  write_npy("big.npy", "'>f8'", "(1, 4, 4)", identity);
  write_npy("flat.npy", "'<f8'", "(16,)", identity);
  write_npy("lacks.npy", "[('tx', '<f8'), ('ty', '<f8')]", "(8,)", identity);
  write_npy("broken.npy", "[('tx', '<f8'", "(8,)", identity);
  write_npy("huge.npy", "'<f8'", "(281474976710656, 4, 4)", identity);
  std::vector<double> scaled = identity, row = identity, nan = identity;
  scaled[0] = 2;
  row[15] = 2;
  nan[3] = std::bit_cast<double>(std::uint64_t{0x7ff8000000000000});
  write_npy("scaled.npy", "'<f8'", "(1, 4, 4)", scaled);
  write_npy("row.npy", "'<f8'", "(1, 4, 4)", row);
  write_npy("nan.npy", "'<f8'", "(1, 4, 4)", nan);
  const Strings head{"score", "map.vdb", "--sensor", "small.toml", "--poses"};
  for (const auto& [name, word] :
       std::vector<std::pair<std::string, std::string>>{{"none.npy", "no .npy"},
                                                        {"byte.npy", "cut off"},
                                                        {"short.npy", "cut off"},
                                                        {"empty.npy", "no pose"},
                                                        {"float.npy", "<f8"},
                                                        {"big.npy", ">f8"},
                                                        {"flat.npy", "(n, 4, 4)"},
                                                        {"lacks.npy", "tz"},
                                                        {"broken.npy", "header"},
                                                        {"huge.npy", "count"},
                                                        {"scaled.npy", "row 0: the matrix is not"},
                                                        {"row.npy", "last row"},
                                                        {"nan.npy", "row 0"},
                                                        {"missing.npy", "missing.npy"}}) {
    const test::ProgramResult result = run(test::joined(head, {name}));
    EXPECT_EQ(result.exit_code, 2) << name;
    EXPECT_NE(result.err.find(word), std::string::npos) << name << ": " << result.err;
    EXPECT_NE(result.err.find(name), std::string::npos) << name << ": " << result.err;
  }
  EXPECT_EQ(run(test::joined(head, {"good.npy"})).exit_code, 0);
}

TEST(NpyHeader, OfTheSecondVersionMayBeLong) {
  constexpr std::size_t kLength = 70'000;  // more than 16 bits hold
  std::string bytes("\x93NUMPY\x02\0\x70\x11\x01\0", 12);
  bytes += "{'descr': '<f8', 'fortran_order': False, 'shape': (3,), }";
  bytes.resize(12 + kLength, ' ');
  const NpyHeader header = parse_npy_header("long.npy", bytes);
  EXPECT_EQ(header.data_offset, 12 + kLength);
  EXPECT_EQ(header.shape, std::vector<std::uint64_t>{3});
}

// By the bytes that numpy gives its types.
TEST_F(ScoreParts, RowsOfOtherColumns) {
  const auto header = [&](const std::string& type) {
    write_npy("types.npy", type, "(3,)", {});
    return parse_npy_header("types.npy", read("types.npy"));
  };
  EXPECT_EQ(header("[('a', '<U4'), ('b', '|S8'), ('c', '|b1'), ('', '|V3'), ('d', '<f8')]")
                .fields.back()
                .offset,
            16U + 8 + 1 + 3);
  EXPECT_EQ(header("[('a', '<f4', (2, 3)), ('b', '<c16'), ('c', '<i2')]").row_bytes, 24U + 16 + 2);
  for (const char* type :
       {"'>f4'", "'|O'", "'<M8[ns]'", "'<U0'", "[('a', '>f8')]", "[('a', [('b', '<f8')])]",
        "[(('title', 'a'), '<f8')]", "('<f8', (2,))"}) {
    test::expect_error(ErrorCode::format, "types.npy: .npy header: ", [&] { (void)header(type); });
  }
  std::vector<double> pose{1, 2, 3, 0, 0, 0, 1};
  const std::string columns = "('tx', '<f8'), ('ty', '<f8'), ('tz', '<f8'), ('qx', '<f8'), ";
  const std::string turned = "('qy', '<f8'), ('qz', '<f8'), ('qw', '<f8')]";
  write_npy("named.npy", "[" + columns + turned, "(1,)", pose);
  EXPECT_EQ(MappedPoses(dir / "named.npy").size(), 1U);
  pose.insert(pose.begin(), 5);
  write_npy("text.npy", "[('name', '<U2'), " + columns + turned, "(1,)", pose);
  bool mended = false;
  EXPECT_EQ(MappedPoses(dir / "text.npy").at(0, mended).translation(), Eigen::Vector3d(1, 2, 3));
  write("fortran.npy", test::with(read("text.npy"), "order': False", "order': True "));
  test::expect_error(ErrorCode::format, "Fortran's order",
                     [&] { (void)MappedPoses(dir / "fortran.npy"); });
}

TEST_F(ScoreParts, FlagsThatDoNotGoTogetherAreRefused) {
  expect_refused_with(arguments({"--out", "part.csv"}),
                      {{{"--shard", "3/3"}, "below n"},
                       {{"--shard", "0/0"}, "below n"},
                       {{"--shard", "-1/3"}, "i/n"},
                       {{"--shard", "1"}, "i/n"},
                       {{"--shard", "1/3x"}, "i/n"},
                       {{"--shard", "0/2", "--race"}, "--race"},
                       {{"--shard", "0/2", "--set", "2"}, "--set"},
                       {{"--shard", "0/2", "--picture", "p.png"}, "--picture"},
                       {{"--shard", "0/2", "--report", "p.html"}, "--report"}});
  expect_refused(arguments({"--shard", "0/2"}), "--out");
}

// `merge`: the best are those of a sort, and parts that are not of one job are refused by name.

class Merge : public test::ProgramTest {
 protected:
  // Three parts of 300 rows: gains of 40 values, so that there are many ties, and some NaN.
  Merge() {
    for (std::size_t i = 0; i < 300; ++i) {
      const std::uint64_t bits = mix64(i);
      const auto gain = static_cast<double>(bits % 40) - 3.25;
      gains.push_back(bits % 17 == 0 ? std::numeric_limits<double>::quiet_NaN() : gain);
    }
    write("a.csv", part(0, 100));
    write("b.csv", part(100, 250));
    write("c.csv", part(250, 300));
  }

  [[nodiscard]] static std::string head(const std::string& rows, std::size_t scored,
                                        const std::string& isa = "avx2") {
    return "# format 1\n# viewgain 1.2.3\n# map 0123\n# sensor small 4567\n# settings "
           "{\"gain\":\"paper\"}\n# "
           "isa " +
           isa + "\n# poses 300 89ab\n# rows " + rows + "\n# scored " + std::to_string(scored) +
           "\n";
  }
  [[nodiscard]] std::string row(std::size_t i) const {
    return std::to_string(i) + "," + exact_text(gains[i]) + "," + std::to_string(7 * i) + ",ok\n";
  }
  [[nodiscard]] std::string part(std::size_t begin, std::size_t end) const {
    std::string text =
        head(std::to_string(begin) + ":" + std::to_string(end), end - begin) + kColumns;
    for (std::size_t i = begin; i < end; ++i) text += row(i);
    return text;
  }
  // a.csv with a text in another's place.
  [[nodiscard]] std::string changed(const std::string& from, const std::string& to) const {
    return test::with(read("a.csv"), from, to);
  }
  void expect_refused(const Strings& parts, const Strings& words) const {
    const test::ProgramResult result = run(test::joined({"merge", "--out", "out.csv"}, parts));
    EXPECT_EQ(result.exit_code, 2) << result.err;
    for (const std::string& word : words) {
      EXPECT_NE(result.err.find(word), std::string::npos) << word << " in: " << result.err;
    }
    EXPECT_EQ(std::filesystem::exists(dir / "out.csv"), false) << result.err;
  }

  static constexpr const char* kColumns = "index,gain,hits,status\n";
  std::vector<double> gains;
};

TEST_F(Merge, TheBestAreThoseOfASort) {
  std::vector<std::size_t> order(gains.size());
  for (std::size_t i = 0; i < order.size(); ++i) order[i] = i;
  std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
    const bool a_nan = std::isnan(gains[a]), b_nan = std::isnan(gains[b]);
    if (a_nan != b_nan) return b_nan;
    if (!a_nan && gains[a] != gains[b]) return gains[a] > gains[b];
    return a < b;
  });
  std::size_t compared = 0;
  for (const std::size_t top : {0U, 1U, 2U, 17U, 150U, 299U, 300U, 1000U}) {
    (void)run_well(
        {"merge", "c.csv", "a.csv", "b.csv", "--top", std::to_string(top), "--out", "best.csv"});
    const std::size_t count = std::min<std::size_t>(top, 300);
    std::string expected = head("0:300", count) + kColumns;
    expected.replace(expected.find("# scored"), 8, "# best");
    for (std::size_t i = 0; i < count; ++i, ++compared) expected += row(order[i]);
    EXPECT_EQ(read("best.csv"), expected) << top;
  }
  EXPECT_EQ(compared, 1069U);
}

TEST_F(Merge, AllRowsComeInOrder) {
  const std::string said = run_well({"merge", "b.csv", "c.csv", "a.csv", "--out", "all.csv"});
  EXPECT_EQ(read("all.csv"), part(0, 300));
  EXPECT_NE(said.find("3 parts of 300 poses, 300 rows left in all.csv"), std::string::npos);
  // What was put together can be merged again.
  (void)run_well({"merge", "all.csv", "--out", "again.csv"});
  EXPECT_EQ(read("again.csv"), part(0, 300));
}

TEST_F(Merge, PartsOfOtherJobsAreNamed) {
  for (const auto& [from, to, word] : std::vector<std::array<std::string, 3>>{
           {"viewgain 1.2.3", "viewgain 1.2.4", "viewgain 1.2.4, not 1.2.3 as in b.csv"},
           {"map 0123", "map 0124", "map 0124, not 0123 as in b.csv"},
           {"small 4567", "small 4568", "sensor small 4568, not small 4567"},
           {"\"paper\"", "\"surface\"", "settings {\"gain\":\"surface\"}"},
           {"isa avx2", "isa sse4", "isa sse4, not avx2 as in b.csv"},
           {"poses 300 89ab", "poses 300 89ac", "poses 300 89ac, not 300 89ab"},
           {"poses 300 89ab", "poses 301 89ab", "poses 301 89ab, not 300 89ab"},
           {"index,gain,hits", "index,gain,rays", "columns index,gain,rays,status, not index,"}}) {
    write("mixed.csv", changed(from, to));
    expect_refused({"b.csv", "c.csv", "mixed.csv"}, {"mixed.csv: ", word});
  }
}

TEST_F(Merge, GapsAndOverlapsAreNamed) {
  expect_refused({"a.csv", "c.csv"}, {"100:250 of 300"});
  expect_refused({"b.csv"}, {"0:100, 250:300 of 300"});
  expect_refused({"a.csv", "b.csv"}, {"250:300"});
  expect_refused({"a.csv", "b.csv", "c.csv", "b.csv"}, {"b.csv", "overlap", "100:250"});
  write("d.csv", part(240, 300));
  expect_refused({"a.csv", "b.csv", "d.csv"},
                 {"d.csv: rows 240:300 overlap rows 100:250 of b.csv"});
}

TEST_F(Merge, WhatIsCutOffOrBrokenIsNamed) {
  (void)run_well({"merge", "a.csv", "b.csv", "c.csv", "--out", "all.npy"});
  const std::string whole = read("a.csv"), npy = read("all.npy");
  std::size_t cases = 0;
  const auto expect = [&](const std::string& name, const std::string& bytes,
                          const std::string& word) {
    write(name, bytes);
    expect_refused(name.ends_with(".npy") ? Strings{name} : Strings{"b.csv", "c.csv", name},
                   {name, word});
    ++cases;
  };
  // Wherever the file ends, somebody says so.
  for (std::size_t size = 0; size < whole.size(); size += 37) {
    expect("cut.csv", whole.substr(0, size), "cut.csv");
  }
  expect("line.csv", whole.substr(0, whole.rfind("99,")), "cut off: 99 rows of 100");
  expect("half.csv", whole.substr(0, whole.size() - 1), "cut off within its last line");
  for (std::size_t size = 0; size < npy.size(); size += 111) {
    expect("cut.npy", npy.substr(0, size), "cut.npy");
  }
  expect("rows.npy", npy.substr(0, 2000), "cut off");
  expect("more.csv", whole + row(99), "more rows than the 100");
  expect("out.csv.csv", changed("\n5,", "\n500,"), "row 500 is not among its rows 0:100");
  expect("back.csv", changed("\n5,", "\n3,"), "row 3 follows 4");
  expect("word.csv", changed(",ok\n", ",well\n"), "there is no status 'well'");
  expect("number.csv", changed("\n5,", "\n5,x"), "gain is no number");
  expect("columns.csv", changed(",ok\n", ",ok,1\n"), "too many columns");
  expect("few.csv", changed(",ok\n", "\n"), "too few columns");
  expect("plain.csv", whole.substr(whole.find("index")), "lines of #");
  expect("rows.csv", changed("rows 0:100", "rows 100:0"), "rows 100:0");
  expect("scored.csv", changed("scored 100", "scored 101"), "more were scored");
  expect("key.csv", changed("# isa avx2\n", ""), "line 6 of #: expected \"# isa ");
  const std::size_t end = npy.find(head("0:300", 300).substr(0, 10));  // of the rows
  ASSERT_NE(end, std::string::npos);
  expect("saved.npy", npy.substr(0, end), "does not say which rows it has");
  std::string wrong = npy;
  wrong[end - 1] = 77;
  expect("status.npy", wrong, "row 299 has no known status: 77");
  EXPECT_EQ(cases, 122U);
}

TEST_F(Merge, TheBestAreNoPart) {
  (void)run_well({"merge", "a.csv", "b.csv", "c.csv", "--top", "300", "--out", "best.npy"});
  expect_refused({"best.npy"}, {"best.npy", "no part"});
  expect_refused({"missing.csv"}, {"missing.csv"});
}

TEST_F(Merge, NothingThatIsReadIsWritten) {
  const std::string before = read("a.csv");
  const test::ProgramResult result = run({"merge", "a.csv", "b.csv", "c.csv", "--out", "a.csv"});
  EXPECT_EQ(result.exit_code, 2);
  EXPECT_NE(result.err.find("PART"), std::string::npos) << result.err;
  EXPECT_EQ(read("a.csv"), before);
}

}  // namespace
}  // namespace viewgain
