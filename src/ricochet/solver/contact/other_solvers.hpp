#pragma once

#include <map>
#include <memory>
#include <string>
#include <vector>

#include "ricochet/solver/contact/globalized_newton.hpp"
#include "ricochet/solver/contact/iterative_contact_solver.hpp"

/// @file Fallbacks of the automatic solver after its own sweeps and Newton steps have failed.
namespace ricochet {

/// The other solvers, from r = 0, then from the best r so far. They fail on other problems than the automatic one does:
/// they are needed for strong friction in wedges whose surfaces are hardly compliant (hard_problems_test.cpp).
class OtherSolvers {
 public:
  struct Kind {
    const char* name;
    bool factorizes;
    int iteration_limit;
  };
  /// Solvers tried after Newton's method has failed from the last reactions and from zero.
  static const std::vector<Kind> first;
  /// Solvers tried before the very end.
  static const std::vector<Kind> last;

  /// Returns whether it is solved, with r and u in work.current. Better iterates than `best` are kept in it.
  bool solve(const ContactIteration& iteration, const std::vector<Kind>& kinds, BestIterate& best);
  void forget() { solvers_.clear(); }

 private:
  std::map<std::string, std::unique_ptr<IterativeContactSolver>> solvers_;
  ContactIterate on_law_;
};

}  // namespace ricochet
