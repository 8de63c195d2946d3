#pragma once

#if defined(__SSE2__)
#include <xmmintrin.h>
#endif

/// @file Numbers too small for their exponent.
namespace ricochet {

/// While it lives, arithmetic of this thread takes denormal numbers as zero, where the processor can: it is slow with
/// them, and in single precision what decays across a body reaches them.
class FlushDenormals {
 public:
#if defined(__SSE2__)
  FlushDenormals() : before_(_mm_getcsr()) {
    _mm_setcsr(before_ | flush_results | zero_operands);
  }
  ~FlushDenormals() {
    _mm_setcsr(before_);
  }
#else
  FlushDenormals() = default;
  ~FlushDenormals() = default;
#endif
  FlushDenormals(const FlushDenormals&) = delete;
  FlushDenormals& operator=(const FlushDenormals&) = delete;

#if defined(__SSE2__)
 private:
  static constexpr unsigned flush_results = 0x8000, zero_operands = 0x0040;
  unsigned before_;
#endif
};

}  // namespace ricochet
