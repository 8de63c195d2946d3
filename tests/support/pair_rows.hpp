#pragma once

#include <string>

#include "ricochet/problem/semidiscrete_problem.hpp"

/// @file What tests of rows between two bodies share.
namespace ricochet::test_support {

/// Two boxes of one shape of cells, with multipliers on one of them.
struct PairOfBoxes {
  CellShape shape = CellShape::triangle;
  std::string multipliers = "p1";
  int degree = 1;
};
[[nodiscard]] std::string name_of(const PairOfBoxes& of);

[[nodiscard]] Vector gaps(const SemidiscreteProblem& problem, const Vector& displacement);

/// Resultant and moment of a row of G about places X + U: their lengths.
struct RowBalance {
  double force = 0.0, moment = 0.0;
};
[[nodiscard]] RowBalance balance_of_row(const SemidiscreteProblem& problem, const ContactRows& rows, Index point,
                                        const Vector& displacement);

/// The displacement with a turn by two radians, in space about more than one axis, and a translation after it.
[[nodiscard]] Vector moved_rigidly(const SemidiscreteProblem& problem, const Vector& displacement);

}  // namespace ricochet::test_support
