#pragma once

#include <memory>
#include <string>
#include <vector>

#include "ricochet/linear_algebra/preconditioner_factory.hpp"

/// @file Options of the step solver, the method chosen for each operator, and counts of iterations.
namespace ricochet {

enum class SolverMethod : char {
  automatic,  ///< the faster one for the expected number of steps, if the factor fits into memory
  direct,     ///< a Cholesky factor, made once: forward solve, contact problem, back solve
  iterative,  ///< conjugate gradients around a direct solve near the contact
};

struct StepSolverOptions {
  SolverMethod method = SolverMethod::automatic;
  /// Residual force of the iterative method, relative to the forces of the step, in the energy norm.
  double tolerance = 1e-10;
  /// Error of the increment of a step that Newton's method leaves, relative to the increment.
  double newton_tolerance = 1e-8;
  /// Memory that factors may take, in bytes; 0: half of the machine's.
  double memory = 0.0;
  /// Includes all contact points in every contact problem, not only those that may touch. For comparisons.
  bool all_points = false;
  /// Expected number of solves of each operator, which decides whether a factorization pays. 0: unknown, counts as a
  /// thousand.
  long solves = 0;
  /// Preconditioner of iterations: a name of preconditioner_registry(); "auto": the one that is expected to take less
  /// time.
  std::string preconditioner = "auto";
  std::shared_ptr<const PreconditionerFactory> preconditioners = {};  ///< those of PETSc; null without it
  /// Methods chosen earlier for these operators, one by one, which a resumed run keeps. Empty: chosen anew.
  std::vector<SolverMethod> chosen = {};
};

/// Method chosen for an operator, and the reason.
struct ChosenMethod {
  SolverMethod method = SolverMethod::direct;
  std::string reason = {};            ///< the rest of a sentence that begins with the method
  double predicted_entries = 0.0;     ///< of the factor; 0 if not computed
  double predicted_operations = 0.0;  ///< of its factorization
  double expected_iterations = 0.0;   ///< of conjugate gradients; 0 if not computed
  double ordering_seconds = 0.0;      ///< including the analysis for the prediction
  double factorization_seconds = 0.0;
};

/// Iterations of the iterative method so far.
struct IterationCounts {
  long schwarz_iterations = 0;  ///< alternations of subdomains and conjugate gradients
  long gradients = 0;           ///< iterations of conjugate gradients
  IterationCounts& operator+=(const IterationCounts& other) {
    schwarz_iterations += other.schwarz_iterations;
    gradients += other.gradients;
    return *this;
  }
};

}  // namespace ricochet
