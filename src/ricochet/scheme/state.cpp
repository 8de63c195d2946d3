#include "ricochet/scheme/state.hpp"

#include <algorithm>
#include <initializer_list>
#include <utility>

#include "ricochet/problem/viscous_force.hpp"

namespace ricochet {

namespace {

/// Saves and loads the rows of contact that follows the motion.
void persist_rows(const SnapshotVisitor& visit, const ContactBoundary& contact,
                  std::shared_ptr<const ContactRows>& rows) {
  const bool follows = contact.follows_motion();
  if (visit.loads()) rows = contact.rows;
  Points normals;
  Vector gap, row_values;
  if (follows) {
    normals = rows->normals;
    gap = rows->gap;
    row_values = contact.geometry->row_values(*rows);
  }
  const Index points = follows ? contact.size() : 0;
  visit("normals", normals, contact.dimension, points, points);
  visit("gap", gap, points);
  if (row_values.size() > 0) visit("row_values", row_values, row_values.size());
  if (!visit.loads() || !follows) return;
  const auto restored = std::make_shared<ContactRows>(*rows);
  contact.geometry->restore(normals, gap, row_values, *restored);
  rows = restored;
}

/// Saves and loads the forces, of one of two sizes each if they may be absent.
void persist(const SnapshotVisitor& visit, const SemidiscreteProblem& problem, StepForces& forces) {
  const Index dofs = problem.dof_count(), points = problem.contact.size();
  const Index tangents = points * (problem.dimension - 1);
  visit("normal_reaction", forces.normal_reaction, points);
  visit("tangential_reaction", forces.tangential_reaction, tangents, 0);
  visit("mean_normal_reaction", forces.mean_normal_reaction, points, 0);
  visit("mean_tangential_reaction", forces.mean_tangential_reaction, tangents, 0);
  visit("end_weight", forces.end_weight);
  visit("support_reaction", forces.support_reaction, problem.supports.size());
  visit("varying_load", forces.varying_load, dofs, 0);
  visit("damping_force", forces.damping_force, dofs, 0);
  persist_rows(visit, problem.contact, forces.rows);
}

/// Saves and loads the scheme's memory: vectors of one of these sizes.
void persist_memory(const SnapshotVisitor& visit, std::initializer_list<Index> sizes, SchemeMemory& memory) {
  Snapshot::Texts names;
  for (const auto& [key, values] : memory) names.push_back(key);
  visit("memory", names);
  if (visit.loads()) memory.clear();
  for (const std::string& key : names) {
    Vector& values = memory[key];
    visit("memory." + key, values);
    visit.require(std::ranges::find(sizes, values.size()) != sizes.end(), "memory." + key,
                  "has a length that does not fit this problem");
  }
}

}  // namespace

const Vector& SchemeMemory::at(const std::string& name, Index size) const {
  const auto found = find(name);
  if (found == end()) Snapshot::refuse("memory." + name, "is missing");
  if (found->second.size() != size) Snapshot::refuse("memory." + name, "has a length that does not fit this problem");
  return found->second;
}

Vector& SchemeMemory::at(const std::string& name, Index size) {
  return const_cast<Vector&>(std::as_const(*this).at(name, size));
}

void persist(const SnapshotVisitor& visit, const SemidiscreteProblem& problem, State& state) {
  const Index dofs = problem.dof_count(), points = problem.contact.size();
  const Index tangents = points * (problem.dimension - 1);
  const ViscousForce* const viscous = problem.internal_force->viscous();
  visit("step", state.step);
  visit("time", state.time);
  visit("displacement", state.displacement, dofs);
  visit("velocity", state.velocity, dofs);
  visit("acceleration", state.acceleration, dofs);
  visit("internal_strain", state.internal_strain, viscous != nullptr ? viscous->internal_size() : 0);
  persist(visit, problem, state.forces);
  visit("contact_status", state.contact_status, {0, std::int64_t(ContactStatus::slip)}, points);
  ObstacleMotion& increment = state.obstacle_increment;
  visit("obstacle_increment.normal", increment.normal, points, 0);
  visit("obstacle_increment.tangential", increment.tangential, tangents, 0);
  visit("obstacle_increment.in_space", increment.in_space, problem.dimension, points, 0);
  visit("iterations", state.iterations);
  visit("newton_rounds", state.newton_iterations);
  persist_memory(visit, {dofs, problem.supports.size(), tangents, State::memory_numbers}, state.memory);
}

}  // namespace ricochet
