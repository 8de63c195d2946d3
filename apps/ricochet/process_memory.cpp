#include "process_memory.hpp"

#include <malloc.h>
#include <unistd.h>

#include <cstdlib>
#include <string_view>

#include "ricochet/base/blas.hpp"

namespace ricochet::program {

void restart_without_blas_threads(char** argv) {
  const char* const threads = std::getenv("OPENBLAS_NUM_THREADS");
  if (!memory_is_limited() || (threads != nullptr && std::string_view(threads) == "1")) return;
  setenv("OPENBLAS_NUM_THREADS", "1", 1);
  execv("/proc/self/exe", argv);
}

void keep_memory() {
#ifdef __GLIBC__
  constexpr int threshold = 1 << 30;
  mallopt(M_MMAP_THRESHOLD, threshold);
  mallopt(M_TRIM_THRESHOLD, threshold);
#endif
}

}  // namespace ricochet::program
