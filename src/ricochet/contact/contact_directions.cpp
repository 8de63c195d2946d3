#include "ricochet/contact/contact_directions.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

namespace ricochet {

namespace {

/// Returns d × (d−1) orthonormal directions that complete the normal; in 2D (1, 0) for the normal (0, 1).
Points tangents_of(const Vector& normal) {
  Points result(normal.size(), normal.size() - 1);
  if (normal.size() == 2) {
    result << normal[1], -normal[0];
    return result;
  }
  // The axis least aligned with the normal gives a well-conditioned first tangent.
  Index axis = 0;
  normal.cwiseAbs().minCoeff(&axis);
  const Eigen::Vector3d n = normal;
  const Eigen::Vector3d first = Eigen::Vector3d::Unit(axis).cross(n).normalized();
  result.col(0) = first;
  result.col(1) = n.cross(first);
  return result;
}

}  // namespace

bool has_free_part(Index node, const Vector& normal, const FreeComponent& is_free) {
  double free_part = 0.0;
  for (int k = 0; k < normal.size(); ++k) {
    if (is_free(node, k)) free_part = std::max(free_part, std::abs(normal[k]));
  }
  // The bound applies to a unit vector and has no unit. Below it the free part of the normal is rounding error.
  return free_part > 1e-10;
}

ContactTangents tangents_at(Index node, const Vector& normal, const FreeComponent& is_free) {
  ContactTangents result{tangents_of(normal), {false, false}};
  int supported = 0;
  int axis = 0;
  for (int k = 0; k < normal.size(); ++k) {
    if (is_free(node, k)) continue;
    ++supported;
    axis = k;
  }
  if (supported == 0) {
    result.slips = {true, true};
  } else if (supported == 1 && normal.size() == 3) {
    const Eigen::Vector3d n = normal;
    const Eigen::Vector3d slip = n.cross(Eigen::Vector3d::Unit(axis));
    // A normal along the constrained axis belongs to a constrained node, which is no contact point.
    if (slip.norm() == 0.0) return result;
    result.directions.col(0) = slip.normalized();
    result.directions.col(1) = n.cross(Eigen::Vector3d(result.directions.col(0)));
    result.slips[0] = true;
  }
  return result;
}

void write_directions(Index point, const SpaceVector& normal, const std::array<bool, 3>& is_free,
                      const SparseRowMatrix& trace, ContactRows& rows) {
  const Index d = normal.size();
  const ContactTangents tangents =
      tangents_at(0, normal, [&](Index, int component) { return is_free[std::size_t(component)]; });
  rows.normals.col(point) = normal;
  rows.tangents[std::size_t(point)] = tangents.directions;
  for (Index j = 0; j < d - 1; ++j) {
    const Index row = point * (d - 1) + j;
    const bool slips = tangents.slips[std::size_t(j)];
    rows.slips[std::size_t(row)] = slips ? 1 : 0;
    double* slip = rows.tangential_trace.valuePtr() + rows.tangential_trace.outerIndexPtr()[row];
    for (SparseRowMatrix::InnerIterator entry(trace, point); entry; ++entry) {
      for (Index k = 0; k < d; ++k) *slip++ = slips ? entry.value() * tangents.directions(k, j) : 0.0;
    }
  }
}

}  // namespace ricochet
