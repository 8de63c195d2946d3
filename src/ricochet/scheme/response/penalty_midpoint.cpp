#include <algorithm>
#include <cmath>
#include <limits>

#include "ricochet/base/dense_decompositions.hpp"
#include "ricochet/base/error.hpp"
#include "ricochet/scheme/kane.hpp"
#include "ricochet/scheme/response/contact_response.hpp"

namespace ricochet {

namespace {

/// The energy ½ k min(g, 0)² of a point, and the force on it over a step, −(ψ(g₁)−ψ(g₀))/(g₁−g₀) ≥ 0, with its
/// derivative by g₁, both without cancellation.
struct Penalty {
  double force, slope;
};
double penalty_energy(double stiffness, double gap) {
  return gap < 0.0 ? 0.5 * stiffness * gap * gap : 0.0;
}
Penalty penalty(double stiffness, double before, double after) {
  if (before <= 0.0 && after <= 0.0) return {-0.5 * stiffness * (before + after), -0.5 * stiffness};
  if (before > 0.0 && after > 0.0) return {0.0, 0.0};
  const double change = after - before;
  const double inside = before > 0.0 ? after : before;
  const double force = 0.5 * stiffness * inside * inside / std::abs(change);
  if (before > 0.0) return {force, 0.5 * stiffness * after * (2.0 * before - after) / (change * change)};
  return {force, -force / change};
}

/// The midpoint scheme with a penalty whose force is a discrete gradient of its energy (P. Hauret, P. Le Tallec,
/// Comput. Methods Appl. Mech. Engrg. 195 (2006) 4890–4916; the same force: F. Armero, E. Petőcz, 158 (1998) 269–300):
///   M (V₁−V₀)/h + C ΔU/h + K (U₀+U₁)/2 = L_½ + Gᵀ r,   ΔU = h (V₀+V₁)/2,   r_i = −(ψ_i(g₁)−ψ_i(g₀))/(g₁−g₀),
///   ψ_i(g) = ½ k_i min(g, 0)².
/// J + Σψ_i(g_i) is kept to rounding where gaps are linear and obstacles rest. Points penetrate by r/k; a large k makes
/// forces rattle. k_i is `penalty` times the stiffness n·Kn of the body at the point. No friction: the source has none.
///
/// r decreases with g₁, so each step has one solution: Newton's method on g₁ = q + W r, W = G A⁻¹Gᵀ, for the points
/// that are or come inside.
class PenaltyMidpoint final : public Kane {
 public:
  PenaltyMidpoint(double step, double penalty) : Kane(step, "penalty-midpoint"), penalty_(penalty) {}

  [[nodiscard]] double force_instant() const override { return -0.5; }
  /// Σψ.
  [[nodiscard]] double algorithmic_energy(const SemidiscreteProblem& problem, const State& state) const override;
  /// What the forces take from the body the penalty stores.
  [[nodiscard]] StepCorrections step_corrections(const SemidiscreteProblem&) const override {
    return {.contact_work = stored_};
  }
  void analyse(const SemidiscreteProblem& problem) override;
  void advance(const SemidiscreteProblem& problem, State& state, StageSolve& stages, Vector& increment) override;

 protected:
  void step_changed(const SemidiscreteProblem&) override { response_.forget(); }

 private:
  [[nodiscard]] double energy(const Vector& gap) const;
  void find_forces(const SemidiscreteProblem& problem, const ContactRows& rows, StageSolve& stages);
  void solve_law(const Matrix& w);

