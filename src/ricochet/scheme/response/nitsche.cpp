#include <map>
#include <vector>

#include "ricochet/base/dense_decompositions.hpp"
#include "ricochet/base/error.hpp"
#include "ricochet/scheme/response/dense_complementarity.hpp"
#include "ricochet/scheme/response/forced_midpoint.hpp"

namespace ricochet {

namespace {

/// Contact law over a step of the midpoint rule, with per point s the force that balances the stress of the body, g the
/// gap, Γ a stiffness, p = s − Γ g. The obstacle's force r and f = Sᵀ q are
///   r = [½(p₀+p₁)]₊ where p₀ > 0, else ½[p₁]₊;   Γ q = ½(s₀+s₁) − r,
/// and s₁ = s + S A⁻¹(Gᵀr + Sᵀq), g₁ = g + G A⁻¹(Gᵀr + Sᵀq) from s and g, those without forces.
class NitscheLaw {
 public:
  /// `response` is [G; S] A⁻¹ [G; S]ᵀ, 2 points × 2 points; `stiffness` is Γ, with Γ − ½ S A⁻¹Sᵀ positive definite.
  NitscheLaw(const Matrix& response, const Vector& stiffness);

  /// p₀, s₀ and, without forces, s and g.
  struct Points {
    Vector p_before, s_before, s, gap;
  };
  /// Allocates nothing while no point presses.
  void solve(const Points& points, Vector& r, Vector& q);

 private:
  Vector stiffness_;
  Matrix q_of_stress_, q_of_r_;  ///< q = q_of_stress ½(s₀+s) + q_of_r r
  Matrix p_of_q_;                ///< change of p₁ due to f
  Matrix compliance_;            ///< decrease of p₁/Γ per r; with 2/Γ, symmetric
  Vector mean_, p_;              ///< work space
  std::vector<char> first_;
};

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
  first_.resize(std::size_t(p_.size()));
  for (Index i = 0; i < p_.size(); ++i) {
    first_[std::size_t(i)] = points.p_before[i] > 0.0 ? 1 : 0;
    if (points.p_before[i] > 0.0) p_[i] += points.p_before[i];
  }
  p_ = p_.cwiseQuotient(stiffness_);
  r.setZero(p_.size());
  if (!(p_.maxCoeff() > 0.0)) return;
  r = dense_complementarity(compliance_, p_, first_);
  q.noalias() += q_of_r_ * r;
}

/// −½Σs²/Γ + ½Σ[p]₊²/Γ, the contribution of Nitsche's method to the energy.
double nitsche_energy(const Vector& stiffness, const Vector& stress_force, const Vector& p) {
  return 0.5 * (p.cwiseMax(0.0).cwiseAbs2() - stress_force.cwiseAbs2()).cwiseQuotient(stiffness).sum();
}

/// Dissipation of the law in a step: Σ 1/Γ times 0 if p₀, p₁ > 0; ½p₁² if p₀ > 0 ≥ p₁ and r > 0; ½p₀² if r = 0 < p₀;
/// ½p₁|p₀| if p₁ > 0 ≥ p₀.
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

/// Nitsche's method, symmetric (θ = 1), under the midpoint scheme with the hybrid contact term of F. Chouly, P. Hild
/// and Y. Renard (ESAIM: M2AN 49 (2015) 481–502 and 503–528), at the contact points: with s_i the force of the obstacle
/// that balances the stress of the body (ContactStress), Γ_i a stiffness and p = s − Γ g,
///   r = [½(p₀+p₁)]₊ where p₀ > 0, else ½[p₁]₊;   f = SᵀΓ⁻¹(½(s₀+s₁) − r).
/// J − ½Σs²/Γ + ½Σ[p]₊²/Γ is conserved while p stays positive, and falls by nitsche_dissipation() otherwise, if gaps
/// are linear and obstacles rest; with Γ_i = `penalty` κ_i it is at least (1−1/penalty) of the elastic energy. f has
/// neither resultant nor moment. No friction: the source has none. In the exact motion r = s and f = 0; points
/// penetrate by (r − s)/Γ, due to the error of the stress of the cells.
///
/// A step requires one dense problem of all contact points: suitable for a few hundred.
class Nitsche final : public ForcedMidpoint {
 public:
  Nitsche(double step, double penalty) : ForcedMidpoint(step, "nitsche"), penalty_(penalty) {}

