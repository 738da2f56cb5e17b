// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include "viewgain/support/isa.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <string>

#include "expect_error.hpp"

namespace viewgain {
namespace {

/// Sets VIEWGAIN_ISA (nullptr: unsets) and puts the old value back at the end.
class IsaEnvironment {
 public:
  explicit IsaEnvironment(const char* value) {
    if (const char* old = std::getenv("VIEWGAIN_ISA")) old_ = old, was_set_ = true;
    if (value != nullptr) {
      ::setenv("VIEWGAIN_ISA", value, 1);
    } else {
      ::unsetenv("VIEWGAIN_ISA");
    }
  }
  ~IsaEnvironment() {
    if (was_set_) {
      ::setenv("VIEWGAIN_ISA", old_.c_str(), 1);
    } else {
      ::unsetenv("VIEWGAIN_ISA");
    }
  }

 private:
  std::string old_;
  bool was_set_ = false;
};

TEST(Isa, TheBestIsTakenUnlessLowered) {
  const std::vector<Isa> isas = supported_isas();
  ASSERT_FALSE(isas.empty());
  EXPECT_TRUE(std::is_sorted(isas.rbegin(), isas.rend()));
  {
    const IsaEnvironment unset(nullptr);
    EXPECT_EQ(select_isa(), isas.front());
  }
  {
    const IsaEnvironment empty("");
    EXPECT_EQ(select_isa(), isas.front());
  }
  std::size_t cases = 0;
  for (const Isa isa : isas) {
    const IsaEnvironment environment(std::string(isa_name(isa)).c_str());
    if (isa != Isa::baseline) {
      EXPECT_EQ(select_isa(), isa);
    }
    ++cases;
  }
  EXPECT_EQ(cases, isas.size());
}

TEST(Isa, AWishTheCpuLacksGivesTheBestItHas) {
  // CPUs by what they support, whatever this one does.
  const std::vector<std::vector<Isa>> cpus{
      {Isa::sse4}, {Isa::avx2, Isa::sse4}, {Isa::avx512, Isa::avx2, Isa::sse4}};
  for (const std::vector<Isa>& cpu : cpus) {
    for (const Isa wish : {Isa::avx512, Isa::avx2, Isa::sse4}) {
      const IsaEnvironment environment(std::string(isa_name(wish)).c_str());
      EXPECT_EQ(select_isa(cpu), wish > cpu.front() ? cpu.front() : wish);
    }
    const IsaEnvironment unset(nullptr);
    EXPECT_EQ(select_isa(cpu), cpu.front());
  }
  test::expect_error(ErrorCode::backend, "SSE4.2", [] { (void)select_isa(std::vector<Isa>{}); });
}

TEST(Isa, AnUnknownNameListsTheValidOnes) {
  const IsaEnvironment environment("mmx");
  test::expect_error(ErrorCode::invalid_argument, "'mmx'; valid are avx512, avx2, sse4",
                     [] { (void)select_isa(); });
}

}  // namespace
}  // namespace viewgain
