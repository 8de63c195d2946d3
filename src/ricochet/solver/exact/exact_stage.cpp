#include "ricochet/solver/exact/exact_stage.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "ricochet/base/error.hpp"
#include "ricochet/base/log.hpp"
#include "ricochet/linear_algebra/sparse_matrix.hpp"

namespace ricochet {

namespace {

/// c in units of the largest stiffness of a row: it must exceed a negative one.
constexpr double stiffening = 10.0;

}  // namespace

Index ExactStage::rows_of(Index point) const { return problem_.contact.has_friction(point) ? problem_.dimension : 1; }

/// Product of a row of Y or Y_T with unknowns.
double ExactStage::along(const ExactTangent& tangent, const Row& row, const auto& unknowns) const {
  const SparseRowMatrix& motion = row.is_tangent ? tangent.tangential_motion : tangent.normal_motion;
  double sum = 0.0;
  for (SparseRowMatrix::InnerIterator entry(motion, row.at); entry; ++entry)
    sum += entry.value() * unknowns[entry.col()];
  return sum;
}

void ExactStage::factorize(const ExactTangent& tangent) {
  const double operations = factor_.analyse(tangent.matrix);
  if (operations > most_operations) {
    throw Error(ErrorKind::not_converged,
                fmt::format("the exact tangent of the step has {} unknowns, and its factorization would take {:.2g} "
                            "operations",
                            tangent.matrix.rows(), operations));
  }
  const auto refuse = [] {
    throw Error(ErrorKind::not_converged, "the exact tangent of the step is singular: nothing resists some motion");
  };
  if (!factor_.factorize()) refuse();
  factor_.solve(tangent.right_hand_side, free_);
  if (!free_.allFinite()) refuse();
}

void ExactStage::add_points(const ExactTangent& tangent, const std::vector<Index>& points) {
  const Index tangents = problem_.dimension - 1;
  for (const Index point : points) {
    points_.push_back(point);
    is_point_[std::size_t(point)] = 1;
    for (Index k = 0; k < rows_of(point); ++k) {
      const Row row{k == 0 ? point : point * tangents + k - 1, k > 0};
      right_.setZero(tangent.matrix.rows());
      const SparseRowMatrix& force = row.is_tangent ? tangent.tangential_force : tangent.normal_force;
      for (SparseRowMatrix::InnerIterator entry(force, row.at); entry; ++entry) right_[entry.col()] = entry.value();
      rows_.push_back(row);
      factor_.solve(right_, columns_.emplace_back());
    }
    contact_.row_offset.push_back(Index(rows_.size()));
  }
}

/// Points that are no candidates and would penetrate.
std::vector<Index> ExactStage::penetrating(const ExactTangent& tangent, const std::vector<char>& eligible,
                                           const Vector& unknowns) {
  gap_ = tangent.gap;
  gap_.noalias() += tangent.normal_motion * unknowns;
  std::vector<Index> result;
  for (Index i = 0; i < gap_.size(); ++i) {
    const auto at = std::size_t(i);
    if (eligible[at] != 0 && is_point_[at] == 0 && gap_[i] < -tangent.gap_rounding[i]) result.push_back(i);
  }
  return result;
}

/// Sets c by the diagonal of W.
void ExactStage::find_stiffness(const Matrix& w) {
  stiffness_ = 0.0;
  for (Index i = 0; i < w.rows(); ++i)
    if (w(i, i) != 0.0) stiffness_ = std::max(stiffness_, stiffening / std::abs(w(i, i)));
}

void ExactStage::make_problem(const ExactTangent& tangent, Matrix& w) {
  const auto rows = Index(rows_.size()), count = Index(points_.size());
  const Index tangents = problem_.dimension - 1;
  w.resize(rows, rows);
  contact_.offset.resize(rows);
  contact_.offset_rounding.resize(rows);
  for (Index i = 0; i < rows; ++i) {
    const Row& row = rows_[std::size_t(i)];
    contact_.offset[i] = (row.is_tangent ? tangent.slip : tangent.gap)[row.at] + along(tangent, row, free_);
    contact_.offset_rounding[i] =
        row.is_tangent ? tangent.slip_rounding[row.at / tangents] : tangent.gap_rounding[row.at];
    for (Index j = 0; j < rows; ++j) w(i, j) = along(tangent, row, columns_[std::size_t(j)]);
  }
  contact_.friction_coefficient.resize(count);
  contact_.friction_bound.resize(count);
  for (Index i = 0; i < count; ++i) {
    contact_.friction_coefficient[i] = problem_.contact.friction_coefficient[points_[std::size_t(i)]];
    contact_.friction_bound[i] = problem_.contact.friction_bound[points_[std::size_t(i)]];
  }
  contact_.eligible.assign(points_.size(), 1);
  contact_.point_numbers = points_;
  contact_.is_symmetric = false;
  contact_.contact_operator = make_dense_operator(w);
}

/// Starts from the reactions of the last iteration.
void ExactStage::set_warm_start(const StageSolution& last) {
  right_.setZero(Index(rows_.size()));
  for (std::size_t i = 0; i < rows_.size(); ++i) {
    const Row& row = rows_[i];
    if (!row.is_tangent && last.normal_reaction.size() > 0) right_[Index(i)] = last.normal_reaction[row.at];
    if (row.is_tangent && last.tangential_reaction.size() > 0) right_[Index(i)] = -last.tangential_reaction[row.at];
  }
  solver_->set_warm_start(right_);
}

/// Returns false if the contact problem was not solved.
bool ExactStage::try_solve(const ExactTangent& tangent, const std::vector<char>& eligible, const StageSolution& last,
                           Vector& unknowns) {
  factorize(tangent);
  const std::vector<Index> candidates = points_;
  points_.clear();
  rows_.clear();
  columns_.clear();
  contact_.row_offset.assign(1, 0);
  is_point_.assign(std::size_t(problem_.contact.size()), 0);
  add_points(tangent, candidates);
  unknowns = free_;
  for (std::vector<Index> more; true; add_points(tangent, more)) {
    if (!points_.empty()) {
      Matrix w;
      make_problem(tangent, w);
      if (solver_ == nullptr) solver_ = make_contact_solver();
      solver_->analyse(contact_);
      set_warm_start(last);
      solver_->solve(contact_, {}, contact_solution_);
      if (!contact_solution_.solved()) {
        if (!tangent.is_stiffened) find_stiffness(w);
        return false;
      }
      unknowns = free_;
      for (std::size_t j = 0; j < columns_.size(); ++j)
        if (const double r = contact_solution_.reaction[Index(j)]; r != 0.0) unknowns += r * columns_[j];
    }
    more = penetrating(tangent, eligible, unknowns);
    if (more.empty()) return true;
  }
}

void ExactStage::add_stiffness(const ExactTangent& tangent, const Vector& normal_reaction,
                               ExactTangent& augmented) const {
  augmented = tangent;
  const Index unknowns = tangent.matrix.rows();
  std::vector<Eigen::Triplet<double>> entries;
  for (Index i = 0; i < normal_reaction.size(); ++i) {
    if (!(normal_reaction[i] > 0.0)) continue;
    for (SparseRowMatrix::InnerIterator force(tangent.normal_force, i); force; ++force) {
      const double by = stiffness_ * force.value();
      augmented.right_hand_side[force.col()] -= by * tangent.gap[i];
      for (SparseRowMatrix::InnerIterator motion(tangent.normal_motion, i); motion; ++motion)
        entries.emplace_back(int(force.col()), int(motion.col()), by * motion.value());
    }
  }
  SparseMatrix stiffness(unknowns, unknowns);
  stiffness.setFromTriplets(entries.begin(), entries.end());
  augmented.matrix = add_sparse(tangent.matrix, stiffness);
}

void ExactStage::throw_not_solved() const {
  throw Error(ErrorKind::not_converged,
              fmt::format("the contact problem of {} points with the exact tangent of the step was not solved: {}",
                          points_.size(), contact_solution_.reason));
}

void ExactStage::solve(ExactTangent& tangent, const std::vector<char>& eligible, StageSolution& solution,
                       Vector& unknowns) {
  const Vector pressed = solution.normal_reaction;
  points_.clear();
  for (Index i = 0; i < pressed.size(); ++i)
    if (pressed[i] > 0.0 && eligible[std::size_t(i)] != 0) points_.push_back(i);
  const bool any_pressed = !points_.empty();
  const bool is_stiffened = tangent.is_stiffened && any_pressed;
  if (is_stiffened || !try_solve(tangent, eligible, solution, unknowns)) {
    if (!any_pressed) throw_not_solved();
    if (!is_stiffened) log::debug(fmt::format("exact tangent: {}; adding contact stiffness", contact_solution_.reason));
    tangent.is_stiffened = true;
    ExactTangent augmented;
    add_stiffness(tangent, pressed, augmented);
    if (!try_solve(augmented, eligible, solution, unknowns)) throw_not_solved();
  }
  write_solution(solution);
}

void ExactStage::write_solution(StageSolution& solution) const {
  const Index points = problem_.contact.size(), tangents = problem_.dimension - 1;
  const int before = solution.iterations;
  solution.open_all(points, problem_.contact.has_friction() ? tangents : 0);
  solution.iterations = before + (points_.empty() ? 0 : contact_solution_.iterations);
  for (std::size_t i = 0; i < points_.size(); ++i) {
    const Index point = points_[i], row = contact_.row_offset[i];
    solution.contact_status[std::size_t(point)] = contact_solution_.status[i];
    solution.normal_reaction[point] = contact_solution_.reaction[row];
    for (Index k = 1; row + k < contact_.row_offset[i + 1]; ++k)
      solution.tangential_reaction[point * tangents + k - 1] = -contact_solution_.reaction[row + k];
  }
}

}  // namespace ricochet
