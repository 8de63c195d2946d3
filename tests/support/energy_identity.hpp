#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <string>

#include "support/case_run.hpp"

/// @file Discrete energy identities: exact, for one step, on any mesh.
namespace ricochet::test_support {

/// Runs a case and compares the energy change of every step with `identity(before, after)`, up to so many roundings.
inline void expect_identity(CaseRun& run, const std::string& name,
                            const std::function<double(const StepEnd&, const StepEnd&)>& identity,
                            double roundings = 20.0) {
  StepEnd before(run);
  double worst = 0.0;
  double touched = 0.0;
  run.run(
      [&] {
        const StepEnd after(run);
        const double size = std::max(before.size_of_energy_terms, after.size_of_energy_terms);
        worst = std::max(worst, std::abs(after.energy - before.energy - identity(before, after)) / size);
        touched = std::max(touched, after.normal.maxCoeff());
        before = after;
      },
      false);
  EXPECT_LT(worst, roundings * std::numeric_limits<double>::epsilon()) << name;
  EXPECT_GT(touched, 0.0) << name << ": the body never touched the obstacle";
}

}  // namespace ricochet::test_support
