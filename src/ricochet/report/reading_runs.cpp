#include "ricochet/report/reading_runs.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <thread>

#include "ricochet/base/error.hpp"
#include "ricochet/io/run_directory.hpp"

namespace ricochet {

void read_with_retries(const std::vector<std::string>& directories, const std::function<void()>& read) {
  constexpr int most_attempts = 5;
  for (int attempt = 1;; ++attempt) {
    try {
      return read();
    } catch (const Error& problem) {
      const auto used = std::ranges::find_if(directories, RunDirectory::is_in_use);
      if (problem.kind() != ErrorKind::invalid_input || used == directories.end()) throw;
      if (attempt == most_attempts) {
        throw Error(problem.kind(), fmt::format("{} (a run is writing into {}: try again)", problem.what(), *used));
      }
    }
    std::this_thread::sleep_for(std::chrono::milliseconds(200));
  }
}

}  // namespace ricochet
