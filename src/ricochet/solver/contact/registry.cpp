#include <fmt/format.h>

#include "ricochet/base/error.hpp"
#include "ricochet/base/text.hpp"
#include "ricochet/solver/contact/contact_solver.hpp"

namespace ricochet {

// The solvers: a name, the constructor that its own file defines, and what it is. One line each.
// clang-format off
#define RICOCHET_CONTACT_SOLVERS(solver)                                                                              \
  solver("automatic", make_automatic, "accelerated Gauss-Seidel, then Newton with a line search, then fallbacks; no parameter") \
  solver("active-set", make_active_set,                                                                                \
         "primal-dual active set: without friction, and with friction in two dimensions")                              \
  solver("gauss-seidel", make_gauss_seidel, "projected block Gauss-Seidel with exact local solves")                       \
  solver("newton-alart-curnier", make_newton_alart_curnier, "semi-smooth Newton on Alart and Curnier's equations")      \
  solver("newton-jean-moreau", make_newton_jean_moreau,                                                                \
         "semi-smooth Newton on Jean and Moreau's equations")                                                          \
  solver("newton-fischer-burmeister", make_newton_fischer_burmeister,                                                  \
         "semi-smooth Newton on the Fischer-Burmeister function of the second-order cone")                             \
  solver("accelerated-gradient", make_accelerated_gradient,                                                            \
         "Nesterov's projected gradient with restarts: needs only products with W")                                    \
  solver("extragradient", make_extragradient,                                                                          \
         "Korpelevich's extragradient with an adapted step: needs only products with W")                               \
  solver("admm", make_admm, "alternating direction method of multipliers with an adapted penalty")
// clang-format on

#define RICOCHET_DECLARE(name, make, text) std::unique_ptr<ContactSolver> make();
RICOCHET_CONTACT_SOLVERS(RICOCHET_DECLARE)
#undef RICOCHET_DECLARE

namespace {

struct Registration {
  ContactSolverDescription description;
  std::unique_ptr<ContactSolver> (*make)();
};

const std::vector<Registration>& registrations() {
#define RICOCHET_REGISTER(name, make, text) {{name, text}, make},
  static const std::vector<Registration> all{RICOCHET_CONTACT_SOLVERS(RICOCHET_REGISTER)};
#undef RICOCHET_REGISTER
  return all;
}

}  // namespace

std::vector<ContactSolverDescription> contact_solvers() {
  std::vector<ContactSolverDescription> result;
  for (const Registration& entry : registrations()) result.push_back(entry.description);
  return result;
}

std::unique_ptr<ContactSolver> make_contact_solver(const std::string& name) {
  std::vector<std::string> names;
  for (const Registration& entry : registrations()) {
    if (entry.description.name == name) return entry.make();
    names.push_back(entry.description.name);
  }
  throw Error(ErrorKind::usage, fmt::format("unknown contact solver \"{}\"; known: {}", name, join_names(names)));
}

}  // namespace ricochet
