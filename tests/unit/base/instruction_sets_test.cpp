#include "ricochet/base/instruction_sets.hpp"

#include <gtest/gtest.h>

#include <cstdlib>
#include <string>

namespace ricochet {
namespace {

TEST(InstructionSets, TheOneThatRunsIsWhatTheEnvironmentSaysOrTheBest) {
  const char* const variable = std::getenv("RICOCHET_INSTRUCTION_SET");
  const char* const given = variable != nullptr && *variable != '\0' ? variable : nullptr;
  EXPECT_LE(instruction_set(), best_instruction_set());
  EXPECT_EQ(name(instruction_set()), given != nullptr ? std::string(given) : name(best_instruction_set()));
  EXPECT_EQ(instruction_set_is_given(), given != nullptr);
}

#if defined(__x86_64__) && defined(__GNUC__)
/// (1 + 2⁻³⁰)² = 1 + 2⁻²⁹ + 2⁻⁶⁰, whose last term is lost if the product is rounded separately.
RICOCHET_EACH_INSTRUCTION_SET(double, last_term, (double value), (value)) { return value * value - (1.0 + 0x1p-29); }
/// Returns (1 + 2⁻³⁰)² − (1 + 2⁻²⁹) with AVX2 and FMA, whichever instruction set is selected.
__attribute__((target("arch=x86-64-v3"), noinline)) double last_term_with_avx2(double value) {
  return value * value - (1.0 + 0x1p-29);
}

TEST(InstructionSets, TheVersionForTheSetIsCalled) {
  const volatile double value = 1.0 + 0x1p-30;  // unknown to the compiler, which would evaluate it
  if (instruction_set() == InstructionSet::baseline) {
    EXPECT_EQ(last_term(value), 0.0);
    return;
  }
  const double fused = last_term_with_avx2(value);
  if (fused == 0.0) GTEST_SKIP() << "without its optimizer this compiler fuses no product and sum";
  EXPECT_EQ(fused, 0x1p-60);
  EXPECT_EQ(last_term(value), fused);
}
#endif

}  // namespace
}  // namespace ricochet
