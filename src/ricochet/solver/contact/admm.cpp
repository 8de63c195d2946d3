#include <algorithm>
#include <cmath>
#include <optional>
#include <vector>

#include "ricochet/base/dense_decompositions.hpp"
#include "ricochet/linear_algebra/dense_factor.hpp"
#include "ricochet/linear_algebra/sparse_cholesky.hpp"
#include "ricochet/linear_algebra/sparse_matrix.hpp"
#include "ricochet/solver/contact/cone_formulation.hpp"
#include "ricochet/solver/contact/iteration_record.hpp"
#include "ricochet/solver/contact/iterative_contact_solver.hpp"

namespace ricochet {

namespace {

constexpr int admm_iterations = 20000;
constexpr double relaxation = 1.6;
/// Iterations between two evaluations of the measure, unless the residual of the iteration triggers one.
constexpr int verdict_interval = 16;
/// Initial number of iterations between adaptations of the penalty, its growth factor, and the least factor by which
/// the penalty is changed.
constexpr int first_interval = 12;
constexpr double interval_growth = 1.3;
constexpr double least_change = 2.5;
/// Lanczos steps of the initial estimate of W's extreme eigenvalues; the smallest is assumed to be at least this
/// fraction of the largest.
constexpr int lanczos_steps = 16;
constexpr double smallest_part = 1e-8;

/// Cholesky factor of W + ρ D, D = diag(w_i).
class PenaltyFactor {
 public:
  bool compute(const ContactSystem& system, double penalty);
  void solve(const Vector& right, Vector& x);

 private:
  Matrix matrix_;
  DenseCholesky dense_;
  std::vector<Index> rows_;  ///< rows of points, for a sparse W
  std::optional<SparseCholesky> sparse_;
  Vector right_, solution_;
};

bool PenaltyFactor::compute(const ContactSystem& system, double penalty) {
  if (system.dense() != nullptr) {
    sparse_.reset();
    matrix_ = *system.dense();
    for (const ContactPoint& point : system.points())
      matrix_.diagonal().segment(point.row, point.size).array() += penalty * point.diagonal;
    return dense_.compute(matrix_);
  }
  rows_.clear();
  std::vector<int> number(static_cast<std::size_t>(system.rows()), -1);
  std::vector<double> added;
  for (const ContactPoint& point : system.points()) {
    for (Index row = point.row; row < point.row + point.size; ++row) {
      number[std::size_t(row)] = int(rows_.size());
      rows_.push_back(row);
      added.push_back(penalty * point.diagonal);
    }
  }
  const auto count = Index(rows_.size());
  SparseMatrix matrix = extract(*system.sparse(), number, count, number, count);
  for (Index row = 0; row < count; ++row) matrix.coeffRef(row, row) += added[std::size_t(row)];
  matrix.makeCompressed();
  sparse_.emplace(matrix);
  return sparse_->positive_definite();
}

void PenaltyFactor::solve(const Vector& right, Vector& x) {
  if (!sparse_) {
    dense_.solve(right, x);
    return;
  }
  right_ = right(rows_);
  sparse_->solve(right_, solution_);
  x.setZero(right.size());
  x(rows_) = solution_;
}

/// Root of the product of the extreme eigenvalues of D⁻¹W, as estimated by a few steps of Lanczos (B. Parlett, The
/// Symmetric Eigenvalue Problem, 1980), from a start with a component along every eigenvector.
double geometric_mean_eigenvalue(const ContactSystem& system) {
  const Index rows = system.rows();
  Vector root = Vector::Zero(rows);
  Vector v = Vector::Zero(rows);
  for (const ContactPoint& point : system.points()) {
    for (Index row = point.row; row < point.row + point.size; ++row) {
      root[row] = 1.0 / std::sqrt(point.diagonal);
      v[row] = 1.0 + 0.5 * std::sin(1.7 * double(row * row % 101));
    }
  }
  v.normalize();
  const Index steps = std::min<Index>(lanczos_steps, rows);
  Matrix small = Matrix::Zero(steps, steps);
  Vector last = Vector::Zero(rows), product;
  double beta = 0.0;
  Index count = 0;
  while (count < steps) {
    system.multiply(root.cwiseProduct(v), product);
    product = root.cwiseProduct(product) - beta * last;
    small(count, count) = product.dot(v);
    product -= small(count, count) * v;
    beta = product.norm();
    if (++count == steps || !(beta > 1e-10 * std::abs(small(0, 0)))) break;
    small(count, count - 1) = small(count - 1, count) = beta;
    last = v;
    v = product / beta;
  }
  const Vector values = symmetric_eigen(small.topLeftCorner(count, count)).values;
  const double largest = values[count - 1];
  return std::sqrt(std::max(values[0], smallest_part * largest) * largest);
}

/// Alternating direction method of multipliers on ½ rᵀ W r + (q + s n)ᵀ r over r = z ∈ K, s = F |u_T|:
///   (W + ρ D) r⁺ = ρ D (z − m) − q − s n,   v = α r⁺ + (1 − α) z + m,   z⁺ = P_K(v),   m⁺ = v − z⁺,
/// with −ρ D m the û of the iteration, from which the next s is taken. S. Boyd et al., Found. Trends Mach. Learn. 3
/// (2011) 1–122, with their over-relaxation α and balancing of residuals; on contact problems V. Acary, M. Brémond, O.
/// Huber, INRIA RR-9118 (2017). ρ starts at the geometric mean of the extreme eigenvalues of D⁻¹W, for which the
/// slowest modes of a linear problem converge fastest, and is replaced by
///   ρ ← ρ (|r − z|/max(|r|, |z|) · |m|/|z⁺ − z|)^½
/// if the two differ by a factor of at least `least_change`; only then is the matrix factorized again.
class Admm final : public IterativeContactSolver {
 protected:
  [[nodiscard]] std::string refuses(const ContactSystem& system) const override {
    if (!system.has_entries()) return "ADMM needs the entries of W, but only products with W are available";
    return refuse_bounds(system);
  }
  void forget() override { key_.clear(); }
  std::string iterate(const ContactSystem& system, const ContactOptions& options, ContactIterate& current,
                      ContactSolution& solution) override;

