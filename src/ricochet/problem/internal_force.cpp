#include "ricochet/problem/internal_force.hpp"

namespace ricochet {

LinearElasticity::LinearElasticity(const SparseMatrix& stiffness, const Points& nodes,
                                   std::shared_ptr<const NodeOrder> order)
    : rigid_(nodes, stiffness, order), stiffness_(stiffness, static_cast<int>(nodes.rows()), std::move(order)) {}

void LinearElasticity::evaluate(const Vector& displacement, Vector& force) const {
  rigid_.remove(displacement, deformation_);
  stiffness_.multiply_ordered(deformation_, force_);
  stiffness_.from_order(force_, force);
}

double LinearElasticity::energy(const Vector& displacement) const {
  rigid_.remove(displacement, deformation_);
  return 0.5 * stiffness_.form_ordered(deformation_);
}

}  // namespace ricochet
