#include "ricochet/scheme/state.hpp"

#include <algorithm>
#include <initializer_list>

#include "ricochet/contact/row_values.hpp"

#include "ricochet/problem/viscous_force.hpp"

namespace ricochet {

void save(const SemidiscreteProblem& problem, const State& state, Snapshot& snapshot, const std::string& name) {
  snapshot.save(name + ".step", static_cast<std::int64_t>(state.step));
  snapshot.save(name + ".time", state.time);
  snapshot.save(name + ".displacement", state.displacement);
  snapshot.save(name + ".velocity", state.velocity);
  snapshot.save(name + ".acceleration", state.acceleration);
  snapshot.save(name + ".internal_strain", state.internal_strain);
  snapshot.save(name + ".normal_reaction", state.forces.normal_reaction);
  snapshot.save(name + ".tangential_reaction", state.forces.tangential_reaction);
  snapshot.save(name + ".mean_normal_reaction", state.forces.mean_normal_reaction);
  snapshot.save(name + ".mean_tangential_reaction", state.forces.mean_tangential_reaction);
  snapshot.save(name + ".end_weight", state.forces.end_weight);
  snapshot.save(name + ".support_reaction", state.forces.support_reaction);
  snapshot.save(name + ".varying_load", state.forces.varying_load);
  snapshot.save(name + ".damping_force", state.forces.damping_force);
  const bool follows = !state.forces.rows->revision.empty();
  const Points& normals = state.forces.rows->normals;
  snapshot.save(name + ".normals", follows ? Vector(normals.reshaped()) : Vector());
  snapshot.save(name + ".gap", follows ? state.forces.rows->gap : Vector());
  if (follows && problem.contact.geometry->row_value_count() > 0)
    snapshot.save(name + ".row_values", problem.contact.geometry->row_values(*state.forces.rows));
  snapshot.save(name + ".contact_status", state.contact_status);
  snapshot.save(name + ".obstacle_increment.normal", state.obstacle_increment.normal);
  snapshot.save(name + ".obstacle_increment.tangential", state.obstacle_increment.tangential);
  snapshot.save(name + ".obstacle_increment.in_space", Vector(state.obstacle_increment.in_space.reshaped()));
  snapshot.save(name + ".iterations", state.iterations);
  snapshot.save(name + ".newton_rounds", state.newton_iterations);
  Snapshot::Texts names;
  for (const auto& [key, values] : state.memory) {
    names.push_back(key);
    snapshot.save(name + ".memory." + key, values);
  }
  snapshot.save(name + ".memory", std::move(names));
}

namespace {

/// Reads values whose count is one of these lengths.
const Vector& memory(const Snapshot& snapshot, const std::string& name, std::initializer_list<Index> lengths) {
  const Vector& values = snapshot.reals(name);
  if (std::find(lengths.begin(), lengths.end(), values.size()) == lengths.end())
    Snapshot::refuse(name, "has a length that does not fit this problem");
  return values;
}

}  // namespace

State load_state(const SemidiscreteProblem& problem, const Snapshot& snapshot, const std::string& name) {
  const Index dofs = problem.dof_count(), points = problem.contact.size();
  const Index tangents = points * (problem.dimension - 1);
  State state;
  state.step = snapshot.integer(name + ".step");
  state.time = snapshot.real(name + ".time");
  state.displacement = snapshot.reals(name + ".displacement", dofs);
  state.velocity = snapshot.reals(name + ".velocity", dofs);
  state.acceleration = snapshot.reals(name + ".acceleration", dofs);
  const ViscousForce* const viscous = problem.internal_force->viscous();
  state.internal_strain = snapshot.reals(name + ".internal_strain", viscous != nullptr ? viscous->internal_size() : 0);
  state.forces.normal_reaction = snapshot.reals(name + ".normal_reaction", points);
  state.forces.tangential_reaction = snapshot.reals(name + ".tangential_reaction", tangents, 0);
  state.forces.mean_normal_reaction = snapshot.reals(name + ".mean_normal_reaction", points, 0);
  state.forces.mean_tangential_reaction = snapshot.reals(name + ".mean_tangential_reaction", tangents, 0);
  state.forces.end_weight = snapshot.real(name + ".end_weight");
  state.forces.support_reaction = snapshot.reals(name + ".support_reaction", problem.supports.size());
  state.forces.varying_load = snapshot.reals(name + ".varying_load", dofs, 0);
  state.forces.damping_force = snapshot.reals(name + ".damping_force", dofs, 0);
  state.forces.rows = problem.contact.rows;
  if (problem.contact.follows_motion()) {
    const auto rows = std::make_shared<ContactRows>(*problem.contact.rows);
    const Vector& normals = snapshot.reals(name + ".normals", points * problem.dimension);
    const Index values = problem.contact.geometry->row_value_count();
    problem.contact.geometry->restore(normals.reshaped(problem.dimension, points),
                                      snapshot.reals(name + ".gap", points),
                                      values > 0 ? snapshot.reals(name + ".row_values", values) : Vector(), *rows);
    state.forces.rows = rows;
  }
  state.contact_status = snapshot.statuses(name + ".contact_status", points);
  state.obstacle_increment.normal = snapshot.reals(name + ".obstacle_increment.normal", points, 0);
  state.obstacle_increment.tangential = snapshot.reals(name + ".obstacle_increment.tangential", tangents, 0);
  const Vector& in_space = snapshot.reals(name + ".obstacle_increment.in_space", points * problem.dimension, 0);
  state.obstacle_increment.in_space = in_space.reshaped(problem.dimension, in_space.size() / problem.dimension);
  state.iterations = static_cast<int>(snapshot.integer(name + ".iterations"));
  state.newton_iterations = static_cast<int>(snapshot.integer(name + ".newton_rounds"));
  const Index row_values = row_value_count(*problem.contact.rows);
  for (const std::string& key : snapshot.texts(name + ".memory"))
    state.memory[key] = memory(snapshot, name + ".memory." + key,
                               {dofs, problem.supports.size(), tangents, row_values, State::memory_numbers});
  return state;
}

}  // namespace ricochet
