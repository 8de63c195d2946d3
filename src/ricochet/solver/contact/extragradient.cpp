#include <algorithm>
#include <cmath>

#include "ricochet/solver/contact/cone_formulation.hpp"
#include "ricochet/solver/contact/iteration_record.hpp"
#include "ricochet/solver/contact/iterative_contact_solver.hpp"

namespace ricochet {

namespace {

constexpr int extragradient_iterations = 50000;
/// Bounds of ρ |û(r̄) − û(r)|/|r̄ − r|: above the first the step is repeated, shorter; below the second the next one is
/// longer.
constexpr double longest = 0.9, shortest = 0.3;
constexpr double shortening = 2.0 / 3.0;

/// Extragradient method for the variational inequality of û on K:
///   r̄ = P_K(r − ρ û(r)/w),   r⁺ = P_K(r − ρ û(r̄)/w),   û = u + (F |u_T|, 0, 0),   u = q + W r.
/// G. M. Korpelevich, Matecon 12 (1976) 747–756; ρ adapted as by E. N. Khobotov, USSR Comput. Math. Math. Phys. 27
/// (1987) 120–127, and on contact problems by V. Acary, M. Brémond, O. Huber, in Advanced Topics in Nonsmooth Dynamics,
/// Springer 2018, 375–457. Two products with W per iteration, which include the whole of De Saxcé's correction.
class Extragradient final : public IterativeContactSolver {
 protected:
  [[nodiscard]] std::string refuses(const ContactSystem& system) const override { return refuse_bounds(system); }
  std::string iterate(const ContactSystem& system, const ContactOptions& options, ContactIterate& current,
                      ContactSolution& solution) override;

 private:
  void advance(const ContactSystem& system, ContactIterate& current);
  void step(const ContactSystem& system, const ContactIterate& from, const Vector& motion, ContactIterate& to) const;
  [[nodiscard]] double ratio(const ContactSystem& system, const ContactIterate& current) const;

  ContactIterate middle_;  ///< r̄
  FirstOrderVerdict verdict_;
  double step_ = 1.0;  ///< ρ
};

void Extragradient::step(const ContactSystem& system, const ContactIterate& from, const Vector& motion,
                         ContactIterate& to) const {
  if (to.reaction.size() != system.rows()) to.reaction.setZero(system.rows());
  for (const ContactPoint& point : system.points()) {
    const PaddedVector change = (step_ / point.diagonal) * de_saxce(point, padded(point, motion));
    enter(point, project(point, padded(point, from.reaction) - change), to.reaction);
  }
  system.multiply(to.reaction, to.motion);
  to.motion += system.offset();
}

/// Computes ρ |û(r̄) − û(r)|/|r̄ − r|, with u in the dual metric.
double Extragradient::ratio(const ContactSystem& system, const ContactIterate& current) const {
  double of_motion = 0.0;
  double of_reaction = 0.0;
  for (const ContactPoint& point : system.points()) {
    const PaddedVector u =
        de_saxce(point, padded(point, middle_.motion)) - de_saxce(point, padded(point, current.motion));
    of_motion += u.squaredNorm() / point.diagonal;
    of_reaction += point.diagonal * (padded(point, middle_.reaction) - padded(point, current.reaction)).squaredNorm();
  }
  return of_reaction > 0.0 ? step_ * std::sqrt(of_motion / of_reaction) : 0.0;
}

void Extragradient::advance(const ContactSystem& system, ContactIterate& current) {
  double reached = 0.0;
  for (int k = 0; k < 60; ++k) {
    step(system, current, current.motion, middle_);
    reached = ratio(system, current);
    if (!(reached > longest)) break;
    step_ *= shortening * std::min(1.0, 1.0 / reached);
  }
  step(system, current, middle_.motion, current);
  if (reached < shortest) step_ /= shortening;
}

std::string Extragradient::iterate(const ContactSystem& system, const ContactOptions& options, ContactIterate& current,
                                   ContactSolution& solution) {
  if (system.is_solved(current, options.tolerance)) return "";
  const int limit = options.iteration_limit > 0 ? options.iteration_limit : extragradient_iterations;
  verdict_.start(system, options.tolerance, current);
  step_ = 1.0;
  for (int k = 1; k <= limit; ++k) {
    advance(system, current);
    const double residual = system.residual(current);
    note_iteration(system, options, "extragradient", residual, current.reaction, solution);
    if (!std::isfinite(residual)) break;
    if (verdict_.is_solved(system, k, residual, current)) return "";
  }
  return verdict_.finish(system, current) ? "the limit of extragradient steps was reached"
                                          : "the extragradient steps diverged: W is not positive semi-definite";
}

}  // namespace

ContactSolverRegistration extragradient_solver() {
  return {"extragradient",
          {[] { return std::make_unique<Extragradient>(); },
           "Korpelevich's extragradient method with an adaptive step; needs only products with W"}};
}

}  // namespace ricochet
