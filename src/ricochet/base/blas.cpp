#include "ricochet/base/blas.hpp"

#include <fmt/format.h>
#include <sys/mman.h>
#include <sys/resource.h>

#include <algorithm>
#include <cstddef>
#include <vector>

#include "ricochet/base/blas_kernels.hpp"
#include "ricochet/base/error.hpp"

extern "C" {
void openblas_set_num_threads(int count);
// The allocator that OpenBLAS itself calls at the beginning and end of its functions.
void* blas_memory_alloc(int procedure);
void blas_memory_free(void* buffer);
}

namespace ricochet {

namespace {

/// Size of an OpenBLAS buffer (128 MB on current processors), and memory needed besides to start.
constexpr std::size_t buffer_size = std::size_t{128} << 20, beginning = std::size_t{32} << 20;

bool is_limited(decltype(RLIMIT_AS) resource) {
  struct rlimit limit {};
  return getrlimit(resource, &limit) == 0 && limit.rlim_cur != RLIM_INFINITY;
}

}  // namespace

void prepare_blas() {
  static const bool done = [] {
    choose_blas_kernels();
    openblas_set_num_threads(1);
    return true;
  }();
  static_cast<void>(done);
}

bool memory_is_limited() { return is_limited(RLIMIT_AS) || is_limited(RLIMIT_DATA); }

void reserve_blas_memory(int threads) {
  if (!memory_is_limited()) return;
  const auto count = std::size_t(std::max(threads, 1));
  const std::size_t size = count * buffer_size + beginning;
  void* const probe = mmap(nullptr, size, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS | MAP_NORESERVE, -1, 0);
  if (probe == MAP_FAILED) {
    throw Error(ErrorKind::not_converged, fmt::format("the memory limit (ulimit -v, ulimit -d) is too low: the linear "
                                                      "algebra library needs {} MB to start; raise the limit{}",
                                                      size >> 20, count > 1 ? ", or use fewer threads" : ""));
  }
  munmap(probe, size);
  std::vector<void*> buffers;
  for (std::size_t i = 0; i < count; ++i) buffers.push_back(blas_memory_alloc(0));
  for (void* const buffer : buffers) blas_memory_free(buffer);
}

}  // namespace ricochet
