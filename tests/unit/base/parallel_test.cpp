#include "ricochet/base/parallel.hpp"

#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <mutex>
#include <set>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

namespace ricochet {
namespace {

/// Sets the number of threads for a test, and restores it.
class Threads {
 public:
  explicit Threads(int count) : before_(thread_count()) { set_thread_count(count); }
  ~Threads() { set_thread_count(before_); }
  Threads(const Threads&) = delete;
  Threads& operator=(const Threads&) = delete;

 private:
  int before_;
};

TEST(Parallel, CoversEveryIndexOnce) {
  for (const int threads : {1, 2, 3, 7}) {
    const Threads set(threads);
    for (const Index count : {0, 1, 2, 5, 28, 1000}) {
      std::vector<std::atomic<int>> visits(static_cast<std::size_t>(count));
      for (int repeat = 0; repeat < 50; ++repeat) {
        parallel_ranges(count, [&](Index begin, Index end) {
          EXPECT_LT(begin, end);
          for (Index i = begin; i < end; ++i) ++visits[std::size_t(i)];
        });
      }
      for (const auto& visited : visits) EXPECT_EQ(visited, 50) << threads << " threads, " << count;
    }
  }
}

/// Ranges that wait for one another end only if all requested threads work; the next call uses the same threads.
TEST(Parallel, UsesTheThreadsAskedForAgainAndAgain) {
  const Threads set(3);
  std::set<std::thread::id> seen;
  std::mutex guard;
  for (int repeat = 0; repeat < 20; ++repeat) {
    if (repeat % 5 == 4) std::this_thread::sleep_for(std::chrono::milliseconds(2));  // the threads fall asleep
    std::atomic<int> arrived{0};
    parallel_ranges(3, [&](Index, Index) {
      ++arrived;
      while (arrived < 3) std::this_thread::yield();
      const std::lock_guard<std::mutex> lock(guard);
      seen.insert(std::this_thread::get_id());
    });
  }
  EXPECT_EQ(seen.size(), 3U);
  EXPECT_EQ(seen.count(std::this_thread::get_id()), 1U) << "the caller works, too";
}

TEST(Parallel, RethrowsTheFirstRangesExceptionWhenAllHaveEnded) {
  for (const int threads : {1, 3}) {
    const Threads set(threads);
    for (int repeat = 0; repeat < 20; ++repeat) {
      std::atomic<Index> done{0};
      try {
        parallel_ranges(1000, [&](Index begin, Index end) {
          for (Index i = begin; i < end; ++i) {
            if (i == 500 || i == 900) throw std::runtime_error(std::to_string(i));
            ++done;
          }
        });
        FAIL() << "nothing was thrown";
      } catch (const std::runtime_error& problem) {
        EXPECT_STREQ(problem.what(), "500");
      }
      EXPECT_GE(done, 500);
    }
    Index sum = 0;  // the next call is unaffected
    std::mutex guard;
    parallel_ranges(100, [&](Index begin, Index end) {
      const std::lock_guard<std::mutex> lock(guard);
      for (Index i = begin; i < end; ++i) sum += i;
    });
    EXPECT_EQ(sum, 4950);
  }
}

TEST(Parallel, NestedCallsAndCallsFromSeveralThreadsEnd) {
  const Threads set(3);
  std::atomic<Index> sum{0};
  const auto nested = [&] {
    parallel_ranges(20, [&](Index begin, Index end) {
      for (Index i = begin; i < end; ++i) {
        parallel_ranges(10, [&](Index first, Index last) { sum += last - first; });
      }
    });
  };
  nested();
  EXPECT_EQ(sum, 200);
  std::vector<std::thread> callers;
  for (int k = 0; k < 4; ++k) {
    callers.emplace_back([&] {
      for (int repeat = 0; repeat < 25; ++repeat) nested();
    });
  }
  for (std::thread& caller : callers) caller.join();
  EXPECT_EQ(sum, 200 + 4 * 25 * 200);
}

TEST(Parallel, SumsAreTheSameBitsForAnyNumberOfThreads) {
  for (const Index count : {0, 1, 2048, 2049, 100000, 1000003}) {
    const auto sum = [&] {
      return parallel_sum<double>(count, [](Index begin, Index end) {
        double part = 0.0;
        for (Index i = begin; i < end; ++i) part += 1.0 / double(i + 1);
        return part;
      });
    };
    const double alone = sum();
    double plain = 0.0;
    for (Index i = 0; i < count; ++i) plain += 1.0 / double(i + 1);
    EXPECT_NEAR(alone, plain, 1e-12);
    for (const int threads : {2, 3, 5}) {
      const Threads set(threads);
      EXPECT_EQ(sum(), alone) << threads;
    }
  }
}

}  // namespace
}  // namespace ricochet
