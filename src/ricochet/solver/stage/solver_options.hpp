#pragma once

#include <memory>
#include <string>
#include <vector>

#include "ricochet/linear_algebra/preconditioner_maker.hpp"

/// @file Options of the step solver, the method chosen for each operator, and counts of iterations.
namespace ricochet {

enum class SolverMethod : char {
  automatic,  ///< what takes less time for the steps that are expected, where the factor fits into memory
  direct,     ///< a Cholesky factor, made once: forward solve, contact problem, back solve
  iterative,  ///< conjugate gradients around a direct solve near the contact
};

struct StepSolverOptions {
  SolverMethod method = SolverMethod::automatic;
  /// Of the iterative method: the force that is left over, relative to the forces of the step, in the energy norm.
  double tolerance = 1e-10;
  /// Memory that factors may take, in bytes; 0: half of the machine's.
  double memory = 0.0;
  /// All contact points take part in every contact problem, not only those that may touch. For comparisons.
  bool all_points = false;
  /// Solves that are expected of each operator: what a factorization is worth. 0: nobody knows, and it counts as a
  /// thousand.
  long solves = 0;
  /// What iterations are preconditioned by: "block-jacobi", or a name that `preconditioners` knows; "auto": one of
  /// both, by what is expected to take less time.
  std::string preconditioner = "auto";
  std::shared_ptr<const PreconditionerMaker> preconditioners = {};  ///< null: there are no others
  /// What was chosen before for these operators, one by one: a run that goes on keeps it. Empty: chosen anew.
  std::vector<SolverMethod> chosen = {};
};

/// What was chosen for an operator, and why.
struct ChosenMethod {
  SolverMethod method = SolverMethod::direct;
  std::string reason = {};            ///< the rest of a sentence that begins with the method
  double predicted_entries = 0.0;     ///< of the factor; 0: not asked
  double predicted_operations = 0.0;  ///< of its factorization
  double expected_iterations = 0.0;   ///< of conjugate gradients; 0: not asked
  double ordering_seconds = 0.0;      ///< with the analysis that predicts
  double factorization_seconds = 0.0;
};

/// What the iterative method has done so far.
struct IterationCounts {
  long rounds = 0;     ///< of zones and conjugate gradients in turn
  long gradients = 0;  ///< iterations of conjugate gradients
  IterationCounts& operator+=(const IterationCounts& other) {
    rounds += other.rounds;
    gradients += other.gradients;
    return *this;
  }
};

}  // namespace ricochet
