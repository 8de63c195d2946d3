#include "ricochet/problem/internal_force.hpp"

#include <stdexcept>

#include "ricochet/base/error.hpp"

namespace ricochet {

void require_linear(const InternalForce& internal_force, const std::string& who) {
  if (internal_force.is_linear()) return;
  throw Error(ErrorKind::invalid_input, who + " needs a linear material law: set material.law = \"linear\"");
}

namespace {

[[noreturn]] void throw_linear() {
  throw std::logic_error("this internal force does not provide the requested function");
}

}  // namespace

std::shared_ptr<const InternalForce> InternalForce::restricted_to(const std::vector<char>&) const { throw_linear(); }

void InternalForce::path_force(const Vector&, const Vector&, const PathRules&, Vector&) const { throw_linear(); }

SparseMatrix InternalForce::path_tangent(const Vector&, const Vector&, const PathRules&, const PathVariation&) const {
  throw_linear();
}

PathRules InternalForce::path_rules() const { throw_linear(); }

bool InternalForce::raise_path_rules(const Vector&, const Vector&, PathRules&) const { throw_linear(); }

double InternalForce::energy(const Vector& displacement, const Vector&) const { return energy(displacement); }

double InternalForce::energy_terms(const Vector&) const { throw_linear(); }

Vector InternalForce::stiffness_diagonal() const {
  const NodeMatrix* const constant = constant_tangent();
  return constant != nullptr ? constant->diagonal() : Vector(tangent().diagonal());
}

MatrixGraph InternalForce::graph(int d) const {
  const NodeMatrix* const constant = constant_tangent();
  return constant != nullptr ? MatrixGraph(constant->pattern()) : MatrixGraph(tangent(), d);
}

LinearElasticity::LinearElasticity(const SparseMatrix& stiffness, const Points& nodes)
    : rigid_(nodes, stiffness), stiffness_(stiffness, int(nodes.rows())) {}

void LinearElasticity::evaluate(const Vector& displacement, Vector& force) const {
  rigid_.remove(displacement, deformation_);
  stiffness_.multiply(deformation_, force);
}

double LinearElasticity::energy(const Vector& displacement) const {
  rigid_.remove(displacement, deformation_);
  return 0.5 * stiffness_.quadratic_form(deformation_);
}

double LinearElasticity::energy_terms(const Vector& displacement) const {
  rigid_.remove(displacement, deformation_);
  return stiffness_.absolute_quadratic_form(deformation_);
}

double LinearElasticity::energy(const Vector& displacement, const Vector& force) const {
  return 0.5 * rigid_.work(force, displacement);
}

}  // namespace ricochet
