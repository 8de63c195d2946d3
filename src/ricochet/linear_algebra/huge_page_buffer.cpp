#include "ricochet/linear_algebra/huge_page_buffer.hpp"

#include <cstdlib>
#include <new>

#if defined(__linux__)
#include <sys/mman.h>
#endif

namespace ricochet {

namespace {

constexpr std::size_t huge_page = std::size_t{1} << 21;
constexpr std::size_t cache_line = 64;

}  // namespace

HugePageBuffer::HugePageBuffer(std::size_t size) : size_(size) {
  const std::size_t alignment = size * sizeof(double) >= huge_page ? huge_page : cache_line;
  const std::size_t bytes = (size * sizeof(double) / alignment + 1) * alignment;
  values_.reset(static_cast<double*>(std::aligned_alloc(alignment, bytes)));
  if (!values_) throw std::bad_alloc();
#if defined(__linux__)
  // Only a hint: without such pages the solves are a little slower.
  if (alignment == huge_page) static_cast<void>(madvise(values_.get(), bytes, MADV_HUGEPAGE));
#endif
}

void HugePageBuffer::Release::operator()(double* values) const {
  std::free(values);
}

}  // namespace ricochet