  void analyse(const SemidiscreteProblem& problem) override {
    ForcedMidpoint::analyse(problem);
    if (!problem.contact_stress)
      throw Error(ErrorKind::invalid_input, "scheme \"nitsche\" needs the stress at the contact points");
    warn_of_dense_response("nitsche", 2 * problem.contact.size());
    stress_ = problem.contact_stress();
    const double largest = stress_.stiffness.size() > 0 ? stress_.stiffness.maxCoeff() : 0.0;
    if (!(stress_.stiffness.array() > 1e-10 * largest).all() || !(problem.contact.weights.array() > 0.0).all())
      throw Error(ErrorKind::invalid_input,
                  "scheme \"nitsche\" requires a positive area at every contact point, which multipliers \"nodal\" of "
                  "degree 2 do not have; set multipliers = \"p1\" or \"dual\", or mesh.degree = 1");
    stiffness_ = penalty_ * stress_.stiffness;
  }

 protected:
  bool find_forces(const SemidiscreteProblem& problem, const ContactRows& rows, const Unforced& unforced,
                   StageSolve& stages, Vector& normal) override {
    find_pressures(unforced.start.displacement, unforced.gap_before, points_.s_before, points_.p_before);
    points_.s.noalias() = stress_.rows * unforced.displacement;
    points_.gap = unforced.gap;
    if (stiffness_.size() == 0) {  // no contact: no dense problem
      normal.resize(0);
      q_.resize(0);
      return true;
    }
    law(problem, rows, stages).solve(points_, normal, q_);
    return true;
  }

  void add_other_forces(Vector& force) const override { force.noalias() += stress_.rows.transpose() * q_; }

  [[nodiscard]] double contact_energy(const Vector& displacement, const Vector& gap) const override {
    find_pressures(displacement, gap, s_, p_);
    return nitsche_energy(stiffness_, s_, p_);
  }
  [[nodiscard]] double lost(const Vector& displacement, const Vector& gap) const override {
    find_pressures(displacement, gap, s_, p_);
    return nitsche_dissipation(stiffness_, points_.p_before, p_);
  }
  [[nodiscard]] double other_work(const Vector& increment) const override {
    s_.noalias() = stress_.rows * increment;
    return q_.dot(s_);
  }

 private:
  /// Computes s and p.
  void find_pressures(const Vector& displacement, const Vector& gap, Vector& s, Vector& p) const {
    s.noalias() = stress_.rows * displacement;
    p = s - stiffness_.cwiseProduct(gap);
  }

  /// Law for this length of the step, made once.
  NitscheLaw& law(const SemidiscreteProblem& problem, const ContactRows& rows, StageSolve& stages) {
    const auto found = laws_.find(step());
    if (found != laws_.end()) return found->second;
    const Index count = problem.contact.size();
    Matrix response(2 * count, 2 * count);
    Vector unit = Vector::Zero(count), column;
    for (Index i = 0; i < 2 * count; ++i) {
      Stage& stage = unloaded_stage(problem, 0, stages);
      unit.setZero();
      if (i < count) {
        unit[i] = 1.0;
      } else {
        stage.right_hand_side.force = stress_.rows.row(i - count).transpose();
      }
      const Vector& motion = solve_with_forces(problem, unit, 0, stages).increment;
      rows.normal_motion(motion, column);
      response.col(i) << column, stress_.rows * motion;
    }
    return laws_.emplace(step(), NitscheLaw(response, stiffness_)).first->second;
  }

  double penalty_;
  ContactStress stress_;
  Vector stiffness_, q_;  ///< Γ, and q with f = Sᵀq
  NitscheLaw::Points points_;
  std::map<double, NitscheLaw> laws_;
  mutable Vector s_, p_;  ///< work space
};

}  // namespace

SchemeRegistration nitsche_scheme() {
  const auto make = [](double step, const Parameters& parameters) {
    return std::make_unique<Nitsche>(step, parameters.number("penalty"));
  };
  return {
      "nitsche",
      make,
      {number_key("penalty", "1", {.default_value = "4", .range = {.above = 1.0, .at_most = 1e6}},
                  "Stiffness of the contact, in units of the smallest one for which the energy has a definite sign.")}};
}

}  // namespace ricochet
