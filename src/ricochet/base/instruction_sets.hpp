#pragma once

#include <string_view>

/// @file Loops compiled for several instruction sets, and the choice among them. Not part of the public interface.
///
/// The program is compiled for any x86-64. Functions made by RICOCHET_EACH_INSTRUCTION_SET use wider registers if the
/// processor has them, and may round a product and a sum once if it has fused operations: bits depend on the
/// instruction set.
namespace ricochet {

/// Instruction sets; each contains those before it. On other processors only the first exists.
enum class InstructionSet {
  baseline,  ///< x86-64, which every processor has
  avx2,      ///< x86-64-v3, with fused multiply-add
  avx512,    ///< x86-64-v4: F, BW, CD, DQ and VL
};

/// Returns "x86-64", "x86-64-v3" or "x86-64-v4"; "any processor" on other processors.
[[nodiscard]] std::string_view name(InstructionSet set);

/// Returns the largest set that the processor and the operating system support.
[[nodiscard]] InstructionSet best_instruction_set();

/// Returns the set that the environment variable RICOCHET_INSTRUCTION_SET names, or else the best; decided at the first
/// call. Throws Error(usage), at each call, if the variable names no set or one that the processor does not support.
[[nodiscard]] InstructionSet instruction_set();

/// Returns whether the user has chosen the set.
[[nodiscard]] bool instruction_set_is_given();

}  // namespace ricochet

/// Marks a function or template that such functions call, to be compiled as a part of each.
#if defined(__GNUC__)
#define RICOCHET_PART_OF_CALLER __attribute__((always_inline)) inline
#else
#define RICOCHET_PART_OF_CALLER inline
#endif

/// Replaces the head of a function and is followed by its body: the function calls the compiled version for
/// `instruction_set()`. `parameters` are in parentheses, as are `arguments`, their names. GCC's target_clones would
/// need less code, but clang lacks it, and the user could not choose the version.
#if defined(__x86_64__) && defined(__GNUC__)
#define RICOCHET_EACH_INSTRUCTION_SET(Result, function, parameters, arguments)                                 \
  RICOCHET_PART_OF_CALLER static Result function##_body parameters;                                            \
  __attribute__((target("arch=x86-64-v4"))) static Result function##_avx512 parameters {                       \
    return function##_body arguments;                                                                          \
  }                                                                                                            \
  __attribute__((target("arch=x86-64-v3"))) static Result function##_avx2 parameters {                         \
    return function##_body arguments;                                                                          \
  }                                                                                                            \
  __attribute__((noinline)) static Result function##_baseline parameters { return function##_body arguments; } \
  Result function parameters {                                                                                 \
    switch (instruction_set()) {                                                                               \
      case InstructionSet::avx512:                                                                             \
        return function##_avx512 arguments;                                                                    \
      case InstructionSet::avx2:                                                                               \
        return function##_avx2 arguments;                                                                      \
      case InstructionSet::baseline:                                                                           \
        break;                                                                                                 \
    }                                                                                                          \
    return function##_baseline arguments;                                                                      \
  }                                                                                                            \
  Result function##_body parameters
#else
#define RICOCHET_EACH_INSTRUCTION_SET(Result, function, parameters, arguments) Result function parameters
#endif