 private:
  bool start(const ContactSystem& system, const ContactIterate& current, ContactSolution& solution);
  void advance(const ContactSystem& system);
  double measure(const ContactSystem& system);
  bool adapt(const ContactSystem& system, ContactSolution& solution);

  std::vector<double> key_;  ///< points, sizes and diagonals for which `start_factor_` was computed
  double start_penalty_ = 1.0, penalty_ = 1.0;
  PenaltyFactor start_factor_, adapted_factor_;
  PenaltyFactor* factor_ = &start_factor_;
  Vector right_, r_, z_, last_z_, multiplier_;
  ContactIterate candidate_, best_;
  double balance_ = 1.0;  ///< factor by which ρ should change
};

bool Admm::start(const ContactSystem& system, const ContactIterate& current, ContactSolution& solution) {
  std::vector<double> key;
  for (const ContactPoint& point : system.points()) {
    key.push_back(double(point.point));
    key.push_back(double(point.size));
    key.push_back(point.diagonal);
  }
  if (key != key_) {
    key_.clear();
    start_penalty_ = geometric_mean_eigenvalue(system);
    ++solution.factorizations;
    if (!start_factor_.compute(system, start_penalty_)) return false;
    key_ = std::move(key);
  }
  penalty_ = start_penalty_;
  factor_ = &start_factor_;
  z_ = current.reaction;
  multiplier_.setZero(system.rows());
  for (const ContactPoint& point : system.points()) {
    const PaddedVector dual = de_saxce(point, padded(point, current.motion));
    const PaddedVector trial = padded(point, z_) - dual / (penalty_ * point.diagonal);
    enter(point, PaddedVector(trial - project(point, trial)), multiplier_);
  }
  return true;
}

void Admm::advance(const ContactSystem& system) {
  right_ = -system.offset();
  for (const ContactPoint& point : system.points()) {
    const double weight = penalty_ * point.diagonal;
    const PaddedVector m = padded(point, multiplier_);
    PaddedVector right = padded(point, right_) + weight * (padded(point, z_) - m);
    right[0] -= point.coefficient * weight * m.tail<2>().norm();
    enter(point, right, right_);
  }
  factor_->solve(right_, r_);
  last_z_ = z_;
  for (const ContactPoint& point : system.points()) {
    const PaddedVector z = padded(point, z_);
    const PaddedVector v = relaxation * padded(point, r_) + (1.0 - relaxation) * z + padded(point, multiplier_);
    const PaddedVector projected = project(point, v);
    enter(point, projected, z_);
    enter(point, PaddedVector(v - projected), multiplier_);
  }
}

/// Returns the largest primal or dual residual of a point, and sets `balance_`.
double Admm::measure(const ContactSystem& system) {
  double largest = 0.0;
  double primal = 0.0, dual = 0.0, of_r = 0.0, of_z = 0.0, of_multiplier = 0.0;
  for (const ContactPoint& point : system.points()) {
    const double w = point.diagonal;
    const PaddedVector r = padded(point, r_);
    const PaddedVector z = padded(point, z_);
    const double apart = w * (r - z).squaredNorm();
    const double moved = w * (z - padded(point, last_z_)).squaredNorm();
    largest = std::max({largest, apart, penalty_ * penalty_ * moved});
    primal += apart;
    dual += moved;
    of_r += w * r.squaredNorm();
    of_z += w * z.squaredNorm();
    of_multiplier += w * padded(point, multiplier_).squaredNorm();
  }
  const double numerator = primal * of_multiplier;
  const double denominator = dual * std::max(of_r, of_z);
  balance_ = numerator > 0.0 && denominator > 0.0 ? std::sqrt(std::sqrt(numerator / denominator)) : 1.0;
  return std::sqrt(largest);
}

/// Adapts the penalty. Returns false if the matrix with the new penalty is not positive definite.
bool Admm::adapt(const ContactSystem& system, ContactSolution& solution) {
  if (balance_ < least_change && balance_ > 1.0 / least_change) return true;
  penalty_ *= balance_;
  multiplier_ /= balance_;
  ++solution.factorizations;
  factor_ = &adapted_factor_;
  return factor_->compute(system, penalty_);
}

std::string Admm::iterate(const ContactSystem& system, const ContactOptions& options, ContactIterate& current,
                          ContactSolution& solution) {
  if (system.is_solved(current, options.tolerance)) return "";
  const int limit = options.iteration_limit > 0 ? options.iteration_limit : admm_iterations;
  const std::string indefinite = "W is not positive semi-definite";
  if (!start(system, current, solution)) return indefinite;
  double best = system.residual(current);
  double interval = first_interval;
  int next_adaptation = first_interval;
  for (int k = 1; k <= limit; ++k) {
    advance(system);
    const double residual = measure(system);
    note_iteration(system, options, "admm", residual, z_, solution);
    if (!std::isfinite(residual)) return indefinite;
    if (residual <= options.tolerance * system.data() || k % verdict_interval == 0 || k == limit) {
      candidate_.reaction = z_;
      system.evaluate(candidate_);
      const double reached = system.residual(candidate_);
      if (reached < best) {
        best = reached;
        std::swap(current, candidate_);
        if (system.is_solved(current, options.tolerance)) return "";
      }
    }
    if (k == next_adaptation) {
      if (!adapt(system, solution)) return indefinite;
      interval *= interval_growth;
      next_adaptation += int(interval);
    }
  }
  return "the iteration limit was reached";
}

}  // namespace

ContactSolverRegistration admm_solver() {
  return {"admm",
          {[] { return std::make_unique<Admm>(); },
           "alternating direction method of multipliers with an adaptive penalty"}};
}

}  // namespace ricochet
