#include "ricochet/base/parallel.hpp"

#include <exception>
#include <thread>
#include <vector>

#include "ricochet/base/error.hpp"

namespace ricochet {

namespace {
int configured_thread_count = 1;
}

void set_thread_count(int count) {
  if (count < 1 || count > 1024) throw Error(ErrorKind::usage, "the number of threads must be from 1 to 1024");
  configured_thread_count = count;
}

int thread_count() {
  return configured_thread_count;
}

void parallel_ranges(Index count, const std::function<void(Index, Index)>& work) {
  const Index parts = std::min<Index>(configured_thread_count, count);
  if (parts <= 1) {
    if (count > 0) work(0, count);
    return;
  }
  std::vector<std::exception_ptr> problems(static_cast<std::size_t>(parts));
  std::vector<std::thread> threads;
  threads.reserve(static_cast<std::size_t>(parts));
  for (Index part = 0; part < parts; ++part) {
    threads.emplace_back([&, part] {
      try {
        work(count * part / parts, count * (part + 1) / parts);
      } catch (...) {
        problems[static_cast<std::size_t>(part)] = std::current_exception();
      }
    });
  }
  for (std::thread& thread : threads) thread.join();
  for (const std::exception_ptr& problem : problems) {
    if (problem) std::rethrow_exception(problem);
  }
}

}  // namespace ricochet
