#include <map>

#include "ricochet/base/error.hpp"
#include "ricochet/scheme/response/forced_midpoint.hpp"
#include "ricochet/scheme/response/nitsche_law.hpp"

namespace ricochet {

namespace {

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
