#pragma once

/// @file Denormal numbers, too small for the normal range of exponents.
namespace ricochet {

/// Makes arithmetic of this thread treat denormal numbers as zero for its lifetime, if the processor supports it:
/// operations on them are slow, and quantities that decay across a body reach them in single precision.
class FlushDenormals {
 public:
#if defined(__SSE__)
  FlushDenormals() : before_(__builtin_ia32_stmxcsr()) {
    __builtin_ia32_ldmxcsr(before_ | flush_results | zero_operands);
  }
  ~FlushDenormals() { __builtin_ia32_ldmxcsr(before_); }
#else
  FlushDenormals() = default;
  ~FlushDenormals() = default;
#endif
  FlushDenormals(const FlushDenormals&) = delete;
  FlushDenormals& operator=(const FlushDenormals&) = delete;

#if defined(__SSE__)
 private:
  static constexpr unsigned flush_results = 0x8000, zero_operands = 0x0040;
  unsigned before_;
#endif
};

}  // namespace ricochet
