// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0

// Poses and gains in columns (.npy) are those of text.
#include <bit>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <limits>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include "apps/program_runner.hpp"
#include "core/expect_error.hpp"
#include "viewgain/core/generators.hpp"
#include "viewgain/core/pose_io.hpp"
#include "viewgain/formats/pose_files.hpp"
#include "viewgain/grid/vdb_io.hpp"

namespace viewgain {
namespace {

class Columns : public test::ProgramTest {
 protected:
  Columns() {
    write_small_sensor();
    BeliefGrid grid{{0.02, {{-0.2, -0.2, -0.2}, {0.2, 0.2, 0.2}}, {}, 0.02}};
    for (int x = -3; x < 3; ++x) {
      for (int y = -3; y < 3; ++y) grid.set({x, y, 4}, 0.85F);
    }
    // Another planner's map would have none.
    grid.set({0, 0, 4}, 0.85F, Belief{{1e4F, 1e4F, 1e4F, 0, 0, 0}, {0, 0, 0}, 1});
    save_vdb(grid, dir / "map.vdb");
  }

  [[nodiscard]] static Strings arguments(const Strings& more) {
    return test::joined({"score", "map.vdb", "--sensor", "small.toml"}, more);
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
};

TEST_F(Columns, PosesInColumnsAreThoseOfText) {
  const std::vector<Pose> poses = sphere_poses(40, 0.45);
  write_tum(dir / "poses.txt", poses);
  std::vector<double> columns, matrices;
  std::istringstream tum(read("poses.txt"));
  std::string line;
  std::getline(tum, line);
  for (double value = 0; tum >> value;) columns.push_back(value);
  for (const Pose& pose : poses) {
    matrices.insert(matrices.end(), pose.m.begin(), pose.m.end());
    matrices.insert(matrices.end(), {0, 0, 0, 1});
  }
  const std::string types =
      "('ty', '<f8'), ('tz', '<f8'), ('qx', '<f8'), ('qy', '<f8'), ('qz', '<f8'), ('qw', '<f8')]";
  write_npy("matrices.npy", "'<f8'", "(40, 4, 4)", matrices);
  write_npy("columns.npy", "[('name', '<U2'), ('tx', '<f8'), " + types, "(40,)", columns);
  write_npy("shaped.npy", "[('a', '|S2', (1, 4)), ('tx', '<f8'), " + types, "(40,)", columns);
  const auto rows = [&](const Strings& more) {
    (void)run_well(arguments(test::joined(more, {"--out", "scores.csv"})));
    return read("scores.csv");
  };
  const std::string text = rows({"--poses", "poses.txt"});
  EXPECT_GT(text.size(), 40U * 50U);
  EXPECT_EQ(rows({"--poses", "columns.npy"}), text);
  EXPECT_EQ(rows({"--poses", "shaped.npy"}), text);
  EXPECT_EQ(rows({"--poses", "matrices.npy"}), rows({"--poses", "sphere:40,0.45"}));
}

// As numpy writes arrays that it holds as float32, by columns (order="F"), or both.
TEST_F(Columns, SingleNumbersAndFortransOrderAreRead) {
  const std::vector<Pose> poses = sphere_poses(40, 0.45);
  std::vector<double> rows, by_columns(40 * 16);
  for (const Pose& pose : poses) {
    rows.insert(rows.end(), pose.m.begin(), pose.m.end());
    rows.insert(rows.end(), {0, 0, 0, 1});
  }
  for (std::size_t n = 0; n < 40; ++n) {
    for (std::size_t i = 0; i < 4; ++i) {
      for (std::size_t j = 0; j < 4; ++j) {
        by_columns[n + 40 * (i + 4 * j)] = rows[16 * n + 4 * i + j];
      }
    }
  }
  const auto in_fortran = [&](const std::string& name) {
    write(name, test::with(read(name), "order': False", "order': True "));
  };
  // Pairs of float32 in the place of a float64.
  const auto single = [](const std::vector<double>& numbers) {
    std::vector<double> pairs(numbers.size() / 2);
    const std::vector<float> floats(numbers.begin(), numbers.end());
    std::memcpy(pairs.data(), floats.data(), sizeof(float) * floats.size());
    return pairs;
  };
  write_npy("f4.npy", "'<f4'", "(40, 4, 4)", single(rows));
  write_npy("fortran.npy", "'<f8'", "(40, 4, 4)", by_columns);
  in_fortran("fortran.npy");
  write_npy("both.npy", "'<f4'", "(40, 4, 4)", single(by_columns));
  in_fortran("both.npy");
  for (const std::string name : {"f4.npy", "fortran.npy", "both.npy"}) {
    const PoseList read = load_poses(dir / name);
    ASSERT_EQ(read.poses.size(), 40U) << name;
    EXPECT_EQ(read.orthonormalized, 0U) << name;
    EXPECT_EQ(read.timestamps[39], 39) << name;
    for (std::size_t n = 0; n < 40; ++n) {
      for (std::size_t i = 0; i < 12; ++i) {
        EXPECT_NEAR(read.poses[n].m[i], poses[n].m[i], name == "fortran.npy" ? 1e-15 : 1e-6);
      }
    }
    EXPECT_EQ(run(arguments({"--poses", name})).exit_code, 0) << name;
  }
  const std::string types =
      "[('tx', '<f4'), ('ty', '<f4'), ('tz', '<f4'), ('qx', '<f4'), ('qy', '<f4'), ('qz', '<f4'), "
      "('qw', '<f4'), ('timestamp', '<f4')]";
  write_npy("columns.npy", types, "(2,)", single({1, 2, 3, 0, 0, 0, 1, 7, 4, 5, 6, 0, 0, 0, 1, 9}));
  const PoseList columns = load_poses(dir / "columns.npy");
  EXPECT_EQ(columns.timestamps, (std::vector<double>{7, 9}));
  EXPECT_EQ(columns.poses[1].translation(), Eigen::Vector3d(4, 5, 6));
}

// The ending says the format: what is written under a name is what is read under it.
TEST_F(Columns, FilesOfPosesAreOfTheFormatThatTheirNameSays) {
  const std::vector<Pose> poses = sphere_poses(5, 0.45);
  const std::vector<double> times{0.5, 1.5, 2.5, 3.5, 1e9};
  for (const std::string name : {"p.npy", "p.txt", "p.tum", "P.NPY"}) {
    save_poses(dir / name, poses, times);
    const PoseList read = load_poses(dir / name);
    EXPECT_EQ(read.timestamps, times) << name;
    EXPECT_LT((read.poses[4].rotation() - poses[4].rotation()).norm(), 1e-14) << name;
    EXPECT_EQ(read.poses[4].translation(), poses[4].translation()) << name;
  }
  EXPECT_TRUE(read("p.npy").starts_with("\x93NUMPY"));
  EXPECT_TRUE(read("p.tum").starts_with("#"));
  for (const std::string name : {"p.csv", "p.npz", "p.txt.gz", "p"}) {
    test::expect_error(ErrorCode::invalid_argument, "must have the ending .txt, .tum or .npy",
                       [&] { save_poses(dir / name, poses); });
    EXPECT_FALSE(exists(dir / name));
  }
  save_poses("/dev/null", poses);
  std::vector<Pose> bent = poses;
  bent[3].m[0] += 0.5;
  test::expect_error(ErrorCode::invalid_argument, "pose 3",
                     [&] { save_poses(dir / "bent.npy", bent); });
  write("poses.dat", read("p.npy"));  // numbers of numpy's under another name
  test::expect_error(ErrorCode::format, ".npy", [&] { (void)load_poses(dir / "poses.dat"); });
}

// Of every command and every function that writes a file.
TEST_F(Columns, EndingsThatNoWriterWritesAreRefused) {
  const auto refuses = [&](const Strings& call, const std::string& name, const std::string& word) {
    const test::ProgramResult result = run(call);
    EXPECT_EQ(result.exit_code, 2) << call[0] << " " << name;
    EXPECT_NE(result.err.find("must have the ending " + word), std::string::npos) << result.err;
    EXPECT_NE(result.err.find(name), std::string::npos) << result.err;
    EXPECT_FALSE(exists(dir / name)) << name;
  };
  refuses({"surface", "map.vdb", "--out", "model.stl"}, "model.stl", ".ply");
  refuses({"surface", "map.vdb", "--points", "model.pcd"}, "model.pcd", ".ply");
  refuses({"next", "map.vdb", "--generator", "sphere", "--sensor", "small.toml", "--out", "n.csv"},
          "n.csv", ".txt, .tum or .npy");
  refuses(arguments({"--poses", "sphere:4,0.45", "--out", "s.parquet"}), "s.parquet",
          ".csv or .npy");
  refuses(arguments({"--poses", "sphere:4,0.45", "--picture", "s.jpg"}), "s.jpg", ".png");
  refuses(arguments({"--poses", "sphere:4,0.45", "--report", "s.pdf"}), "s.pdf", ".html");
  refuses(arguments({"--poses", "sphere:4,0.45", "--save-config", "s.json"}), "s.json", ".toml");
  refuses({"convert", "map.vdb", "map.ply"}, "map.ply", ".vdb or .ot");
  refuses({"render", "map.vdb", "map", "--out", "map.svg"}, "map.svg", ".png");
}

// What the other file says in text stands behind the header, a value after the other.
TEST_F(Columns, ScoresInColumnsAreThoseOfText) {
  for (const std::string name : {"scores.csv", "scores.npy"}) {
    (void)run_well(arguments(
        {"--poses", "sphere:40,0.45", "--gain", "paper", "--threads", "2", "--out", name}));
  }
  const std::string npy = read("scores.npy");
  const std::string head =
      "{'descr': [('index', '<i8'), ('gain', '<f8'), ('exploration', '<f8'), ('refinement', "
      "'<f8'), ('posterior_entropy', '<f8'), ('rays', '<u4'), ('hits', '<u4'), "
      "('unknown_voxels', '<u4'), ('occupied_voxels', '<u4'), ('status', '|u1'), ('tx', '<f8'), ";
  EXPECT_EQ(npy.substr(10, head.size()), head);
  EXPECT_NE(npy.find("'shape': (40,), }"), std::string::npos);
  const std::size_t begin = npy.find('\n') + 1, bytes = 5 * 8 + 4 * 4 + 1 + 7 * 8;
  EXPECT_EQ(begin % 64, 0U);
  ASSERT_EQ(npy.size(), begin + 40 * bytes);
  std::istringstream csv(read("scores.csv"));
  std::string line;
  std::getline(csv, line);
  for (std::size_t row = 0; row < 40; ++row) {
    ASSERT_TRUE(std::getline(csv, line));
    const char* at = npy.data() + begin + row * bytes;
    const auto next = [&](auto value) {
      std::memcpy(&value, at, sizeof value);
      at += sizeof value;
      std::ostringstream text;
      text.precision(17);
      text << value;
      return text.str() + ",";
    };
    std::string expected = next(std::int64_t{});
    for (int i = 0; i < 4; ++i) expected += next(double{});
    for (int i = 0; i < 4; ++i) expected += next(std::uint32_t{});
    EXPECT_EQ(*at++, 0);
    EXPECT_TRUE(line.starts_with(expected + "ok,")) << line << "\n" << expected;
  }
}

TEST_F(Columns, BadColumnsOfPosesAreNamed) {
  std::vector<double> identity{1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};
  write_npy("good.npy", "'<f8'", "(1, 4, 4)", identity);
  write("none.npy", "index,gain\n");
  write_npy("short.npy", "'<f8'", "(2, 4, 4)", identity);
  write_npy("empty.npy", "'<f8'", "(0, 4, 4)", {});
  write_npy("half.npy", "'<f2'", "(8, 4, 4)", identity);
  write_npy("big.npy", "'>f8'", "(1, 4, 4)", identity);
  write_npy("flat.npy", "'<f8'", "(16,)", identity);
  write_npy("lacks.npy", "[('tx', '<f8'), ('ty', '<f8')]", "(8,)", identity);
  write_npy("object.npy", "[('tx', '<f8'), ('a', '|O')]", "(8,)", identity);
  write_npy("text.npy", "[('tx', '<f8'), ('a', '<U4611686018427387905')]", "(8,)", identity);
  write_npy("nested.npy", "[('a', [('b', '<f8')])]", "(8,)", identity);
  write_npy("broken.npy", "[('tx', '<f8'", "(8,)", identity);
  write_npy("huge.npy", "'<f8'", "(281474976710656, 4, 4)", identity);
  write_npy("real.npy", "'<f8'", "(3E31, 4, 4)", identity);
  write_npy("wide.npy", "[('tx', '<f8'), ('a', '<f8', (1e30,))]", "(8,)", identity);
  write("fortran.npy", test::with(read("huge.npy"), "order': False", "order': True "));
  std::vector<double> scaled = identity, row = identity, nan = identity;
  scaled[0] = 2;
  row[15] = 2;
  nan[3] = std::numeric_limits<double>::quiet_NaN();
  write_npy("scaled.npy", "'<f8'", "(1, 4, 4)", scaled);
  write_npy("row.npy", "'<f8'", "(1, 4, 4)", row);
  write_npy("nan.npy", "'<f8'", "(1, 4, 4)", nan);
  for (const auto& [name, word] :
       std::vector<std::pair<std::string, std::string>>{{"none.npy", "not a .npy"},
                                                        {"short.npy", "truncated"},
                                                        {"empty.npy", "no pose"},
                                                        {"half.npy", "<f4"},
                                                        {"big.npy", ">f8"},
                                                        {"flat.npy", "(n, 4, 4)"},
                                                        {"lacks.npy", "tz"},
                                                        {"object.npy", "a of |O"},
                                                        {"text.npy", "a of <U4611"},
                                                        {"nested.npy", "header"},
                                                        {"broken.npy", "header"},
                                                        {"huge.npy", "truncated"},
                                                        {"real.npy", "header"},
                                                        {"wide.npy", "header"},
                                                        {"fortran.npy", "truncated"},
                                                        {"scaled.npy", "row 0: the matrix is not"},
                                                        {"row.npy", "last row"},
                                                        {"nan.npy", "row 0"},
                                                        {"missing.npy", "missing.npy"}}) {
    const test::ProgramResult result = run(arguments({"--poses", name}));
    EXPECT_EQ(result.exit_code, 2) << name;
    EXPECT_NE(result.err.find(word), std::string::npos) << name << ": " << result.err;
    EXPECT_NE(result.err.find(name), std::string::npos) << name << ": " << result.err;
  }
  EXPECT_EQ(run(arguments({"--poses", "good.npy"})).exit_code, 0);
}

}  // namespace
}  // namespace viewgain
