// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0

// `merge`: the best are those of a sort, and parts that are not of one job are refused by name.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <limits>
#include <string>
#include <vector>

#include "apps/program_runner.hpp"
#include "core/expect_error.hpp"
#include "viewgain/support/mix64.hpp"
#include "viewgain/support/text.hpp"

namespace viewgain {
namespace {

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
    return "# viewgain 1.2.3\n# map 0123\n# sensor small 4567\n# settings {\"gain\":\"paper\"}\n# "
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
  expect("key.csv", changed("# isa avx2\n", ""), "line 5 of #: expected \"# isa ");
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
