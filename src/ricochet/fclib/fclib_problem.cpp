#include <fmt/format.h>

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "ricochet/base/error.hpp"
#include "ricochet/fclib/fclib_file.hpp"

namespace ricochet {

namespace {

/// Prefix of put_solution's line in math_info, by which an earlier one is replaced.
constexpr const char* verdict = "Ricochet: ";

/// Powers of two d for which d_i |R_ii| d_i is near one (without a diagonal: the largest entry of the row).
Vector equilibration(const Matrix& r) {
  Vector result(r.rows());
  for (Index i = 0; i < r.rows(); ++i) {
    const double size = r(i, i) != 0.0 ? std::abs(r(i, i)) : r.row(i).cwiseAbs().maxCoeff();
    result[i] = size > 0.0 ? std::exp2(-std::floor(0.5 * std::log2(size))) : 1.0;
  }
  return result;
}

/// Computes R⁻¹ [Vᵀ, s].
Matrix solve_constraints(const FclibProblem& problem) {
  const Matrix r(problem.r);
  const Vector scale = equilibration(r);
  const Eigen::FullPivLU<Matrix> factor(scale.asDiagonal() * r * scale.asDiagonal());
  if (!factor.isInvertible()) {
    // The last pivot in the order of full pivoting is the constraint that depends on the others.
    const Index dependent = factor.permutationQ().indices()[factor.rank()];
    throw Error(
        ErrorKind::invalid_input,
        fmt::format(
            "{}: /fclib_local/R: is singular, of rank {} with {} constraints, so that the multipliers of the equality "
            "constraints are not unique; remove constraints that others imply, for example number {} (counted from 0)",
            problem.path, factor.rank(), r.rows(), dependent));
  }
  Matrix right(r.rows(), problem.v.rows() + 1);
  right.leftCols(problem.v.rows()) = Matrix(problem.v).transpose();
  right.col(problem.v.rows()) = problem.s;
  return scale.asDiagonal() * factor.solve(Matrix(scale.asDiagonal() * right));
}

std::shared_ptr<const ContactOperator> make_operator(SparseMatrix w) {
  const bool dense = 3.0 * double(w.nonZeros()) > double(w.rows()) * double(w.rows());
  return dense ? make_dense_operator(Matrix(w)) : make_sparse_operator(std::move(w));
}

/// Rows of a problem's eligible points, and their new rows with `dimension` rows each.
struct Selection {
  std::vector<Index> points;   ///< their numbers in the problem
  std::vector<Index> new_row;  ///< per row of the problem: its row in the file, or −1
  std::vector<Index> old_row;  ///< per row of the file: its row in the problem, or −1
};

Selection select_eligible(const ContactProblem& problem, Index dimension) {
  Selection result;
  result.new_row.assign(std::size_t(problem.rows()), -1);
  for (Index i = 0; i < problem.points(); ++i) {
    if (!problem.is_eligible(i)) continue;
    const Index first = problem.row_offset[std::size_t(i)];
    const Index size = problem.row_offset[std::size_t(i + 1)] - first;
    if (problem.bound(i) > 0.0) {
      throw Error(ErrorKind::invalid_input, fmt::format("point {} has a friction bound ({:g}): FCLib files support "
                                                        "Coulomb's law only, so this problem cannot be written to one",
                                                        i, problem.bound(i)));
    }
    if (size != 1 && size != dimension) {
      throw Error(
          ErrorKind::invalid_input,
          fmt::format("point {} has {} rows, which does not match a problem in {} dimensions", i, size, dimension));
    }
    result.points.push_back(i);
    for (Index k = 0; k < dimension; ++k) {
      if (k < size) result.new_row[std::size_t(first + k)] = Index(result.old_row.size());
      result.old_row.push_back(k < size ? first + k : -1);
    }
  }
  return result;
}

/// Columns of W by products with unit vectors, if W is known by nothing else.
Matrix columns_of(const ContactOperator& w) {
  Matrix result(w.rows(), w.rows());
  Vector unit = Vector::Zero(w.rows()), column;
  for (Index j = 0; j < w.rows(); ++j) {
    unit[j] = 1.0;
    w.multiply(unit, column);
    result.col(j) = column;
    unit[j] = 0.0;
  }
  return 0.5 * (result + result.transpose());
}

SparseMatrix select_matrix(const ContactOperator& w, const Selection& selection, Index dimension) {
  const Matrix known = w.dense() == nullptr && w.sparse() == nullptr ? columns_of(w) : Matrix();
  const Matrix* const dense = w.dense() != nullptr ? w.dense() : &known;
  const auto size = Index(selection.old_row.size());
  SparseMatrix result(size, size);
  result.reserve(w.sparse() != nullptr ? w.sparse()->nonZeros() + size : size * size);
  for (Index column = 0; column < size; ++column) {
    result.startVec(column);
    const Index old_column = selection.old_row[std::size_t(column)];
    if (old_column < 0) {  // a tangent that the problem does not have
      const Index normal = selection.old_row[std::size_t(column - column % dimension)];
      result.insertBack(column, column) = w.block(normal, 1)(0, 0);
    } else if (w.sparse() != nullptr) {
      for (SparseMatrix::InnerIterator entry(*w.sparse(), old_column); entry; ++entry) {
        const Index row = selection.new_row[std::size_t(entry.row())];
        if (row >= 0) result.insertBack(row, column) = entry.value();
      }
    } else {
      for (Index row = 0; row < size; ++row) {
        const Index old = selection.old_row[std::size_t(row)];
        if (old >= 0 && (*dense)(old, old_column) != 0.0) result.insertBack(row, column) = (*dense)(old, old_column);
      }
    }
  }
  result.finalize();
  return result;
}

Vector select_rows(const Vector& values, const Selection& selection) {
  Vector result = Vector::Zero(Index(selection.old_row.size()));
  for (Index row = 0; row < result.size(); ++row) {
    const Index old = selection.old_row[std::size_t(row)];
    if (old >= 0) result[row] = values[old];
  }
  return result;
}

/// Removes the lines that put_solution wrote.
std::string without_verdict(const std::string& text) {
  std::string result;
  for (std::size_t begin = 0; begin < text.size();) {
    const std::size_t end = std::min(text.find('\n', begin), text.size());
    const std::string line = text.substr(begin, end - begin);
    if (!line.starts_with(verdict)) result += line + "\n";
    begin = end + 1;
  }
  return result;
}

}  // namespace

FclibReduction reduce(const FclibProblem& problem) {
  FclibReduction result;
  SparseMatrix w = problem.w;
  Vector q = problem.q;
  result.multiplier_matrix.resize(problem.constraint_count(), w.rows());
  result.multiplier_offset.resize(problem.constraint_count());
  if (problem.constraint_count() > 0) {
    const Matrix solved = solve_constraints(problem);
    result.multiplier_matrix = -solved.leftCols(w.rows());
    result.multiplier_offset = -solved.col(w.rows());
    const Matrix whole = Matrix(w) + problem.v * result.multiplier_matrix;
    w = Matrix(0.5 * (whole + whole.transpose())).sparseView(0.0, 0.0);
    q += problem.v * result.multiplier_offset;
    if (!whole.allFinite() || !q.allFinite())
      throw Error(ErrorKind::invalid_input,
                  fmt::format("{}: /fclib_local/R: eliminating the equality constraints overflows", problem.path));
  }
  result.problem = ContactProblem(problem.dimension, make_operator(std::move(w)), std::move(q), problem.mu);
  result.problem.offset_rounding = problem.q_rounding;
  return result;
}

FclibSolution FclibReduction::solution(const ContactSolution& found) const {
  return {found.motion, found.reaction, multiplier_matrix * found.reaction + multiplier_offset};
}

void put_solution(FclibProblem& problem, FclibSolution found, const ContactSolution& how) {
  const std::string figures = fmt::format(
      "residual {:.3g}, of which {:.3g} may be rounding (largest natural map of a point relative to that of r = 0)",
      how.residual, how.rounding_floor);
  problem.math_info = without_verdict(problem.math_info);
  problem.solution.reset();
  problem.guesses.clear();
  if (how.solved()) {
    problem.math_info += fmt::format("{}solved; {}", verdict, figures);
    problem.solution = std::move(found);
  } else {
    problem.math_info += fmt::format("{}NOT SOLVED ({}); the best found is guess 1: {}", verdict, how.reason, figures);
    problem.guesses.push_back(std::move(found));
  }
}

FclibProblem make_fclib(const ContactProblem& problem, Index dimension, const ContactSolution* solution) {
  problem.validate();
  if (dimension != 2 && dimension != 3) {
    throw Error(ErrorKind::invalid_input,
                fmt::format("contact problem: the dimension is {}; FCLib files support 2 and 3", dimension));
  }
  const Selection selection = select_eligible(problem, dimension);
  FclibProblem result;
  result.dimension = dimension;
  for (const Index point : selection.points) result.points.push_back(problem.number_of(point));
  result.w = select_matrix(*problem.contact_operator, selection, dimension);
  const Index rows = result.w.rows();
  result.v.resize(rows, 0);
  result.q = select_rows(problem.offset, selection);
  if (problem.offset_rounding.size() > 0) result.q_rounding = select_rows(problem.offset_rounding, selection);
  result.mu.setZero(rows / dimension);
  Index padded = 0;
  for (Index i = 0; i < result.mu.size(); ++i) {
    if (selection.old_row[std::size_t(i * dimension + 1)] < 0)
      ++padded;
    else
      result.mu[i] = problem.friction_coefficient[selection.points[std::size_t(i)]];
  }
  if (padded > 0) {
    result.description = fmt::format(
        "{} of {} points have no friction and no tangents in the original problem: their tangents here have W_TT = "
        "W_NN, no coupling, q_T = 0 and mu = 0, so that r_T = u_T = 0 there.",
        padded, result.mu.size());
  }
  if (solution != nullptr) {
    put_solution(result,
                 {select_rows(solution->motion, selection), select_rows(solution->reaction, selection), Vector()},
                 *solution);
  }
  return result;
}

}  // namespace ricochet
