#pragma once

#include <string_view>

/// @file Loops compiled for several instruction sets, and which of them runs. Not part of the public interface.
///
/// The program is compiled for any x86-64; functions made by RICOCHET_EACH_INSTRUCTION_SET take wider registers where
/// the processor has them, and may round a product and a sum once where it can do both at once: bits are those of the
/// set.
namespace ricochet {

/// Each contains those before it. On other processors there is only the first.
enum class InstructionSet {
  baseline,  ///< x86-64, which every processor has
  avx2,      ///< x86-64-v3, with fused products and sums
  avx512,    ///< x86-64-v4: F, BW, CD, DQ and VL
};

/// "x86-64", "x86-64-v3" or "x86-64-v4"; "any processor" on others.
[[nodiscard]] std::string_view name(InstructionSet set);

/// The most that the processor and the system can do.
[[nodiscard]] InstructionSet best_instruction_set();

/// What environment variable RICOCHET_INSTRUCTION_SET allows, given by its name, or else the best; decided at the first
/// call. Throws Error(usage), each time, if the variable has no such name or one that the processor cannot do.
[[nodiscard]] InstructionSet instruction_set();

/// Has the user said which?
[[nodiscard]] bool instruction_set_is_given();

}  // namespace ricochet

/// A function or template that such functions call, to be compiled as a part of each.
#if defined(__GNUC__)
#define RICOCHET_PART_OF_CALLER __attribute__((always_inline)) inline
#else
#define RICOCHET_PART_OF_CALLER inline
#endif

/// Stands for the head of a function, and is followed by its body: the function calls the one of its compiled versions
/// that is for `instruction_set()`. `parameters` are in parentheses, as are `arguments`, their names. GCC's
/// target_clones would do as much with less, but clang does not have them, and nobody can tell them what to take.
#if defined(__x86_64__) && defined(__GNUC__)
#define RICOCHET_EACH_INSTRUCTION_SET(Result, function, parameters, arguments)           \
  RICOCHET_PART_OF_CALLER static Result function##_body parameters;                      \
  __attribute__((target("arch=x86-64-v4"))) static Result function##_avx512 parameters { \
    return function##_body arguments;                                                    \
  }                                                                                      \
  __attribute__((target("arch=x86-64-v3"))) static Result function##_avx2 parameters {   \
    return function##_body arguments;                                                    \
  }                                                                                      \
  __attribute__((noinline)) static Result function##_baseline parameters {               \
    return function##_body arguments;                                                    \
  }                                                                                      \
  Result function parameters {                                                           \
    switch (instruction_set()) {                                                         \
      case InstructionSet::avx512:                                                       \
        return function##_avx512 arguments;                                              \
      case InstructionSet::avx2:                                                         \
        return function##_avx2 arguments;                                                \
      case InstructionSet::baseline:                                                     \
        break;                                                                           \
    }                                                                                    \
    return function##_baseline arguments;                                                \
  }                                                                                      \
  Result function##_body parameters
#else
#define RICOCHET_EACH_INSTRUCTION_SET(Result, function, parameters, arguments) Result function parameters
#endif
