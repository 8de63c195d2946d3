#include "ricochet/problem/internal_force.hpp"

namespace ricochet {

void LinearElasticity::evaluate(const Vector& displacement, Vector& force) const {
  rigid_.remove(displacement, deformation_);
  force.noalias() = stiffness_ * deformation_;
}

double LinearElasticity::energy(const Vector& displacement) const {
  rigid_.remove(displacement, deformation_);
  work_.noalias() = stiffness_ * deformation_;
  return 0.5 * deformation_.dot(work_);
}

}  // namespace ricochet
