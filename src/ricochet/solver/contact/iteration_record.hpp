#pragma once

#include "ricochet/solver/contact/contact_solver.hpp"
#include "ricochet/solver/contact/contact_system.hpp"

/// @file Records of iterations: their number and, on demand, their results.
namespace ricochet {

/// Counts an iteration, and enters it in the record with the reactions it has reached. `residual` is not yet divided by
/// the data.
void note_iteration(const ContactSystem& system, const ContactOptions& options, const char* phase, double residual,
                    const Vector& reaction, ContactSolution& solution);
/// Enters it in the record, if one is kept, without counting.
void record_iteration(const ContactSystem& system, const ContactOptions& options, const char* phase, double residual,
                      const Vector& reaction, ContactSolution& solution);

/// Transfers the states of the points to the solution's record; returns the number of each, and of changed ones.
IterationRecord count_states(const ContactSystem& system, const Vector& reaction, ContactSolution& solution);

}  // namespace ricochet
