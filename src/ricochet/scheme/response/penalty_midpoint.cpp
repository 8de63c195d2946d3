#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "ricochet/base/dense_decompositions.hpp"
#include "ricochet/base/error.hpp"
#include "ricochet/base/log.hpp"
#include "ricochet/scheme/response/forced_midpoint.hpp"

namespace ricochet {

namespace {

/// Force of a point, without cancellation, and its derivative with respect to the gap at the end.
struct PenaltyForce {
  double force, slope;
};

PenaltyForce penalty_force(double stiffness, double before, double after) {
  if (before <= 0.0 && after <= 0.0) return {-0.5 * stiffness * (before + after), -0.5 * stiffness};
  if (before > 0.0 && after > 0.0) return {0.0, 0.0};
  const double change = after - before;
  const double inside = before > 0.0 ? after : before;
  const double force = 0.5 * stiffness * inside * inside / std::abs(change);
  if (before > 0.0) return {force, 0.5 * stiffness * after * (2.0 * before - after) / (change * change)};
  return {force, -force / change};
}

/// Returns the forces at which the linearized law and gap = free + W r agree; `motion` is gap − free.
Vector newton_forces(const Matrix& w, const Vector& law, const Vector& slope, const Vector& motion) {
  std::vector<Index> pressing;
  for (Index i = 0; i < slope.size(); ++i) {
    if (slope[i] != 0.0) pressing.push_back(i);
  }
  Vector result = Vector::Zero(slope.size());
  if (pressing.empty()) return result;
  const Vector compliance = -slope(pressing).cwiseInverse();
  Matrix tangent = w(pressing, pressing);
  tangent.diagonal() += compliance;
  result(pressing) = SmallCholesky(tangent).solve(compliance.cwiseProduct(law(pressing)) + motion(pressing));
  return result;
}

/// Stiffness k, gap at the start of a step, and gap at its end without forces, per point.
struct PenaltyPoints {
  Vector stiffness, before, free;
};
/// Penalty energy Σ ½ k_i min(g_i, 0)².
double penalty_energy(const Vector& stiffness, const Vector& gap) {
  return 0.5 * stiffness.dot(gap.cwiseMin(0.0).cwiseAbs2());
}

/// Returns the forces r of a step, r_i = −(ψ_i(g₁)−ψ_i(g₀))/(g₁−g₀) ≥ 0 with ψ_i(g) = ½ k_i min(g, 0)² and
/// g₁ = free + W r, W positive semi-definite. r decreases with g₁, so the solution is unique: Newton's method. Throws
/// Error(not_converged).
///
/// Newton's method for r = f(free + W r), the minimum of a convex function whose derivative is W (r − f). The unknown
/// is r, with W + diag(−1/slope) of the pressing points: with gaps as unknowns, a stiffness much larger than W⁻¹ would
/// reduce r to the rounding of gaps times that stiffness.
Vector penalty_forces(const Matrix& w, const PenaltyPoints& points) {
  constexpr int most_iterations = 200, most_halvings = 50;
  constexpr double rounding = 4.0 * std::numeric_limits<double>::epsilon(), good_enough = 1e-12;
  const Index count = points.free.size();
  Vector gap = points.free, r = Vector::Zero(count), law(count), slope(count);
  const auto evaluate = [&](const Vector& at) {
    for (Index i = 0; i < count; ++i) {
      const PenaltyForce here = penalty_force(points.stiffness[i], points.before[i], at[i]);
      law[i] = here.force;
      slope[i] = here.slope;
    }
  };
  double last = std::numeric_limits<double>::infinity();
  evaluate(gap);
  for (int iteration = 0; iteration < most_iterations; ++iteration) {
    const Vector change = newton_forces(w, law, slope, gap - points.free) - r;
    const Vector motion = w * change;
    const double size = std::max(gap.lpNorm<Eigen::Infinity>(), points.free.lpNorm<Eigen::Infinity>());
    const double moved = size > 0.0 ? motion.lpNorm<Eigen::Infinity>() / size : 0.0;
    // The law at a gap has the rounding of the gap times the stiffness; the change does not.
    if (moved <= rounding || (moved <= good_enough && moved >= 0.5 * last)) return (r + change).cwiseMax(0.0);
    last = moved;
    const double descent = -motion.dot(r - law);
    double part = 1.0;
    for (int halving = 0; halving < most_halvings; ++halving, part *= 0.5) {
      evaluate(gap + part * motion);
      if (motion.dot(r + part * change - law) <= 0.5 * descent) break;
    }
    r += part * change;
    gap = points.free + w * r;
    evaluate(gap);
  }
  throw Error(ErrorKind::not_converged, "the penalty forces of contact were not found");
}

/// Midpoint scheme with a penalty whose force is a discrete gradient of its energy (P. Hauret, P. Le Tallec, Comput.
/// Methods Appl. Mech. Engrg. 195 (2006) 4890–4916; the same force: F. Armero, E. Petőcz, 158 (1998) 269–300):
///   r_i = −(ψ_i(g₁)−ψ_i(g₀))/(g₁−g₀),   ψ_i(g) = ½ k_i min(g, 0)²,   f = 0.
/// J + Σψ_i(g_i) is conserved to rounding if gaps are linear and obstacles rest. Points penetrate by r/k; with a large
/// k contact forces oscillate. k_i is `penalty` times the stiffness n·Kn of the body at the point. No friction: the
/// source has none.
///
/// r decreases with g₁, so each step has one solution: Newton's method on g₁ = q + W r, W = G A⁻¹Gᵀ, for the points
/// that penetrate before or after.
class PenaltyMidpoint final : public ForcedMidpoint {
 public:
  PenaltyMidpoint(double step, double penalty) : ForcedMidpoint(step, "penalty-midpoint"), penalty_(penalty) {}

