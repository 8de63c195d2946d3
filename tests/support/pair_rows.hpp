#pragma once

#include <string>

#include "ricochet/problem/semidiscrete_problem.hpp"

/// @file Helpers for tests of rows between two bodies.
namespace ricochet::test_support {

/// Two boxes with the same cell shape, and multipliers on one of them.
struct PairOfBoxes {
  CellShape shape = CellShape::triangle;
  std::string multipliers = "p1";
  int degree = 1;
};
[[nodiscard]] std::string name_of(const PairOfBoxes& of);

[[nodiscard]] Vector gaps(const SemidiscreteProblem& problem, const Vector& displacement);

/// Lengths of the resultant and moment of a row of G about positions X + U.
struct RowBalance {
  double force = 0.0, moment = 0.0;
};
[[nodiscard]] RowBalance balance_of_row(const SemidiscreteProblem& problem, const ContactRows& rows, Index point,
                                        const Vector& displacement);

/// Returns the displacement followed by a rotation by two radians, in space about more than one axis, and a
/// translation.
[[nodiscard]] Vector moved_rigidly(const SemidiscreteProblem& problem, const Vector& displacement);

}  // namespace ricochet::test_support
