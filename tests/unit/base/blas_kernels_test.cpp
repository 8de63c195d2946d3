#include "ricochet/base/blas_kernels.hpp"

#include <cblas.h>
#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <future>
#include <iterator>
#include <string>
#include <thread>
#include <vector>

#include "ricochet/base/blas.hpp"
#include "ricochet/base/log.hpp"

extern "C" {
__attribute__((weak)) void gotoblas_dynamic_init();
__attribute__((weak)) void gotoblas_dynamic_quit();
}

namespace ricochet {
namespace {

constexpr InstructionSet baseline = InstructionSet::baseline, avx2 = InstructionSet::avx2,
                         avx512 = InstructionSet::avx512;

/// The features of the processor decide, not the table of OpenBLAS; an equally good or an unknown kernel is kept.
TEST(BlasKernels, AreThoseOfTheProcessorUnlessOpenBlasHasChosenAsWell) {
  for (const char* lesser : {"Prescott", "PRESCOTT", "Nehalem", "Core2", "Barcelona", "Sandybridge", "Bulldozer"}) {
    EXPECT_EQ(better_blas_core(lesser, avx512, false), "SkylakeX") << lesser;
    EXPECT_EQ(better_blas_core(lesser, avx2, false), "Haswell") << lesser;
    EXPECT_EQ(better_blas_core(lesser, baseline, false), "") << lesser;
  }
  for (const char* good : {"Haswell", "Zen", "Excavator"}) {
    EXPECT_EQ(better_blas_core(good, avx512, false), "SkylakeX") << good;
    EXPECT_EQ(better_blas_core(good, avx2, false), "") << good;
  }
  for (const char* best : {"SkylakeX", "SKYLAKEX", "Cooperlake", "SapphireRapids", "a core of tomorrow"}) {
    for (const InstructionSet set : {baseline, avx2, avx512}) EXPECT_EQ(better_blas_core(best, set, false), "") << best;
  }
}

/// Requesting a set selects the same kernels on every machine.
TEST(BlasKernels, OfASetThatIsGivenAreAlwaysTheSame) {
  for (const char* chosen : {"Nehalem", "Sandybridge", "Zen", "Cooperlake", "SapphireRapids", "a core of tomorrow"}) {
    EXPECT_EQ(better_blas_core(chosen, baseline, true), "Prescott");
    EXPECT_EQ(better_blas_core(chosen, avx2, true), "Haswell");
    EXPECT_EQ(better_blas_core(chosen, avx512, true), "SkylakeX");
  }
  EXPECT_EQ(better_blas_core("PRESCOTT", baseline, true), "");
  EXPECT_EQ(better_blas_core("Haswell", avx2, true), "");
  EXPECT_EQ(better_blas_core("SkylakeX", avx512, true), "");
}

/// A process in which OpenBLAS chose badly, forced here by its variable.
class BadChoice : public testing::Test {
 protected:
  void SetUp() override {
    if (gotoblas_dynamic_init == nullptr || gotoblas_dynamic_quit == nullptr) GTEST_SKIP() << "not with this OpenBLAS";
    if (std::getenv("OPENBLAS_CORETYPE") != nullptr) GTEST_SKIP() << "OPENBLAS_CORETYPE is set";
    const std::filesystem::directory_iterator threads("/proc/self/task");
    if (std::distance(begin(threads), end(threads)) > openblas_get_num_threads())
      GTEST_SKIP() << "threads that an earlier test has left";
    take(instruction_set() == baseline ? "Nehalem" : "Prescott");
    bad_ = openblas_get_corename();
    wanted_ = better_blas_core(bad_, instruction_set(), instruction_set_is_given());
    if (wanted_.empty()) GTEST_SKIP() << "nothing is better on this processor";
  }
  static void take(const char* core) {
    setenv("OPENBLAS_CORETYPE", core, 1);
    gotoblas_dynamic_quit();
    gotoblas_dynamic_init();
    unsetenv("OPENBLAS_CORETYPE");
  }
  std::string bad_, wanted_;
};

TEST_F(BadChoice, IsCorrectedAndLeavesNoVariable) {
  std::vector<std::string> warnings;
  const log::CollectWarnings collect(warnings);
  choose_blas_kernels();
  EXPECT_EQ(openblas_get_corename(), wanted_);
  EXPECT_EQ(std::getenv("OPENBLAS_CORETYPE"), nullptr);
  choose_blas_kernels();
  EXPECT_EQ(openblas_get_corename(), wanted_);
  EXPECT_TRUE(warnings.empty());
}

TEST_F(BadChoice, StaysWhereTheUserHasMadeIt) {
  setenv("OPENBLAS_CORETYPE", bad_.c_str(), 1);
  choose_blas_kernels();
  EXPECT_EQ(openblas_get_corename(), bad_);
  EXPECT_EQ(std::getenv("OPENBLAS_CORETYPE"), bad_);
  unsetenv("OPENBLAS_CORETYPE");
}

TEST_F(BadChoice, StaysWhileOtherThreadsRunWhichIsSaid) {
  std::vector<std::string> warnings;
  const log::CollectWarnings collect(warnings);
  std::promise<void> finish;
  std::thread other([&] { finish.get_future().wait(); });
  choose_blas_kernels();
  EXPECT_EQ(openblas_get_corename(), bad_);
  finish.set_value();
  other.join();
  ASSERT_EQ(warnings.size(), 1U);
  EXPECT_NE(warnings[0].find("prepare_blas()"), std::string::npos) << warnings[0];
  EXPECT_NE(warnings[0].find("OPENBLAS_CORETYPE=" + wanted_), std::string::npos) << warnings[0];
}

}  // namespace
}  // namespace ricochet
