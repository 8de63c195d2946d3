#include "ricochet/solver/contact/newton_iteration.hpp"

namespace ricochet {

namespace {

/// Semismooth Newton method of M. Jean and J. J. Moreau (Proc. Contact Mechanics Int. Symp., Lausanne, 1992, 31–48):
/// Alart and Curnier's equations with the friction limit of r_N itself,
///   f_N = r_N − max(0, τ_N),   f_T = r_T − P_b(τ_T),   τ = r − u/w,   b = F max(0, r_N)
/// (or the point's bound). From r = 0 the first step is therefore one without friction.
class NewtonJeanMoreau final : public NewtonContactSolver {
 protected:
  [[nodiscard]] PointEquation equation(const ContactPoint& point, const PaddedVector& reaction,
                                       const PaddedVector& motion, bool derivatives) const override {
    return projection_equation(point, reaction, motion, DiscRadius::of_reaction, derivatives);
  }
};

}  // namespace

ContactSolverRegistration newton_jean_moreau_solver() {
  return {"newton-jean-moreau",
          {[] { return std::make_unique<NewtonJeanMoreau>(); }, "semi-smooth Newton on Jean and Moreau's equations"}};
}

}  // namespace ricochet
