#include "ricochet/scheme/response/nitsche_law.hpp"

#include "ricochet/base/dense_decompositions.hpp"
#include "ricochet/scheme/response/dense_complementarity.hpp"

namespace ricochet {

NitscheLaw::NitscheLaw(const Matrix& response, const Vector& stiffness) : stiffness_(stiffness) {
  const Index n = stiffness.size();
  const auto gg = response.topLeftCorner(n, n), gs = response.topRightCorner(n, n);
  const auto sg = response.bottomLeftCorner(n, n), ss = response.bottomRightCorner(n, n);
  Matrix own = -0.5 * ss;
  own.diagonal() += stiffness;
  q_of_stress_ = SmallCholesky(own).solve(Matrix::Identity(n, n));
  q_of_r_ = q_of_stress_ * (0.5 * sg - Matrix::Identity(n, n));
  p_of_q_ = ss - stiffness.asDiagonal() * gs;
  const Matrix p_of_r = sg - stiffness.asDiagonal() * gg + p_of_q_ * q_of_r_;
  compliance_ = -(stiffness.cwiseInverse().asDiagonal() * p_of_r);
  compliance_ = Matrix(0.5 * (compliance_ + compliance_.transpose()));
  compliance_.diagonal() += 2.0 * stiffness.cwiseInverse();
}

void NitscheLaw::solve(const Points& points, Vector& r, Vector& q) {
  mean_ = 0.5 * (points.s_before + points.s);
  q.noalias() = q_of_stress_ * mean_;
  p_ = points.s - stiffness_.cwiseProduct(points.gap);
  p_.noalias() += p_of_q_ * q;
  first_.resize(static_cast<std::size_t>(p_.size()));
  for (Index i = 0; i < p_.size(); ++i) {
    first_[static_cast<std::size_t>(i)] = points.p_before[i] > 0.0 ? 1 : 0;
    if (points.p_before[i] > 0.0) p_[i] += points.p_before[i];
  }
  p_ = p_.cwiseQuotient(stiffness_);
  r.setZero(p_.size());
  if (!(p_.maxCoeff() > 0.0)) return;
  r = dense_complementarity(compliance_, p_, first_);
  q.noalias() += q_of_r_ * r;
}

double nitsche_energy(const Vector& stiffness, const Vector& stress_force, const Vector& p) {
  return 0.5 * (p.cwiseMax(0.0).cwiseAbs2() - stress_force.cwiseAbs2()).cwiseQuotient(stiffness).sum();
}

double nitsche_dissipation(const Vector& stiffness, const Vector& p_before, const Vector& p_after) {
  double sum = 0.0;
  for (Index i = 0; i < stiffness.size(); ++i) {
    const double before = p_before[i], after = p_after[i];
    double lost = 0.0;
    if (before > 0.0) {
      if (after <= 0.0) lost = before + after > 0.0 ? after * after : before * before;
    } else if (after > 0.0) {
      lost = -before * after;
    }
    sum += 0.5 * lost / stiffness[i];
  }
  return sum;
}

}  // namespace ricochet
