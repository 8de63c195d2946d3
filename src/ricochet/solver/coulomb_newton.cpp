#include "ricochet/solver/coulomb_newton.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "ricochet/solver/coulomb_solver.hpp"

namespace ricochet {

namespace {
constexpr double epsilon = std::numeric_limits<double>::epsilon();
/// Relative to W's diagonal; small enough to leave a few steps, large enough to hide what is rounding in W.
constexpr double proximal_size = 0x1p-30;
/// A diagonal of this many W leaves p = 0 to rounding.
constexpr double rigid = 0x1p60;
}  // namespace

void CoulombNewton::add(const CoulombPoint& point, const PointVector& trial, const PointVector& test, double diagonal,
                        double present) {
  Unknown unknown;
  unknown.first = point.first;
  unknown.size = point.size;
  for (Index k = 0; k < point.size; ++k) {
    unknown.trial[static_cast<std::size_t>(k)] = trial[k];
    unknown.test[static_cast<std::size_t>(k)] = test[k];
  }
  unknown.diagonal = diagonal;
  unknown.weight = point.weight;
  present_[static_cast<Index>(unknowns_.size())] = present;
  unknowns_.push_back(unknown);
}

/// The unknowns of a point, by its state.
void CoulombNewton::choose(const CoulombPoint& point, const CoulombIterate& from) {
  const PointVector rho = from.reaction.segment(point.first, point.size);
  const PointVector tau = rho - point.step * from.motion.segment(point.first, point.size);
  if (!(tau[0] > 0.0)) return;
  const auto unit = [&](Index k) { return PointVector(PointVector::Unit(point.size, k)); };
  if (!point.has_friction()) {
    add(point, unit(0), unit(0), 0.0, rho[0]);
    return;
  }
  const double limit = point.friction_limit(tau[0]);
  const double length = tau.tail(point.size - 1).norm();
  if (length <= limit) {
    for (Index k = 0; k < point.size; ++k) add(point, unit(k), unit(k), 0.0, rho[k]);
    return;
  }
  PointVector direction = tau / length;
  direction[0] = 0.0;
  PointVector pressing = unit(0);
  if (point.is_bounded(tau[0])) {
    fixed_.segment(point.first, point.size) = point.bound * direction;
    has_fixed_ = true;
  } else {
    pressing += point.coefficient * direction;
  }
  add(point, pressing, unit(0), 0.0, rho[0]);
  const double diagonal = (length - limit) / (limit * point.step);
  if (point.size < 3 || !(diagonal * point.step < rigid)) return;
  PointVector across(3);
  across << 0.0, -direction[2], direction[1];
  add(point, across, across, diagonal, across.dot(rho));
}

double CoulombNewton::test(const Unknown& unknown, const Vector& motion) const {
  double sum = 0.0;
  for (Index k = 0; k < unknown.size; ++k) sum += unknown.test[static_cast<std::size_t>(k)] * motion[unknown.first + k];
  return sum;
}

/// Rows and columns are scaled by powers of two to a diagonal near one, before any pivot is chosen.
void CoulombNewton::assemble(const Matrix& w) {
  const auto count = static_cast<Index>(unknowns_.size());
  matrix_.resize(count, count);
  double largest = 0.0;
  for (const Unknown& unknown : unknowns_)
    largest = std::max(largest, unknown.weight * unknown.weight * w(unknown.first, unknown.first));
  operator_scale_ = std::isnormal(largest) ? std::ldexp(1.0, -std::ilogb(largest)) : 1.0;
  for (Index j = 0; j < count; ++j) {
    const Unknown& column = unknowns_[static_cast<std::size_t>(j)];
    const double scale = column.weight * operator_scale_;
    column_.setZero(w.rows());
    for (Index k = 0; k < column.size; ++k) {
      const double factor = column.trial[static_cast<std::size_t>(k)];
      if (factor != 0.0) column_ += (scale * factor) * w.col(column.first + k);
    }
    for (Index i = 0; i < count; ++i) {
      const Unknown& row = unknowns_[static_cast<std::size_t>(i)];
      matrix_(i, j) = row.weight * test(row, column_);
    }
    matrix_(j, j) += scale * column.weight * column.diagonal;
  }
}

/// A matrix singular to rounding belongs to conditions that depend on one another. With a small multiple of x −
/// x_present added, whole steps stay defined and their limits are the solutions of the problem itself.
void CoulombNewton::add_proximal_term() {
  proximal_ = 0.0;
  const double count = static_cast<double>(unknowns_.size());
  if (factor_.smallest_pivot() > 4.0 * count * epsilon) return;
  proximal_ = proximal_size;
  matrix_.diagonal().array() += proximal_;
  factor_.compute(matrix_);
}

void CoulombNewton::expand(Vector& reaction) const {
  for (std::size_t j = 0; j < unknowns_.size(); ++j) {
    const Unknown& unknown = unknowns_[j];
    const double x = unknown.weight * solution_[static_cast<Index>(j)];
    for (Index k = 0; k < unknown.size; ++k)
      reaction[unknown.first + k] += x * unknown.trial[static_cast<std::size_t>(k)];
  }
}

bool CoulombNewton::step(const CoulombProblem& problem, const std::vector<CoulombPoint>& points,
                         const CoulombIterate& from, Vector& reaction) {
  const Matrix& w = *problem.operator_matrix;
  unknowns_.clear();
  present_.resize(w.rows());
  fixed_.setZero(w.rows());
  has_fixed_ = false;
  for (const CoulombPoint& point : points) choose(point, from);
  has_factored_ = false;
  reaction = fixed_;
  if (unknowns_.empty()) return true;
  if (unknowns_ != factored_) {
    assemble(w);
    factor_.compute(matrix_);
    add_proximal_term();
    factored_ = unknowns_;
    has_factored_ = true;
  }
  fixed_motion_ = *problem.offset;
  if (has_fixed_) {
    for (Index j = 0; j < w.cols(); ++j) {
      if (fixed_[j] != 0.0) fixed_motion_ += fixed_[j] * w.col(j);
    }
  }
  const auto count = static_cast<Index>(unknowns_.size());
  right_.resize(count);
  for (Index i = 0; i < count; ++i) {
    const Unknown& unknown = unknowns_[static_cast<std::size_t>(i)];
    right_[i] = -operator_scale_ * unknown.weight * test(unknown, fixed_motion_);
    right_[i] += proximal_ * (present_[i] / unknown.weight);
  }
  factor_.solve(right_, solution_);
  if (!solution_.allFinite()) {
    factored_.clear();
    return false;
  }
  expand(reaction);
  return true;
}

bool CoulombNewton::refine(const CoulombIterate& full, Vector& reaction) {
  const auto count = static_cast<Index>(unknowns_.size());
  if (proximal_ > 0.0 || count == 0) return false;
  bool rounding_only = true;
  for (Index i = 0; i < count; ++i) {
    const Unknown& unknown = unknowns_[static_cast<std::size_t>(i)];
    const double x = unknown.weight * solution_[i];
    const double left = test(unknown, full.motion) + unknown.diagonal * x;
    double size = std::abs(unknown.diagonal * x);
    for (Index k = 0; k < unknown.size; ++k) size += full.size[unknown.first + k];
    rounding_only = rounding_only && std::abs(left) <= 4.0 * epsilon * size;
    right_[i] = -operator_scale_ * unknown.weight * left;
  }
  if (rounding_only) return false;
  factor_.solve(right_, solution_);
  if (!solution_.allFinite()) return false;
  expand(reaction);
  return true;
}

}  // namespace ricochet
