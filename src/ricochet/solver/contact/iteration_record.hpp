#pragma once

#include "ricochet/solver/contact/contact_solver.hpp"
#include "ricochet/solver/contact/contact_system.hpp"

/// @file What iterations leave behind of themselves: their number, and where a record is asked for, what they did.
namespace ricochet {

/// Counts an iteration, and notes it in the record with the reactions it has come to. `residual`: not yet divided by
/// the data.
void note_iteration(const ContactSystem& system, const ContactOptions& options, const char* phase, double residual,
                    const Vector& reaction, ContactSolution& solution);
/// Notes it without counting, where a record is asked for.
void record_iteration(const ContactSystem& system, const ContactOptions& options, const char* phase, double residual,
                      const Vector& reaction, ContactSolution& solution);

/// Takes the states of the points over into the solution's record; how many there are of each, and have changed.
IterationRecord count_states(const ContactSystem& system, const Vector& reaction, ContactSolution& solution);

}  // namespace ricochet
