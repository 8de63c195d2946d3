#include "ricochet/base/memory.hpp"

#include <sys/mman.h>
#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <cstdlib>
#include <fstream>
#include <new>

#ifdef __GLIBC__
#include <malloc.h>
#endif

namespace ricochet {

constexpr std::size_t huge_page = std::size_t{2} << 20;

double physical_memory() {
  double bytes = double(sysconf(_SC_PHYS_PAGES)) * double(sysconf(_SC_PAGESIZE));
  // The file contains "max" if there is no limit: not a number, and extraction fails.
  for (const char* name : {"/sys/fs/cgroup/memory.max", "/sys/fs/cgroup/memory/memory.limit_in_bytes"}) {
    std::ifstream file(name);
    double limit = 0.0;
    if (file >> limit && limit > 0.0) bytes = std::min(bytes, limit);
  }
  return bytes;
}

double peak_memory() {
  struct rusage usage {};
  getrusage(RUSAGE_SELF, &usage);
  return 1024.0 * double(usage.ru_maxrss);
}

void release_freed_memory() {
#ifdef __GLIBC__
  malloc_trim(0);
#endif
}

void* allocate_large(std::size_t bytes) {
  const bool is_large = bytes >= 2 * huge_page;
  // Whole pages, so that the rest of the last one belongs to no other allocation.
  const std::size_t size = is_large ? (bytes + huge_page - 1) / huge_page * huge_page : bytes;
  void* const memory = is_large ? std::aligned_alloc(huge_page, size) : std::malloc(std::max<std::size_t>(size, 1));
  if (memory == nullptr) throw std::bad_alloc();
#ifdef MADV_HUGEPAGE
  // Only a hint: without such pages nothing changes but the time.
  if (is_large) madvise(memory, size, MADV_HUGEPAGE);
#endif
  return memory;
}

void free_large(void* memory) { std::free(memory); }

}  // namespace ricochet
