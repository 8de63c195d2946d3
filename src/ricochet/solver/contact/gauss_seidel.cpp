#include "ricochet/solver/contact/gauss_seidel.hpp"

#include <cmath>

#include "ricochet/solver/contact/iteration_record.hpp"
#include "ricochet/solver/contact/iterative_contact_solver.hpp"

namespace ricochet {

bool GaussSeidel::sweep(const ContactSystem& system, double damping, ContactIterate& iterate, bool roughly) {
  roughly = roughly && system.has_rough_entries();
  const std::vector<ContactPoint>& points = system.points();
  bool changed = states_.size() != points.size();
  if (changed) {
    states_.assign(points.size(), 0);
    slip_stiffness_.assign(points.size(), -1.0);
  }
  for (std::size_t k = 0; k < points.size(); ++k) {
    const ContactPoint& point = points[k];
    const PaddedVector r = padded(point, iterate.reaction);
    const PaddedVector u = padded(point, iterate.motion);
    if (u[0] >= 0.0 && r.isZero(0.0)) {
      changed = changed || states_[k] != 0;
      states_[k] = 0;
      continue;
    }
    const PointOperator& block = system.point_operator(k);
    const PaddedVector found = solve_point(point, block, u - block.multiply(r), r[0] > 0.0, slip_stiffness_[k]);
    char state = found[0] > 0.0 ? 1 : 0;
    if (state != 0 && point.has_friction()) {
      const double limit = point.friction_limit(found[0]) * (1.0 - 8.0 * machine_epsilon);
      if (found.tail<2>().squaredNorm() < limit * limit) state = 2;
    }
    changed = changed || state != states_[k];
    states_[k] = state;
    const PaddedVector change = damping * (found - r);
    if (change.isZero(0.0)) continue;
    roughly ? system.add_change_roughly(point, change, iterate.motion)
            : system.add_change(point, change, iterate.motion);
    enter(point, damping < 1.0 ? PaddedVector(r + change) : found, iterate.reaction);
  }
  return changed;
}

namespace {

/// Sweeps alone, for comparison and as a fallback.
class GaussSeidelSolver final : public IterativeContactSolver {
 protected:
  [[nodiscard]] std::string refuses(const ContactSystem& system) const override {
    return system.has_entries() ? "" : "Gauss-Seidel needs the entries of W, but only products with W are available";
  }
  std::string iterate(const ContactSystem& system, const ContactOptions& options, ContactIterate& current,
                      ContactSolution& solution) override {
    const int limit = options.iteration_limit > 0 ? options.iteration_limit : 20000;
    sweeps_.restart();
    for (int k = 1; k <= limit; ++k) {
      sweeps_.sweep(system, 1.0, current);
      const double residual = system.residual(current);
      note_iteration(system, options, "sweep", residual, current.reaction, solution);
      if (!std::isfinite(residual)) return "the sweeps diverged: W is not positive definite";
      // u accumulates the rounding of its updates; the verdict is on a fresh one.
      if (residual > options.tolerance * system.data() && k % 16 != 0) continue;
      system.evaluate(current);
      if (system.is_solved(current, options.tolerance)) return "";
    }
    return "the limit of sweeps was reached";
  }

 private:
  GaussSeidel sweeps_;
};

}  // namespace

ContactSolverRegistration gauss_seidel_solver() {
  return {
      "gauss-seidel",
      {[] { return std::make_unique<GaussSeidelSolver>(); }, "projected block Gauss-Seidel with exact local solves"}};
}

}  // namespace ricochet
