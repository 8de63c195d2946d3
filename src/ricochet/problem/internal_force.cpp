#include "ricochet/problem/internal_force.hpp"

#include "ricochet/base/parallel.hpp"

namespace ricochet {

LinearElasticity::LinearElasticity(const SparseMatrix& stiffness, const Points& nodes)
    : rigid_(nodes, stiffness),
      stiffness_(stiffness, static_cast<int>(nodes.rows()), std::make_shared<const NodeOrder>(order_nodes(nodes))) {}

void LinearElasticity::evaluate(const Vector& displacement, Vector& force) const {
  rigid_.remove(displacement, stiffness_.order(), deformation_);
  stiffness_.multiply_ordered(deformation_, force_);
  stiffness_.from_order(force_, force);
}

double LinearElasticity::evaluate_with_energy(const Vector& displacement, Vector& force) const {
  evaluate(displacement, force);
  return 0.5 * parallel_sum<double>(deformation_.size(), [&](Index begin, Index end) {
           return deformation_.segment(begin, end - begin).dot(force_.segment(begin, end - begin));
         });
}

double LinearElasticity::energy(const Vector& displacement) const {
  rigid_.remove(displacement, stiffness_.order(), deformation_);
  return 0.5 * stiffness_.form_ordered(deformation_);
}

}  // namespace ricochet
