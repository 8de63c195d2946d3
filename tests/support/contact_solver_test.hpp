#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <vector>

#include "support/contact_problems.hpp"

/// @file Fixture of the tests of every contact solver. Registered solvers are included automatically.
namespace ricochet::test_support {

/// The parameter is the name of a solver.
class ContactSolverTest : public testing::TestWithParam<std::string> {
 protected:
  /// The active set method does not support slip in two directions.
  [[nodiscard]] Index dimension() const { return GetParam() == "active-set" ? 2 : 3; }
  [[nodiscard]] ContactSolution solve(const FrictionProblem& problem, const ContactOptions& options) const {
    return test_support::solve(problem, options, GetParam());
  }
  [[nodiscard]] ContactSolution solve(const ContactProblem& problem, const ContactOptions& options) const {
    const auto solver = make_contact_solver(GetParam());
    ContactSolution solution;
    solver->analyse(problem);
    solver->solve(problem, options, solution);
    return solution;
  }
};

/// Parameters for INSTANTIATE_TEST_SUITE_P.
inline auto every_contact_solver() {
  std::vector<std::string> names;
  for (const auto& solver : contact_solver_registry().all()) names.push_back(solver.name);
  return testing::ValuesIn(names);
}
inline std::string contact_solver_test_name(const testing::TestParamInfo<std::string>& parameter) {
  std::string name = parameter.param;
  std::ranges::replace(name, '-', '_');
  return name;
}

}  // namespace ricochet::test_support