  void analyse(const SemidiscreteProblem& problem) override {
    ForcedMidpoint::analyse(problem);
    stiffness_ = penalty_ * point_stiffness(problem);
  }

  void start(const SemidiscreteProblem&, State& state, StageSolve&) override {
    if (!(state.forces.normal_reaction.sum() > 0.0)) return;
    log::warning(
        "scheme \"penalty-midpoint\": contact in the static equilibrium has no penetration, without which this scheme "
        "has no contact force: the body falls until it penetrates, and vibrates; start it slightly above the obstacle "
        "with damping, or use scheme \"reduced-kane\", with which it stays at rest");
  }

 protected:
  void step_changed(const SemidiscreteProblem&) override { response_.forget(); }

  /// Solves for the points that penetrate before or after, and for more of them if forces push others inside.
  bool find_forces(const SemidiscreteProblem& problem, const ContactRows& rows, const Unforced& unforced,
                   StageSolve& stages, Vector& normal) override {
    points_.clear();
    gap_ = unforced.gap;
    while (true) {
      const std::size_t before = points_.size();
      for (Index i = 0; i < gap_.size(); ++i) {
        const bool is_there = std::binary_search(points_.begin(), points_.begin() + long(before), i);
        if ((unforced.gap_before[i] < 0.0 || gap_[i] < 0.0) && !is_there) points_.push_back(i);
      }
      if (points_.size() == before) return before > 0;
      std::ranges::sort(points_);
      const Matrix& w = response_.among(problem, rows, points_, stages);
      normal(points_) = penalty_forces(w, {stiffness_(points_), unforced.gap_before(points_), unforced.gap(points_)});
      gap_ = unforced.gap;
      for (const Index i : points_) gap_ += normal[i] * response_.column(problem, rows, i, stages);
    }
  }

  /// Contact energy Σψ.
  [[nodiscard]] double contact_energy(const Vector&, const Vector& gap) const override {
    return penalty_energy(stiffness_, gap);
  }

 private:
  double penalty_;
  ContactResponse response_{0};
  Vector stiffness_;           ///< k, per contact point
  Vector gap_;                 ///< g₁
  std::vector<Index> points_;  ///< that may press, ascending
};

}  // namespace

SchemeRegistration penalty_midpoint_scheme() {
  const auto make = [](double step, const Parameters& parameters) {
    return std::make_unique<PenaltyMidpoint>(step, parameters.number("penalty"));
  };
  return {"penalty-midpoint",
          make,
          {number_key("penalty", "1", {.default_value = "10", .range = {.above = 0.0, .at_most = 1e6}},
                      "Stiffness of the contact, in units of the body's own stiffness at a contact point.")}};
}

}  // namespace ricochet
