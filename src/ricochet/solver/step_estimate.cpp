#include "ricochet/solver/step_estimate.hpp"

#include <algorithm>
#include <map>

#include "ricochet/base/timer.hpp"
#include "ricochet/linear_algebra/sparse_matrix.hpp"
#include "ricochet/solver/choose_method.hpp"
#include "ricochet/solver/delassus/direct_stage.hpp"
#include "ricochet/solver/stage/stage_operator.hpp"

namespace ricochet {

namespace {

constexpr Index sampled_points = 100;

/// Elimination tree of a matrix in the order of its factor: per row, the root and the length of the path to it, which
/// is the number of entries of a column of L⁻¹. Liu's algorithm with compressed paths.
struct PathsToRoots {
  std::vector<int> length, root;
};

PathsToRoots find_paths(const SparseMatrix& matrix, const SparseCholesky& factor) {
  const auto count = std::size_t(matrix.cols());
  std::vector<int> parent(count, -1), ancestor(count, -1);
  PathsToRoots paths{std::vector<int>(count, 1), std::vector<int>(count)};
  for (std::size_t column = 0; column < count; ++column) {
    for (SparseMatrix::InnerIterator entry(matrix, factor.permutation()[column]); entry; ++entry) {
      auto row = int(factor.factor_index(entry.row()));
      while (row >= 0 && row < int(column)) {
        const int next = ancestor[std::size_t(row)];
        ancestor[std::size_t(row)] = int(column);
        if (next < 0) parent[std::size_t(row)] = int(column);
        row = next;
      }
    }
  }
  for (std::size_t column = count; column-- > 0;) {
    const auto above = std::size_t(std::max(parent[column], 0));
    if (parent[column] >= 0) paths.length[column] = paths.length[above] + 1;
    paths.root[column] = parent[column] >= 0 ? paths.root[above] : int(column);
  }
  return paths;
}

/// Mean over some contact points, evenly spread over their numbers, of rows × the longest path of their unknowns in
/// each tree: there is one tree per body.
double column_entries(const SemidiscreteProblem& problem, const AnalysedOperator& analysed,
                      const std::vector<int>& number, const SparseMatrix& matrix) {
  const Index points = problem.contact.size();
  if (points == 0 || analysed.dofs.empty()) return 0.0;
  const PathsToRoots paths = find_paths(matrix, analysed.factor);
  const double rows = problem.contact.has_friction() ? double(problem.dimension) : 1.0;
  const Index samples = std::min(points, sampled_points);
  double sum = 0.0;
  for (Index k = 0; k < samples; ++k) {
    std::map<int, int> longest;
    problem.contact.rows->visit_normal(k * points / samples, [&](Index dof, double) {
      const int unknown = number[std::size_t(dof)];
      if (unknown < 0) return;
      const auto column = std::size_t(analysed.factor.factor_index(unknown));
      int& of_tree = longest[paths.root[column]];
      of_tree = std::max(of_tree, paths.length[column]);
    });
    for (const auto& [root, length] : longest) sum += rows * length;
  }
  return sum / double(samples);
}

StageEstimate estimate(const SemidiscreteProblem& problem, const OperatorCoefficients& coefficients,
                       const StepSolverOptions& options) {
  StageEstimate result;
  const AnalysedOperator analysed = analyse_operator(problem, coefficients);
  const SparseCholesky::Prediction predicted = analysed.factor.predicted();
  result.chosen = choose_method(problem, predicted, coefficients, options);
  result.unknowns = Index(analysed.dofs.size());
  if (result.chosen.method == SolverMethod::iterative) {
    const IterationEstimate iteration = estimate_iterations(problem, coefficients, options.tolerance);
    result.iterations = iteration.iterations;
    result.step_seconds = iteration.iterations * iteration.bytes / estimated_bytes_per_second;
    return result;
  }
  result.factor_bytes = sizeof(double) * predicted.entries;
  const std::vector<int> number = number_dofs(problem, analysed.dofs);
  const SparseMatrix matrix =
      extract(combine_operator(problem, coefficients), number, result.unknowns, number, result.unknowns);
  // Besides the factor, a triangle of the operator in its order exists during factorization, and little else.
  constexpr double bytes_per_entry = sizeof(double) + sizeof(int);
  result.peak_bytes = result.factor_bytes + 0.5 * bytes_per_entry * double(matrix.nonZeros() + result.unknowns);
  result.factorization_seconds = predicted.operations / estimated_operations_per_second;
  result.step_seconds = 2.0 * result.factor_bytes / estimated_bytes_per_second;
  result.bytes_per_point = sizeof(double) * column_entries(problem, analysed, number, matrix);
  return result;
}

}  // namespace

std::vector<StageEstimate> estimate_step_solver(const SemidiscreteProblem& problem,
                                                const std::vector<OperatorCoefficients>& operators,
                                                const StepSolverOptions& options) {
  std::vector<StageEstimate> result;
  for (const OperatorCoefficients& coefficients : operators) result.push_back(estimate(problem, coefficients, options));
  return result;
}

/// Counts K's triangle by blocks of nodes with an index each, and the vectors that a step reads and writes besides
/// (docs/theory.md counts them for the semi-explicit scheme).
double estimate_products(const SemidiscreteProblem& problem) {
  constexpr double vectors = 180.0;  // bytes per dof
  const double d = problem.dimension;
  const double entries = double(problem.internal_force->tangent().nonZeros());
  const double bytes = 0.5 * entries * (8.0 + 4.0 / (d * d)) + vectors * double(problem.dof_count());
  return bytes / estimated_bytes_per_second;
}

}  // namespace ricochet
