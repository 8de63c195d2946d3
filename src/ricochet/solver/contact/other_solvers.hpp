#pragma once

#include <map>
#include <memory>
#include <string>
#include <vector>

#include "ricochet/solver/contact/globalized_newton.hpp"
#include "ricochet/solver/contact/iterative_contact_solver.hpp"

/// @file What the automatic solver asks where its own sweeps and Newton steps have failed.
namespace ricochet {

/// The other solvers from r = 0, then from the best r there is. They fail where the automatic one does not and the
/// other way round: strong friction in wedges whose surfaces hardly give (hard_problems_test.cpp) is where they are
/// needed.
class OtherSolvers {
 public:
  struct Kind {
    const char* name;
    bool factorizes;
    int iteration_limit;
  };
  /// Where Newton has failed from the last reactions and from zero.
  static const std::vector<Kind> first;
  /// Before the very end.
  static const std::vector<Kind> last;

  /// True: solved, with r and u in work.current. What comes nearer than `best` is kept in it.
  bool solve(const ContactWork& work, const std::vector<Kind>& kinds, BestIterate& best);
  void forget() { solvers_.clear(); }

 private:
  std::map<std::string, std::unique_ptr<IterativeContactSolver>> solvers_;
  ContactIterate on_law_;
};

}  // namespace ricochet
