#include "ricochet/solver/contact/alart_curnier.hpp"
#include "ricochet/solver/contact/newton_iteration.hpp"

namespace ricochet {

namespace {

/// Semismooth Newton method on the equations of P. Alart and A. Curnier (Comput. Methods Appl. Mech. Engrg. 92 (1991)
/// 353–375):
///   f_N = r_N − max(0, τ_N),   f_T = r_T − P_b(τ_T),   τ = r − u/w,   b = F max(0, τ_N)
/// (or the point's bound), P_b the projection on the disc |·| ≤ b. The step is AlartCurnierStep's for a dense W, and
/// follows from (A W + B) Δr = −f for a sparse one.
class NewtonAlartCurnier final : public NewtonContactSolver {
 protected:
  [[nodiscard]] PointEquation equation(const ContactPoint& point, const PaddedVector& reaction,
                                       const PaddedVector& motion, bool derivatives) const override {
    return projection_equation(point, reaction, motion, DiscRadius::of_trial, derivatives);
  }
  bool full_step(const ContactSystem& system, const ContactIterate& from, Vector& reaction,
                 ContactSolution& solution) override {
    if (system.dense() == nullptr) return NewtonContactSolver::full_step(system, from, reaction, solution);
    if (!step_.step(system, from, reaction)) return false;
    if (step_.has_factored()) ++solution.factorizations;
    full_.reaction = reaction;
    system.evaluate(full_);
    step_.refine(full_, reaction);
    return true;
  }
  void forget() override {
    NewtonContactSolver::forget();
    step_.reset();
  }
  void persist_memory(const SnapshotVisitor& visit, const std::vector<Index>& row_offset) override {
    step_.reused().persist(visit, row_offset);
  }
  [[nodiscard]] bool keeps_row(Index problem_row) const override { return step_.reused().keeps_row(problem_row); }

 private:
  AlartCurnierStep step_;
  ContactIterate full_;
};

}  // namespace

ContactSolverRegistration newton_alart_curnier_solver() {
  return {
      "newton-alart-curnier",
      {[] { return std::make_unique<NewtonAlartCurnier>(); }, "semi-smooth Newton on Alart and Curnier's equations"}};
}

}  // namespace ricochet
