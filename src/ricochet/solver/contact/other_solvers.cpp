#include "ricochet/solver/contact/other_solvers.hpp"

#include <algorithm>

#include "ricochet/solver/contact/cone_formulation.hpp"

namespace ricochet {

/// Largest number of operations of factors, or of entries of W.
constexpr double max_factor_work = 1e11;
constexpr double max_sweep_work = 4e9;
constexpr int fewest_worth_a_try = 5;

const std::vector<OtherSolvers::Kind> OtherSolvers::first{{"newton-alart-curnier", true, 60},
                                                          {"newton-fischer-burmeister", true, 150}};
const std::vector<OtherSolvers::Kind> OtherSolvers::last{{"newton-fischer-burmeister", true, 200},
                                                         {"accelerated-gradient", false, 20000},
                                                         {"newton-jean-moreau", true, 200},
                                                         {"admm", false, 20000}};

bool OtherSolvers::solve(const ContactIteration& iteration, const std::vector<Kind>& kinds, BestIterate& best) {
  if (!refuse_bounds(iteration.system).empty()) return false;
  const double rows = double(iteration.system.rows());
  for (const bool cold : {true, false}) {
    for (const Kind& kind : kinds) {
      const double limit = kind.factorizes ? max_factor_work / (rows * rows * rows) : max_sweep_work / (rows * rows);
      ContactOptions options = iteration.options;
      options.iteration_limit = int(std::min(limit, double(kind.iteration_limit)));
      if (options.iteration_limit < fewest_worth_a_try) continue;
      iteration.current.reaction = cold ? Vector(Vector::Zero(iteration.system.rows())) : best.iterate.reaction;
      iteration.system.evaluate(iteration.current);
      std::unique_ptr<IterativeContactSolver>& solver = solvers_[kind.name];
      if (solver == nullptr) solver = make_iterative_contact_solver(kind.name);
      const bool solved = solver->iterate(iteration.system, options, iteration.current, iteration.solution).empty();
      if ((solved && iteration.options.tolerance > 0.0) || iteration.is_loosely_solved(iteration.current, on_law_))
        return true;
      best.keep(iteration);
    }
  }
  return false;
}

}  // namespace ricochet
