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

/// Expects that all rows of G have neither a resultant nor a moment about positions X + U.
void expect_balance(const SemidiscreteProblem& problem, const ContactRows& rows, const Vector& displacement,
                    double tolerance, const std::string& what);
/// Expects that the rows of a step yield the change of the gaps between its ends.
void expect_change_of_gaps(const SemidiscreteProblem& problem, const ContactRows& rows, const Vector& first,
                           const Vector& second, const std::string& what);
/// Expects that a rotation by two radians, in space about more than one axis, and a translation change no gap.
void expect_invariant_gaps(const SemidiscreteProblem& problem, const Vector& displacement, const std::string& what);

}  // namespace ricochet::test_support
