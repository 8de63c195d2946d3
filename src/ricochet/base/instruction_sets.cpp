#include "ricochet/base/instruction_sets.hpp"

#include <fmt/format.h>

#include <array>
#include <cstdlib>

#include "ricochet/base/error.hpp"

namespace ricochet {

namespace {

constexpr const char* variable = "RICOCHET_INSTRUCTION_SET";

const char* given_name() {
  const char* const value = std::getenv(variable);
  return value != nullptr && *value != '\0' ? value : nullptr;
}

InstructionSet choose() {
  const InstructionSet best = best_instruction_set();
  const char* const given = given_name();
  if (given == nullptr) return best;
  for (const InstructionSet set : {InstructionSet::baseline, InstructionSet::avx2, InstructionSet::avx512}) {
    if (name(set) != given) continue;
    if (set <= best) return set;
    throw Error(
        ErrorKind::usage,
        fmt::format(
            "{}={}: this processor, or its operating system, supports at most {}; use that, or unset the variable",
            variable, given, name(best)));
  }
#if defined(__x86_64__)
  throw Error(ErrorKind::usage,
              fmt::format("{}={}: unknown instruction set; use x86-64, x86-64-v3 or x86-64-v4, or unset the variable",
                          variable, given));
#else
  throw Error(ErrorKind::usage,
              fmt::format("{}={}: this kind of processor has no instruction sets to choose from; unset the variable",
                          variable, given));
#endif
}

}  // namespace

std::string_view name(InstructionSet set) {
#if defined(__x86_64__)
  constexpr std::array<std::string_view, 3> names{"x86-64", "x86-64-v3", "x86-64-v4"};
  return names[std::size_t(set)];
#else
  static_cast<void>(set);
  return "any processor";
#endif
}

InstructionSet best_instruction_set() {
#if defined(__x86_64__) && defined(__clang__) && __clang_major__ < 18
  // Older clang does not know the levels by name. Features that it cannot test either (LZCNT, MOVBE, F16C) came with
  // AVX2 or before.
  const bool v3 = __builtin_cpu_supports("avx2") != 0 && __builtin_cpu_supports("fma") != 0 &&
                  __builtin_cpu_supports("bmi") != 0 && __builtin_cpu_supports("bmi2") != 0;
  const bool v4 = v3 && __builtin_cpu_supports("avx512f") != 0 && __builtin_cpu_supports("avx512bw") != 0 &&
                  __builtin_cpu_supports("avx512cd") != 0 && __builtin_cpu_supports("avx512dq") != 0 &&
                  __builtin_cpu_supports("avx512vl") != 0;
  return v4 ? InstructionSet::avx512 : v3 ? InstructionSet::avx2 : InstructionSet::baseline;
#elif defined(__x86_64__) && defined(__GNUC__)
  if (__builtin_cpu_supports("x86-64-v4") != 0) return InstructionSet::avx512;
  if (__builtin_cpu_supports("x86-64-v3") != 0) return InstructionSet::avx2;
  return InstructionSet::baseline;
#else
  return InstructionSet::baseline;
#endif
}

InstructionSet instruction_set() {
  static const InstructionSet set = choose();
  return set;
}

bool instruction_set_is_given() {
  static const bool given = given_name() != nullptr;
  return given;
}

}  // namespace ricochet
