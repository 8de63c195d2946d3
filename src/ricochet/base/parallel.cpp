#include "ricochet/base/parallel.hpp"

#include <atomic>
#include <chrono>
#include <cstdint>
#include <exception>
#include <memory>
#include <mutex>
#include <thread>
#include <utility>
#include <vector>

#include "ricochet/base/blas.hpp"
#include "ricochet/base/blocked_signals.hpp"
#include "ricochet/base/error.hpp"

namespace ricochet {

namespace {

int configured_thread_count = 1;

/// True on a thread that is executing the work of a range.
thread_local bool inside_range = false;

/// Hints to the processor that this is a spin loop.
void pause() {
#if defined(__x86_64__)
  __builtin_ia32_pause();
#endif
}

/// Polls `ready` for a while; returns false if it did not become true.
template <class Ready>
bool spin_until(const Ready& ready) {
  using clock = std::chrono::steady_clock;
  constexpr std::chrono::microseconds patience{50};
  if (ready()) return true;
  const clock::time_point start = clock::now();
  do {
    for (int i = 0; i < 64; ++i) {
      if (ready()) return true;
      pause();
    }
  } while (clock::now() - start < patience);
  return false;
}

/// Threads that process the parts of one call after another. The caller takes part in the work, so a call never waits
/// for a thread that has not woken up yet.
class Pool {
 public:
  /// Creates `count` threads, including the caller's.
  explicit Pool(int count) : count_(count) {
    threads_.reserve(std::size_t(count - 1));
    const BlockedSignals signals_are_for_the_caller;
    for (int i = 1; i < count; ++i) threads_.emplace_back([this] { serve(); });
  }
  Pool(const Pool&) = delete;
  Pool& operator=(const Pool&) = delete;
  ~Pool() {
    ending_.store(true);
    call_.fetch_add(1);
    call_.notify_all();
    for (std::thread& thread : threads_) thread.join();
  }

  [[nodiscard]] int count() const { return count_; }

  void run(Index count, const detail::RangeWork& work) {
    const Index parts = std::min<Index>(count, work.one_by_one ? most_parts : Index(count_) * parts_per_thread);
    size_ = count;
    work_ = work;
    unfinished_.store(int(parts));
    const std::uint32_t call = call_.load(std::memory_order_relaxed) + 1;
    ticket_.store(std::uint64_t{call} << 32 | std::uint64_t(parts) << 16, std::memory_order_release);
    call_.store(call, std::memory_order_release);
    call_.notify_all();
    run_parts();
    if (!spin_until([&] { return unfinished_.load(std::memory_order_acquire) == 0; })) {
      for (int left = unfinished_.load(); left != 0; left = unfinished_.load()) unfinished_.wait(left);
    }
    if (problem_) std::rethrow_exception(std::exchange(problem_, nullptr));
  }

 private:
  /// More than one, so that a thread that is late or disturbed does not hold up the others.
  static constexpr int parts_per_thread = 4;
  /// The ticket below can hold twice as many.
  static constexpr Index most_parts = 1 << 15;

  /// Processes parts of the current call until none is left. The number of the call, its number of parts and the next
  /// part form one atomic number: a thread that draws an existing part keeps the call alive until that part is done.
  void run_parts() {
    while (true) {
      const std::uint64_t ticket = ticket_.fetch_add(1, std::memory_order_acq_rel);
      const auto part = Index(ticket & 0xffff);
      const auto parts = Index(ticket >> 16 & 0xffff);
      if (part >= parts) return;
      inside_range = true;
      try {
        work_.call(work_.object, size_ * part / parts, size_ * (part + 1) / parts);
      } catch (...) {
        const std::lock_guard lock(problem_access_);
        if (!problem_ || part < part_of_problem_) {
          problem_ = std::current_exception();
          part_of_problem_ = part;
        }
      }
      inside_range = false;
      if (unfinished_.fetch_sub(1, std::memory_order_acq_rel) == 1) unfinished_.notify_all();
    }
  }

  void serve() {
    std::uint32_t last_call = 0;
    while (true) {
      const auto called = [&] { return call_.load(std::memory_order_acquire) != last_call; };
      if (!spin_until(called)) call_.wait(last_call, std::memory_order_acquire);
      last_call = call_.load(std::memory_order_acquire);
      if (ending_.load()) return;
      run_parts();
    }
  }

  int count_;
  std::mutex problem_access_;
  std::exception_ptr problem_;  ///< of the lowest part that has thrown
  Index part_of_problem_ = 0;
  std::vector<std::thread> threads_;
  Index size_ = 0;
  detail::RangeWork work_;
  std::atomic<std::uint64_t> ticket_{0};
  std::atomic<std::uint32_t> call_{0};
  std::atomic<int> unfinished_{0};
  std::atomic<bool> ending_{false};
};

}  // namespace

void set_thread_count(int count) {
  if (count < 1 || count > 1024) throw Error(ErrorKind::usage, "the number of threads must be from 1 to 1024");
  if (count > 1) prepare_blas();  // it must run while there are no other threads
  configured_thread_count = count;
}

int thread_count() { return configured_thread_count; }

void detail::run_ranges(Index count, const RangeWork& work) {
  if (count <= 0) return;
  static std::mutex in_use;
  std::unique_lock<std::mutex> lock(in_use, std::defer_lock);
  const int requested = configured_thread_count;
  if (requested == 1 || count == 1 || inside_range || !lock.try_lock()) {
    work.call(work.object, 0, count);
    return;
  }
  static std::unique_ptr<Pool> pool;
  if (!pool || pool->count() != requested) {
    pool.reset();
    pool = std::make_unique<Pool>(requested);
  }
  pool->run(count, work);
}

}  // namespace ricochet
