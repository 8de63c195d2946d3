#pragma once

/// @file Numbers too small for their exponent.
namespace ricochet {

/// While it lives, arithmetic of this thread takes denormal numbers as zero, where the processor can: it is slow with
/// them, and in single precision what decays across a body reaches them.
class FlushDenormals {
 public:
#if defined(__SSE__)
  FlushDenormals() : before_(__builtin_ia32_stmxcsr()) {
    __builtin_ia32_ldmxcsr(before_ | flush_results | zero_operands);
  }
  ~FlushDenormals() {
    __builtin_ia32_ldmxcsr(before_);
  }
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
