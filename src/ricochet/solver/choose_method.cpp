#include "ricochet/solver/choose_method.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "ricochet/base/memory.hpp"
#include "ricochet/linear_algebra/graph_components.hpp"
#include "ricochet/solver/stage/stage_product.hpp"
#include "ricochet/solver/step_estimate.hpp"

namespace ricochet {

namespace {

/// Part of the machine's memory that factors may take. The model and other programs need the rest.
constexpr double memory_part = 0.5;
/// Seconds up to which a factorization is always preferred: solves with a factor are exact to rounding.
constexpr double short_factorization = 10.0;
/// Number of solves that is assumed if it is unknown.
constexpr double many_solves = 1000.0;
/// Vectors that an iteration reads or writes besides those of the product: in single precision, and in double precision
/// with a separate mass.
constexpr double single_vectors_per_iteration = 13.0;
constexpr double vectors_per_iteration = 12.0;
/// Products in double precision of a stage whose iterations are in single precision: two in each of five alternations
/// with the subdomains.
constexpr double double_products = 10.0;

/// M 1, component by component: also for a mass that acts on all components alike.
Vector row_sums(const NodeMatrix& mass) {
  Vector result;
  mass.multiply(Vector::Ones(mass.size()), result);
  return result;
}

/// Displacement that shears each body in the plane of two axes: along each, the position along the other, from the
/// body's centre of mass.
Vector shear(const SemidiscreteProblem& problem, const std::vector<std::vector<Index>>& bodies, const Vector& inertia,
             int a, int b) {
  const int d = problem.dimension;
  Vector result = Vector::Zero(problem.dof_count());
  for (const std::vector<Index>& body : bodies) {
    Eigen::Vector2d moment = Eigen::Vector2d::Zero();
    double mass = 0.0;
    for (const Index node : body) {
      moment += inertia[node * d] * Eigen::Vector2d(problem.nodes(a, node), problem.nodes(b, node));
      mass += inertia[node * d];
    }
    if (mass > 0.0) moment /= mass;
    for (const Index node : body) {
      result[node * d + a] = problem.nodes(b, node) - moment[1];
      result[node * d + b] = problem.nodes(a, node) - moment[0];
    }
  }
  return result;
}

/// Σ x·y over the dofs of a body's nodes.
double product_in(const std::vector<Index>& body, int d, const Vector& x, const Vector& y) {
  double sum = 0.0;
  for (const Index node : body) sum += x.segment(node * d, d).dot(y.segment(node * d, d));
  return sum;
}

/// Largest ratio uᵀDu/uᵀAu of the shears u of a body, over the bodies: D is A's diagonal, without the off-diagonal part
/// of M.
double softness(const SemidiscreteProblem& problem, const OperatorCoefficients& coefficients,
                const NodeMatrix& stiffness) {
  const int d = problem.dimension;
  const std::vector<std::vector<Index>> bodies = graph_components(MatrixGraph(stiffness.pattern()));
  const Vector inertia = row_sums(problem.mass);
  const Vector diagonal = coefficients.mass * inertia + coefficients.stiffness * stiffness.diagonal();
  double result = 0.0;
  Vector elastic, inertial;
  for (int axis = 0; axis < (d == 2 ? 1 : 3); ++axis) {
    const Vector along = shear(problem, bodies, inertia, axis, (axis + 1) % d);
    stiffness.multiply(along, elastic);
    problem.mass.multiply(along, inertial);
    const Vector force = coefficients.mass * inertial + coefficients.stiffness * elastic;
    const Vector nodal = diagonal.cwiseProduct(along);
    for (const std::vector<Index>& body : bodies) {
      const double energy = product_in(body, d, along, force);
      if (energy > 0.0) result = std::max(result, product_in(body, d, along, nodal) / energy);
    }
  }
  return result;
}

std::string seconds_text(double seconds) {
  return seconds < 120.0 ? fmt::format("{:.2g} s", seconds) : fmt::format("{:.2g} min", seconds / 60.0);
}

void compare(const SparseCholesky::Prediction& predicted, double solves, const IterationEstimate& iteration,
             ChosenMethod& chosen) {
  const double factorization = predicted.operations / estimated_operations_per_second;
  const double solve = 2.0 * sizeof(double) * predicted.entries / estimated_bytes_per_second;
  const double iterative_solve = iteration.iterations * iteration.bytes / estimated_bytes_per_second;
  chosen.expected_iterations = iteration.iterations;
  const bool direct = factorization + solves * solve <= solves * iterative_solve;
  chosen.method = direct ? SolverMethod::direct : SolverMethod::iterative;
  chosen.reason = fmt::format(
      "estimate for {:.0f} solves: {} to factorize and {} per solve with the factor, {} per solve by iterations",
      solves, seconds_text(factorization), seconds_text(solve), seconds_text(iterative_solve));
}

}  // namespace

IterationEstimate estimate_iterations(const SemidiscreteProblem& problem, const OperatorCoefficients& coefficients,
                                      double tolerance) {
  const int d = problem.dimension;
  const NodeMatrix* const kept = problem.internal_force->constant_tangent();
  const NodeMatrix tangent = kept != nullptr ? NodeMatrix() : NodeMatrix(problem.internal_force->tangent(), d);
  const NodeMatrix& stiffness = kept != nullptr ? *kept : tangent;
  // Largest eigenvalue of A relative to its diagonal blocks: as for the matrix of a simplex, at most its number of
  // nodes.
  const double largest_eigenvalue = d + 1.0;
  const double condition = std::max(1.0, largest_eigenvalue * softness(problem, coefficients, stiffness));
  const auto nodes = double(problem.nodes.cols());
  const auto blocks = double(stiffness.pattern().column.size());
  IterationEstimate result;
  result.iterations = 0.5 * std::sqrt(condition) * std::log(2.0 / tolerance);
  const double product = blocks * (8.0 * d * d + 4.0);
  // With a mass that couples many more nodes than K (stage_product.hpp) iterations are in double precision.
  if (keeps_mass_apart(problem, stiffness)) {
    result.bytes = product + double(problem.mass.bytes()) + 8.0 * nodes * d * (d + vectors_per_iteration);
  } else {
    result.bytes = blocks * (4.0 * d * d + 4.0) + 4.0 * nodes * d * single_vectors_per_iteration +
                   double_products * product / result.iterations;
  }
  return result;
}

ChosenMethod choose_method(const SparseCholesky::Prediction& predicted, const OperatorCoefficients& coefficients,
                           const StepSolverOptions& options, const std::function<IterationEstimate()>& iterations) {
  ChosenMethod chosen{.method = SolverMethod::direct,
                      .reason = "",
                      .predicted_entries = predicted.entries,
                      .predicted_operations = predicted.operations};
  if (coefficients.dofs == StageDofs::contact) {
    chosen.reason =
        "the operator of the contact nodes alone is small, and has no inertia that would help iterations to converge";
    return chosen;
  }
  if (options.method != SolverMethod::automatic) {
    chosen.method = options.method;
    chosen.reason = "requested by the case";
    return chosen;
  }
  const double limit = options.memory > 0.0 ? options.memory : memory_part * physical_memory();
  const double bytes = sizeof(double) * predicted.entries;
  if (!predicted.possible) {
    chosen.method = SolverMethod::iterative;
    chosen.reason = fmt::format("a factor would have {:.2g} entries, more than CHOLMOD can count", predicted.entries);
  } else if (bytes > limit) {
    chosen.method = SolverMethod::iterative;
    chosen.reason =
        fmt::format("a factor would need {:.3g} GB, but only {:.3g} GB are allowed", 1e-9 * bytes, 1e-9 * limit);
  } else if (predicted.operations <= short_factorization * estimated_operations_per_second) {
    chosen.reason = "a factor is computed within seconds";
  } else if (coefficients.mass == 0.0) {
    chosen.reason = "the operator has no inertia, without which iterations converge badly";
  } else {
    compare(predicted, options.solves > 0 ? double(options.solves) : many_solves, iterations(), chosen);
    if (options.solves == 0) chosen.reason += "; the actual number of solves is unknown";
  }
  return chosen;
}

ChosenMethod choose_method(const SemidiscreteProblem& problem, const SparseCholesky::Prediction& predicted,
                           const OperatorCoefficients& coefficients, const StepSolverOptions& options) {
  return choose_method(predicted, coefficients, options,
                       [&] { return estimate_iterations(problem, coefficients, options.tolerance); });
}

}  // namespace ricochet
