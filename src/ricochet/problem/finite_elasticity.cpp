#include "ricochet/problem/finite_elasticity.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "ricochet/base/error.hpp"

namespace ricochet {

FiniteElasticity::FiniteElasticity(const Body& body, NodeGraph graph)
    : FiniteElasticity(body, std::move(graph), {}, std::make_shared<bool>(false)) {}

FiniteElasticity::FiniteElasticity(const Body& body, NodeGraph graph, std::vector<int> cells,
                                   std::shared_ptr<bool> controls_distortion)
    : body_(body),
      graph_(std::move(graph)),
      cells_(body, &graph_, cells),
      controls_distortion_(std::move(controls_distortion)) {
  if (DistortionControl::applies_to(body)) control_.emplace(body, graph_, cells);
}

/// Includes the nodes that are tied to the requested ones.
std::shared_ptr<const InternalForce> FiniteElasticity::restricted_to(const std::vector<char>& nodes) const {
  std::vector<char> selected = nodes;
  if (body_.tied != nullptr) {
    for (const TiedNodes::Tie& tie : body_.tied->ties()) {
      for (const auto& [node, weight] : tie.weights) {
        if (weight != 0.0 && nodes[std::size_t(node)] != 0) selected[std::size_t(tie.node)] = 1;
      }
    }
  }
  NodeGraph graph = cells_at_nodes(graph_, *body_.space, selected);
  std::vector<int> cells = graph.cells;
  std::ranges::sort(cells);
  cells.erase(std::unique(cells.begin(), cells.end()), cells.end());
  return std::make_shared<FiniteElasticity>(body_, std::move(graph), std::move(cells), controls_distortion_);
}

const Vector& FiniteElasticity::complete(const Vector& values, Vector& memory) const {
  if (body_.tied == nullptr || body_.tied->empty() || values.size() == 0) return values;
  memory = values;
  body_.tied->complete(memory, body_.mesh->dimension);
  return memory;
}

void FiniteElasticity::condense(Vector& force) const {
  if (body_.tied != nullptr && !body_.tied->empty()) body_.tied->condense_load(force, body_.mesh->dimension);
}

void FiniteElasticity::require_positive_volume(const CellVolume& smallest) const {
  if (smallest.volume_ratio > 0.0) return;
  const CellLocation location = location_of_cell(*body_.mesh, smallest.cell);
  throw Error(ErrorKind::not_converged,
              fmt::format("cell {} at ({:.6g}) is inverted: somewhere in it the volume is {:.3g} times that at rest",
                          location.tag, fmt::join(location.centre, ", "), smallest.volume_ratio));
}

void FiniteElasticity::evaluate(const Vector& displacement, Vector& force) const {
  const Vector& completed = complete(displacement, displacement_);
  require_positive_volume(cells_.force(completed, force));
  if (control() != nullptr) require_positive_volume(control()->add_force(completed, force));
  condense(force);
}

void FiniteElasticity::path_force(const Vector& middle, const Vector& increment, const PathRules& rules,
                                  Vector& force) const {
  require_positive_volume(
      cells_.path_force(complete(middle, displacement_), complete(increment, increment_), rules, force));
  if (control() != nullptr)
    require_positive_volume(
        control()->add_path_force(complete(middle, displacement_), complete(increment, increment_), force));
  condense(force);
}

SparseMatrix FiniteElasticity::condensed(SparseMatrix general) const {
  if (body_.tied == nullptr || body_.tied->empty()) return general;
  return body_.tied->condense_general(general, body_.mesh->dimension);
}

SparseMatrix FiniteElasticity::path_tangent(const Vector& middle, const Vector& increment, const PathRules& rules,
                                            const PathVariation& variation) const {
  const Vector &at = complete(middle, displacement_), &change = complete(increment, increment_);
  SparseMatrix result = cells_.path_tangent(at, change, rules, variation);
  if (control() != nullptr) control()->add_path_tangent(at, change, variation, result);
  return condensed(std::move(result));
}

double FiniteElasticity::estimated_seconds() const {
  constexpr double per_number = 1.3e-9;  // per component of a node and quadrature point
  return per_number * cells_.size();
}

PathRules FiniteElasticity::path_rules() const {
  return PathRules(std::size_t(body_.mesh->cell_count()), PathRule::two_points);
}

bool FiniteElasticity::raise_path_rules(const Vector& middle, const Vector& increment, PathRules& rules) const {
  return cells_.raise_path_rules(complete(middle, displacement_), complete(increment, increment_), rules);
}

double FiniteElasticity::energy(const Vector& displacement) const {
  const Vector& completed = complete(displacement, displacement_);
  return cells_.energy(completed) + (control() != nullptr ? control()->energy(completed) : 0.0);
}

CellVolume FiniteElasticity::smallest_nodal_volume(const Vector& displacement) const {
  return control_->smallest_volume(complete(displacement, displacement_));
}

double FiniteElasticity::distortion_energy(const Vector& displacement) const {
  return control() != nullptr ? control()->energy(complete(displacement, displacement_)) : 0.0;
}

SparseMatrix FiniteElasticity::tangent(const Vector& displacement) const { return step_tangent(displacement, 0.0); }

SparseMatrix FiniteElasticity::step_tangent(const Vector& displacement, double step) const {
  const Vector& completed = complete(displacement, displacement_);
  SparseMatrix result = cells_.tangent(completed, step);
  if (control() != nullptr && completed.size() > 0) control()->add_tangent(completed, result);
  if (body_.tied == nullptr || body_.tied->empty()) return result;
  return body_.tied->condense(result, body_.mesh->dimension);
}

SparseMatrix FiniteElasticity::step_path_tangent(const BranchStep& step, const PathRules& rules,
                                                 const PathVariation& variation) const {
  const BranchStep completed = complete(step);
  SparseMatrix result = cells_.path_tangent(completed, rules, variation);
  if (control() != nullptr) control()->add_path_tangent(completed.middle, completed.increment, variation, result);
  return condensed(std::move(result));
}

BranchStep FiniteElasticity::complete(const BranchStep& step) const {
  return {complete(step.middle, displacement_),
          complete(step.increment, increment_),
          complete(step.start, start_),
          complete(step.end, end_),
          step.internal,
          step.step};
}

void FiniteElasticity::add_branches(Vector& force) const {
  condense(branches_);
  force += branches_;
}

void FiniteElasticity::relax(const Vector& displacement, Vector& internal) const {
  cells_.relax(complete(displacement, displacement_), internal);
}

double FiniteElasticity::branch_energy(const Vector& displacement, const Vector& internal) const {
  return cells_.branch_energy(complete(displacement, displacement_), internal);
}

void FiniteElasticity::add_mean_force(const BranchStep& step, Vector& force) const {
  cells_.mean_branch_force(complete(step), branches_);
  add_branches(force);
}

void FiniteElasticity::add_end_force(const BranchStep& step, Vector& force) const {
  cells_.end_branch_force(complete(step), branches_);
  add_branches(force);
}

double FiniteElasticity::start_energy(const BranchStep& step, const Vector& displacement) const {
  return cells_.start_branch_energy(complete(step), complete(displacement, at_));
}

double FiniteElasticity::advance_internal(const BranchStep& step, Vector& internal) const {
  return cells_.advance_internal(complete(step), internal);
}

}  // namespace ricochet
