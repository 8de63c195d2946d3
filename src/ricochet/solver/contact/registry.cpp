#include "ricochet/solver/contact/iterative_contact_solver.hpp"

namespace ricochet {

// Solvers, each by the registration function of its own file. One line each, in the order of the documentation.
// clang-format off
#define RICOCHET_CONTACT_SOLVERS(solver)   \
  solver(automatic_solver)                 \
  solver(active_set_solver)                \
  solver(gauss_seidel_solver)              \
  solver(newton_alart_curnier_solver)      \
  solver(newton_jean_moreau_solver)        \
  solver(newton_fischer_burmeister_solver) \
  solver(accelerated_gradient_solver)      \
  solver(extragradient_solver)             \
  solver(admm_solver)
// clang-format on

RICOCHET_DEFINE_REGISTRY(contact_solver_registry, ContactSolverType, "contact solver", RICOCHET_CONTACT_SOLVERS)

std::unique_ptr<ContactSolver> make_contact_solver(const std::string& name) {
  return make_iterative_contact_solver(name);
}

std::unique_ptr<IterativeContactSolver> make_iterative_contact_solver(const std::string& name) {
  return contact_solver_registry().find(name).type.make();
}

}  // namespace ricochet
