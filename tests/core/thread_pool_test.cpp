// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0

#include "viewgain/support/thread_pool.hpp"

#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cstdint>
#include <limits>
#include <memory>
#include <numeric>
#include <set>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

#include "expect_error.hpp"
#include "scoped_variable.hpp"
#include "viewgain/support/isa.hpp"

namespace viewgain {
namespace {

using test::expect_error;

constexpr std::size_t kMaxSize = std::numeric_limits<std::size_t>::max();

/// Waits until `arrived` reaches `expected`; false after a minute.
bool meet(std::atomic<int>& arrived, int expected) {
  arrived.fetch_add(1);
  const auto end = std::chrono::steady_clock::now() + std::chrono::minutes(1);
  while (arrived.load() < expected) {
    if (std::chrono::steady_clock::now() > end) return false;
    std::this_thread::yield();
  }
  return true;
}

TEST(ThreadPool, CoversEveryIndexOnce) {
  for (const int threads : {1, 2, 3, 8}) {
    ThreadPool pool(threads);
    ASSERT_EQ(pool.num_threads(), threads);
    for (const std::size_t count : {0, 1, 2, 7, 64, 1000, 4097}) {
      for (const std::size_t chunk :
           {std::size_t{1}, std::size_t{3}, std::size_t{64}, std::size_t{4097}, kMaxSize}) {
        std::vector<std::atomic<int>> visits(count);
        std::atomic<int> bad_ranges{0};
        pool.for_each_chunk(count, chunk, [&](std::size_t begin, std::size_t end) {
          const bool full = end - begin == chunk || end == count;
          if (begin >= end || end > count || begin % chunk != 0 || !full) bad_ranges.fetch_add(1);
          for (std::size_t i = begin; i < end; ++i) visits[i].fetch_add(1);
        });
        ASSERT_EQ(bad_ranges.load(), 0);
        for (const auto& v : visits) ASSERT_EQ(v.load(), 1);
      }
    }
  }
}

TEST(ThreadPool, CountsNearTheLargestSizeDoNotOverflow) {
  for (const int threads : {1, 4}) {
    ThreadPool pool(threads);
    std::atomic<std::size_t> covered{0};
    std::atomic<int> calls{0};
    pool.for_each_chunk(kMaxSize, kMaxSize / 3, [&](std::size_t begin, std::size_t end) {
      covered.fetch_add(end - begin);
      calls.fetch_add(1);
    });
    EXPECT_EQ(covered.load(), kMaxSize);
    EXPECT_EQ(calls.load(), 3);
  }
}

bool all_threads_meet(ThreadPool& pool) {
  std::atomic<int> arrived{0};
  std::atomic<bool> met{true};
  const int all = pool.num_threads();
  pool.for_each_chunk(static_cast<std::size_t>(all), 1, [&](std::size_t, std::size_t) {
    if (!meet(arrived, all)) met = false;
  });
  return met;
}

TEST(ThreadPool, AllThreadsWorkAtOnceAndSleepersWakeUp) {
  ThreadPool pool(4);
  for (int repetition = 0; repetition < 50; ++repetition) {
    if (repetition % 10 == 0) std::this_thread::sleep_for(std::chrono::milliseconds(20));
    ASSERT_TRUE(all_threads_meet(pool));
  }
}

TEST(ThreadPool, OneThreadIsTheCallerInOrder) {
  ThreadPool pool(1);
  std::vector<std::size_t> order;
  bool same_thread = true;
  const auto caller = std::this_thread::get_id();
  pool.for_each_chunk(100, 7, [&](std::size_t begin, std::size_t end) {
    same_thread = same_thread && std::this_thread::get_id() == caller;
    for (std::size_t i = begin; i < end; ++i) order.push_back(i);
  });
  std::vector<std::size_t> expected(100);
  std::iota(expected.begin(), expected.end(), 0U);
  EXPECT_TRUE(same_thread);
  EXPECT_EQ(order, expected);
}

TEST(ThreadPool, ASingleChunkStaysOnTheCaller) {
  ThreadPool pool(4);
  std::thread::id worker;
  pool.for_each_chunk(10, 10,
                      [&](std::size_t, std::size_t) { worker = std::this_thread::get_id(); });
  EXPECT_EQ(worker, std::this_thread::get_id());
}

TEST(ThreadPool, NestedLoopsRunOnTheirCaller) {
  ThreadPool pool(3);
  std::vector<std::atomic<int>> visits(20 * 30 * 4);
  std::atomic<int> elsewhere{0};
  pool.for_each_chunk(20, 1, [&](std::size_t i, std::size_t) {
    const auto outer = std::this_thread::get_id();
    pool.for_each_chunk(30, 1, [&](std::size_t k, std::size_t) {
      if (std::this_thread::get_id() != outer) elsewhere.fetch_add(1);
      pool.for_each_chunk(
          4, 1, [&](std::size_t l, std::size_t) { visits[(i * 30 + k) * 4 + l].fetch_add(1); });
    });
  });
  EXPECT_EQ(elsewhere.load(), 0);
  for (const auto& v : visits) ASSERT_EQ(v.load(), 1);
}

TEST(ThreadPool, ConcurrentCallersAllFinish) {
  ThreadPool pool(3);
  constexpr int kCallers = 8, kLoops = 300;
  std::vector<std::uint64_t> sums(kCallers, 0);
  std::vector<std::thread> callers;
  for (std::size_t c = 0; c < kCallers; ++c) {
    callers.emplace_back([&pool, &sums, c] {
      for (int i = 0; i < kLoops; ++i) {
        std::atomic<std::uint64_t> sum{0};
        pool.for_each_chunk(100, 3, [&](std::size_t begin, std::size_t end) {
          for (std::size_t k = begin; k < end; ++k) sum.fetch_add(k);
        });
        sums[c] += sum.load();
      }
    });
  }
  for (std::thread& caller : callers) caller.join();
  for (const std::uint64_t sum : sums) EXPECT_EQ(sum, 4950U * kLoops);
}

TEST(ThreadPool, ACallerThatFindsThePoolBusyIsNotHeldUp) {
  ThreadPool pool(2);
  std::atomic<int> inside{0};
  std::atomic<bool> release{false};
  std::thread holder([&] {
    pool.for_each_chunk(2, 1, [&](std::size_t, std::size_t) {
      inside.fetch_add(1);
      while (!release.load()) std::this_thread::yield();
    });
  });
  while (inside.load() < 2) std::this_thread::yield();
  std::set<std::thread::id> ids;
  pool.for_each_chunk(50, 1,
                      [&](std::size_t, std::size_t) { ids.insert(std::this_thread::get_id()); });
  EXPECT_EQ(ids, std::set<std::thread::id>{std::this_thread::get_id()});
  release = true;
  holder.join();
}

TEST(ThreadPool, ExceptionsReachTheCallerAndThePoolLives) {
  for (const int threads : {1, 2, 4}) {
    ThreadPool pool(threads);
    for (std::size_t bad = 0; bad < 40; ++bad) {
      try {
        pool.for_each_chunk(40, 1, [&](std::size_t begin, std::size_t) {
          if (begin == bad) throw std::out_of_range("index " + std::to_string(begin));
        });
        FAIL() << "nothing thrown";
      } catch (const std::out_of_range& e) {
        ASSERT_EQ(std::string(e.what()), "index " + std::to_string(bad));
      }
      std::atomic<int> visits{0};
      pool.for_each_chunk(40, 1, [&](std::size_t, std::size_t) { visits.fetch_add(1); });
      ASSERT_EQ(visits.load(), 40);
    }
  }
}

TEST(ThreadPool, AnExceptionEndsTheLoopEarly) {
  ThreadPool pool(4);
  std::atomic<int> visits{0};
  std::atomic<bool> thrown{false};
  EXPECT_THROW(pool.for_each_chunk(10'000, 1,
                                   [&](std::size_t begin, std::size_t) {
                                     visits.fetch_add(1);
                                     if (begin == 0) {
                                       thrown = true;
                                       throw std::runtime_error("at once");
                                     }
                                     while (!thrown.load()) std::this_thread::yield();
                                     // Leaves the other thread the time to end the loop.
                                     std::this_thread::sleep_for(std::chrono::microseconds(100));
                                   }),
               std::runtime_error);
  EXPECT_GE(visits.load(), 1);
  EXPECT_LT(visits.load(), 5'000);
}

TEST(ThreadPool, AllThrowingAtOnceGivesOneOfTheExceptions) {
  ThreadPool pool(4);
  for (int i = 0; i < 200; ++i) {
    std::atomic<int> arrived{0};
    ASSERT_THROW(pool.for_each_chunk(4, 1,
                                     [&](std::size_t, std::size_t) {
                                       meet(arrived, 4);
                                       throw std::runtime_error("all");
                                     }),
                 std::runtime_error);
  }
}

TEST(ThreadPool, StartsAndStopsManyTimes) {
  for (int i = 0; i < 200; ++i) {
    ThreadPool pool(1 + i % 5);
    std::atomic<int> visits{0};
    if (i % 3 != 0) {
      pool.for_each_chunk(10, 1, [&](std::size_t, std::size_t) { visits.fetch_add(1); });
      ASSERT_EQ(visits.load(), 10);
    }
  }
}

TEST(ThreadPool, RefusesBadArguments) {
  expect_error(ErrorCode::invalid_argument, "-1", [] { ThreadPool pool(-1); });
  expect_error(ErrorCode::invalid_argument, "1025", [] { ThreadPool pool(1025); });
  ThreadPool pool(2);
  expect_error(ErrorCode::invalid_argument, "chunk",
               [&] { pool.for_each_chunk(3, 0, [](std::size_t, std::size_t) {}); });
  pool.for_each_chunk(0, 0, [](std::size_t, std::size_t) { ADD_FAILURE(); });
}

/// Runs `body` in a child process, which must say 0 within a minute.
template <typename Body>
void expect_in_child(const Body& body) {
  const pid_t child = fork();
  ASSERT_GE(child, 0);
  if (child == 0) {
    alarm(60);
    _exit(body() ? 0 : 1);
  }
  int status = -1;
  ASSERT_EQ(waitpid(child, &status, 0), child);
  EXPECT_TRUE(WIFEXITED(status) && WEXITSTATUS(status) == 0) << "status " << status;
}

TEST(ThreadPool, AChildOfAForkHasItsOwnThreads) {
  auto pool = std::make_unique<ThreadPool>(2);
  ASSERT_TRUE(all_threads_meet(*pool));
  expect_in_child([&] { return all_threads_meet(*pool) && all_threads_meet(*pool); });
  expect_in_child([&] {  // a child that only drops it
    pool.reset();
    return true;
  });
  // In the middle of a loop of the parent's other thread, which the child does not have.
  std::atomic<bool> inside{false}, leave{false};
  std::thread busy([&] {
    pool->for_each_chunk(2, 1, [&](std::size_t, std::size_t) {
      inside = true;
      while (!leave) std::this_thread::yield();
    });
  });
  while (!inside) std::this_thread::yield();
  expect_in_child([&] { return all_threads_meet(*pool); });
  leave = true;
  busy.join();
  EXPECT_TRUE(all_threads_meet(*pool));
}

TEST(ThreadPool, ZeroMeansAllHardwareThreads) {
  const ThreadPool pool(0);
  EXPECT_EQ(pool.num_threads(), std::max(1, static_cast<int>(std::thread::hardware_concurrency())));
}

TEST(Isa, TheBestIsTakenUnlessLowered) {
  const std::vector<Isa> isas = supported_isas();
  ASSERT_FALSE(isas.empty());
  EXPECT_TRUE(std::is_sorted(isas.rbegin(), isas.rend()));
  {
    const test::ScopedIsa unset(std::nullopt);
    EXPECT_EQ(select_isa(), isas.front());
  }
  {
    const test::ScopedIsa empty("");
    EXPECT_EQ(select_isa(), isas.front());
  }
  std::size_t cases = 0;
  for (const Isa isa : isas) {
    const test::ScopedIsa environment(std::string(isa_name(isa)));
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
      const test::ScopedIsa environment(std::string(isa_name(wish)));
      EXPECT_EQ(select_isa(cpu), wish > cpu.front() ? cpu.front() : wish);
    }
    const test::ScopedIsa unset(std::nullopt);
    EXPECT_EQ(select_isa(cpu), cpu.front());
  }
  // Elsewhere there is one set, whose name is taken, too.
  const std::vector<Isa> other{Isa::baseline};
  for (const Isa wish : {Isa::avx2, Isa::baseline}) {
    const test::ScopedIsa environment(std::string(isa_name(wish)));
    EXPECT_EQ(select_isa(other), Isa::baseline);
  }
  test::expect_error(ErrorCode::backend, "SSE4.2", [] { (void)select_isa(std::vector<Isa>{}); });
}

TEST(Isa, AnUnknownNameListsTheValidOnes) {
  const test::ScopedIsa environment("mmx");
  test::expect_error(ErrorCode::invalid_argument, "'mmx'; valid values: avx512, avx2, sse4",
                     [] { (void)select_isa(); });
}

}  // namespace
}  // namespace viewgain
