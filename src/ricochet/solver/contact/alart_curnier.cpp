#include "ricochet/solver/contact/alart_curnier.hpp"

#include <algorithm>
#include <cmath>

namespace ricochet {

/// Multiple of W from which a diagonal leaves p = 0 to rounding.
constexpr double rigid = 0x1p60;
/// Number of unknowns up to which LU in double precision is the fastest.
constexpr Index few_unknowns = 64;
/// A new factor is worth unknowns/`iterations_per_factor` iterations with an old one, and no fewer than these.
constexpr Index iterations_per_factor = 30;
constexpr Index fewest_iterations = 6;
/// Ratio of the speeds of a factorization and of a product with a vector, and the overhead per row of a factorization.
constexpr double factor_speed = 12.0;
constexpr double factor_overhead = 60.0;
/// Iterations with the factor of the system itself.
constexpr Index fresh_iterations = 12;

namespace {

/// Returns whether the states are equal, up to the direction of slip.
bool is_alike(const ContactUnknown& one, const ContactUnknown& other) {
  double product = 0.0;
  for (std::size_t k = 0; k < one.test.size(); ++k) product += one.test[k] * other.test[k];
  return one.problem_row == other.problem_row && product > 0.5;
}

}  // namespace

void AlartCurnierStep::add(ContactUnknown unknown, const PaddedVector& trial, const PaddedVector& test, double diagonal,
                           double present) {
  std::ranges::copy(trial, unknown.trial.begin());
  std::ranges::copy(test, unknown.test.begin());
  unknown.diagonal = diagonal;
  present_[Index(unknowns_.size())] = present;
  unknowns_.push_back(unknown);
}

/// Adds the unknowns of a point, according to its state.
void AlartCurnierStep::choose(const ContactSystem& system, const ContactPoint& point, const ContactIterate& from) {
  const PaddedVector r = padded(point, from.reaction);
  const double c = 1.0 / point.diagonal;
  const PaddedVector tau = r - c * padded(point, from.motion);
  if (!(tau[0] > 0.0)) return;
  const ContactUnknown unknown{system.problem_row(point.row), point.row, point.size, {}, {}, 0.0};
  const auto unit = [](Index k) { return PaddedVector(PaddedVector::Unit(k)); };
  if (!point.has_friction()) {
    add(unknown, unit(0), unit(0), 0.0, r[0]);
    return;
  }
  const double limit = point.friction_limit(tau[0]);
  const double length = tau.tail<2>().norm();
  if (length <= limit) {
    for (Index k = 0; k < point.size; ++k) add(unknown, unit(k), unit(k), 0.0, r[k]);
    return;
  }
  PaddedVector direction = tau / length;
  direction[0] = 0.0;
  PaddedVector pressing = unit(0);
  if (point.is_bounded(tau[0])) {
    enter(point, point.bound * direction, fixed_);
    has_fixed_ = true;
  } else {
    pressing += point.coefficient * direction;
  }
  add(unknown, pressing, unit(0), 0.0, r[0]);
  const double diagonal = (length - limit) / (limit * c);
  if (point.size < 3 || !(diagonal * c < rigid)) return;
  const PaddedVector across(0.0, -direction[2], direction[1]);
  add(unknown, across, across, diagonal, across.dot(r));
}

double AlartCurnierStep::factor_work(double unknowns) {
  return unknowns * unknowns * (unknowns / factor_speed + factor_overhead);
}

/// Counts the matrix, a factor in half the memory, and the earlier vectors.
double AlartCurnierStep::iteration_work(double unknowns) { return 1.5 * unknowns * unknowns + 30.0 * unknowns; }

/// A matrix singular to rounding belongs to conditions that depend on one another. With a small multiple of
/// x − x_present added, full steps stay defined, and their limits are the solutions of the problem itself.
void AlartCurnierStep::add_proximal_term() {
  factored_proximal_ = 0.0;
  const double count = double(unknowns_.size());
  if (factor_.smallest_pivot() > 4.0 * count * machine_epsilon) return;
  factored_proximal_ = proximal_size;
  matrix_.diagonal().array() += factored_proximal_;
  factor_.compute(matrix_);
}

void AlartCurnierStep::expand(const Vector& x, Vector& reaction) const {
  for (std::size_t j = 0; j < unknowns_.size(); ++j) {
    const ContactUnknown& unknown = unknowns_[j];
    for (Index k = 0; k < unknown.size; ++k) reaction[unknown.row + k] += x[Index(j)] * unknown.trial[std::size_t(k)];
  }
}

bool AlartCurnierStep::solve_directly() {
  is_iterative_ = false;
  const bool is_new = unknowns_ != factored_;
  if (is_new || !has_charged_factor_) work_ += factor_work(double(unknowns_.size()));
  has_charged_factor_ = true;
  if (is_new) {
    factor_.compute(matrix_);
    add_proximal_term();
    factored_ = unknowns_;
    has_factored_ = true;
  }
  proximal_ = factored_proximal_;
  const auto count = Index(unknowns_.size());
  for (Index i = 0; i < count; ++i) right_[i] += proximal_ * present_[i];
  factor_.solve(right_, solution_);
  if (solution_.allFinite()) return true;
  factored_.clear();
  return false;
}

/// Applies GMRES to the residual of the system and adds the correction to the solution. Returns the reduction reached.
double AlartCurnierStep::correct(const Vector& residual, double reduction, Index limit) {
  const auto multiply = [this](const Vector& x, Vector& y) { multiply_dense(matrix_, x, y); };
  const auto precondition = [this](const Vector& x, Vector& y) { reused_.apply(x, y); };
  const double reached = gmres_.solve(multiply, precondition, residual, reduction, limit, correction_);
  work_ += double(gmres_.iterations()) * iteration_work(double(residual.size()));
  if (correction_.allFinite()) solution_ += correction_;
  return reached;
}

bool AlartCurnierStep::solve_with_reused_factor(const ContactSystem& system, double reduction) {
  const auto count = Index(unknowns_.size());
  is_iterative_ = true;
  solution_ = present_.head(count);
  const auto find_residual = [&] {
    multiply_dense(matrix_, solution_, residual_);
    residual_ = right_ - residual_;
    return residual_.norm();
  };
  const double start = find_residual();
  if (!(start > 0.0)) return start == 0.0;
  if (!reused_.empty() && reused_.map_rows(system, unknowns_)) {
    const Index limit = std::max(fewest_iterations, count / iterations_per_factor);
    if (correct(residual_, reduction, limit) <= reduction) return true;
  }
  work_ += factor_work(double(count));
  if (!reused_.compute(matrix_, unknowns_)) return false;
  has_factored_ = true;
  if (!reused_.map_rows(system, unknowns_)) return false;
  const double restarted = find_residual();
  if (!std::isfinite(restarted)) {
    solution_ = present_.head(count);
    find_residual();
  }
  const double remaining_reduction = std::min(1.0, reduction * start / residual_.norm());
  if (correct(residual_, remaining_reduction, fresh_iterations) <= std::max(remaining_reduction, 1e-4)) return true;
  reused_.reset();
  return false;
}

bool AlartCurnierStep::step(const ContactSystem& system, const ContactIterate& from, Vector& reaction,
                            double reduction) {
  unknowns_.clear();
  present_.resize(system.rows());
  fixed_.setZero(system.rows());
  has_fixed_ = false;
  for (const ContactPoint& point : system.points()) choose(system, point, from);
  has_settled_ = std::equal(unknowns_.begin(), unknowns_.end(), last_unknowns_.begin(), last_unknowns_.end(), is_alike);
  last_unknowns_ = unknowns_;
  has_factored_ = false;
  reaction = fixed_;
  if (unknowns_.empty()) return true;
  if (has_fixed_) {
    system.multiply(fixed_, fixed_motion_);
    fixed_motion_ += system.offset();
  } else {
    fixed_motion_ = system.offset();
  }
  const auto count = Index(unknowns_.size());
  right_.resize(count);
  for (Index i = 0; i < count; ++i) right_[i] = -test_motion(unknowns_[std::size_t(i)], fixed_motion_.data());
  const bool direct = count <= few_unknowns;
  work_ += 3.0 * double(count) * double(system.rows());
  if (!direct || unknowns_ != factored_) assemble_contact_matrix(system, unknowns_, column_, matrix_);
  proximal_ = 0.0;
  const bool solved = (!direct && solve_with_reused_factor(system, reduction)) || solve_directly();
  if (solved) expand(solution_, reaction);
  return solved;
}

bool AlartCurnierStep::refine(const ContactIterate& full, Vector& reaction) {
  const auto count = Index(unknowns_.size());
  if (proximal_ > 0.0 || count == 0) return false;
  bool rounding_only = true;
  residual_.resize(count);
  for (Index i = 0; i < count; ++i) {
    const ContactUnknown& unknown = unknowns_[std::size_t(i)];
    const double diagonal_term = unknown.diagonal * solution_[i];
    residual_[i] = -(test_motion(unknown, full.motion.data()) + diagonal_term);
    double size = std::abs(diagonal_term);
    for (Index k = 0; k < unknown.size; ++k) size += full.size[unknown.row + k];
    rounding_only = rounding_only && std::abs(residual_[i]) <= 4.0 * machine_epsilon * size;
  }
  if (rounding_only) return false;
  if (is_iterative_) {
    correct(residual_, 1e-4, fewest_iterations);
  } else {
    factor_.solve(residual_, correction_);
  }
  if (!correction_.allFinite()) return false;
  expand(correction_, reaction);
  return true;
}

}  // namespace ricochet
