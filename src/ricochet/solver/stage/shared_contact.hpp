#pragma once

#include "ricochet/solver/contact/contact_solver.hpp"

/// @file Options, observer and counts that the contact problems of all stages of a step solver share.
namespace ricochet {

struct SharedContact {
  bool all_points = false;         ///< whether every contact point is a candidate from the start
  ContactObserver observer = {};   ///< to which StageSolver::show_contact shows problems; may be empty
  double solver_seconds = 0.0;     ///< time spent in contact solvers so far
  std::size_t factor_entries = 0;  ///< number of entries of all factors in use
};

}  // namespace ricochet
