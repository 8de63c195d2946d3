#include "ricochet/solver/contact/iteration_record.hpp"

namespace ricochet {

namespace {

/// Status of a point, by its reaction alone.
ContactStatus status_of(const ContactPoint& point, const Vector& reaction) {
  if (!(reaction[point.row] > 0.0)) return ContactStatus::open;
  if (!point.has_friction()) return ContactStatus::closed;
  const double limit = point.friction_limit(reaction[point.row]) * (1.0 - 1e-9);
  const double length = reaction.segment(point.row + 1, point.size - 1).norm();
  return length < limit ? ContactStatus::stick : ContactStatus::slip;
}

}  // namespace

IterationRecord count_states(const ContactSystem& system, const Vector& reaction, ContactSolution& solution) {
  IterationRecord counts;
  for (const ContactPoint& point : system.points()) {
    const ContactStatus status = status_of(point, reaction);
    ContactStatus& before = solution.record_status[std::size_t(point.point)];
    counts.changed += status != before ? 1 : 0;
    counts.closed += status != ContactStatus::open ? 1 : 0;
    counts.slipping += status == ContactStatus::slip ? 1 : 0;
    counts.sticking += status == ContactStatus::stick ? 1 : 0;
    before = status;
  }
  return counts;
}

void note_iteration(const ContactSystem& system, const ContactOptions& options, const char* phase, double residual,
                    const Vector& reaction, ContactSolution& solution) {
  ++solution.iterations;
  record_iteration(system, options, phase, residual, reaction, solution);
}

void record_iteration(const ContactSystem& system, const ContactOptions& options, const char* phase, double residual,
                      const Vector& reaction, ContactSolution& solution) {
  if (!options.record) return;
  IterationRecord line = count_states(system, reaction, solution);
  line.phase = phase;
  line.residual = residual / system.data();
  solution.record.push_back(line);
}

}  // namespace ricochet