  double penalty_, stored_ = 0.0;
  ContactResponse response_{0};
  Vector stiffness_;            ///< k, per contact point
  Vector before_, free_, gap_;  ///< g₀, g₁ without forces, g₁
  Vector normal_;               ///< r
  std::vector<Index> points_;   ///< that may press
  StageSolution solution_;
};

void PenaltyMidpoint::analyse(const SemidiscreteProblem& problem) {
  Kane::analyse(problem);
  if (problem.contact.has_friction() || problem.contact.follows_motion()) {
    throw Error(ErrorKind::invalid_input,
                "scheme \"penalty-midpoint\" takes neither friction nor curved obstacles; take friction out, or use "
                "scheme \"reduced-kane\"");
  }
  const SparseMatrix& k = problem.internal_force->tangent();
  stiffness_.setZero(problem.contact.size());
  for (Index i = 0; i < stiffness_.size(); ++i) {
    double own = 0.0, length = 0.0;
    problem.contact.rows->visit_normal(i, [&](Index a, double at_a) {
      length += at_a * at_a;
      problem.contact.rows->visit_normal(i, [&](Index b, double at_b) { own += at_a * k.coeff(a, b) * at_b; });
    });
    if (length > 0.0) stiffness_[i] = penalty_ * own / (length * length);
  }
}

double PenaltyMidpoint::algorithmic_energy(const SemidiscreteProblem& problem, const State& state) const {
  Vector gap;
  problem.gaps(state.displacement, state.time, gap);
  return energy(gap);
}

double PenaltyMidpoint::energy(const Vector& gap) const {
  double sum = 0.0;
  for (Index i = 0; i < gap.size(); ++i) sum += penalty_energy(stiffness_[i], gap[i]);
  return sum;
}

void PenaltyMidpoint::advance(const SemidiscreteProblem& problem, State& state, StageSolve& stages, Vector& increment) {
  const double end = state.time + step();
  problem.gaps(state.displacement, state.time, before_);
  const ContactRows& rows = *stages.stage(0).rows;
  // Without forces, then with them.
  normal_.setZero(before_.size());
  Stage& stage = balance(problem, state, stages);
  if (problem.has_moving_obstacles()) equations().observe_obstacles(problem, state.time + 0.5 * step(), base());
  const StageSolution* solution = &solve_with_forces(problem, normal_, 0, stages);
  gap_ = base() + solution->increment;
  problem.gaps(gap_, end, free_);
  find_forces(problem, rows, stages);
  if (!points_.empty()) {
    balance(problem, state, stages);
    solution = &solve_with_forces(problem, normal_, 0, stages);
  }
  solution_.increment = solution->increment;
  solution_.support_reaction = solution->support_reaction;
  solution_.normal_reaction = normal_;
  solution_.contact_status.assign(static_cast<std::size_t>(normal_.size()), ContactStatus::open);
  for (Index i = 0; i < normal_.size(); ++i) {
    if (normal_[i] > 0.0) solution_.contact_status[static_cast<std::size_t>(i)] = ContactStatus::slip;
  }
  take(problem, stage, solution_, state, increment);
  problem.gaps(state.displacement, end, gap_);
  stored_ = energy(gap_) - energy(before_);
}

void PenaltyMidpoint::find_forces(const SemidiscreteProblem& problem, const ContactRows& rows, StageSolve& stages) {
  points_.clear();
  gap_ = free_;
  for (bool grows = true; grows;) {
    std::vector<Index> more;
    for (Index i = 0; i < gap_.size(); ++i) {
      if ((before_[i] < 0.0 || gap_[i] < 0.0) && !std::binary_search(points_.begin(), points_.end(), i))
        more.push_back(i);
    }
    grows = !more.empty();
    if (!grows) return;
    points_.insert(points_.end(), more.begin(), more.end());
    std::sort(points_.begin(), points_.end());
    solve_law(response_.among(problem, rows, points_, stages));
    // The other points, too: W's columns are of all.
    gap_ = free_;
    for (const Index i : points_) gap_ += normal_[i] * response_.column(problem, rows, i, stages);
  }
}

/// Newton's method; the residual is in terms of gaps.
void PenaltyMidpoint::solve_law(const Matrix& w) {
  const auto count = static_cast<Index>(points_.size());
  Vector q(count), g0(count), k(count);
  for (Index i = 0; i < count; ++i) {
    const Index point = points_[static_cast<std::size_t>(i)];
    q[i] = free_[point];
    g0[i] = before_[point];
    k[i] = stiffness_[point];
  }
  Vector y = q, force(count), slope(count);
  constexpr int most_iterations = 200;
  constexpr double rounding = 4.0 * std::numeric_limits<double>::epsilon();
  for (int iteration = 0; iteration < most_iterations; ++iteration) {
    for (Index i = 0; i < count; ++i) {
      const Penalty law = penalty(k[i], g0[i], y[i]);
      force[i] = law.force;
      slope[i] = law.slope;
    }
    const Vector error = y - q - w * force;
    // I − W diag(slope), slope ≤ 0.
    Matrix tangent = -w * slope.asDiagonal();
    tangent.diagonal().array() += 1.0;
    const Vector change = PivotedLu(tangent).solve(error);
    const Vector next = y - change;
    if (change.lpNorm<Eigen::Infinity>() <=
        rounding * std::max(y.lpNorm<Eigen::Infinity>(), q.lpNorm<Eigen::Infinity>())) {
      for (Index i = 0; i < count; ++i) normal_[points_[static_cast<std::size_t>(i)]] = force[i];
      return;
    }
    y = next;
  }
  throw Error(ErrorKind::not_converged, "the penalty forces of contact were not found");
}

}  // namespace

SchemeRegistration penalty_midpoint_scheme() {
  const auto make = [](double step, const Parameters& parameters) {
    return std::make_unique<PenaltyMidpoint>(step, parameters.number("penalty"));
  };
  return {"penalty-midpoint",
          make,
          {{.name = "penalty",
            .type = KeyType::number,
            .unit = "1",
            .standard = "10",
            .range = positive,
            .doc = "Stiffness of the contact, in units of the body's own stiffness at a contact point."}}};
}

}  // namespace ricochet
